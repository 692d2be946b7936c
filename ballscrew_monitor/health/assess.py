# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Health of an axis by the summaries of its logs: a condition after each, and causes of a change.

The change is found by the history of the axis alone. Surface and sheet explain it, and tell life
and lubrication.

"""

import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import changed_screw, in_force, motion_by_day
from ballscrew_monitor.health.causes import causes_of, likely
from ballscrew_monitor.health.change import changes_of, marks_of
from ballscrew_monitor.health.detection import BASELINE_DAYS, latched, Look, looks
from ballscrew_monitor.health.energy import energy_quantities
from ballscrew_monitor.health.history import history_of
from ballscrew_monitor.health.life import life_quantities, rated_of, recent, shaft_notes
from ballscrew_monitor.health.lubrication import (
    boundary_note,
    lubrication_rate,
    opposed,
    severity_quantities,
    usual_boundary,
)
from ballscrew_monitor.health.mixed import Prior, USUAL
from ballscrew_monitor.health.records import (
    Cause,
    CellKind,
    Condition,
    Health,
    KeptHealth,
    LoadSource,
    Quantity,
    quantity,
    unknown,
)
from ballscrew_monitor.health.remedies import remedy_text
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.summary import array_of
from ballscrew_monitor.health.usual import usual_warnings
from ballscrew_monitor.health.where import lost_motion_grew, where_on_screw
from ballscrew_monitor.health.words import advice_of, input_notes, missing_reason, verdict_of
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface

RECENT, SHORT = 28, 7
"""Days whose programme counts as that of now; the longer where the shorter has too little."""
FEWEST_CELLS = 10
DRAG, SMALLEST = 'drag change', 'smallest loss shown'
CHANGED = (Condition.WORSE, Condition.SLIGHTLY_CHANGED)
NEW_PROGRAMME = 0.5  # share of the motion at places new to the baseline: another programme [-]
ALARM_RATE = 'at most one clean year of a hundred ends in a false alarm'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class HealthSettings:
    """
    Settings of an assessment: limits of the zone, and what the machine allows.

    `speed_allowed`: advice may name another speed, which a process may not allow. The baseline has
    the logs of the first `baseline_days`. The `prior` is that of its peers, where it has any.

    """

    limits: Limits
    speed_allowed: bool = False
    baseline_days: float = BASELINE_DAYS
    prior: Prior = USUAL


class Course:
    """Looks at the logs of an axis since its baseline began, with the latched conditions."""

    def __init__(
        self, axis: str, kept: KeptHealth, surface: Surface, settings: HealthSettings
    ) -> None:
        self.axis, self.kept, self.surface, self.settings = axis, kept, surface, settings
        days = settings.baseline_days
        baseline = in_force(kept.baselines, motion_by_day(kept.spectrum), days)
        cells = array_of(kept.cells)
        self.cells = cells[cells['start'] >= baseline.begin]
        self.history = history_of(self.cells, surface.lead)
        self.starts: list[int] = [] if self.history is None else self.history.start.tolist()
        self.looks: list[Look] = []
        if self.history is not None:
            first = self.starts[0]
            if kept.baselines and kept.baselines[-1].end:
                days = (baseline.end - first) / DAY
            else:
                end = first + round(days * DAY)
                baseline = dataclasses.replace(baseline, begin=first, end=end)
            self.looks += looks(self.history, baseline_days=days, prior=settings.prior)
        self.states, self.baseline = latched(self.looks), baseline

    def healths(self, now: int) -> list[Health]:
        """Return the health after each log, the last one at `now` [ns]."""
        *earlier, _ = np.unique(self.cells['start']).tolist() or [0]
        return [*map(self._after, earlier), self.latest(now)]

    def _after(self, start: int) -> Health:
        """Return the health after a log: the change of the friction with its date and causes."""
        if start not in self.starts:
            return _unknown(self.axis, start, self.cells[self.cells['start'] == start])
        at = self.starts.index(start)
        look, (condition, onset) = self.looks[at], self.states[at]
        since = self.starts[onset] if onset >= 0 else 0
        if look.is_known:
            text = f'the last {look.now} logs against {look.baseline} of the baseline'
            drag = quantity(DRAG, '-', (look.change, look.low, look.high), text)
        else:
            drag = unknown(DRAG, '-', f'not known yet: {look.reason}')
        proven = condition in CHANGED and look.low * look.high > 0.0
        causes = self._causes(at, since) if proven else []
        return Health(
            axis=self.axis,
            stamp=start,
            condition=condition,
            verdict=verdict_of(self.axis, condition, drag, causes, since),
            advice=advice_of(condition, causes),
            since=since,
            quantities=[drag],
            causes=causes,
            baseline=self.baseline,
            doubt=look.doubt,
        )

    def _causes(self, at: int, since: int) -> list[Cause]:
        """Return the causes of a proven change since a date [ns] after a log."""
        assert self.history is not None
        look, history = self.looks[at], self.history.until(at + 1)
        reversals = self.cells[self.cells['kind'] == CellKind.REVERSAL]
        grew = lost_motion_grew(reversals, since, self.starts[at])
        marks = marks_of(history, look)._replace(lost_motion=grew)
        preload = float(self.surface.header.get('service', {}).get('preload', math.nan))
        return causes_of(changes_of(history, look), marks, math.log1p(look.change), preload)

    def latest(self, now: int) -> Health:
        """Return the health at `now` [ns], with all that is told beside the friction."""
        today, surface, settings = day_of(now), self.surface, self.settings
        if self.looks:
            health = self._after(self.starts[-1])
        elif self.kept.baselines and any(cell.direction for cell in self.kept.cells):
            reason = 'not known yet: no log since the baseline was named'
            health = _unknown(self.axis, now, reason)
        else:
            health = _unknown(self.axis, now, array_of(self.kept.cells))
        cells = [
            cell
            for cell in sorted(self.kept.cells, key=lambda cell: cell.start)
            if cell.kind == CellKind.MOTION
            and cell.load_source != LoadSource.DERIVED
            and cell.first_day <= today
        ]
        spectrum = [each for each in self.kept.spectrum if each.first_day <= today]
        known = self.baseline if self.looks and self.looks[-1].is_known else None
        normal = None if health.condition in CHANGED else known
        usual = usual_boundary(cells, normal, surface, today)
        latest = recent(cells, today, SHORT + 1)  # a log of a week ago counts
        if len(latest) < FEWEST_CELLS:
            latest = recent(cells, today, RECENT + 1)
        advice = health.advice
        if not advice and usual is None:
            free = settings.speed_allowed
            advice = remedy_text(latest, surface, settings.limits, speed_allowed=free)
        rated = rated_of(surface.header)
        where, worn = where_on_screw(self.cells, self.baseline if self.looks else None)
        speed = max((abs(cell.speed) for cell in latest), default=0.0)
        load = max((abs(opposed(cell)) for cell in latest), default=0.0)
        return dataclasses.replace(
            health,
            stamp=now,
            advice=advice,
            quantities=[
                *health.quantities,
                *self._bounds(health),
                *life_quantities(spectrum, rated, today),
                lubrication_rate(cells, surface, rated, today),
                *severity_quantities(spectrum, known, today),
                *energy_quantities(spectrum, known, today),
                *where,
            ],
            baseline=known,
            notes=[
                *([] if usual is None else [boundary_note(*usual)]),
                *worn,
                *filter(None, self._notes()),
                *shaft_notes(surface.header, speed, load),
            ],
            usual=usual is not None,
            usual_warnings=usual_warnings(cells, normal, surface, settings.limits),
        )

    def _bounds(self, health: Health) -> tuple[Quantity, Quantity]:
        """Return the smallest loss that shows, and the preload where it alone fits a change."""
        smallest = unknown(SMALLEST, '-', 'not known yet: nothing is compared')
        if self.looks and self.looks[-1].is_known:
            text = f'found within eight weeks in nine of ten cases; {ALARM_RATE}'
            smallest = quantity(SMALLEST, '-', [self.looks[-1].smallest] * 3, text)
        why = 'not known: drag alone does not tell it from other causes'
        preload, sizes = unknown('preload', '-', why), [c.size for c in likely(health.causes)]
        if [size.name for size in sizes] == ['preload']:
            text = 'a bound by the loss of drag, which follows the preload'
            preload = dataclasses.replace(sizes[0], evidence=text)
        return smallest, preload

    def _notes(self) -> list[str]:
        """Return what is to be known of the inputs, the programme and the screw."""
        history, notes = self.history, []
        if history is None:
            return []
        if not history.load_known:
            notes.append(
                'no load is measured and the axis is not declared free: a change of the process '
                'force counts as one of the friction'
            )
        if not history.warm:
            notes.append(
                'no temperature is measured: the interval is wider by what a season may change'
            )
        look = self.looks[-1]
        if not look.is_known:
            return notes
        marks = marks_of(history, look)
        notes += input_notes(marks)
        if marks.new_share > NEW_PROGRAMME:
            notes.append(
                f'the programme has changed: {100 * marks.new_share:.0f} % of the motion has '
                'speeds or loads that the baseline lacks'
            )
        changes = np.expm1(changes_of(history, look).change).tolist()
        return [*notes, changed_screw(self.baseline, self.surface.screw_name, changes)]


def course(
    axis: str, kept: KeptHealth, surface: Surface, settings: HealthSettings
) -> list[Health]:
    """
    Return the health of an axis after each of its logs.

    The last one, at the end of its day, has all quantities, the others the change of the drag.

    """
    now = (max(cell.first_day for cell in kept.cells) + 1) * DAY - 1
    return Course(axis, kept, surface, settings).healths(now)


def assess(
    axis: str, kept: KeptHealth, surface: Surface, settings: HealthSettings, *, now: int
) -> Health:
    """Return the health of an axis at `now` [ns]."""
    return Course(axis, kept, surface, settings).latest(now)


def without_order(axis: str, start: int) -> Health:
    """Return the health of an axis of which two recordings begin at one `start` [ns]."""
    reason = f'not known: two recordings begin at {clock_text(start)}, so their order is not known'
    return _unknown(axis, start, reason)


def _unknown(axis: str, stamp: int, why: str | NDArray[Any]) -> Health:
    """Return the health of an axis for a reason, or of cells without motion that counts."""
    drag = unknown(DRAG, '-', why if isinstance(why, str) else missing_reason(why))
    condition = Condition.UNKNOWN
    verdict = verdict_of(axis, condition, drag, (), 0)
    return Health(axis=axis, stamp=stamp, condition=condition, verdict=verdict, quantities=[drag])
