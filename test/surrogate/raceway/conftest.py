# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Filtered traces of heights, and Rq of the published sum in closed form."""

import math

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

DERIVATIVE = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60
"""Weights of the local slope at seven neighbours over their spacing, ISO 21920-2 [-]."""


@pytest.fixture
def traced():
    """Return filtered heights [m] and slopes of traces along axis 0, without their ends."""

    def filtered(heights, spacing, band):
        smooth = [
            math.sqrt(math.log(2) / 2) / math.pi * cutoff / spacing  # ISO 16610-21
            for cutoff in (band.cutoff_short, band.cutoff_long)
        ]
        rough = gaussian_filter1d(heights, smooth[0], axis=0, mode='nearest')
        rough = rough - gaussian_filter1d(rough, smooth[1], axis=0, mode='nearest')
        rough = rough[slice(end := math.ceil(4 * sum(smooth)), -end)]
        last = len(rough) - 6
        slope = sum(weight * rough[slice(at, at + last)] for at, weight in enumerate(DERIVATIVE))
        return rough, slope / spacing

    return filtered


@pytest.fixture
def theoretical_rms():
    """Return the function that gives Rq of the published sum [m], the mean over draws."""

    def rms(roughness):
        g, length = roughness.scale_ratio, roughness.sample_length
        falls = g ** (-2 * (3 - roughness.fractal_dimension))
        last = math.floor(math.log(length / roughness.shortest_wavelength) / math.log(g))
        strength = (roughness.fractal_roughness / length) ** (2 * roughness.fractal_dimension - 4)
        waves = (1 - falls ** (last + 1)) / (1 - falls)
        return math.sqrt(0.5 * math.log(g) * length**2 * strength * waves)

    return rms
