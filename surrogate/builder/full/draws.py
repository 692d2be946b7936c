# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Draws of the roughness: how many are solved, and weights with which few of them stand for many.

A patch of the raceway is rescaled to one rms over a window, which its long waves decide. The short
waves, which touch, are scaled with them, by a factor that differs from draw to draw and decides
how much they touch. It is known of any draw without a solve: so draws are weighted until the mean
of its sixth power is that of a large population, and what they scatter by beside it is left.

Calibration by exponential weights (raking): Deville, Sarndal, J. Am. Stat. Assoc. 87 (1992) 376.

"""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from surrogate.parameters import Screw
from surrogate.surface import FIELDS, SolvedPoint

Array = NDArray[np.float64]
POPULATION = 1000
"""Draws whose mean the weights aim at [-]."""
POWER = 6
"""Power of the factor [-]: RCS grows with the second where it is 0.5, the fourth at 0.1, the
eighth at 0.01."""
VERGE = (0.875, 0.9375)
"""Parts of the idle load between which draws that are solved only near it gain weight [-]."""
STEEPEST = 2.0
"""Largest exponent of a weight per standard deviation of the powers [-]: with more one draw
decides."""


@dataclass(frozen=True, slots=True)
class WeightedDraws:
    """
    How many draws there are, the load [N] from which on the relieved nut is idle, weights.

    `powers` of the factors of twice as many draws and their `mean` over a population [-]; none
    where means are plain.

    """

    count: int
    idle: float = 0.0
    powers: tuple[float, ...] = ()
    mean: float = math.nan

    @property
    def most(self) -> int:
        """Return the most draws at any load."""
        return len(self.powers) or self.count

    def at(self, load: float) -> int:
        """
        Return how many draws are solved at a load [N]: twice as many on the verge of idling.

        There balls of the relieved nut carry a hundredth of the others or less. Where their
        contacts are hardly larger than the shortest waves single summits decide, and draws differ
        the more.

        """
        return self.most if self._verge(load) > 0 else self.count

    def _verge(self, load: ArrayLike) -> Array:
        """Return the weight [-] of the mean over twice as many draws at loads [N]."""
        size = np.abs(load)
        part = np.interp(size / self.idle, VERGE, (0.0, 1.0)) if self.idle else np.zeros_like(size)
        return np.asarray(np.where(size < self.idle, part, 0.0))

    def weights(self, values: Array, load: ArrayLike) -> Array:
        """
        Return the weights [..., draw] of `values`, where they are finite, at loads [N].

        They change with the load without a step, so that fields between nodes do.

        """
        if not self.powers:
            return _even(np.isfinite(values))
        some = values.copy()
        some[..., np.arange(values.shape[-1]) >= self.count] = np.nan
        few, more = self._calibrated(some), self._calibrated(values)
        return np.asarray(few + self._verge(load)[..., None] * (more - few))

    def _calibrated(self, values: Array) -> Array:
        known = np.isfinite(values)
        patterns, places = np.unique(
            known.reshape(-1, known.shape[-1]), axis=0, return_inverse=True
        )
        weights = np.zeros(patterns.shape)
        for row, pattern in zip(weights, patterns):
            if pattern.any():
                off = np.array(self.powers[: pattern.size])[pattern] - self.mean
                row[pattern] = raked(off)
        return np.asarray(weights[places].reshape(known.shape))

    def standard_error(self, values: Array, weights: Array) -> Array:
        """
        Return the standard error of the weighted mean of `values` [..., draw], NaN of too few.

        From residuals, each over 1 - h with its leverage h: HC2 of MacKinnon, White, J.
        Econometrics 29 (1985) 305. Calibrated, those of a straight line over the powers, with what
        the weights miss of their aim and the population of its mean.

        """
        used = np.isfinite(values)
        left = np.where(used, values - weighted_mean(values, weights)[..., None], 0.0)
        leverage, rest, lines = weights, np.zeros(left.shape[:-1]), 0
        if self.powers:
            left, leverage, rest = self._about_line(left, weights)
            lines = 1
        with np.errstate(divide='ignore', invalid='ignore'):
            square = np.sum((weights * left) ** 2 / (1 - leverage), axis=-1, where=used) + rest
        return np.asarray(np.where(used.sum(axis=-1) > 1 + lines, np.sqrt(square), np.nan))

    def _about_line(self, left: Array, weights: Array) -> tuple[Array, Array, Array]:
        """Return residuals of a line over the powers, leverages, and the square that is left."""
        x = np.array(self.powers[: left.shape[-1]])
        mean = (weights * x).sum(axis=-1)
        off = x - mean[..., None]
        variance = (weights * off**2).sum(axis=-1)
        with np.errstate(divide='ignore', invalid='ignore'):
            slope = (weights * off * left).sum(axis=-1) / variance
            leverage = weights * (1 + off**2 / variance[..., None])
        rest = slope**2 * ((self.mean - mean) ** 2 + variance / POPULATION)
        return np.asarray(left - slope[..., None] * off), np.asarray(leverage), np.asarray(rest)


def draws_of(screw: Screw, count: int) -> WeightedDraws:
    """Return `count` draws of a screw, plain: all have the height of the expectation."""
    return WeightedDraws(count)


def raked(off: Array) -> Array:
    """
    Return weights exp(t off) [-] with the sum 1 and the mean 0 of `off`.

    Equal ones where t would be steeper than `STEEPEST` per standard deviation.

    """
    spread, even = float(np.std(off)), np.full(off.size, 1 / off.size)
    if not spread > 0:
        return even
    unit = off / spread

    def mean(exponent: float) -> float:
        return float(_tilted(unit, exponent) @ unit)

    if not mean(-STEEPEST) < 0 < mean(STEEPEST):
        return even
    return _tilted(unit, float(brentq(mean, -STEEPEST, STEEPEST, xtol=1e-12)))


def _tilted(unit: Array, exponent: float) -> Array:
    weights = np.exp(exponent * (unit - unit.max()))
    return np.asarray(weights / weights.sum())


def _even(known: NDArray[np.bool_]) -> Array:
    with np.errstate(invalid='ignore'):
        return np.asarray(known / known.sum(axis=-1, keepdims=True))


def weighted_mean(values: Array, weights: Array) -> Array:
    """Return the mean over draws [...]; NaN where there is none."""
    used = np.isfinite(values)
    mean = np.sum(weights * values, axis=-1, where=used)
    return np.asarray(np.where(used.any(axis=-1), mean, np.nan))


def deviation(values: Array, weights: Array) -> Array:
    """Return the standard deviation of draws [...], in their unit; NaN of less than two."""
    off = values - weighted_mean(values, weights)[..., None]
    several = np.isfinite(values).sum(axis=-1) > 1
    with np.errstate(divide='ignore', invalid='ignore'):
        square = weighted_mean(off**2, weights) / (1 - np.nansum(weights**2, axis=-1))
        return np.asarray(np.where(several, np.sqrt(square), np.nan))


def mean_of_draws(
    points: Sequence[SolvedPoint | None], draws: WeightedDraws, load: float
) -> SolvedPoint:
    """
    Return the means of the fields over the points of the draws at a load [N], in their order.

    None stands for a chain that failed. Not converged where fewer than half of the draws did.

    """
    good = [point is not None and point.converged for point in points]
    if 2 * sum(good) < len(good):
        return SolvedPoint(converged=False, status='Too few draws of the roughness converged.')
    values = np.array(
        [
            [getattr(point, name) if kept else np.nan for point, kept in zip(points, good)]
            for name in FIELDS
        ]
    )
    means = weighted_mean(values, draws.weights(values, np.full(len(FIELDS), load)))
    return SolvedPoint(converged=True, **dict(zip(FIELDS, means.tolist())))
