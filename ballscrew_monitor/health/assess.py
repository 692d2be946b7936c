# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Normal or worse: what is kept of an axis, held against its baseline.

The condition is worse only where the change of the drag, or the loss of preload, lies beyond the
tolerance with 99.9 % confidence, so that a look every day for years seldom warns of nothing.

"""

from collections.abc import Iterator, Sequence
import dataclasses
import math
from typing import NamedTuple

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import changed_screw, motion_by_day
from ballscrew_monitor.health.calibration import calibrated
from ballscrew_monitor.health.causes import carrying, causes_of, FEWEST_GROUPS, fits_of
from ballscrew_monitor.health.change import Change, Days, parts_of, select
from ballscrew_monitor.health.companions import Companions
from ballscrew_monitor.health.damage import rated_of
from ballscrew_monitor.health.detector import note_on_runs
from ballscrew_monitor.health.energy import energy_quantities, student
from ballscrew_monitor.health.evidence import is_certain
from ballscrew_monitor.health.faults import input_fault
from ballscrew_monitor.health.life import life_quantities, shaft_notes, unknown
from ballscrew_monitor.health.lubrication import (
    boundary_note,
    lubrication_rate,
    opposed,
    severity_quantities,
    usual_boundary,
)
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.onset import onset_note, onset_of
from ballscrew_monitor.health.preload import preload_of
from ballscrew_monitor.health.records import (
    Baseline,
    Cause,
    ComparablePoint,
    Condition,
    Health,
    Quantity,
    SpectrumBin,
    TOLERANCE,
)
from ballscrew_monitor.health.remedies import remedies_of
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.words import advice_of, verdict_of
from surrogate.surface import Surface

NARROW = 0.1
"""Half width of an interval of the drag that holds 0, up to which an axis is normal [-]."""
SURE = 1.9
"""Half width of the 99.9 % interval over that of 95 %."""
RECENT = 28
"""Days that count as now, if the last week has too little [-]."""
SHORT = 7
FEWEST_STRETCHES = 10
"""Stretches in common places that a comparison needs."""
DRAG = 'drag change'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class HealthSettings:
    """
    What health is told: limits of the zone, and what the machine allows.

    `speed_allowed`: advice may name another speed, which a process may not allow. Where an axis is
    `always_free` of process force, its readings come daily.

    """

    limits: Limits
    speed_allowed: bool = False
    always_free: bool = False


class Compared(NamedTuple):
    """
    The recent days against the baseline, each quantity with its interval.

    `change` is that of the last week, or of `month`, the last 28 days, where that has too little;
    both are None where there is no comparison, and `reason` says why.

    """

    model: Model
    change: Change | None
    month: Change | None
    reason: str
    drag: Quantity
    preload: Quantity
    condition: Condition
    causes: Sequence[Cause]


def assess(
    axis: str,
    now: int,
    baseline: Baseline | str,
    points: Sequence[ComparablePoint],
    spectrum: Sequence[SpectrumBin],
    surface: Surface,
    companions: Companions | str,
    settings: HealthSettings,
) -> Health:
    """
    Return the health of an axis at `now` [ns].

    `baseline` is one, or a sentence why there is none yet; so are `companions`. `points` and
    `spectrum` are all that is kept.

    """
    today = day_of(now)
    known = baseline if isinstance(baseline, Baseline) else None
    compared = compare(baseline, points, today, surface, companions)
    model, change, month, reason, drag, preload, condition, causes = compared
    onset = onset_of(month, *held_points(known, points, today), model, reason)
    recent = recent_of(points, today)
    found = [
        *_drags(change, drag, reason),
        preload,
        onset,
        *_others(points, spectrum, surface, known, today, settings),
    ]
    alarms = [
        onset_note(onset, TOLERANCE, SURE),
        note_on_runs(points, motion_by_day(spectrum), model, always_free=settings.always_free),
    ]
    usual = usual_boundary(points, known, surface, today)
    if condition is Condition.WORSE or any(alarms):
        usual = None
    notes = [
        '' if usual is None else boundary_note(usual),
        *_notes(surface, known, recent, change),
        *alarms,
    ]
    remedy = remedies_of(
        recent, surface, settings.limits, speed_allowed=settings.speed_allowed
    ).text
    return Health(
        axis=axis,
        stamp=now,
        condition=condition,
        verdict=verdict_of(axis, condition, drag, preload, causes),
        advice=advice_of(condition, causes) or (remedy if usual is None else ''),
        quantities=found,
        causes=causes,
        baseline=known,
        notes=[one for one in notes if one],
        usual=usual is not None,
    )


def compare(
    baseline: Baseline | str,
    points: Sequence[ComparablePoint],
    today: int,
    surface: Surface,
    companions: Companions | str,
) -> Compared:
    """Return how the days before the end of `today` compare with the baseline."""
    known = baseline if isinstance(baseline, Baseline) else None
    model = Model(
        surface,
        companions if isinstance(companions, Companions) else None,
        None if known is None else calibrated(known.points, surface),
    )
    days = None if known is None else Days(known.points, _since(known, points), model)
    week, month = (_change(days, today - length) for length in (SHORT, RECENT))
    change = week or month
    reason = _reason(baseline, points, recent_of(points, today), change)
    fits = [] if month is None else fits_of(month, model)
    causes = [] if month is None else causes_of(month, fits)
    preload = preload_of(change, model, reason, companions, causes)
    if change is not None:
        causes = carrying(causes, fits, change, model)
    condition = _condition(days, change, month, model)
    drag = _drag(change, reason)
    return Compared(model, change, month, reason, drag, preload, condition, causes)


def held_points(
    baseline: Baseline | None, points: Sequence[ComparablePoint], today: int
) -> tuple[Sequence[ComparablePoint], Sequence[ComparablePoint]]:
    """Return the points of the baseline, and those of the 28 days that are held against it."""
    if baseline is None:
        return (), ()
    later = _since(baseline, points)
    return baseline.points, [one for one in later if one.first_day > today - RECENT]


def _since(baseline: Baseline, points: Sequence[ComparablePoint]) -> list[ComparablePoint]:
    return [one for one in points if one.first_day * DAY >= baseline.end]


def _change(days: Days | None, after: int) -> Change | None:
    """Return the change of the days after one, None where it has too few stretches."""
    change = None if days is None else days.change(after + 1)
    return change if change is not None and change.stretches >= FEWEST_STRETCHES else None


def recent_of(points: Sequence[ComparablePoint], today: int) -> list[ComparablePoint]:
    """Return the points of the last week, or of the last four where that has too few."""
    week = [one for one in points if one.first_day + one.days > today - SHORT]
    if sum(one.stretches for one in week) >= FEWEST_STRETCHES:
        return week
    return [one for one in points if one.first_day + one.days > today - RECENT]


def _reason(
    baseline: Baseline | str,
    points: Sequence[ComparablePoint],
    recent: Sequence[ComparablePoint],
    change: Change | None,
) -> str:
    """Return why the change of the drag is not known, empty where it is."""
    if change is not None:
        return ''
    if not points:
        return 'not known: no steady motion with a measured torque and an independent load yet'
    if isinstance(baseline, str):
        return f'not known yet: {baseline}'
    if not recent:
        return f'not known: no steady motion with a measured torque in the last {RECENT} days'
    if not _since(baseline, points):
        return (
            'not known yet: no steady motion after the baseline, add later days or name a shorter '
            'baseline'
        )
    return (
        f'not known yet: fewer than {FEWEST_STRETCHES} stretches at speeds, loads and directions '
        'that the baseline has, too'
    )


def _drag(change: Change | None, reason: str) -> Quantity:
    if change is None:
        return unknown(DRAG, '-', reason)
    return _interval(DRAG, '-', change.common, change.deviation, change)


def _interval(name: str, unit: str, value: float, deviation: float, change: Change) -> Quantity:
    reach = student(change.freedom) * deviation
    return Quantity(
        name=name,
        unit=unit,
        value=value,
        low=value - reach,
        high=value + reach,
        evidence=f'{change.stretches} stretches at {len(change.groups)} places of the baseline',
    )


def _condition(
    days: Days | None, change: Change | None, month: Change | None, model: Model
) -> Condition:
    """Return the condition by the interval of the drag, or the pattern of a cause."""
    if days is None or change is None or month is None:
        return Condition.UNKNOWN
    reach = student(change.freedom) * change.deviation
    certain = is_certain(days, month, model, TOLERANCE)
    if certain or abs(change.common) - SURE * reach > TOLERANCE:
        return Condition.WORSE
    return Condition.NORMAL if abs(change.common) <= reach <= NARROW else Condition.UNKNOWN


def _drags(change: Change | None, drag: Quantity, reason: str) -> list[Quantity]:
    """Return the change of the drag, by direction, and its constant and proportional parts."""
    parts = None if change is None else parts_of(change)
    if change is None or parts is None:
        why = reason or 'not known: all places have one speed'
        rest = [unknown('constant drag', 'N m', why), unknown('drag per speed', 'N m s/rad', why)]
    else:
        (constant, rate), (apart, rate_apart) = parts
        rest = [
            _interval('constant drag', 'N m', constant, apart, change),
            _interval('drag per speed', 'N m s/rad', rate, rate_apart, change),
        ]
    ways = [] if change is None else list(_ways(change))
    return [drag, *ways, *rest]


def _ways(change: Change) -> Iterator[Quantity]:
    """Yield the change in each direction that both have."""
    for name, sign in (('forward', 1), ('backward', -1)):
        value, deviation = select(change, [one.direction == sign for one in change.groups])
        if math.isfinite(value):
            yield _interval(f'{DRAG} {name}', '-', value, deviation, change)


def _others(
    points: Sequence[ComparablePoint],
    spectrum: Sequence[SpectrumBin],
    surface: Surface,
    baseline: Baseline | None,
    today: int,
    settings: HealthSettings,
) -> list[Quantity]:
    """Return life, lubrication and energy."""
    rated = rated_of(surface.header)
    return [
        *life_quantities(spectrum, rated, today),
        lubrication_rate(points, surface, rated, today),
        *severity_quantities(spectrum, baseline, today),
        *energy_quantities(spectrum, baseline, today),
    ]


def _notes(
    surface: Surface,
    baseline: Baseline | None,
    recent: Sequence[ComparablePoint],
    change: Change | None,
) -> list[str]:
    notes = []
    if baseline is not None:
        changes = [] if change is None else change.relative.tolist()
        notes.append(input_fault(baseline.points, surface))
        notes.append(changed_screw(baseline, surface.screw_name, changes))
    if change is not None and len(change.groups) < FEWEST_GROUPS:
        notes.append(
            f'the cause is not known: at fewer than {FEWEST_GROUPS} places every cause fits'
        )
    speed = max((abs(one.speed) for one in recent), default=0.0)
    load = max((abs(opposed(one)) for one in recent), default=0.0)
    return [*notes, *shaft_notes(surface.header, speed, load)]
