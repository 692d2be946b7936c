# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed model of the friction of one axis, and the changes that may have come, by their probability.

    x_i = mu + b (T_i - T_0) + r exp(-t_i / 25 d) + w_i + u_i + sum_k delta_k h_k(t_i)

x is the effect of log i on ln(friction). The level mu, the slope b with its prior of the oil and
the running-in r are effects with a prior. Random are the wander w, an autoregression of first
order, and the scatter u of logs; each pair of a grid of their standard deviations is a hypothesis.
So is each shape h: nothing more, a step or a ramp that lasts, or fresh grease that passes. Every
number is a mean over the hypotheses by their posterior probability.

"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
SLOPE, SLOPE_DOUBT = -0.010, 0.006  # prior of the change with the temperature [1/K]: mean, spread
SCATTERS = (0.005, 0.008, 0.012, 0.018, 0.025, 0.035, 0.05)  # standard deviations of logs [-]
SCATTER_WEIGHTS = (0.3, 0.7, 1.0, 1.0, 0.9, 0.5, 0.2)
WANDERS = (0.003, 0.007, 0.011, 0.015, 0.02, 0.026, 0.033)  # standard deviations of the wander [-]
WANDER_WEIGHTS = (0.8, 1.0, 1.0, 1.0, 0.8, 0.6, 0.4)
CORRELATION_TIME = 105.0  # over which the wander is forgotten [days]
YEAR, SEASON = 365.25, 0.06  # period [days], and spread of the season without a thermometer [-]
LEVEL = 1.0  # standard deviation of the level itself [-]
RUNNING_IN, RUNNING_IN_TIME = 0.05, 25.0  # what a new screw loses [-], over a time [days]
CHANGE, CHANGE_RATE = 0.15, 1.0 / (2.0 * YEAR)  # spread of a lasting change [-], rate [1/day]
RAMPS = (56.0, 180.0)  # durations of ramps beside the step [days]
GREASE, GREASE_SPREAD, GREASE_TIME, GREASE_RATE = 0.05, 0.04, 6.0, 4.0 / YEAR
"""Fresh grease: mean and standard deviation [-], time until it has passed [days], rate [1/day]."""
LEAST_GAP = 0.1  # time from log to log that counts at least [days]
MODEL_DOUBT = 0.008  # standard deviation of what no part of the model says [-]
FIRST_CHANGE = 3  # logs before the first change
IN_A_ROW = 2  # logs by which a change shows at least: one may be odd
ACCEPTED = 0.01  # probability of no further change below which the likeliest is held for true
MOST_SHAPES = 8
CHANGED_ODDS = 4.0  # odds of a change lately, for the interval [-]


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
    """Pairs of scatter and wander [-] that are weighed, and the logarithm of prior weights."""

    scatter: Array
    wander: Array
    prior: Array


GRID = Grid(
    np.repeat(SCATTERS, len(WANDERS)),
    np.tile(WANDERS, len(SCATTERS)),
    np.log(np.outer(SCATTER_WEIGHTS, WANDER_WEIGHTS)).ravel(),
)


class Prior(NamedTuple):
    """
    What is known of an axis before its own logs.

    Mean and standard deviation of its temperature slope [1/K], and the weights of the pairs of the
    grid, none for the usual ones.

    """

    slope: float = SLOPE
    doubt: float = SLOPE_DOUBT
    pairs: tuple[float, ...] = ()


