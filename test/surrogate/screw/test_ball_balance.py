# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Balance of one ball: the table, a balance by vectors, energy, what every solution shows."""

from dataclasses import fields, replace
import math

from coulomb import coulomb_traction
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.ehl.friction import NodeStrengths
from surrogate.files import InputError
from surrogate.formulas.geometry import conformity, helix_angle, hertz, screw_contact, SIDES
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.sliding import ellipse_nodes
from surrogate.parameters import load_screw
from surrogate.screw import ball_balance
from surrogate.screw.ball_balance import _floors, balance_ball, FIRST_FLOOR
from surrogate.screw.ball_equations import BallFlank, TwoPointBall
from surrogate.screw.ball_motion import axis_vector, contact_frame, slip_field, slip_floor
from surrogate.screw.ball_result import BalanceStatus, BallContact
from surrogate.screw.ball_traction import SolvedTraction

SCREW = load_screw('nominal')
SPEED = 600 * math.pi / 30


def make_screw(radius, lead, ball, angle, first, second):
    """Return a screw with lead and ball relative to the pitch radius."""
    return replace(
        SCREW,
        pitch_radius=radius,
        lead=lead * radius,
        ball_diameter=ball * radius,
        contact_angle=angle,
        conformity_screw=first,
        conformity_nut=second,
    )


CONFORMITIES = st.floats(0.51, 0.57)
SCREWS = st.builds(
    make_screw,
    st.floats(6e-3, 25e-3),
    st.floats(0.2, 1.8),
    st.floats(0.2, 0.45),
    st.floats(math.radians(35), math.radians(55)),
    CONFORMITIES,
    CONFORMITIES,
)
FRICTION, SPEEDS, LOADS = st.floats(0.01, 0.12), st.floats(1.0, 60.0), st.floats(20.0, 200.0)
SIGNS = st.sampled_from([1, -1])
FEW = settings(max_examples=15)


def coulomb(screw, speed, friction, *, floor=None, **given):
    """Balance a ball under one friction coefficient at both contacts."""
    floor = slip_floor(screw, speed) if floor is None else floor
    first, second = (coulomb_traction(screw, side, friction, slip_floor=floor) for side in SIDES)
    return balance_ball(screw, speed, screw_traction=first, nut_traction=second, **given)


@pytest.mark.parametrize('flank', [1, -1])
def test_coulomb_table(table, screw, flank):
    """Loads, angles, orbit, transverse traction and loss, driving and reverse, on both flanks."""
    for row in table('coulomb_balance.csv'):
        speed = SPEED * flank * (1 if row['state'] == 'driving' else -1)
        found = coulomb(screw, speed, 0.05, floor=1e-4, normal_force=27.6, flank=flank)
        number = {key: float(text) for key, text in row.items() if key != 'state'}
        assert found.converged, found.status.value
        assert found.opposing == (row['state'] == 'driving')
        ratio = found.nut.normal_force / found.screw.normal_force
        assert ratio == pytest.approx(number['Q_B_over_Q_A'], abs=1e-4)
        assert math.degrees(found.screw.angle) == pytest.approx(number['beta_A_deg'], abs=0.01)
        assert math.degrees(found.nut.angle) == pytest.approx(number['beta_B_deg'], abs=0.01)
        orbit = found.motion.orbit_rate / speed
        assert orbit == pytest.approx(number['orbit_over_screw_rate'], abs=1e-4)
        across = abs(found.screw.traction_across)
        assert across == pytest.approx(number['transverse_traction_N'], rel=1e-3)
        loss = found.loss_torque * 1e3
        assert loss == pytest.approx(number['loss_torque_per_ball_mNm'], rel=1e-3)


