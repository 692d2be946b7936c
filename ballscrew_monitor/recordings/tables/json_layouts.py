# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Signals of JSON: of the data recorder of a SINUMERIK, and of tables as programs write them.

The layouts of tables are brought to two: records, or lists by their names. Each is an entry of a
table. What none of them is stays as it is.

"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
import contextlib
import itertools
import json
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.heads import unlike, with_unit
from ballscrew_monitor.recordings.tables.layouts import period_of, property_of, RECORDER
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.quantities import RATED
from ballscrew_monitor.recordings.tables.signals import (
    columns_of_records,
    side_by_side,
    Signals,
    signals_of,
    stated_factors,
)
from ballscrew_monitor.recordings.tables.unit_names import BRACKETS
from ballscrew_monitor.recordings.words import short
import numpy as np
import polars as pl
from surrogate.files import limits

NAMES = ('columns', 'names', 'fields', 'headers', 'header', 'channels', 'signals')
ROWS = ('data', 'values', 'rows', 'samples')
CHANNELS = ('channels', 'signals', 'series', 'traces', 'curves', 'data', 'datasets')
NAME = ('name', 'label', 'id', 'channel', 'signal')
UNIT = ('unit', 'units')
VALUES = ('values', 'data', 'samples', 'y')
TIMES = ('times', 'timestamps', 'time', 'x')
INDEX = 'index'
"""Name of a column of what pandas calls so."""
OF_RECORDER = {'LOAD': RATED, 'TORQUE': 'N m', 'CURRENT': 'A'}
"""Units of signals of a data recorder, which its file does not state."""
OF_LISTS = 'its cells are lists'
CYCLE, COUNTERS = 'CycleTimeMs', ('CYCLE', 'HFProbeCounter')
"""Key of the time of a cycle, and signals that count cycles."""
TRACE = 'SignalListHFData'
"""Key of the signals in a trace of SINUMERIK."""
STAMP = 'HFTimestamp'
"""Key of the count of the cycle of the row behind it."""
HALF = 0.5  # row that a count may be off
Content = Any


def read_json(path: Path) -> Signals:
    """Return the signals of JSON in any of the layouts that are known."""
    content = _parsed(path.read_bytes())
    if limits.is_deeper(content, limits.DEPTH):
        raise Unreadable(f'it nests deeper than {limits.DEPTH}')
    header = content.get('Header') if isinstance(content, dict) else None
    if isinstance(header, dict) and TRACE in header:
        return _sinumerik_json(content)
    left_out, factors, more_rows = {}, '', 0
    content = _plain_table(content)
    if isinstance(content, dict):
        lists = {key: value for key, value in content.items() if isinstance(value, list)}
        records = [key for key, one in lists.items() if one and isinstance(one[0], dict)]
        if not records:
            nested = {name for name, cells in lists.items() if any(map(_is_nested, cells))}
            lists = {name: cells for name, cells in lists.items() if name not in nested}
            left_out = dict.fromkeys(sorted(nested), OF_LISTS)
            periods = _stated_periods(content)
            return signals_of(lists, content, periods, left_out=left_out)
        named = {key: sum(bool(read_name(name).kind) for name in lists[key][0]) for key in records}
        chosen = max(records, key=named.__getitem__)
        factors = ', '.join(stated_factors(content))
        content = _plain_table(lists[chosen])
        others = [name for name in records if name != chosen]
        left_out = dict.fromkeys(others, f'the records of {chosen} are read')
        more_rows = sum(_rows_alike(lists[chosen], lists[name]) for name in others)
    if not _are_all(dict, content):
        raise TypeError
    nested = {name for one in content for name, cell in one.items() if _is_nested(cell)}
    return Signals(
        frame=side_by_side(columns_of_records(content, nested)),
        left_out=left_out | dict.fromkeys(sorted(nested), OF_LISTS),
        more_rows=more_rows,
        empty_rows=[at + 1 for at, record in enumerate(content) if not record],
        factors=factors,
    )


def _is_nested(cell: Any) -> bool:
    return isinstance(cell, list | dict)


def _rows_alike(records: Sequence[Any], others: Sequence[Any]) -> int:
    """Return how many other records there are if they are of the signals of some, else 0."""
    held = [one[0].keys() if isinstance(one[0], dict) else set() for one in (records, others)]
    return len(others) if held[0] and held[0] <= held[1] else 0