USUAL = Prior()


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
    count, kinds = len(time), 1 + len(RAMPS)
    first = min(FIRST_CHANGE, count)
    later = np.arange(first, max(count - IN_A_ROW + 1, first))
    grease = np.arange(1, count)
    lasting = [(np.arange(count)[:, None] >= later).astype(float)]
    for duration in RAMPS:  # from the log before the onset on, now at full size
        ramp = np.clip((time[:, None] - time[later - 1]) / duration, 0.0, 1.0)
        lasting.append(ramp / np.maximum(ramp[-1], 1e-9))
    since = time[:, None] - time[grease]
    passing = np.where(since >= 0.0, np.exp(-np.maximum(since, 0.0) / GREASE_TIME), 0.0)
    change_rate = np.tile(gap[later] * CHANGE_RATE / kinds, kinds)
    parts = (kinds * len(later), len(grease))
    return Shapes(
        column=np.concatenate([*lasting, passing], axis=1),
        mean=np.repeat([0.0, GREASE], parts),
        deviation=np.repeat([CHANGE, GREASE_SPREAD], parts),
        prior=np.log(np.concatenate([change_rate, gap[grease] * GREASE_RATE])),
        onset=np.concatenate([np.tile(later, kinds), grease]),
        lasts=np.repeat([True, False], parts),
    )


class Weights(NamedTuple):
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
        sigmas = (sign * self.mean - size) / self.deviation
        tails = [0.5 * math.erfc(value / math.sqrt(2.0)) for value in sigmas.ravel().tolist()]
        return float((self.weight * np.array(tails).reshape(sigmas.shape)).sum())


