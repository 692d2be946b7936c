# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Summaries of logs: stretches of one log and one place as a cell, and older logs merged.

Means are weighted by time and pooled exactly, so that the order of merging changes nothing but
roundings, and no stretch is lost or counted twice.

"""

from collections import Counter
from collections.abc import Iterable, MutableMapping
import dataclasses
import datetime
import math
from operator import attrgetter
from typing import Any

from ballscrew_monitor.health.bands import day_of, FIRST_DAY, load_band, period_of, speed_band
from ballscrew_monitor.health.records import CELL, Cell, CellKind, LoadSource, Missing, Stretch
from ballscrew_monitor.health.rows import DAY
import numpy as np
from numpy.typing import NDArray

MOST_PLACES = 400  # cells of one period; those with the fewest stretches go first
MEANS = ('speed', 'axial_load', 'temperature', 'motor_torque', 'backlash')
NAMES = tuple(field.name for field in dataclasses.fields(Cell))
PLACE = attrgetter(
    *('start', 'days', 'kind', 'speed_band', 'load_band', 'direction', 'load_source'),
    'temperature_measured',
)
"""All that tells cells apart: log, period [days], kind, place and sources."""
Cells = MutableMapping[Any, Cell]
"""Cells by their places."""


def by_place(cells: Iterable[Cell]) -> dict[Any, Cell]:
    """Return cells by their places; those of one place are merged."""
    kept: dict[Any, Cell] = {}
    for cell in cells:
        _put(kept, cell)
    return kept


def array_of(cells: Iterable[Cell]) -> NDArray[Any]:
    """Return cells as an array of CELL, ordered by their logs."""
    rows = [tuple(getattr(cell, name) for name in NAMES) for cell in cells]
    array = np.array(rows, dtype=CELL)
    return array[np.argsort(array['start'], kind='stable')]


def add(cells: Cells, stretch: Stretch, start: int | None = None, today: int | None = None) -> str:
    """
    Add a stretch to the cells of its log; return in a sentence why it does not count, or ''.

    `start` [ns] is that of the log, None for a log of each day. `today` is the day of the clock
    since 1970, by which stamps are checked where it is known.

    """
    day = day_of(stretch.start)
    if objection := clock_objection(day, today):
        return objection
    cell = cell_of(stretch, day * DAY if start is None else start)
    is_new = PLACE(cell) not in cells
    _put(cells, cell)
    if is_new and _drop_rare(cells, (cell.start, cell.days)):
        return f'a stretch does not count: its log has {MOST_PLACES} places already'
    return ''


def cell_of(stretch: Stretch, start: int) -> Cell:
    """Return the cell of one stretch of the log that begins at `start` [ns]."""
    derived = stretch.load_source == LoadSource.DERIVED
    moves = stretch.speed != 0.0
    return Cell(
        start=start,
        first_day=day_of(start),
        kind=int(CellKind.MOTION if moves else CellKind.STANDSTILL),
        speed_band=speed_band(abs(stretch.speed)) if moves else 0,
        load_band=0 if derived or not moves else load_band(stretch.axial_load),
        direction=(stretch.speed > 0.0) - (stretch.speed < 0.0),
        load_source=int(stretch.load_source),
        temperature_measured=stretch.temperature_measured,
        stretches=1,
        duration=stretch.duration,
        speed=stretch.speed,
        axial_load=stretch.axial_load,
        temperature=stretch.temperature,
        motor_torque=stretch.motor_torque,
    )


def nothing(start: int, why: Missing) -> Cell:
    """Return the cell of a log from `start` [ns] on without motion that counts."""
    return Cell(start=start, first_day=day_of(start), kind=int(CellKind.NOTHING), missing=int(why))


def clock_objection(day: int, today: int | None) -> str:
    """Return in a sentence why motion of a `day` cannot be of `today`, both since 1970, or ''."""
    if day < FIRST_DAY:
        return f'motion of {date_text(day)} does not count: the clock was not set'
    if today is not None and abs(day - today) > 1:
        return (
            f'motion of {date_text(day)} does not count: the clock says {date_text(today)}, '
            'one day off is allowed'
        )
    return ''


def date_text(day: int) -> str:
    """Return a day since 1970 for people, UTC."""
    try:
        return f'{datetime.date(1970, 1, 1) + datetime.timedelta(days=day)}'
    except OverflowError:
        return f'day {day}'


def merged(cell: Cell, other: Cell) -> Cell:
    """Return two cells of one key as one, with their means by time."""
    duration = cell.duration + other.duration
    share = other.duration / duration if duration > 0.0 else 0.0
    means: dict[str, Any] = {}
    for name in MEANS:
        value, more = getattr(cell, name), getattr(other, name)
        mean = value + share * (more - value)
        means[name] = mean if not math.isnan(mean) else more if math.isnan(value) else value
    return dataclasses.replace(
        cell, stretches=cell.stretches + other.stretches, duration=duration, **means
    )


def aged(cells: Iterable[Cell], today: int) -> tuple[list[Cell], list[str]]:
    """
    Return cells with days merged into weeks and weeks into periods of 28 days by their age.

    `today` in days since 1970. Cells of days to come do not count and stay as they are, at the
    end; notes say how many, and how many of too many places were left out.

    """
    kept: dict[Any, Cell] = {}
    future, notes = [], []
    for cell in cells:
        if cell.first_day > today + 1:
            future.append(cell)
            continue
        first_day, days = period_of(cell.first_day, cell.days, today)
        start = cell.start if days == 1 else first_day * DAY
        _put(kept, dataclasses.replace(cell, start=start, first_day=first_day, days=days))
    if future:
        first = date_text(min(cell.first_day for cell in future))
        notes.append(
            f'{len(future)} cells from {first} on do not count: the clock says {date_text(today)}'
        )
    sizes = Counter((cell.start, cell.days) for cell in kept.values())
    full = [period for period, places in sizes.items() if places > MOST_PLACES]
    if dropped := sum(_drop_rare(kept, period) for period in full):
        notes.append(f'{dropped} rare places left out, a period holds {MOST_PLACES}')
    return [*(kept[place] for place in sorted(kept)), *future], notes


def _put(cells: Cells, cell: Cell) -> None:
    place = PLACE(cell)
    cells[place] = merged(cells[place], cell) if place in cells else cell


def _drop_rare(cells: Cells, period: tuple[int, int]) -> int:
    """Drop the places with the fewest stretches above the limit of a period; return how many."""
    places = [place for place in cells if place[:2] == period]
    rare = sorted(places, key=lambda place: -cells[place].stretches)[MOST_PLACES:]
    for place in rare:
        del cells[place]
    return len(rare)
