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
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import changed_screw, in_force, motion_by_day
from ballscrew_monitor.health.causes import causes_of
from ballscrew_monitor.health.change import changes_of, Marks, marks_of
from ballscrew_monitor.health.damage import rated_of
from ballscrew_monitor.health.detection import BASELINE_DAYS, Latched, latched, Look, look
from ballscrew_monitor.health.energy import energy_quantities
from ballscrew_monitor.health.history import History, history_of
from ballscrew_monitor.health.life import life_quantities, shaft_notes, unknown
from ballscrew_monitor.health.lubrication import (
    boundary_note,
    lubrication_rate,
    opposed,
    severity_quantities,
    usual_boundary,
)
from ballscrew_monitor.health.mixed import Prior, USUAL
from ballscrew_monitor.health.records import (
    Baseline,
    Cause,
    Cell,
    CellKind,
    Condition,
    Health,
    LoadSource,
    Quantity,
    SpectrumBin,
)
from ballscrew_monitor.health.remedies import remedies_of
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.summary import cells_of
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


class Kept(NamedTuple):
    """All that is kept of an axis: cells as an array of CELL, spectrum, and baselines in order."""

    cells: NDArray[Any]
    spectrum: Sequence[SpectrumBin] = ()
    baselines: Sequence[Baseline] = ()


class Course(NamedTuple):
    """
    Looks at a history with the condition that is latched after each.

    `reversals` are the cells of lost motion since the baseline began, an array of CELL.

    """

    history: History | None
    looks: Sequence[Look]
    states: Sequence[Latched]
    baseline: Baseline
    reversals: NDArray[Any]


def course(
    axis: str, kept: Kept, surface: Surface, settings: HealthSettings, *, now: int | None = None
) -> list[Health]:
    """
    Return the health of an axis after each of its logs, the last one at `now` [ns].

    The last one has all quantities, the others the change of the drag.

    """
    seen = course_of(kept, surface.lead, settings)
    places = {} if seen.history is None else dict(_numbered(seen.history.start))
    begun = kept.cells['start'][kept.cells['start'] >= seen.baseline.begin]
    *starts, _ = np.unique(begun).tolist() or [0]
    earlier = [
        _earlier(axis, seen, places[start], surface)
        if start in places
        else _silent(axis, start, kept)
        for start in starts
    ]
    stamp = _last(kept) if now is None else now
    return [*earlier, _latest(axis, stamp, seen, kept, surface, settings)]


def _numbered(starts: NDArray[np.int64]) -> list[tuple[int, int]]:
    return [(start, at) for at, start in enumerate(starts.tolist())]


def _silent(axis: str, start: int, kept: Kept) -> Health:
    """Return the health after a log without motion that counts."""
    drag = unknown(DRAG, '-', missing_reason(kept.cells[kept.cells['start'] == start]))
    return _unknown(axis, start, drag)


def _unknown(axis: str, stamp: int, drag: Quantity) -> Health:
    return Health(
        axis=axis,
        stamp=stamp,
        condition=Condition.UNKNOWN,
        verdict=verdict_of(axis, Condition.UNKNOWN, drag, (), 0),
        quantities=[drag],
    )


def assess(
    axis: str, kept: Kept, surface: Surface, settings: HealthSettings, *, now: int
) -> Health:
    """Return the health of an axis at `now` [ns]."""
    seen = course_of(kept, surface.lead, settings)
    return _latest(axis, now, seen, kept, surface, settings)


def without_order(axis: str, start: int) -> Health:
    """Return the health of an axis of which two recordings begin at one `start` [ns]."""
    reason = f'not known: two recordings begin at {clock_text(start)}, so their order is not known'
    return _unknown(axis, start, unknown(DRAG, '-', reason))


