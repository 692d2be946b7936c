# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Heating of the inlet by shear: the published factor, its limits, and what it does to a film."""

from dataclasses import replace
import math

import pytest
from surrogate.ehl import Settings
from surrogate.formulas.film import film_factor_gupta_1992
from surrogate.formulas.inlet_heating import heated_speed, heating_factor, viscosity_slope
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.solve import solve_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
WARM = 313.15


def test_the_factor_by_hand_falls_with_speed_and_rises_with_conductivity():
    """L = 1, p/E' = 0.005, S = 0: 0.934 / 1.213; without heating exactly 1."""
    found = film_factor_gupta_1992(pressure=0.005, loading=1.0, slide_roll=0.0)
    assert found == pytest.approx(0.934 / 1.213)
    assert film_factor_gupta_1992(pressure=0.005, loading=0.0, slide_roll=0.02) == 1.0
    assert viscosity_slope(OIL, WARM) == pytest.approx(0.05, abs=0.01)
    factors = [heating_factor(SCREW, OIL, 'screw', 27.6, us, WARM) for us in (0, 0.1, 1, 10)]
    assert factors[0] == 1.0
    assert factors[0] > factors[1] > factors[2] > factors[3] > 0.5
    other = replace(OIL, thermal_conductivity=0.28)
    assert heating_factor(SCREW, other, 'screw', 27.6, 1.0, WARM) > factors[2]


def test_heated_films_are_thinner_by_the_factor_and_it_is_off_by_default():
    small = Settings(nx=129, ny=65, error_estimate=False)
    cold = ScrewSettings(smooth=small, kinematics='smooth')
    assert not cold.inlet_heating
    point = OperatingPoint(speed=1000 * math.pi / 30, load=0.0, temperature=WARM)
    plain = solve_screw(SCREW, OIL, point, settings=cold)
    heated = solve_screw(SCREW, OIL, point, settings=replace(cold, inlet_heating=True))
    speed, load = plain.entrainment_speed, plain.normal_forces[0]
    factor = heating_factor(SCREW, OIL, 'screw', load, speed, WARM)
    assert factor < 0.985
    ratio = heated.contacts[0].smooth.central_film / plain.contacts[0].smooth.central_film
    assert ratio == pytest.approx(factor, rel=3e-3)
    assert heated.entrainment_speed == speed
    assert heated_speed(SCREW, OIL, 'screw', load, speed, WARM) < speed


def test_beyond_the_fit_the_factor_is_not_known_and_not_applied(refused):
    """Cold oil at 80 m/s: NaN where it is reported, one sentence where it is asked for."""
    cold = 273.15
    assert math.isnan(heating_factor(SCREW, OIL, 'screw', 27.6, 80.0, cold))
    refused('inlet_heating_entrainment', heated_speed, SCREW, OIL, 'screw', 27.6, 80.0, cold)
