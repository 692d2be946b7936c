# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The raceway of the published study."""

from dataclasses import replace

import pytest
from surrogate.screw.opened import Contacts
from surrogate.studies.solve import published_patch


def test_the_patch_belongs_to_the_draw_and_stays_where_the_preload_vanishes(screw):
    """One surface per draw, with all waves of the published constants."""
    first, again, other = (published_patch(Contacts.of(screw), draw) for draw in (3, 3, 4))
    assert first.scale == again.scale != other.scale
    assert first.shortest_wavelength == pytest.approx(9.13e-6, rel=1e-3)
    scales = [
        published_patch(Contacts.of(replace(screw, preload=preload)), 0).scale
        for preload in (0.0, 1.0)
    ]
    assert scales[0] == scales[1]
