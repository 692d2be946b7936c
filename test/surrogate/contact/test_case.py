# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Case files: units, defaults and one sentence for each mistake."""

import math

import pytest
from surrogate.contact.case import load_case
from surrogate.parameters import DATA
import yaml

CASES = sorted(path.stem for path in (DATA / 'cases').glob('*.yaml'))
SMALLEST = {
    'radius_x_mm': 2.5888,
    'radius_y_mm': 77.389,
    'reduced_modulus_GPa': 226.37,
    'load_N': 27.6,
    'entrainment_speed_m_s': 0.5,
    'viscosity_Pa_s': 0.06,
    'pressure_viscosity_1_GPa': 20.0,
}
STANDARD = {'patch': 'standard', 'rms_um': 0.12, 'fractal_dimension': 2.5}
ROLLING = {'kinematics': 'rolling', 'roughness': STANDARD}


def write(folder, **keys):
    """Write the smallest case with `keys` changed, without those of None; return its path."""
    content = {key: value for key, value in {**SMALLEST, **keys}.items() if value is not None}
    path = folder / 'case.yaml'
    path.write_text(yaml.safe_dump(content), encoding='utf-8')
    return str(path)


def load(folder, **keys):
    return load_case(write(folder, **keys))


def test_units_and_defaults(tmp_path):
    case = load(tmp_path)
    assert case.contact.radius_x == pytest.approx(2.5888e-3)
    assert case.contact.reduced_modulus == pytest.approx(226.37e9)
    assert case.lubricant.pressure_viscosity == pytest.approx(20e-9)
    assert case.lubricant.eyring_stress == 5e6
    assert case.lubricant.law == 'roelands_dh'
    assert case.film_floor == 3e-9
    assert case.slide_roll_ratio == ()
    assert case.roughness is case.grid is case.domain is None


def test_optional_keys(tmp_path):
    keys = {
        'fluid': 'barus_incompressible',
        'eyring_stress_MPa': 6,
        'slide_roll_ratio': [0.01, 0.05],
        'film_floor_nm': 1.0,
        'grid': {'nx': 65, 'ny': 33},
        'domain': {'inlet': -4.5, 'outlet': 1.5, 'side': 3},
    }
    case = load(tmp_path, **keys)
    assert case == load(tmp_path, **{**keys, 'grid': [65, 33], 'domain': [-4.5, 1.5, 3.0]})
    assert case.slide_roll_ratio == (0.01, 0.05)
    assert case.lubricant.law == 'barus_incompressible'
    assert (case.grid.nx, case.grid.ny) == (65, 33)
    assert case.film_floor == pytest.approx(1e-9)
    assert load(tmp_path, slide_roll_ratio=0.02).slide_roll_ratio == (0.02,)


def test_a_rolling_case(tmp_path):
    rough = {
        'patch': 'standard',
        'rms_um': 0.12,
        'rms_slope_deg': 2.0,
        'cutoff_long_mm': 0.8,
        'cutoff_short_um': 8,
        'lay': 'transverse',
        'fan_angle_deg': 30,
        'ball_grade': 'G10',
    }
    strip = {'width_um': 80, 'columns': 64}
    case = load(tmp_path, kinematics='rolling', transits=6, places=3, strip=strip, roughness=rough)
    assert (case.kinematics, case.transits, case.places) == ('rolling', 6, 3)
    assert (case.strip.place, case.strip.columns) == (0.0, 64)
    assert case.strip.width == pytest.approx(80e-6)
    assert case.roughness.rms_slope == pytest.approx(math.radians(2.0))
    assert case.roughness.fan_angle == pytest.approx(math.radians(30.0))
    assert case.roughness.cutoff_long == pytest.approx(0.8e-3)
    assert case.roughness.cutoff_short == pytest.approx(8e-6)
    assert load(tmp_path).kinematics == 'standing'


@pytest.mark.parametrize('name', CASES)
def test_shipped_cases_load(name):
    case = load_case(name)
    assert case.load > 0
    if name.startswith('nominal'):
        assert case.contact.radius_x == pytest.approx(2.5888e-3, rel=1e-4)


