# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What the assessment of a year is worth: when it found the change, and what it said of it.

The axis is assessed once a week. Where that says worse for the first time, the days since the week
before are gone through by halves for the first of them.

"""

from collections.abc import Callable, Sequence
import dataclasses
import math

from ballscrew_monitor.health.baseline import learned
from ballscrew_monitor.health.records import Baseline, CauseCode, Condition, Health, Quantity
from ballscrew_monitor.health.rows import DAY
from health_parts.programmes import DAYS
from health_parts.years import FIRST_DAY, Truth, Year
import numpy as np

NAN = math.nan
WEEK = 7
Assess = Callable[[int, Baseline, Sequence], Health]
"""Returns the health at a time [ns] out of a baseline and points."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Score:
    """
    What came of one year.

    `size` of the change and that of the drag at the first alarm [-], NaN if there was none;
    alarms before the change with the days that had none of it; whether each interval that was
    given holds the truth; the cause that comes first at the end, and whether the right one was
    excluded.

    """

    truth: Truth
    size: float = NAN
    drag: float = NAN
    early_alarms: int = 0
    clean_days: int = 0
    held: dict[str, bool] = dataclasses.field(default_factory=dict)
    first_cause: CauseCode | None = None
    right_excluded: bool = False
    problem: str = ''

    @property
    def is_right(self) -> bool:
        """Tell whether the first cause is the true one."""
        return self.first_cause in self.truth.value


def score(year: Year, assess: Assess) -> Score:
    """Return what the assessments of a year are worth."""
    truth = year.kind.truth
    baseline = learned(year.points)
    if isinstance(baseline, str):
        return Score(truth=truth, problem=baseline)
    begin = baseline.end // DAY - FIRST_DAY
    changed = _first_change(year)

    def ask(day: int) -> Health:
        now = (FIRST_DAY + day + 1) * DAY
        return assess(now, baseline, [p for p in year.points if p.first_day <= FIRST_DAY + day])

    early, before, found = 0, False, None
    last = None
    for day in range(begin + WEEK, DAYS, WEEK):
        last = ask(day)
        alarmed = last.condition is Condition.WORSE
        if alarmed and not before and day < changed:
            early += 1
        if alarmed and day >= changed:
            found = day
            break
        before = alarmed
    if found is not None:
        found = _first_alarm(ask, max(found - WEEK, changed), found)
    final = ask(DAYS - 1)
    return Score(
        truth=truth,
        size=NAN if found is None else abs(float(year.size[found])),
        drag=NAN if found is None else abs(true_drag(year, begin, found)),
        early_alarms=early,
        clean_days=max(min(changed, DAYS) - begin, 0),
        held=held_by(year, begin, final, DAYS - 1),
        first_cause=first_cause(final),
        right_excluded=any(c.excluded for c in final.causes if c.code in truth.value),
    )


def _first_change(year: Year) -> int:
    """Return the first day with a change, that after the last without one."""
    changed = np.flatnonzero(year.size)
    return int(changed[0]) if changed.size else DAYS


def _first_alarm(ask: Callable[[int], Health], low: int, high: int) -> int:
    """Return the first day after `low` that says worse, `high` at the latest."""
    while high - low > 1:
        middle = (low + high) // 2
        if ask(middle).condition is Condition.WORSE:
            high = middle
        else:
            low = middle
    return high


def first_cause(health: Health) -> CauseCode | None:
    """Return the cause with the most weight among those not excluded."""
    left = [cause for cause in health.causes if not cause.excluded]
    return max(left, key=lambda cause: cause.weight).code if left else None


def held_by(year: Year, begin: int, health: Health, day: int) -> dict[str, bool]:
    """Return by quantity whether its interval holds the truth on a day, where it is given."""
    truths = {'drag change': true_drag(year, begin, day), 'preload': true_preload(year, day)}
    given = {one.name: one for one in health.quantities}
    return {
        name: holds(given[name], value)
        for name, value in truths.items()
        if name in given and given[name].is_known and math.isfinite(value)
    }


def holds(quantity: Quantity, value: float) -> bool:
    """Tell whether an interval holds a value [-]; percent are of hundred."""
    scale = 100.0 if quantity.unit == '%' else 1.0
    return quantity.low <= scale * value <= quantity.high


def true_drag(year: Year, begin: int, day: int) -> float:
    """Return the change of friction in the last week [-]; NaN where the torque is wrong."""
    if year.kind.truth is Truth.TORQUE_GAIN:
        return NAN
    return year.drag_change(day - WEEK + 1, day, year.groups_until(begin))


def true_preload(year: Year, day: int) -> float:
    """Return the preload over that of the baseline [-]; NaN where something else changes."""
    if not year.kind.truth.name.startswith(('PRELOAD', 'NOTHING')):
        return NAN
    return 1.0 - float(year.size[day])
