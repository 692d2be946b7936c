# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Kinematics: table, vector identities, limits."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.formulas.geometry import curvature_ratio, helix_angle
from surrogate.formulas.kinematics import entrainment_speed_paper, no_slip_rates, slip_arm

ANGLES = st.floats(math.radians(25), math.radians(65))


def test_kinematics_table(table, screw):
    rates = no_slip_rates(screw)
    for row in table('kinematics.csv'):
        speed = float(row['speed_rpm']) * math.pi / 30
        expected = float(row['paper_entrainment_mm_s'])
        assert entrainment_speed_paper(screw, speed) * 1e3 == pytest.approx(expected, abs=0.006)
        wanted = float(row['entrainment_mm_s'])
        assert rates.entrainment * speed * 1e3 == pytest.approx(wanted, abs=0.006)
        found = rates.helical_slip * speed * 1e3
        assert found == pytest.approx(float(row['helical_slip_per_contact_mm_s']), abs=0.006)
        assert rates.orbit * speed == pytest.approx(float(row['orbit_rate_rad_s']), abs=6e-4)
        assert rates.rolling * speed == pytest.approx(float(row['rolling_rate_rad_s']), rel=5e-4)


@given(ANGLES, st.floats(2e-3, 40e-3), st.sampled_from([1.0, -1.0]))
def test_rates_satisfy_the_slip_equations(angle, lead, flank):
    """No slip along the track at A and B, and the spins add up, by vectors in (t, n, b)."""
    from surrogate.parameters import load_screw

    screw = replace(load_screw('nominal'), contact_angle=angle, lead=lead)
    rates, alpha = no_slip_rates(screw), helix_angle(screw)
    ball, radius = screw.ball_diameter / 2, screw.pitch_radius
    axis = np.array([math.sin(alpha), 0.0, math.cos(alpha)])
    to_screw = np.array([0.0, math.cos(angle), flank * math.sin(angle)])
    # The spin part of the ball rotation is free without friction: the even split is chosen.
    across = np.cross([1.0, 0.0, 0.0], to_screw)
    spin = 0.5 * axis @ to_screw
    rotation = rates.rolling * across + spin * to_screw
    at_screw = radius / math.cos(alpha) * np.array([rates.orbit - 1, 0, 0]) + np.cross(
        rotation - axis, ball * to_screw
    )
    at_nut = radius / math.cos(alpha) * np.array([rates.orbit, 0, 0]) + np.cross(
        rotation, -ball * to_screw
    )
    assert at_screw[0] == pytest.approx(0.0, abs=1e-12)
    assert at_nut[0] == pytest.approx(0.0, abs=1e-12)
    assert abs((rotation - axis) @ to_screw) == pytest.approx(rates.spin, rel=1e-9)
    assert abs(rotation @ -to_screw) == pytest.approx(rates.spin, rel=1e-9)


def test_entrainment_is_the_mean_of_both_surfaces_and_slip_helical(screw):
    """Entrainment is 1.2 % below the published w r_m/2, the slip at the centre 2 % of it."""
    g = curvature_ratio(screw)
    exact = no_slip_rates(screw).entrainment
    expected = screw.pitch_radius * (1 - g**2) / (2 * math.cos(helix_angle(screw)))
    assert exact == pytest.approx(expected, rel=1e-14)
    assert exact / entrainment_speed_paper(screw, 1.0) == pytest.approx(0.988, abs=5e-4)
    rates = no_slip_rates(screw)
    assert slip_arm(screw, 'screw', 0.0, 0.0, 0.0) == pytest.approx(rates.helical_slip)
    assert slip_arm(screw, 'screw', 0.0, 0.0, 3e-4) > rates.helical_slip
    assert rates.helical_slip / rates.entrainment == pytest.approx(0.0186, abs=2e-4)


@pytest.mark.parametrize('side', ['screw', 'nut'])
def test_curvature_slip_carries_a_free_ball_neither_on_nor_back(screw, side):
    """Along the track its mean under Hertz pressure vanishes: where spin cancels helical slip."""
    rates, semi_axis = no_slip_rates(screw), 3e-4
    nodes, weights = np.polynomial.legendre.leggauss(20)
    y = semi_axis * nodes
    there, mirrored = slip_arm(
        screw, side, rates.helical_slip / rates.spin, np.array([y, -y]), semi_axis
    )
    curvature = (there**2 - mirrored**2) / (
        4 * rates.spin * y
    )  # the even part of spin + curvature
    pressure = weights * (1 - nodes**2)
    assert pressure @ np.abs(curvature) > 1e-3 * rates.spin * semi_axis
    assert pressure @ curvature == pytest.approx(0.0, abs=1e-9 * (pressure @ np.abs(curvature)))
