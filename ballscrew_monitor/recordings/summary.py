# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Summary of a run or a replay: totals, events, and the words for them."""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.advice import speed_advice
from ballscrew_monitor.core.conversions import rounded, SECOND, seconds
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.core.inputs import InputStatus, Source, Why
from ballscrew_monitor.core.judgement import EventEnd, Limits
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.views import TIMES
from ballscrew_monitor.judge.zone import ACTIVE
from ballscrew_monitor.recordings.declared import plain, unwritten, written
from ballscrew_monitor.recordings.words import counted, number, share
from ballscrew_msgs.msg import BallScrewState, Finding, OutOfZone, Totals
from surrogate.surface import REGIMES
from surrogate.units import RPM

RELATIONS = {
    Finding.CODE_RCS_HIGH: ('RCS', '>='),
    Finding.CODE_EFFICIENCY_LOW: ('efficiency', '<'),
}
OTHER = 'other', 'beyond'
SHOWN = 'event_id start_s duration_s active cause worst_value limit advice'.split()
"""What the totals say of an event, by its keys."""
SUMS = *TIMES, 'revolutions', 'energy_lost'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class EventRecord:
    """
    One stay outside the optimal zone; start [ns], duration [s], worst value and limit [-].

    `speed` [rad/s] and `axial_load` [N] are those of the worst value, NaN where only the message
    of the warning is known; `target_speed` is that of the advice, NaN if there is none. It was on
    when its run ended if `run_ended`.

    """

    event_id: int
    start: int = written('ns', key='start_stamp')
    duration: float = written('s')
    active: bool
    quantity: str
    relation: str
    limit: float
    worst_value: float
    speed: float = written('rad_s', default=math.nan, compare=False)
    axial_load: float = written('N', default=math.nan, compare=False)
    target_speed: float = written('rad_s', default=math.nan, compare=False)
    advice: str
    run_ended: bool = unwritten(default=False)

    @property
    def place(self) -> str:
        """Return in words where the worst value was, empty where that is not known."""
        if not math.isfinite(self.speed + self.axial_load):
            return ''
        return f'{rounded(self.speed / RPM)} rev/min and {rounded(self.axial_load)} N'

    @property
    def end(self) -> int:
        """Return when it ended, or how far it is known [ns]."""
        return self.start + round(self.duration * SECOND)

    def shown(self, value: float) -> str:
        """Return a worst value or a limit as people read it: an efficiency in percent."""
        if math.isnan(value):
            return '–'
        return f'{value:.3g}' if self.quantity == 'RCS' else f'{round(100.0 * value, 1):g} %'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class RunRecord:
    """
    What one of several runs of a recording comes to for an axis; each is judged apart.

    First and last stamp of its rows [ns], 0 without any; judged speed samples and warnings [-];
    times [s].

    """

    number: int
    first: int = written('ns', key='first_stamp')
    last: int = written('ns', key='last_stamp')
    running_time: float = written('s')
    unjudged_time: float = written('s')
    optimal_time: float = written('s')
    outside_time: float = written('s')
    revolutions: float
    judged: int = 0
    warnings: int = 0

    @property
    def duration(self) -> float:
        """Return the time from its first to its last row [s]."""
        return seconds(self.last - self.first)

    @property
    def words(self) -> str:
        """Return the run in words, without its number and times."""
        if not self.first:
            return 'no usable sample'
        parts = (
            f'{name} {getattr(self, f"{name}_time"):.1f} s'
            for name in ('optimal', 'outside', 'unjudged')
        )
        return (
            f'in motion {self.running_time:.1f} s of {self.duration:.1f} s, '
            f'{self.revolutions:.0f} revolutions; {", ".join(parts)}; '
            f'{counted(self.warnings, "warning")}'
        )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Summary:
    """
    Totals of one axis.

    Stamps of the first and last state [ns]; number of states and of judged speed samples [-];
    times [s]; energy [J]; events in order; the runs of a recording that holds several.

    """

    axis: str
    first: int = written('ns', key='first_stamp')
    last: int = written('ns', key='last_stamp')
    states: int
    judged: int
    running_time: float = written('s')
    unjudged_time: float = written('s')
    boundary_time: float = written('s')
    mixed_time: float = written('s')
    hydrodynamic_time: float = written('s')
    optimal_time: float = written('s')
    outside_time: float = written('s')
    revolutions: float
    energy_lost: float = written('J')
    events: tuple[EventRecord, ...]
    runs: tuple[RunRecord, ...] = unwritten(default=())

    @property
    def recorded(self) -> float:
        """Return the time that was recorded [s], without the pauses between runs."""
        if not self.runs:
            return self.since_first(self.last)
        return math.fsum(run.duration for run in self.runs)

    @property
    def says_nothing(self) -> bool:
        """Return True if no motion was judged; at standstill there is nothing to judge."""
        return not self.judged or not self.optimal_time + self.outside_time

    def record(self) -> dict[str, Any]:
        """Return plain data for JSON; times of events are relative [s]."""
        runs = {'runs': plain(self.runs)} if self.runs else {}
        return (
            plain(self) | {'events': [self._event_record(event) for event in self.events]} | runs
        )

    def _event_record(self, event: EventRecord) -> dict[str, Any]:
        own = plain(event) | {
            'start_s': self.since_first(event.start),
            'cause': f'{event.quantity} {event.relation} limit',
        }
        return {key: own[key] for key in SHOWN}

    def since_first(self, stamp: int) -> float:
        """Return a stamp [ns] as time since the first state [s]."""
        return (stamp - self.first) / SECOND

    def span(self, event: EventRecord) -> tuple[float, float]:
        """Return begin and end [s] since the first state; one that is on lasts to the last."""
        end = max(self.last, event.end) if event.active else event.end
        return self.since_first(event.start), self.since_first(end)

    def lines(self) -> list[str]:
        """Return the summary in words."""
        lines = [
            f'in motion   {self.running_time:.1f} s of {self.recorded:.1f} s, '
            f'{self.revolutions:.0f} revolutions, '
            f'{number(self.energy_lost, 4)} J lost to friction',
            'regime      ' + self._shares(*(regime.word for regime in REGIMES)),
            'zone        ' + self._shares('optimal', 'outside', 'unjudged'),
        ]
        if self.runs:
            lines.append(f'runs        {len(self.runs)}, each judged apart')
        for run in self.runs:
            begin, end = self.since_first(run.first), self.since_first(run.last)
            span = f'{begin:5.1f} s to {end:5.1f} s  ' if run.first else ''
            lines.append(f'  {run.number:2d}  {span}{run.words}')
        no_events = 'none, for no motion was judged' if self.says_nothing else 'none'
        lines.append(f'events      {len(self.events) or no_events}')
        for event in self.events:
            until = 'still on' if event.active else f'{self.since_first(event.end):5.1f} s'
            place = f' at {event.place}' if event.place else ''
            advice = f'{":" if place else ";"} {event.advice}' if event.advice else ''
            lines.append(
                f'  {event.event_id:2d}  {self.since_first(event.start):5.1f} s to {until}  '
                f'{event.quantity} {event.relation} {event.shown(event.limit)}, '
                f'worst {event.shown(event.worst_value)}{place}{advice}'
            )
        return lines

    def _shares(self, *names: str) -> str:
        parts = []
        for name in names:
            time = getattr(self, f'{name}_time')
            parts.append(f'{name} {time:.1f} s ({share(time, self.running_time)})')
        return ', '.join(parts)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class MessageCounts:
    """
    What became of the messages of an input in a recording.

    All that were `heard`, those of other joints, refused, by why, and left out as out of order or
    without a slope; how many were `lost` on their way to a node, None where that is not known.

    """

    heard: int = 0
    others: int = 0
    refused: Mapping[Why, int] = dataclasses.field(default_factory=dict)
    left_out: int = 0
    lost: int | None = None

    @property
    def good(self) -> int:
        """Return how many gave a value."""
        return self.heard - self.others - sum(self.refused.values()) - self.left_out


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisOutcome:
    """
    What a recording comes to for one axis.

    `first` and `last` are stamps of states [ns]; `events` in order, one that is still on as far
    as it is known; `inputs` as they stood at the last row, `refused` messages by input and
    why; `reason` tells why the last row has no answer, if it has none; `messages` of the recording
    alone, where a node had heard others before it; `runs` of a recording that holds several.

    """

    axis: str
    first: int
    last: int
    rows: int
    states: int
    judged: int
    totals: Totals
    events: tuple[EventRecord, ...]
    inputs: tuple[InputStatus, ...]
    refused: Mapping[Source, Mapping[Why, int]]
    limits: Limits
    reason: str = ''
    messages: Mapping[Source, MessageCounts] = dataclasses.field(default_factory=dict)
    runs: tuple[RunRecord, ...] = ()

    def summary(self) -> Summary | None:
        """Return the summary, None without a state."""
        if not self.states:
            return None
        return Summary(
            axis=self.axis,
            first=self.first,
            last=self.last,
            states=self.states,
            judged=self.judged,
            events=self.events,
            runs=self.runs,
            **{name: getattr(self.totals, name) for name in SUMS},
        )


