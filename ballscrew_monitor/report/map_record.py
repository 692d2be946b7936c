# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The operating map of an axis for page and picture: zone, borders, time spent, warnings."""

from collections.abc import Mapping, Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import (
    celsius,
    Direction,
    direction_of,
    opposing_load,
    SECOND,
)
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.recordings.declared import written
from ballscrew_monitor.report import operating_field
from ballscrew_monitor.report.judging import AxisCase
from ballscrew_monitor.report.operating_field import Field
from ballscrew_monitor.report.page import floats, packed
from contourpy import contour_generator
import numpy as np
from numpy.typing import NDArray
import polars as pl
from surrogate.surface import FILM_RATIO_LIMITS
from surrogate.units import RPM

Array = NDArray[np.float64]

COLUMNS, ROWS = 72, 48  # cells of the time spent
MARKED = 20  # events that are drawn, the worst
NAMED_EFFICIENCIES = (0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.97)
TOP, BELOW_TOP, MIDDLE = 0.96, 0.88, 0.7  # heights of the names of lines, as parts of the map
OUTSIDE, OPTIMAL, NO_NUMBER = 0, 1, 2  # codes of the cells of the zone


def longest_dwell(cells: Array) -> float:
    """Return the longest time in a cell [s], 1 where there is none."""
    return float(cells.max()) or 1.0


def _ends(span: tuple[float, float]) -> dict[str, float]:
    return dict(zip(('low', 'high'), span, strict=True))


def _grid(cells: Array, content: Any, **more: float) -> dict[str, Any]:
    """Return cells as a page carries them, with their `content` in one of its forms."""
    return {'columns': cells.shape[1], 'rows': cells.shape[0], **more, 'cells': content}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class MapLine:
    """Where a quantity has a level; its name is at a height, a part of that of the map."""

    kind: str
    label: str
    height: float
    points: Array = written(form=floats)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class OperatingMap:
    """
    The map of an axis at an oil temperature [degC], between speeds [rev/min] and loads [N].

    Rows of the cells of zone (a code) and dwell [s] are of a load, columns of a speed. Points of
    lines are speed and load in turn, NaN where one is interrupted. `events`: the worst warnings by
    number, place [rev/min], [N] and what the page shows of time [s]. `others`: borders at other
    temperatures are among the lines; `banded`: so is the range of that in force. `feed`: how far
    the axis moves in a revolution [m] if its log speaks of that, else None.

    """

    temperature: float
    others: bool
    banded: bool
    feed: float | None = None
    speed: tuple[float, float] = written(form=_ends)
    load: tuple[float, float] = written(form=_ends)
    light_load: float
    zone: Array = written(form=lambda cells: _grid(cells, packed(cells.ravel())))
    lines: Sequence[MapLine]
    dwell: Array = written(
        form=lambda cells: _grid(cells, floats(cells), longest=longest_dwell(cells))
    )
    events: Sequence[Mapping[str, Any]]


def operating_map(case: AxisCase) -> OperatingMap:
    """Return the map of an axis at the mean temperature of its oil in motion."""
    limits, surface, oil = case.settings.limits, case.surface, case.survey.oil
    speeds = operating_field.judged_speeds(surface, limits.standstill_speed)
    opposing = case.survey.opposing
    loads = operating_field.loads_around(
        surface, opposing.low, opposing.high, light_load=limits.light_load
    )
    known = (oil.low, oil.mean, oil.high)
    if math.isnan(oil.mean):  # then that of the datasheet
        known = (surface.reference_temperature,) * 3
    mean, others = operating_field.map_temperatures(*map(celsius, known))
    field = operating_field.sample(surface, mean, speeds=speeds, loads=loads)
    lines = map_lines(field, limits, mean)
    for degrees in others:
        border = operating_field.sample(surface, degrees, speeds=speeds, loads=loads)
        lines.append(map_line(border, border.rcs, limits.rcs, 'rcs_other', _degrees(degrees)))
    return OperatingMap(
        temperature=mean,
        others=bool(others),
        banded=math.isfinite(field.band[0]),
        feed=surface.lead if case.speaks_feed else None,
        speed=(speeds[0] / RPM, speeds[1] / RPM),
        load=loads,
        light_load=limits.light_load,
        zone=zone_cells(field, limits),
        lines=lines,
        dwell=_dwell(case, speeds, loads),
        events=[
            {
                'number': event.event_id,
                'speed': abs(event.speed) / RPM,
                'load': opposing_load(event.axial_load, direction_of(event.speed)),
                **dict(zip(('begin', 'end'), case.shown(event))),
            }
            for event in reversed(case.worst_first[:MARKED])  # the worst last, to be on top
            if event.place
        ],
    )


def _degrees(temperature: float) -> str:
    return f'{temperature:.0f} °C'


