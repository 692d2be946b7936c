# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Detection of a change of the friction: a look after each log, and the condition that is latched.

A look compares the last logs with the baseline by the mixed model. The condition follows from
looks in their order, so that it is a function of the logs alone and nothing flaps.

"""

from collections.abc import Iterable, Iterator
import math
from typing import NamedTuple

from ballscrew_monitor.health.history import effects_of, History
from ballscrew_monitor.health.mixed import (
    CHANGE,
    CHANGE_RATE,
    Estimate,
    estimate,
    FIRST_CHANGE,
    Logs,
    Prior,
    USUAL,
)
from ballscrew_monitor.health.records import Condition, TOLERANCE
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
BASELINE_DAYS = 91.0
"""Days of the first logs that are the baseline."""
FEWEST_LOGS = 3
"""Logs of a baseline, and of the logs that are compared where they come monthly: two."""
NOW = 4
"""Logs that count as now."""
SPARSE = 20.0
"""Days between logs from which two of them count as now."""
EIGHT_WEEKS = 56.0
"""Days within which a loss is to be found, and after which older logs are merged to weeks."""
A_DAY, MERGED, MERGED_OLD, FEW = 0.75, 2.5, 6.0, 60
"""
Days within which logs count as one: of up to 60 logs those of a day, else those of some days, and
of a week where they are older than eight.

