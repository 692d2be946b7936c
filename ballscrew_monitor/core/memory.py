# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Memory of an axis over restarts: sums, last event and shelving; also as a plain record."""

import collections
import dataclasses
import math
import operator
from typing import Any

from ballscrew_monitor.core.judgement import Code, Finding, Severity
from ballscrew_monitor.core.state import Event, NOT_SHELVED, Shelving, TIMES, Totals

RESTARTED = 'ended by a restart of the node'
MOST_EVENTS = 2**32 - 1  # what a message holds
NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Memory:
    """What outlives the monitor of an axis; an active event carries the last stamp seen of it."""

    totals: Totals = Totals()
    event: Event = Event()
    shelving: Shelving = NOT_SHELVED


def after_restart(memory: Memory) -> Memory:
    """Return the memory to go on with: an event that was interrupted is over."""
    if not memory.event.active:
        return memory
    event = dataclasses.replace(memory.event, active=False, ending=RESTARTED)
    return dataclasses.replace(memory, event=event)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisRecord:
    """
    Memory of an axis in plain numbers and words: a row of the database.

    The suffixes are the units; times in [ns] so that none is rounded. `worst_value`, `value` and
    `limit` stand in `unit`, NaN is not known.

    """

    axis: str
    running_time_ns: int = 0
    unjudged_time_ns: int = 0
    boundary_time_ns: int = 0
    mixed_time_ns: int = 0
    hydrodynamic_time_ns: int = 0
    optimal_time_ns: int = 0
    outside_time_ns: int = 0
    since_ns: int = 0
    angle_rad: float = 0.0
    energy_lost_J: float = 0.0
    event: int = 0
    active: bool = False
    stamp_ns: int = 0
    start_ns: int = 0
    worst_value: float = NAN
    cause: str = Code.UNKNOWN.name
    severity: str = Severity.UNKNOWN.name
    value: float = NAN
    limit: float = NAN
    unit: str = '-'
    text: str = ''
    ending: str = ''
    until_ns: int = 0
    reason: str = ''


TYPES: dict[str, Any] = {field.name: field.type for field in dataclasses.fields(AxisRecord)}
SUMS = {'angle_rad': 'totals.angle', 'energy_lost_J': 'totals.energy_lost'}
PLACES = {
    **{f'{name}_ns': f'totals.{name}' for name in (*TIMES, 'since')},
    **SUMS,
    'event': 'event.number',
    **{name: f'event.{name}' for name in ('active', 'worst_value', 'ending')},
    **{f'{name}_ns': f'event.{name}' for name in ('stamp', 'start')},
    **{name: f'event.cause.{name}' for name in ('value', 'limit', 'unit', 'text')},
    'until_ns': 'shelving.until',
    'reason': 'shelving.reason',
}
"""Values of a record, and where a memory holds them as they are."""


def check_record(record: AxisRecord) -> None:
    """Raise ValueError or KeyError for a record that no node has written."""
    for name, kind in TYPES.items():
        value = getattr(record, name)
        if (kind is int or name in SUMS) and value < 0:
            raise ValueError(f'{name} is {value!r}')
    if record.event > MOST_EVENTS:
        raise ValueError(f'event {record.event} is above {MOST_EVENTS}')
    Code[record.cause], Severity[record.severity]


def record_of(axis: str, memory: Memory) -> AxisRecord:
    """Return the memory of an axis as a record."""
    cause = memory.event.cause
    return AxisRecord(
        axis=axis,
        cause=cause.code.name,
        severity=cause.severity.name,
        **{
            name: TYPES[name](operator.attrgetter(place)(memory)) for name, place in PLACES.items()
        },
    )


def memory_of(record: AxisRecord) -> Memory:
    """Return the memory of a record."""
    parts: dict[str, dict[str, Any]] = collections.defaultdict(dict)
    for name, place in PLACES.items():
        part, _, field = place.rpartition('.')
        parts[part][field] = getattr(record, name)
    code, severity = Code[record.cause], Severity[record.severity]
    cause = Finding(code=code, severity=severity, **parts['event.cause'])
    return Memory(
        totals=Totals(**parts['totals']),
        event=Event(cause=cause, **parts['event']),
        shelving=Shelving(**parts['shelving']),
    )
