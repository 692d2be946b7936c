# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Identities that any correct smooth solution fulfils without a table."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.ehl import Condition, Settings, solve_contact
from surrogate.ehl.grid import make_grid
from surrogate.ehl.results import _rolling
from surrogate.formulas.geometry import Contact, hertz


def integral(solution, field):
    area = (solution.x[1] - solution.x[0]) * (solution.y[1] - solution.y[0])
    return field.sum() * area


def test_load_pressure_sign_and_symmetry(solved):
    """Load to 1e-6, p >= 0, p even in y, no contact."""
    assert solved.converged, solved.status.value
    assert integral(solved, solved.pressure) == pytest.approx(27.6, rel=1e-6)
    assert solved.pressure.min() >= 0
    assert np.array_equal(solved.pressure, solved.pressure[:, ::-1])
    assert solved.rcs == solved.asperity_share == 0.0
    assert not solved.contact_mask.any()


def test_first_moment_is_the_couette_integral(nominal):
    """Integral of x p = -Rx integral of h dp/dx = -2 Rx rolling force; closed inlet."""
    contact, _ = nominal
    solved = solve_contact(
        *nominal,
        Condition(load=27.6, entrainment_speed=0.5),
        settings=Settings(domain=(-4.5, 1.5, 1.5)),
    )
    moment = integral(solved, solved.x[:, None] * solved.pressure)
    slope = np.gradient(solved.film_pressure, solved.x, axis=0)
    couette = -contact.radius_x * integral(solved, solved.film * slope)
    assert moment == pytest.approx(couette, rel=1e-3)
    assert solved.rolling_force == pytest.approx(-moment / (2 * contact.radius_x), rel=1e-3)
    assert moment < 0 < solved.rolling_force


def test_same_groups_same_answer(solved, nominal):
    contact, oil = nominal
    larger = Contact(
        radius_x=10 * contact.radius_x,
        radius_y=10 * contact.radius_y,
        reduced_modulus=contact.reduced_modulus,
    )
    found = solve_contact(
        larger,
        oil,
        Condition(load=2760.0, entrainment_speed=5.0),
        settings=replace(solved.settings, film_floor=3e-8),
    )
    assert found.central_film == pytest.approx(10 * solved.central_film, rel=1e-6)
    assert found.minimum_film == pytest.approx(10 * solved.minimum_film, rel=1e-6)
    assert found.rolling_force == pytest.approx(100 * solved.rolling_force, rel=1e-5)


def test_dry_smooth_contact_is_hertz(nominal):
    """Speed zero: Hertz's pressure and approach, all load on asperities, no rolling."""
    contact, oil = nominal
    found = solve_contact(
        contact,
        oil,
        Condition(load=27.6, entrainment_speed=0.0),
        settings=Settings(nx=257, ny=129),
    )
    dry = hertz(contact, 27.6)
    assert found.converged, found.status.value
    assert found.max_pressure == pytest.approx(float(dry.max_pressure), rel=5e-3)
    floor = found.settings.film_floor
    assert found.approach + floor == pytest.approx(float(dry.approach), rel=1e-3)
    assert found.rcs == pytest.approx(1.0, abs=1e-6)
    assert found.asperity_share == pytest.approx(1.0, abs=1e-6)
    assert found.rolling_force == found.rolling_tail == 0.0
    area = found.contact_mask.sum() * np.ptp(found.x[:2]) * np.ptp(found.y[:2])
    assert area == pytest.approx(float(np.pi * dry.semi_axis_x * dry.semi_axis_y), rel=0.02)


def test_warm_start_gives_the_cold_answer(solved, nominal):
    """From another load and speed, on another domain, in fewer iterations."""
    contact, oil = nominal
    near = Condition(load=30.0, entrainment_speed=0.4)
    cold = solve_contact(contact, oil, near)
    warm = solve_contact(contact, oil, near, start=solved)
    assert warm.converged, warm.status.value
    assert warm.central_film == pytest.approx(cold.central_film, rel=1e-4)
    assert warm.krylov_iterations < cold.krylov_iterations


@pytest.mark.parametrize(
    ('load', 'speed', 'radius_y'),
    [
        (27.6, 0.5, 77.39e-3),
        (27.6, 0.05, 77.39e-3),
        (5.0, 0.5, 77.39e-3),
        (100.0, 0.5, 10e-3),
        (20.0, 0.5, 3e-3),
    ],
)
def test_production_domain_cuts_nothing_off(nominal, load, speed, radius_y):
    """A domain of 12 half-widths, at the same node distance, moves the film by 0.5 % at most."""
    contact = replace(nominal[0], radius_y=radius_y)
    case = Condition(load=load, entrainment_speed=speed)
    found = solve_contact(
        contact, nominal[1], case, settings=Settings(nx=129, ny=49, error_estimate=False)
    )
    a, b = found.semi_axis_x, found.semi_axis_y
    inlet, outlet, side = found.x[0] / a, found.x[-1] / a, found.y[-1] / b
    dx, dy = (found.x[1] - found.x[0]) / a, (found.y[1] - found.y[0]) / b
    rows, columns = int((12 + inlet) / dx), int((1.6 * side - side) / dy)
    wide = solve_contact(
        contact,
        nominal[1],
        case,
        settings=Settings(
            nx=129 + rows + rows % 2,
            ny=49 + 2 * columns,
            error_estimate=False,
            open_inlet=True,
            domain=(inlet - (rows + rows % 2) * dx, outlet, side + columns * dy),
        ),
    )
    assert found.converged, found.status.value
    assert wide.converged, wide.status.value
    assert found.central_film == pytest.approx(wide.central_film, rel=5e-3)


def test_in_a_gap_of_one_height_rolling_is_half_of_it_times_the_rise_from_the_inlet():
    """The pressure before the first row is a share of that of the second one."""
    grid = make_grid(5, 5, (-2.0, 2.0, 1.0), symmetric=False, compliance=1.0)
    pressure = np.array([0.0, 1.0, 4.0, 2.0, 0.5])[:, None] + np.zeros(grid.shape)
    force = _rolling(grid, np.full(grid.shape, 3.0), pressure, np.full(5, 0.25))
    assert force == pytest.approx(1.5 * (0.5 - 0.25 * 1.0) * 5 * grid.dy)
