# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The course of an axis over time, as panels of a page: numbers, limits, regimes and warnings."""

from collections.abc import Iterable
import itertools
import math
from typing import Any

from ballscrew_monitor.core.conversions import celsius, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Level, PointSource, Zone
from ballscrew_monitor.judge.records import LIGHT_LOAD, STANDSTILL
from ballscrew_monitor.report import buckets
from ballscrew_monitor.report.buckets import AxisBudget
from ballscrew_monitor.report.judging import AxisCase
from ballscrew_monitor.report.page import script_json
import polars as pl
from surrogate.surface import FILM_RATIO_LIMITS, Regime, REGIMES
from surrogate.units import RPM

COARSE_BYTES, EVENT_BYTES = 5000, 60  # of panels and the like in the page, and of an event
AROUND = 1.0  # [s] about an end of an event, of which every sample is kept
SAMPLE_BYTES = 8 / 3  # of one number of a stretch in the page
STRETCH_BYTES = 1000  # of a stretch in the page besides its numbers
LESS = 0.95  # of what would just fit, where stretches were too large
SMALLEST_RCS, SMALLEST_RATIO, LARGEST_RATIO = 1e-4, 0.05, 10.0
"""Ends of the logarithmic panels [-]: what is smaller is drawn on the lowest line."""
HEIGHT = 140  # of a panel [px]
# What is drawn of codes: the largest of a bucket, so the worst comes last.
BARS = (
    ('zone', 'Zone', ('none', 'none', 'optimal', 'unjudged', 'outside')),
    ('level', 'Warning', ('none', 'unjudged', 'optimal', 'outside')),
    ('regime', 'Regime', ('none', 'hydrodynamic', 'mixed', 'boundary')),
)
BAR_LEGEND = (
    ('optimal', 'optimal, no warning'),
    ('outside', 'outside the zone, warning'),
    ('unjudged', 'not judged, not known yet'),
    ('boundary', 'boundary'),
    ('mixed', 'mixed'),
    ('hydrodynamic', 'hydrodynamic'),
    ('warning-shade', 'during a warning; over the film ratio a bar'),
)
RANKS: dict[str, dict[Any, int]] = {
    'regime': {Regime.UNKNOWN: 0, Regime.HYDRODYNAMIC: 1, Regime.MIXED: 2, Regime.BOUNDARY: 3},
    'zone': {Zone.UNKNOWN: 3, Zone.OPTIMAL: 2, Zone.OUTSIDE: 4},
    'level': {Level.UNKNOWN: 1, Level.OK: 2, Level.WARN: 3},
}
NUMBERS = (
    'speed',
    'load',
    'temperature',
    'efficiency',
    'film_ratio',
    'rcs',
    'measured_torque',
    'machine_torque',
)


def series_record(
    case: AxisCase, fine_bytes: float = buckets.PAGE_BYTES, budget: AxisBudget | None = None
) -> dict[str, Any]:
    """Return the course of an axis; `fine_bytes` of the page are for every sample of events."""
    budget = budget or AxisBudget()
    coarse, near, bucket = _columns(case, fine_bytes, budget.buckets)
    shown, fine = _fine(case, near, fine_bytes)
    record = buckets.coarse_record(coarse)
    codes = record.pop('codes')
    if bucket:  # the times follow from it
        record.pop('time')
    return record | {
        'span': case.survey.length,
        'bucket': bucket,
        'shown': shown,
        'worst': min(buckets.WORST, len(case.outcome.events)),
        'begins': None if math.isnan(case.begins) else case.begins,
        'fine': fine,
        'bars': [
            {'title': title, 'codes': codes[key], 'colours': colours}
            for key, title, colours in BARS
        ],
        'events': [
            dict(zip(('begin', 'end'), case.span(event)))
            for event in case.worst_first[: budget.events]
        ],
        'panels': panels(case),
    }


def drawn_rows(case: AxisCase) -> pl.DataFrame:
    """Return all rows of a short recording, extremes of buckets of a long one."""
    return _columns(case, 0.0, buckets.BUCKETS)[0]


def coarse_bytes(case: AxisCase, budget: AxisBudget) -> float:
    """Return what a course takes in a page at most, without every sample of events [bytes]."""
    row = 4 * len(_numbers(case)) + len(BARS)
    if _is_short(case, budget.buckets):  # each row has its time, and there may be a break after it
        rows, row = 2 * case.survey.rows, row + 8
    else:
        rows = 2 * budget.buckets
    return rows * row * 4 / 3 + budget.events * EVENT_BYTES + COARSE_BYTES


