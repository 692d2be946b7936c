# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Detection of a change of the friction: a look after each log, and the condition that is latched.

A look compares the last logs with the baseline by the mixed model. The condition follows from
looks in their order, so that it is a function of the logs alone and nothing flaps.

"""

from collections.abc import Iterable, Iterator, Sequence
import math
from typing import NamedTuple

from ballscrew_monitor.health.history import calmed, Effects, effects_of, History
from ballscrew_monitor.health.mixed import Estimate, estimate, Logs, Prior, USUAL, weights_of
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
BLOCK_DAYS = 56.0
"""Days over which logs between baseline and now share one change."""
A_DAY, MERGED, MERGED_OLD, FEW = 0.75, 2.5, 6.0, 60
"""
Days within which logs count as one: of up to 60 logs those of a day, else those of some days, and
of a week where they are older than a block.

"""
NO_CHANGE, WITHIN_TOLERANCE = 4e-4, 0.01
"""
Probabilities at which a change is worse: that there is none, and that it is within the tolerance.

At these, about two clean years of a hundred end in a false alarm: 3 of 180 that were played.

"""
RUNNING_IN = 0.1
"""Loss that a new screw may have while it runs in, in the days of the baseline [-]."""
SLIGHT = 0.005
"""Probability of no change at which an axis has slightly changed."""
NARROW = 0.08
"""Half width of an interval that holds zero, up to which an axis is normal [-]."""
RECOVERY = 56.0
"""Days within the tolerance after which a latched condition ends."""
NORMAL_95 = 1.959964
ALARM_SIGMAS, TOLERANCE_SIGMAS, MISSED_SIGMAS = 3.35, 2.33, 0.6
"""Normal quantiles of the two probabilities, and what a loss found in nine of ten has beyond."""


class Look(NamedTuple):
    """
    Comparison of the last logs until `log` with the baseline.

    `change` with its 95 % interval `low` to `high` is relative [-]; `raised` is the sign of a
    change that is worse, 0 for none; `shifted` that of one that is proven at all. `chance` is the
    p-value of no change [-], 1 in the days of the baseline. `smallest` is
    the loss that nine of ten times shows within eight weeks [-]. `baseline` and `now` count logs,
    the first up to `baseline_end`, the last from `now_begin` on [days].
    NaN where nothing is compared, for the `reason`.

    """

    log: int
    time: float
    change: float = math.nan
    low: float = math.nan
    high: float = math.nan
    raised: int = 0
    shifted: int = 0
    chance: float = 1.0
    smallest: float = math.nan
    slope: float = math.nan
    baseline: int = 0
    now: int = 0
    baseline_end: float = math.nan
    now_begin: float = math.nan
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
    index, time = len(history.start) - 1, float(history.time[-1])
    if not effects.compared[-1]:
        reason = 'the last log shares no speed and load with the logs before'
        return Look(index, time, reason=reason)
    logs = calmed(binned(_chosen(effects.logs, effects.compared)))
    parts = blocks_of(logs.time, baseline_days)
    if parts is None:
        known = len(logs.time)
        reason = f'{known} logs so far, a baseline needs {FEWEST_LOGS} and then two more'
        return Look(index, time, reason=reason)
    step = step_of(logs.effect - prior.slope * logs.warmth, int((parts == 0).sum()))
    before, blocks = _before(logs.time, parts, baseline_days), cut_at_step(parts, step)
    weight = weights_of(logs.until(len(before)), before, warm=history.warm, prior=prior)
    found = estimate(logs, blocks, weight, warm=history.warm, step=step, prior=prior)
    provisional = time - logs.time[0] <= baseline_days
    seen = _look(index, logs.time, found, blocks, RUNNING_IN if provisional else TOLERANCE)
    return seen if seen.now > 2 or _both_beyond(logs, blocks, seen) else seen._replace(raised=0)


def _both_beyond(logs: Logs, blocks: NDArray[np.int64], seen: Look) -> bool:
    """Return True if both logs that are now lie beyond the tolerance: one run may be odd."""
    values = logs.effect - seen.slope * logs.warmth
    apart = values[-2:] - float(np.mean(values[blocks == 0]))
    return bool((seen.raised * apart > TOLERANCE).all())


def _look(
    index: int, times: Array, found: Estimate, blocks: NDArray[np.int64], usual_loss: float
) -> Look:
    sign = -1 if found.value < 0.0 else 1
    none, usual = found.beyond(0.0, sign), usual_loss if sign < 0 else TOLERANCE
    raised = none < NO_CHANGE and found.beyond(usual, sign) < WITHIN_TOLERANCE
    reach = NORMAL_95 * found.deviation
    shifted = (
        abs(found.value) > reach
        and 0.5 * math.erfc(abs(found.value) / found.deviation / math.sqrt(2.0)) < SLIGHT
    )
    return Look(
        log=index,
        time=float(times[-1]),
        change=math.expm1(found.value),
        low=math.expm1(found.value - reach),
        high=math.expm1(found.value + reach),
        raised=sign if raised else 0,
        shifted=sign if shifted else 0,
        chance=1.0 if usual_loss > TOLERANCE else min(2.0 * none, 1.0),
        smallest=smallest_loss(found),
        slope=found.slope,
        baseline=int((blocks == 0).sum()),
        now=int((blocks == blocks.max()).sum()),
        baseline_end=float(times[blocks == 0][-1]),
        now_begin=float(times[blocks == blocks.max()][0]) - MERGED,
    )


def smallest_loss(found: Estimate) -> float:
    """Return the loss [-] that would be worse within eight weeks in nine of ten cases."""
    doubt = found.lasting_deviation
    size = max(ALARM_SIGMAS * doubt, TOLERANCE + TOLERANCE_SIGMAS * doubt)
    return -math.expm1(-(size + MISSED_SIGMAS * doubt))


def _chosen(logs: Logs, which: NDArray[np.bool_]) -> Logs:
    return Logs(*(part[which] for part in logs))


def binned(logs: Logs) -> Logs:
    """Return logs with those of some days as one, and of a week where they are older."""
    age = logs.time[-1] - logs.time
    width = np.where(age > BLOCK_DAYS, MERGED_OLD, MERGED)
    width = np.full(len(age), A_DAY) if len(age) <= FEW else width
    begin, bins = -math.inf, []
    for at, (time, length) in enumerate(zip(logs.time.tolist(), width.tolist(), strict=True)):
        if time - begin >= length:
            bins.append([at])
            begin = time
        else:
            bins[-1].append(at)
    return Logs(*map(np.array, zip(*(_mean(logs, part) for part in bins), strict=True)))


def _mean(logs: Logs, part: Sequence[int]) -> tuple[float, float, float, float]:
    """Return several logs as one: what logs of some days share does not become less."""
    share = 1.0 / logs.noise[part]
    share = share / share.sum()
    noise = float(np.mean(logs.noise[part])) / min(len(part), 3)
    time, effect, warmth = (float(share @ values[part]) for values in logs[:3])
    return time, effect, warmth, noise


def blocks_of(time: Array, baseline_days: float) -> NDArray[np.int64] | None:
    """
    Return the block of each log: 0 the baseline, the last one now; None for too few logs.

    `time` [days]; the baseline is that of the first days, or of three logs.

    """
    now = _now(time)
    last = len(time) - now
    first = time - time[0] <= baseline_days
    first[:FEWEST_LOGS] = True
    first[last:] = False
    if first.sum() < FEWEST_LOGS:
        return None
    blocks: NDArray[np.int64] = np.zeros(len(time), dtype=np.int64)
    middle = ~first
    middle[last:] = False
    if middle.any():
        blocks[middle] = 1 + ((time[middle] - time[middle][0]) // BLOCK_DAYS).astype(np.int64)
        blocks[middle] = 1 + np.unique(blocks[middle], return_inverse=True)[1]
    blocks[last:] = blocks.max() + 1
    return blocks


def cut_at_step(blocks: NDArray[np.int64], step: int) -> NDArray[np.int64]:
    """Return blocks cut at the log of the largest step, lest it counts as a slope."""
    middle = (blocks > 0) & (blocks < blocks.max())
    if not middle.any():
        return blocks
    later = middle & (np.arange(len(blocks)) >= step)
    cut = 2 * blocks + later
    return np.asarray(np.unique(cut, return_inverse=True)[1], dtype=np.int64)


def step_of(values: Array, first: int) -> int:
    """Return where the values have one step, by least squares; at `first` at the earliest."""
    sums = [
        float(np.var(values[:at]) * at + np.var(values[at:]) * (len(values) - at))
        for at in range(first, len(values))
    ]
    return first + int(np.argmin(sums))


def _now(time: Array) -> int:
    """Return the number of logs that count as now: four, or two where they come monthly."""
    if len(time) <= FEWEST_LOGS + 2:
        return 2
    spacing = float(np.median(np.diff(time[-6:])))
    wanted = 2 if spacing > SPARSE else NOW
    return min(wanted, len(time) - FEWEST_LOGS)


def _before(time: Array, blocks: NDArray[np.int64], baseline_days: float) -> NDArray[np.int64]:
    """Return the blocks of the logs that tell the scatter: baseline, and up to eight weeks ago."""
    last = int((blocks < blocks.max()).sum())
    old = int((time <= time[-1] - BLOCK_DAYS).sum())
    count = min(max(old, int((blocks == 0).sum())), last)
    apart = time[:count] - time[0]
    kept = np.where(apart <= baseline_days, 0, 1 + (apart - baseline_days) // BLOCK_DAYS)
    return np.asarray(np.unique(kept, return_inverse=True)[1], dtype=np.int64)


class Latched(NamedTuple):
    """Condition after a look, and the index of the log since which it has changed, -1 for none."""

    condition: Condition
    since: int


def latched(seen: Iterable[Look], onsets: Sequence[int]) -> list[Latched]:
    """
    Return the condition after each look.

    Worse and slightly changed stay until the change was eight weeks within the tolerance, or not
    proven. `onsets` are the logs with which the change of each look began.

    """
    course, state, since, left = [], Condition.UNKNOWN, -1, math.nan
    for here, onset in zip(seen, onsets, strict=True):
        if not here.is_known:
            course.append(Latched(state if since >= 0 else Condition.UNKNOWN, since))
            continue
        if here.raised:
            since = onset if state is not Condition.WORSE else since
            state, left = Condition.WORSE, math.nan
        elif state is Condition.WORSE or (since >= 0 and not here.shifted):
            inside = abs(here.change) <= TOLERANCE if state is Condition.WORSE else True
            left = (here.time if math.isnan(left) else left) if inside else math.nan
            if here.time - left >= RECOVERY:
                state, since, left = _unlatched(here), -1, math.nan
        elif here.shifted:
            since = onset if since < 0 else since
            state, left = Condition.SLIGHTLY_CHANGED, math.nan
        else:
            state = _unlatched(here)
        course.append(Latched(state, since))
    return course


def _unlatched(here: Look) -> Condition:
    half = 0.5 * (here.high - here.low)
    return Condition.NORMAL if half <= NARROW else Condition.UNKNOWN


def onset_of(effects: Effects, blocks_from: int, index: int, slope: float) -> int:
    """
    Return the log with which a change began, by the least squares of one step.

    `blocks_from` is the first log that is not of the baseline, `index` that of the look; `slope`
    [1/K] is that of the temperature.

    """
    values = effects.logs.effect - slope * effects.logs.warmth
    return step_of(values[: index + 1], min(max(blocks_from, 1), index))