def _sinumerik_json(content: Mapping[str, Any]) -> Signals:
    """Return the fast signals of a data recorder: a row for each cycle of the control."""
    header = content['Header']
    parts: Any = content.get('Payload')
    listed = header[TRACE]
    if not _are_all(dict, listed) or not all('Name' in signal for signal in listed):
        raise Unreadable('SignalListHFData of its Header must be a list of signals with a Name')
    if not _are_all(dict, parts) or not _are_all(list, [part.get('HFData', []) for part in parts]):
        raise Unreadable('its Payload must be a list of parts, HFData in each a list of rows')
    names = []
    for signal in listed:
        name, axis = str(signal['Name']), str(signal.get('Axis', ''))
        plain, letter = name.split('|')[0], axis if re.fullmatch(r'[A-Za-z]\d?', axis) else ''
        plain = with_unit(plain, OF_RECORDER.get(plain, ''))
        names.append(f'{letter} {plain}' if letter else plain)
    rows = [row for part in parts for row in part.get('HFData', ())]
    if not rows:
        raise Unreadable('no part of its Payload holds a row of HFData')
    if not _are_all(list, rows) or {*map(len, rows)} != {len(names)}:
        raise Unreadable(f'a row of HFData holds other than {len(names)} cells, one a signal')
    columns = list(zip(*rows, strict=True))
    held = {name: list(column) for name, column in zip(unlike(names), columns, strict=True)}
    for signal, column in zip(listed, columns, strict=True):
        if signal['Name'] in COUNTERS:
            _check_cycles(signal['Name'], column, range(len(rows)))
    begins = itertools.accumulate((len(part.get('HFData', ())) for part in parts), initial=0)
    stamps = {
        begin: part[STAMP].get(COUNTERS[1])
        for begin, part in zip(begins, parts)
        if isinstance(part.get(STAMP), dict)
    }
    _check_cycles(STAMP, [*stamps.values()], [*stamps])
    begin, cycle = header.get('Initial'), header.get(CYCLE) or math.nan
    if not isinstance(cycle, int | float):
        raise Unreadable('CycleTimeMs of its Header is no number')
    start = str(begin.get('Time', '')) if isinstance(begin, dict) else ''
    periods = {CYCLE: cycle * 1e-3} if cycle > 0.0 else {}
    return signals_of(held, header, periods, start=start, program=RECORDER)


def _check_cycles(name: str, counts: Sequence[Any], places: Sequence[int]) -> None:
    """Raise Unreadable if counts of cycles, each of a row by its place, leave cycles out."""
    counted = pl.Series(counts, dtype=pl.Float64, strict=False)
    steps, rows = np.diff(np.array(counted)), np.diff(places)
    usual = np.median(steps / rows) if steps.size else math.nan
    lost = steps > usual * (rows + HALF)
    if usual > 0.0 and lost.any():
        at = int(lost.argmax())
        raise Unreadable(
            f'{name} goes on by {steps[at]:g} from row {places[at] + 1} to row '
            f'{places[at + 1] + 1} of its HFData, usually by {usual * rows[at]:g}: rows '
            'are missing there, save what is before and behind as files of their own'
        )


def _parsed(text: bytes) -> Content:
    """
    Return the content of a JSON text, or of one in each of its lines; raises ValueError.

    A last record that is cut off is an empty one.

    """
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        lines = [line for line in text.splitlines() if line.strip()]
        if len(lines) < 2 or not _is_json(lines[0]):
            raise
    records = []
    for number, line in enumerate(lines):
        try:
            records.append(json.loads(line))
        except json.JSONDecodeError as error:
            if number + 1 < len(lines) or not isinstance(records[0], dict):
                raise Unreadable(f'line {number + 1} is no JSON: {error.msg}') from None
            records.append({})
    return records


def _is_json(line: bytes) -> bool:
    with contextlib.suppress(ValueError):
        json.loads(line)
        return True
    return False


def _plain_table(content: Content) -> Content:
    """Return a table in any known layout as a list of records, or as lists by their names."""
    for layout in LAYOUTS:
        if (table := layout(content)) is not None:
            return table
    return content


def _stated_periods(content: Content) -> dict[str, float]:
    """Return the periods [s] that numbers beside the signals state with their unit, by name."""
    periods: dict[str, float] = {}
    for key, value in content.items() if isinstance(content, dict) else ():
        label, _, unit = key.rpartition('_')
        if isinstance(value, int | float) and property_of(label) in ('period', 'rate'):
            period = period_of(f'{value:.12g} {unit}')
            periods |= {key: period} if math.isfinite(period) else {}
    return periods


def _first(content: Mapping[str, Any], keys: Sequence[str]) -> Any:
    return next((content[key] for key in keys if key in content), None)


def _are_all(kind: type, values: Any) -> bool:
    return isinstance(values, list) and all(isinstance(one, kind) for one in values)


def _are(kind: type, values: Any) -> bool:
    return bool(values) and _are_all(kind, values)


def _named_rows(content: Content) -> Content:
    """Return names beside rows or columns: {columns, data}, perhaps with units and an index."""
    if not isinstance(content, dict):
        return None
    names, rows = _first(content, NAMES), _first(content, ROWS)
    if not (_are(str, names) and _are(list, rows)):
        return None
    units = _first(content, UNIT)
    every = [*(units if _are(str, units) else []), *[''] * len(names)]
    return _columns([with_unit(*pair) for pair in zip(names, every, strict=False)], rows, content)