def course_of(kept: Kept, lead: float, settings: HealthSettings) -> Course:
    """Return the looks at all logs since the baseline in force; `lead` [m] of the screw."""
    baseline = in_force(kept.baselines, motion_by_day(kept.spectrum), settings.baseline_days)
    cells = kept.cells[kept.cells['start'] >= baseline.begin]
    reversals = cells[cells['kind'] == CellKind.REVERSAL]
    history = history_of(cells, lead)
    if history is None:
        return Course(None, (), (), baseline, reversals)
    learned = not kept.baselines or not kept.baselines[-1].end
    begin = int(history.start[0]) if learned else baseline.begin
    days = settings.baseline_days if learned else (baseline.end - int(history.start[0])) / DAY
    end = begin + round(days * DAY) if learned else baseline.end
    count = len(history.start)
    looks = [
        look(history.until(at), baseline_days=days, prior=settings.prior)
        for at in range(1, count + 1)
    ]
    baseline = dataclasses.replace(baseline, begin=begin, end=end)
    return Course(history, looks, latched(looks), baseline, reversals)


def _earlier(axis: str, seen: Course, at: int, surface: Surface) -> Health:
    assert seen.history is not None
    here, state = seen.looks[at], seen.states[at]
    causes, _ = _explained(seen, at, surface)
    since, drag = _since(seen, at), _drag(here)
    return Health(
        axis=axis,
        stamp=int(seen.history.start[at]),
        condition=state.condition,
        verdict=verdict_of(axis, state.condition, drag, causes, since),
        advice=advice_of(state.condition, causes),
        since=since,
        quantities=[drag],
        causes=causes,
        baseline=seen.baseline,
        doubt=here.doubt,
    )


def _latest(
    axis: str, now: int, seen: Course, kept: Kept, surface: Surface, settings: HealthSettings
) -> Health:
    today, at = day_of(now), len(seen.looks) - 1
    here = seen.looks[-1] if seen.looks else None
    condition, since = Condition.UNKNOWN, 0
    drag = _drag(here) if here else unknown(DRAG, '-', _missing(kept))
    causes: Sequence[Cause] = ()
    marks = None
    if here is not None:
        condition, since = seen.states[-1].condition, _since(seen, at)
        causes, marks = _explained(seen, at, surface)
    points = [
        cell
        for cell in cells_of(kept.cells[kept.cells['kind'] == CellKind.MOTION])
        if cell.load_source != LoadSource.DERIVED and cell.first_day <= today
    ]
    spectrum = [one for one in kept.spectrum if one.first_day <= today]
    known = seen.baseline if here is not None and here.is_known else None
    usual = usual_boundary(points, known, surface, today)
    if condition in CHANGED:
        usual = None
    recent = recent_of(points, today)
    remedy = remedies_of(
        recent, surface, settings.limits, speed_allowed=settings.speed_allowed
    ).text
    where = where_on_screw(
        kept.cells[kept.cells['start'] >= seen.baseline.begin],
        None if seen.history is None else seen.baseline,
    )
    notes = [
        '' if usual is None else boundary_note(usual),
        *where.notes,
        *_notes(surface, seen, here, marks),
        *_shaft(surface, recent),
    ]
    rated = rated_of(surface.header)
    return Health(
        axis=axis,
        stamp=now,
        condition=condition,
        verdict=verdict_of(axis, condition, drag, causes, since),
        advice=advice_of(condition, causes) or (remedy if usual is None else ''),
        since=since,
        quantities=[
            drag,
            _smallest(here),
            _preload(condition, causes),
            *life_quantities(spectrum, rated, today),
            lubrication_rate(points, surface, rated, today),
            *severity_quantities(spectrum, known, today),
            *energy_quantities(spectrum, known, today),
            *where.quantities,
        ],
        causes=causes,
        baseline=known,
        notes=[note for note in notes if note],
        usual=usual is not None,
        doubt=here.doubt if here is not None else 1.0,
    )


def _missing(kept: Kept) -> str:
    if kept.baselines and (kept.cells['direction'] != 0).any():
        return 'not known yet: no log since the baseline was named'
    return missing_reason(kept.cells)