def summary_of(messages: Iterable[BallScrewState | OutOfZone]) -> Summary | None:
    """Return what states and events of one axis come to, None without a state."""
    first, states, last = 0, 0, None
    events: dict[int, EventRecord] = {}
    for message in messages:
        if isinstance(message, BallScrewState):
            first, states, last = first if states else stamp_of(message), states + 1, message
        elif message.event_id:
            events[message.event_id] = _event_record(message)
    if last is None:
        return None
    return Summary(
        axis=last.axis,
        first=first,
        last=stamp_of(last),
        states=states,
        judged=last.judged,
        events=tuple(events[key] for key in sorted(events)),
        **{name: getattr(last.totals, name) for name in SUMS},
    )


def run_record(number: int, span: Sequence[int], before: Totals, after: Totals) -> RunRecord:
    """Return a run by its first and last stamp [ns] and the totals before and after it."""
    return RunRecord(
        number=number,
        first=span[0],
        last=span[1],
        running_time=after.running_time - before.running_time,
        unjudged_time=after.unjudged_time - before.unjudged_time,
        optimal_time=after.optimal_time - before.optimal_time,
        outside_time=after.outside_time - before.outside_time,
        revolutions=after.revolutions - before.revolutions,
    )


def event_record(monitor: Monitor, *, until: int) -> EventRecord:
    """Return the last event of a monitor as it stands at the stamp `until` [ns]."""
    memory, target_speed = monitor.memory, monitor.target_speed
    quantity, relation = RELATIONS.get(monitor.event_code, OTHER)
    start = int(memory.event_start[ACTIVE])
    return EventRecord(
        event_id=int(memory.event_number),
        start=start,
        duration=seconds(until - start),
        active=bool(memory.event_active),
        quantity=quantity,
        relation=relation,
        limit=float(memory.event_limit[ACTIVE]),
        worst_value=float(memory.event_worst[ACTIVE]),
        speed=float(memory.event_speed[ACTIVE]),
        axial_load=float(memory.event_load[ACTIVE]),
        target_speed=target_speed,
        advice=speed_advice(target_speed),
        run_ended=monitor.ending.kind is EventEnd.RUN_ENDED,
    )


def _event_record(message: OutOfZone) -> EventRecord:
    quantity, relation = RELATIONS.get(message.cause.code, OTHER)
    return EventRecord(
        event_id=message.event_id,
        start=message.start.sec * SECOND + message.start.nanosec,
        duration=message.duration,
        active=message.active,
        quantity=quantity,
        relation=relation,
        limit=message.cause.limit,
        worst_value=message.worst_value,
        target_speed=message.cause.target_speed,
        advice=message.advice,
    )