BAD = [
    ({'viscosity_Pa_s': None}, 'missing_key_viscosity_pa_s'),
    ({'speed': 1.0}, 'unknown_key_speed'),
    ({'load_kN': 1.0, 'load_N': None}, 'load_kn_has_wrong'),
    ({'radius_x_mm': 0}, 'radius_x_mm_0_0'),
    ({'radius_y_mm': -3.0}, 'radius_y_mm_3'),
    ({'load_N': 0.0}, 'load_n_0'),
    ({'load_N': -27.6}, 'load_n_27_6'),
    ({'load_N': float('nan')}, 'load_n_nan'),
    ({'load_N': '27.6'}, 'load_n_27'),
    ({'load_N': True}, 'load_n_true_number'),
    ({'entrainment_speed_m_s': -0.5}, 'entrainment_speed_m_s_0_5'),
    ({'pressure_viscosity_1_GPa': 2e-8}, 'pressure_viscosity_1_gpa_2e'),
    ({'fluid': 'water'}, 'fluid_water_roelands_dh'),
    ({'fluid': ['water']}, 'fluid_water'),
    ({'slide_roll_ratio': [0.01, 'fast']}, 'slide_roll_ratio_fast_number'),
    ({'slide_roll_ratio': [-0.1]}, 'slide_roll_ratio_0_1'),
    ({'grid': 129}, 'grid_mapping_keys'),
    ({'grid': {'nx': 129}}, 'grid_missing_key'),
    ({'grid': [129, 64]}, 'grid_ny_64'),
    ({'grid': [129, 65.5]}, 'grid_ny_65'),
    ({'grid': [5, 65]}, 'grid_nx_5'),
    ({'domain': [-4.5, 1.5]}, 'domain_mapping_keys'),
    ({'domain': [4.5, 1.5, 3]}, 'domain_inlet_4'),
    ({'film_floor_nm': 0}, 'film_floor_nm_0'),
    ({'roughness': {'seed': 1}}, 'roughness_missing_key'),
    ({'roughness': {'rms_nm': 1}}, 'roughness_rms_nm_has'),
    ({'roughness': {'rms_um': -0.1}}, 'roughness_rms_um_0'),
    ({'roughness': {'rms_um': 0.1, 'seed': 1.5}}, 'seed_1_5'),
    ({'roughness': {'rms_um': 0.1, 'patch': 'whole'}}, 'patch_whole_rescaled'),
    ({'roughness': {'file': 'a.csv', 'seed': 1}}, 'seed_belongs_generated'),
    ({'roughness': {'file': 'a.csv', 'patch': 'rescaled'}}, 'needs_rms_um_above'),
    (
        {'roughness': {'rms_um': 0.1, 'patch': 'rescaled', 'cutoff_long_mm': 0.8}},
        'cutoff_long_does_belong',
    ),
    ({'roughness': {'rms_um': 0.1, 'ball_grade': 'G10'}}, 'ball_grade_does_belong'),
    ({'roughness': {**STANDARD, 'window_x_mm': 0.2}}, 'window_x_does_belong'),
    ({'roughness': {**STANDARD, 'file': 'a.csv'}}, 'file_does_belong'),
    ({'roughness': {**STANDARD, 'ball_grade': 'G7'}}, 'ball_grade_g7_g3'),
    (
        {'roughness': {**STANDARD, 'ball_grade': 'G10', 'ball_rms_um': 0.1}},
        'ball_rms_ball_grade_given',
    ),
    ({'roughness': STANDARD, 'transits': 4}, 'transits_belongs_kinematics'),
    ({'strip': {'width_um': 80, 'columns': 64}}, 'strip_belongs_kinematics'),
    ({'kinematics': 'sliding'}, 'kinematics_sliding_standing'),
    ({**ROLLING, 'roughness': {'file': 'a.csv'}}, 'surface_measured_one'),
    ({**ROLLING, 'roughness': None}, 'needs_roughness_with'),
    ({**ROLLING, 'roughness': {'rms_um': 0}}, 'needs_roughness_with'),
    (
        {**ROLLING, 'roughness': {'rms_um': 0.1, 'grid_wavelength_um': 20}},
        'grid_wavelength_belongs',
    ),
    ({**ROLLING, 'entrainment_speed_m_s': 0}, 'entrainment_speed_m_s_0'),
    ({**ROLLING, 'slide_roll_ratio': [0.01, 0.02]}, 'slide_roll_ratio_has_2'),
    ({**ROLLING, 'places': 2.5}, 'places_2_5'),
    ({**ROLLING, 'transits': 0.5}, 'transits_0_5'),
    ({**ROLLING, 'strip': {'columns': 64}}, 'strip_missing_key'),
    ({**ROLLING, 'strip': [1.0, 80, 64]}, 'strip_place_1'),
    ({'roughness': {'file': ''}}, 'file_text_empty'),
]


@pytest.mark.parametrize(('keys', 'sentence'), BAD)
def test_bad_cases_are_one_sentence(tmp_path, keys, sentence, refused):
    path = write(tmp_path, **keys)
    with refused(sentence) as caught:
        load_case(path)
    assert str(caught.value).startswith(path)
    assert '\n' not in str(caught.value)


def test_files_that_are_no_cases(tmp_path, refused):
    refused('cases_absent_neither', load_case, 'absent')
    path = tmp_path / 'list.yaml'
    path.write_text('- 1\n', encoding='utf-8')
    refused('mapping_keys_values', load_case, str(path))
    path.write_text('a: [1\n', encoding='utf-8')
    refused('cannot_read_as', load_case, str(path))
