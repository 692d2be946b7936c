# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One axis through a recording: rows, states and what they come to."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
import itertools
import operator
from typing import Any, NamedTuple

from ballscrew_monitor.core.inputs import InputStatus, Source, Why
from ballscrew_monitor.core.state import RUN_ENDED
from ballscrew_monitor.judge import records, views
from ballscrew_monitor.judge.many import compiled_nearest, ManyJudge
from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.messages.state_messages import (
    empty_state,
    fill_state,
    fill_totals,
    out_of_zone_message,
)
from ballscrew_monitor.messages.unjudged import reason_of
from ballscrew_monitor.recordings.bulk.events import (
    Events,
    Notes,
    places_of_axis,
    some,
    TICK_SOURCE,
)
from ballscrew_monitor.recordings.summary import (
    AxisOutcome,
    event_record,
    EventRecord,
    MessageCounts,
    run_record,
    RunRecord,
)
from ballscrew_monitor.settings.axis import Axis
from ballscrew_msgs.msg import BallScrewState, OutOfZone, Totals
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.records import from_array


class TimedState(NamedTuple):
    """
    A state of an axis, how well its inputs do, and the event that it tells of.

    `log_time` [ns] is that of the message or the tick at which it is due.

    """

    log_time: int
    axis: Axis
    state: BallScrewState
    inputs: tuple[InputStatus, ...]
    event: OutOfZone | None


class AxisRows(NamedTuple):
    """
    The next rows of an axis, an array of ROW, at least one; those after them overwrite them.

    A row is a speed sample that was judged, or a tick that found no fresh speed; states are
    published of some rows only. They are of the run of this number, of a log with several.

    """

    axis: str
    rows: NDArray[Any]
    run: int = 0


Part = AxisRows | TimedState | AxisOutcome
"""What comes out of judging: rows, a state that was published, or all of an axis."""
Due = tuple[int, TimedState]
"""The place of an event, and the state that is due at it."""


