# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The reduced peak height against closed forms."""

from statistics import NormalDist

import numpy as np
import pytest
from surrogate.studies.ours import reduced_peak_height

SHARES = (np.arange(20000) + 0.5) / 20000


def test_a_uniform_profile_has_no_peaks():
    """Its material ratio curve is straight."""
    assert reduced_peak_height(np.linspace(-1e-7, 1e-7, 1000)) == pytest.approx(0.0, abs=1e-12)


def test_gaussian_heights():
    """
    Core from the quantile of 0.7, slope 2 q/0.4, extended to the top t = 5 q/2.

    Spk = 2 (pdf(t) - t Q(t))/Q(t), in rms heights.

    """
    normal = NormalDist()
    top = 2.5 * normal.inv_cdf(0.7)
    above = 1 - normal.cdf(top)
    expected = 2 * (normal.pdf(top) - top * above) / above
    heights = np.array([normal.inv_cdf(share) for share in SHARES])
    assert reduced_peak_height(1e-7 * heights) == pytest.approx(1e-7 * expected, rel=5e-3)


def test_peaks_upon_a_plateau():
    """One in ten rises evenly to a height upon a flat: a triangle of that height."""
    heights = np.concatenate([np.zeros(9000), np.linspace(0, 1e-6, 1001)[1:]])
    assert reduced_peak_height(heights) == pytest.approx(1e-6, rel=1e-2)
