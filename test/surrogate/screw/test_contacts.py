# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the contacts of a screw: what a solve does unless it is told otherwise."""

from surrogate.ehl import Settings
from surrogate.screw.contacts import ScrewSettings


def test_a_screw_is_solved_with_the_settings_that_are_measured():
    """Another default is another model: accuracy and times of the notes are measured again."""
    assert ScrewSettings() == ScrewSettings(
        kinematics='rolling', smooth=Settings(), inlet_heating=True, coupling_tolerance=0.01
    )
