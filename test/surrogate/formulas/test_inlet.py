# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The inlet of a contact: not fully flooded, and heated by shear, in both tiers alike."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.ehl import Settings
from surrogate.formulas.film import film_factor_gupta_1992, LEAST_FACTOR
from surrogate.formulas.inlet import (
    heating_factor,
    inlet_speed,
    speed_before_inlet,
    SPEED_EXPONENT,
    starved_speed,
    viscosity_slope,
)
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import closed_form
from surrogate.screw.contacts import make_contacts, ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point
from surrogate.screw.solve import solve_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
WARM, COLD = 313.15, 283.15
RPM = math.pi / 30


@pytest.mark.parametrize('factor', [0.05, 0.5, 1.0])
def test_the_isothermal_central_film_is_the_stated_share(screw, oil, factor):
    starved, flooded = (
        closed_form.solve(Contacts.of(one), sheet, [1.0, 50.0], 500.0, WARM, inlet_heating=False)
        for one, sheet in ((screw, replace(oil, film_factor=factor)), (screw, oil))
    )
    np.testing.assert_allclose(starved.central_film, factor * flooded.central_film, rtol=1e-12)
    np.testing.assert_allclose(starved.film_ratio, factor * flooded.film_ratio, rtol=1e-12)
    np.testing.assert_array_equal(starved.entrainment_speed, flooded.entrainment_speed)
    assert np.all(starved.rcs >= flooded.rcs)


def test_a_flooded_contact_keeps_its_speed_to_the_bit(oil):
    assert starved_speed(oil, 0.123456789) == 0.123456789


def test_the_factor_by_hand_falls_with_speed_and_rises_with_conductivity():
    """L = 1, p/E' = 0.005, S = 0: 0.934 / 1.213; without heating exactly 1."""
    found = film_factor_gupta_1992(pressure=0.005, loading=np.array([1.0]), slide_roll=0.0)
    assert found == pytest.approx([0.934 / 1.213])
    assert film_factor_gupta_1992(pressure=0.005, loading=np.array(0.0), slide_roll=0.02) == 1.0
    assert viscosity_slope(OIL, WARM) == pytest.approx(0.05, abs=0.01)
    factors = heating_factor(SCREW, OIL, 'screw', 27.6, [0, 0.1, 1, 10], WARM).tolist()
    assert factors[0] == 1.0
    assert factors[0] > factors[1] > factors[2] > factors[3] > 0.5
    other = replace(OIL, thermal_conductivity=0.28)
    assert heating_factor(SCREW, other, 'screw', 27.6, 1.0, WARM) > factors[2]
    assert heating_factor(SCREW, OIL, 'screw', 27.6, 80.0, 273.15) == LEAST_FACTOR


def test_heated_films_of_the_solver_are_thinner_by_the_factor():
    """By default; the ball moves as fast as without."""
    small = Settings(nx=129, ny=65, error_estimate=False)
    warm = ScrewSettings(smooth=small, kinematics='smooth')
    point = OperatingPoint(speed=1000 * RPM, load=0.0, temperature=WARM)
    plain = solve_screw(OPENED, OIL, point, settings=replace(warm, inlet_heating=False))
    heated = solve_screw(OPENED, OIL, point, settings=warm)
    speed, load = plain.entrainment_speed, plain.normal_forces[0]
    factor = heating_factor(SCREW, OIL, 'screw', load, speed, WARM)
    assert factor < 0.985
    ratio = heated.contacts[0].smooth.central_film / plain.contacts[0].smooth.central_film
    assert ratio == pytest.approx(factor, rel=3e-3)
    assert heated.entrainment_speed == speed


@pytest.mark.parametrize('kelvin', [COLD, WARM, 353.15])
@pytest.mark.parametrize('entrained', [1.0, 2.0, 3.0])
def test_both_tiers_have_one_factor_at_one_entrainment_speed(kelvin, entrained):
    """1 to 3 m/s: films of formulas and the speeds of contacts that are solved fall alike."""
    load, starved = 1000.0, replace(OIL, film_factor=0.7)
    still = closed_form.solve(OPENED, starved, 1.0, load, kelvin)
    speed = entrained / float(still.entrainment_speed)
    heated, cold = (
        closed_form.solve(OPENED, starved, speed, load, kelvin, inlet_heating=given)
        for given in (True, False)
    )
    point = OperatingPoint(speed=speed, load=load, temperature=kelvin)
    sides = make_contacts(OPENED, starved, point, ScrewSettings())
    given = float(starved_speed(starved, entrained))
    for one, other in zip(heated.contacts, cold.contacts, strict=True):
        side = next(side for side in sides if side.side == one.side)
        force = float(one.normal_force)
        factor = float(heating_factor(SCREW, starved, one.side, force, given, kelvin))
        assert 0.4 < factor < 0.999
        assert float(one.central_film / other.central_film) == pytest.approx(factor)
        slowed = side.entrainment(force) / given
        assert slowed**SPEED_EXPONENT == pytest.approx(factor)


def test_a_faster_screw_makes_up_for_a_heated_inlet():
    """The onset stands in the speed of the screw that the contact is slowed from."""
    for side, load, inlet, kelvin in (('screw', 27.6, 0.3, WARM), ('nut', 150.0, 2.0, COLD)):
        speed = speed_before_inlet(SCREW, OIL, side, load, inlet, kelvin)
        found = float(inlet_speed(SCREW, OIL, side, load, speed, kelvin))
        assert found == pytest.approx(inlet, rel=1e-9)
        assert speed > inlet
    begun = onset_point(OPENED, OIL, 0.0, WARM)
    found = closed_form.solve(OPENED, OIL, begun['speed_rad_s'], 0.0, WARM)
    told = begun['entrainment_speed_m_s']
    assert 1 < float(found.entrainment_speed) / told < 1.03
