# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Scaled spectra: one factor by the expectation, met by filtered profiles of draws."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.raceway.fractal import PublishedRoughness, wave_spectrum
from surrogate.raceway.fractal_fit import identify_fractal
from surrogate.raceway.scaling import draw_raceway, scale_spectrum, with_shorter_waves
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stylus import read_waves

NOMINAL = PublishedRoughness()
SPECTRUM = RoughnessSpectrum(rms=0.12e-6, cutoff_long=0.25e-3, fractal_dimension=2.68)
SMALL = replace(SPECTRUM, cutoff_long=0.08e-3, fractal_dimension=2.4)
FAN = math.radians(20)
SPACING = 0.4e-6


def over_published(cutoff_long, shortest=2.5e-6):
    """Return the factor on the sum of the nominal datasheet, longest wave 4 mm [-]."""
    spectrum = replace(SPECTRUM, cutoff_long=cutoff_long)
    _, amplitude = wave_spectrum(replace(NOMINAL, shortest_wavelength=shortest))
    scaled = scale_spectrum(spectrum, wavelengths=(4e-3, shortest))
    np.testing.assert_allclose(np.ptp(scaled.amplitude / amplitude), 0, atol=1e-9)
    return scaled.amplitude[0] / amplitude[0]


def traces(scaled, draws, angle, length=0.5e-3, *, across=False):
    """Return profiles [m] of draws, one each, traced at `angle` by turning the surface."""
    places = SPACING * np.arange(round(length / SPACING))
    found = []
    for seed in range(draws):
        surface = draw_raceway(replace(scaled, direction=scaled.direction - angle[seed]), seed)
        axes = ([0.0], places) if across else (places, [0.0])
        found.append(surface.heights(*axes).ravel())
    return np.array(found).T


def test_factors_on_the_nominal_sum():
    """Rq 0.12 um on the sum of D 2.68 with waves from 4 mm: by band, by profile, by cut-off."""
    number, amplitude = wave_spectrum(replace(NOMINAL, shortest_wavelength=2.5e-6))
    inside = 2 * math.pi / number < 0.8e-3
    areal = math.sqrt(0.5 * NOMINAL.ridges * np.sum(amplitude[inside] ** 2))
    assert 0.12e-6 / areal == pytest.approx(1.70, rel=0.01)
    assert 2.1 < over_published(0.8e-3) < 2.3
    assert over_published(0.25e-3) == pytest.approx(3.4, abs=0.05)
    assert over_published(0.25e-3) == pytest.approx(3.4192, abs=1e-4)


def test_the_published_constants_follow():
    """G and the derived sum are those that `wave_spectrum` turns into the same amplitudes."""
    scaled = scale_spectrum(SPECTRUM)
    longest, shortest = SPECTRUM.cutoff_long, SPECTRUM.cutoff_short
    number, amplitude = wave_spectrum(
        replace(
            NOMINAL,
            fractal_roughness=scaled.fractal_roughness,
            sample_length=longest,
            shortest_wavelength=shortest,
        )
    )
    np.testing.assert_allclose(scaled.wave_number, number)
    np.testing.assert_allclose(scaled.amplitude, amplitude)


def test_a_single_ridge_is_scaled_in_closed_form():
    """One wave across the trace, a sqrt(1/2) T = Rq; along a fan each ridge reads q cos t."""
    alone = replace(SPECTRUM, lay='longitudinal', fan_angle=0.0, ridges=1, scale_ratio=10.0)
    waves = 0.25e-3, 20e-6
    scaled = scale_spectrum(alone, wavelengths=waves)
    (wave, _) = scaled.wave_number
    readings = read_waves(scaled.wave_number, alone.band).height
    assert 0.5 * scaled.amplitude**2 @ readings == pytest.approx(alone.rms**2)
    assert wave == pytest.approx(2 * math.pi / 0.25e-3)
    fan = scale_spectrum(replace(alone, fan_angle=FAN, ridges=3), wavelengths=waves)
    total = sum(
        0.5 * fan.amplitude**2 @ read_waves(fan.wave_number * math.cos(turn), alone.band).height
        for turn in (-FAN / 2, 0, FAN / 2)
    )
    assert total == pytest.approx(alone.rms**2)


