# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solving cases: the surface that the contact sees, the grid, the solution."""

from dataclasses import replace
import logging

import numpy as np
import pytest
from surrogate.contact.case import load_case
from surrogate.contact.solve import case_settings, case_surface, solve_case
from surrogate.files import InputError
from surrogate.parameters import DATA, load_screw
from surrogate.raceway.fractal import fractal_surface, shifted
from surrogate.raceway.patch import take_patch, Window
import yaml

NOMINAL = DATA / 'cases' / 'nominal_smooth.yaml'


def load(folder, **keys):
    """Return the nominal smooth case with `keys` of the file changed."""
    content = {**yaml.safe_load(NOMINAL.read_text(encoding='utf-8')), **keys}
    path = folder / 'case.yaml'
    path.write_text(yaml.safe_dump(content), encoding='utf-8')
    return load_case(str(path))


def test_what_a_case_states_reaches_the_solver(tmp_path):
    """Grid, domain and floor; a stated domain has no tail of the rolling force."""
    case = load(tmp_path, grid=[65, 33], domain=[-4.5, 1.5, 3], film_floor_nm=1.0)
    settings = case_settings(case, case_surface(case))
    assert (settings.nx, settings.ny, settings.domain) == (65, 33, (-4.5, 1.5, 3.0))
    assert settings.film_floor == pytest.approx(1e-9)
    assert settings.meniscus_length == 0.0
    assert case_settings(load(tmp_path), None).meniscus_length > 0


def test_a_generated_surface_is_that_of_the_nominal_screw(tmp_path):
    """What the case does not state comes from the nominal datasheet; the window from Hertz."""
    case = load(tmp_path, roughness={'rms_um': 0.12, 'seed': 7})
    nominal = load_screw('nominal').roughness
    window = Window(length_x=2 * 40.646e-6, length_y=2 * 360.0e-6)
    expected = take_patch(fractal_surface(nominal, 7), 'rescaled', window, nominal.rms)
    found = case_surface(case)
    x = np.linspace(-4e-5, 4e-5, 9)
    np.testing.assert_allclose(found.heights(x, x), expected.heights(x, x), rtol=1e-3, atol=1e-11)
    assert found.patch == 'rescaled'
    settings = case_settings(case, found)
    assert settings.nx == 129
    assert 401 <= settings.ny <= 513


def test_the_grid_of_a_smooth_case_follows_its_shape_and_error(tmp_path):
    """Wide contacts get nodes across; a film with a large error is solved on a finer grid."""
    assert case_settings(load(tmp_path), None).ny == 65
    assert case_settings(load(tmp_path, radius_y_mm=3.0), None).ny == 257
    wide = {'domain': [-9.0, 1.5, 2.0]}
    coarse, _ = solve_case(load(tmp_path, **wide, grid=[257, 65]))
    found, _ = solve_case(load(tmp_path, **wide))
    assert coarse.film_error > 0.005 > found.film_error
    assert found.settings.nx == 513
    assert found.newton_iterations > coarse.newton_iterations


def test_keys_of_a_generated_surface(tmp_path):
    """Lay, place, window, constants and kind of patch reach the surface."""
    case = load(
        tmp_path,
        roughness={
            'rms_um': 0.2,
            'seed': 3,
            'lay': 'longitudinal',
            'patch': 'cut',
            'position_x_mm': 1.0,
            'window_x_mm': 0.2,
            'window_y_mm': 0.3,
            'shortest_wavelength_um': 30,
            'fractal_dimension': 2.5,
            'ridges': 4,
            'scale_ratio': 1.4,
            'sample_length_mm': 2.0,
            'fractal_roughness_nm': 0.01,
        },
    )
    constants = replace(
        load_screw('nominal').roughness,
        fractal_dimension=2.5,
        ridges=4,
        scale_ratio=1.4,
        sample_length=2e-3,
        fractal_roughness=0.01e-9,
        shortest_wavelength=30e-6,
    )
    draw = shifted(fractal_surface(constants, 3, lay='longitudinal'), 1e-3, 0.0)
    expected = take_patch(draw, 'cut', Window(length_x=0.2e-3, length_y=0.3e-3), 1.0)
    x = np.linspace(-4e-5, 4e-5, 9)
    np.testing.assert_allclose(
        case_surface(case).heights(x, x), expected.heights(x, x), rtol=1e-9, atol=1e-18
    )


