# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A recording that a node made of itself: the very steps that its monitors took.

Its journal says in which bursts messages were taken, when ticks came, what was lost, and all about
each axis from time to time. So a replay gives what the node gave, bit for bit, and proves it: each
time the node wrote down what a monitor remembered, the replayed one must remember the same.

"""

from collections.abc import Callable, Iterator, Mapping
import dataclasses
import json
from typing import Any

from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.core.full_point import corrected, KeptSolve
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal
from ballscrew_monitor.core.snapshot import freeze_monitor, thaw_monitor
from ballscrew_monitor.node import parameters
from ballscrew_monitor.node.axis import Axis, build_axis, settings_of
from ballscrew_monitor.node.intake import ordered
from ballscrew_monitor.node.journal import STRING, VERSION
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.decoding import decode, UNDECODABLE
from rclpy.serialization import deserialize_message
from surrogate.files import InputError
from surrogate.surface import SurfaceError

JOURNAL = '/journal'
TOLD = 1000  # messages after which the progress is told


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """What happened next to an axis: a sample or refusal, a tick [ns], or neither: it changed."""

    axis: Axis
    event: InputSample | Refusal | None = None
    tick: int | None = None
    because: str = ''


def journal_of(bag: Bag) -> str:
    """Return the topic of the journal in a bag; empty: no node recorded it."""
    found = [
        name
        for name, info in bag.topics.items()
        if name.endswith(JOURNAL) and info.type_name == STRING
    ]
    return found[0] if len(found) == 1 else ''


def recorded_values(bag: Bag) -> dict[str, Any]:
    """
    Return the parameters with which a node judged what it recorded, topics by their full names.

    Raises InputError for a recording that describes no axis.

    """
    found: dict[str, dict[str, Any]] = {}
    for message in bag.as_written([journal_of(bag)]):
        entry = _entry(message)
        if entry['kind'] == 'axis':
            if entry['axis'] in found:
                break
            found[entry['axis']] = _values(entry, bag.types)
    if not found:
        raise InputError(f'bag {bag.path}: its journal describes no axis')
    values = parameters.defaults(list(found))
    for one in found.values():
        values |= one
    return values | {'axes': list(found)}


def is_as_recorded(bag: Bag, values: Mapping[str, Any]) -> bool:
    """Tell whether a bag is the recording of a node, to be judged with the node's parameters."""
    return bool(journal_of(bag)) and recorded_values(bag) == dict(values)