@pytest.mark.parametrize('ridges', [4, 10, 40])
def test_the_mean_over_traces_stands_for_every_number_of_ridges(ridges):
    """Rq differs between traces by 6 % with 4 ridges, 1 % with 10 and 0.1 % with 40."""
    scaled = scale_spectrum(replace(SPECTRUM, ridges=ridges))
    share = [
        sum(
            0.5 * scaled.amplitude**2 @ read_waves(q, scaled.band).height
            for q in np.outer(np.cos(scaled.direction - turn), scaled.wave_number)
        )
        / scaled.rms**2
        for turn in np.linspace(0, math.pi / ridges, 64, endpoint=False)
    ]
    assert np.mean(share) == pytest.approx(1, rel=2e-4)
    assert np.ptp(np.sqrt(share)) < {4: 0.07, 10: 0.015, 40: 0.001}[ridges]


@pytest.mark.parametrize('lay', ['isotropic', 'longitudinal', 'transverse'])
def test_filtered_profiles_of_draws_have_the_rms_and_slope(lay, traced):
    """Within four standard errors of 200 draws, traced across a lay or in random directions."""
    fan = {} if lay == 'isotropic' else {'fan_angle': FAN}
    scaled = scale_spectrum(replace(SMALL, lay=lay, **fan))
    turn = np.random.default_rng(5).uniform(0, math.pi, 200) * (lay == 'isotropic')
    heights = traces(scaled, 200, turn, across=lay == 'longitudinal')
    rough, slopes = traced(heights, SPACING, scaled.band)
    for found, expected in (
        (np.mean(rough**2, axis=0), scaled.rms**2),
        (np.mean(slopes**2, axis=0), math.tan(scaled.rms_slope) ** 2),
    ):
        error = found.std() / math.sqrt(len(found))
        assert error < 0.03 * expected
        # The slope by seven points falls short by 1 % at the shortest wave.
        assert found.mean() == pytest.approx(expected, abs=4 * error + 0.005 * expected)


def test_one_factor_for_all_draws():
    """Draws differ in their phases alone; the mean of each is 0 and not its height at a place."""
    scaled = scale_spectrum(SPECTRUM)
    one, other = draw_raceway(scaled, 1), draw_raceway(scaled, 2)
    np.testing.assert_array_equal(one.amplitude, other.amplitude)
    assert one.scale == other.scale == 1.0
    assert np.all(one.phase != other.phase)
    again = draw_raceway(scaled, 1, field=1)
    assert np.all(one.phase != again.phase)
    wide = np.linspace(0, 0.1, 300)
    assert abs(one.heights(wide, wide).mean()) < 0.05 * scaled.rms


def test_the_dimension_is_found_again_in_profiles():
    """By the structure function of 32 unfiltered profiles; G within what its error allows."""
    scaled = scale_spectrum(SPECTRUM)
    longest, shortest = SPECTRUM.cutoff_long, SPECTRUM.cutoff_short
    heights = traces(scaled, 32, np.zeros(32), length=1.5e-3)
    constants = replace(NOMINAL, sample_length=longest, shortest_wavelength=shortest)
    found = identify_fractal(heights, SPACING, constants)
    assert found.fractal_dimension == pytest.approx(2.68, abs=0.02)
    made = math.log(found.fractal_roughness / scaled.fractal_roughness)
    assert made == pytest.approx(0, abs=0.5)


