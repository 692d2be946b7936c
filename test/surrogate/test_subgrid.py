# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Waves that are too short for a grid, and the floor that stands for them."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.geometry import hertz, screw_contact
from surrogate.parameters import InputError, load_screw
from surrogate.roughness import fractal_surface, take_patch, Window
from surrogate.subgrid import CARRIED, dry_gap, subgrid_floor, without_short_waves

AXIS = np.linspace(-1e-4, 1e-4, 201)


@pytest.fixture(scope='module')
def contact():
    """Return the nominal contact at the screw."""
    return screw_contact(load_screw('nominal'), 'screw')


@pytest.fixture(scope='module')
def surface(contact):
    """Return one draw of the nominal roughness with waves down to 13.7 um."""
    roughness = replace(load_screw('nominal').roughness, shortest_wavelength=13e-6)
    ellipse = hertz(contact, 100.0)
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    return take_patch(fractal_surface(roughness, 1), 'rescaled', window, roughness.rms)


def test_long_waves_stay_as_they_are(surface):
    """Only amplitudes of shorter waves go; nothing is cut below the shortest."""
    kept = without_short_waves(surface, 20e-6)
    assert kept.shortest_wavelength == pytest.approx(4e-3 / 1.5**13)
    assert (kept.scale, kept.plane) == (surface.scale, surface.plane)
    lost = surface.heights(AXIS, AXIS) - kept.heights(AXIS, AXIS)
    assert 0 < lost.std() < 0.5 * kept.heights(AXIS, AXIS).std()
    whole = without_short_waves(surface, 13e-6)
    assert np.array_equal(whole.heights(AXIS, AXIS), surface.heights(AXIS, AXIS))


def test_a_cut_that_leaves_no_wave_is_refused(surface):
    """The sentence names the length and what is allowed."""
    with pytest.raises(InputError, match=r'5000 um, allowed is the longest .*4000 um'):
        without_short_waves(surface, 5e-3)


def test_short_waves_hold_a_gap_that_the_load_closes(contact, surface):
    """The dry gap grows with the waves and shrinks with the load; none is left of long waves."""
    light, heavy = (dry_gap(contact, load, surface) for load in (10.0, 40.0))
    assert 0 < heavy < light < 30e-9
    kept = without_short_waves(surface, 30e-6)
    assert 0 <= dry_gap(contact, 10.0, kept) < 0.3 * light


def test_floor_is_the_share_of_the_gap_that_is_lost(contact, surface):
    """The difference of both gaps times the fitted share; exactly zero without shorter waves."""
    kept = without_short_waves(surface, 20e-6)
    gap = dry_gap(contact, 10.0, surface) - dry_gap(contact, 10.0, kept)
    assert subgrid_floor(contact, 10.0, surface, 20e-6) == pytest.approx(CARRIED * gap)
    assert subgrid_floor(contact, 10.0, kept, 20e-6) == 0.0
