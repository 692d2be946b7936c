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
    BUCKETS,
    Buckets,
    coarse_record,
    fine_record,
    in_order,
    joined_rows,
    TimedRows,
    with_breaks,
)
from ballscrew_monitor.report.case import AxisCase
from ballscrew_monitor.report.panels import panels
import numpy as np
from surrogate.surface import Regime
from surrogate.units import RPM

SHORT = 2 * BUCKETS  # rows up to which all are kept
WORST, AROUND = 50, 1.0  # events of which every sample is kept, and for how long about an end [s]
SHADED = 1000  # events that are shaded, the worst
FINE_BYTES = 3_750_000  # of all stretches in the page, in base64
SAMPLE_BYTES = 8 / 3  # of one number of a stretch in the page
# What is drawn of codes: the largest of a bucket, so the worst comes last.
BARS = (
    ('regime', 'Regime', ('none', 'hydrodynamic', 'mixed', 'boundary')),
    ('zone', 'Zone', ('none', 'none', 'optimal', 'unjudged', 'outside')),
    ('level', 'Warning', ('none', 'unjudged', 'optimal', 'outside')),
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


def course_record(case: AxisCase, fine_bytes: int = FINE_BYTES) -> dict[str, Any]:
    """Return the course of an axis; `fine_bytes` of the page are for every sample of events."""
    numbers = _numbers(case)
    # The temperature changes too seldom to take any room.
    shown, stretches = _stretches(case, len(numbers) - 1, fine_bytes)
    coarse, fine, bucket = _columns(case, numbers, stretches)
    record = coarse_record(coarse)
    codes = record.pop('codes')
    if bucket:  # the times follow from it
        record.pop('time')
    return record | {
        'span': case.survey.span,
        'bucket': bucket,
        'shown': shown,
        'begins': None if math.isnan(case.begins) else case.begins,
        'fine': [fine_record(part) for part in fine],
        'bars': [
            {'title': title, 'codes': codes[key], 'colours': colours}
            for key, title, colours in BARS
        ],
        'events': [
            {'begin': case.since_first(event.start), 'end': case.since_first(event.end)}
            for event in case.worst_first[:SHADED]
        ],
        'panels': [
            panel for panel in panels(case.settings.limits) if panel['series'][0]['key'] in numbers
        ],
    }


def _numbers(case: AxisCase) -> tuple[str, ...]:
    """Return the keys of the columns: torques only where one was measured."""
    torque = bool(case.survey.torque.count)
    return tuple(key for key in NUMBERS if torque or not key.endswith('torque'))


def _stretches(
    case: AxisCase, columns: int, fine_bytes: int
) -> tuple[int, list[tuple[float, float]]]:
    """Return of how many of the worst events every sample is kept about their ends, and where."""
    rate = case.survey.rows / max(case.survey.span, 1e-9)
    allowed = fine_bytes / (rate * columns * SAMPLE_BYTES)
    chosen: list[tuple[float, float]] = []
    count = 0
    for event in case.worst_first[:WORST]:
        ends = case.since_first(event.start), case.since_first(event.end)
        more = _merged([*chosen, *((at - AROUND, at + AROUND) for at in ends)])
        if sum(end - begin for begin, end in more) > allowed:
            break
        count, chosen = count + 1, more
    return count, chosen


def _merged(stretches: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return stretches in order, those that touch as one."""
    made: list[tuple[float, float]] = []
    for begin, end in sorted(stretches):
        if made and begin <= made[-1][1]:
            made[-1] = made[-1][0], max(made[-1][1], end)
        else:
            made.append((begin, end))
    return made


def _columns(
    case: AxisCase, numbers: tuple[str, ...], stretches: list[tuple[float, float]]
) -> tuple[TimedRows, list[TimedRows], float]:
    """Return the rows of the whole, those of each stretch, and the width of a bucket [s]."""
    gap = case.settings.timeouts[Source.SPEED] / SECOND
    if case.survey.rows <= SHORT:
        rows = joined_rows([rows_of(case, block, numbers) for block in case.blocks()])
        return with_breaks(in_order(rows), gap), [], 0.0
    buckets = Buckets(case.survey.span, numbers, [key for key, _, _ in BARS])
    kept: list[TimedRows] = []
    for block in case.blocks():
        rows = rows_of(case, block, numbers)
        buckets.add(rows)
        kept.append(between(rows, stretches))
    near = in_order(joined_rows(kept))
    parts = [between(near, [stretch]) for stretch in stretches]
    fine = [with_breaks(part, gap) for part in parts if part.time.size > 1]
    return buckets.rows(), fine, buckets.width


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