def _last(kept: Kept) -> int:
    return (int(kept.cells['first_day'].max()) + 1) * DAY - 1


def _since(seen: Course, at: int) -> int:
    """Return the date [ns] since which the condition is latched, 0 for none."""
    assert seen.history is not None
    since = seen.states[at].since
    return int(seen.history.start[since]) if since >= 0 else 0


def _drag(here: Look) -> Quantity:
    if not here.is_known:
        return unknown(DRAG, '-', f'not known yet: {here.reason}')
    return Quantity(
        name=DRAG,
        value=here.change,
        low=here.low,
        high=here.high,
        evidence=f'the last {here.now} logs against {here.baseline} of the baseline',
    )


def _smallest(here: Look | None) -> Quantity:
    if here is None or not here.is_known:
        return unknown(SMALLEST, '-', 'not known yet: nothing is compared')
    size = here.smallest
    text = f'found within eight weeks in nine of ten cases; {ALARM_RATE}'
    return Quantity(name=SMALLEST, value=size, low=size, high=size, evidence=text)


def _preload(condition: Condition, causes: Sequence[Cause]) -> Quantity:
    """Return the share of the preload that is left, where its loss alone explains a change."""
    told = [cause for cause in causes if not cause.excluded]
    if condition in CHANGED and [cause.size.name for cause in told] == ['preload']:
        return dataclasses.replace(
            told[0].size, evidence='a bound by the loss of drag, which follows the preload'
        )
    return unknown('preload', '-', 'not known: drag alone does not tell it from other causes')


def _explained(seen: Course, at: int, surface: Surface) -> tuple[list[Cause], Marks | None]:
    """Return the causes of a change that is latched and still proven, and marks of inputs."""
    assert seen.history is not None
    here, state = seen.looks[at], seen.states[at]
    if not here.is_known:
        return [], None
    history = seen.history.until(at + 1)
    latest = at == len(seen.looks) - 1
    proven = state.condition in CHANGED and here.low * here.high > 0.0
    marks = marks_of(history, here) if latest or proven else None
    if marks is None or not proven:
        return [], marks
    until = int(history.start[-1])
    grew = lost_motion_grew(seen.reversals, _since(seen, at), until)
    marks = marks._replace(lost_motion=grew)
    preload = float(surface.header.get('service', {}).get('preload', math.nan))
    groups = changes_of(history, here)
    return causes_of(groups, marks, math.log1p(here.change), preload), marks


def recent_of(points: Sequence[Cell], today: int) -> list[Cell]:
    """Return the cells of the last week, or of the last four where that has too few."""
    week = [one for one in points if one.first_day + one.days > today - SHORT]
    if len(week) >= FEWEST_CELLS:
        return week
    return [one for one in points if one.first_day + one.days > today - RECENT]


def _notes(surface: Surface, seen: Course, here: Look | None, marks: Marks | None) -> list[str]:
    if here is None or seen.history is None:
        return []
    notes = []
    if not seen.history.load_known:
        notes.append(
            'no load is measured and the axis is not declared free: a change of the process force '
            'counts as one of the friction'
        )
    if not seen.history.warm:
        notes.append(
            'no temperature is measured: the interval is wider by what a season may change'
        )
    if marks is None:
        return notes
    notes += input_notes(marks)
    if marks.new_share > NEW_PROGRAMME:
        notes.append(
            f'the programme has changed: {100 * marks.new_share:.0f} % of the motion has speeds '
            'or loads that the baseline lacks'
        )
    changes = np.expm1(changes_of(seen.history, here).change).tolist()
    return [*notes, changed_screw(seen.baseline, surface.screw_name, changes)]


def _shaft(surface: Surface, recent: Sequence[Cell]) -> list[str]:
    speed = max((abs(one.speed) for one in recent), default=0.0)
    load = max((abs(opposed(one)) for one in recent), default=0.0)
    return shaft_notes(surface.header, speed, load)
