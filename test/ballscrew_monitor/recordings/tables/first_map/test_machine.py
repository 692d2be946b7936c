# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The machine that a first map assumes."""

from ballscrew_monitor.recordings.tables.first_map import machine
import pytest
from surrogate.parameters import load_lubricant, load_screw


def test_the_usual_screw_and_oil_are_shipped_and_it_has_the_lead_of_its_sheet():
    """Whose surface tells it, so that no sheet has to be read."""
    assert machine._usual_lead() == pytest.approx(load_screw(machine.SCREW).lead, rel=1e-12)
    assert load_lubricant(machine.OIL).name == machine.OIL
