# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the monitors of a node said, again, out of the recording that the node made of itself."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from ballscrew_monitor.core.state import Event, State
from ballscrew_monitor.node.axis import Axis
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.columns import AxisOutcome, JudgedColumns
from ballscrew_monitor.recordings.own_recording import OwnRecording, Step
from ballscrew_monitor.recordings.rows import RowCollector

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


def own_states(bag: Bag, on_done: OnDone = None) -> Iterator[TimedState]:
    """
    Yield every state that the node published.

    An event that an acknowledgement has ended comes with the state after that.

    """
    ended: dict[str, Event | None] = {}
    last: dict[str, Event] = {}
    for step in OwnRecording(bag).steps(on_done):
        name, monitor = step.axis.name, step.axis.monitor
        state = _take(step)
        if step.because and name in last and last[name].active and not monitor.event.active:
            ended[name] = monitor.event
        last[name] = monitor.event
        if state is not None:
            event = state.event or ended.pop(name, None)
            yield TimedState(_log_time(step), step.axis, state, event)


def own_columns(bag: Bag, on_done: OnDone = None) -> Iterator[JudgedColumns | AxisOutcome]:
    """Yield every row that the node judged, in blocks, and at last what each axis comes to."""
    collectors: dict[str, RowCollector] = {}
    for step in OwnRecording(bag).steps(on_done):
        name = step.axis.name
        if name not in collectors:
            collectors[name] = RowCollector(name, step.axis.monitor)
        elif step.because:
            collectors[name].observe(step.axis.monitor)
        _take(step)
        if len(collectors[name]) >= BLOCK:
            yield collectors[name].block()
    yield from (one.block() for one in collectors.values() if len(one))
    yield from (one.outcome() for one in collectors.values())


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
