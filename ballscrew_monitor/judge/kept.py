# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Part of a memory that outlives the node, as a row of its database."""

from collections.abc import Iterable
import dataclasses
import json
import math
from typing import Any

from ballscrew_monitor.core.judgement import Code, EventEnd
from ballscrew_monitor.core.state import Ending, NOT_SHELVED, RESTARTED, Shelving
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.judge.zone import ACTIVE
from surrogate.files import to_json
from surrogate.files.limits import read_json

MOST_EVENTS = 2**32 - 1  # what a message holds
SUMS = 'running_time', 'unjudged_time', 'regime_time', 'zone_time', 'angle', 'energy_lost'
"""Fields of a memory that are added up."""
EXCURSION = 'event_start', 'event_code', 'event_worst', 'event_limit', 'event_derived'
"""Fields of which the excursion is kept that is active or was the last."""
KEPT = (*SUMS, 'since', 'event_active', 'event_stamp', *EXCURSION)


@dataclasses.dataclass(frozen=True, slots=True)
class AxisRecord:
    """
    An axis as it outlives its monitor, a row of the database.

    `event` is the number of its last event; `memory` holds the fields KEPT of a `Memory` in JSON,
    times in [ns], an active event with the last stamp seen of it; then how that event ended, how
    long [ns] and why the warning is still shelved, and the numbers of usual events in JSON.

    """

    axis: str
    event: int = 0
    memory: str = '{}'
    ending: str = EventEnd.UNKNOWN.name
    ended_by: str = ''
    end_reason: str = ''
    left_ns: int = 0
    reason: str = ''
    usual: str = '[]'

    @classmethod
    def of(
        cls,
        axis: str,
        memory: Any,
        ending: Ending,
        shelving: Shelving,
        now: int,
        usual: Iterable[int] = (),
    ) -> 'AxisRecord':
        """
        Return what is kept of a memory at `now` [ns] of the clock of the node.

        `ending` is of its event and `shelving` of its warning; `usual` are numbers of events.

        """
        kept: dict[str, Any] = {name: getattr(memory, name) for name in KEPT}
        kept |= {name: kept[name][ACTIVE] for name in EXCURSION}
        if memory.event_active:
            kept['event_stamp'] = memory.stamp
        return cls(
            axis=axis,
            event=int(memory.event_number),
            memory=json.dumps(to_json(kept), allow_nan=False),
            ending=ending.kind.name,
            ended_by=ending.name,
            end_reason=ending.reason,
            left_ns=shelving.left(now),
            reason=shelving.reason,
            usual=json.dumps(list(usual)),
        )

    def read_memory(self) -> Memory:
        """
        Return a memory that holds what is kept, and nothing else.

        Raises ValueError, KeyError or TypeError for what no node has written.

        """
        if not 0 <= self.event <= MOST_EVENTS:
            raise ValueError(f'event is {self.event}, allowed is 0 to {MOST_EVENTS}')
        memory = Memory(event_number=self.event)
        for name, value in dict(read_json(self.memory)).items():
            if name not in KEPT:
                raise KeyError(name)
            if name in EXCURSION:
                numbers = getattr(memory, name)
                numbers[ACTIVE] = _checked(name, value, numbers[ACTIVE])
            else:
                setattr(memory, name, _checked(name, value, getattr(memory, name)))
        Code(memory.event_code[ACTIVE])
        return memory

    def read_ending(self) -> Ending:
        """Return how its event ended; raises KeyError for what no node has written."""
        return Ending(EventEnd[self.ending], self.ended_by, self.end_reason)

    def read_usual(self) -> list[int]:
        """Return the numbers of usual events; raises ValueError for what no node has written."""
        numbers = read_json(self.usual)
        if not isinstance(numbers, list) or any(type(number) is not int for number in numbers):
            raise ValueError(f'usual is {self.usual}')
        return numbers

    def check(self) -> None:
        """Raise ValueError, KeyError or TypeError for a record that no node has written."""
        self.read_memory(), self.read_ending(), self.read_usual()
        if self.left_ns < 0:
            raise ValueError(f'left_ns is {self.left_ns}')


def _checked(name: str, value: Any, usual: Any) -> Any:
    """Return a value of the type of a `usual` one; raises ValueError or TypeError for others."""
    if isinstance(usual, list):
        return [_checked(name, part, first) for part, first in zip(value, usual, strict=True)]
    if value is None and isinstance(usual, float) and name not in SUMS:
        return math.nan
    if type(value) is not type(usual) or (value < 0 and (name in SUMS or type(value) is int)):
        raise ValueError(f'{name} is {value!r}')
    return value


def after_restart(record: AxisRecord) -> AxisRecord:
    """Return the record to go on with: an event that was interrupted is over."""
    memory = record.read_memory()
    if not memory.event_active:
        return record
    memory.event_active = False
    over = AxisRecord.of(record.axis, memory, RESTARTED, NOT_SHELVED, 0)
    kept = {name: getattr(record, name) for name in ('left_ns', 'reason', 'usual')}
    return dataclasses.replace(over, **kept)