def zone_cells(field: Field, limits: Limits) -> Array:
    """Return the zone in the cells between the points of the field."""
    middles = field.middles()
    known = np.where(middles.is_optimal(limits), OPTIMAL, OUTSIDE)
    return np.where(np.isnan(middles.rcs), NO_NUMBER, known)


def map_lines(field: Field, limits: Limits, mean: float) -> list[MapLine]:
    """Return the lines of a field at an oil temperature [degC], the limits last."""
    shown = field.judged_efficiency(limits.light_load)
    percent = f'{100 * limits.efficiency:g} %'
    return [
        *(
            map_line(field, shown, level, 'efficiency_other', f'{100 * level:g} %', MIDDLE)
            for level in NAMED_EFFICIENCIES
        ),
        *(
            map_line(field, field.film_ratio, level, 'film', f'Λ {level:g}', TOP)
            for level in FILM_RATIO_LIMITS
        ),
        *(
            map_line(field, field.rcs, limits.rcs, 'rcs_band', '', factor=factor)
            for factor in field.band
            if math.isfinite(factor)
        ),
        map_line(field, shown, limits.efficiency, 'efficiency', percent, BELOW_TOP),
        map_line(field, field.rcs, limits.rcs, 'rcs', _degrees(mean)),
    ]


def map_line(
    field: Field,
    values: Array,
    level: float,
    kind: str,
    label: str,
    height: float = BELOW_TOP,
    *,
    factor: float = 1.0,
) -> MapLine:
    """Return where values are at a level, as points with breaks; speeds times a factor."""
    lines: Any = contour_generator(factor * field.speed, field.load, values).lines(level)
    gap = np.full((1, 2), np.nan)
    parts: list[Array] = [part for line in lines for part in (line, gap)]
    points = np.concatenate(parts[:-1]) if parts else np.empty((0, 2))
    return MapLine(kind=kind, label=label, height=height, points=points)


def _dwell(case: AxisCase, speeds: tuple[float, float], loads: tuple[float, float]) -> Array:
    """Return the time spent in each cell [s]; before a gap it is not counted."""
    longest, limits = case.settings.timeouts[Source.SPEED], case.settings.limits
    step, speed = pl.col('stamp').shift(-1) - pl.col('stamp'), pl.col('speed').abs()
    load, direction = pl.col('axial_load'), pl.col('direction')
    forward, backward = direction == Direction.POSITIVE, direction == Direction.NEGATIVE
    opposing = pl.when(forward).then(0.0 - load).when(backward).then(load)  # else null
    cells = (
        _cell(opposing, np.linspace(*loads, ROWS + 1)).alias('row'),
        _cell(speed, np.geomspace(*speeds, COLUMNS + 1)).alias('column'),
    )

    def query(part: pl.LazyFrame) -> pl.LazyFrame:
        moving = speed >= limits.standstill_speed
        lasting = part.with_columns(step=step).filter(moving)
        lasting = lasting.filter(pl.col('step').is_between(1, longest))
        return lasting.group_by(*cells).agg(pl.sum('step'))

    sums = case.row_table.collect(query, ahead=1).drop_nulls()
    row, column, time = (sums[name].to_numpy() for name in ('row', 'column', 'step'))
    dwell = np.zeros((ROWS, COLUMNS), np.int64)
    np.add.at(dwell, (row, column), time)
    return dwell / SECOND


def _cell(value: pl.Expr, edges: Array) -> pl.Expr:
    """Return between which edges a number is, null if between none; the last one belongs to it."""
    place = pl.lit(pl.Series(edges)).search_sorted(value, side='right').cast(pl.Int64) - 1
    last = len(edges) - 1
    place = pl.when(value == edges[-1]).then(last - 1).otherwise(place)
    return pl.when(value.is_finite() & place.is_between(0, last - 1)).then(place)


def map_legend(case: AxisCase, chart: OperatingMap) -> list[tuple[tuple[str, ...], str]]:
    """Return what is on a map: colour, shape and dashes of each sample, and its words."""
    limits, degrees = case.settings.limits, f'{chart.temperature:g} °C'
    entries: list[tuple[tuple[str, ...], str]] = [
        (('zone',), f'optimal zone at {degrees}'),
        (('heat',), 'time spent, darker is longer'),
        (('rcs', 'line'), f'RCS {limits.rcs:g}: left of it metal pierces the oil film'),
        (('efficiency', 'line'), f'efficiency {100 * limits.efficiency:g} %'),
        (('hatch', 'dots'), 'light load: efficiency is not judged'),
        (('film', 'line', '2 3'), 'film ratio Λ 1 and 3'),
    ]
    if chart.others:
        text = 'RCS limit with the coldest and the warmest oil'
        entries.insert(3, (('rcs', 'line', '6 4'), text))
    if chart.banded:
        text = 'RCS limit, its range by what is not known'
        entries.insert(3, (('rcs', 'line', '8 3 2 3'), text))
    return entries
