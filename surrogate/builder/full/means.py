# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Means over all draws, also where few of them are solved.

All are solved at the middle temperature around the onset, and at a speed far beyond. What they
differ from the few there is carried to other speeds as a factor, which fades as contact grows
below the onset: where asperities carry everything, draws are alike. To other temperatures it is
carried as a factor, too, but for shares: at one mapped speed they are nearly those of the middle
temperature, so theirs are read there at a coordinate that is moved by a straight line. The line is
fitted to the few draws, which leaves their noise behind.

"""

from collections.abc import Callable
from typing import Any
import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import least_squares

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

LEAST_WEIGHED, RELATIVE = 0.003, 0.05
"""Errors of a share that count as equal in a fit: absolute, and of the share where more [-]."""
FARTHEST = np.array([0.5, 0.3])
"""Largest shift and stretch of a coordinate that a fit may find [-]."""


def fading(rcs: Array, full: Flags, few: int) -> Array:
    """
    Return what is left [speed, load] of the differences between draws below the onset, 0 to 1.

    What `few` draws of the `rcs` [speed, load, draw] lack of 1, over that at the first of the
    speeds at which all draws are solved; that of the other loads where it is not known.

    """
    lacking = 1 - quiet(np.nanmean, rcs[..., :few])
    first = int(np.argmax(full))
    with np.errstate(divide='ignore', invalid='ignore'):
        left = np.clip(lacking / lacking[first], 0.0, 1.0)
    left = np.where(np.isfinite(left), left, quiet(np.nanmean, left)[:, None])
    below = (np.arange(len(full)) < first)[:, None]
    return np.asarray(np.where(below & np.isfinite(left), left, 1.0))


def middle_mean(
    s: Array, values: Array, whole: Array, full: Flags, few: int, fade: Array, *, share: bool
) -> Array:
    """
    Return the mean [speed, load] of `values` [speed, load, draw] at the middle temperature.

    `full` tells at which speeds all draws are solved, with the mean `whole`; elsewhere the first
    `few` are, each moved by what that mean differs from it, so that one that is lost moves
    nothing. A share is scaled below the onset by what it lacks of 1, as `fade` is.

    """
    around = full[:, None]
    below = (np.arange(len(full)) < np.argmax(full))[:, None]
    moved = []
    for one in np.moveaxis(values, -1, 0)[:few]:
        factor = _carried(s, around, whole, one)
        if share:
            lacking = (1 - one) * _carried(s, around, 1 - whole, 1 - one)
            moved.append(np.clip(np.where(below, 1 - lacking, one * factor), 0.0, 1.0))
        else:
            moved.append(one * (1 + (factor - 1) * fade))
    return np.asarray(np.where(around, whole, quiet(np.nanmean, np.stack(moved, axis=-1))))


def _carried(s: Array, around: Flags, whole: Array, one: Array) -> Array:
    """Return `whole` over `one` where all draws are solved, carried over the other speeds."""
    with np.errstate(divide='ignore', invalid='ignore'):
        return filled(s, np.where(around, whole / one, np.nan), 1.0)


def carried_spread(
    s: Array, own: Array, mean: Array, full: Flags, fade: Array, *, share: bool
) -> Array:
    """
    Return a deviation of draws or an error of their mean [speed, load].

    Known, as `own`, where all draws are solved; elsewhere carried over the speed, relative to the
    `mean` but for shares, which do not deviate where there is no contact, and fading as the
    differences do.

    """
    with np.errstate(divide='ignore', invalid='ignore'):
        known = np.where(full[:, None], own if share else own / mean, np.nan)
    return np.asarray(filled(s, known, np.nan) * fade * ((mean != 0) if share else mean))


def other_mean(s: Array, own: Array, middle: Array, mean: Array) -> Array:
    """
    Return the mean [speed, load] at a temperature with few draws, by a factor.

    `own` and `middle` [speed, load, draw] are the same draws there and at the middle temperature,
    `mean` is that of all draws at the latter.

    """
    both = np.isfinite(own) & np.isfinite(middle)
    few = quiet(np.nanmean, np.where(both, middle, np.nan))
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.asarray(quiet(np.nanmean, own) * filled(s, mean / few, 1.0))


def moved_shares(s: Array, own: Array, middle: Array, mean: Array, full: Flags) -> Array:
    """
    Return the mean shares [speed, load] at a temperature with few draws.

    Arguments as for `other_mean`: read from `mean` at s + a + b s, where it is known; slower the
    few draws speak for themselves. One line serves all loads: theirs differ by noise alone.

    """
    here = own.mean(axis=-1)
    fitted = np.isfinite(here) & full[:, None]
    line = _common_line(s, here, middle.mean(axis=-1), fitted)
    columns = [
        _moved_share(s, one, known, mean[:, j], line)
        for j, (one, known) in enumerate(zip(np.moveaxis(own, 1, 0), fitted.T))
    ]
    return np.stack(columns, axis=1)


def _common_line(s: Array, here: Array, there: Array, fitted: Flags) -> Array:
    """Return a and b [-] with which `there` at s + a + b s is `here` at s, over all loads."""
    curves = [_curve(s, column) for column in there.T]
    known = [(f, one, part) for f, one, part in zip(curves, here.T, fitted.T) if f and part.any()]
    if not known:
        return np.zeros(2)

    def wrong(line: Array) -> Array:
        return np.concatenate(
            [
                (few(s[part] + _moved(s[part], line)) - one[part])
                / np.maximum(LEAST_WEIGHED, RELATIVE * one[part])
                for few, one, part in known
            ]
        )

    found = least_squares(wrong, np.zeros(2), bounds=(-FARTHEST, FARTHEST), loss='soft_l1')
    return np.asarray(found.x)


def _moved_share(s: Array, own: Array, fitted: Flags, mean: Array, line: Array) -> Array:
    """Return the mean share [speed] of one load, that of its own few draws where none is known."""
    all_draws = _curve(s, mean)
    if all_draws is None or not fitted.any():
        return quiet(np.nanmean, own)
    ends = s[fitted][0], s[fitted][-1]
    found = all_draws(s + _moved(np.clip(s, *ends), line))
    slower = s < s[np.isfinite(mean)][0]
    return np.asarray(np.where(slower, np.fmax(found, quiet(np.nanmean, own)), found))


def joined(
    s: Array, column: Array, beside: Array, asked: Flags, *, share: bool, fade: Array | None = None
) -> Array:
    """
    Return a column [speed, load] continued where it was not `asked` for by that `beside` it.

    At one mapped speed a temperature, or a load, differs from the next by a factor that changes
    little, and in shares next to nothing; so the column goes on in the shape of its neighbour.
    What the factor differs from 1 at the slowest known speed falls below it as `fade` does.

    """
    if share:
        factor = np.ones_like(beside)
    else:
        with np.errstate(divide='ignore', invalid='ignore'):
            ratio = column / beside
        factor = filled(s, ratio, 1.0)
        if fade is not None:
            factor = 1 + (factor - 1) * _left_below(np.isfinite(ratio), fade)
    return np.asarray(np.where(~asked & np.isnan(column), beside * factor, column))


def _left_below(known: Flags, fade: Array) -> Array:
    """Return `fade` [speed, load] over that at the slowest known speed, never rising, else 1."""
    first = np.argmax(known, axis=0)
    below = np.arange(len(fade))[:, None] < first
    with np.errstate(divide='ignore', invalid='ignore'):
        share = np.nan_to_num(fade / np.take_along_axis(fade, first[None], axis=0))
    falling = np.minimum.accumulate(np.where(below, share, 1.0)[::-1])[::-1]
    return np.asarray(falling)


def _moved(s: Array, line: Array) -> Array:
    return np.asarray(line[0] + line[1] * s)


def _curve(s: Array, values: Array) -> Callable[[Array], Array] | None:
    """Return a monotone cubic through what is known, held beyond its ends; None if too few."""
    known = np.isfinite(values)
    if known.sum() < 2:
        return None
    cubic, ends = PchipInterpolator(s[known], values[known]), s[known][[0, -1]]
    return lambda place: np.asarray(cubic(np.clip(place, *ends)))


def filled(s: Array, values: Array, otherwise: float) -> Array:
    """Return columns over `s` with straight lines between what is known, held beyond it."""
    found = np.full_like(values, otherwise)
    for j, column in enumerate(values.T):
        known = np.isfinite(column)
        if known.any():
            found[:, j] = np.interp(s, s[known], column[known])
    return found


def quiet(reduce: Any, values: Array) -> Array:
    """Reduce over draws, where there may be none."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)
        return np.asarray(reduce(values, axis=-1))