def _columns(names: Sequence[str], rows: list[Any], content: Mapping[str, Any]) -> Content:
    """Return rows, or columns of the same number as the names, by their names."""
    _check_names(names)
    count = len(names)
    are_rows = all(len(row) == count for row in rows)
    are_columns = len(rows) == count and len({*map(len, rows)}) == 1
    if are_rows and are_columns and INDEX not in content:
        raise Unreadable(
            f'{count} lists of {count} numbers each may be its rows or its columns: write a '
            'record for each time'
        )
    if not are_rows and not are_columns:
        raise Unreadable(f'its lists must hold {count} cells each, one for a name')
    held = [*zip(*rows, strict=True)] if are_rows else rows
    table = {name: list(column) for name, column in zip(names, held, strict=True)}
    index = content.get(INDEX)
    counts = list(range(len(rows)))
    plain = not isinstance(index, list) or index == counts or not are_rows
    return table if plain else {INDEX: index} | table


def _header_row(content: Content) -> Content:
    """Return a list of rows of which the first holds the names."""
    if not _are(list, content) or not _are(str, content[0]) or len(content) < 2:
        return None
    return _columns(content[0], content[1:], {INDEX: None})


def _channels(content: Content) -> Content:
    """Return channels with a name, a unit and values each, in a list or by their names."""
    if not isinstance(content, dict):
        return None
    listed = next((content[key] for key in CHANNELS if _are(dict, content.get(key))), None)
    if listed is None or not all(isinstance(_first(one, VALUES), list) for one in listed):
        named = {name: one for name, one in content.items() if isinstance(one, dict)}
        if not named or not all(isinstance(_first(one, VALUES), list) for one in named.values()):
            return None
        listed = [{'name': name} | one for name, one in named.items()]
    names = [str(_first(one, NAME) or f'channel {at + 1}') for at, one in enumerate(listed)]
    _check_names(names)
    by_time: list[tuple[Any, list[int]]] = []  # times, and the numbers of their channels
    for at, one in enumerate(listed):
        times = _first(one, TIMES)
        alike = next((numbers for known, numbers in by_time if known == times), None)
        if alike is None:
            by_time.append((times, [at]))
        else:
            alike.append(at)
    table: dict[str, Any] = {}
    # A signal has the time before it, so one without any comes first.
    for times, numbers in sorted(by_time, key=lambda group: isinstance(group[0], list)):
        if isinstance(times, list):
            table['time' if 'time' not in table else f'{names[numbers[0]]} time'] = times
        for at in numbers:
            table[with_unit(names[at], _first(listed[at], UNIT))] = _first(listed[at], VALUES)
    return _beside(content) | table


def _check_names(names: Sequence[str]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise Unreadable(
                f'{count} of its signals are called {short(repr(name))}: give each a name of its '
                'own'
            )


def _beside(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers that stand beside signals, of which one may be their period."""
    return {key: one for key, one in content.items() if isinstance(one, int | float | str)}


def _labelled(content: Content) -> Content:
    """Return what pandas writes by columns or by its index: {name: {label: value}} or reversed."""
    if not isinstance(content, dict) or len(content) < 2:
        return None
    parts = list(content.values())
    if not _are(dict, parts) or any(part.keys() != parts[0].keys() for part in parts):
        return None
    by_columns = all(map(_is_number, parts[0])) and len(parts[0]) > 1
    if not by_columns and not all(map(_is_number, content)):
        return None
    table = (
        {name: list(part.values()) for name, part in content.items()}
        if by_columns
        else {name: [part[name] for part in parts] for name in parts[0]}
    )
    labels = list(parts[0] if by_columns else content)
    plain = labels == list(map(str, range(len(labels))))
    return table if plain else {INDEX: [float(label) for label in labels]} | table


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _nested_records(content: Content) -> Content:
    """Return records whose cells are records as flat ones: x.position, or a value and its unit."""
    if not _are(dict, content) or not any(isinstance(one, dict) for one in content[0].values()):
        return None
    records = [dict(_flat(record)) for record in content]
    units: dict[str, str] = {}
    for name in dict.fromkeys(name for record in records for name in record):
        bare = BRACKETS.sub('', name).strip()
        if units.setdefault(bare, name) != name:
            raise Unreadable(f'its records state {units[bare]} and {name}: give both in one unit')
    return records


def _flat(record: Mapping[str, Any], before: str = '') -> list[tuple[str, Any]]:
    cells = []
    for key, value in record.items():
        name = f'{before}{key}'
        if isinstance(value, dict) and 'value' in value:
            cells.append((with_unit(name, _first(value, UNIT)), value['value']))
        elif isinstance(value, dict):
            cells += _flat(value, f'{name}.')
        else:
            cells.append((name, value))
    return cells


def _within(content: Content) -> Content:
    """Return the only part that is a table in any layout, with the numbers beside it."""
    if not isinstance(content, dict) or any(isinstance(one, list) for one in content.values()):
        return None
    parts = [one for one in content.values() if isinstance(one, dict) and _holds_lists(one)]
    if len(parts) != 1:
        return None
    table = _plain_table(parts[0])
    return _beside(content) | table if isinstance(table, dict) else table


def _holds_lists(content: Content) -> bool:
    return isinstance(content, dict) and any(
        isinstance(one, list) or _holds_lists(one) for one in content.values()
    )


LAYOUTS: tuple[Callable[[Content], Content], ...] = (
    _named_rows,
    _header_row,
    _channels,
    _labelled,
    _nested_records,
    _within,
)
"""Readers of a layout each, which return None for another one."""
