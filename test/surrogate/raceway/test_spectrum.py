# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs of a roughness spectrum: what is assumed where nothing is stated, what is refused."""

import math

import numpy as np
import pytest
from surrogate.files import InputError
from surrogate.raceway.spectrum import RoughnessSpectrum

FAN = math.radians(20)


def test_cutoffs_and_waves_that_are_not_stated():
    """The long cut-off is that of the table at Ra = 0.8 Rq; waves run between the cut-offs."""
    for rms, cutoff in ((0.025e-6, 0.08e-3), (0.12e-6, 0.25e-3), (0.13e-6, 0.8e-3)):
        spectrum = RoughnessSpectrum(rms=rms, fractal_dimension=2.5)
        assert spectrum.band.cutoff_long == cutoff
        assert spectrum.wavelengths == (cutoff, 2.5e-6)
    stated = RoughnessSpectrum(
        rms=0.12e-6, fractal_dimension=2.5, cutoff_long=0.8e-3, longest_wavelength=4e-3
    )
    assert stated.band.cutoff_long == 0.8e-3
    assert stated.wavelengths == (4e-3, 2.5e-6)


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
        ({'rms': -1e-7}, 'rms is -0.1 um, allowed is 0 or more'),
        ({'rms': math.nan}, 'rms is nan um, allowed'),
        ({'cutoff_long': 2e-6}, r'long cut-off is 2 um, allowed is more than the short one \(2.5'),
        ({'cutoff_short': 1e-3}, 'long cut-off is 250 um, allowed is more than the short one'),
        ({'fractal_dimension': 3.2}, 'fractal dimension is 3.2, allowed is 2.01 to 2.99'),
        ({'fractal_dimension': 1.9}, 'fractal dimension is 1.9, allowed'),
        ({'fractal_dimension': None}, 'neither fractal dimension nor rms slope is given'),
        ({'rms_slope': 0.0}, 'rms slope is 0 deg, allowed is above 0'),
        ({'rms': 0.0, 'rms_slope': 0.01}, 'rms slope is .* with an rms above 0'),
        ({'lay': 'radial'}, "lay is 'radial', allowed is isotropic, longitudinal or transverse"),
        ({'lay': 'transverse'}, 'fan angle is missing, lay is transverse, allowed'),
        ({'fan_angle': FAN}, 'fan angle is given, lay is isotropic, allowed'),
        ({'lay': 'transverse', 'fan_angle': 2.0}, 'fan angle is 114.592 deg, allowed is 0 to 90'),
        ({'scale_ratio': 1.0}, 'scale ratio is 1, allowed is above 1'),
        ({'ridges': 0}, 'number of ridges is 0, allowed is 1, 2'),
        ({'shortest_wavelength': 1e-3}, 'shortest wave is 1000 um, allowed is above 0 and less'),
        ({'longest_wavelength': 2e-6}, 'longest wave is 2 um, allowed is more than 2.5 um'),
    ],
)
def test_inputs_that_no_roughness_has_are_refused(changed, message):
    """One sentence each: what, value, unit, allowed."""
    with pytest.raises(InputError, match=f'^roughness: {message}'):
        RoughnessSpectrum(**{'rms': 0.12e-6, 'fractal_dimension': 2.5, **changed})