def by_vectors(screw, side, found, friction, floor):
    """Sum force and moments on the ball, about its centre and about the axis, over points."""
    contact = found.screw if side == 'screw' else found.nut
    ellipse = hertz(screw_contact(screw, side), contact.normal_force)
    x, y, weight = ellipse_nodes(80, 240)
    normal = 1.5 / np.pi * contact.normal_force * weight * np.sqrt(1 - x * x - y * y)
    x, y = x * float(ellipse.semi_axis_x), y * float(ellipse.semi_axis_y)
    along, across = slip_field(screw, side, found.motion, x, y)
    share = -friction * normal / np.sqrt(along**2 + across**2 + floor**2)
    e, sideways = contact_frame(side, contact.angle, found.flank)
    track, ball = np.array([1.0, 0, 0]), screw.ball_diameter / 2
    groove = conformity(screw, side) * screw.ball_diameter
    depth = y * y / (2 * (2 * ball * groove / (ball + groove)))
    pulls = np.outer(share * along, track) + np.outer(share * across, sideways)
    points = np.outer(ball - depth, e) + np.outer(x, track) + np.outer(y, sideways)
    push, where = -contact.normal_force * e, ball * e
    from_axis = np.array([0.0, -screw.pitch_radius, 0.0])
    moment = np.cross(points, pulls).sum(axis=0) + np.cross(where, push)
    turning = np.cross(points + from_axis, pulls).sum(axis=0) + np.cross(where + from_axis, push)
    return pulls.sum(axis=0) + push, moment, turning


@FEW
@given(SCREWS, FRICTION, SPEEDS, LOADS, SIGNS, SIGNS)
def test_forces_and_moments_balance_by_vectors(screw, friction, speed, load, sense, flank):
    """A sum over other points, with cross products alone, leaves nothing over."""
    floor = 2e-5 * speed  # soft enough where the spin pole lies within the ellipse
    found = coulomb(screw, sense * speed, friction, floor=floor, normal_force=load, flank=flank)
    assert found.converged, found.status.value
    first, second = (by_vectors(screw, side, found, friction, floor) for side in SIDES)
    mass = math.pi / 6 * screw.ball.density * screw.ball_diameter**3
    axis, turn = axis_vector(screw), np.array(found.motion.rotation)
    orbit, arm = found.motion.orbit_rate, screw.ball_diameter / 2
    outward = np.array([0.0, -mass * orbit**2 * screw.pitch_radius, 0.0])
    gyroscopic = -orbit * np.cross(axis, 0.4 * mass * arm**2 * turn)
    whole = friction * load
    assert first[0] + second[0] + outward == pytest.approx(np.zeros(3), abs=5e-3 * whole)
    assert first[1] + second[1] + gyroscopic == pytest.approx(np.zeros(3), abs=5e-3 * whole * arm)
    torque = math.copysign(1.0, speed * sense) * float(axis @ first[2])
    assert found.torque == pytest.approx(torque, abs=5e-3 * whole * screw.pitch_radius)
    assert found.axial_force == pytest.approx(-flank * float(axis @ first[0]), abs=5e-3 * whole)


@FEW
@given(SCREWS, FRICTION, SPEEDS, LOADS, SIGNS, SIGNS, st.booleans(), st.floats(-0.1, 0.2))
def test_torque_is_load_and_lost_power(screw, friction, speed, load, sense, flank, axial, rolling):
    """(iii) The torque on the screw is F_z L/(2 pi) and the lost power over speed, to rounding."""
    given_load = {'axial_force' if axial else 'normal_force': load}
    drag = 0.3 * rolling * friction * load
    found = coulomb(
        screw,
        sense * speed,
        friction,
        flank=flank,
        screw_rolling_force=drag,
        nut_rolling_force=2 * drag,
        **given_load,
    )
    assert found.converged, found.status.value
    scale = found.axial_force * screw.lead / (2 * math.pi) + found.loss_torque
    assert abs(found.torque - found.energy_torque) <= 1e-9 * scale
    for contact in (found.screw, found.nut):
        assert contact.slip_power > 0
        assert contact.rolling_power * rolling >= 0
    if axial:
        assert found.axial_force == pytest.approx(load, rel=1e-9)


def lever_loss(screw, load):
    """Return by how much of its radius the ball is narrower at the end of the ellipses [-]."""
    ends = [float(hertz(screw_contact(screw, side), load).semi_axis_y) for side in SIDES]
    return 2 * (max(ends) / screw.ball_diameter) ** 2


