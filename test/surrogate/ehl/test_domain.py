# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The domain of a contact that states none."""

from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.ehl import Condition, Settings, solve_contact, Status
from surrogate.ehl.case import make_case
import surrogate.ehl.domain
from surrogate.ehl.domain import nodes_at_multiples, production_domain

SLOW = Condition(load=27.6, entrainment_speed=0.01)


def domain(nominal, roughness=None, condition=SLOW):
    """Return inlet, outlet and side over the semi-axes of the nominal contact."""
    case = make_case(*nominal, condition, Settings(), roughness)
    return np.array([*case.domain[:2], case.domain[2] / case.ellipticity])


def bump(x0, y0, height):
    """Return a summit of 5 um radius at a place [m]."""
    return lambda x, y: height * np.exp(-(((x - x0) / 5e-6) ** 2) - ((y - y0) / 5e-5) ** 2)


@pytest.mark.parametrize(
    ('place', 'edge', 'least'),
    [((2.4, 0), 1, 2.4), ((-2.8, 0), 0, -2.8), ((0, 1.8), 2, 1.8), ((0, -1.8), 2, 1.8)],
)
def test_a_summit_that_touches_outside_is_inside_the_domain(nominal, place, edge, least):
    """Behind, before and on both sides; a summit lower than the gap there changes nothing."""
    case = make_case(*nominal, SLOW, Settings(), None)
    x0, y0 = place[0] * case.semi_axis_x, place[1] * case.semi_axis_y
    found = domain(nominal, bump(x0, y0, 5e-6))
    assert abs(found[edge]) > abs(least)
    flat, low = domain(nominal, bump(x0, y0, 0.0)), domain(nominal, bump(x0, y0, 0.2e-6))
    assert low == pytest.approx(flat)


@pytest.mark.parametrize(
    ('reaches', 'ends'), [((0, 0, 0), (-1.4, 1.4, 1.3)), ((0.9, 0.8, 0.7), (-1.9, 1.8, 1.7))]
)
def test_at_rest_the_domain_ends_where_its_summits_do(monkeypatch, reaches, ends):
    """All over the semi-axes, from the middle of the contact."""
    monkeypatch.setattr(surrogate.ehl.domain, '_summit_reaches', lambda *known: reaches)
    still = SimpleNamespace(condition=Condition(load=27.6, entrainment_speed=0.0))
    assert production_domain(still, 0.0) == pytest.approx(ends)


def test_coarseness_is_the_distance_of_the_nodes_over_the_inlet_length(nominal):
    settings = Settings(domain=(-4.0, 2.0, 1.5), nx=61)
    case = make_case(*nominal, SLOW, settings, None)
    distance = 6.0 / 60
    length = case.inlet_length(SLOW.entrainment_speed)
    assert case.coarseness(settings, SLOW.entrainment_speed) * length == pytest.approx(distance)


def test_heights_at_nodes_leave_the_domain_alone(nominal):
    wall = np.full((9, 9), 1e-3)
    assert domain(nominal, wall) == pytest.approx(domain(nominal, lambda x, y: 0 * x))


def test_a_tiny_contact_has_room_for_summits_far_from_it(nominal):
    """A thousandth of the load: the ball rests on a summit four semi-axes beside the middle."""
    light = Condition(load=0.03, entrainment_speed=0.0)
    axis = make_case(*nominal, light, Settings(), None).semi_axis_y
    summit = bump(0.0, 4.0 * axis, 0.3e-6)
    far = Settings(nx=97, ny=129, summit_reach=6.0)
    found = solve_contact(*nominal, light, settings=far, roughness=summit)
    assert found.converged, found.status.value
    assert found.asperity_pressure[:, found.y > 3 * axis].max() > 0


def test_summits_behind_the_contact_are_solved(nominal):
    """A summit at 1.6 semi-axes touches when dry; on the domain of a smooth contact it is cut."""
    case = make_case(*nominal, SLOW, Settings(), None)
    summit = bump(1.6 * case.semi_axis_x, 0.0, 0.4e-6)
    dry = Condition(load=27.6, entrainment_speed=0.0)
    settings = Settings(nx=129, ny=65)
    found = solve_contact(*nominal, dry, settings=settings, roughness=summit)
    assert found.converged, found.status.value
    beyond = found.x > 1.5 * found.semi_axis_x
    assert found.asperity_pressure[beyond].max() > 0
    cut = Settings(nx=129, ny=65, domain=(-1.4, 1.6, 1.3))
    lost = solve_contact(*nominal, dry, settings=cut, roughness=summit)
    assert lost.status is Status.DOMAIN_TOO_SMALL


@given(
    st.floats(1e-6, 2e-5), st.floats(1e-5, 1e-3), st.floats(1.05, 30.0), st.sampled_from([65, 129])
)
def test_nodes_are_at_multiples(spacing, semi_axis, wide, ny):
    """Whole distances over a power of sqrt(2), at least the nodes asked for, few on wide ones."""
    side = wide * semi_axis
    nodes, found = nodes_at_multiples(Settings(ny=ny, spacing=spacing), side, semi_axis)
    distance = 2 * found / (nodes - 1)
    assert nodes % 2 == 1
    assert nodes >= ny
    assert side * (1 - 1e-12) <= found < side + distance * (1 + 1e-12)
    steps = 2 * np.log2(distance / spacing)
    assert steps == pytest.approx(round(steps), abs=1e-6)
    assert nodes <= max(3 + 3.2 * semi_axis / spacing, 3 + np.sqrt(2) * ny)
    if wide <= 1.6 and 2 * side / spacing >= ny - 1:
        assert round(steps) == 0


def test_a_summit_beside_the_middle_is_met_at_one_place_by_all_loads(nominal):
    """Nodes across lie at the same places, and so high is the highest of a ridge between two."""

    def ridge(x, y):
        return 1e-7 * np.cos(2 * np.pi * y / 2e-5) + 0 * x

    settings = Settings(nx=33, ny=65, spacing=4e-6)
    heights = []
    for load in (30.0, 31.0, 40.0):
        case = make_case(*nominal, Condition(load=load, entrainment_speed=0.01), settings, ridge)
        grid = case.grid(case.settings.nx, case.settings.ny, symmetric=False)
        y = grid.y * case.semi_axis_x
        assert y / 4e-6 == pytest.approx(np.round(y / 4e-6), abs=1e-9)
        assert y[-1] >= 1.05 * case.semi_axis_y
        heights.append(case.rough_heights(grid)[:, np.abs(y) < 0.9e-4] * case.height_unit)
    assert all(one == pytest.approx(heights[0]) for one in heights)
