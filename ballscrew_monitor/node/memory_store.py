# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What an axis remembers over a restart, on the disk: a file for each axis."""

from collections.abc import Mapping
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.judgement import Code, Finding, Severity
from ballscrew_monitor.core.memory import Memory, NOTHING
from ballscrew_monitor.core.shelving import Shelving
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.node.state_folder import StateFolder

TIMES = tuple(field.name for field in dataclasses.fields(Totals) if field.type is int)
MOST_EVENTS = 2**32 - 1  # what a message holds


class MemoryStore:
    """The memories kept for the axes of one node."""

    def __init__(self, folder: StateFolder) -> None:
        """Keep them in a `folder`."""
        self._folder = folder

    def load(self, axis: str) -> Memory:
        """
        Return what was kept of an axis.

        Raises InputError for a file that is none; it is moved aside and nothing is lost.

        """
        return self._folder.read(_name(axis), read_memory) or NOTHING

    def save(self, axis: str, memory: Memory) -> str:
        """Keep what is remembered of an axis; return why that failed, or nothing."""
        return self._folder.write(_name(axis), memory_record(memory))


def _name(axis: str) -> str:
    return f'{axis}.memory.json'


def memory_record(memory: Memory) -> dict[str, Any]:
    """Return a memory as JSON has it: times in [ns], so that none is rounded."""
    totals, event = memory.totals, memory.event
    return {
        'totals': {f'{name}_ns': getattr(totals, name) for name in TIMES}
        | {'angle_rad': totals.angle, 'energy_lost_J': totals.energy_lost},
        'event': event_record(event) | {'active': event.active, 'ending': event.ending},
        'shelving': {'until_ns': memory.shelving.until, 'reason': memory.shelving.reason},
    }


def event_record(event: Event) -> dict[str, Any]:
    """Return an event as JSON has it, without whether it is over."""
    cause = event.cause
    return {
        'event': event.number,
        'stamp_ns': event.stamp,
        'start_ns': event.start,
        'worst_value': event.worst_value,
        'cause': cause.code.name,
        'severity': cause.severity.name,
        'value': cause.value,
        'limit': cause.limit,
        'unit': cause.unit,
        'text': cause.text,
    }


def read_memory(record: Mapping[str, Any]) -> Memory:
    """Return the memory of a record; raises ValueError, KeyError or TypeError if it is none."""
    totals, shelving = record['totals'], record['shelving']
    return Memory(
        totals=Totals(
            **{name: _count(totals[f'{name}_ns']) for name in TIMES},
            angle=_amount(totals['angle_rad']),
            energy_lost=_amount(totals['energy_lost_J']),
        ),
        event=dataclasses.replace(
            read_event(record['event']),
            active=bool(record['event']['active']),
            ending=str(record['event']['ending']),
        ),
        shelving=Shelving(until=_count(shelving['until_ns']), reason=str(shelving['reason'])),
    )


def read_event(record: Mapping[str, Any]) -> Event:
    """Return the event of a record, as one that is over; raises as `read_memory` does."""
    number = _count(record['event'])
    if number > MOST_EVENTS:
        raise ValueError(f'event {number} is above {MOST_EVENTS}')
    return Event(
        number=number,
        stamp=_count(record['stamp_ns']),
        start=_count(record['start_ns']),
        worst_value=_number(record['worst_value']),
        cause=Finding(
            code=Code[record['cause']],
            severity=Severity[record['severity']],
            value=_number(record['value']),
            limit=_number(record['limit']),
            unit=str(record['unit']),
            text=str(record['text']),
        ),
    )


def _count(value: Any) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f'{value!r} is no count')
    return value


def _amount(value: Any) -> float:
    number = _number(value)
    if not 0.0 <= number < math.inf:
        raise ValueError(f'{value!r} is no amount')
    return number


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)
