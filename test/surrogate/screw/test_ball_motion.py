# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Motion of one ball: the table, rigid bodies by vectors, sums, symmetry."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.formulas.geometry import conformity, helix_angle, SIDES
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.parameters import load_screw
from surrogate.screw import ball_motion

SCREW = load_screw('nominal')
ANGLES, RATES = st.floats(0.4, 1.2), st.floats(-100.0, 100.0)
FLANKS = st.sampled_from([1, -1])


def against(screw, side, motion):
    """Return the motion of the ball against one raceway."""
    return ball_motion.relative_motion(
        screw,
        side,
        angle=motion.screw_angle if side == 'screw' else motion.nut_angle,
        flank=motion.flank,
        speed=motion.screw_speed,
        orbit=motion.orbit_rate,
        rotation=motion.rotation,
    )


@pytest.mark.parametrize('flank', [1, -1])
def test_kinematics_table(table, screw, flank):
    """Slip at the centres, orbit and rolling rate of the ball without gross slip."""
    for row in table('kinematics.csv'):
        motion = ball_motion.no_slip_motion(screw, float(row['speed_rpm']) * math.pi / 30, flank)
        assert motion.orbit_rate == pytest.approx(float(row['orbit_rate_rad_s']), abs=6e-4)
        beta, (_, wn, wb) = screw.contact_angle, motion.rotation
        rolling = wb * math.cos(beta) - flank * wn * math.sin(beta)
        assert rolling == pytest.approx(float(row['rolling_rate_rad_s']), rel=5e-4)
        for side in SIDES:
            along, across = ball_motion.slip_field(screw, side, motion, 0.0, 0.0)
            assert along == pytest.approx(0.0, abs=1e-12)
            expected = float(row['helical_slip_per_contact_mm_s'])
            assert abs(across) * 1e3 == pytest.approx(expected, abs=0.006)


@given(RATES, RATES, st.tuples(RATES, RATES, RATES), ANGLES, ANGLES, FLANKS)
def test_slip_is_that_of_two_rigid_bodies(speed, orbit, rotation, first, second, flank):
    """Velocity of the ball less that of the turning screw or the nut, at points of the ellipse."""
    screw = replace(SCREW, conformity_nut=0.55, lead=17e-3)
    motion = ball_motion.BallMotion(
        screw_speed=speed,
        orbit_rate=orbit,
        rotation=rotation,
        screw_angle=first,
        nut_angle=second,
        flank=flank,
    )
    path, axis = screw.pitch_radius / math.cos(helix_angle(screw)), ball_motion.axis_vector(screw)
    for side, own, angle in zip(SIDES, (speed, 0.0), (first, second)):
        e, across = ball_motion.contact_frame(side, angle, flank)
        groove, ball = conformity(screw, side) * screw.ball_diameter, screw.ball_diameter / 2
        radius = 2 * ball * groove / (ball + groove)
        for x, y in ((0.0, 0.0), (4e-5, 3e-4), (-3e-5, 1e-4), (2e-5, -2e-4)):
            point = (ball - y * y / (2 * radius)) * e + np.array([x, 0, 0]) + y * across
            slip = path * (orbit - own) * np.array([1.0, 0, 0]) + np.cross(
                np.array(rotation) - own * axis, point
            )
            found = ball_motion.slip_field(screw, side, motion, x, y)
            assert found[0] == pytest.approx(slip[0], abs=1e-12)
            assert found[1] == pytest.approx(slip @ across, abs=1e-12)


@given(RATES, st.tuples(RATES, RATES, RATES), ANGLES, FLANKS)
def test_spins_add_up_to_that_of_the_screw(speed, rotation, angle, flank):
    """spin_A + spin_B = -s w cos(alpha) sin(beta) for equal angles, however the ball turns."""
    motion = ball_motion.BallMotion(
        screw_speed=speed,
        orbit_rate=0.0,
        rotation=rotation,
        screw_angle=angle,
        nut_angle=angle,
        flank=flank,
    )
    total = sum(against(SCREW, side, motion)[3] for side in SIDES)
    expected = -flank * speed * math.cos(helix_angle(SCREW)) * math.sin(angle)
    assert total == pytest.approx(expected, abs=1e-12)


def test_the_even_split_has_the_spin_of_the_rates(screw):
    for flank in (1, -1):
        motion = ball_motion.no_slip_motion(screw, 10.0, flank)
        for side in SIDES:
            spin = against(screw, side, motion)[3]
            assert spin == pytest.approx(-flank * 10.0 * no_slip_rates(screw).spin, rel=1e-12)


def test_points_keep_their_shape(screw):
    """Any shape of x and y, spread over each other."""
    motion = ball_motion.no_slip_motion(screw, 10.0)
    along, across = ball_motion.slip_field(
        screw, 'nut', motion, np.zeros((3, 1)), np.linspace(0, 1e-4, 4)
    )
    assert along.shape == across.shape == (3, 4)
    single = ball_motion.slip_field(screw, 'nut', motion, 0.0, 1e-4)
    assert along[1, 3] == pytest.approx(float(single[0]), rel=1e-12)


def test_slip_floor_follows_slow_motion_only(screw):
    """1 % of the helical slip, at most 1e-4 m/s, the same both ways."""
    assert ball_motion.slip_floor(screw, 1e3) == ball_motion.slip_floor(screw, -1e3) == 1e-4
    expected = 0.01 * no_slip_rates(screw).helical_slip
    assert ball_motion.slip_floor(screw, 1.0) == pytest.approx(expected)
