# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The course of an axis over time, as panels of a page: numbers, limits, regimes and warnings."""

from collections.abc import Iterable
import math
from typing import Any

from ballscrew_monitor.core.conversions import celsius, SECOND
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Level, Zone
from ballscrew_monitor.recordings.columns import (
    Codes,
    Floats,
    JudgedColumns,
    LIGHT_LOAD,
    STANDSTILL,
)
from ballscrew_monitor.report.buckets import (
    between,
    Buckets,
    coarse_record,
    fine_record,
    in_order,
    joined_rows,
    stretch_of,
    TimedRows,
    with_breaks,
)
from ballscrew_monitor.report.case import AxisCase
from ballscrew_monitor.report.encoding import script_json
from ballscrew_monitor.report.page_budget import AxisBudget, BUCKETS, PAGE_BYTES, WORST
from ballscrew_monitor.report.panels import panels
import numpy as np
from surrogate.surface import Regime
from surrogate.units import RPM

COARSE_BYTES, EVENT_BYTES = 5000, 60  # of panels and the like in the page, and of an event
AROUND = 1.0  # [s] about an end of an event, of which every sample is kept
SAMPLE_BYTES = 8 / 3  # of one number of a stretch in the page
STRETCH_BYTES = 1000  # of a stretch in the page besides its numbers
LESS = 0.95  # of what would just fit, where stretches were too large
# What is drawn of codes: the largest of a bucket, so the worst comes last.
BARS = (
    ('regime', 'Regime', ('none', 'hydrodynamic', 'mixed', 'boundary')),
    ('zone', 'Zone', ('none', 'none', 'optimal', 'unjudged', 'outside')),
    ('level', 'Warning', ('none', 'unjudged', 'optimal', 'outside')),
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
_REGIME_RANK = {Regime.UNKNOWN: 0, Regime.HYDRODYNAMIC: 1, Regime.MIXED: 2, Regime.BOUNDARY: 3}
_ZONE_RANK = {Zone.UNKNOWN: 3, Zone.OPTIMAL: 2, Zone.OUTSIDE: 4}
_LEVEL_RANK = {Level.UNKNOWN: 1, Level.OK: 2, Level.WARN: 3}
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
    case: AxisCase, fine_bytes: float = PAGE_BYTES, budget: AxisBudget | None = None
) -> dict[str, Any]:
    """Return the course of an axis; `fine_bytes` of the page are for every sample of events."""
    budget = budget or AxisBudget()
    coarse, near, bucket = _columns(case, fine_bytes, budget.buckets)
    shown, fine = _fine(case, near, fine_bytes)
    record = coarse_record(coarse)
    codes = record.pop('codes')
    if bucket:  # the times follow from it
        record.pop('time')
    return record | {
        'span': case.survey.span,
        'bucket': bucket,
        'shown': shown,
        'worst': min(WORST, len(case.outcome.events)),
        'begins': None if math.isnan(case.begins) else case.begins,
        'fine': fine,
        'bars': [
            {'title': title, 'codes': codes[key], 'colours': colours}
            for key, title, colours in BARS
        ],
        'events': [
            {'begin': case.since_first(event.start), 'end': case.since_first(event.end)}
            for event in case.worst_first[: budget.events]
        ],
        'panels': [
            panel
            for panel in panels(case.settings.limits)
            if panel['series'][0]['key'] in coarse.numbers
        ],
    }


def drawn_rows(case: AxisCase) -> TimedRows:
    """Return all rows of a short recording, extremes of buckets of a long one."""
    return _columns(case, 0.0, BUCKETS)[0]


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
    return 2.0 * (2.0 * AROUND * _bytes_per_second(case, _fine_columns(case)) + STRETCH_BYTES)


def _is_short(case: AxisCase, buckets: int) -> bool:
    """Tell whether all samples are kept, because they are no more than the rows of buckets."""
    return case.survey.rows <= 2 * buckets


def _numbers(case: AxisCase) -> tuple[str, ...]:
    """Return the keys of the columns: torques only where one was measured."""
    torque = bool(case.survey.torque.count)
    return tuple(key for key in NUMBERS if torque or not key.endswith('torque'))


def _fine_columns(case: AxisCase) -> int:
    """Return how many columns take room; the temperature changes too seldom."""
    return len(_numbers(case)) - 1


def _columns(
    case: AxisCase, fine_bytes: float, buckets: int
) -> tuple[TimedRows, TimedRows | None, float]:
    """Return the rows of the whole, those near the worst events, and the width of a bucket [s]."""
    numbers = _numbers(case)
    if _is_short(case, buckets):
        rows = joined_rows([rows_of(case, block, numbers) for block in case.blocks()])
        return with_breaks(in_order(rows), _longest_step(case)), None, 0.0
    _, stretches = _worst_stretches(case, _longest(case, fine_bytes))
    found = Buckets(case.survey.span, numbers, [key for key, _, _ in BARS], count=buckets)
    kept: list[TimedRows] = []
    for block in case.blocks():
        rows = rows_of(case, block, numbers)
        found.add(rows)
        kept.append(between(rows, stretches))
    return found.rows(), in_order(joined_rows(kept)), found.width