"""
DOUBT = 0.05
"""Probability at which a change is worse: that nothing lasting has come beyond the tolerance."""
RUNNING_IN = 0.1
"""Loss that a new screw may have while it runs in, in the days of the baseline [-]."""
SLIGHT_99 = 2.575829
NARROW = 0.08
"""Half width of an interval that holds zero, up to which an axis is normal [-]."""
RECOVERY = 56.0
"""Days within the tolerance after which a latched condition ends."""
NORMAL_95 = 1.959964
DOUBT_SIGMAS, MISSED_SIGMAS = 1.645, 1.282
"""Normal quantiles of the doubt, and of what nine of ten cases have."""
UNFORESEEN = 1.35
"""What eight weeks to come have of doubt beyond the last ones [-], as measured."""


class Look(NamedTuple):
    """
    Comparison of the last logs until `log` with the baseline.

    `change` with its 95 % interval `low` to `high` is relative [-]; `raised` is the sign of a
    change that is worse, 0 for none; `shifted` that of one that is proven at all. `doubt` is the
    probability that nothing lasting has come beyond the tolerance. `smallest` is the loss that
    nine of ten times shows within eight weeks [-]. `baseline` and `now` count logs, the first up
    to `baseline_end`, the last from `now_begin` on [days]; `onset` is the log with which the
    change began. NaN where nothing is compared, for the `reason`.

    """

    log: int
    time: float
    change: float = math.nan
    low: float = math.nan
    high: float = math.nan
    raised: int = 0
    shifted: int = 0
    doubt: float = 1.0
    smallest: float = math.nan
    slope: float = math.nan
    baseline: int = 0
    now: int = 0
    baseline_end: float = math.nan
    now_begin: float = math.nan
    onset: int = -1
    reason: str = ''

    @property
    def is_known(self) -> bool:
        """Return True if there is an interval."""
        return math.isfinite(self.change)


def looks(
    history: History, *, baseline_days: float = BASELINE_DAYS, prior: Prior = USUAL
) -> Iterator[Look]:
    """Yield a look after each log of a history."""
    for count in range(1, len(history.start) + 1):
        yield look(history.until(count), baseline_days=baseline_days, prior=prior)


def look(history: History, *, baseline_days: float = BASELINE_DAYS, prior: Prior = USUAL) -> Look:
    """Return the comparison of the last logs of a history with its first ones."""
    effects = effects_of(history)
    index, time = len(history.start) - 1, history.time
    if not effects.compared[-1]:
        reason = 'the last log shares no speed and load with the logs before'
        return Look(index, float(time[-1]), reason=reason)
    compared = np.flatnonzero(effects.compared)
    bins = bins_of(time[compared])
    logs = binned(effects.logs, [compared[part] for part in bins])
    now = np.arange(len(bins)) >= len(bins) - now_of(logs.time)
    baseline = baseline_of(logs.time, now, baseline_days)
    sizes = np.array([len(part) for part in bins])
    if baseline.sum() < FEWEST_LOGS:
        known = len(logs.time)
        reason = f'{known} logs so far, a baseline needs {FEWEST_LOGS} and then two more'
        return Look(index, float(time[-1]), reason=reason)
    found = estimate(logs, baseline, now, warm=history.warm, prior=prior)
    first = [int(compared[part[0]]) for part in bins]
    seen = _look(found, provisional=float(time[-1] - time[compared[0]]) <= baseline_days)
    seen = seen._replace(
        log=index,
        time=float(time[-1]),
        smallest=smallest_loss(found, logs.time),
        baseline=int(sizes[baseline].sum()),
        now=int(sizes[now].sum()),
        baseline_end=float(time[compared[bins[int(baseline.sum()) - 1][-1]]]),
        now_begin=float(time[first[int(now.argmax())]]),
        onset=first[found.onset] if found.onset >= 0 else first[int(now.argmax())],
    )
    return seen if now.sum() > 2 or _both_beyond(logs, baseline, seen) else seen._replace(raised=0)


def _both_beyond(logs: Logs, baseline: NDArray[np.bool_], seen: Look) -> bool:
    """Return True if both logs that are now lie beyond the tolerance: one run may be odd."""
    values = logs.effect - seen.slope * logs.warmth
    apart = values[-2:] - float(np.mean(values[baseline]))
    return bool((seen.raised * apart > TOLERANCE).all())


def _look(found: Estimate, *, provisional: bool) -> Look:
    sign = -1 if found.lasts.value < 0.0 else 1
    usual = RUNNING_IN if provisional and sign < 0 else TOLERANCE
    doubt = max(found.lasts.within(usual, sign), found.unproven)
    reach = NORMAL_95 * found.deviation
    shifted = abs(found.change) > SLIGHT_99 * found.deviation
    return Look(
        log=-1,
        time=math.nan,
        change=math.expm1(found.change),
        low=math.expm1(found.change - reach),
        high=math.expm1(found.change + reach),
        raised=sign if doubt < DOUBT else 0,
        shifted=int(math.copysign(shifted, found.change)),
        doubt=doubt,
        slope=found.slope,
    )


def smallest_loss(found: Estimate, time: Array) -> float:
    """
    Return the loss [-] that would be worse within eight weeks in nine of ten cases.

    It has to be beyond the tolerance, and more likely than that nothing came. `time` [days] of
    the logs.

    """
    if not len(found.recent):
        return math.nan
    ago = np.abs(time[-1] - time[FIRST_CHANGE:][: len(found.recent)] - EIGHT_WEEKS)
    deviation = float(found.recent[int(ago.argmin())])
    odds = math.log((1.0 - DOUBT) / DOUBT / (CHANGE_RATE * EIGHT_WEEKS))
    proven = deviation * math.sqrt(2.0 * odds + 2.0 * math.log(max(CHANGE / deviation, 1.0)))
    size = max(proven, TOLERANCE + DOUBT_SIGMAS * deviation) + MISSED_SIGMAS * deviation
    return -math.expm1(-UNFORESEEN * size)


def bins_of(time: Array) -> list[NDArray[np.int64]]:
    """Return the logs of some days that count as one, of a week for old ones; `time` [days]."""
    width = np.where(time[-1] - time > EIGHT_WEEKS, MERGED_OLD, MERGED)
    width = np.full(len(time), A_DAY) if len(time) <= FEW else width
    begin, first = -math.inf, []
    for at, (here, length) in enumerate(zip(time.tolist(), width.tolist(), strict=True)):
        if here - begin >= length:
            first.append(at)
            begin = here
    return np.split(np.arange(len(time)), first[1:])


def binned(logs: Logs, bins: Iterable[NDArray[np.int64]]) -> Logs:
    """Return the logs of each bin as one: what logs of some days share does not become less."""
    rows = []
    for part in bins:
        share = 1.0 / logs.noise[part]
        share = share / share.sum()
        means = (float(share @ values[part]) for values in logs[:3])
        rows.append((*means, float(np.mean(logs.noise[part])) / min(len(part), 3)))
    return Logs(*np.array(rows).T)


def baseline_of(time: Array, now: NDArray[np.bool_], baseline_days: float) -> NDArray[np.bool_]:
    """Return which logs are the baseline: those of its days [days], or the first three."""
    first = time - time[0] <= baseline_days
    first[:FEWEST_LOGS] = True
    return np.asarray(first & ~now)


def now_of(time: Array) -> int:
    """Return how many logs are now, four or two if monthly, by their `time` [days]."""
    if len(time) <= FEWEST_LOGS + 2:
        return 2
    spacing = float(np.median(np.diff(time[-6:])))
    wanted = 2 if spacing > SPARSE else NOW
    return min(wanted, len(time) - FEWEST_LOGS)


class Latched(NamedTuple):
    """Condition after a look, and the index of the log since which it has changed, -1 for none."""

    condition: Condition
    since: int


def latched(seen: Iterable[Look]) -> list[Latched]:
    """
    Return the condition after each look.

    Worse and slightly changed stay until the change was eight weeks within the tolerance, or not
    proven.

    """
    course, state, since, left = [], Condition.UNKNOWN, -1, math.nan
    for here in seen:
        if not here.is_known:
            course.append(Latched(state if since >= 0 else Condition.UNKNOWN, since))
            continue
        if here.raised:
            since = here.onset if state is not Condition.WORSE else since
            state, left = Condition.WORSE, math.nan
        elif state is Condition.WORSE or (since >= 0 and not here.shifted):
            inside = abs(here.change) <= TOLERANCE if state is Condition.WORSE else True
            left = (here.time if math.isnan(left) else left) if inside else math.nan
            if here.time - left >= RECOVERY:
                state, since, left = _unlatched(here), -1, math.nan
        elif here.shifted:
            since = here.onset if since < 0 else since
            state, left = Condition.SLIGHTLY_CHANGED, math.nan
        else:
            state = _unlatched(here)
        course.append(Latched(state, since))
    return course


def _unlatched(here: Look) -> Condition:
    half = 0.5 * (here.high - here.low)
    return Condition.NORMAL if half <= NARROW else Condition.UNKNOWN
