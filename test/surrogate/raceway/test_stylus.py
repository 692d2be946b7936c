# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Readings of a stylus: transmissions, waves, the mean over directions, sampled profiles."""

import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.raceway import stylus
from surrogate.raceway.standards import long_cutoff_iso_21920, ProfileBand

BAND = ProfileBand(cutoff_short=2.5e-6, cutoff_long=0.25e-3)
WAVELENGTH = st.floats(2e-6, 2e-3)
SPACING = 0.25e-6


def sampled_wave(wavelength, angle=0.0, amplitude=1e-7):
    """Return a plane wave [m] as a trace at `angle` to it samples it."""
    x = np.arange(6000) * SPACING
    return amplitude * np.cos(2 * math.pi * x * math.cos(angle) / wavelength + 0.7)


def test_half_of_a_wave_at_the_cutoff_passes():
    """ISO 16610-21; the wave twice as long passes by 84 %, that half as long by 6.25 %."""
    cutoff = 0.8e-3
    passed = stylus.gaussian_transmission(2 * math.pi / (cutoff * np.array([1, 2, 0.5])), cutoff)
    np.testing.assert_allclose(passed, [0.5, 0.5**0.25, 0.5**4], rtol=1e-12)
    at_both = stylus.band_transmission(2 * math.pi / np.array([2.5e-6, 0.25e-3]), BAND)
    np.testing.assert_allclose(at_both, [0.5, 0.5], rtol=1e-3)


@pytest.mark.parametrize(
    ('ra', 'cutoff'),
    [
        (0, 0.08),
        (0.02, 0.08),
        (0.021, 0.25),
        (0.1, 0.25),
        (0.11, 0.8),
        (2, 0.8),
        (3, 2.5),
        (20, 8),
    ],
)
def test_long_cutoffs_are_those_of_the_table(ra, cutoff):
    """ISO 4288 table 1, micrometres and millimetres; a limit belongs to the row below it."""
    assert long_cutoff_iso_21920(0.8 * (ra / 0.8) * 1e-6) == pytest.approx(1e-3 * cutoff)


@given(wavelength=WAVELENGTH, angle=st.floats(0, 0.5 * math.pi))
def test_an_oblique_wave_is_read_as_a_longer_one(wavelength, angle):
    """A wave at an angle to the trace is read as q cos t, in height and slope."""
    number = 2 * math.pi / wavelength
    oblique = stylus.read_waves(number * math.cos(angle), BAND)
    expected = stylus.band_transmission(2 * math.pi * math.cos(angle) / wavelength, BAND) ** 2
    assert oblique.height == pytest.approx(expected)
    assert oblique.slope == pytest.approx(expected * (number * math.cos(angle)) ** 2)
    assert oblique.height <= 1


@given(wavelength=WAVELENGTH, short=st.floats(0, 1e-5), long=st.floats(2e-5, 1e-3))
def test_the_mean_over_directions_is_that_of_many_traces(wavelength, short, long):
    """The Bessel functions agree with a sum over evenly spread angles."""
    band = ProfileBand(cutoff_short=short, cutoff_long=long)
    number, angle = 2 * math.pi / wavelength, (np.arange(8192) + 0.5) * math.pi / 8192
    traces = stylus.read_waves(number * np.cos(angle), band)
    mean = stylus.read_all_directions(number, band)
    assert mean.height == pytest.approx(traces.height.mean(), rel=1e-6, abs=1e-12)
    assert mean.slope == pytest.approx(traces.slope.mean(), rel=1e-6, abs=1e-12 * number**2)


def test_an_isotropic_wave_is_read_lower_and_flatter_than_a_ridge():
    """Far inside the band its height is read whole, its slope by 1/sqrt(2): mean of cos^2."""
    band = ProfileBand(cutoff_short=0.0, cutoff_long=1.0)
    number = 2 * math.pi / 1e-5
    mean = stylus.read_all_directions(number, band)
    assert mean.height == pytest.approx(1, rel=1e-4)
    assert mean.slope == pytest.approx(0.5 * number**2, rel=1e-4)


@pytest.mark.parametrize('wavelength', [3e-6, 1e-5, 1e-4, 0.25e-3])
@pytest.mark.parametrize('angle', [0.0, 1.0])
def test_a_sampled_wave_has_the_expected_rms_and_slope(wavelength, angle, traced):
    """The filtered profile of a single wave, over whole periods and without its ends."""
    heights, slopes = traced(sampled_wave(wavelength, angle), SPACING, BAND)
    period = wavelength / math.cos(angle) / SPACING
    whole = slice(round(int(len(slopes) / period) * period))
    reading = stylus.read_waves(2 * math.pi * math.cos(angle) / wavelength, BAND)
    expected = 1e-7 * math.sqrt(reading.height / 2)
    assert np.sqrt(np.mean(heights[whole] ** 2)) == pytest.approx(expected, rel=0.01)
    slope = 1e-7 * math.sqrt(reading.slope / 2)
    assert np.sqrt(np.mean(slopes[whole] ** 2)) == pytest.approx(slope, rel=0.01)


@pytest.mark.parametrize(('short', 'long'), [(1e-3, 1e-4), (1e-6, math.nan), (-1e-6, 1e-3)])
def test_a_band_upside_down_is_refused(short, long, refused):
    refused('cut_off', ProfileBand, cutoff_short=short, cutoff_long=long)