@FEW
@given(SCREWS, FRICTION, SPEEDS, LOADS, SIGNS, st.floats(0.0, 0.15), st.floats(0.0, 0.15))
def test_a_free_ball_carries_no_net_traction(screw, friction, speed, load, sense, first, second):
    """(i) F_tA = -F_tB; it is what holds the rolling couples, (M_rA + M_rB)/(2 r_b)."""
    forces = (first * friction * load, second * friction * load)
    found = coulomb(
        screw,
        sense * speed,
        friction,
        normal_force=load,
        screw_rolling_force=forces[0],
        nut_rolling_force=forces[1],
    )
    assert found.converged, found.status.value
    held = found.screw.traction_along
    assert held == pytest.approx(-found.nut.traction_along, abs=1e-9 * load)
    couples = sum(
        2 * screw_contact(screw, side).radius_x * force for side, force in zip(SIDES, forces)
    )
    expected = sense * couples / screw.ball_diameter
    # Beside the couples: spin moments through the tilt, and levers that are shorter off the
    # centre line.
    assert held == pytest.approx(expected, abs=(0.003 + lever_loss(screw, load)) * friction * load)


@FEW
@given(SCREWS, FRICTION, SPEEDS, LOADS)
def test_transverse_traction_tilts_the_contact_line(screw, friction, speed, load):
    """(ii) Equal at both contacts, |beta_A - beta_B| = 2 F_perp/Q, turned by reversal."""
    tilts = []
    for sense in (1, -1):
        found = coulomb(screw, sense * speed, friction, normal_force=load)
        assert found.converged, found.status.value
        mass = math.pi / 6 * screw.ball.density * screw.ball_diameter**3
        inertia = mass * screw.pitch_radius * speed**2
        first, second = found.screw.traction_across, found.nut.traction_across
        uneven = inertia + (0.003 + lever_loss(screw, load)) * friction * load
        assert first == pytest.approx(-second, abs=uneven)  # e_p of the nut is the other way
        tilt, expected = found.screw.angle - found.nut.angle, (abs(first) + abs(second)) / load
        assert abs(tilt) == pytest.approx(expected, rel=0.02, abs=2 * inertia / load)
        assert 0.5 * (found.screw.angle + found.nut.angle) == pytest.approx(screw.contact_angle)
        tilts.append(tilt)
    assert tilts[0] > 0 > tilts[1]


@FEW
@given(SCREWS, LOADS, SIGNS)
def test_weak_friction_leaves_the_motion_without_gross_slip(screw, load, flank):
    """Angles, load, orbit and rolling of the no-slip rates; spin and helical slip add up."""
    speed, rates = 1.0, no_slip_rates(screw)
    found = coulomb(screw, speed, 1e-4, normal_force=load, flank=flank)
    assert found.converged, found.status.value
    assert found.screw.angle == pytest.approx(screw.contact_angle, abs=2e-4)
    assert found.nut.normal_force == pytest.approx(load, rel=1e-4)
    loss = lever_loss(screw, load)
    assert found.motion.orbit_rate == pytest.approx(rates.orbit * speed, rel=loss)
    total = -flank * 2 * rates.spin * speed
    assert found.screw.spin_rate + found.nut.spin_rate == pytest.approx(total, rel=2e-3)
    slips = [slip_field(screw, side, found.motion, 0.0, 0.0) for side in SIDES]
    for along, _ in slips:
        assert abs(along) <= 2 * loss * rates.entrainment * speed
    shares = slips[0][1] - slips[1][1]
    assert abs(shares) == pytest.approx(2 * rates.helical_slip * speed, rel=1e-9)


@FEW
@given(SCREWS, FRICTION, SPEEDS, LOADS, SIGNS)
def test_the_other_flank_is_the_same_ball(screw, friction, speed, load, sense):
    """Half a turn about n: t, b, k, flank and speed change sign, nothing else."""
    first = coulomb(screw, sense * speed, friction, axial_force=load, flank=1)
    second = coulomb(screw, -sense * speed, friction, axial_force=load, flank=-1)
    assert first.converged
    for name in ('angle', 'normal_force', 'slip_power'):
        for side in SIDES:
            one, other = (getattr(getattr(ball, side), name) for ball in (first, second))
            assert one == pytest.approx(other, rel=1e-7)
    assert first.torque == pytest.approx(second.torque, rel=1e-7)
    assert first.motion.orbit_rate == pytest.approx(-second.motion.orbit_rate, rel=1e-7)
    turned = np.array(second.motion.rotation) * (-1, 1, -1)
    assert first.motion.rotation == pytest.approx(turned, rel=1e-5, abs=1e-5 * speed)


