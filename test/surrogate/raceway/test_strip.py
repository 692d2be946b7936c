# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Strips: blocks of rows at any place along the track are the heights of their surface."""

import numpy as np
import pytest
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness, shifted
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum

RACEWAY = draw_raceway(scale_spectrum(RoughnessSpectrum(rms=1e-7, fractal_dimension=2.5)), 4)
Y = np.linspace(-4e-4, 4e-4, 33)


def test_blocks_are_the_heights_of_the_surface():
    """Put together they are the whole, also of a patch with its plane and scale."""
    window = Window(length_x=1e-4, length_y=8e-4)
    patch = take_patch(fractal_surface(PublishedRoughness(), 1), 'rescaled', window, 1e-7)
    x = np.linspace(-1e-4, 3e-4, 50)
    for surface in (RACEWAY, patch):
        strip = surface.strip(Y)
        blocks = [strip.rows(part) for part in np.array_split(x, 4)]
        np.testing.assert_allclose(np.concatenate(blocks), surface.heights(x, Y), atol=1e-20)


def test_a_strip_goes_on_without_end():
    """A metre along the track it is the surface moved there, and as rough as at its start."""
    x = 1e-6 * np.arange(200)
    far = RACEWAY.strip(Y).rows(1.0 + x)
    np.testing.assert_allclose(far, shifted(RACEWAY, 1.0, 0.0).heights(x, Y), atol=1e-14)
    places = np.arange(0.0, 0.4, 1.3e-3)
    start, later = (np.std(RACEWAY.strip(Y).rows(where + places)) for where in (0.0, 2.0))
    assert later == pytest.approx(start, rel=0.1)
