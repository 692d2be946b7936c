# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed model of the friction of one axis: level, own temperature slope, wander, scatter of logs.

    x_i = mu + b (T_i - T_0) + delta_i + w_i + u_i

x is the effect of log i on ln(friction). Fixed are the level mu, the slope b with its prior of the
oil, and the change delta, which is free after the baseline. Random are the wander w, an
autoregression of first order, and the scatter u of logs. Both standard deviations are unknown:
each pair of a grid is weighed by its likelihood, and all that is said is a mean over the grid.

"""

import dataclasses
import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SLOPE, SLOPE_DOUBT = -0.010, 0.006
"""Prior of the change of ln(friction) with the temperature [1/K]: mean and standard deviation."""
SCATTERS = (0.005, 0.008, 0.012, 0.018, 0.025, 0.035, 0.05)
"""Standard deviations of the effect of a log that are weighed [-]."""
SCATTER_WEIGHTS = (0.3, 0.7, 1.0, 1.0, 0.9, 0.5, 0.2)
WANDERS = (0.003, 0.007, 0.011, 0.015, 0.02, 0.026, 0.033)
"""Standard deviations of the wander that are weighed [-]."""
WANDER_WEIGHTS = (0.8, 1.0, 1.0, 1.0, 0.8, 0.6, 0.4)
CORRELATION_TIME = 105.0
"""Time over which the wander is forgotten [days]."""
YEAR, SEASON = 365.25, 0.06
"""Period [days] and standard deviation [-] of the season where no temperature is measured."""
FREE, BETWEEN, LEVEL = 0.3, 0.15, 10.0
"""Standard deviation of a change now, of one before, and of the level itself [-]."""

RUNNING_IN, RUNNING_IN_TIME = 0.03, 25.0
"""Standard deviation of what a new screw loses [-], and time over which it does so [days]."""


class Logs(NamedTuple):
    """
    Effects of logs of one axis, in the order of time.

    `time` [days]; `effect` on ln(friction) [-]; `warmth` [K] above the mean, 0 where none was
    measured; `noise` is the variance of an effect over that of a usual log [-].

    """

    time: Array
    effect: Array
    warmth: Array
    noise: Array

    def until(self, count: int) -> 'Logs':
        """Return the first `count` logs."""
        return Logs(*(part[:count] for part in self))


class Prior(NamedTuple):
    """
    What is known of an axis before its own logs.

    Mean and standard deviation of its temperature slope [1/K], and the weights of the pairs of the
    grid, none for the usual ones.

    """

    slope: float = SLOPE
    doubt: float = SLOPE_DOUBT
    pairs: tuple[float, ...] = ()

    @property
    def logarithms(self) -> Array:
        """Return the logarithms of the weights of the pairs."""
        return np.log(np.array(self.pairs)) if self.pairs else grid().prior


USUAL = Prior()


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """
    Change of ln(friction) of the last logs against the baseline.

    An entry for each pair of the grid with its `weight`: the `mean` change, its standard deviation
    `known` as the change that has come, wander included, and `lasting`, where the wander is an
    error. `slope` [1/K] is that of the temperature.

    """

    weight: Array
    mean: Array
    known: Array
    lasting: Array
    slope: float

    @property
    def value(self) -> float:
        """Return the mean change [-]."""
        return float(self.weight @ self.mean)

    @property
    def deviation(self) -> float:
        """Return the standard deviation of the change that has come [-]."""
        return self._spread(self.known)

    @property
    def lasting_deviation(self) -> float:
        """Return the standard deviation of a change beyond the wander [-]."""
        return self._spread(self.lasting)

    def _spread(self, part: Array) -> float:
        return math.sqrt(self.weight @ (part**2 + (self.mean - self.value) ** 2))

    def beyond(self, size: float, sign: int) -> float:
        """Return the probability that no lasting change beyond a `size` [-] of a sign is there."""
        return float(self.weight @ _tail((sign * self.mean - size) / self.lasting))


def _tail(z: Array) -> Array:
    """Return the upper tail of the normal distribution."""
    return np.array([0.5 * math.erfc(one / math.sqrt(2.0)) for one in z.tolist()])


class Grid(NamedTuple):
    """Pairs of scatter and wander [-], and the logarithm of their prior weights."""

    scatter: Array
    wander: Array
    prior: Array


@functools.cache
def grid() -> Grid:
    """Return the pairs that are weighed."""
    scatter, wander = np.meshgrid(SCATTERS, WANDERS, indexing='ij')
    prior = np.log(np.outer(SCATTER_WEIGHTS, WANDER_WEIGHTS))
    return Grid(scatter.ravel(), wander.ravel(), prior.ravel())


class Fit(NamedTuple):
    """Posterior of the effects for each pair of a grid, and the likelihood of the pair."""

    mean: Array
    covariance: Array
    likelihood: Array


def effects(
    logs: Logs, blocks: NDArray[np.int64], *, warm: bool, step: int = 0, doubt: float = SLOPE_DOUBT
) -> tuple[Array, Array]:
    """
    Return the columns of all effects with a prior, and their prior standard deviations.

    Level, slope, running-in, two of the season without a temperature, a step within the logs that
    are now beside their mean, then a change of each block but 0.

    """
    phase = 2.0 * math.pi * logs.time / YEAR
    columns = [
        np.ones(len(logs.time)),
        logs.warmth,
        np.exp((logs.time[0] - logs.time) / RUNNING_IN_TIME),
        *([] if warm else [np.cos(phase), np.sin(phase)]),
        _step_within(logs, blocks, step),
        *(np.where(blocks == block, 1.0, 0.0) for block in range(1, int(blocks.max()) + 1)),
    ]
    season = [] if warm else [SEASON, SEASON]
    known = [LEVEL, doubt, RUNNING_IN, *season, FREE]
    between = [BETWEEN] * (len(columns) - len(known) - 1)
    deviations = [*known, *between, *([FREE] if blocks.max() else [])]
    return np.stack(columns, axis=1), np.array(deviations)


def _step_within(logs: Logs, blocks: NDArray[np.int64], step: int) -> Array:
    now = (blocks == blocks.max()) & (blocks > 0)
    later = now & (np.arange(len(blocks)) >= step)
    share = np.where(now, 1.0 / logs.noise, 0.0)
    mean = float(share @ later) / max(float(share.sum()), 1e-9)
    return np.asarray(np.where(now, later - mean, 0.0))


def fit(
    logs: Logs,
    blocks: NDArray[np.int64],
    *,
    warm: bool = True,
    step: int = 0,
    prior: Prior = USUAL,
) -> Fit:
    """
    Return the effects of logs, the slope less its prior mean, by generalised least squares.

    `blocks` numbers the logs, see `estimate`. `warm`: the temperature was measured.

    """
    pairs = grid()
    design, deviations = effects(logs, blocks, warm=warm, step=step, doubt=prior.doubt)
    effect = logs.effect - prior.slope * logs.warmth
    random = covariance(logs, pairs)
    white = np.linalg.inv(random)
    left = design.T @ white  # (pairs, columns, logs)
    normal = left @ design + np.diag(deviations**-2.0)
    posterior: Array = np.linalg.inv(normal).astype(float)
    pull = left @ effect
    mean = np.einsum('gij,gj->gi', posterior, pull)
    chi = np.einsum('i,gij,j->g', effect, white, effect) - np.einsum('gi,gi->g', pull, mean)
    determinants = np.linalg.slogdet(random)[1] + np.linalg.slogdet(normal)[1]
    return Fit(mean, posterior, np.asarray(-0.5 * (determinants + chi)))


def weights_of(
    logs: Logs, blocks: NDArray[np.int64], *, warm: bool = True, prior: Prior = USUAL
) -> Array:
    """Return the weight of each pair of the grid by logs before a change."""
    return _weights(fit(logs, blocks, warm=warm, prior=prior).likelihood + prior.logarithms)


def estimate(
    logs: Logs,
    blocks: NDArray[np.int64],
    weight: Array,
    *,
    warm: bool = True,
    step: int = 0,
    prior: Prior = USUAL,
) -> Estimate:
    """
    Return the change of the last block of logs against the first one.

    `blocks` numbers the logs: 0 is the baseline, the last one is now, and each between has a
    change of its own. `weight` is that of each pair of the grid; `step` is the log with which a
    step may begin, which is no slope.

    """
    pairs = grid()
    mean, posterior, _ = fit(logs, blocks, warm=warm, step=step, prior=prior)
    now = blocks == blocks.max()
    share = 1.0 / logs.noise[now]
    share = share / share.sum()
    spread = pairs.scatter**2 * float(share**2 @ logs.noise[now])
    contrast = share @ effects(logs, blocks, warm=warm, step=step)[0][now]
    contrast[2], contrast[-1] = 0.0, 0.0
    level = np.einsum('i,gij,j->g', contrast, posterior, contrast)
    effect = float(share @ (logs.effect - prior.slope * logs.warmth)[now])
    return Estimate(
        weight=weight,
        mean=effect - mean @ contrast,
        known=np.sqrt(level + spread),
        lasting=np.sqrt(posterior[:, -1, -1]),
        slope=prior.slope + float(weight @ mean[:, 1]),
    )


def covariance(logs: Logs, pairs: Grid) -> Array:
    """Return the covariance of the effects of logs for each pair of a grid."""
    apart = np.abs(logs.time[:, None] - logs.time)
    wander = pairs.wander[:, None, None] ** 2 * np.exp(-apart / CORRELATION_TIME)
    scatter = pairs.scatter[:, None, None] ** 2 * np.diag(logs.noise)
    return np.asarray(wander + scatter)


def _weights(logarithms: Array) -> Array:
    weights = np.exp(logarithms - logarithms.max())
    return np.asarray(weights / weights.sum())