def test_both_modes_are_one_balance(screw):
    """The axial force that a normal force gives leads back to that normal force."""
    for speed in (SPEED, -SPEED):
        one = coulomb(screw, speed, 0.05, normal_force=27.6)
        other = coulomb(screw, speed, 0.05, axial_force=one.axial_force)
        assert other.screw.normal_force == pytest.approx(27.6, rel=1e-9)
        assert other.loss_torque == pytest.approx(one.loss_torque, rel=1e-8)
        frictionless = 27.6 * math.sin(screw.contact_angle) * math.cos(helix_angle(screw))
        assert one.axial_force != pytest.approx(frictionless, rel=1e-3)


def test_slow_motion_has_a_limit(screw):
    """With a floor that follows the speed, Coulomb friction takes a torque without speed."""
    slow, slower = (coulomb(screw, speed, 0.05, normal_force=27.6) for speed in (1e-2, 1e-5))
    assert slow.loss_torque == pytest.approx(slower.loss_torque, rel=1e-6)
    assert slow.screw.angle == pytest.approx(slower.screw.angle, rel=1e-6)


def test_a_solved_contact_scales_with_its_load(screw):
    """Three places of a film and an asperity: it balances, and energy holds in both modes."""
    nodes = NodeStrengths(
        x=np.array([-2e-5, 0.0, 3e-5]),
        y=np.array([1e-4, -2e-4, 2e-5]),
        boundary=np.array([0.0, 0.3, 0.0]),
        eyring=np.array([0.2, 0.0, 0.4]),
        rate=np.array([300.0, 0.0, 50.0]),
        limit=np.full(3, np.inf),
    )
    law = SolvedTraction(nodes=nodes, load=20.0)
    for given_load in ({'normal_force': 21.0}, {'axial_force': 15.0}):
        found = balance_ball(
            screw,
            SPEED,
            screw_traction=law,
            nut_traction=law,
            screw_rolling_force=0.02,
            nut_rolling_force=0.02,
            **given_load,
        )
        assert found.converged, found.status.value
        assert found.torque == pytest.approx(found.energy_torque, rel=1e-9)
        # Without gross slip the rolling couples take 2 F_roll us.
        rolling = 2 * 0.02 * no_slip_rates(screw).entrainment * SPEED
        assert found.nut.rolling_power == pytest.approx(rolling, rel=0.02)


@pytest.mark.parametrize('friction', [0.5, 1.0, 5.0])
@pytest.mark.parametrize('sense', [1, -1])
def test_absurd_friction_converges_or_says_so(screw, friction, sense):
    """Never a silent last iterate."""
    found = coulomb(screw, sense * SPEED, friction, normal_force=27.6)
    if found.converged:
        assert found.imbalance < 1e-10
        assert found.torque == pytest.approx(found.energy_torque, rel=1e-9)
    else:
        assert_unknown(found)


def assert_unknown(found):
    expected = (BalanceStatus.STALLED, BalanceStatus.OUT_OF_RANGE, BalanceStatus.UNDETERMINED)
    assert found.status in expected
    assert found.motion is None
    assert math.isnan(found.torque)
    assert math.isnan(found.energy_torque)
    assert math.isnan(found.axial_force)
    assert math.isnan(found.loss_torque)
    for contact in (found.screw, found.nut):
        assert all(math.isnan(getattr(contact, field.name)) for field in fields(BallContact))


