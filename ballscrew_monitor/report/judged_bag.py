# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A judged bag: inputs of a recording with the states, events and diagnostics that they give."""

from collections.abc import Callable, Iterator, Mapping
import contextlib
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.messages import state_messages
from ballscrew_monitor.messages.diagnostics import statuses, summaries
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import whole_bag
from ballscrew_monitor.recordings.bulk.batches import batches, END
from ballscrew_monitor.recordings.recorder import DIAGNOSTICS, recorded_topics
from ballscrew_monitor.settings.parameters import input_topics, NODE_NAME, output, with_types
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

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
            if topic.type_name:  # of the recording of a node without the messages of its inputs
                writer.add_topic(topic)
        inputs, answers = batches(bag, input_topics(values)), Answers()
        until = 0  # [ns] all inputs logged before that are there

        def copy_inputs(log_time: int) -> None:
            nonlocal until
            while until <= log_time and (batch := next(inputs, None)) is not None:
                writer.write_batch(batch)
                until = batch.until

        def add_state(state: TimedState) -> None:
            """Add what the node would say with a state, behind the inputs up to its log time."""
            at = state.log_time
            copy_inputs(at)
            for topic, message in answers.messages(state):
                writer.write(topic, serialized(message), log_time=at, publish_time=at)

        yield add_state
        copy_inputs(END)


class Answers:
    """Makes messages of states: the state, an event, and diagnostics as often as the node does."""

    def __init__(self) -> None:
        self._causes: dict[str, Code] = {}  # of the event that is active, or of the last one
        self._latest: dict[str, TimedState] = {}
        self._said: dict[str, Any] = {}
        self._said_at = 0  # [ns]

    def messages(self, one: TimedState) -> Iterator[tuple[str, Any]]:
        """Yield topic and message of all that the node would say with a state."""
        name = one.axis.name
        if name not in self._causes:
            self._causes[name] = Code.UNKNOWN
            info = state_messages.surface_info_message(
                name, one.axis.surface, one.axis.monitor.settings, stamp=one.log_time
            )
            yield output(name, 'surface_info'), info
        yield output(name, 'state'), one.state
        if one.event is not None:
            self._causes[name] = Code(one.event.cause.code)
            yield output(name, 'out_of_zone'), one.event
        yield from self._diagnostics(one)

    def _diagnostics(self, one: TimedState) -> Iterator[tuple[str, DiagnosticArray]]:
        """Yield diagnostics of all axes where those of one change, or the last are old."""
        name = one.axis.name
        summary = summaries(one.state, one.inputs, self._causes[name], {})
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
        name, cause, surface = one.axis.name, self._causes[one.axis.name], one.axis.surface
        return statuses(f'/{NODE_NAME}', name, one.state, one.inputs, cause, surface, links={})
