# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Local C1 monotone cubic Hermite interpolation on a rectilinear grid.

Slopes are those of Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300: zero at extrema,
so that data which rise keep rising between the nodes. At a break node the axis is cut: each side
takes its own one-sided slope, which keeps a kink a kink. Needs numpy only.

"""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def monotone_slopes(nodes: Array, values: Array, axis: int = 0) -> Array:
    """
    Return the slope at each of the `nodes` of `values` along `axis`; same shape as `values`.

    A NaN value is a hole: slopes beside it are one-sided.

    """
    values = np.moveaxis(values, axis, 0)
    width = np.diff(nodes).reshape((-1,) + (1,) * (values.ndim - 1))
    secant = np.diff(values, axis=0) / width
    slopes = np.full_like(values, np.nan)
    if len(nodes) == 2:
        slopes[:] = secant
        return np.moveaxis(slopes, 0, axis)
    slopes[1:-1] = _inner(width, secant)
    slopes[0] = _end(width[0], width[1], secant[0], secant[1])
    slopes[-1] = _end(width[-1], width[-2], secant[-1], secant[-2])
    return np.moveaxis(slopes, 0, axis)


def _inner(width: Array, secant: Array) -> Array:
    """Weighted harmonic mean of two secants of one sign; one-sided beside a hole."""
    before, after = secant[:-1], secant[1:]
    heavy_after, heavy_before = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
    rising = before * after > 0
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        mean = (heavy_after + heavy_before) / (heavy_after / before + heavy_before / after)
    slope = np.where(rising, mean, 0.0)
    slope = np.where(np.isnan(before), after, slope)
    return np.where(np.isnan(after), before, slope)


def _end(width: Array, next_width: Array, secant: Array, next_secant: Array) -> Array:
    """Three-point slope at an end, limited so that the first cell stays monotone."""
    slope = ((2 * width + next_width) * secant - width * next_secant) / (width + next_width)
    slope = np.where(slope * secant <= 0, 0.0, slope)
    turning = (secant * next_secant <= 0) & (np.abs(slope) > 3 * np.abs(secant))
    slope = np.where(turning, 3 * secant, slope)
    return np.where(np.isnan(next_secant), secant, slope)


def split_at(nodes: Array, breaks: Array) -> list[slice]:
    """Return the slices of `nodes` between `breaks`; neighbours share their break node."""
    cuts = [0, *np.flatnonzero(np.isin(nodes[1:-1], breaks)) + 1, len(nodes) - 1]
    return [slice(int(low), int(high) + 1) for low, high in zip(cuts, cuts[1:])]


def first_rows(nodes: Array, breaks: Array) -> list[int]:
    """
    Return the table row at which each cell begins.

    A break node has two rows, left and right.

    """
    rows: list[int] = []
    start = 0
    for piece in split_at(nodes, breaks):
        cells = piece.stop - piece.start - 1
        rows += range(start, start + cells)
        start += cells + 1
    return rows


def patch_table(axes: Sequence[Array], breaks: Sequence[Array], values: Array) -> Array:
    """
    Tabulate what the patches of all cells need: per node the value and one slope per axis.

    `values` has one dimension per axis and any number behind; the table has the rows of
    `first_rows` along each axis, then value and slopes, then the trailing dimensions of `values`.
    Cross derivatives at the nodes are taken as zero (Ferguson's patch), which keeps the
    interpolant C1.

    """
    for axis, (nodes, cuts) in enumerate(zip(axes, breaks)):
        values = np.concatenate(
            [
                np.take(values, range(piece.start, piece.stop), axis)
                for piece in split_at(nodes, cuts)
            ],
            axis,
        )
    slopes = []
    for axis, (nodes, cuts) in enumerate(zip(axes, breaks)):
        parts, start = [], 0
        for piece in split_at(nodes, cuts):
            rows = range(start, start + piece.stop - piece.start)
            parts.append(monotone_slopes(nodes[piece], np.take(values, rows, axis), axis))
            start = rows.stop
        slopes.append(np.concatenate(parts, axis))
    return np.stack([values, *slopes], axis=len(axes))


Weights = tuple[float, float, float, float]
Number = TypeVar('Number', float, Array)


def hermite_weights(width: Number, fraction: Number) -> tuple[Number, Number, Number, Number]:
    """Return the weights of value, slope, value, slope at `fraction` of a cell of `width`."""
    rest = 1.0 - fraction
    left, right = rest * rest, fraction * fraction
    return (
        (1.0 + 2.0 * fraction) * left,
        width * fraction * left,
        (3.0 - 2.0 * fraction) * right,
        -width * rest * right,
    )


def patch_weights(p: Weights, q: Weights) -> tuple[float, ...]:
    """Return the weights of the four corners of a cell in two dimensions, value and two slopes."""
    a, da, b, db = p
    c, dc, d, dd = q
    return (
        a * c,
        da * c,
        a * dc,
        a * d,
        da * d,
        a * dd,
        b * c,
        db * c,
        b * dc,
        b * d,
        db * d,
        b * dd,
    )
