# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Replays a bag through the same pure pipeline as the node, without DDS, faster than real time.

Samples are taken in the order of their stamps, equal stamps in the fixed order of the sources.
Log times stand for the clock of the node: ticks fall on the same grid of it as online, whatever
the stamps say, and are taken after the samples of equal stamp. Sample by sample the states are
those of the node to the last bit; many at once, its numbers agree to rounding. The recording that
a node made of itself, judged with its own parameters, is followed step by step.

"""

from collections.abc import Iterator, Mapping, Sequence
import operator
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Input
from ballscrew_monitor.core.state import Event, State
from ballscrew_monitor.messages.state_messages import out_of_zone_message, StateWriter, TIERS
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.entries import Entries
from ballscrew_monitor.recordings.bulk.judge import AxisJudge
from ballscrew_monitor.recordings.bulk.source import OnDone, ordered_entries, places_of_axis
from ballscrew_monitor.recordings.columns import AxisOutcome, JudgedColumns
from ballscrew_monitor.recordings.decoding import decode, named_instead
from ballscrew_monitor.recordings.own_recording import is_as_recorded
from ballscrew_monitor.recordings.own_replay import own_parts, Part, TimedState
from ballscrew_monitor.recordings.rows import RowCollector
from ballscrew_monitor.settings.axis import Axis, build_axis
from ballscrew_monitor.settings.topics import absolute, input_topics, with_types
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from surrogate.files import InputError


def ignore(share: float) -> None:
    """Be told which share is done [-], and do nothing."""


class Judged(NamedTuple):
    """A state and, if an event began or ended with it, that event; the state is reused."""

    state: BallScrewState
    event: OutOfZone | None


class Due(NamedTuple):
    """A state, the number of its axis, and the place in a batch of the entry it is due at."""

    place: int
    axis: int
    state: State


def speed_messages(bag: Bag, axes: Sequence[Axis]) -> dict[str, int]:
    """
    Return for each axis how many messages of `bag` speak of its speed.

    Reads and so verifies the whole bag; raises InputError when it is damaged and was not opened
    to be salvaged, or when it says nothing of an axis.

    """
    speed = {axis.name: axis.inputs[-1] for axis in axes}
    counts = dict.fromkeys(speed, 0)
    readers: dict[str, list[tuple[str, Input]]] = {}
    for axis in axes:
        for source in axis.inputs:
            readers.setdefault(absolute(source.topic), []).append((axis.name, source))
    for message in bag.messages():
        wanted = readers.get(message.topic, [])
        decoded = decode(bag, message, wanted[0][1].message_type)[0] if wanted else None
        for name, source in wanted if decoded is not None else ():
            if source is speed[name]:
                counts[name] += not isinstance(source.read_field(decoded), OtherJoints)
    for name, count in counts.items():
        if not count:
            raise InputError(
                f'bag {bag.path}: no message of {absolute(speed[name].topic)} holds '
                f'the speed of axis {name}, at least one must{named_instead(bag, speed[name])}'
            )
    return counts


def replay(
    bag: Bag, values: Mapping[str, Any], *, at_once: bool = False, on_done: OnDone = ignore
) -> Iterator[Judged]:
    """
    Yield every state that the node would publish for `bag` with the parameters `values`.

    Sample by sample, or many `at_once`; `on_done` is told which share of the bag is done [-].
    Raises InputError for bad parameters, for a bag without the topics that they name and, unless
    what is whole of it is to be salvaged, for a damaged one.

    """
    return _messages(replay_states(bag, values, at_once=at_once, on_done=on_done))


def replay_states(
    bag: Bag, values: Mapping[str, Any], *, at_once: bool = False, on_done: OnDone = ignore
) -> Iterator[TimedState]:
    """Yield what `replay` does before it is made a message."""
    if is_as_recorded(bag, values):
        return (part for part in own_parts(bag, on_done) if isinstance(part, TimedState))
    axes = axes_for(bag, values)
    return _states(_entries(bag, axes, values, on_done), axes, at_once=at_once)


def replay_columns(
    bag: Bag, values: Mapping[str, Any], *, at_once: bool = True, on_done: OnDone = ignore
) -> Iterator[JudgedColumns | AxisOutcome]:
    """
    Yield every judged row of `bag` with the parameters `values`, and at last what it comes to.

    The rows come in blocks, those of one axis in order; then one outcome for each axis. The rest
    is as for `replay`.

    """
    if is_as_recorded(bag, values):
        return (part for part in own_parts(bag, on_done) if not isinstance(part, TimedState))
    axes = axes_for(bag, values)
    return _columns(_entries(bag, axes, values, on_done), axes, at_once=at_once)


def replay_parts(
    bag: Bag, values: Mapping[str, Any], *, on_done: OnDone = ignore
) -> Iterator[Part]:
    """Yield what `replay_columns` and `replay_states` do, of many samples at once, judged once."""
    if is_as_recorded(bag, values):
        return own_parts(bag, on_done)
    axes = axes_for(bag, values)
    return _parts(_entries(bag, axes, values, on_done), axes)


def axes_for(bag: Bag, values: Mapping[str, Any]) -> list[Axis]:
    """
    Return the axes that `values` configure, ready for `bag`.

    Raises InputError for bad parameters and for a bag without the topics that they name.

    """
    values = with_types(values, bag.types)
    bag.require(input_topics(values))
    return [build_axis(name, values) for name in values['axes']]


def _entries(
    bag: Bag, axes: list[Axis], values: Mapping[str, Any], on_done: OnDone
) -> Iterator[Entries]:
    return ordered_entries(bag, axes, nanoseconds(values['tick_period']), on_done=on_done)


def _columns(
    batches: Iterator[Entries], axes: list[Axis], *, at_once: bool
) -> Iterator[JudgedColumns | AxisOutcome]:
    judges = [AxisJudge(axis, at_once=at_once) for axis in axes]
    collectors = [RowCollector(axis.name, axis.monitor) for axis in axes]
    for entries in batches:
        for number, (judge, collector) in enumerate(zip(judges, collectors, strict=True)):
            yield from judge.columns(entries.take(places_of_axis(entries, number)), collector)
    yield from (collector.outcome() for collector in collectors)


def _states(
    batches: Iterator[Entries], axes: list[Axis], *, at_once: bool
) -> Iterator[TimedState]:
    judges = [AxisJudge(axis, at_once=at_once) for axis in axes]
    for entries in batches:
        found = [
            Due(int(places[at]), number, state)
            for number, judge in enumerate(judges)
            for places in [places_of_axis(entries, number)]
            for at, state in judge.states(entries.take(places))
        ]
        yield from _in_order(found, entries, axes)


def _parts(batches: Iterator[Entries], axes: list[Axis]) -> Iterator[Part]:
    judges = [AxisJudge(axis) for axis in axes]
    collectors = [RowCollector(axis.name, axis.monitor) for axis in axes]
    for entries in batches:
        found: list[Due] = []
        for number, (judge, collector) in enumerate(zip(judges, collectors, strict=True)):
            places = places_of_axis(entries, number)
            for part in judge.both(entries.take(places), collector):
                if isinstance(part, JudgedColumns):
                    yield part
                else:
                    found.append(Due(int(places[part[0]]), number, part[1]))
        yield from _in_order(found, entries, axes)
    yield from (collector.outcome() for collector in collectors)


def _in_order(found: list[Due], entries: Entries, axes: list[Axis]) -> Iterator[TimedState]:
    """Yield the states of a batch in the order of the entries that they are due at."""
    for one in sorted(found, key=operator.itemgetter(0, 1)):
        log_time = int(entries.log_time[one.place])
        yield TimedState(log_time, axes[one.axis], one.state, one.state.event)


def _messages(states: Iterator[TimedState]) -> Iterator[Judged]:
    writers: dict[str, StateWriter] = {}
    for one in states:
        name, tier = one.axis.name, TIERS[one.axis.surface.tier]
        writer = writers.setdefault(name, StateWriter(name, tier))
        writer.tier = tier  # the node may have taken another one
        yield _judged(writer, name, one.state, one.event)


def _judged(writer: StateWriter, axis: str, state: State, event: Event | None) -> Judged:
    message = None
    if event is not None:
        message = out_of_zone_message(axis, event, shelved=state.shelving.until != 0)
    return Judged(state=writer.write(state), event=message)