def event_bytes(case: AxisCase, budget: AxisBudget) -> float:
    """Return what every sample about an event takes in a page, at the mean rate [bytes]."""
    if _is_short(case, budget.buckets):
        return 0.0
    return 2.0 * (2.0 * AROUND * _bytes_per_second(case) + STRETCH_BYTES)


def _is_short(case: AxisCase, buckets: int) -> bool:
    """Return True if all samples are kept, because they are no more than the rows of buckets."""
    return case.survey.rows <= 2 * buckets


def _numbers(case: AxisCase) -> tuple[str, ...]:
    """Return the keys of the columns: torques only where one was measured."""
    torque = bool(case.survey.torque.count)
    return tuple(key for key in NUMBERS if torque or not key.endswith('torque'))


def _columns(
    case: AxisCase, fine_bytes: float, count: int
) -> tuple[pl.DataFrame, pl.DataFrame | None, float]:
    """Return the rows of the whole, those near the worst events, and the width of a bucket [s]."""
    columns, table = row_columns(case, _numbers(case)), case.row_table
    if _is_short(case, count):
        rows = table.collect(lambda part: part.select(*columns))
        rows = rows.sort('time', maintain_order=True)
        return buckets.with_breaks(rows, _longest_step(case)), None, 0.0
    coarse, width = buckets.bucketed(table, columns, case.survey.length, count)
    _, stretches = _worst_stretches(case, fine_bytes / _bytes_per_second(case))
    if not stretches:
        return coarse, coarse.clear(), width
    is_near = buckets.between(stretches)
    near = table.collect(
        lambda part: part.with_columns(columns[0]).filter(is_near).select('time', *columns[1:])
    )
    # As a rule they are in order, and a copy of what is near takes room.
    is_sorted = near['time'].is_sorted()
    return coarse, near if is_sorted else near.sort('time', maintain_order=True), width


def _longest_step(case: AxisCase) -> float:
    """Return the time between two rows above which it is a gap [s]."""
    return case.settings.timeouts[Source.SPEED] / SECOND


def _fine(
    case: AxisCase, near: pl.DataFrame | None, fine_bytes: float
) -> tuple[int, list[dict[str, Any]]]:
    """Return of how many of the worst events every sample is kept, and the stretches of those."""
    longest = fine_bytes / _bytes_per_second(case)
    while near is not None:
        shown, stretches = _worst_stretches(case, longest)
        parts = (near.filter(buckets.between([stretch])) for stretch in stretches)
        records = [
            buckets.fine_record(buckets.with_breaks(part, _longest_step(case)))
            for part in parts
            if part.height > 1
        ]
        size = len(script_json(records))
        if size <= fine_bytes or not shown:
            return shown, records
        # Rates differ, and so do times that are not even.
        length = sum(end - begin for begin, end in stretches)
        longest = LESS * fine_bytes / size * min(longest, length)
    return 0, []


def _worst_stretches(case: AxisCase, longest: float) -> tuple[int, list[tuple[float, float]]]:
    """
    Return of how many of the worst events samples are kept, and where; `longest` in all [s].

    Stretches are in order, those that touch are one.

    """
    chosen: list[tuple[float, float]] = []
    count = 0
    for event in case.worst_first[: buckets.WORST]:
        ends = ((at - AROUND, at + AROUND) for at in case.span(event))
        spans: list[tuple[float, float]] = []
        for begin, end in sorted([*chosen, *ends]):
            if spans and begin <= spans[-1][1]:
                spans[-1] = spans[-1][0], max(spans[-1][1], end)
            else:
                spans.append((begin, end))
        if sum(end - begin for begin, end in spans) > longest:
            break
        count, chosen = count + 1, spans
    return count, chosen


def _bytes_per_second(case: AxisCase) -> float:
    """Return how much a second of every sample takes in a page, at the mean rate [bytes/s]."""
    count = len(_numbers(case)) - 1  # the temperature changes too seldom
    return count * SAMPLE_BYTES * case.survey.rows / max(case.survey.span, 1e-9)