@given(rms=st.floats(1e-9, 1e-6), factor=st.floats(0.1, 10), dimension=st.floats(2.1, 2.9))
def test_heights_and_slopes_are_proportional_to_rms(rms, factor, dimension):
    """And G to its power 1/(D-2); nothing else changes."""
    first, second = (
        scale_spectrum(replace(SPECTRUM, rms=value, fractal_dimension=dimension))
        for value in (rms, factor * rms)
    )
    np.testing.assert_allclose(second.amplitude, factor * first.amplitude)
    assert math.tan(second.rms_slope) == pytest.approx(factor * math.tan(first.rms_slope))
    power = math.log(second.fractal_roughness / first.fractal_roughness) * (dimension - 2)
    assert power == pytest.approx(math.log(factor), abs=1e-9)


@given(fan=st.floats(0, 0.5 * math.pi), ridges=st.integers(1, 12))
def test_a_lay_that_is_turned_keeps_its_heights(fan, ridges):
    """It is traced across itself, so that longitudinal and transverse are scaled alike."""
    along, across = (
        scale_spectrum(replace(SPECTRUM, lay=lay, fan_angle=fan, ridges=ridges))
        for lay in ('longitudinal', 'transverse')
    )
    np.testing.assert_allclose(along.amplitude, across.amplitude)
    assert along.rms_slope == pytest.approx(across.rms_slope)
    np.testing.assert_allclose(along.direction - across.direction, 0.5 * math.pi)


@given(dimension=st.floats(2.02, 2.98), cutoff=st.sampled_from([0.08e-3, 0.25e-3, 0.8e-3]))
def test_a_slope_fixes_the_dimension(dimension, cutoff):
    """The rms slope of a dimension gives that dimension back; both together are accepted."""
    by_dimension = replace(SPECTRUM, fractal_dimension=dimension, cutoff_long=cutoff)
    slope = scale_spectrum(by_dimension).rms_slope
    by_slope = scale_spectrum(replace(by_dimension, fractal_dimension=None, rms_slope=slope))
    assert by_slope.fractal_dimension == pytest.approx(dimension, abs=1e-6)
    assert by_slope.rms_slope == pytest.approx(slope)
    assert scale_spectrum(replace(by_dimension, rms_slope=1.005 * slope)).rms_slope == slope


@pytest.mark.parametrize(
    ('changed', 'message'),
    [
        ({'fractal_dimension': None, 'rms_slope': 0.5}, 'rms_slope_28'),
        ({'fractal_dimension': None, 'rms_slope': 1e-3}, 'rms_slope_0'),
        ({'rms_slope': 0.02}, 'fractal_dimension_2'),
    ],
)
def test_slopes_that_no_dimension_has_are_refused(changed, message, refused):
    with refused(message):
        scale_spectrum(replace(SPECTRUM, **changed))


def test_smooth_is_a_roughness():
    scaled = scale_spectrum(RoughnessSpectrum(rms=0.0))
    assert scaled.rms_slope == 0.0
    assert not draw_raceway(scaled, 0).heights(np.arange(5.0), np.arange(3.0)).any()
    assert not with_shorter_waves(RoughnessSpectrum(rms=0.0), 1e-6).amplitude.any()


def test_shorter_waves_add_and_keep_the_draw():
    """One step of 1.5 adds the waves of one length at the dimension that the slope gave."""
    base = replace(SPECTRUM, fractal_dimension=None, rms_slope=math.radians(2.0))
    first, second = scale_spectrum(base), with_shorter_waves(base, base.cutoff_short / 1.5)
    assert second.fractal_dimension == first.fractal_dimension
    assert len(second.wave_number) == len(first.wave_number) + 1
    assert second.rms == first.rms
    ratio = second.amplitude[:-1] / first.amplitude
    np.testing.assert_allclose(ratio, ratio[0])
    assert 0.99 < ratio[0] < 1
    one, other = draw_raceway(first, 3), draw_raceway(second, 3)
    np.testing.assert_array_equal(other.phase[: len(one.phase)], one.phase)


def test_the_sentence_says_what_was_not_stated(says):
    """Filters, slope and dimension; the table where the long cut-off is its own."""
    assert scale_spectrum(SPECTRUM).sentence == says('rq_0_12')
    assert scale_spectrum(replace(SPECTRUM, cutoff_long=None)).sentence == says('rq_0_12_um')
