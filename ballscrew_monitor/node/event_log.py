# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The event log: what happened to the axes and was done to them, a line of JSON each.

Lines are only ever appended, and are on the disk when `append` returns. A full file becomes
`events.<number>.jsonl`, and the oldest of these go when the directory is at its limit. A line that
a kill has torn is skipped, and the next one begins anew.

"""

from collections.abc import Iterable, Iterator
import contextlib
import dataclasses
import enum
import json
import os
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import celsius, seconds
from ballscrew_monitor.core.estimate import MachinePoint
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.node.memory_store import event_record, read_event, TIMES
from ballscrew_monitor.node.state_folder import old_logs, StateFolder
from surrogate.files import to_json

NAME = 'events.jsonl'
PARTS = 8  # the log is rotated at this part of the limit
TAIL = 1_000_000  # [B] of the log in which the last events are looked for


class Kind(enum.StrEnum):
    """What a line tells of."""

    NODE_START = 'node_start'
    NODE_STOP = 'node_stop'
    EVENT_BEGIN = 'event_begin'
    EVENT_END = 'event_end'
    ACKNOWLEDGE = 'acknowledge'
    RESET_TOTALS = 'reset_totals'
    RELOAD_SURFACE = 'reload_surface'
    SHELVE = 'shelve'
    UNSHELVE = 'unshelve'
    CORRECTION = 'correction'


class EventLog:
    """The log of one node."""

    def __init__(self, folder: StateFolder) -> None:
        """Keep it in a `folder`."""
        self._folder = folder

    def append(self, lines: Iterable[str]) -> str:
        """Append whole lines and wait for the disk; return why that failed, or nothing."""
        path = self._folder.file(NAME)
        if path is None:
            return self._folder.reason
        text = ''.join(f'{line}\n' for line in lines).encode()
        try:
            self._rotate(path, len(text))
            _append(path, text)
        except OSError as error:
            return self._folder.unwritable(error)
        return ''

    def last_events(self) -> dict[str, Event]:
        """Return the last event of each axis, active if the log does not know its end."""
        found: dict[str, Event] = {}
        for line in self._tail():
            # Others than the kinds of an event, and torn lines.
            with contextlib.suppress(ValueError, KeyError, TypeError):
                record = json.loads(line)
                kind = Kind(record['kind'])
                if kind in (Kind.EVENT_BEGIN, Kind.EVENT_END):
                    active = kind is Kind.EVENT_BEGIN
                    event = dataclasses.replace(read_event(record), active=active)
                    found[str(record['axis'])] = event
        return found

    def _tail(self) -> Iterator[bytes]:
        path = self._folder.file(NAME)
        if path is None:
            return
        for one in (*list(old_logs(path.parent).values())[-1:], path):
            with contextlib.suppress(OSError), one.open('rb') as file:
                file.seek(max(0, one.stat().st_size - TAIL))
                yield from file.read().splitlines()

    def _rotate(self, path: Path, size: int) -> None:
        """Begin a new file if `size` [B] more are too many; the oldest go."""
        part = self._folder.limit // PARTS
        if not path.exists() or path.stat().st_size + size <= part:
            return
        number = max(old_logs(path.parent), default=0) + 1
        path.replace(path.with_name(f'events.{number:06d}.jsonl'))
        self._folder.make_room(part)


def _append(path: Path, text: bytes) -> None:
    """Append all of `text`, on a new line, or nothing."""
    with path.open('ab+', buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        if size:
            file.seek(size - 1)
            text = text if file.read(1) == b'\n' else b'\n' + text
        try:
            while text:
                written = file.write(text)
                text = text[written:]
            os.fsync(file.fileno())
        except OSError:
            with contextlib.suppress(OSError):
                file.truncate(size)
            raise


def line_of(kind: Kind, *, time: str, stamp: int, axis: str | None, **facts: Any) -> str:
    """Return a line: `time` of the machine in UTC, `stamp` [ns] of the clock of the node."""
    record = {'time': time, 'stamp_ns': stamp, 'axis': axis, 'kind': kind.value, **facts}
    return json.dumps(to_json(record), allow_nan=False)


def event_facts(event: Event) -> dict[str, Any]:
    """Return what a line says of an event, besides its stamp."""
    record = event_record(event)
    del record['stamp_ns']
    return record | {
        'duration_s': seconds(event.stamp - event.start),
        'advice': event.advice.text,
        'ending': event.ending,
    }


def point_facts(point: MachinePoint) -> dict[str, float]:
    """Return where an axis was, in the machine frame."""
    return {
        'speed_rad_s': point.speed,
        'axial_load_N': point.axial_load,
        'temperature_degC': celsius(point.temperature),
    }


def totals_facts(totals: Totals) -> dict[str, float]:
    """Return sums as a line says them: times in [s]."""
    return {f'{name}_s': seconds(getattr(totals, name)) for name in TIMES if name != 'since'} | {
        'revolutions': totals.revolutions,
        'energy_lost_J': totals.energy_lost,
        'since_ns': totals.since,
    }
