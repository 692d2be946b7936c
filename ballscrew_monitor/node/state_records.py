# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of what outlives the node: entries of the event log, axes, corrections."""

from collections.abc import Iterable, Mapping
import dataclasses
import datetime
import enum
import json
from typing import Any

from ballscrew_monitor.core.conversions import celsius, seconds
from ballscrew_monitor.core.fault_codes import cause_code
from ballscrew_monitor.core.judgement import Code, Severity
from ballscrew_monitor.core.state import Ending
from ballscrew_monitor.judge.full_point import KeptSolve, Solve
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.judge.views import total_times
from ballscrew_monitor.judge.zone import ACTIVE
from ballscrew_monitor.messages.state_messages import event_cause
from surrogate.files import InputError, to_json
from surrogate.files.limits import read_json
from surrogate.files.store import Table
from surrogate.units import TURN

SOLVE = {
    'speed': 'speed_rad_s',
    'opposing_load': 'opposing_load_N',
    'temperature': 'temperature_K',
    'solved': 'solved',
}
"""Names of a solve, and with their units as they are kept."""


UNREADABLE = 'the facts of this entry are damaged and cannot be read'


class Kind(enum.StrEnum):
    """Subject of an entry of the event log."""

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
    SET_BASELINE = 'set_baseline'
    CLOCK_STEP = 'clock_step'


@dataclasses.dataclass(frozen=True, slots=True)
class Entry:
    """
    An entry of the event log, a row of its table.

    `time` of the machine in UTC, `stamp_ns` [ns] of the clock of the node, `facts` in strict JSON.

    """

    time: str
    stamp_ns: int
    axis: str | None
    kind: str
    facts: str

    def record(self) -> dict[str, Any]:
        """Return the entry as one record; of a damaged one what is left, and that it is."""
        record = dataclasses.asdict(self)
        try:
            return record | dict(read_json(str(record.pop('facts'))))
        except (InputError, TypeError, ValueError):
            return record | {'text': UNREADABLE}


@dataclasses.dataclass(frozen=True, slots=True)
class Corrections:
    """Full solves that correct the surface of an axis, by its hash: a row of their table."""

    axis: str
    surface: str = ''
    solves: str = '[]'

    @classmethod
    def of(cls, axis: str, surface: str, solves: Iterable[Solve]) -> 'Corrections':
        """Return the solves that correct the `surface` of a hash, as they are kept."""
        rows = [{key: getattr(solve, name) for name, key in SOLVE.items()} for solve in solves]
        return cls(axis, surface, json.dumps(rows))

    def read_solves(self) -> list[KeptSolve]:
        """Return the solves; ValueError, KeyError or TypeError for what no node has written."""
        return [
            KeptSolve(
                **{name: float(solve[key]) for name, key in SOLVE.items() if name != 'solved'},
                solved={name: float(value) for name, value in solve['solved'].items()},
            )
            for solve in read_json(self.solves)
        ]


AXES = Table(name='axes', kind=AxisRecord, key='axis', check=AxisRecord.check)
CORRECTIONS = Table(
    name='corrections', kind=Corrections, key='axis', check=Corrections.read_solves
)
EVENTS = Table(name='events', kind=Entry, key='number', beside={'number': int})
Record = AxisRecord | Corrections
TABLES: dict[type, Table] = {AxisRecord: AXES, Corrections: CORRECTIONS, Entry: EVENTS}
Records = dict[tuple[type, str], Any]
"""Records by what they are and their axis."""


def entry_of(kind: Kind, axis: str | None, stamp: int, facts: Mapping[str, Any]) -> Entry:
    """Return an entry of now; `stamp` [ns]."""
    time = datetime.datetime.now(datetime.UTC).isoformat(timespec='milliseconds')
    return Entry(time, stamp, axis, kind.value, json.dumps(to_json(facts), allow_nan=False))


def by_key(records: Iterable[Record]) -> Records:
    """Return records by what they are and their axis."""
    return {(type(record), record.axis): record for record in records}


def event_facts(memory: Any, ending: Ending, advice: str = '') -> dict[str, Any]:
    """Return what an entry says of the last event of a memory, its ending and the advice on it."""
    code, cause = Code(int(memory.event_code[ACTIVE])), event_cause(memory)
    start = int(memory.event_start[ACTIVE])
    stamp = int(memory.stamp if memory.event_active else memory.event_stamp)
    return {
        'event': int(memory.event_number),
        'start_ns': start,
        'worst_value': cause.value,
        'cause': code.name,
        'severity': Severity(cause.severity).name,
        'value': cause.value,
        'limit': cause.limit,
        'unit': cause.unit,
        'text': cause.text,
        'ending': ending.text,
        'code': int(cause_code(code)),
        'duration_s': seconds(stamp - start),
        'advice': advice,
    }


def step_text(step: int) -> str:
    """Return how far a clock was set, a step [ns]."""
    return f'{"forward" if step > 0 else "back"} by {abs(seconds(step)):.6g} s'


def point_facts(row: Row) -> dict[str, float]:
    """Return where the axis of a row was, in the machine frame."""
    return {
        'speed_rad_s': row.speed,
        'axial_load_N': row.axial_load,
        'temperature_degC': celsius(row.temperature),
    }


def totals_facts(memory: Any) -> dict[str, float]:
    """Return sums as an entry says them: times in [s]."""
    return {f'{name}_s': seconds(time) for name, time in total_times(memory).items()} | {
        'revolutions': memory.angle / TURN,
        'energy_lost_J': memory.energy_lost,
        'since_ns': memory.since,
    }
