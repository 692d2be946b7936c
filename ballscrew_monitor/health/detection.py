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
BASELINE_DAYS = 91.0  # days of the first logs that are the baseline
FEWEST_LOGS = 3  # of a baseline
NOW = 4  # logs that count as now, two where they come monthly
SPARSE = 20.0  # days between logs from which two of them count as now
EIGHT_WEEKS = 56.0  # days until a loss is to be found, and after which logs are merged to weeks
A_DAY, MERGED, MERGED_OLD, FEW = 0.75, 2.5, 6.0, 60
"""
Days within which logs count as one: of up to 60 logs those of a day, else those of some days, and
of a week where they are older than eight.

"""
DOUBT = 0.05  # probability at which a change is worse: nothing lasting beyond the tolerance
RUNNING_IN = 0.1  # loss that a new screw may have in the days of the baseline [-]
SLIGHT_99, NORMAL_95 = 2.575829, 1.959964  # quantiles of two sides
NARROW = 0.08  # half width of an interval that holds zero, up to which an axis is normal [-]
RECOVERY = 56.0  # days within the tolerance after which a latched condition ends
DOUBT_SIGMAS, MISSED_SIGMAS = 1.645, 1.282  # quantiles of the doubt, and of nine of ten cases
UNFORESEEN = 1.35  # doubt of eight weeks to come over that of the last ones [-], as measured


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
    logs, bins = binned_logs(history)
    index, time = len(history.start) - 1, history.time
    if bins[-1][-1] != index:
        reason = 'the last log shares no speed and load with the logs before'
        return Look(index, float(time[-1]), reason=reason)
    now = np.arange(len(bins)) >= len(bins) - now_of(logs.time)
    baseline = baseline_of(logs.time, now, baseline_days)
    sizes = np.array([len(part) for part in bins])
    if baseline.sum() < FEWEST_LOGS:
        needed = FEWEST_LOGS + 2
        reason = f'{min(len(logs.time), needed)} of {needed} logs'
        return Look(index, float(time[-1]), reason=reason)
    change = estimate(logs, baseline, now, warm=history.warm, prior=prior)
    first = [int(part[0]) for part in bins]
    sign = -1 if change.lasts.value < 0.0 else 1
    provisional = float(time[-1] - time[first[0]]) <= baseline_days
    usual = RUNNING_IN if provisional and sign < 0 else TOLERANCE
    doubt = max(change.lasts.within(usual, sign), change.unproven)
    is_worse = doubt < DOUBT
    if is_worse and now.sum() <= 2:  # one run may be odd: both lie beyond the tolerance
        effects = logs.effect - change.slope * logs.warmth
        apart = effects[-2:] - float(np.mean(effects[baseline]))
        is_worse = bool((sign * apart > TOLERANCE).all())
    reach = NORMAL_95 * change.deviation
    proven = abs(change.change) > SLIGHT_99 * change.deviation
    return Look(
        log=index,
        time=float(time[-1]),
        change=math.expm1(change.change),
        low=math.expm1(change.change - reach),
        high=math.expm1(change.change + reach),
        raised=sign if is_worse else 0,
        shifted=int(math.copysign(proven, change.change)),
        doubt=doubt,
        smallest=smallest_loss(change, logs.time),
        slope=change.slope,
        baseline=int(sizes[baseline].sum()),
        now=int(sizes[now].sum()),
        baseline_end=float(time[bins[int(baseline.sum()) - 1][-1]]),
        now_begin=float(time[first[int(now.argmax())]]),
        onset=first[change.onset if change.onset >= 0 else int(now.argmax())],
    )


def smallest_loss(change: Estimate, time: Array) -> float:
    """
    Return the loss [-] that would be worse within eight weeks in nine of ten cases.

    It has to be beyond the tolerance, and more likely than that nothing came. `time` [days] of
    the logs.

    """
    if not len(change.recent):
        return math.nan
    ago = np.abs(time[-1] - time[FIRST_CHANGE:][: len(change.recent)] - EIGHT_WEEKS)
    deviation = float(change.recent[int(ago.argmin())])
    odds = math.log((1.0 - DOUBT) / DOUBT / (CHANGE_RATE * EIGHT_WEEKS))
    proven = deviation * math.sqrt(2.0 * odds + 2.0 * math.log(max(CHANGE / deviation, 1.0)))
    size = max(proven, TOLERANCE + DOUBT_SIGMAS * deviation) + MISSED_SIGMAS * deviation
    return -math.expm1(-UNFORESEEN * size)


def binned_logs(history: History) -> tuple[Logs, list[NDArray[np.int64]]]:
    """Return the logs that can be compared, those of some days as one, and which ones each has."""
    effects = effects_of(history)
    compared = np.flatnonzero(effects.compared)
    bins = [compared[part] for part in bins_of(history.time[compared])]
    return binned(effects.logs, bins), bins


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


def latched(course: Iterable[Look]) -> list[tuple[Condition, int]]:
    """
    Return the condition after each look, and the log since which it has changed, -1 for none.

    Worse and slightly changed stay until the change was eight weeks within the tolerance, or not
    proven.

    """
    states, state, since, left = [], Condition.UNKNOWN, -1, math.nan
    for here in course:
        narrow = 0.5 * (here.high - here.low) <= NARROW
        unchanged = Condition.NORMAL if narrow else Condition.UNKNOWN
        worse = state is Condition.WORSE
        if not here.is_known:
            state = state if since >= 0 else Condition.UNKNOWN
        elif here.raised:
            since = since if worse else here.onset
            state, left = Condition.WORSE, math.nan
        elif worse or (since >= 0 and not here.shifted):
            inside = abs(here.change) <= TOLERANCE or not worse
            left = (here.time if math.isnan(left) else left) if inside else math.nan
            if here.time - left >= RECOVERY:
                state, since, left = unchanged, -1, math.nan
        elif here.shifted:
            since = here.onset if since < 0 else since
            state, left = Condition.SLIGHTLY_CHANGED, math.nan
        else:
            state = unchanged
        states.append((state, since))
    return states
