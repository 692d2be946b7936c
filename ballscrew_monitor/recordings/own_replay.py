# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the monitors of a node said, again, out of the recording that the node made of itself."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from ballscrew_monitor.core.state import Event, State
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.columns import AxisOutcome, JudgedColumns
from ballscrew_monitor.recordings.own_recording import OwnRecording, Step
from ballscrew_monitor.recordings.rows import RowCollector
from ballscrew_monitor.settings.axis import Axis

OnDone = Callable[[float], None] | None
BLOCK = 65536  # rows of an axis that are handed on at once


class TimedState(NamedTuple):
    """
    A state, its axis, and the event that began or ended with it.

    `log_time` [ns] is that of the message or the tick at which it is due.

    """

    log_time: int
    axis: Axis
    state: State
    event: Event | None


Part = JudgedColumns | TimedState | AxisOutcome
"""What comes out of judging: a block of rows, a state that was published, or all of an axis."""


def own_parts(bag: Bag, on_done: OnDone = None) -> Iterator[Part]:
    """
    Yield every state that the node published, the rows that it judged, and all of each axis last.

    The rows come in blocks. An event that an acknowledgement has ended comes with the state after
    that.

    """
    followed: dict[str, _Followed] = {}
    for step in OwnRecording(bag).steps(on_done):
        name = step.axis.name
        if name not in followed:
            followed[name] = _Followed(step.axis)
        yield from followed[name].take(step)
    collectors = [one.collector for one in followed.values()]
    yield from (one.block() for one in collectors if len(one))
    yield from (one.outcome() for one in collectors)


class _Followed:
    """An axis whose steps are followed: its rows, and an event of which no state has told yet."""

    def __init__(self, axis: Axis) -> None:
        self.collector = RowCollector(axis.name, axis.monitor)
        self._last: Event | None = None
        self._ended: Event | None = None

    def take(self, step: Step) -> Iterator[JudgedColumns | TimedState]:
        """Let the monitor take a step; yield a state that is due, and rows when they are many."""
        monitor = step.axis.monitor
        if step.because:
            self.collector.observe(monitor)
            if self._last is not None and self._last.active and not monitor.event.active:
                self._ended = monitor.event
        state = _take(step)
        self._last = monitor.event
        if state is not None:
            event = state.event
            if event is None:
                event, self._ended = self._ended, None
            yield TimedState(_log_time(step), step.axis, state, event)
        if len(self.collector) >= BLOCK:
            yield self.collector.block()


def _log_time(step: Step) -> int:
    """Return when a step was taken on the clock of the node [ns]."""
    if step.event is not None:
        return step.event.arrival
    return step.tick or 0


def _take(step: Step) -> State | None:
    """Let the monitor of a step take it; return its state, if one was due."""
    if step.event is not None:
        return step.axis.monitor.update(step.event)
    return None if step.tick is None else step.axis.monitor.tick(step.tick)
