# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Traction on a ball: closed forms, derivatives, power, and the same sums as for the contact."""

from dataclasses import fields, replace
import math

from coulomb import coulomb_traction, CoulombTraction, hertz_nodes
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact, Status
from surrogate.ehl.friction import contact_friction, NodeStrengths
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.parameters import load_screw
from surrogate.screw.ball_motion import no_slip_motion, relative_motion, slip_field, slip_maps
from surrogate.screw.ball_traction import (
    _strongest,
    integrate_traction,
    solved_traction,
    SolvedTraction,
)

SCREW = load_screw('nominal')
LAWS = {
    'coulomb': coulomb_traction(SCREW, 'nut', 0.05),
    'solved': SolvedTraction(
        nodes=NodeStrengths(
            x=np.array([-2e-5, 0.0, 3e-5]),
            y=np.array([1e-4, -2e-4, 2e-5]),
            boundary=np.array([0.0, 0.3, 0.0]),
            eyring=np.array([0.2, 0.0, 0.4]),
            rate=np.array([300.0, 0.0, 50.0]),
            limit=np.array([0.1, np.inf, np.inf]),
        ),
        load=20.0,
    ),
}
SLIPS, TURNS = st.floats(-0.02, 0.02), st.floats(-50.0, 50.0)
MOTIONS = st.builds(
    lambda *numbers: np.array(numbers), SLIPS, SLIPS, st.floats(-5.0, 5.0), TURNS, SLIPS
)


@pytest.fixture(scope='module')
def solved():
    """Solve the nominal contact with the nut on a coarse grid and puncture some of it."""
    oil = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
    settings = Settings(nx=65, ny=33, error_estimate=False, refine=False)
    found = solve_contact(
        screw_contact(SCREW, 'nut'),
        oil,
        Condition(load=27.6, entrainment_speed=0.5),
        settings=settings,
    )
    assert found.converged, found.status.value
    film = found.film.copy()
    film[36:50, 14:19] = settings.film_floor
    return replace(found, film=film)


def test_nodes_carry_the_hertz_load():
    """The shares add up to 1, their mean squares are 1/5 each; accuracy is that of 20 by 60."""
    assert hertz_nodes()[0].size == 20 * 60
    x, y, share = hertz_nodes()
    assert share.sum() == pytest.approx(1.0, rel=1e-14)
    assert share @ x**2 == pytest.approx(0.2, rel=1e-13)
    assert share @ y**2 == pytest.approx(0.2, rel=1e-13)


def test_coulomb_ellipse_is_that_of_hertz(screw):
    """The outermost places come close to the semi-axes, which grow with the load."""
    ellipse = hertz(screw_contact(screw, 'screw'), 27.6)
    x, y = coulomb_traction(screw, 'screw', 0.1).places(27.6)
    assert x.max() == pytest.approx(float(ellipse.semi_axis_x), rel=0.01)
    assert y.max() == pytest.approx(float(ellipse.semi_axis_y), rel=0.01)


def test_uniform_slip_gives_the_whole_friction_and_a_higher_floor_less(screw):
    """Force mu Q against the slip, power mu Q V."""
    law = coulomb_traction(screw, 'screw', 0.05)
    wrench = integrate_traction(screw, 'screw', law, 27.6, np.array([0.3, -0.4, 0, 0, 0]))
    assert wrench.values[0] == pytest.approx(-0.6 * 0.05 * 27.6, rel=1e-6)
    assert wrench.values[1] == pytest.approx(0.8 * 0.05 * 27.6, rel=1e-6)
    assert wrench.power == pytest.approx(0.05 * 27.6 * 0.5, rel=1e-6)
    law, motion = coulomb_traction(screw, 'screw', 0.05), np.array([1e-3, 0, 0, 0, 0])
    soft = integrate_traction(screw, 'screw', law, 10.0, motion, slip_floor=1e-2)
    hard = integrate_traction(screw, 'screw', law, 10.0, motion, slip_floor=1e-9)
    assert soft.values[0] == pytest.approx(-0.5 / math.sqrt(101), rel=1e-9)
    assert hard.values[0] == pytest.approx(-0.5 / math.sqrt(1.01), rel=1e-9)


