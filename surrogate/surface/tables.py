# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables that the lookup makes once, when a surface is loaded."""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.file import SurfaceData
from surrogate.surface.point import FIELDS, LOGARITHMIC

Array = NDArray[np.float64]
ROUNDING = 1e-9
"""Largest error of a mapped speed [-]."""


def transform(name: str, values: Array) -> Array:
    """Return the values of a field as they are interpolated: films by their logarithm."""
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.log(values) if name in LOGARITHMIC else values


def spread_table(data: SurfaceData) -> Array | None:
    """Return deviations and standard errors of all fields at the nodes; None without spreads."""
    groups = (data.deviations, data.standard_errors)
    if not any(groups):
        return None
    unknown = np.full(data.mask.shape, np.nan)
    return np.stack([group.get(name, unknown) for group in groups for name in FIELDS], axis=-1)


def open_cells(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the cells of which no corner is masked."""
    good = ~mask
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        good = good[tuple(low)] & good[tuple(high)]
    return good


def summary(error: Array) -> tuple[float, float]:
    """Return the largest and the 95th percentile of the measured errors; NaN if none."""
    known = error[np.isfinite(error)]
    if not known.size:
        return math.nan, math.nan
    return float(known.max()), float(np.quantile(known, 0.95))
