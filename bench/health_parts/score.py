# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Score of the assessment of a year: when it found the change, and its words for it.

The axis is assessed every four weeks. Where that says worse for the first time, the days since the
time before are gone through by halves for the first of them.

"""

from collections.abc import Callable, Sequence
import dataclasses
import math

from ballscrew_monitor.health.assess import Compared
from ballscrew_monitor.health.baseline import learned
from ballscrew_monitor.health.records import (
    Baseline,
    CauseCode,
    ComparablePoint,
    Condition,
    Quantity,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.words import explained
from health_parts.programmes import DAYS
from health_parts.years import FIRST_DAY, Truth, Year
import numpy as np

NAN = math.nan
WEEK, PERIOD = 7, 28
"""Days that count as now, and days between two assessments."""


Compare = Callable[[int, Baseline, Sequence[ComparablePoint]], Compared]
"""The product with its surfaces: takes the last day, since 1970, a baseline and points."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Score:
    """
    What came of one year.

    `size` of the change and that of the drag at the first alarm [-], NaN if there was none;
    alarms before the change with the days that had none of it; whether each interval that was
    given holds the truth; the causes that are named at the end, the likeliest first.

    """

    truth: Truth
    size: float = NAN
    drag: float = NAN
    early_alarms: int = 0
    clean_days: int = 0
    held: dict[str, bool] = dataclasses.field(default_factory=dict)
    causes: tuple[CauseCode, ...] = ()
    condition: Condition = Condition.UNKNOWN
    problem: str = ''

    @property
    def is_right(self) -> bool:
        """Tell whether the likeliest cause is the true one."""
        return bool(self.causes) and self.causes[0] in self.truth.value

    @property
    def is_named(self) -> bool:
        """Tell whether the true cause is among those named."""
        return any(one in self.truth.value for one in self.causes)


def score(year: Year, compare: Compare) -> Score:
    """Return what the assessments of a year are worth."""
    truth = year.kind.truth
    baseline = learned(year.points)
    if isinstance(baseline, str):
        return Score(truth=truth, problem=baseline)
    begin = baseline.end // DAY - FIRST_DAY
    changed = _first_change(year)

    def asked(day: int) -> tuple[int, Baseline, list[ComparablePoint]]:
        last = FIRST_DAY + day
        return last, baseline, [one for one in year.points if one.first_day <= last]

    def is_worse(day: int) -> bool:
        return compare(*asked(day)).condition is Condition.WORSE

    early, before, found = 0, False, None
    for day in range(begin + PERIOD, DAYS, PERIOD):
        alarmed = is_worse(day)
        early += alarmed and not before and day < changed
        before = alarmed
        if alarmed and day >= changed:
            found = day
            break
    if found is not None:
        found = _first_alarm(is_worse, max(found - PERIOD, changed), found)
    final = compare(*asked(DAYS - 1))
    return Score(
        truth=truth,
        size=NAN if found is None else abs(float(year.size[found])),
        drag=NAN if found is None else abs(true_drag(year, begin, found)),
        early_alarms=early,
        clean_days=max(min(changed, DAYS) - begin, 0),
        held=held_by(year, begin, final, DAYS - 1),
        causes=named_causes(final),
        condition=final.condition,
    )


def _first_change(year: Year) -> int:
    """Return the first day with a change, that after the last without one."""
    changed = np.flatnonzero(year.size)
    return int(changed[0]) if changed.size else DAYS


def _first_alarm(is_worse: Callable[[int], bool], low: int, high: int) -> int:
    """Return the first day after `low` that says worse, `high` at the latest."""
    while high - low > 1:
        middle = (low + high) // 2
        if is_worse(middle):
            high = middle
        else:
            low = middle
    return high


def named_causes(found: Compared) -> tuple[CauseCode, ...]:
    """Return the causes that the verdict names, as `words` does, the likeliest first."""
    _, likely = explained(NAN, found.causes)
    return tuple(one.code for one in likely)


def held_by(year: Year, begin: int, found: Compared, day: int) -> dict[str, bool]:
    """Return by quantity whether its interval holds the truth on a day, where it is given."""
    truths = {'drag change': true_drag(year, begin, day), 'preload': true_preload(year, day)}
    given = {one.name: one for one in (found.drag, found.preload)}
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