class OwnRecording:
    """The steps in a recording, and how often it proved the replay right and wrong."""

    def __init__(self, bag: Bag) -> None:
        """Read a bag that has a journal."""
        self.proven = 0
        self.refuted = 0
        self._bag = bag
        self._journal = journal_of(bag)
        self._axes: dict[str, Axis] = {}
        self._readers: dict[str, list[tuple[Axis, Input]]] = {}
        self._entries: dict[str, Mapping[str, Any]] = {}
        self._burst: list[tuple[Message, int | None]] = []
        self._lost: dict[str, int | None] = {}

    def steps(self, on_done: Callable[[float], None] | None = None) -> Iterator[Step]:
        """
        Yield every step; raises InputError for a recording that cannot be replayed here.

        `on_done` is told which share is done [-].

        """
        for number, message in enumerate(self._bag.as_written()):
            if on_done is not None and number % TOLD == 0:
                span = max(self._bag.end_time - self._bag.start_time, 1)
                on_done(min(max((message.log_time - self._bag.start_time) / span, 0.0), 1.0))
            entry = _entry(message) if message.topic == self._journal else None
            if entry is not None and entry['kind'] == 'lost':  # of a message in the burst
                self._lost[entry['topic']] = entry['count']
                continue
            if self._burst and message.sequence != self._burst[0][0].sequence:
                yield from self._take_burst()
            if entry is not None:
                yield from self._follow(entry)
            elif message.topic in self._readers:
                self._burst.append((message, self._take_lost(message.topic)))
        yield from self._take_burst()
        if self.proven + self.refuted:
            self._bag.remarks.append(self._proof())

    def _proof(self) -> str:
        """Return how often the replay was held against what the node remembered."""
        held = self.proven + self.refuted
        if self.refuted:
            return (
                f'the replay differs from what the node said of itself at {self.refuted} of '
                f'{held} times that it did'
            )
        return f'the replay is what the node judged: it agrees with all {held} notes of the node'

    def _take_lost(self, topic: str) -> int | None:
        """Return how many messages were lost; a number counts once, that it is unknown stays."""
        lost = self._lost.get(topic, 0)
        if lost:
            self._lost[topic] = 0
        return lost

    def _take_burst(self) -> Iterator[Step]:
        burst, self._burst = self._burst, []
        events = [event for one, lost in burst for event in self._events(one, lost)]
        for axis, event in ordered(events):
            yield Step(axis=axis, event=event)

    def _events(
        self, message: Message, lost: int | None
    ) -> Iterator[tuple[Axis, InputSample | Refusal]]:
        """Yield what a message says of each axis."""
        readers, now = self._readers[message.topic], message.log_time
        decoded, _ = decode(self._bag, message, readers[0][1].message_type)
        for axis, one in readers:
            if decoded is None:
                yield axis, one.refuse_undecoded(now=now, lost=lost)
            else:
                yield axis, one.read(decoded, now=now, max_future=axis.max_future, lost=lost)

    def _follow(self, entry: Mapping[str, Any]) -> Iterator[Step]:
        """Take an entry of the journal."""
        if entry['kind'] == 'tick':
            for axis in self._axes.values():
                yield Step(axis=axis, tick=entry['stamp'])
        elif entry['kind'] == 'hole':  # until each axis is described anew
            self._axes, self._readers, self._entries = {}, {}, {}
        elif entry['kind'] == 'axis':
            try:
                step = self._describe(entry)
            except (KeyError, TypeError, AttributeError) as error:
                raise InputError(f'{self._journal}: an axis is described badly: {error}') from None
            if step is not None:
                yield step

    def _describe(self, entry: Mapping[str, Any]) -> Step | None:
        """Hold an axis against what is said of it, or make it as is said."""
        name = entry['axis']
        self._lost = dict.fromkeys(entry['loss_unknown'])
        known = self._axes.get(name)
        if known is not None and entry['because'] == 'time':
            same = freeze_monitor(known.monitor) == entry['monitor']
            self.proven += same
            self.refuted += not same
            if same:
                return None
        axis = self._rebuilt(known, entry)
        self._axes[name], self._entries[name] = axis, entry
        self._readers = {}
        for one in self._axes.values():
            for source in one.inputs:
                self._readers.setdefault(source.topic, []).append((one, source))
        return Step(axis=axis, because=entry['because'])

    def _rebuilt(self, known: Axis | None, entry: Mapping[str, Any]) -> Axis:
        """Return an axis as an entry describes it; what is the same as before is not made anew."""
        name, values = entry['axis'], _values(entry, self._bag.types)
        before = self._entries.get(name)
        parts = ('values', 'topics', 'surface')
        if known is None or before is None or any(before[part] != entry[part] for part in parts):
            axis = build_axis(name, values)
            axis.surface = _surface(axis, entry['surface'])
        else:
            axis = dataclasses.replace(known)
        settings = settings_of(name, values, axis.surface)
        axis.monitor = thaw_monitor(entry['monitor'], axis.surface, settings)
        return axis


def _entry(message: Message) -> Mapping[str, Any]:
    try:
        text = deserialize_message(message.data, message_class(STRING)).data
        entry: Mapping[str, Any] = json.loads(text)
        known = entry['kind'] != 'axis' or entry['version'] == VERSION
    except (*UNDECODABLE, KeyError, TypeError) as error:
        raise InputError(f'{message.topic}: no entry of a journal ({error})') from None
    if not known:
        raise InputError(
            f'{message.topic}: a journal of version {entry["version"]}, known is {VERSION}'
        )
    return entry


def _values(entry: Mapping[str, Any], types: Mapping[str, str]) -> dict[str, Any]:
    """Return the parameters of an axis, its topics by full name and with their types."""
    values = dict(entry['values'])
    for source, topic in entry['topics'].items():
        prefix = f'{entry["axis"]}.{source}'
        values[f'{prefix}.topic'] = topic
        values[f'{prefix}.type'] = types.get(topic) or values[f'{prefix}.type']
    return values


def _surface(axis: Axis, stated: Mapping[str, Any]) -> Any:
    """Return the surface of an axis with the corrections that the node had made by then."""
    if axis.surface.base_sha256 != stated['base_sha256']:
        raise InputError(
            f'axis {axis.name}: the recording was judged with the surface '
            f'{stated["base_sha256"][:16]}, the file is now {axis.surface.base_sha256[:16]}: '
            'put that file back where the parameters name it'
        )
    try:
        return corrected(axis.surface, (KeptSolve(**one) for one in stated['corrections']))
    except (SurfaceError, TypeError) as error:
        raise InputError(f'axis {axis.name}: corrections of the recording: {error}') from None