def test_failures_give_no_numbers(screw, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(ball_balance, 'NEWTON_LIMIT', 1)
        short = coulomb(screw, SPEED, 0.05, normal_force=27.6)
    assert (short.status, short.iterations) == (BalanceStatus.STALLED, 1)
    slippery = coulomb(screw, SPEED, 0.0, normal_force=27.6)
    assert slippery.status is BalanceStatus.UNDETERMINED
    for found in (short, slippery):
        assert_unknown(found)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_the_floor_of_the_slip_follows_a_slow_speed(screw, sign):
    """1 % of the helical slip, at most 1e-4 m/s."""
    helical = no_slip_rates(screw).helical_slip
    knee = 1e-2 / helical
    assert slip_floor(screw, sign * 0.5 * knee) == pytest.approx(0.5e-4, rel=1e-12)
    assert slip_floor(screw, sign * 1.01 * knee) == 1e-4
    assert slip_floor(screw, 0.0) == 0.0


def test_an_unloaded_ball_is_legal(screw):
    for given_load in ({'normal_force': 0.0}, {'axial_force': 0.0}):
        found = coulomb(screw, SPEED, 0.05, **given_load)
        assert found.status is BalanceStatus.UNLOADED
        assert found.converged
        assert found.torque == found.energy_torque == found.loss_torque == 0.0
        assert found.axial_force == found.imbalance == found.power == 0.0
        for one in (found.screw, found.nut):
            left = {one.normal_force, one.traction_along, one.traction_across, one.spin_moment}
            assert left | {one.slip_power, one.rolling_power} == {0.0}
        assert found.motion is None


@pytest.mark.parametrize(
    ('given_input', 'text'),
    [
        ({'speed': 0.0, 'normal_force': 1.0}, 'speed is 0.0 rad/s'),
        ({'speed': math.nan, 'normal_force': 1.0}, 'speed is nan rad/s'),
        ({'flank': 2, 'normal_force': 1.0}, 'flank is 2'),
        ({}, 'either normal_force or axial_force'),
        ({'normal_force': 1.0, 'axial_force': 1.0}, 'either normal_force or axial_force'),
        ({'normal_force': -1.0}, 'normal_force is -1.0 N'),
        ({'axial_force': math.inf}, 'axial_force is inf N'),
        ({'axial_force': 1.0, 'nut_rolling_force': math.nan}, 'nut_rolling_force is nan N'),
    ],
)
def test_inputs_that_make_no_sense_are_refused(screw, given_input, text):
    laws = {f'{side}_traction': coulomb_traction(screw, side, 0.05) for side in SIDES}
    with pytest.raises(InputError, match=text):
        balance_ball(screw, **{'speed': SPEED, **laws, **given_input})


@pytest.mark.parametrize('ratio', [10.0, 3.0, 1.5, math.inf])
def test_floors_fall_by_a_ratio_from_far_above_the_slip_to_that_of_the_problem(screw, ratio):
    """The last stage has the lower floor of both laws; an infinite ratio leaves no other."""
    laws = [coulomb_traction(screw, side, 0.05, slip_floor=f) for side, f in zip(SIDES, (1e-4, 1))]
    problem = TwoPointBall(
        screw=screw,
        speed=-SPEED,
        flanks=tuple(
            BallFlank(side=side, flank=1, traction=law, rolling_force=0.0)
            for side, law in zip(SIDES, laws)
        ),
        force_unit=27.6,
        axial_force=None,
    )
    floors = _floors(problem, ratio)
    assert floors[-1] == problem.slip_floor
    far = FIRST_FLOOR * no_slip_rates(screw).helical_slip * SPEED
    assert far > 1e-3
    assert (len(floors) == 1) is math.isinf(ratio)
    if len(floors) > 1:
        assert floors[0] >= far > floors[0] / ratio
        assert floors[:-1] == pytest.approx(
            [1e-4 * ratio**n for n in range(len(floors) - 1, 0, -1)]
        )


def test_a_ball_is_solved_to_the_tolerances_that_are_measured():
    """Another tolerance, stage or damping is measured again."""
    stages = ball_balance.STAGE_RATIOS, ball_balance.STAGE_TOLERANCE, FIRST_FLOOR
    assert stages == ((10.0, 3.0, 1.5, math.inf), 0.2, 3.0)
    assert (ball_balance.SMALLEST_DAMPING, ball_balance.LARGEST_CONDITION) == (1 / 64, 1e14)
    assert (ball_balance.STEP_TOLERANCE, ball_balance.BALANCE_TOLERANCE) == (1e-8, 1e-10)
    assert ball_balance.NEWTON_LIMIT == 40
