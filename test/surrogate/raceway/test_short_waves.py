# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Waves that are too short for a grid, and the floor that stands for them."""

import csv
from pathlib import Path

import numpy as np
import pytest
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.short_waves import STANDING, subgrid_floor, wave_rms, without_short_waves

ROUGHNESS = PublishedRoughness(shortest_wavelength=13e-6)
ROOT = Path(__file__).parents[3]
AXIS = np.linspace(-1e-4, 1e-4, 201)


@pytest.fixture(scope='module')
def surface():
    """Return one rescaled draw of the nominal roughness with waves down to 13.7 um."""
    window = Window(length_x=1.2e-4, length_y=1.1e-3)
    return take_patch(fractal_surface(ROUGHNESS, 1), 'rescaled', window, ROUGHNESS.rms)


def test_long_waves_stay_as_they_are_and_some_must_be_left(surface, refused):
    """Only amplitudes of shorter waves go; nothing is cut below the shortest."""
    kept = without_short_waves(surface, 20e-6)
    assert kept.shortest_wavelength == pytest.approx(4e-3 / 1.5**13)
    assert (kept.scale, kept.plane) == (surface.scale, surface.plane)
    lost = surface.heights(AXIS, AXIS) - kept.heights(AXIS, AXIS)
    assert 0 < lost.std() < 0.5 * kept.heights(AXIS, AXIS).std()
    whole = without_short_waves(surface, 13e-6)
    assert np.array_equal(whole.heights(AXIS, AXIS), surface.heights(AXIS, AXIS))
    refused('5000_um_longest', without_short_waves, surface, 5e-3)


def test_rms_of_the_waves_is_that_of_the_formula(theoretical_rms):
    """An unscaled surface has the theoretical Rq of its constants."""
    assert wave_rms(fractal_surface(ROUGHNESS, 0)) == pytest.approx(theoretical_rms(ROUGHNESS))


def test_floor_is_a_share_of_the_waves_that_are_lost(surface):
    """Measured on heights; more waves lost, higher floor; exactly zero when none is."""
    kept = without_short_waves(surface, 20e-6)
    lost = surface.heights(4 * AXIS, 4 * AXIS) - kept.heights(4 * AXIS, 4 * AXIS)
    assert subgrid_floor(surface, 20e-6) == pytest.approx(STANDING * lost.std(), rel=0.1)
    assert subgrid_floor(surface, 30e-6) > subgrid_floor(surface, 20e-6)
    assert subgrid_floor(surface, 13e-6) == 0.0


def resolved_rcs(speed):
    """Return RCS of the draws whose 9.1 um waves were solved, on a grid that resolves them."""
    with (ROOT / 'test' / 'data' / 'resolved_waves.csv').open(newline='') as file:
        rows = list(csv.DictReader(file))
    return {int(r['draw']): float(r['rcs']) for r in rows if abs(float(r['speed']) - speed) < 1e-6}


def test_floor_gives_the_mean_rcs_of_resolved_waves():
    """At 8 mm/s within 20 %; without the floor it is a quarter, with twice its rise double."""
    speed, screw, oil = 2.0 * 10 ** (-12 / 5), load_screw('nominal'), load_lubricant('iso_vg_68')
    contact, known, found = screw_contact(screw, 'screw'), resolved_rcs(speed), []
    ellipse = hertz(contact, 100.0)
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    roughness = PublishedRoughness(shortest_wavelength=9e-6)
    for draw in known:
        whole = take_patch(fractal_surface(roughness, draw), 'rescaled', window, roughness.rms)
        floor = oil.film_floor + subgrid_floor(whole, 20e-6)
        solution = solve_contact(
            contact,
            ContactLubricant(viscosity=oil.viscosity, pressure_viscosity=oil.pressure_viscosity),
            Condition(load=27.6, entrainment_speed=speed),
            roughness=without_short_waves(whole, 20e-6).heights,
            settings=Settings(nx=129, ny=257, film_floor=floor, error_estimate=False),
        )
        found.append(solution.rcs)
    assert len(known) == 4
    assert np.mean(found) == pytest.approx(np.mean(list(known.values())), rel=0.2)
