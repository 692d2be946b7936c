# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Health of an axis by the summaries of its logs: a condition after each, and causes of a change.

The change is found by the history of the axis alone. Surface and sheet explain it, and tell life
and lubrication.

"""

from collections.abc import Sequence
import dataclasses
import math

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import changed_screw, in_force, motion_by_day
from ballscrew_monitor.health.causes import causes_of, likely
from ballscrew_monitor.health.change import changes_of, marks_of
from ballscrew_monitor.health.detection import BASELINE_DAYS, latched, Look, looks
from ballscrew_monitor.health.energy import energy_quantities
from ballscrew_monitor.health.history import history_of
from ballscrew_monitor.health.life import life_quantities, rated_of, shaft_notes
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
    Cell,
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
from surrogate.surface import Surface

RECENT, SHORT = 28, 7
"""Days whose programme counts as that of now; the longer where the shorter has too little."""
FEWEST_CELLS = 10
DRAG, SMALLEST = 'drag change', 'smallest loss shown'
CHANGED = (Condition.WORSE, Condition.SLIGHTLY_CHANGED)
NEW_PROGRAMME = 0.5
"""Share of the motion at places that the baseline lacks, from which the programme changed [-]."""
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
        self.baseline = in_force(
            kept.baselines, motion_by_day(kept.spectrum), settings.baseline_days
        )
        cells = array_of(kept.cells)
        self.history = history_of(cells[cells['start'] >= self.baseline.begin], surface.lead)
        self.looks: list[Look] = []
        if self.history is not None:
            first, days = int(self.history.start[0]), settings.baseline_days
            if kept.baselines and kept.baselines[-1].end:
                days = (self.baseline.end - first) / DAY
            else:
                end = first + round(days * DAY)
                self.baseline = dataclasses.replace(self.baseline, begin=first, end=end)
            self.looks += looks(self.history, baseline_days=days, prior=settings.prior)
        self.states = latched(self.looks)
        self.cells = cells[cells['start'] >= self.baseline.begin]

    def healths(self, now: int) -> list[Health]:
        """Return the health after each log, the last one at `now` [ns]."""
        history = [] if self.history is None else self.history.start.tolist()
        place = {start: at for at, start in enumerate(history)}
        *starts, _ = np.unique(self.cells['start']).tolist() or [0]
        earlier = (
            self._after(place[start]) if start in place else self._silent(start)
            for start in starts
        )
        return [*earlier, self.latest(now)]

    def _silent(self, start: int) -> Health:
        """Return the health after a log without motion that counts."""
        return _unknown(self.axis, start, missing_reason(self.cells[self.cells['start'] == start]))

    def _after(self, at: int) -> Health:
        """Return the health after a log: the change of the drag with its date and causes."""
        assert self.history is not None
        look, condition, since = self.looks[at], self.states[at].condition, self._since(at)
        drag, causes = _drag(look), self._causes(at)
        return Health(
            axis=self.axis,
            stamp=int(self.history.start[at]),
            condition=condition,
            verdict=verdict_of(self.axis, condition, drag, causes, since),
            advice=advice_of(condition, causes),
            since=since,
            quantities=[drag],
            causes=causes,
            baseline=self.baseline,
            doubt=look.doubt,
        )

    def latest(self, now: int) -> Health:
        """Return the health at `now` [ns], with all that is told beside the drag."""
        if self.looks:
            health = self._after(len(self.looks) - 1)
        else:
            health = _unknown(self.axis, now, self._missing())
        today, surface, settings = day_of(now), self.surface, self.settings
        points = [
            cell
            for cell in sorted(self.kept.cells, key=lambda cell: cell.start)
            if cell.kind == CellKind.MOTION
            and cell.load_source != LoadSource.DERIVED
            and cell.first_day <= today
        ]
        spectrum = [each for each in self.kept.spectrum if each.first_day <= today]
        known = self.baseline if self.looks and self.looks[-1].is_known else None
        changed = health.condition in CHANGED
        usual = None if changed else usual_boundary(points, known, surface, today)
        recent = recent_of(points, today)
        where, worn = where_on_screw(self.cells, None if self.history is None else self.baseline)
        notes = ['' if usual is None else boundary_note(*usual), *worn, *self._notes()]
        advice = health.advice
        if not advice and usual is None:
            free = settings.speed_allowed
            advice = remedy_text(recent, surface, settings.limits, speed_allowed=free)
        rated = rated_of(surface.header)
        return dataclasses.replace(
            health,
            stamp=now,
            advice=advice,
            quantities=[
                *health.quantities,
                self._smallest(),
                _preload(health),
                *life_quantities(spectrum, rated, today),
                lubrication_rate(points, surface, rated, today),
                *severity_quantities(spectrum, known, today),
                *energy_quantities(spectrum, known, today),
                *where,
            ],
            baseline=known,
            notes=[*filter(None, notes), *_shaft_notes(surface, recent)],
            usual=usual is not None,
            usual_warnings=usual_warnings(
                points, None if changed else known, surface, settings.limits
            ),
        )

    def _missing(self) -> str:
        if self.kept.baselines and any(cell.direction for cell in self.kept.cells):
            return 'not known yet: no log since the baseline was named'
        return missing_reason(array_of(self.kept.cells))

    def _since(self, at: int) -> int:
        """Return the date [ns] since which the condition is latched, 0 for none."""
        assert self.history is not None
        since = self.states[at].since
        return int(self.history.start[since]) if since >= 0 else 0

    def _causes(self, at: int) -> list[Cause]:
        """Return the causes of a change that is latched and still proven."""
        assert self.history is not None
        look, header = self.looks[at], self.surface.header
        if self.states[at].condition not in CHANGED or not look.low * look.high > 0.0:
            return []
        history = self.history.until(at + 1)
        reversals = self.cells[self.cells['kind'] == CellKind.REVERSAL]
        grew = lost_motion_grew(reversals, self._since(at), int(history.start[-1]))
        marks = marks_of(history, look)._replace(lost_motion=grew)
        preload = float(header.get('service', {}).get('preload', math.nan))
        return causes_of(changes_of(history, look), marks, math.log1p(look.change), preload)

    def _smallest(self) -> Quantity:
        if not self.looks or not self.looks[-1].is_known:
            return unknown(SMALLEST, '-', 'not known yet: nothing is compared')
        size = self.looks[-1].smallest
        text = f'found within eight weeks in nine of ten cases; {ALARM_RATE}'
        return quantity(SMALLEST, '-', (size, size, size), text)

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


def _unknown(axis: str, stamp: int, reason: str) -> Health:
    drag = unknown(DRAG, '-', reason)
    return Health(
        axis=axis,
        stamp=stamp,
        condition=Condition.UNKNOWN,
        verdict=verdict_of(axis, Condition.UNKNOWN, drag, (), 0),
        quantities=[drag],
    )


def _drag(look: Look) -> Quantity:
    if not look.is_known:
        return unknown(DRAG, '-', f'not known yet: {look.reason}')
    text = f'the last {look.now} logs against {look.baseline} of the baseline'
    return quantity(DRAG, '-', (look.change, look.low, look.high), text)


def _preload(health: Health) -> Quantity:
    """Return the share of the preload that is left, where its loss alone explains a change."""
    told = likely(health.causes)
    if [cause.size.name for cause in told] == ['preload']:
        return dataclasses.replace(
            told[0].size, evidence='a bound by the loss of drag, which follows the preload'
        )
    return unknown('preload', '-', 'not known: drag alone does not tell it from other causes')


def recent_of(points: Sequence[Cell], today: int) -> list[Cell]:
    """Return the cells of the last week, or of the last four where that has too few."""
    week = [cell for cell in points if cell.first_day + cell.days > today - SHORT]
    if len(week) >= FEWEST_CELLS:
        return week
    return [cell for cell in points if cell.first_day + cell.days > today - RECENT]


def _shaft_notes(surface: Surface, recent: Sequence[Cell]) -> list[str]:
    speed = max((abs(cell.speed) for cell in recent), default=0.0)
    load = max((abs(opposed(cell)) for cell in recent), default=0.0)
    return shaft_notes(surface.header, speed, load)
