# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A judged bag: inputs of a recording with the states, events and diagnostics that they give."""

from collections.abc import Callable, Iterator, Mapping
import contextlib
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.messages import state_messages
from ballscrew_monitor.messages.diagnostics import statuses, summaries
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, whole_bag
from ballscrew_monitor.recordings.bulk.batches import Batch, batches, END
from ballscrew_monitor.recordings.recorder import DIAGNOSTICS, recorded_topics
from ballscrew_monitor.recordings.replay import answer
from ballscrew_monitor.settings.parameters import input_topics, NODE_NAME, output, with_types
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import numpy as np

NAME = 'judged'
PERIOD = SECOND  # [ns] of log time after which diagnostics come again


@contextlib.contextmanager
def judged_bag(
    bag: Bag, values: Mapping[str, Any], directory: Path, metadata: Mapping[str, str]
) -> Iterator[Callable[[TimedState], None]]:
    """
    Give what takes the states of `bag`; its judged bag is in `directory` when the block ends.

    It was judged with the parameters `values`. The judged bag is on its log times; `metadata` are
    what it says of the log, and of the parameters. Raises InputError as `whole_bag` does.

    """
    values = with_types(values, bag.types)
    with whole_bag(directory, NAME) as writer:
        if metadata:
            writer.add_metadata(metadata)
        for topic in recorded_topics(values):
            writer.add_topic(topic)
        growing = _Growing(bag, values, writer)
        yield growing.add
        growing.copy_inputs(END)


class _Growing:
    """A judged bag, to which inputs are added as far as the judging has come."""

    def __init__(self, bag: Bag, values: Mapping[str, Any], writer: BagWriter) -> None:
        self._inputs = batches(bag, input_topics(values))
        self._until = 0  # [ns] all inputs logged before that are there
        self._answers, self._writer = Answers(), writer

    def add(self, state: TimedState) -> None:
        """Add what the node would say with a state, behind the inputs up to its log time."""
        self.copy_inputs(state.log_time)
        at = state.log_time
        for topic, message in self._answers.messages(state):
            self._writer.write(topic, serialized(message), log_time=at, publish_time=at)

    def copy_inputs(self, log_time: int) -> None:
        """Add all inputs up to a log time [ns]."""
        while self._until <= log_time and (batch := next(self._inputs, None)) is not None:
            _copy(batch, self._writer)
            self._until = batch.until


def _copy(batch: Batch, writer: BagWriter) -> None:
    """Write the messages of a batch in the order of their log times."""
    parts = list(batch.topics.values())
    if not parts:
        return
    which = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    times, places, begins, sizes = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ('log_time', 'place', 'begin', 'size')
    )
    order = np.lexsort((places, times))
    data = parts[0].data  # that of all topics of a batch
    columns = (which[order], times[order], data, begins[order], sizes[order])
    writer.write_many(list(batch.topics), *columns)


class Answers:
    """Makes messages of states: the state, an event, and diagnostics as often as the node does."""

    def __init__(self) -> None:
        """Begin with no axis known."""
        self._writers: dict[str, state_messages.StateWriter] = {}
        self._events: dict[str, Event] = {}
        self._latest: dict[str, TimedState] = {}
        self._said: dict[str, Any] = {}
        self._said_at = 0  # [ns]

    def messages(self, one: TimedState) -> Iterator[tuple[str, Any]]:
        """Yield topic and message of all that the node would say with a state."""
        name = one.axis.name
        if name not in self._events:
            self._events[name] = Event()
            info = state_messages.surface_info_message(
                name, one.axis.surface, one.axis.monitor.settings, stamp=one.log_time
            )
            yield output(name, 'surface_info'), info
        state, event = answer(one, self._writers)
        yield output(name, 'state'), state
        if one.event is not None:
            self._events[name] = one.event
            yield output(name, 'out_of_zone'), event
        yield from self._diagnostics(one)

    def _diagnostics(self, one: TimedState) -> Iterator[tuple[str, DiagnosticArray]]:
        """Yield diagnostics of all axes where those of one change, or the last are old."""
        name = one.axis.name
        summary = summaries(one.state, self._events[name], {})
        self._latest[name] = one
        if summary == self._said.get(name) and one.log_time - self._said_at < PERIOD:
            return
        self._said[name], self._said_at = summary, one.log_time
        # A viewer shows the last message of a topic alone: it is to tell of every axis.
        array = DiagnosticArray(
            status=[each for latest in self._latest.values() for each in self._statuses(latest)]
        )
        state_messages.fill_time(array.header.stamp, one.log_time)
        yield DIAGNOSTICS.name, array

    def _statuses(self, one: TimedState) -> list[DiagnosticStatus]:
        axis = one.axis
        event = self._events[axis.name]
        return statuses(f'/{NODE_NAME}', axis.name, one.state, event, axis.surface, links={})
