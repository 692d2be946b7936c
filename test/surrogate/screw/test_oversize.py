# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A ball between four flanks: Coulomb's limit, statics by hand, energy, the point of a screw."""

from dataclasses import replace
import math

from coulomb import coulomb_traction, hertz_nodes
import numpy as np
import pytest
from surrogate.files import InputError
from surrogate.formulas.geometry import hertz, screw_contact, SIDES
from surrogate.formulas.load_sharing import nut_forces, UNLOADING_RATIO
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import closed_form, rebalance_screw, solve_screw
from surrogate.screw.ball_balance import balance_four_points
from surrogate.screw.ball_equations import BallFlank
from surrogate.screw.ball_motion import axis_vector, contact_frame, slip_floor
from surrogate.screw.opened import Contacts
from surrogate.units import RPM, ZERO_CELSIUS

TWO_NUTS = load_screw('iso3408_40x10')
SCREW = replace(TWO_NUTS, nut='oversize')
OIL = load_lubricant('iso_vg_68')
BALLS, PRELOAD = SCREW.loaded_balls_per_nut, SCREW.preload
SHARE = BALLS * math.sin(SCREW.contact_angle) * axis_vector(SCREW)[2]


def balance(preloads, friction=0.02, speed=10.0, screw=SCREW):
    """Balance an oversize ball under a load in preloads and one friction coefficient."""
    sides = {
        side: coulomb_traction(screw, side, friction, slip_floor=slip_floor(screw, speed))
        for side in SIDES
    }
    return balance_four_points(
        screw,
        speed,
        flanks=tuple(
            BallFlank(side=side, flank=flank, traction=sides[side], rolling_force=0.0)
            for flank in (1, -1)
            for side in SIDES
        ),
        axial_forces=[float(force) / BALLS for force in nut_forces(preloads * PRELOAD, PRELOAD)],
        preload_force=PRELOAD / SHARE,
    )


def parts(pairs):
    """Return the four contacts."""
    return [contact for pair in pairs for contact in (pair.screw, pair.nut)]


def point(preloads, rpm, screw=SCREW):
    """Solve a point at 40 degC under a load in preloads."""
    where = OperatingPoint(speed=rpm * RPM, load=preloads * PRELOAD, temperature=40 + ZERO_CELSIUS)
    return solve_screw(Contacts.of(screw), OIL, where)


def test_without_load_the_ball_turns_about_an_axis_parallel_to_the_screws():
    """
    Planetary gear by hand: the orbit is half the speed of the inner point of contact.

    The centre goes r_m w (1 - g)/2 and the ball rolls on the nut at r_b cos(beta) from its axis,
    so that it turns by (1 - g)/(2 g), backwards. Each flank spins by sin(beta) of what the ball
    turns against it: (1 - g)/(2 g) on the nut, which stands, (1 + g)/(2 g) on the screw. The
    pressed ball rolls on a radius that is smaller by 0.3 %.

    """
    flat = replace(SCREW, lead=1e-3)
    g = 0.5 * flat.ball_diameter * math.cos(flat.contact_angle) / flat.pitch_radius
    pairs = balance(0.0, screw=flat)
    for pair in pairs:
        assert pair.motion.orbit_rate / 10.0 == pytest.approx((1 - g) / 2, rel=5e-3)
        assert pair.motion.rotation[2] / 10.0 == pytest.approx(-(1 - g) / (2 * g), rel=5e-3)
        assert abs(pair.motion.rotation[1]) < 1e-2
        side = math.sin(flat.contact_angle)
        assert abs(pair.nut.spin_rate) / 10.0 == pytest.approx(side * (1 - g) / (2 * g), rel=5e-3)
        on_screw = side * (1 + g) / (2 * g)
        assert abs(pair.screw.spin_rate) / 10.0 == pytest.approx(on_screw, rel=5e-3)


def test_a_spinning_hertz_contact_loses_what_the_textbook_says():
    """Spin torque 3/8 mu Q a E(k) of an ellipse: Johnson; helical slip and bulge are small."""
    friction = 0.02
    pairs = balance(0.0, friction)
    nodes = hertz_nodes()
    for contact, side in zip(parts(pairs), 2 * SIDES, strict=True):
        ellipse = hertz(screw_contact(SCREW, side), contact.normal_force)
        arm = np.hypot(ellipse.semi_axis_x * nodes[0], ellipse.semi_axis_y * nodes[1])
        spin = friction * contact.normal_force * float(arm @ nodes[2])
        assert contact.slip_power == pytest.approx(spin * abs(contact.spin_rate), rel=0.1)


