# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of the former format, one or two for each axis and the event log: taken over once."""

from collections.abc import Iterator, Mapping
import contextlib
import json
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.core.memory import AxisRecord, LARGEST, read_record
from ballscrew_monitor.node.state_records import Corrections, Entry, EVENT, Kind, Record, Records
from surrogate.limits import read_json, read_text

NAMES = re.compile(r'([^.].*)\.(memory|corrections)\.json|events(\.[0-9]+)?\.jsonl')
PLACE = 'before_sqlite3'
VERSION = 1
BAD = (OSError, ValueError, KeyError, TypeError, AttributeError)


def read_former(folder: Path) -> tuple[Iterator[Entry], Records, list[str]]:
    """
    Return what the files of a folder hold, and a sentence for each that is damaged.

    The event log may know of a later event than the record of its axis: the records are complete
    when all entries have been taken.

    """
    records: Records = {}
    damage = []
    for path, axis, kind in _files(folder):
        try:
            if kind != 'events':
                record = READ[kind](axis, _content(path))
                records[type(record), axis] = record
        except BAD as error:
            damage.append(f'{path} is damaged ({error}), and not taken over')
    return _entries(folder, records), records, damage


def set_aside(folder: Path) -> list[str]:
    """Move the files away; return a sentence that says so, if there were any."""
    moved = 0
    for path, _, _ in _files(folder):
        place = folder / PLACE / path.name
        while place.exists():
            place = place.with_name(f'{place.name}~')
        place.parent.mkdir(exist_ok=True)
        path.replace(place)
        moved += 1
    said = f'the database replaces {moved} files, which are now in {folder / PLACE}'
    return [said] if moved else []


def _files(folder: Path) -> list[tuple[Path, str, str]]:
    """Return path, axis and kind of each file; the event log in its order, the newest last."""
    matches = {path: NAMES.fullmatch(path.name) for path in folder.iterdir()}
    found = [(path, match[1], match[2], match[3]) for path, match in matches.items() if match]
    found.sort(key=lambda one: int(one[3][1:]) if one[3] else 10**9)
    return [(path, axis or '', kind or 'events') for path, axis, kind, _ in found]


def _content(path: Path) -> Any:
    content = read_json(read_text(path))
    if content['version'] != VERSION:
        raise ValueError(f'version {content["version"]}, known is {VERSION}')
    return content


def _record(axis: str, content: Mapping[str, Any]) -> Record:
    parts = (content['totals'], content['event'], content['shelving'])
    return read_record({'axis': axis} | {name: part[name] for part in parts for name in part})


def _corrections(axis: str, content: Mapping[str, Any]) -> Record:
    solves = json.dumps(content['corrections'])
    return Corrections.read({'axis': axis, 'surface': content['surface'], 'solves': solves})


READ = {'memory': _record, 'corrections': _corrections}


def _entries(folder: Path, records: Records) -> Iterator[Entry]:
    """Yield the entries of the log but for torn lines, and bring the `records` up to date."""
    for path, _, kind in _files(folder):
        for line in path.read_bytes().splitlines() if kind == 'events' else ():
            with contextlib.suppress(*BAD):
                facts = read_json(line)
                time, stamp, axis, what = (facts.pop(name) for name in Entry._fields[:-1])
                if type(stamp) is int and 0 <= stamp <= LARGEST:
                    entry = Entry(
                        str(time), stamp, axis and str(axis), Kind(what), json.dumps(facts)
                    )
                    yield entry
                    _follow(records, entry, facts)


def _follow(records: Records, entry: Entry, facts: Mapping[str, Any]) -> None:
    if entry.axis is None or entry.kind not in (Kind.EVENT_BEGIN, Kind.EVENT_END):
        return
    key = (AxisRecord, entry.axis)
    row = records.get(key, AxisRecord(axis=entry.axis)).row()
    active = entry.kind == Kind.EVENT_BEGIN
    if facts['event'] > row['event'] or (facts['event'] == row['event'] and not active):
        event = {name: facts[name] for name in EVENT} | {'stamp_ns': entry.stamp_ns}
        records[key] = read_record(row | event | {'active': active})