def test_pure_spin_on_a_circle(screw):
    """Moment 3 pi/16 mu Q a: Johnson, Contact Mechanics (1985), section 8.5."""
    x, y, share = hertz_nodes(60, 24)
    law = CoulombTraction(coefficient=0.1, x=1e-4 * x, y=1e-4 * y, share=share, slip_floor=1e-9)
    wrench = integrate_traction(screw, 'screw', law, 1.0, np.array([0, 0, 0, 20.0, 0]))
    assert wrench.values[3] == pytest.approx(-3 * math.pi / 16 * 0.1 * 1e-4, rel=1e-4)


@pytest.mark.parametrize('law', LAWS.values(), ids=LAWS)
@given(motion=MOTIONS, load=st.floats(1.0, 100.0), direction=st.sampled_from([1.0, -1.0]))
def test_derivatives_and_power(law, motion, load, direction):
    def values(at, force):
        return integrate_traction(SCREW, 'nut', law, force, at, direction=direction).values

    found = integrate_traction(SCREW, 'nut', law, load, motion, direction=direction)
    assert found.power == pytest.approx(-found.values @ motion, rel=1e-9, abs=1e-15)
    arm = SCREW.ball_diameter / 2
    size = np.array([1.0, 1.0, arm, 1e-3, arm])  # m/s at a place per rate
    largest = np.outer(size, size) * load / law.slip_floor  # [N s/m] and so on
    assert (np.abs(found.by_motion - found.by_motion.T) <= 1e-14 * largest).all()
    for column, step in enumerate(1e-7 / size):
        move = step * np.eye(5)[column]
        slope = (values(motion + move, load) - values(motion - move, load)) / (2 * step)
        assert (np.abs(slope - found.by_motion[:, column]) <= 1e-6 * largest[:, column]).all()
    step = 1e-5 * load
    slope = (values(motion, load + step) - values(motion, load - step)) / (2 * step)
    assert (np.abs(slope - found.by_load) <= 1e-6 * size).all()


@given(motion=MOTIONS)
def test_the_compiled_sums_are_those_of_the_slip_maps(motion):
    """Forces, moments and power from the maps and the law written out; oil and dry places."""
    law, load = LAWS['solved'], 33.0
    along, across = slip_maps(SCREW, 'nut', *law.places(load))
    slip = np.array([motion @ along, motion @ across])
    speed = np.sqrt((slip**2).sum(axis=0) + law.slip_floor**2)
    nodes = law.nodes
    sheared = np.minimum(nodes.eyring * np.arcsinh(nodes.rate * speed), nodes.limit)
    force = load / law.load * (nodes.boundary + sheared)
    drag = -force * slip / speed
    found = integrate_traction(SCREW, 'nut', law, load, motion)
    assert found.values == pytest.approx(along @ drag[0] + across @ drag[1], rel=1e-9, abs=1e-15)
    assert found.power == pytest.approx(-(drag * slip).sum(), rel=1e-9, abs=1e-18)


@pytest.mark.parametrize('share', [1e-4, 1e-2])
def test_weak_nodes_that_are_left_out_bear_little(solved, share):
    """Friction in a sliding contact falls by no more than the share; many nodes are saved."""
    whole, strong = solved_traction(solved), solved_traction(solved, neglected=share)
    assert strong.nodes.x.size < 0.95 * whole.nodes.x.size
    motion = np.array([0.01, 0.0, 0.0, 0.0, 0.0])
    all_of_it = integrate_traction(SCREW, 'nut', whole, 27.6, motion).values[0]
    most_of_it = integrate_traction(SCREW, 'nut', strong, 27.6, motion).values[0]
    assert (1 - share) * all_of_it >= most_of_it > all_of_it


