# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of cases: by formula, by the standard, measured, and what is said of them."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.contact.case import CaseRoughness
from surrogate.contact.surface import case_surface, composite_rms, level_surface, roughness_words
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness, shifted
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.short_waves import wave_rms
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.standards import ball_rms

STANDARD = {'patch': 'standard', 'rms_um': 0.12, 'fractal_dimension': 2.5}


def test_keys_of_a_generated_surface(load):
    """Lay, place, window, constants and kind of patch reach the surface; Rq 0 is smooth."""
    case = load(
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
        }
    )
    constants = PublishedRoughness(
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
    wanted = expected.heights(x, x)
    np.testing.assert_allclose(case_surface(case).heights(x, x), wanted, rtol=1e-9, atol=1e-18)
    assert case_surface(load(roughness={'rms_um': 0})) is None


def test_a_roughness_file_lies_beside_the_case(load, tmp_path):
    """Cut as measured, or rescaled when the rms is stated; filtered at the shortest wavelength."""
    x = np.arange(0, 2001, 1.0)
    lines = ['x_um,z_um', *(f'{one},{0.1 * np.sin(one / 10)}' for one in x)]
    (tmp_path / 'trace.csv').write_text('\n'.join(lines), encoding='utf-8')
    cut = case_surface(load(roughness={'file': 'trace.csv'}))
    assert (cut.patch, cut.scale) == ('cut', 1.0)
    assert cut.shortest_wavelength == pytest.approx(2e-6)
    keys = {'file': 'trace.csv', 'rms_um': 0.2, 'shortest_wavelength_um': 20}
    rescaled = case_surface(load(roughness=keys))
    assert rescaled.patch == 'rescaled'
    assert rescaled.shortest_wavelength == pytest.approx(20e-6)
    places = np.linspace(-40e-6, 40e-6, 400)
    assert np.std(rescaled.heights(places, [0.0])) == pytest.approx(0.2e-6, rel=0.02)


@pytest.mark.parametrize(
    ('rough', 'sentence'),
    [
        ({'file': 'absent.csv'}, 'absent_there_such'),
        ({'file': 'z.csv', 'grid_wavelength_um': 20}, 'grid_wavelength_belongs'),
        (
            {'rms_um': 0.1, 'shortest_wavelength_um': 500, 'sample_length_mm': 0.4},
            'shortest_wavelength_500',
        ),
    ],
)
def test_bad_surfaces_are_one_sentence(load, rough, sentence, refused):
    with refused(sentence):
        case_surface(load(roughness=rough))


def standard(load, **keys):
    case = load(roughness={**STANDARD, **keys})
    return case.roughness, case_surface(case)


def test_a_surface_by_the_standard(load):
    """It is one draw of the scaled spectrum, by no window levelled or scaled."""
    _, found = standard(
        load,
        seed=7,
        cutoff_long_mm=0.8,
        cutoff_short_um=8.0,
        lay='longitudinal',
        fan_angle_deg=30.0,
        scale_ratio=1.4,
        ridges=6,
        position_x_mm=1.0,
    )
    spectrum = RoughnessSpectrum(
        rms=0.12e-6,
        cutoff_long=0.8e-3,
        cutoff_short=8e-6,
        fractal_dimension=2.5,
        lay='longitudinal',
        fan_angle=math.radians(30),
        scale_ratio=1.4,
        ridges=6,
    )
    expected = shifted(draw_raceway(scale_spectrum(spectrum), 7), 1e-3, 0.0)
    x = np.linspace(-4e-5, 4e-5, 9)
    np.testing.assert_allclose(found.heights(x, x), expected.heights(x, x), atol=1e-18)
    assert found.patch is None


def test_the_slope_fixes_the_dimension(load):
    """The sentence has the stated slope and, for a cut-off by the table, says that."""
    rough, found = standard(load, fractal_dimension=2.5)
    words = roughness_words(rough, found)
    assert 'by the table for Ra = 0.8 Rq, not stated' in words
    slope = float(words.split('rms slope ')[1].split(' deg')[0])
    keys = {'patch': 'standard', 'rms_um': 0.12, 'rms_slope_deg': slope}
    case = load(roughness=keys)
    assert 'D 2.5' in roughness_words(case.roughness, case_surface(case)).replace('2.49', '2.5')
    assert ', G ' in words


def test_waves_left_out_are_said_and_a_ball_adds_its_roughness(load):
    """Rms of what is left out or added: the root of the sum of squares."""
    _, whole = standard(load, seed=2)
    rough, found = standard(load, seed=2, shortest_wavelength_um=20)
    assert found.shortest_wavelength >= 20e-6
    words = roughness_words(rough, found)
    lost = float(words.split('rms ')[-1].split(' nm')[0]) * 1e-9
    assert math.hypot(lost, wave_rms(found)) == pytest.approx(wave_rms(whole), rel=1e-3)
    bare, alone = standard(load)
    by_rms, both = standard(load, ball_rms_um=0.05)
    assert composite_rms(bare) == pytest.approx(0.12e-6)
    assert composite_rms(by_rms) == pytest.approx(math.hypot(0.12e-6, 0.05e-6))
    assert wave_rms(both) > wave_rms(alone)
    by_grade, _ = standard(load, ball_grade='G10')
    assert composite_rms(by_grade) == pytest.approx(math.hypot(0.12e-6, ball_rms('G10')))
    assert 'ball G10 Rq 0.025 um' in roughness_words(by_grade, both)


@pytest.mark.parametrize(
    ('keys', 'sentence'),
    [
        ({'fractal_dimension': None}, 'neither_fractal_dimension'),
        ({'rms_slope_deg': 1.0}, 'fractal_dimension_2'),
        ({'lay': 'longitudinal'}, 'fan_angle_missing'),
        ({'fan_angle_deg': 10.0}, 'fan_angle_given'),
        ({'cutoff_long_mm': 0.002}, 'long_cut_off'),
        ({'shortest_wavelength_um': 1.0}, 'shortest_wavelength_1'),
        ({'shortest_wavelength_um': 900.0}, 'shortest_wave_grid'),
    ],
)
def test_bad_surfaces_by_the_standard(load, keys, sentence, refused):
    content = {one: value for one, value in {**STANDARD, **keys}.items() if value is not None}
    with refused(sentence) as caught:
        case_surface(load(roughness=content))
    assert '\n' not in str(caught.value)


def test_a_level_surface_has_no_slope(load):
    """Its waves are those of the patch about their own mean."""
    rough = CaseRoughness(rms=0.12e-6, seed=1)
    patch = case_surface(replace(load(), roughness=rough))
    level = level_surface(patch)
    assert patch.plane[1] != 0.0
    assert level.plane[1:] == (0.0, 0.0)
    x = np.linspace(-2e-5, 2e-5, 11)
    difference = level.heights(x, x) - patch.heights(x, x)
    curved = np.diff(difference, n=2, axis=0)
    np.testing.assert_allclose(curved, 0.0, atol=1e-17)
    period = 2 * math.pi / np.abs(level.wave_number_x[level.wave_number_x != 0]).min()
    far = level.heights(np.linspace(0.0, 40 * period, 4001), [0.0])
    assert abs(far.mean()) < 0.05 * far.std()
