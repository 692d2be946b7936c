# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The recording that a node made of itself: the steps of its judgement in their order.

Its journal says in which bursts messages were taken, when ticks came, what was lost, and all about
each axis from time to time. So a replay gives what the node gave, bit for bit, and proves it: each
time the node wrote down what it remembered of an axis, the replay must remember the same.

"""

from collections.abc import Iterable, Iterator, Mapping
import dataclasses
from typing import Any

from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.core.inputs import Source, Why
from ballscrew_monitor.judge.dump import dump, restored
from ballscrew_monitor.judge.full_point import corrected, KeptSolve
from ballscrew_monitor.judge.records import MEMORY_VERSION, NOT_KNOWN, REFUSAL, SAMPLE, TICK
from ballscrew_monitor.recordings.axis_run import AxisRun
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import batches, END
from ballscrew_monitor.recordings.bulk.chunks import Integers, Messages
from ballscrew_monitor.recordings.bulk.decode import Reader, TopicDecoder, UNDECODABLE
from ballscrew_monitor.recordings.bulk.events import (
    blank,
    CHECK,
    Events,
    joined,
    Notes,
    some,
    ticks,
)
from ballscrew_monitor.recordings.bulk.order import OnDone
from ballscrew_monitor.recordings.frames import STRING, VERSION
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, build_axis, settings_of
import numpy as np
from rclpy.serialization import deserialize_message
from surrogate.files import InputError
from surrogate.limits import read_json
from surrogate.surface import SurfaceError

JOURNAL = '/journal'
OTHER_VERSION = (
    'the node that made this recording was of another version: the recording is judged as an '
    'ordinary bag, by log times'
)
SHAPES: dict[str, dict[str, Any]] = {
    'axis': {'axis': str, 'version': int},
    'tick': {'stamp': int},
    'lost': {'topic': str, 'count': int | None},
}
"""What entries hold, by their kind."""
DESCRIPTION: dict[str, Any] = {
    **dict.fromkeys(('values', 'topics', 'surface', 'monitor'), dict),
    **{'because': str, 'loss_unknown': list},
}
"""What else the description of an axis holds."""
Noted = tuple[int, Mapping[str, Any]]
"""The place of an entry of the journal, and the entry."""


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
    return _values_of(bag, _first_entries(bag))


def _values_of(bag: Bag, described: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    found = {entry['axis']: _values(entry, bag.types) for entry in described}
    values = parameters.defaults(list(found))
    for one in found.values():
        values |= one
    return values | {'axes': list(found)}


def is_as_recorded(bag: Bag, values: Mapping[str, Any]) -> bool:
    """
    Tell whether a bag is the recording of a node, to be judged with the node's parameters.

    The journal of another version says nothing of the memory: such a bag is judged as any other
    bag is, and has a remark.

    """
    if not journal_of(bag):
        return False
    described = _first_entries(bag)
    if not all(map(_is_known, described)):
        bag.remark(OTHER_VERSION)
        return False
    return _values_of(bag, described) == dict(values)


def _is_known(entry: Mapping[str, Any]) -> bool:
    """Tell whether the description of an axis, and the memory in it, are of the version of now."""
    memory = entry.get('monitor')
    known = not isinstance(memory, dict) or memory.get('version') == MEMORY_VERSION
    return bool(entry['version'] == VERSION and known)


def _first_entries(bag: Bag) -> list[Mapping[str, Any]]:
    """Return the first description of each axis; raises InputError if there is none."""
    found: dict[str, Mapping[str, Any]] = {}
    for entry in _journal_of(bag):
        if entry['kind'] == 'axis':
            if entry['axis'] in found:
                break
            found[entry['axis']] = entry
    if not found:
        raise InputError(f'bag {bag.path}: its journal describes no axis')
    return list(found.values())


def _journal_of(bag: Bag) -> Iterator[Mapping[str, Any]]:
    """Yield the entries of a journal in the order of the file."""
    journal = journal_of(bag)
    for batch in batches(bag, [journal], as_written=True):
        if journal in batch.topics:
            yield from (entry for _, entry in _noted(batch.topics[journal], journal))


def _noted(messages: Messages, journal: str) -> Iterator[Noted]:
    """Yield messages of a journal as entries, each with its place."""
    messages = messages.some(np.argsort(messages.place))
    for place, data in zip(messages.place.tolist(), messages.contents(), strict=True):
        yield place, _entry_of(data, journal)


class OwnRecording:
    """The events of a recording, and how often it proved the replay right and wrong."""

    def __init__(self, bag: Bag, notes: Notes) -> None:
        """Read a bag that has a journal; events refer to `notes`."""
        self.runs: list[AxisRun] = []
        self._bag, self._notes = bag, notes
        self._checks: dict[int, Mapping[str, Any]] = {}  # entries by their places
        self._journal = journal_of(bag)
        self._proven = self._refuted = 0
        self._numbers: dict[str, int] = {}  # of the axes that are described, among the runs
        self._described: dict[str, Mapping[str, Any]] = {}
        self._decoders: dict[str, TopicDecoder] = {}
        self._lost: dict[str, int] = {}  # before the next message of a topic
        self._ahead = 0  # [ns] that stamps may be ahead beside max_future
        self._several: set[tuple[str, str]] = set()  # inputs that several publishers send

    def events(self, on_done: OnDone) -> Iterator[Events]:
        """
        Yield the events in the order in which the node took them; each is judged before the next.

        Raises InputError for a recording that cannot be replayed here. `on_done` is told which
        share is done [-].

        """
        for batch in batches(self._bag, self._bag.topics.keys(), as_written=True):
            yield from self._segments(batch.topics)
            on_done(min(max(batch.done, 0.0), 1.0))
        if self._proven + self._refuted:
            self._bag.remark(self._proof())

    def _segments(self, topics: dict[str, Messages]) -> Iterator[Events]:
        """Yield the events of a batch, in parts between changes of what is read."""
        journal = topics.pop(self._journal, None)
        begin, waiting = -1, list[Noted]()
        for place, entry in [] if journal is None else _noted(journal, self._journal):
            if not self._changes(entry):
                waiting.append((place, entry))
                continue
            yield self._ordered(topics, begin, place, waiting)
            begin, waiting = place, []
            self._change(entry)
        yield self._ordered(topics, begin, END, waiting)

    def _changes(self, entry: Mapping[str, Any]) -> bool:
        """Tell whether an entry changes what is read, so that all before is judged first."""
        if entry['kind'] != 'axis':
            return entry['kind'] in ('hole', 'reading')
        return entry['because'] != 'time' or entry['axis'] not in self._numbers

    def _change(self, entry: Mapping[str, Any]) -> None:
        """Read on as an entry says."""
        if entry['kind'] == 'hole':  # until each axis is described again
            self._numbers, self._described, self._decoders = {}, {}, {}
            return
        if entry['kind'] == 'reading':
            self._read(entry)
        else:
            self._describe(entry)
        readers: dict[str, list[Reader]] = {}
        for number in self._numbers.values():
            axis = self.runs[number].axis
            for one in axis.inputs:  # by the full names that the node stated
                readers.setdefault(one.topic, []).append((number, axis, one))
        self._decoders = {
            topic: TopicDecoder(self._bag, wanted, self._notes, ahead=self._ahead)
            for topic, wanted in readers.items()
        }

    def _read(self, stated: Mapping[str, Any]) -> None:
        """Read messages from now on as the node said that it does."""
        self._ahead = int(stated['ahead'])
        self._several = {(axis, one) for axis, one in stated['several']}

    def _ordered(
        self, topics: dict[str, Messages], begin: int, end: int, noted: list[Noted]
    ) -> Events:
        """Return the events between two places, in the order in which the node took them."""
        parts = [self._of_journal(place, entry) for place, entry in noted]
        bursts = [np.zeros(len(part), dtype=np.int64) for part in parts]
        for topic, decoder in self._decoders.items():
            messages = topics.get(topic)
            if messages is None:
                continue
            some = np.flatnonzero((messages.place > begin) & (messages.place < end))
            some = some[np.argsort(messages.place[some])]
            messages = messages.some(some)
            events = decoder.events(messages)
            at = np.searchsorted(messages.place, events['place'])
            events['lost'] = self._losses(topic, messages.place, noted)[at]
            self._refuse_several(events)
            parts.append(events)
            bursts.append(messages.sequence[at])
        return as_taken(joined(parts), np.concatenate([np.zeros(0, np.int64), *bursts]))

    def _refuse_several(self, events: Events) -> None:
        """Refuse the samples of inputs that several publishers send, where one is allowed."""
        numbers = {run.axis.name: number for number, run in enumerate(self.runs)}
        for name, source in self._several:
            if self.runs[numbers[name]].axis.one_source:
                mine = (events['axis'] == numbers[name]) & (events['kind'] == SAMPLE)
                mine &= events['source'] == Source[source.upper()]
                events['kind'][mine], events['why'][mine] = REFUSAL, int(Why.SEVERAL)
                events['stamp'][mine] = events['log_time'][mine]

    def _losses(self, topic: str, places: Integers, noted: list[Noted]) -> Integers:
        """Return how many messages were lost before each; that it is not known holds on."""
        found = np.zeros(len(places), dtype=np.int64)
        changes = [(-1, self._lost.get(topic, 0))]
        changes += [
            (place, NOT_KNOWN if entry['count'] is None else entry['count'])
            for place, entry in noted
            if entry['kind'] == 'lost' and entry['topic'] == topic
        ]
        for place, count in changes:
            first = int(np.searchsorted(places, place))
            if count == NOT_KNOWN:
                found[first:] = NOT_KNOWN
            elif first < len(places):
                found[first:], found[first] = 0, count
            self._lost[topic] = count if count == NOT_KNOWN or first == len(places) else 0
        return found

    def _of_journal(self, place: int, entry: Mapping[str, Any]) -> Events:
        """Return an entry of the journal that changes nothing as events to be judged."""
        if entry['kind'] == 'tick':
            axes = list(self._numbers.values())
            return ticks(np.full(len(axes), int(entry['stamp'])), place=place, axis=axes)
        if entry['kind'] != 'axis':
            return joined([])
        self._checks[place] = entry
        return blank(1, place=place, axis=self._numbers[entry['axis']], kind=CHECK)

    def _check(self, place: int) -> None:
        """Hold what is remembered of an axis against what the node says it remembered."""
        entry = self._checks.pop(place)
        run, told = self.runs[self._numbers[entry['axis']]], entry.get('monitor')
        if isinstance(told, dict) and dump(run.axis.monitor)['records'] == told.get('records'):
            self._proven += 1
            return
        self._refuted += 1
        self._describe(entry)

    def _describe(self, entry: Mapping[str, Any]) -> None:
        """Make an axis as it is described, and go on with it."""
        try:
            name = entry['axis']
            self._lost = dict.fromkeys(entry['loss_unknown'], NOT_KNOWN)
            self._read(entry['reading'])
            axis = self._rebuilt(entry)
        except InputError:
            raise
        except (KeyError, TypeError, AttributeError, ValueError, IndexError) as error:
            raise InputError(f'{self._journal}: an axis is described badly: {error}') from None
        self._described[name] = entry
        known = [number for number, run in enumerate(self.runs) if run.axis.name == name]
        if known:
            self.runs[known[0]].change(axis)
        else:
            self.runs.append(AxisRun(axis, self._notes, self._check))
        self._numbers[name] = known[0] if known else len(self.runs) - 1

    def _rebuilt(self, entry: Mapping[str, Any]) -> Axis:
        """Return an axis as an entry describes it; the same parts as before are not made again."""
        name, values = entry['axis'], _values(entry, self._bag.types)
        before = self._described.get(name)
        parts = ('values', 'topics', 'surface')
        if before is None or any(before[part] != entry[part] for part in parts):
            axis = build_axis(name, values)
            axis.surface = _surface(axis, entry['surface'])
        else:
            axis = dataclasses.replace(self.runs[self._numbers[name]].axis)
        settings = settings_of(name, values, axis.surface)
        axis.monitor = restored(entry['monitor'], axis.surface, settings)
        return axis

    def _proof(self) -> str:
        """Return how often the replay was held against what the node remembered."""
        held = self._proven + self._refuted
        if self._refuted:
            return (
                f'the replay differs from what the node said of itself at {self._refuted} of '
                f'{held} times that it did'
            )
        return f'the replay is what the node judged: it agrees with all {held} notes of the node'


def as_taken(events: Events, bursts: Integers) -> Events:
    """
    Return events in the order in which a node takes them, see `core.inputs.ordered`.

    Messages of one burst come by the place at which their stamp came first, then by source.

    """
    by_place = np.lexsort((events['axis'], events['place']))
    events, bursts = some(events, by_place), bursts[by_place]
    count = np.arange(len(events))
    other = bursts != np.roll(bursts, 1)
    alone = events['kind'] >= TICK
    burst = np.cumsum(other | alone | np.roll(alone, 1))
    order = np.lexsort((count, events['stamp'], burst))
    new = np.ones(len(order), dtype=bool)
    groups, stamps = burst[order], events['stamp'][order]
    new[1:] = (groups[1:] != groups[:-1]) | (stamps[1:] != stamps[:-1])
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.maximum.accumulate(np.where(new, count, 0))]
    return some(events, np.lexsort((count, events['source'], first, burst)))


def _entry_of(data: bytes, topic: str) -> Mapping[str, Any]:
    try:
        text = deserialize_message(data, message_class(STRING)).data
        entry: Mapping[str, Any] = read_json(text)
        kind = entry['kind']
        shape = SHAPES.get(kind, {}) if isinstance(kind, str) else {}
        if kind == 'axis' and entry['version'] == VERSION:
            shape = shape | DESCRIPTION
        wrong = [name for name, kinds in shape.items() if not _is_one(entry[name], kinds)]
        if wrong:
            raise ValueError(f'{", ".join(wrong)} of another kind')
    except (*UNDECODABLE, KeyError, TypeError, AttributeError) as error:
        raise InputError(f'{topic}: no entry of a journal ({error})') from None
    return entry


def _is_one(value: Any, kinds: Any) -> bool:
    return isinstance(value, kinds) and not (isinstance(value, int) and abs(value) >= END)


def _values(entry: Mapping[str, Any], types: Mapping[str, str]) -> dict[str, Any]:
    """
    Return the parameters of an axis, its topics by full name and with their types.

    Raises InputError for one that no node has.

    """
    values, rows = dict(entry['values']), parameters.table([entry['axis']])
    for source, topic in entry['topics'].items():
        prefix = f'{entry["axis"]}.{source}'
        if f'{prefix}.type' not in rows or not isinstance(topic, str):
            raise InputError(f'axis {entry["axis"]}: the topic of {source} is {topic!r}')
        values[f'{prefix}.topic'] = topic
        values[f'{prefix}.type'] = types.get(topic) or values.get(f'{prefix}.type', '')
    parameters.check(rows, {name: value for name, value in values.items() if name in rows})
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
