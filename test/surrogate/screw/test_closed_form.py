# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The closed-form tier as a whole: energy, limits, quadrants, published marks."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.ehl import Settings
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.load_sharing import UNLOADING_RATIO
from surrogate.formulas.sliding import ellipse_nodes
from surrogate.parameters import OperatingPoint
from surrogate.screw import closed_form, ScrewSettings, solve_screw
from surrogate.screw.opened import Contacts

RPM = math.pi / 30
WARM = 313.15


def solve(screw, oil, rpm, load, kelvin=WARM):
    return closed_form.solve(Contacts.of(screw), oil, np.asarray(rpm) * RPM, load, kelvin)


def test_ellipse_nodes_integrate_the_hertz_pressure_and_its_moment():
    """Over the unit disk: area pi, sqrt(1 - r^2) gives 2 pi/3, its y^2 moment a fifth of that."""
    x, y, weight = ellipse_nodes()
    pressure = np.sqrt(1 - x * x - y * y)
    assert weight.sum() == pytest.approx(math.pi, rel=1e-12)
    assert weight @ pressure == pytest.approx(2 * math.pi / 3, rel=1e-3)
    assert weight @ (pressure * y * y) == pytest.approx(2 * math.pi / 15, rel=1e-3)


def test_torque_is_the_sum_of_its_parts(screw, oil):
    dragging = replace(screw, parasitic_torque=0.02, parasitic_torque_rate=1e-3)
    result = solve(dragging, oil, 600.0, 1000.0)
    parts = sum(c.sliding_torque + c.rolling_torque for c in result.contacts)
    assert result.friction_torque == pytest.approx(parts + 0.02 + 1e-3 * 600 * RPM, rel=1e-12)
    assert parts == pytest.approx(solve(screw, oil, 600.0, 1000.0).friction_torque, rel=1e-12)


def test_published_marks_of_the_nominal_screw(screw, oil):
    """At 600 rev/min and preload only: 27.6 N per ball, 0.153 um of film, sliding as solved."""
    result = solve(screw, oil, 600.0, 0.0)
    assert result.contacts[0].normal_force == pytest.approx(27.6, abs=0.05)
    assert result.central_film == pytest.approx(0.153e-6, rel=0.05)
    assert sum(c.sliding_torque for c in result.contacts) == pytest.approx(0.015, rel=0.15)


def test_torque_has_an_interior_minimum_and_rcs_falls(screw, oil):
    """Stribeck: the torque falls, then rises with speed; RCS only falls."""
    rpm = np.geomspace(1, 2000, 60)
    result = solve(screw, oil, rpm, 0.0)
    lowest = int(np.argmin(result.friction_torque))
    assert 0 < lowest < len(rpm) - 1
    assert np.all(np.diff(result.friction_torque[:lowest]) < 0)
    assert np.all(np.diff(result.friction_torque[lowest:]) > 0)
    assert np.all(np.diff(result.rcs) <= 0)
    assert np.all(np.diff(result.rcs[result.rcs > 0]) < 0)


def test_a_screw_that_hardly_presses_has_friction_and_one_that_does_not_has_none(screw, oil):
    smooth = replace(screw, preload=0.0, roughness=replace(screw.roughness, rms=0.0))
    lightly, unloaded = (solve(smooth, oil, 300.0, load) for load in (1.0, 0.0))
    assert 0.0 < sum(lightly.normal_forces) < 0.1  # [N] of a ball
    assert 0.0 < lightly.friction_coefficient < 1e-3
    assert unloaded.friction_coefficient == 0.0


def test_at_rest_the_asperities_carry_everything_and_rub_by_the_slip_arm(screw, oil):
    """Torque above the helical part of mu_a times the Hertz-weighted slip arm."""
    rest, crawl = solve(screw, oil, 0.0, 1000.0), solve(screw, oil, 1e-9, 1000.0)
    assert rest.rcs == 1.0
    assert rest.friction_coefficient == pytest.approx(screw.roughness.asperity_friction)
    assert rest.friction_torque == pytest.approx(crawl.friction_torque, rel=1e-3)
    rest = solve(screw, oil, 0.0, 0.0)
    normal = sum(float(c.normal_force) for c in rest.contacts) * screw.loaded_balls_per_nut
    helical = screw.roughness.asperity_friction * normal * no_slip_rates(screw).helical_slip
    assert helical < rest.friction_torque < 2.5 * helical


@given(st.floats(0.0, 2000.0), st.floats(0.0, 3.9), st.floats(283.0, 353.0))
def test_friction_does_not_know_the_direction_of_the_load(rpm, ratio, kelvin):
    from surrogate.parameters import load_lubricant, load_screw

    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    one, other = (solve(screw, oil, rpm, sign * ratio * 990, kelvin) for sign in (1, -1))
    assert one.friction_torque == other.friction_torque > 0
    assert 0 <= one.rcs <= 1


@pytest.mark.parametrize('rpm', [60.0, 300.0])
def test_contacts_touch_as_much_as_solved_ones(screw, oil, rpm):
    """The same law under nearly the same normal forces."""
    point = OperatingPoint(speed=rpm * RPM, load=1000.0, temperature=WARM)
    quick = ScrewSettings(smooth=Settings(nx=65, ny=65, error_estimate=False))
    solved = solve_screw(Contacts.of(screw), oil, point, settings=quick)
    found = solve(screw, oil, rpm, 1000.0)
    assert float(found.rcs) == pytest.approx(solved.rcs, rel=0.02)
    assert float(found.asperity_share) == pytest.approx(solved.asperity_share, rel=0.02)
    assert int(found.worst_contact) == solved.worst_contact


def test_a_share_by_the_film_ratio_takes_the_place_of_the_topography(screw, oil):
    found = closed_form.solve(
        Contacts.of(screw), oil, 300 * RPM, 0.0, WARM, share_of=lambda ratio: 0 * ratio
    )
    assert found.rcs == found.asperity_share == 0.0


def test_an_unloaded_nut_and_no_preload_cost_nothing(screw, oil):
    """At zero load without preload there is no film to speak of and no friction."""
    result = solve(screw, oil, 600.0, 1.01 * UNLOADING_RATIO * screw.preload)
    for contact in result.contacts[2:]:
        assert contact.normal_force == contact.sliding_torque == contact.rolling_torque == 0
        assert np.isnan(contact.central_film)
    assert result.worst_contact in (0, 1)
    assert np.isfinite(result.friction_torque)
    loose = replace(screw, preload=0.0)
    result = solve(loose, oil, 600.0, [0.0, 500.0])
    assert result.friction_torque[0] == 0.0
    assert np.isnan(result.film_ratio[0])
    assert result.film_ratio[1] > 1


def test_many_points_are_many_single_points(screw, oil):
    rpm, load = np.array([10.0, 600.0, 2000.0]), np.array([-3000.0, 0.0, 2000.0])
    many = solve(screw, oil, rpm, load)
    for i in range(3):
        one = solve(screw, oil, rpm[i], load[i])
        assert one.friction_torque == many.friction_torque[i]
        assert one.rcs == many.rcs[i]


def test_worst_contact_is_that_which_touches_most_else_the_thinnest_film(screw, oil):
    """The relieved nut, whose summits are pressed less flat; the tighter, heavier loaded side."""
    touching, lifted = (solve(screw, oil, rpm, 1000.0) for rpm in (300.0, 5000.0))
    assert touching.worst_contact == 3
    assert (float(lifted.rcs), lifted.worst_contact) == (0.0, 0)