@pytest.mark.parametrize('preloads', [0.0, 0.4, 1.2, 2.2])
def test_little_friction_shares_the_load_as_two_nuts_do(preloads):
    """F^(2/3) of both pairs is twice that of the preload; fixed angles differ by 0.5 %."""
    pairs = balance(preloads, friction=1e-4)
    wanted = [float(force) / SHARE for force in nut_forces(preloads * PRELOAD, PRELOAD)]
    for pair, force in zip(pairs, wanted, strict=True):
        for contact in (pair.screw, pair.nut):
            assert contact.normal_force == pytest.approx(force, rel=0.03, abs=0.005 * wanted[0])


def test_with_little_friction_one_pair_is_idle_beyond_the_unloading_load():
    over = balance(1.05 * UNLOADING_RATIO, friction=1e-4)
    assert max(over[1].screw.normal_force, over[1].nut.normal_force) < 0.01 * (
        over[0].screw.normal_force
    )


@pytest.mark.parametrize('speed', [10.0, -10.0])
@pytest.mark.parametrize('preloads', [0.0, 1.0, 2.3, 2.7, 4.0])
@pytest.mark.parametrize('friction', [0.01, 0.05, 0.1])
def test_forces_on_the_ball_cancel_and_the_torque_follows_from_energy(speed, preloads, friction):
    """Forces added up by hand from the contacts; the torque from loads and from lost power."""
    pairs = balance(preloads, friction, speed)
    assert all(pair.converged for pair in pairs), pairs[0].status
    total = np.zeros(3)
    for pair in pairs:
        for contact, side in ((pair.screw, 'screw'), (pair.nut, 'nut')):
            e, across = contact_frame(side, contact.angle, pair.flank)
            track = np.array([1.0, 0.0, 0.0])
            total += contact.traction_along * track + contact.traction_across * across
            total -= contact.normal_force * e
    scale = pairs[0].screw.normal_force
    # What is left is the centrifugal force.
    assert np.abs(total[[0, 2]]).max() < 1e-9 * scale
    outward = (
        pairs[0].motion.orbit_rate ** 2
        * SCREW.pitch_radius
        * (math.pi / 6 * SCREW.ball.density * SCREW.ball_diameter**3)
    )
    assert total[1] == pytest.approx(outward, rel=1e-5)
    assert sum(pair.axial_force * pair.flank for pair in pairs) == pytest.approx(
        preloads * PRELOAD / BALLS, abs=1e-9 * scale
    )
    loss = sum(pair.loss_torque for pair in pairs)
    torque = sum(pair.torque for pair in pairs)
    assert torque == pytest.approx(sum(pair.energy_torque for pair in pairs), abs=1e-10 * loss)
    ideal = math.copysign(preloads * PRELOAD / BALLS * SCREW.lead / (2 * math.pi), speed)
    assert torque == pytest.approx(ideal + loss, abs=1e-9 * loss)


def test_the_axis_tilts_where_the_lighter_pair_carries_a_few_per_cent():
    """Both pairs spin at a share of 8 %; at 2 % the heavier one hardly does, the other slides."""
    shares = [float(np.divide(*nut_forces(k * PRELOAD, PRELOAD)[::-1])) for k in (2.0, 2.5)]
    assert shares == pytest.approx([0.083, 0.019], abs=1e-3)
    spinning, sliding = balance(2.0), balance(2.5)
    assert abs(spinning[0].nut.spin_rate) > 0.95 * abs(balance(0.0)[0].nut.spin_rate)
    assert abs(sliding[0].nut.spin_rate) < 0.1 * abs(spinning[0].nut.spin_rate)


