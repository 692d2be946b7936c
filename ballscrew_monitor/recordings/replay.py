# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Replays a bag through the same pure pipeline as the node, without DDS, faster than real time.

Samples are taken in the order of their stamps, equal stamps in the fixed order of the sources.
Log times stand for the clock of the node: ticks fall on the same grid of it as online, whatever
the stamps say, and are taken after the samples of equal stamp.

"""

from collections.abc import Iterator, Mapping, Sequence
import heapq
import itertools
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal, Source, Why
from ballscrew_monitor.core.monitor import BACKWARD_JUMP
from ballscrew_monitor.core.state import State
from ballscrew_monitor.node.axis import Axis, build_axis
from ballscrew_monitor.node.messages import out_of_zone_message, StateWriter, TIERS
from ballscrew_monitor.node.topics import absolute, input_topics, with_types
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.decoding import decode, named_instead
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from surrogate.files import InputError

REORDER = nanoseconds(1.0)  # [ns] log time over which samples are put into the order of stamps
LONGEST_HOLE = nanoseconds(60.0)  # [ns] between two messages that is filled with ticks
AFTER_SAMPLES = max(Source) + 1  # place of a tick among the sources


class Judged(NamedTuple):
    """A state and, if an event began or ended with it, that event; the state is reused."""

    state: BallScrewState
    event: OutOfZone | None


def speed_messages(bag: Bag, axes: Sequence[Axis]) -> dict[str, int]:
    """
    Return for each axis how many messages of `bag` speak of its speed.

    Reads and so verifies the whole bag; raises InputError when it is damaged, or when it says
    nothing of an axis.

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


def replay(bag: Bag, values: Mapping[str, Any]) -> Iterator[Judged]:
    """
    Yield every state that the node would publish for `bag` with the parameters `values`.

    Raises InputError for bad parameters and for a bag without the topics that they name.

    """
    values = with_types(values, bag.types)
    bag.require(input_topics(values))
    axes = [build_axis(name, values) for name in values['axes']]
    return itertools.chain.from_iterable(_run(bag, axes, nanoseconds(values['tick_period'])))


class _Entry(NamedTuple):
    """A sample, refusal or tick (None) and its place in the order; `number` settles the rest."""

    stamp: int
    source: int
    number: int
    log_time: int
    axis: int
    event: InputSample | Refusal | None


def _run(bag: Bag, axes: list[Axis], period: int) -> Iterator[list[Judged]]:
    writers = [StateWriter(axis.name, TIERS[axis.surface.tier]) for axis in axes]
    for entry in _ordered(_with_ticks(_read(bag, axes), period)):
        if entry.event is None:
            for axis, writer in zip(axes, writers, strict=True):
                yield _judged(writer, axis.name, axis.monitor.tick(entry.stamp))
        else:
            axis = axes[entry.axis]
            yield _judged(writers[entry.axis], axis.name, axis.monitor.update(entry.event))


def _judged(writer: StateWriter, axis: str, state: State | None) -> list[Judged]:
    if state is None:
        return []
    event = None
    if state.event is not None:
        event = out_of_zone_message(axis, state.event, shelved=state.shelving.until != 0)
    return [Judged(state=writer.write(state), event=event)]


def _read(bag: Bag, axes: list[Axis]) -> Iterator[_Entry]:
    readers: dict[str, list[tuple[int, Axis, Input]]] = {}
    for number, axis in enumerate(axes):
        for source in axis.inputs:
            readers.setdefault(absolute(source.topic), []).append((number, axis, source))
    numbers = itertools.count()
    for message in bag.messages(readers):
        decoded, why = decode(bag, message, readers[message.topic][0][2].message_type)
        for number, axis, source in readers[message.topic]:
            event: InputSample | Refusal
            if decoded is None:
                event = _not_decoded(source.source, why, message.log_time)
            else:
                event = source.read(decoded, now=message.log_time, max_future=axis.max_future)
            stamp = event.stamp if isinstance(event, InputSample) else message.log_time
            yield _Entry(stamp, event.source, next(numbers), message.log_time, number, event)


def _with_ticks(entries: Iterator[_Entry], period: int) -> Iterator[_Entry]:
    """
    Put a tick at every multiple of `period` [ns] of log time between the entries.

    After the longest hole no further tick says anything new, so that one wrong log time does not
    make them endless.

    """
    grid = None
    for entry in entries:
        now = entry.log_time
        if grid is not None:
            for tick in range(grid, min(now, grid + LONGEST_HOLE), period):
                yield _Entry(tick, AFTER_SAMPLES, 0, tick, 0, None)
        grid = max(grid or 0, -(-now // period) * period)
        yield entry


def _not_decoded(source: Source, text: str, arrival: int) -> Refusal:
    return Refusal(source=source, why=Why.NOT_DECODED, text=text, arrival=arrival)


def _ordered(entries: Iterator[_Entry]) -> Iterator[_Entry]:
    """
    Yield the entries by stamp, as far as they are out of order by less than `REORDER`.

    A clock that is set back begins a new time line: what came before comes before.

    """
    waiting: list[_Entry] = []
    last: dict[tuple[int, int], int] = {}  # stamps [ns] by axis and source
    for entry in entries:
        if isinstance(entry.event, InputSample):  # the stamp of a refusal is a log time
            line = entry.axis, entry.source
            if last.get(line, entry.stamp) - entry.stamp > BACKWARD_JUMP:
                yield from _emptied(waiting)
            last[line] = entry.stamp
        heapq.heappush(waiting, entry)
        while entry.log_time - waiting[0].log_time > REORDER:
            yield heapq.heappop(waiting)
    yield from _emptied(waiting)


def _emptied(waiting: list[_Entry]) -> Iterator[_Entry]:
    while waiting:
        yield heapq.heappop(waiting)