@pytest.mark.parametrize(
    ('neglected', 'kept'),
    [(0.0, 4), (0.09, 4), (0.1, 4), (0.11, 3), (0.3, 3), (0.31, 2), (0.6, 2), (0.61, 1)],
)
def test_the_weakest_nodes_are_left_out_up_to_the_share(neglected, kept):
    """Of 0, 4, 1, 3 and 2 N; a node that the share just holds stays, one without friction not."""
    found = _strongest(np.array([[0.0, 4.0, 1.0], [3.0, 2.0, 0.0]]), neglected)
    assert found.tolist() == [[False, True, kept > 3], [kept > 1, kept > 2, False]]


def test_a_sample_has_about_the_friction(solved):
    """Every seventh node stands for seven; few nodes and a quadrature stay as they are."""
    law, motion = solved_traction(solved), np.array([0.01, 0.005, 0.0, 20.0, 0.0])
    arrays = {one.name: np.tile(getattr(law.nodes, one.name), 9) for one in fields(law.nodes)}
    many = replace(law, nodes=NodeStrengths(**arrays))
    assert many.sample().nodes.x.size == -(-many.nodes.x.size // 7)
    whole = integrate_traction(SCREW, 'nut', many, 27.6, motion)
    part = integrate_traction(SCREW, 'nut', many.sample(), 27.6, motion)
    assert part.values[:2] == pytest.approx(whole.values[:2], rel=0.02)
    assert law.sample() is law
    assert LAWS['coulomb'].sample() is LAWS['coulomb']


def test_solved_contact_sums_as_its_friction(solved):
    """Forces, spin moment and power of `contact_friction` with the same slip field."""
    motion = no_slip_motion(SCREW, 60.0)
    x, y = np.meshgrid(solved.x, solved.y, indexing='ij')
    along, across = slip_field(SCREW, 'nut', motion, -x, -y)  # entrained against the track
    grid = contact_friction(
        solved, slip_x=-along, slip_y=-across, asperity_friction=0.12, slip_floor=1e-4
    )
    assert grid.asperity_coefficient > 0.003
    assert grid.film_coefficient > 0.003
    law = solved_traction(solved, asperity_friction=0.12)
    moving = relative_motion(
        SCREW,
        'nut',
        angle=motion.nut_angle,
        flank=1,
        speed=60.0,
        orbit=motion.orbit_rate,
        rotation=motion.rotation,
    )
    wrench = integrate_traction(SCREW, 'nut', law, 27.6, moving, direction=-1.0)
    assert wrench.values[0] == pytest.approx(-grid.force_x, rel=1e-10)
    assert wrench.values[1] == pytest.approx(-grid.force_y, rel=1e-10)
    assert wrench.values[3] == pytest.approx(-grid.spin_moment, rel=1e-9)
    assert wrench.power == pytest.approx(grid.power, rel=1e-10)
    half = integrate_traction(SCREW, 'nut', law, 13.8, moving, direction=-1.0)
    np.testing.assert_allclose(half.values, 0.5 * wrench.values, rtol=1e-12)


def test_a_share_from_elsewhere_bears_boundary_friction(solved):
    """The places sum to mu_a times that share of the load, and shear the rest of the oil."""
    smooth = solved_traction(solved, asperity_share=0.0)
    for friction, given_friction in ((0.12, {'asperity_friction': 0.12}), (0.1, {})):
        law = solved_traction(solved, **given_friction, asperity_share=0.25)
        boundary, eyring, *_ = law.strengths(27.6)
        assert boundary.sum() == pytest.approx(0.25 * friction * 27.6, rel=1e-6)
    assert eyring.sum() == pytest.approx(0.75 * smooth.strengths(27.6)[1].sum(), rel=1e-9)


def test_inputs_that_make_no_sense_are_refused(solved, screw, refused):
    refused('without_solved_contact', solved_traction, replace(solved, status=Status.STALLED))
    refused('slip_floor_0', solved_traction, solved, slip_floor=0.0)