def row_columns(case: AxisCase, numbers: Iterable[str]) -> list[pl.Expr]:
    """Return rows in the units of the page; NaN where a number is not measured or judged."""
    still = pl.col('gates') & STANDSTILL != 0
    unjudged = pl.col('gates') & (STANDSTILL | LIGHT_LOAD) != 0
    line = pl.col('stamp' if case.survey.by_stamp else 'log_time')
    measured = pl.col('motor_torque_source') == PointSource.MEASURED
    turn = RPM / case.surface.lead if case.speaks_feed else RPM  # one of the unit [rad/s]
    # Since its input went quiet, a number is only held.
    held = {
        name: pl.col(f'{name}_source') == PointSource.HELD
        for name in ('speed', 'axial_load', 'temperature')
    }
    known = {
        'speed': (held['speed'], buckets.over(pl.col('speed'), turn)),
        'load': (held['axial_load'], pl.col('axial_load')),
        'temperature': (held['temperature'], pl.col('temperature') + celsius(0.0)),
        'efficiency': (unjudged, 100.0 * pl.col('efficiency')),
        'film_ratio': (still, pl.col('film_ratio')),
        'rcs': (still, pl.col('rcs')),
        'measured_torque': (~measured, pl.col('motor_torque')),
        'machine_torque': (still, pl.col('machine_torque')),
    }
    ranks = {
        name: pl.sum_horizontal(
            (pl.col(name) == code).cast(pl.UInt8) * pl.lit(rank, pl.UInt8)
            for code, rank in codes.items()
        )
        for name, codes in RANKS.items()
    }
    ranks['regime'] = pl.when(still).then(0).otherwise(ranks['regime'])
    ranks['zone'] = pl.when(still).then(1).otherwise(ranks['zone'])
    return [
        buckets.over(line - case.survey.first, SECOND).alias('time'),
        *(
            pl.when(known[name][0]).then(math.nan).otherwise(known[name][1]).alias(name)
            for name in numbers
        ),
        *(rank.cast(pl.UInt8).alias(name) for name, rank in ranks.items()),
    ]


def panels(case: AxisCase) -> list[dict[str, Any]]:
    """Return the panels of the numbers of an axis, in their order."""
    limits, percent = case.settings.limits, 100.0 * case.settings.limits.efficiency
    motion = _panel('Screw speed', 'rev/min', [_line('speed', 'speed')])
    if case.speaks_feed:
        beside = {'unit': 'rev/min', 'factor': 1.0 / case.surface.lead}
        motion = _panel('Feed', 'm/min', [_line('speed', 'speed')], beside=beside)
    every = [
        motion,
        _panel('Axial load, positive along the axis', 'N', [_line('load', 'load')]),
        _panel('Oil temperature', '°C', [_line('temperature', 'oil')], height=110),
        _panel(
            'Efficiency, where it is judged',
            '%',
            [_line('efficiency', 'efficiency')],
            limits=[_limit(percent, f'limit {percent:g} %', 'efficiency')],
            most=100.0,
        ),
        _panel(
            'Film ratio: oil film over roughness',
            '',
            [_line('film_ratio', 'film ratio')],
            floor=SMALLEST_RATIO,
            bands=_bands(),
            show=[0.5, LARGEST_RATIO],
        ),
        _panel(
            'RCS: share of the load carried where metal pierces the oil film',
            '',
            [_line('rcs', 'RCS')],
            floor=SMALLEST_RCS,
            limits=[_limit(limits.rcs, f'limit {limits.rcs:g}', 'rcs')],
            show=[SMALLEST_RCS, 1.0],
        ),
        _panel(
            'Torque on the screw, measured and modelled',
            'N m',
            [
                _line('measured_torque', 'measured', 'measured'),
                _line('machine_torque', 'modelled', 'modelled', dashed=True),
            ],
        ),
    ]
    keys = _numbers(case)
    return [panel for panel in every if panel['series'][0]['key'] in keys]


def _panel(title: str, unit: str, series: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    return {
        'title': f'{title} [{unit}]' if unit else f'{title} [-]',
        'unit': unit,
        'height': HEIGHT,
        'series': series,
        'floor': None,
        'most': None,
        'beside': None,
        'limits': [],
        'bands': [],
        'show': [limit['value'] for limit in more.get('limits', [])],
    } | more


def _line(key: str, label: str, colour: str = 'ink', *, dashed: bool = False) -> dict[str, Any]:
    return {'key': key, 'label': label, 'colour': colour, 'dashed': dashed}


def _limit(value: float, label: str, colour: str) -> dict[str, Any]:
    return {'value': value, 'label': label, 'colour': colour}


def _bands() -> list[dict[str, Any]]:
    edges = itertools.pairwise((SMALLEST_RATIO / 2, *FILM_RATIO_LIMITS, 10 * LARGEST_RATIO))
    return [
        {'low': low, 'high': high, 'colour': f'{regime.word}-band', 'label': regime.word}
        for regime, (low, high) in zip(REGIMES, edges, strict=True)
    ]