def _longest(case: AxisCase, fine_bytes: float) -> float:
    """Return how long stretches may be in all at the mean rate [s]."""
    return fine_bytes / _bytes_per_second(case, _fine_columns(case))


def _longest_step(case: AxisCase) -> float:
    """Return the time between two rows above which it is a gap [s]."""
    return case.settings.timeouts[Source.SPEED] / SECOND


def _fine(
    case: AxisCase, near: TimedRows | None, fine_bytes: float
) -> tuple[int, list[dict[str, Any]]]:
    """Return of how many of the worst events every sample is kept, and the stretches of those."""
    longest = _longest(case, fine_bytes)
    while near is not None:
        shown, stretches = _worst_stretches(case, longest)
        parts = [stretch_of(near, *stretch) for stretch in stretches]
        records = [
            fine_record(with_breaks(part, _longest_step(case)))
            for part in parts
            if part.time.size > 1
        ]
        size = len(script_json(records))
        if size <= fine_bytes or not shown:
            return shown, records
        # Rates differ, and so do times that are not even.
        longest = LESS * fine_bytes / size * min(longest, _length(stretches))
    return 0, []


def rows_of(case: AxisCase, block: JudgedColumns, numbers: tuple[str, ...]) -> TimedRows:
    """Return a block in the units of the page; NaN where a number is not measured or judged."""
    line = block.stamp if case.survey.by_stamp else block.log_time
    still = block.gates & STANDSTILL != 0
    unjudged = still | (block.gates & LIGHT_LOAD != 0)
    made = {
        'speed': _fresh(block.speed / RPM, block.speed_source),
        'load': _fresh(block.axial_load, block.axial_load_source),
        'temperature': _fresh(celsius_of(block.temperature), block.temperature_source),
        'efficiency': np.where(unjudged, np.nan, 100.0 * block.efficiency),
        'film_ratio': np.where(still, np.nan, block.film_ratio),
        'rcs': np.where(still, np.nan, block.rcs),
        'measured_torque': block.measured_torque,
        'machine_torque': np.where(still, np.nan, block.machine_torque),
    }
    return TimedRows(
        time=(line - case.survey.first) / SECOND,
        numbers={key: made[key] for key in numbers},
        codes=_codes(block, still),
    )


def _fresh(values: Floats, sources: Codes) -> Floats:
    """Return numbers without those that are only held since their input went quiet."""
    return np.where(sources == PointSource.HELD, np.nan, values)


def celsius_of(temperature: Floats) -> Floats:
    """Return temperatures [K] in [degC]."""
    return temperature + celsius(0.0)


def _codes(block: JudgedColumns, still: np.ndarray) -> dict[str, Codes]:
    regime, zone, level = (_ranks(table) for table in (_REGIME_RANK, _ZONE_RANK, _LEVEL_RANK))
    return {
        'regime': np.where(still, 0, regime[block.regime]).astype(np.uint8),
        'zone': np.where(still, 1, zone[block.zone]).astype(np.uint8),
        'level': level[block.level],
    }


def _ranks(table: dict[Any, int]) -> Codes:
    return np.array([table[code] for code in sorted(table)], dtype=np.uint8)


def _worst_stretches(case: AxisCase, longest: float) -> tuple[int, list[tuple[float, float]]]:
    """Return of how many of the worst events samples are kept, and where; `longest` in all [s]."""
    chosen: list[tuple[float, float]] = []
    count = 0
    for event in case.worst_first[:WORST]:
        ends = case.since_first(event.start), case.since_first(event.end)
        more = _merged([*chosen, *((at - AROUND, at + AROUND) for at in ends)])
        if _length(more) > longest:
            break
        count, chosen = count + 1, more
    return count, chosen


def _bytes_per_second(case: AxisCase, columns: int) -> float:
    """Return how much a second of some columns takes in a page, at the mean rate [bytes/s]."""
    return columns * SAMPLE_BYTES * case.survey.rows / max(case.survey.span, 1e-9)


def _length(stretches: Iterable[tuple[float, float]]) -> float:
    """Return how long stretches are in all [s]."""
    return sum(end - begin for begin, end in stretches)


def _merged(stretches: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return stretches in order, those that touch as one."""
    made: list[tuple[float, float]] = []
    for begin, end in sorted(stretches):
        if made and begin <= made[-1][1]:
            made[-1] = made[-1][0], max(made[-1][1], end)
        else:
            made.append((begin, end))
    return made
