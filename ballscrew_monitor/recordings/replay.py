# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Replays a bag through the same pure pipeline as the node, without DDS, faster than real time.

Samples are taken in the order of their stamps, equal stamps in the fixed order of the sources.
Log times stand for the clock of the node: ticks fall on the same grid of it as online, whatever
the stamps say, and are taken after the samples of equal stamp. The judgement is the one of the
node, compiled, so its states are those of the node to the last bit. Of the recording that a node
made of itself, the events themselves are judged.

"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.recordings.axis_run import AxisRun, judged_parts, Part, TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.decode import decode, named_instead, readers_by_topic
from ballscrew_monitor.recordings.bulk.events import Events, Notes
from ballscrew_monitor.recordings.bulk.order import OnDone, ordered_events
from ballscrew_monitor.recordings.recorded_events import judged_by_events, RecordedEvents
from ballscrew_monitor.settings.axis import Axis, build_axis
from ballscrew_monitor.settings.parameters import absolute, input_topics, with_types
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from surrogate.files import InputError


def ignore(share: float) -> None:
    """Be told which share is done [-], and do nothing."""


def speed_messages(bag: Bag, axes: Sequence[Axis]) -> dict[str, int]:
    """
    Return for each axis how many messages of `bag` speak of its speed.

    Reads and so verifies the whole bag; raises InputError if it is damaged, or says nothing of an
    axis.

    """
    speed = {axis.name: axis.inputs[-1] for axis in axes}
    counts = dict.fromkeys(speed, 0)
    readers = readers_by_topic(axes)
    for message in bag.messages():
        wanted = readers.get(message.topic, [])
        decoded = decode(bag, message, wanted[0][2].message_type) if wanted else None
        for _, axis, source in wanted if decoded is not None else ():
            if source is speed[axis.name]:
                counts[axis.name] += not isinstance(source.read_field(decoded), OtherJoints)
    for name, count in counts.items():
        if not count:
            raise InputError(
                f'bag {bag.path}: no message of {absolute(speed[name].topic)} holds '
                f'the speed of axis {name}, at least one must{named_instead(bag, speed[name])}'
            )
    return counts


def replay(
    bag: Bag, values: Mapping[str, Any]
) -> Iterator[tuple[BallScrewState, OutOfZone | None]]:
    """
    Yield every state that the node would publish for `bag`, as `replay_parts` does.

    With it comes the event that begins or ends with it, if one does.

    """
    parts = replay_parts(bag, values)
    return ((part.state, part.event) for part in parts if isinstance(part, TimedState))


def replay_parts(
    bag: Bag, values: Mapping[str, Any], *, states: bool = True, on_done: OnDone = ignore
) -> Iterator[Part]:
    """
    Yield every judged row of `bag` with the parameters `values`, and at last what it comes to.

    The rows come in blocks, those of one axis in order; then one outcome for each axis. States
    that the node would publish come between the blocks if they are wanted. `on_done` is told which
    share of the bag is done [-]. Raises InputError for bad parameters, for a bag without the
    topics that they name and for a damaged one.

    """
    notes = Notes()
    if judged_by_events(bag, values):
        recorded = RecordedEvents(bag, notes, values)
        return _parts(recorded.events(on_done), recorded.runs, states=states)
    axes, period = axes_for(bag, values), nanoseconds(values['tick_period'])
    batches = ordered_events(bag, axes, period, notes, on_done=on_done)
    return _parts(batches, [AxisRun(axis, notes, parted=True) for axis in axes], states=states)


def axes_for(bag: Bag, values: Mapping[str, Any]) -> list[Axis]:
    """
    Return the axes that `values` configure, ready for `bag`.

    Raises InputError for bad parameters and for a bag without the topics that they name.

    """
    values = with_types(values, bag.types)
    bag.require(input_topics(values))
    return [build_axis(name, values) for name in values['axes']]


def _parts(batches: Iterator[Events], runs: list[AxisRun], *, states: bool) -> Iterator[Part]:
    for events in batches:
        yield from judged_parts(runs, events, states=states)
    yield from (run.outcome() for run in runs)