class AxisRun:
    """Judges the ordered events of one axis and collects what they come to."""

    def __init__(self, axis: Axis, notes: Notes, *, parted: bool = False) -> None:
        """Begin; a bag whose stamps begin again is `parted` into runs there."""
        self._notes, self._parted = notes, parted
        self._begin(axis)
        self._events: dict[int, EventRecord] = {}
        self._rows = self._states = self._first = self._last = 0
        self._last_row: Any = None
        self._heard = np.zeros(TICK_SOURCE + 1, np.int64)  # messages by source
        self._others = np.zeros(TICK_SOURCE + 1, np.int64)
        self._before = _counts(axis)  # of a node that had judged before
        self._runs: list[RunRecord] = []  # those that have ended
        self._begun = axis.monitor.memory  # as the run began
        self._span = [0, 0]  # stamps of its first and last row [ns], 0 without one
        self._ended: OutOfZone | None = None  # by no sample, and not told yet
        self._last_stamp = np.zeros(0, np.int64)  # of the speed [ns]

    def _begin(self, axis: Axis) -> None:
        self.axis, self._judge = axis, ManyJudge(axis.monitor)
        axis.monitor.nearest = compiled_nearest()

    def take(self, events: Events, *, states: bool = True) -> Iterator[AxisRows | Due]:
        """Judge events; yield their rows, and the states that are due."""
        begins = {*np.flatnonzero(events['kind'] == records.RUN).tolist()}
        back = set[int]()
        if self._parted:  # samples of the speed at which a clock was set back
            is_speed = (events['kind'] == records.SAMPLE) & (events['source'] == Source.SPEED)
            places = np.flatnonzero(is_speed)
            stamps = events['stamp'][places]
            last = self._last_stamp if len(self._last_stamp) else stamps[:1]
            before = np.concatenate([last, stamps])
            self._last_stamp = before[-1:]
            back = {*places[before[:-1] - stamps > BACKWARD_JUMP].tolist()}
        for begin, end in itertools.pairwise([*sorted({0} | begins | back), len(events)]):
            some_events, monitor = events[begin:end], self.axis.monitor
            active = begin in begins and monitor.memory.event_active
            if begin in begins or begin in back:
                self._runs.append(self._run())
                if begin in begins:  # a clock that was set back the judge sees itself
                    for _ in self._judge.judge(some_events[:1]):  # which gives no row
                        pass
                self._begun, self._span = monitor.memory, [0, 0]
            if active:  # what is outside ends with its run
                monitor.ending = RUN_ENDED
                self._ended = out_of_zone_message(monitor, shelved=False)
                self._note(int(monitor.memory.event_stamp))
            for part in self._take(some_events, states=states):
                yield part if isinstance(part, AxisRows) else (begin + part[0], part[1])

    def _take(self, events: Events, *, states: bool) -> Iterator[AxisRows | Due]:
        """Judge events of one run as `take` does."""
        about = (events['kind'] == records.REFUSAL) & (events['why'] == Why.OTHER_JOINTS)
        places = np.flatnonzero(about)
        self._heard += _by_source(events)
        notes = {}  # places of messages about other joints and their notes, by input
        if len(places):
            self._others += _by_source(events[places])
        for source in Source if len(places) else ():
            mine = places[events['source'][places] == source]
            notes[source] = mine, events['note'][mine]
        for judged in self._judge.judge(events, states=states):
            for at, row in self._judge.told(judged):
                place = int(judged.places[at])
                self._hear_others(notes, place)
                log_time = int(events['log_time'][place])
                yield from ((place, state) for state in self._state(log_time, row, states=states))
            if len(judged.rows):
                self._count(judged.rows)
                yield AxisRows(self.axis.name, judged.rows, len(self._runs))
        self._hear_others(notes, len(events))

    def _state(self, log_time: int, row: records.Row, *, states: bool) -> Iterator[TimedState]:
        """Yield the state of a row if states are wanted, and keep the event that it tells of."""
        monitor = self.axis.monitor
        if row.edge:
            self._note(int(monitor.memory.event_stamp))
        if not states:
            return
        state = empty_state(self.axis.name)
        inputs = fill_state(state, row, monitor)
        if row.edge:
            message: OutOfZone | None = out_of_zone_message(monitor, shelved=state.shelved)
        else:
            message, self._ended = self._ended, None
            if message is not None:
                message.shelved = state.shelved
        yield TimedState(log_time, self.axis, state, inputs, message)

    def change(self, axis: Axis) -> None:
        """Go on with an axis as it is described now; an event may have been ended meanwhile."""
        was_active, memory = self.axis.monitor.memory.event_active, axis.monitor.memory
        self._begin(axis)
        if memory.event_number in self._events:
            self._note(memory.event_stamp)
        if was_active and not memory.event_active:
            self._ended = out_of_zone_message(axis.monitor, shelved=False)

    def _run(self) -> RunRecord:
        """Return what the run comes to so far."""
        begun, memory = self._begun, self.axis.monitor.memory
        totals = Totals(), Totals()
        for message, part in zip(totals, (begun, memory), strict=True):
            fill_totals(message, part)
        return dataclasses.replace(
            run_record(len(self._runs) + 1, self._span, *totals),
            judged=int(memory.judged - begun.judged),
            warnings=int(memory.event_number - begun.event_number),
        )

    def outcome(self) -> AxisOutcome:
        """Return what the axis comes to so far."""
        monitor, row = self.axis.monitor, self._last_row
        if monitor.memory.event_active:
            self._note(int(monitor.memory.stamp))
        totals = Totals()
        fill_totals(totals, monitor.memory)
        reason = '' if row is None else reason_of(row, monitor.surface)
        return AxisOutcome(
            axis=self.axis.name,
            first=self._first,
            last=self._last,
            rows=self._rows,
            states=self._states,
            judged=int(monitor.memory.judged),
            totals=totals,
            events=tuple(event for _, event in sorted(self._events.items())),
            inputs=monitor.input_status(0 if row is None else int(row.now)),
            refused=views.refused_of(monitor.memory),
            limits=monitor.settings.limits,
            reason=reason,
            messages={source: self._messages(source) for source in Source},
            runs=(*self._runs, self._run()) if self._runs else (),
        )

    def _messages(self, source: Source) -> MessageCounts:
        before, now = self._before[source], _counts(self.axis)[source]
        refused = {why: now.refused[why] - before.refused.get(why, 0) for why in now.refused}
        others = int(self._others[source])
        left_out = now.left_out - before.left_out - others
        return MessageCounts(
            heard=int(self._heard[source]),
            others=others,
            refused={why: count for why, count in refused.items() if count > 0},
            left_out=max(left_out, 0),
            lost=None if now.lost is None else max(now.lost - (before.lost or 0), 0),
        )

    def _note(self, until: int) -> None:
        event = event_record(self.axis.monitor, until=until)
        self._events[event.event_id] = event

    def _count(self, rows: NDArray[Any]) -> None:
        """Count rows, at least one."""
        published = rows['stamp'][rows['published']]
        self._rows += len(rows)
        self._span = [self._span[0] or int(rows['stamp'][0]), int(rows['stamp'][-1])]
        if len(published):
            self._first = self._first if self._states else int(published[0])
            self._last = int(published[-1])
            self._states += len(published)
        self._last_row = from_array(records.Row, rows[-1])

    def _hear_others(self, notes: Mapping[Source, tuple[Any, Any]], end: int) -> None:
        """Keep the joints that messages before a place have named since the last good sample."""
        monitor = self.axis.monitor
        for source, (places, numbers) in notes.items():
            count, others = int(np.searchsorted(places, end)), monitor.memory.others[source]
            first = max(count - others, 0)
            named = self._notes.named(numbers[first:count])
            monitor.joints.hear_many(source, named, all_since=others <= count)


def _counts(axis: Axis) -> dict[Source, MessageCounts]:
    """Return what an axis has counted so far, messages of other joints among those left out."""
    memory, refused = axis.monitor.memory, views.refused_of(axis.monitor.memory)
    return {
        source: MessageCounts(
            refused=refused[source],
            left_out=int(memory.dropped[source]) - sum(refused[source].values()),
            lost=int(memory.lost[source]) if memory.lost_known[source] else None,
        )
        for source in refused
    }


def _by_source(events: Events) -> NDArray[np.int64]:
    return np.bincount(events['source'], minlength=TICK_SOURCE + 1)


def judged_parts(runs: Sequence[AxisRun], events: Events, *, states: bool) -> Iterator[Part]:
    """Judge the events of several axes; yield rows, and the states in the order of events."""
    due: list[tuple[int, int, TimedState]] = []
    for number, run in enumerate(runs):
        places = places_of_axis(events, number)
        mine = events if len(places) == len(events) else some(events, places)
        for part in run.take(mine, states=states):
            if isinstance(part, AxisRows):
                yield part
                continue
            due.append((int(places[part[0]]), number, part[1]))
    yield from (state for _, _, state in sorted(due, key=operator.itemgetter(0, 1)))
