# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs of a roughness spectrum: what is assumed where nothing is stated, what is refused."""

import math

import numpy as np
import pytest
from surrogate.raceway.spectrum import RoughnessSpectrum

FAN = math.radians(20)


def test_cutoffs_and_waves_that_are_not_stated():
    """The long cut-off is that of the table at Ra = 0.8 Rq; waves run down to the short one."""
    for rms, cutoff in ((0.025e-6, 0.08e-3), (0.12e-6, 0.25e-3), (0.13e-6, 0.8e-3)):
        spectrum = RoughnessSpectrum(rms=rms, fractal_dimension=2.5)
        assert spectrum.band.cutoff_long == cutoff
        assert spectrum.band.cutoff_short == 2.5e-6
    stated = RoughnessSpectrum(rms=0.12e-6, fractal_dimension=2.5, cutoff_long=0.8e-3)
    assert stated.band.cutoff_long == 0.8e-3


@pytest.mark.parametrize(('lay', 'centre'), [('longitudinal', 90.0), ('transverse', 0.0)])
def test_the_waves_of_a_lay_fan_about_its_normal(lay, centre):
    """Over the stated angle, evenly to both sides; a single one runs in the middle."""
    many, one = (
        np.degrees(
            RoughnessSpectrum(
                rms=1e-7, fractal_dimension=2.5, lay=lay, fan_angle=FAN, ridges=ridges
            ).directions
        )
        for ridges in (5, 1)
    )
    np.testing.assert_allclose(many - centre, [-10, -5, 0, 5, 10], atol=1e-9)
    np.testing.assert_allclose(one, [centre])


@pytest.mark.parametrize(
    ('changed', 'message'),
    [
        ({'rms': -1e-7}, 'rms_0_1'),
        ({'rms': math.nan}, 'rms_nan_um'),
        ({'cutoff_long': 2e-6}, 'long_cut_off'),
        ({'cutoff_short': 1e-3}, 'long_cut'),
        ({'fractal_dimension': 3.2}, 'fractal_dimension_3'),
        ({'fractal_dimension': 1.9}, 'fractal_dimension_1'),
        ({'fractal_dimension': None}, 'neither_fractal_dimension'),
        ({'rms_slope': 0.0}, 'rms_slope_0'),
        ({'rms': 0.0, 'rms_slope': 0.01}, 'rms_slope_with'),
        ({'lay': 'radial'}, 'lay_radial_isotropic'),
        ({'lay': 'transverse'}, 'fan_angle_missing'),
        ({'fan_angle': FAN}, 'fan_angle_given'),
        ({'lay': 'transverse', 'fan_angle': 2.0}, 'fan_angle_114'),
        ({'scale_ratio': 1.0}, 'scale_ratio_1'),
        ({'ridges': 0}, 'ridges_0'),
    ],
)
def test_inputs_that_no_roughness_has_are_refused(changed, message, refused):
    refused(message, RoughnessSpectrum, **{'rms': 0.12e-6, 'fractal_dimension': 2.5, **changed})
