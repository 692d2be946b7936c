# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed model of the friction of one axis, and the changes that may have come, by their probability.

    x_i = mu + b (T_i - T_0) + r exp(-t_i / 25 d) + w_i + u_i + sum_k delta_k h_k(t_i)

x is the effect of log i on ln(friction). The level mu, the slope b with its prior of the oil and
the running-in r are effects with a prior. Random are the wander w, an autoregression of first
order, and the scatter u of logs; each pair of a grid of their standard deviations is a hypothesis.
So is each shape h: nothing more, a step or a ramp that lasts, or fresh grease that passes. All
that is said is a mean over the hypotheses by their posterior probability.

"""

import dataclasses
import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
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
LEVEL = 1.0
"""Standard deviation of the level itself [-]."""
RUNNING_IN, RUNNING_IN_TIME = 0.05, 25.0
"""Standard deviation of what a new screw loses [-], and time over which it does so [days]."""
CHANGE, CHANGE_RATE = 0.15, 1.0 / (2.0 * YEAR)
"""Standard deviation of a change that lasts [-], and how often one comes [1/day]."""
RAMPS = (56.0, 180.0)
"""Durations of ramps beside the step [days]."""
GREASE, GREASE_SPREAD, GREASE_TIME, GREASE_RATE = 0.05, 0.04, 6.0, 4.0 / YEAR
"""Fresh grease: mean and standard deviation [-], time until it has passed [days], rate [1/day]."""
LEAST_GAP = 0.1
"""Time from log to log that counts at least [days]."""
MODEL_DOUBT = 0.008
"""Standard deviation of what no part of the model says [-]."""
FIRST_CHANGE = 3
"""Logs before the first change."""
IN_A_ROW = 2
"""Logs by which a change shows at least: one may be odd."""
ACCEPTED = 0.01
"""Probability of no further change below which the likeliest is held for true."""
MOST_SHAPES = 8
CHANGED_ODDS = 4.0
"""Odds of a change lately, for the interval [-]."""


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


def wander_of(time: Array, pairs: Grid) -> Array:
    """Return the covariance of the wander at times [days] for each pair of a grid."""
    apart = np.abs(time[:, None] - time)
    return np.asarray(pairs.wander[:, None, None] ** 2 * np.exp(-apart / CORRELATION_TIME))


def scatter_of(logs: Logs, pairs: Grid) -> Array:
    """Return the covariance of the scatter of logs for each pair of a grid."""
    return np.asarray(pairs.scatter[:, None, None] ** 2 * np.diag(logs.noise))


class Shapes(NamedTuple):
    """
    What may have come, a column for each: logs by shapes, 1 at its full size.

    The size has a prior `mean` and `deviation` [-]; `prior` is the logarithm of the probability;
    `onset` is the log with which it begins. It `lasts`, or it is grease that passes.

    """

    column: Array
    mean: Array
    deviation: Array
    prior: Array
    onset: NDArray[np.int64]
    lasts: Mask


def shapes_of(time: Array) -> Shapes:
    """Return all that may have come within logs at times [days]."""
    gap = np.maximum(np.diff(time, prepend=time[0]), LEAST_GAP)
    count = len(time)
    first, last = min(FIRST_CHANGE, count), count - IN_A_ROW + 1
    later = np.arange(first, max(last, first))
    grease = np.arange(1, count)
    step = np.arange(count)[:, None] >= later
    ramps = [_ramps(time, later, duration) for duration in RAMPS]
    since = time[:, None] - time[grease]
    passing = np.where(since >= 0.0, np.exp(-np.maximum(since, 0.0) / GREASE_TIME), 0.0)
    lasting = (1 + len(RAMPS)) * len(later)
    each = np.tile(gap[later] * CHANGE_RATE / (1 + len(RAMPS)), 1 + len(RAMPS))
    parts = (lasting, len(grease))
    return Shapes(
        column=np.concatenate([step.astype(float), *ramps, passing], axis=1),
        mean=np.repeat([0.0, GREASE], parts),
        deviation=np.repeat([CHANGE, GREASE_SPREAD], parts),
        prior=np.log(np.concatenate([each, gap[grease] * GREASE_RATE])),
        onset=np.concatenate([np.tile(later, 1 + len(RAMPS)), grease]),
        lasts=np.repeat([True, False], parts),
    )


def _ramps(time: Array, onset: NDArray[np.int64], duration: float) -> Array:
    """Return ramps from the log before the onset on, which are now at their full size."""
    ramp = np.clip((time[:, None] - time[onset - 1]) / duration, 0.0, 1.0)
    return np.asarray(ramp / np.maximum(ramp[-1], 1e-9))


class Posterior(NamedTuple):
    """
    Logs with the shapes that are held for true, for each pair of a grid.

    `inverse` of the covariance of the effects, whose mean is taken off in `rest`; `signal` is the
    covariance of the friction itself, `lasting` that of its changes, `added` their prior mean.
    `prior` is what was known of the axis before.

    """

    inverse: Array
    rest: Array
    signal: Array
    lasting: Array
    added: Array
    prior: Prior


def posterior_of(logs: Logs, *, warm: bool, prior: Prior = USUAL) -> Posterior:
    """Return logs without any shape; `warm`: the temperature was measured."""
    pairs, count = grid(), len(logs.time)
    running_in = RUNNING_IN * np.exp((logs.time[0] - logs.time) / RUNNING_IN_TIME)
    phase = 2.0 * math.pi * logs.time / YEAR
    season = [] if warm else [SEASON * np.cos(phase), SEASON * np.sin(phase)]
    effects = np.stack([np.full(count, LEVEL), prior.doubt * logs.warmth, *season])
    signal = wander_of(logs.time, pairs) + np.outer(running_in, running_in)
    return Posterior(
        inverse=np.linalg.inv(signal + scatter_of(logs, pairs) + effects.T @ effects),
        rest=logs.effect - prior.slope * logs.warmth,
        signal=signal,
        lasting=np.zeros((count, count)),
        added=np.zeros(count),
        prior=prior,
    )


def with_shape(posterior: Posterior, shapes: Shapes, which: int) -> Posterior:
    """Return logs with one shape more that is held for true."""
    column, variance = shapes.column[:, which], float(shapes.deviation[which]) ** 2
    covariance = variance * np.outer(column, column)
    pull = posterior.inverse @ column
    share = variance / (1.0 + variance * (pull @ column))
    mean = float(shapes.mean[which]) * column
    return Posterior(
        # Sherman and Morrison 1950.
        inverse=posterior.inverse - share[:, None, None] * pull[:, :, None] * pull[:, None, :],
        rest=posterior.rest - mean,
        signal=posterior.signal + covariance,
        lasting=posterior.lasting + float(shapes.lasts[which]) * covariance,
        added=posterior.added + mean,
        prior=posterior.prior,
    )


class Weighed(NamedTuple):
    """
    Probability of each pair of the grid with each shape, the first column without any.

    `size` of each shape [-] has a posterior mean and `variance`.

    """

    probability: Array
    size: Array
    variance: Array

    @property
    def none(self) -> float:
        """Return the probability that no further shape has come."""
        return float(self.probability[:, 0].sum())

    @property
    def shapes(self) -> Array:
        """Return the probability of each shape."""
        return np.asarray(self.probability[:, 1:].sum(axis=0))


def weighed(posterior: Posterior, shapes: Shapes) -> Weighed:
    """Return how probable each shape is as the next one, by its marginal likelihood."""
    inverse, rest = posterior.inverse, posterior.rest
    pull = inverse @ shapes.column
    precision = np.einsum('ns,gns->gs', shapes.column, pull)
    own = shapes.deviation**-2.0
    variance = 1.0 / (precision + own)
    size = variance * (np.einsum('n,gns->gs', rest, pull) + own * shapes.mean)
    ratio = 0.5 * (
        size**2 / variance - own * shapes.mean**2 - np.log1p(shapes.deviation**2 * precision)
    )
    chi = np.einsum('i,gij,j->g', rest, inverse, rest)
    plain = posterior.prior.logarithms + 0.5 * (np.linalg.slogdet(inverse)[1] - chi)
    logarithm = plain[:, None] + np.concatenate(
        [np.zeros((len(plain), 1)), ratio + shapes.prior], axis=1
    )
    probability = np.exp(logarithm - logarithm.max())
    return Weighed(np.asarray(probability / probability.sum()), size, variance)


def if_changed(seen: Weighed, shapes: Shapes, time: Array) -> Weighed:
    """
    Return the probabilities of an axis of which a change is expected, `time` [days] of its logs.

    An interval has to hold if a change has come, however rare that is.

    """
    lately = shapes.lasts & (time[-1] - time[shapes.onset] <= RAMPS[0])
    odds = max(float(np.exp(shapes.prior[lately]).sum()), 1e-9)
    factor = np.concatenate([[1.0], np.where(lately, max(CHANGED_ODDS / odds, 1.0), 1.0)])
    probability = seen.probability * factor
    return seen._replace(probability=probability / probability.sum())


class Mixture(NamedTuple):
    """A number as a mixture of normal distributions with their `weight`, mean and deviation."""

    weight: Array
    mean: Array
    deviation: Array

    @property
    def value(self) -> float:
        """Return the mean."""
        return float((self.weight * self.mean).sum())

    @property
    def spread(self) -> float:
        """Return the standard deviation."""
        between = (self.mean - self.value) ** 2
        return math.sqrt(float((self.weight * (self.deviation**2 + between)).sum()))

    def within(self, size: float, sign: int) -> float:
        """Return the probability that the number is not beyond a `size` of a sign."""
        return float((self.weight * _tail((sign * self.mean - size) / self.deviation)).sum())


def _tail(z: Array) -> Array:
    """Return the upper tail of the normal distribution."""
    tails = [0.5 * math.erfc(value / math.sqrt(2.0)) for value in z.ravel().tolist()]
    return np.array(tails).reshape(z.shape)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """
    Change of ln(friction) of the last logs against the baseline.

    The mean `change` [-] that has come, wander included, with its standard `deviation`; what of it
    `lasts`; `unproven` is the probability that nothing lasting has come at all. `slope` [1/K] is
    that of the temperature, with its standard deviation, `pairs` the probability of each pair of
    the grid; `onset` is the log with which the likeliest change began, -1 where none is likely. A
    change of some weeks ago would be known within `recent` [-], a standard deviation for each log.

    """

    change: float
    deviation: float
    lasts: Mixture
    unproven: float
    slope: float
    slope_deviation: float
    pairs: Array
    onset: int
    recent: Array


def estimate(
    logs: Logs, baseline: Mask, now: Mask, *, warm: bool = True, prior: Prior = USUAL
) -> Estimate:
    """
    Return the change of the logs `now` against those of the `baseline`.

    Shapes are held for true one after the other, the likeliest first, as long as it is not likely
    that nothing more has come. `warm`: the temperature was measured.

    """
    shapes = shapes_of(logs.time)
    posterior, unproven, onset = posterior_of(logs, warm=warm, prior=prior), 1.0, -1
    for _ in range(MOST_SHAPES):
        seen = weighed(posterior, shapes)
        likely = seen.shapes
        passing = 1.0 - float(likely[shapes.lasts].sum())
        unproven = min(unproven, passing)
        if passing < ACCEPTED:
            best = int(np.where(shapes.lasts, likely, -1.0).argmax())
            onset = int(shapes.onset[best])
        else:
            best = int(np.where(shapes.lasts, -1.0, likely).argmax())
            if likely[best] <= seen.none or shapes.lasts[best]:
                break
        posterior = with_shape(posterior, shapes, best)
    return _said(logs, (baseline, now), posterior, shapes, seen, unproven, onset)


def _said(
    logs: Logs,
    parts: tuple[Mask, Mask],
    posterior: Posterior,
    shapes: Shapes,
    seen: Weighed,
    unproven: float,
    onset: int,
) -> Estimate:
    baseline, now = parts
    apart = now / now.sum() - baseline / baseline.sum()
    pull = posterior.signal @ apart
    lately = if_changed(seen, shapes, logs.time)
    change = functional(posterior, shapes, lately, pull, pull @ apart, apart @ shapes.column)
    lasting = posterior.lasting[-1]
    last = shapes.column[-1] * shapes.lasts
    lasts = functional(posterior, shapes, seen, lasting, lasting[-1], last)
    prior = posterior.prior
    warmth = prior.doubt**2 * logs.warmth
    slope = functional(posterior, shapes, seen, warmth, prior.doubt**2, 0.0 * last)
    steps = slice(0, max(len(logs.time) - IN_A_ROW + 1 - FIRST_CHANGE, 0))
    if onset < 0 and unproven < 0.5:
        onset = int(shapes.onset[np.where(shapes.lasts, seen.shapes, -1.0).argmax()])
    plain = seen.probability.sum(axis=1)
    return Estimate(
        change=change.value + float(apart @ posterior.added),
        deviation=math.hypot(change.spread, MODEL_DOUBT),
        lasts=lasts,
        unproven=unproven,
        slope=prior.slope + slope.value,
        slope_deviation=slope.spread,
        pairs=plain,
        onset=onset,
        recent=np.sqrt(plain @ seen.variance[:, steps]),
    )


def functional(
    posterior: Posterior,
    shapes: Shapes,
    seen: Weighed,
    pull: Array,
    variance: float | Array,
    sizes: Array,
) -> Mixture:
    """
    Return a number that is linear in the effects, over all hypotheses.

    `pull` is its prior covariance with the effects of the logs, `variance` its own; `sizes` is
    what it has of the size of each shape.

    """
    left = np.einsum(
        'gij,gj->gi',
        posterior.inverse,
        np.broadcast_to(pull, (len(grid().prior), len(posterior.rest))),
    )
    plain = left @ posterior.rest
    own = variance - (pull * left).sum(axis=1)
    share = sizes - left @ shapes.column
    mean = np.concatenate([plain[:, None], plain[:, None] + share * seen.size], axis=1)
    spread = np.concatenate([own[:, None], own[:, None] + share**2 * seen.variance], axis=1)
    return Mixture(seen.probability, mean, np.sqrt(np.maximum(spread, 1e-12)))
