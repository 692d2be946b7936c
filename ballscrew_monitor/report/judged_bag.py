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
from diagnostic_msgs.msg import DiagnosticArray

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
        self._summaries: dict[str, Any] = {}
        self._sent = 0  # [ns]

    def messages(self, timed: TimedState) -> Iterator[tuple[str, Any]]:
        """Yield topic and message of all that the node would say with a state."""
        name, axis = timed.axis.name, timed.axis
        if name not in self._causes:
            self._causes[name] = Code.UNKNOWN
            settings = axis.monitor.settings
            yield (
                output(name, 'surface_info'),
                state_messages.surface_info_message(
                    name, axis.surface, settings, stamp=timed.log_time
                ),
            )
        yield output(name, 'state'), timed.state
        if timed.event is not None:
            self._causes[name] = Code(timed.event.cause.code)
            yield output(name, 'out_of_zone'), timed.event
        summary = summaries(timed.state, timed.inputs, self._causes[name], {})
        self._latest[name] = timed
        if summary != self._summaries.get(name) or timed.log_time - self._sent >= PERIOD:
            self._summaries[name], self._sent = summary, timed.log_time
            yield DIAGNOSTICS.name, self._diagnostics(timed.log_time)

    def _diagnostics(self, log_time: int) -> DiagnosticArray:
        """Return the diagnostics of all axes: a viewer shows the last message of a topic alone."""
        array = DiagnosticArray()
        for name, latest in self._latest.items():
            cause, surface = self._causes[name], latest.axis.surface
            array.status += statuses(
                f'/{NODE_NAME}', name, latest.state, latest.inputs, cause, surface, links={}
            )
        state_messages.fill_time(array.header.stamp, log_time)
        return array
