# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solving cases: the surface on its grid, the grid, the solution."""

import logging

import numpy as np
import pytest
from surrogate.contact.solve import case_settings, solve_case
from surrogate.contact.surface import case_surface
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window


def test_what_a_case_states_reaches_the_solver_and_too_coarse_a_grid_is_said(load, caplog, says):
    """Grid, domain and floor; a stated domain has no tail of the rolling force."""
    case = load(grid=[65, 33], domain=[-4.5, 1.5, 3], film_floor_nm=1.0)
    settings = case_settings(case, case_surface(case))
    assert (settings.nx, settings.ny, settings.domain) == (65, 33, (-4.5, 1.5, 3.0))
    assert settings.film_floor == pytest.approx(1e-9)
    assert settings.meniscus_length == 0.0
    assert case_settings(load(), None).meniscus_length > 0
    keys = {'roughness': {'rms_um': 0.12}, 'grid': [129, 65]}
    case = load(**keys)
    with caplog.at_level(logging.WARNING, 'surrogate.contact.solve'):
        case_settings(case, case_surface(case))
    (line,) = caplog.messages
    assert says('um_apart_along') in line


def test_a_generated_surface_is_the_published_one(load):
    """What the case does not state is as published; the window comes from Hertz."""
    case = load(roughness={'rms_um': 0.12, 'seed': 7})
    nominal = PublishedRoughness()
    window = Window(length_x=2 * 40.646e-6, length_y=2 * 360.0e-6)
    expected = take_patch(fractal_surface(nominal, 7), 'rescaled', window, nominal.rms)
    found = case_surface(case)
    x = np.linspace(-4e-5, 4e-5, 9)
    np.testing.assert_allclose(found.heights(x, x), expected.heights(x, x), rtol=1e-3, atol=1e-11)
    assert found.patch == 'rescaled'
    settings = case_settings(case, found)
    assert settings.nx == 129
    assert 401 <= settings.ny <= 513


def test_the_grid_of_a_smooth_case_follows_its_shape_and_error(load):
    """Wide contacts get nodes across; a film with a large error is solved on a finer grid."""
    assert case_settings(load(), None).ny == 65
    assert case_settings(load(radius_y_mm=3.0), None).ny == 257
    wide = {'domain': [-9.0, 1.5, 2.0]}
    coarse, _ = solve_case(load(**wide, grid=[257, 65]))
    found, _ = solve_case(load(**wide))
    assert coarse.film_error > 0.005 > found.film_error
    assert found.settings.nx == 513
    assert found.newton_iterations > coarse.newton_iterations


def test_solve_smooth_and_rough(load):
    """A small smooth case, then with a small roughness; the surface comes back with the result."""
    grid = {'grid': [65, 33]}
    smooth, nothing = solve_case(load(**grid))
    assert nothing is None
    assert smooth.converged
    assert smooth.central_film == pytest.approx(150e-9, rel=0.05)
    rough = {'rms_um': 0.01, 'shortest_wavelength_um': 100}
    solution, surface = solve_case(load(**grid, roughness=rough))
    assert solution.converged
    assert surface.patch == 'rescaled'
    assert 0 < abs(solution.central_film / smooth.central_film - 1) < 0.1


def test_waves_off_the_grid_raise_the_floor(load):
    """The surface on the grid has longer waves only, and the solution a higher floor."""
    rough = {'rms_um': 0.12, 'seed': 1, 'shortest_wavelength_um': 13, 'grid_wavelength_um': 20}
    case = load(load_N=10.0, entrainment_speed_m_s=0.0, roughness=rough, grid=[65, 129])
    found, surface = solve_case(case)
    assert surface.shortest_wavelength == pytest.approx(20.55e-6, rel=1e-3)
    assert 3.2e-9 < found.settings.film_floor < 10e-9
    assert found.converged, found.status.value
