# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Weights of draws, so that few of them stand for many.

A patch of the raceway is rescaled to one rms over a window, which its long waves decide. The short
waves, which XX
Calibration by exponential weights (raking): Deville, Sarndal, J. Am. Stat. Assoc. 87 (1992) 376.

"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from surrogate.full.idle import idle_load
from surrogate.parameters import Screw
from surrogate.screw_contacts import raceway_patch

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
POPULATION = 1000
"""Draws whose mean the weights aim at [-]."""
POWER = 4
"""Power of the factor [-]: RCS grows with the second where it is 0.5, the fourth at 0.1, the
eighth at 0.01."""
LEAST_DRAWS = 8
"""Draws from which on they are weighted [-]."""
VERGE = 0.96
"""Part of the idle load from which on twice as many draws are solved [-]."""
STEEPEST = 5.0
"""Largest exponent of a weight, per standard deviation of the powers [-]."""


def draws_at(screw: Screw, draws: int, load: float) -> int:
    """
    Return how many draws are solved at a load [N]: twice as many on the verge of the idle one.

    There balls of the relieved nut carry a hundredth of the others or less. Where their contacts
    are hardly larger than the shortest waves, single summits decide, and draws differ the more.

    """
    idle = idle_load(screw)
    on_verge = VERGE * idle <= abs(load) < idle
    return 2 * draws if on_verge and draws >= LEAST_DRAWS else draws


@dataclass(frozen=True, slots=True)
class Calibration:
    """Fourth power of the factor of each draw, and its mean over a population [-]."""

    powers: tuple[float, ...]
    mean: float

    def weights(self, known: Flags) -> Array:
        """Return weights [draw] with the sum 1 of the `known` draws, 0 of the others [-]."""
        found = np.where(known, 1.0, 0.0)
        if known.any():
            found[known] = _raked(np.array(self.powers[: known.size])[known] - self.mean)
        return found


def calibration(screw: Screw, draws: int) -> Calibration | None:
    """Return the calibration of draws 0 to `draws` - 1 of a screw, None of fewer than eight."""
    if draws < LEAST_DRAWS:
        return None
    powers = _powers(screw, max(POPULATION, draws))
    return Calibration(powers[:draws], float(np.mean(powers)))


@lru_cache(maxsize=8)
def _powers(screw: Screw, count: int) -> tuple[float, ...]:
    # The windows of both sides are alike: so are the factors, within 3 %.
    return tuple(raceway_patch(screw, 'screw', draw).scale ** POWER for draw in range(count))


def _raked(off: Array) -> Array:
    """Return weights exp(t off) with the sum 1 and the mean 0 of `off`; equal where none can."""
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


def draw_weights(values: Array, weigh: Calibration | None) -> Array:
    """Return the weights [..., draw] of `values`, where they are finite, plain without `weigh`."""
    known = np.isfinite(values)
    if weigh is None:
        with np.errstate(invalid='ignore'):
            return np.asarray(known / known.sum(axis=-1, keepdims=True))
    flat = known.reshape(-1, known.shape[-1])
    patterns, places = np.unique(flat, axis=0, return_inverse=True)
    return np.stack([weigh.weights(one) for one in patterns])[places].reshape(known.shape)


def weighted_mean(values: Array, weights: Array) -> Array:
    """Return the mean over draws [...]; NaN where there is none."""
    mean = np.where(np.isfinite(values), weights * values, 0.0).sum(axis=-1)
    return np.asarray(np.where(np.isfinite(values).any(axis=-1), mean, np.nan))


def standard_error(values: Array, weights: Array, weigh: Calibration | None) -> Array:
    """
    Return the standard error of the weighted mean of `values` [..., draw], NaN of too few draws.

    Calibrated, that of the residuals of the straight line over the fourth power, and what the
    mean of the population leaves open.

    """
    used, count = np.isfinite(values), np.isfinite(values).sum(axis=-1)
    mean = weighted_mean(values, weights)
    left, degrees, rest = np.where(used, values - mean[..., None], 0.0), count - 1.0, 0.0
    if weigh is not None:
        x = np.array(weigh.powers[: values.shape[-1]])
        off = x - (weights * x).sum(axis=-1, keepdims=True)
        variance = (weights * off**2).sum(axis=-1)
        slope = (weights * off * left).sum(axis=-1) / variance
        left = np.where(used, left - slope[..., None] * off, 0.0)
        degrees, rest = count - 2.0, slope**2 * variance / POPULATION
    with np.errstate(divide='ignore', invalid='ignore'):
        square = count / degrees * (weights**2 * left**2).sum(axis=-1) + rest
    return np.asarray(np.where(degrees > 0, np.sqrt(np.abs(square)), np.nan))


def mean_of_draws(
    records: Sequence[Mapping[str, Any] | None], names: Sequence[str], weigh: Calibration | None
) -> dict[str, float]:
    """
    Return the means of named fields over the records of all draws in their order.

    None stands for a chain that failed. Nothing where fewer than half of the draws converged.

    """
    good = [bool(record and record['converged']) for record in records]
    if 2 * sum(good) < len(good):
        return {}
    found = {}
    for name in names:
        values = np.array(
            [record[name] if record and kept else np.nan for record, kept in zip(records, good)]
        )
        found[name] = float(weighted_mean(values, draw_weights(values, weigh)))
    return found
