# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signals of JSON, of traces in XML and of the data recorder of a SINUMERIK."""

from collections import Counter
from collections.abc import Mapping, Sequence
import math
from pathlib import Path
import re
from typing import Any
from xml.etree import ElementTree

from ballscrew_monitor.recordings.tables import json_layouts
from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.heads import unlike, with_unit
from ballscrew_monitor.recordings.tables.layouts import RECORDER
from ballscrew_monitor.recordings.tables.quantities import RATED
from ballscrew_monitor.recordings.tables.signals import (
    columns_of_records,
    side_by_side,
    Signals,
    signals_of,
    stated_factors,
)
from surrogate.files import limits

OF_RECORDER = {'LOAD': RATED, 'TORQUE': 'N m', 'CURRENT': 'A'}
"""Units of signals of a data recorder, which its file does not state."""
OF_LISTS = 'its cells are lists'
DOCUMENT = re.compile('<!(?:DOCTYPE|ENTITY)', re.I)
CYCLE = 'CycleTimeMs'


def read_json(path: Path) -> Signals:
    """Return the signals of JSON in any of the layouts that are known."""
    content = json_layouts.parsed(path.read_bytes())
    if limits.is_deeper(content, limits.DEPTH):
        raise Unreadable(f'it nests deeper than {limits.DEPTH}')
    header = content.get('Header') if isinstance(content, dict) else None
    if isinstance(header, dict) and 'SignalListHFData' in header:
        return _sinumerik_json(content)
    left_out, factors, more_rows = {}, '', 0
    content = json_layouts.plain_table(content)
    if isinstance(content, dict):
        lists = {key: value for key, value in content.items() if isinstance(value, list)}
        records = [key for key, one in lists.items() if one and isinstance(one[0], dict)]
        if not records:
            nested = {name for name, cells in lists.items() if any(map(_is_nested, cells))}
            lists = {name: cells for name, cells in lists.items() if name not in nested}
            left_out = dict.fromkeys(sorted(nested), OF_LISTS)
            periods = json_layouts.stated_periods(content)
            return signals_of(lists, content, periods, left_out=left_out)
        chosen = max(records, key=lambda name: json_layouts.motion_of(lists[name]))
        factors = ', '.join(stated_factors(content))
        content = json_layouts.plain_table(lists[chosen])
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
    header, parts = content['Header'], _list_of(dict, content.get('Payload'))
    listed = _list_of(dict, header['SignalListHFData'])
    if listed is None or not all('Name' in signal for signal in listed):
        raise Unreadable('SignalListHFData of its Header must be a list of signals with a Name')
    if parts is None or not _are_all(list, [p.get('HFData', []) for p in parts]):
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
    begin, cycle = header.get('Initial'), header.get(CYCLE) or math.nan
    if not isinstance(cycle, int | float):
        raise Unreadable('CycleTimeMs of its Header is no number')
    start = str(begin.get('Time', '')) if isinstance(begin, dict) else ''
    periods = {CYCLE: cycle * 1e-3} if cycle > 0.0 else {}
    return signals_of(held, header, periods, start=start, program=RECORDER)


def _list_of(kind: type, values: Any) -> Any:
    """Return values if they are a list of a kind, else None."""
    return values if _are_all(kind, values) else None


def _are_all(kind: type, values: object) -> bool:
    return isinstance(values, list) and all(isinstance(one, kind) for one in values)


def read_xml(path: Path) -> Signals:
    """Return the signals of a trace: names by their keys, and a record for each time."""
    text = path.read_text('utf-8', errors='replace')
    if DOCUMENT.search(text):
        raise Unreadable('it states a type of document')
    root = ElementTree.fromstring(text)
    named, keys, rows, start = {}, {}, [], ''
    for element in root.iter():
        tag, held = element.tag.rpartition('}')[2], element.attrib
        if tag == 'signal' and 'key' in held:
            parts = (held.get(one, '') for one in ('axis', 'axisName', 'name', 'description'))
            unit = held.get('units') or held.get('unit') or ''
            name = ' '.join(dict.fromkeys(part for part in parts if part))
            named[held['key']] = with_unit(name, unit)
        elif tag == 'dataSignal' and 'id' in held:
            keys[held['id']] = held.get('name') or named.get(held.get('key', ''), held['id'])
        elif tag == 'frameHeader':
            start = start or held.get('startTime', '')
        elif tag == 'rec':
            rows.append(dict(held))
    if not rows:
        raise TypeError
    counts = Counter(keys.values())
    names = {key: name if counts[name] == 1 else f'{name} {key}' for key, name in keys.items()}
    frame = side_by_side(columns_of_records(rows)).rename(names, strict=False)
    return Signals(frame=frame, start=start)
