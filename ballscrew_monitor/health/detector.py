# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Detector of a change in a series of readings: a self-starting CUSUM without a look-ahead.

Each reading is held against mean and spread of the readings before it, so that no series of
known normal readings is needed: Hawkins, The Statistician 36 (1987) 299. The readings are those of
reference runs, which are few: beside a screw that is measured once in a while, an interval that
holds for all that may drift says nothing for long.

"""

from collections.abc import Iterable, Sequence
import dataclasses
import math

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.health.baseline import Motion, RUNNING_IN
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint, LoadSource
from ballscrew_monitor.health.rows import DAY
import numpy as np

SLACK, LIMIT = 0.5, 3.7
"""
Reference value k and decision limit h [standard deviations]: without a change a false alarm in 124
readings on average, in one of six series of 30.
"""
FEWEST = 3
"""Readings from which on the next one is scored: two degrees of freedom and more."""
FLOOR = 0.01
"""Least spread over the mean of the readings [-]."""
DAILY_LIMIT, DAILY_FLOOR = 8.0, 0.03
"""Both of readings that come daily: what drifts by the season is no change."""


@dataclasses.dataclass(slots=True)
class SelfStarting:
    """
    Mean and sum of squares of the readings so far, the two sums, and the number of readings.

    `floor` [-] is the least spread over the mean.

    """

    floor: float = FLOOR
    count: int = 0
    mean: float = 0.0
    squares: float = 0.0
    high: float = 0.0
    low: float = 0.0

    def score(self, reading: float) -> float:
        """Return the standard normal score of a reading by those before it; NaN for too few."""
        if self.count < FEWEST:
            return math.nan
        freedom = self.count - 1
        spread = max(math.sqrt(self.squares / freedom), self.floor * abs(self.mean))
        if spread == 0.0:
            return math.copysign(math.inf, reading) if reading else 0.0
        ratio = (reading - self.mean) / spread * math.sqrt(self.count / (self.count + 1))
        return normal_score_wallace_1959(ratio, freedom)

    def take(self, reading: float) -> float:
        """Add a reading after it was scored by those before it; return the larger sum."""
        score = self.score(reading)
        if not math.isnan(score):
            self.high = max(0.0, self.high + score - SLACK)
            self.low = max(0.0, self.low - score - SLACK)
        self.count += 1
        step = reading - self.mean
        self.mean += step / self.count
        self.squares += step * (reading - self.mean)
        return max(self.high, self.low)


def first_alarm(
    series: Iterable[tuple[float, float]], *, limit: float = LIMIT, floor: float = FLOOR
) -> float | None:
    """
    Return the time in motion [s] at which a change is told in a series; None for no change.

    The series has times in motion [s] with readings, in order. Those before `RUNNING_IN` are set
    aside, as in a baseline; readings that are not finite are left out.

    """
    state = SelfStarting(floor)
    for time, reading in series:
        usable = time >= RUNNING_IN and math.isfinite(reading)
        if usable and state.take(reading) >= limit:
            return time
    return None


def note_on_runs(
    points: Sequence[ComparablePoint], motion: Motion, model: Model, *, always_free: bool = False
) -> str:
    """
    Return in a sentence since when friction free of load differs from that before, or ''.

    The reading of a day is its measured friction over that of the model, at the places of its run,
    or of all its motion where an axis is `always_free` of process force;
    `motion` [s] of each day tells how long the screw has run in.

    """
    runs = [one for one in points if one.load_source is LoadSource.FREE]
    days = sorted({one.first_day for one in runs})
    readings = [_reading([one for one in runs if one.first_day == day], model) for day in days]
    times = [sum(time for one, time in motion.items() if one <= day) for day in days]
    daily = {'limit': DAILY_LIMIT, 'floor': DAILY_FLOOR} if always_free else {}
    alarm = first_alarm(zip(times, readings), **daily)
    if alarm is None:
        return ''
    at = times.index(alarm)
    before = [one for time, one in zip(times[:at], readings) if time >= RUNNING_IN]
    change = readings[at] / np.nanmean(before) - 1.0
    return (
        f'the friction without process force of {clock_text(days[at] * DAY)[:10]} differs by '
        f'{100.0 * change:+.0f} % from the readings before, more than those scatter'
    )


def _reading(run: Sequence[ComparablePoint], model: Model) -> float:
    """Return the measured over the modelled friction of a run [-], NaN outside the surface."""
    modelled, stretches = model.friction(run), np.array([one.stretches for one in run])
    measured = np.array([model.measured(one) for one in run])
    known = np.isfinite(modelled)
    total = float(stretches[known] @ modelled[known])
    return float(stretches[known] @ measured[known]) / total if total > 0.0 else math.nan


def normal_score_wallace_1959(ratio: float, freedom: int) -> float:
    """
    Return the standard normal deviate of the probability of Student's t [-].

    Within 0.03 below t = 5 for 3 degrees of freedom and more: Wallace, Ann. Math. Statist. 30
    (1959) 1124.

    """
    nu = float(freedom)
    amount = (8 * nu + 1) / (8 * nu + 3) * math.sqrt(nu * math.log1p(ratio * ratio / nu))
    return math.copysign(amount, ratio)


def run_length_siegmund_1985(slack: float, limit: float, shift: float = 0.0) -> float:
    """
    Return the mean number of readings until a one-sided CUSUM alarms [-].

    Readings have standard deviation 1 and mean `shift`; with b = h + 1.166 and d = k - shift,
    (exp(2 d b) - 2 d b - 1) / (2 d2): Siegmund, Sequential Analysis (1985), eq. 2.56.

    """
    end, drift = limit + 1.166, slack - shift
    if abs(drift) < 1e-6:
        return end * end
    exponent = min(2 * drift * end, 700.0)
    return (math.exp(exponent) - exponent - 1.0) / (2 * drift * drift)
