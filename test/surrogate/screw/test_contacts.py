# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the contacts of a screw: what a solve does unless it is told otherwise."""

from dataclasses import replace
import math

import pytest
from surrogate.ehl import Settings
from surrogate.screw.contacts import _across, ScrewSettings


def test_a_screw_is_solved_with_the_settings_that_are_measured():
    """Another default is another model: accuracy and times of the notes are measured again."""
    assert ScrewSettings() == ScrewSettings(
        kinematics='rolling',
        smooth=Settings(),
        rough=Settings(nx=129, ny=257, error_estimate=False),
        draw=0,
        grid_wavelength=16e-6,
        nodes_per_wave=6.0,
        inlet_heating=True,
        coupling_tolerance=0.01,
    )


@pytest.mark.parametrize(('per_wave', 'nodes'), [(3.0, 257), (6.0, 455), (12.0, 513)])
def test_a_rough_contact_has_its_nodes_on_the_shortest_wave(per_wave, nodes):
    """So many a wave over 2.42 semi-axes, not fewer than the settings have and at most 513."""
    settings = replace(ScrewSettings(), nodes_per_wave=per_wave)
    assert _across(settings, 0.5e-3, 16e-6).ny == nodes
    assert _across(settings, 0.5e-3, math.inf).ny == 257