def test_no_height_is_smooth(tmp_path):
    """Rq 0 is the smooth contact."""
    assert case_surface(load(tmp_path, roughness={'rms_um': 0})) is None


def test_a_roughness_file_lies_beside_the_case(tmp_path):
    """Cut as measured, or rescaled when the rms is stated; filtered at the shortest wavelength."""
    x = np.arange(0, 2001, 1.0)
    lines = ['x_um,z_um', *(f'{one},{0.1 * np.sin(one / 10)}' for one in x)]
    (tmp_path / 'trace.csv').write_text('\n'.join(lines), encoding='utf-8')
    cut = case_surface(load(tmp_path, roughness={'file': 'trace.csv'}))
    assert (cut.patch, cut.scale) == ('cut', 1.0)
    assert cut.shortest_wavelength == pytest.approx(2e-6)
    keys = {'file': 'trace.csv', 'rms_um': 0.2, 'shortest_wavelength_um': 20}
    rescaled = case_surface(load(tmp_path, roughness=keys))
    assert rescaled.patch == 'rescaled'
    assert rescaled.shortest_wavelength == pytest.approx(20e-6)
    places = np.linspace(-40e-6, 40e-6, 400)
    assert np.std(rescaled.heights(places, [0.0])) == pytest.approx(0.2e-6, rel=0.02)


def test_a_grid_too_coarse_for_the_surface_is_said(tmp_path, caplog):
    """One warning names the node distance and the wavelength."""
    keys = {'roughness': {'rms_um': 0.12}, 'grid': [129, 65]}
    case = load(tmp_path, **keys)
    with caplog.at_level(logging.WARNING, 'surrogate.contact.solve'):
        case_settings(case, case_surface(case))
    (line,) = caplog.messages
    assert 'um apart along y, the shortest wavelength is 9.13 um' in line


def test_solve_smooth_and_rough(tmp_path):
    """A small smooth case, then with a small roughness; the surface comes back with the result."""
    grid = {'grid': [65, 33]}
    smooth, nothing = solve_case(load(tmp_path, **grid))
    assert nothing is None
    assert smooth.converged
    assert smooth.central_film == pytest.approx(150e-9, rel=0.05)
    rough = {'rms_um': 0.01, 'shortest_wavelength_um': 100}
    solution, surface = solve_case(load(tmp_path, **grid, roughness=rough))
    assert solution.converged
    assert surface.patch == 'rescaled'
    assert 0 < abs(solution.central_film / smooth.central_film - 1) < 0.1


@pytest.mark.parametrize(
    ('rough', 'sentence'),
    [
        ({'file': 'absent.csv'}, 'absent.csv: there is no such file'),
        (
            {'rms_um': 0.1, 'shortest_wavelength_um': 500, 'sample_length_mm': 0.4},
            'shortest wavelength is 500 um, allowed is less than the sample length',
        ),
    ],
)
def test_bad_surfaces_are_one_sentence(tmp_path, rough, sentence):
    """What shows only when the surface is made."""
    with pytest.raises(InputError, match=sentence):
        case_surface(load(tmp_path, roughness=rough))


def test_waves_off_the_grid_raise_the_floor(tmp_path):
    """The surface on the grid has longer waves only, and the solution a higher floor."""
    rough = {'rms_um': 0.12, 'seed': 1, 'shortest_wavelength_um': 13, 'grid_wavelength_um': 20}
    case = load(tmp_path, load_N=10.0, entrainment_speed_m_s=0.0, roughness=rough, grid=[65, 129])
    found, surface = solve_case(case)
    assert surface.shortest_wavelength == pytest.approx(20.55e-6, rel=1e-3)
    assert 3.2e-9 < found.settings.film_floor < 10e-9
    assert found.converged, found.status.value


def test_a_measured_file_has_no_waves_to_leave_out(tmp_path):
    """The key belongs to a generated surface."""
    with pytest.raises(InputError, match='grid_wavelength belongs to a generated surface'):
        load(tmp_path, roughness={'file': 'z.csv', 'grid_wavelength_um': 20})
