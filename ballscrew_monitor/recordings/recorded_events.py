# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The recording that a node made of itself: the events that it judged, and how its axes stood.

A replay is the step over these events, from the memory that the first snapshots hold: so it gives
what the node gave, to the last bit. Where the memory is of another version, or other parameters
are asked for, it begins with a fresh memory.

"""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
from typing import Any
import weakref

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.judge.full_point import corrected, KeptSolve
from ballscrew_monitor.judge.records import ALL_AXES, EVENTS_VERSION, MEMORY_VERSION
from ballscrew_monitor.judge.snapshot import restored
from ballscrew_monitor.recordings.axis_run import AxisRun
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import batches
from ballscrew_monitor.recordings.bulk.events import Events, Notes, some, TICK_SOURCE
from ballscrew_monitor.recordings.bulk.order import OnDone
from ballscrew_monitor.recordings.event_messages import EventMessage, events_of, read
from ballscrew_monitor.recordings.frames import EVENTS, HOLE, PERIODIC
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, build_axis, load_surface, settings_of
import numpy as np
from surrogate.files import InputError
from surrogate.files.limits import read_json
from surrogate.surface import Surface, SurfaceError

READING = (
    *(
        f'{source.name.lower()}.{leaf}'
        for source in Source
        for leaf in ('topic', 'type', 'field', 'unit', 'scale', 'offset')
    ),
    *('load.source', 'handedness', 'torque.constant', 'torque.rated', 'torque.gear_ratio'),
    *('max_future', 'one_source'),
)
"""Parameters of an axis by which messages become events."""
FRESH = (
    'the node that made this recording remembered an axis in another form (version {}, known is '
    '{}): its events are judged with a fresh memory'
)
OTHERS = (
    'the parameters are not those of the node: its events are judged with a fresh memory, and '
    'without what people did meanwhile'
)
DROPPED = (
    'the recording has a hole, in which the node could not hand over its events: the replay goes '
    'on at the next snapshots'
)
SHAPE: dict[str, Any] = {
    **{'axis': str, 'number': int, 'because': str},
    **dict.fromkeys(('values', 'topics', 'surface', 'memory'), dict),
}
"""What a snapshot holds."""
Snapshot = Mapping[str, Any]
_FIRST: weakref.WeakKeyDictionary[Bag, tuple[EventMessage, dict[str, Snapshot]]] = (
    weakref.WeakKeyDictionary()
)
"""The first snapshots of bags in use."""


def events_topic(bag: Bag) -> str:
    """Return the topic of the events in a bag; empty: no node recorded it."""
    topics = [name for name, info in bag.topics.items() if info.type_name == EVENTS]
    return topics[0] if len(topics) == 1 else ''


def recorded_values(bag: Bag) -> dict[str, Any]:
    """
    Return the parameters with which a node judged what it recorded, topics by their full names.

    Raises InputError for a recording without a snapshot.

    """
    return _values_of(bag, _first(bag)[1])


def judged_by_events(bag: Bag, values: Mapping[str, Any]) -> bool:
    """
    Return True if a bag holds events of a node that can be judged with parameters `values`.

    Where they cannot, and the bag holds the messages of the inputs, it has a remark. Raises
    InputError if it does not hold them.

    """
    if not events_topic(bag):
        return False
    message, snapshots = _first(bag)
    if why := _objection(bag, message, _values_of(bag, snapshots), values):
        missing = [topic for topic in parameters.input_topics(values) if topic not in bag.topics]
        if missing:
            raise InputError(
                f'bag {bag.path}: {why}, and the recording holds no messages of '
                f'{", ".join(missing)} (record_inputs was false)'
            )
        bag.remark(f'{why}: the recording is judged from the messages of its inputs, by log times')
        return False
    return True


def _objection(
    bag: Bag, message: EventMessage, recorded: Mapping[str, Any], values: Mapping[str, Any]
) -> str:
    """Return why the events of a recording do not do for parameters `values`, if they do not."""
    if message.events_version != EVENTS_VERSION:
        return f'its events are of version {message.events_version}, known is {EVENTS_VERSION}'
    asked = parameters.with_types(values, bag.types)
    inputs = {source.name.lower(): source for source in Source}
    for axis in values['axes']:
        if axis not in recorded['axes']:
            return f'the node had no axis {axis}'
        for name in ('tick_period', *(f'{axis}.{leaf}' for leaf in READING)):
            own, other = recorded[name], asked[name]
            if name.endswith('.topic'):
                own, other = (topic and parameters.absolute(topic) for topic in (own, other))
            source = inputs.get(name.removeprefix(f'{axis}.').partition('.')[0])
            if own != other and (source is None or parameters.is_configured(axis, asked, source)):
                return f'{name} was {own!r} and {other!r} is asked for, which reads other numbers'
        surface = [f'{axis}.{leaf}' for leaf in ('surface', 'screw', 'oil')]
        if any(values[name] != recorded[name] for name in surface) and (
            load_surface(axis, values).lead != load_surface(axis, recorded).lead
        ):
            return f'axis {axis} had a screw of another lead'
    return ''


def _first(bag: Bag) -> tuple[EventMessage, dict[str, Snapshot]]:
    """Return the first message with snapshots, and these by axis; raises InputError without."""
    if bag not in _FIRST:
        messages = (read(message.data) for message in bag.as_written([events_topic(bag)]))
        message = next((message for message in messages if message.snapshots), None)
        if message is None:
            raise InputError(f'bag {bag.path}: its events hold no snapshot of an axis')
        _FIRST[bag] = message, _snapshots(message)
    return _FIRST[bag]


def _snapshots(message: EventMessage) -> dict[str, Snapshot]:
    """Return the snapshots of a message by axis; raises InputError for any other text."""
    snapshots: dict[str, Snapshot] = {}
    for text in message.snapshots:
        snapshot = read_json(text)
        wrong = [
            name
            for name, kind in SHAPE.items()
            if not isinstance(snapshot, dict) or not isinstance(snapshot.get(name), kind)
        ]
        if wrong or not 0 <= snapshot['number'] < ALL_AXES:
            raise InputError(f'message {message.number} of events: a snapshot has no {wrong}')
        snapshots[snapshot['axis']] = snapshot
    return snapshots


class RecordedEvents:
    """The events of a recording, and the runs of its axes."""

    def __init__(self, bag: Bag, notes: Notes, values: Mapping[str, Any]) -> None:
        """Judge a bag that `judged_by_events` with parameters `values`; events have `notes`."""
        self.runs: list[AxisRun] = []
        self._bag, self._notes, self._topic = bag, notes, events_topic(bag)
        message, snapshots = _first(bag)
        self._own = _values_of(bag, snapshots) == dict(values)
        self._values = values
        self._remembers = self._own and message.memory_version == MEMORY_VERSION
        self._snapshots: dict[str, Snapshot] = {}  # the last of each axis
        self._numbers = np.full(ALL_AXES + 1, -1)  # of runs, by those of axes
        self._numbers[ALL_AXES] = ALL_AXES
        self._read = np.ones((ALL_AXES + 1, TICK_SOURCE + 1), bool)  # inputs of runs
        self._next: int | None = None  # number of the next message; None: wait for snapshots
        if not self._own:
            bag.remark(OTHERS)
        elif not self._remembers:
            bag.remark(FRESH.format(message.memory_version, MEMORY_VERSION))

    def events(self, on_done: OnDone) -> Iterator[Events]:
        """
        Yield the events in the order in which the node took them; each is judged before the next.

        Raises InputError for a recording that cannot be replayed here. `on_done` is told which
        share is done [-].

        """
        for batch in batches(self._bag, [self._topic], as_written=True):
            parts: list[EventMessage] = []
            messages = batch.topics.get(self._topic)
            contents = [] if messages is None else messages.contents()
            for message in map(read, contents):
                if self._next is not None and message.number != self._next:
                    self._miss(message)
                snapshots = _snapshots(message)
                if self._next is None and not (
                    snapshots and snapshots.keys() >= self._snapshots.keys()
                ):
                    continue
                if changed := [
                    snapshot for snapshot in snapshots.values() if self._changes(snapshot)
                ]:
                    yield self._of_runs(parts)  # judged before the axes change
                    parts = []
                    for snapshot in changed:
                        self._take_up(snapshot)
                self._next = message.number + 1
                parts.append(message)
            yield self._of_runs(parts)
            on_done(min(max(batch.done, 0.0), 1.0))

    def _miss(self, message: EventMessage) -> None:
        """Wait for snapshots: messages before this one are lost."""
        self._bag.remark(
            f'messages of events before number {message.number} are lost: the replay goes on at '
            'the next snapshots'
        )
        self._next = None

    def _changes(self, snapshot: Snapshot) -> bool:
        """Return True if an axis stands otherwise than its events alone would let it."""
        name, because = snapshot['axis'], snapshot['because']
        if name not in self._snapshots:
            return self._own or name in self._values['axes']
        if because == HOLE:
            self._bag.remark(DROPPED)
        return self._own and (because != PERIODIC or self._next is None)

    def _take_up(self, snapshot: Snapshot) -> None:
        """Go on with an axis as it stands in a snapshot."""
        name = snapshot['axis']
        try:
            axis = self._axis_of(name, snapshot)
        except InputError:
            raise
        except (KeyError, TypeError, AttributeError, ValueError, IndexError) as error:
            raise InputError(f'{self._topic}: a snapshot of {name} is damaged: {error}') from None
        number = next((at for at, run in enumerate(self.runs) if run.axis.name == name), None)
        if number is None:
            number = len(self.runs)
            self.runs.append(AxisRun(axis, self._notes))
            self._read[number, :TICK_SOURCE] = False
            self._read[number, [*axis.topics]] = True
        else:
            self.runs[number].change(axis)
        self._snapshots[name] = snapshot
        self._numbers[snapshot['number']] = number

    def _axis_of(self, name: str, snapshot: Snapshot) -> Axis:
        """Return an axis as it stands; the same parts as before are not made again."""
        if not self._own:
            return build_axis(name, parameters.with_types(self._values, self._bag.types))
        values, before = _values(snapshot, self._bag.types), self._snapshots.get(name)
        known = [run.axis for run in self.runs if run.axis.name == name]
        parts = ('values', 'topics', 'surface')
        if before is None or any(before[part] != snapshot[part] for part in parts):
            axis = build_axis(name, values)
            axis.surface = _surface(axis, snapshot['surface'])
        else:
            axis = dataclasses.replace(known[0])
        settings = settings_of(name, values, axis.surface)
        if self._remembers:
            axis.monitor = restored(snapshot['memory'], axis.surface, settings)
        else:
            axis.monitor = known[0].monitor if known else axis.monitor
            axis.monitor.use_surface(axis.surface)
            axis.monitor.settings = settings
        return axis

    def _of_runs(self, messages: Sequence[EventMessage]) -> Events:
        """Return the events of the axes that are judged, with the numbers of their runs."""
        events = events_of(messages, self._notes)
        numbers = self._numbers[events['axis']]
        events['axis'] = np.maximum(numbers, 0)
        wanted = numbers >= 0
        if not self._own:
            wanted &= self._read[numbers, events['source']]
        return events if wanted.all() else some(events, wanted)


def _values_of(bag: Bag, snapshots: Mapping[str, Snapshot]) -> dict[str, Any]:
    by_axis = {name: _values(snapshot, bag.types) for name, snapshot in snapshots.items()}
    values = parameters.defaults(list(by_axis))
    for own in by_axis.values():
        values |= own
    return values | {'axes': list(by_axis)}


def _values(snapshot: Snapshot, types: Mapping[str, str]) -> dict[str, Any]:
    """
    Return the parameters of an axis, its topics by full name and with their types.

    Raises InputError for one that no node has.

    """
    values, rows = dict(snapshot['values']), parameters.table([snapshot['axis']])
    for source, topic in snapshot['topics'].items():
        prefix = f'{snapshot["axis"]}.{source}'
        if f'{prefix}.type' not in rows or not isinstance(topic, str):
            raise InputError(f'axis {snapshot["axis"]}: the topic of {source} is {topic!r}')
        values[f'{prefix}.topic'] = topic
        values[f'{prefix}.type'] = types.get(topic) or values.get(f'{prefix}.type', '')
    parameters.check(rows, {name: value for name, value in values.items() if name in rows})
    return values


def _surface(axis: Axis, stated: Mapping[str, Any]) -> Surface:
    """Return the surface of an axis with the corrections that the node had made by then."""
    if axis.surface.base_sha256 != stated['base_sha256']:
        raise InputError(
            f'axis {axis.name}: the recording was judged with the surface '
            f'{stated["base_sha256"][:16]}, the file is now {axis.surface.base_sha256[:16]}: '
            'put that file back where the parameters name it'
        )
    try:
        return corrected(
            axis.surface, (KeptSolve(**correction) for correction in stated['corrections'])
        )
    except (SurfaceError, TypeError) as error:
        raise InputError(f'axis {axis.name}: corrections of the recording: {error}') from None