class Model:
    """
    Effects of logs with the shapes that are held for true, for each pair of the grid.

    `inverse` of the covariance of the effects, whose mean is taken off in `rest`; `signal` is the
    covariance of the friction itself, `lasting` that of its changes, `added` their prior mean.

    """

    def __init__(self, logs: Logs, *, warm: bool = True, prior: Prior = USUAL) -> None:
        """Hold no shape for true; `warm`: the temperature was measured."""
        time, count = logs.time, len(logs.time)
        self.logs, self.prior, self.shapes = logs, prior, shapes_of(time)
        running_in = RUNNING_IN * np.exp((time[0] - time) / RUNNING_IN_TIME)
        phase = 2.0 * math.pi * time / YEAR
        season = [] if warm else [SEASON * np.cos(phase), SEASON * np.sin(phase)]
        effects = np.stack([np.full(count, LEVEL), prior.doubt * logs.warmth, *season])
        correlation = np.exp(-np.abs(time[:, None] - time) / CORRELATION_TIME)
        wander, scatter = (part[:, None, None] ** 2 for part in (GRID.wander, GRID.scatter))
        self.signal = wander * correlation + np.outer(running_in, running_in)
        covariance = self.signal + scatter * np.diag(logs.noise) + effects.T @ effects
        self.inverse = np.linalg.inv(covariance)
        self.rest = logs.effect - prior.slope * logs.warmth
        self.lasting, self.added = np.zeros((count, count)), np.zeros(count)

    def hold(self, which: int) -> None:
        """Hold one shape more for true (Sherman and Morrison 1950)."""
        shapes = self.shapes
        column, variance = shapes.column[:, which], float(shapes.deviation[which]) ** 2
        covariance, mean = variance * np.outer(column, column), float(shapes.mean[which]) * column
        pull = self.inverse @ column
        share = variance / (1.0 + variance * (pull @ column))
        self.inverse = self.inverse - share[:, None, None] * pull[:, :, None] * pull[:, None, :]
        self.rest, self.added = self.rest - mean, self.added + mean
        self.signal = self.signal + covariance
        self.lasting = self.lasting + float(shapes.lasts[which]) * covariance

    def weights(self) -> Weights:
        """Return how probable each shape is as the next one, by its marginal likelihood."""
        inverse, rest, shapes = self.inverse, self.rest, self.shapes
        pull = inverse @ shapes.column
        precision = np.einsum('ns,gns->gs', shapes.column, pull)
        own = shapes.deviation**-2.0
        variance = 1.0 / (precision + own)
        size = variance * (np.einsum('n,gns->gs', rest, pull) + own * shapes.mean)
        ratio = 0.5 * (
            size**2 / variance - own * shapes.mean**2 - np.log1p(shapes.deviation**2 * precision)
        )
        chi = np.einsum('i,gij,j->g', rest, inverse, rest)
        prior = np.log(np.array(self.prior.pairs)) if self.prior.pairs else GRID.prior
        plain = prior + 0.5 * (np.linalg.slogdet(inverse)[1] - chi)
        logarithm = plain[:, None] + np.concatenate(
            [np.zeros((len(plain), 1)), ratio + shapes.prior], axis=1
        )
        probability = np.exp(logarithm - logarithm.max())
        return Weights(np.asarray(probability / probability.sum()), size, variance)

    def if_changed(self, weights: Weights) -> Weights:
        """
        Return the weights of an axis of which a change is expected lately.

        An interval has to hold if a change has come, however rare that is.

        """
        time, shapes = self.logs.time, self.shapes
        lately = shapes.lasts & (time[-1] - time[shapes.onset] <= RAMPS[0])
        odds = max(float(np.exp(shapes.prior[lately]).sum()), 1e-9)
        factor = np.concatenate([[1.0], np.where(lately, max(CHANGED_ODDS / odds, 1.0), 1.0)])
        probability = weights.probability * factor
        return weights._replace(probability=probability / probability.sum())

    def mixture(
        self, weights: Weights, pull: Array, variance: float | Array, sizes: Array
    ) -> Mixture:
        """
        Return a number that is linear in the effects, over all hypotheses.

        `pull` is its prior covariance with the effects of the logs, `variance` its own; `sizes` is
        what it has of the size of each shape.

        """
        every = np.broadcast_to(pull, (len(GRID.prior), len(self.rest)))
        left = np.einsum('gij,gj->gi', self.inverse, every)
        plain = left @ self.rest
        own = variance - (pull * left).sum(axis=1)
        share = sizes - left @ self.shapes.column
        mean = np.concatenate([plain[:, None], plain[:, None] + share * weights.size], axis=1)
        spread = np.concatenate([own[:, None], own[:, None] + share**2 * weights.variance], axis=1)
        return Mixture(weights.probability, mean, np.sqrt(np.maximum(spread, 1e-12)))


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
    model, unproven, onset = Model(logs, warm=warm, prior=prior), 1.0, -1
    shapes = model.shapes
    for _ in range(MOST_SHAPES):
        weights = model.weights()
        likely = weights.shapes
        passing = 1.0 - float(likely[shapes.lasts].sum())
        unproven = min(unproven, passing)
        if passing < ACCEPTED:
            best = int(np.where(shapes.lasts, likely, -1.0).argmax())
            onset = int(shapes.onset[best])
        else:
            best = int(np.where(shapes.lasts, -1.0, likely).argmax())
            if likely[best] <= weights.none or shapes.lasts[best]:
                break
        model.hold(best)
    if onset < 0 and unproven < 0.5:
        onset = int(shapes.onset[np.where(shapes.lasts, likely, -1.0).argmax()])
    apart = now / now.sum() - baseline / baseline.sum()
    pull = model.signal @ apart
    change = model.mixture(model.if_changed(weights), pull, pull @ apart, apart @ shapes.column)
    lasting, last = model.lasting[-1], shapes.column[-1] * shapes.lasts
    variance = prior.doubt**2
    slope = model.mixture(weights, variance * logs.warmth, variance, 0.0 * last)
    pairs = weights.probability.sum(axis=1)
    steps = slice(0, max(len(logs.time) - IN_A_ROW + 1 - FIRST_CHANGE, 0))
    return Estimate(
        change=change.value + float(apart @ model.added),
        deviation=math.hypot(change.spread, MODEL_DOUBT),
        lasts=model.mixture(weights, lasting, lasting[-1], last),
        unproven=unproven,
        slope=prior.slope + slope.value,
        slope_deviation=slope.spread,
        pairs=pairs,
        onset=onset,
        recent=np.sqrt(pairs @ weights.variance[:, steps]),
    )