def test_a_point_of_a_screw_carries_the_load_and_keeps_the_energy():
    """Torque three ways; more friction than two nuts of the same balls, which spin a tenth."""
    for preloads, rpm in ((0.0, 300.0), (1.0, 20.0), (2.7, 300.0)):
        found, two = point(preloads, rpm), point(preloads, rpm, TWO_NUTS)
        assert found.converged, found.status
        assert found.energy_error < 1e-8
        assert found.load_change < 0.02
        assert 1.3 * two.friction_torque < found.friction_torque < 4.0 * two.friction_torque
    idle = [contact for contact in found.contacts if contact.solved is None]
    assert [(contact.nut, contact.side) for contact in idle] == [('relieved', 'screw')]
    assert found.status == 'Solved: oversize balls and their 3 contacts.'


def test_at_rest_a_point_is_the_ball_under_boundary_friction():
    """All load on asperities: a ball by Coulomb's law with that coefficient."""
    found = point(1.0, 0.0)
    pairs = balance(1.0, SCREW.roughness.asperity_friction, speed=1e-3)
    loss = BALLS * sum(pair.loss_torque for pair in pairs)
    assert found.friction_torque == pytest.approx(loss, rel=0.03)


@pytest.mark.parametrize(
    ('preloads', 'rpm'), [(0.0, 1.0), (0.0, 300.0), (1.0, 20.0), (2.0, 1.0), (2.0, 300.0)]
)
def test_formulas_and_solved_contacts_agree_while_both_pairs_press(preloads, rpm):
    """Films of formulas, the motion without load: within 6 %, as of two nuts."""
    formulas = closed_form.solve(
        Contacts.of(SCREW), OIL, rpm * RPM, preloads * PRELOAD, 40 + ZERO_CELSIUS
    )
    solved = point(preloads, rpm)
    assert float(formulas.friction_torque) == pytest.approx(solved.friction_torque, rel=0.06)


@pytest.mark.parametrize(('preloads', 'rpm'), [(2.5, 300.0), (3.5, 5.0)])
def test_beyond_unloading_the_third_flank_presses_as_solved(preloads, rpm):
    """RCS is that of the flank which friction presses; the torque of formulas is no smaller."""
    formulas = closed_form.solve(
        Contacts.of(SCREW), OIL, rpm * RPM, preloads * PRELOAD, 40 + ZERO_CELSIUS
    )
    solved = point(preloads, rpm)
    assert float(formulas.rcs) == pytest.approx(solved.rcs, rel=0.05, abs=1e-3)
    assert 1.0 <= float(formulas.friction_torque) / solved.friction_torque < 2.2


def test_a_point_is_balanced_again_with_another_asperity_friction():
    """As it is solved, also where the ball has left a flank."""
    rough = replace(SCREW, roughness=replace(SCREW.roughness, asperity_friction=0.12))
    for preloads in (1.0, 2.7):
        where = OperatingPoint(
            speed=20 * RPM, load=preloads * PRELOAD, temperature=40 + ZERO_CELSIUS
        )
        again = rebalance_screw(Contacts.of(rough), OIL, where, point(preloads, 20.0))
        solved = solve_screw(Contacts.of(rough), OIL, where)
        assert again.friction_torque == pytest.approx(solved.friction_torque, rel=0.01)


@pytest.mark.parametrize(('nut', 'preload'), [('plain', 100.0), ('oversize', 0.0)])
def test_the_preload_fits_the_nut(nut, preload):
    with pytest.raises(InputError, match=f'preload_N is {preload:g} N with nut {nut}'):
        replace(TWO_NUTS, nut=nut, preload=preload)


def test_a_preload_beyond_what_one_pair_of_flanks_carries_is_refused():
    """Relieved of one pair by 2.83 preloads, the other carries them: at most C0."""
    largest = TWO_NUTS.static_rating / 2.828427
    assert replace(SCREW, preload=0.999 * largest).preload < largest
    with pytest.raises(InputError, match='with nut oversize, allowed is up to 3.333e.04 N'):
        replace(SCREW, preload=1.001 * largest)


def test_a_nut_of_two_flanks_is_stated_as_before_and_oversize_balls_are_not():
    """Surfaces of the one hold for the other, but not for oversize balls."""
    assert replace(TWO_NUTS, nut='offset').stated() == TWO_NUTS.stated()
    assert SCREW.stated() == TWO_NUTS.stated() | {'nut': 'oversize'}
