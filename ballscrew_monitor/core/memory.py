# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record of an axis over restarts: sums, last event and shelving."""

import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.judgement import Code, EventEnd

MOST_EVENTS = 2**32 - 1  # what a message holds
NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisRecord:
    """
    What outlives the monitor of an axis, a row of the database.

    The suffixes are the units; times in [ns] so that none is rounded. An active event carries the
    last stamp seen of it; NaN is not known. `left_ns` of a shelving is left.

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
    cause: str = Code.UNKNOWN.name
    worst_value: float = NAN
    limit: float = NAN
    derived: bool = False
    ending: str = EventEnd.UNKNOWN.name
    ended_by: str = ''
    end_reason: str = ''
    left_ns: int = 0
    reason: str = ''


TYPES: dict[str, Any] = {field.name: field.type for field in dataclasses.fields(AxisRecord)}
SUMS = 'angle_rad', 'energy_lost_J'


def after_restart(record: AxisRecord) -> AxisRecord:
    """Return the record to go on with: an event that was interrupted is over."""
    if not record.active:
        return record
    return dataclasses.replace(record, active=False, ending=EventEnd.RESTARTED.name)


def check_record(record: AxisRecord) -> None:
    """Raise ValueError or KeyError for a record that no node has written."""
    for name, kind in TYPES.items():
        value = getattr(record, name)
        if (kind is int or name in SUMS) and value < 0:
            raise ValueError(f'{name} is {value!r}')
    if record.event > MOST_EVENTS:
        raise ValueError(f'event {record.event} is above {MOST_EVENTS}')
    Code[record.cause], EventEnd[record.ending]
