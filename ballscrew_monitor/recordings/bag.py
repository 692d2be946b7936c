# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Reads a bag: serialised messages in the order in which they were recorded.

A bag is a directory with one or more MCAP or sqlite3 files, named by its `metadata.yaml` if there
is one, or such a file itself. Files and messages may be compressed by zstd. Whatever is wrong
with it is one sentence in an InputError.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import heapq
from pathlib import Path
import types

from ballscrew_monitor.recordings.bag_files import kind_of, manifest, of_ros1, OWN
from ballscrew_monitor.recordings.log_times import with_believed_log_times
from ballscrew_monitor.recordings.mcap_records import read_metadata
from ballscrew_monitor.recordings.sqlite_storage import SqliteStorage
from ballscrew_monitor.recordings.storages import (
    damage_is_input,
    McapStorage,
    Message,
    Storage,
    TopicInfo,
    whole,
)
from ballscrew_monitor.recordings.unpacking import scratch_folder, unpack_file
from surrogate.files import InputError

MOST_NAMED = 5  # topics in a sentence
CONVERTED = {
    'ros1': 'rosbags-convert makes a bag of ROS 2 out of the .bag that it was made of '
    '(pip install rosbags)'
}
"""How messages of another encoding become such of ROS 2."""
WRITTEN_AGAIN = (
    'write its messages again by mcap_ros2.writer (pip install mcap-ros2-support), or save them '
    'as CSV for ballscrew import'
)


RUN_BORDERS = 'ballscrew_monitor.run_borders'
"""Key of the metadata with the stamps [ns] in the pauses between runs of a log."""


class Bag:
    """
    An opened bag: its topics and its time span; the messages are read on demand.

    `metadata` is what it says of itself; `refused` counts by topic the messages that did not
    decode, with a sentence about the first. `unread` says why parts of its file are not read.
    `promised` counts by topic the messages that its own metadata state, empty without any; those
    that are `absent` are not in its files. Topics that others are `worked_out` of need no reader
    of their own.

    """

    absent = 'counted by metadata.yaml and not in the files'
    worked_out: frozenset[str] = frozenset()
    unread: Mapping[str, str] = types.MappingProxyType({})

    def __init__(self, path: str | Path, *, salvage: bool = False) -> None:
        """
        Open the bag at `path`; raises InputError when it is not readable to its end.

        With `salvage` an MCAP file that has lost its end is read up to there, and of a split bag
        the files that are whole; `notes` says how much that is.

        """
        self.path = Path(path)
        self.refused: dict[str, tuple[int, str]] = {}
        self.remarks: list[str] = []  # of those who read it
        self._salvage = salvage
        self._missing: list[str] = []
        files, custom, counts = manifest(self.path, salvage=salvage)
        self._is_split = len(files) > 1
        self.storages: Sequence[Storage] = [
            storage for storage in map(self._open, files) if storage is not None
        ]
        self.files = [storage.file for storage in self.storages]
        self.topics: dict[str, TopicInfo] = {}
        for storage in self.storages:
            for name, info in storage.topics.items():
                count = info.count + (self.topics[name].count if name in self.topics else 0)
                self.topics[name] = dataclasses.replace(info, count=count)
        if not any(info.count for info in self.topics.values()):
            reason = '; '.join(self.notes) or 'at least one is needed'
            raise InputError(f'bag {self.path} holds no message, {reason}')
        held = [(name, info) for name, info in sorted(self.topics.items()) if info.count]
        if all(info.encoding not in ('cdr', '') for _, info in held):
            name, info = held[0]
            raise InputError(f'bag {self.path}: topic {name} {other_encoding(info.encoding)}')
        self._compare(counts)
        self.metadata = self._own_metadata() | custom
        self.storages, disbelief = with_believed_log_times(self.path, self.storages)
        self.remarks += filter(None, [disbelief])
        spans = [storage.span for storage in self.storages if storage.span[1]]
        self.start_time = min(span[0] for span in spans)
        self.end_time = max(span[1] for span in spans)
        self.promised: Mapping[str, int] = counts

    @property
    def duration(self) -> float:
        """Return the time from the first to the last message [s]."""
        return (self.end_time - self.start_time) * 1e-9

    @property
    def types(self) -> dict[str, str]:
        """Return the message type of each topic."""
        return {name: info.type_name for name, info in self.topics.items()}

    @property
    def run_borders(self) -> list[int]:
        """Return stamps [ns] in the pauses between runs of the log, each judged apart."""
        return [int(border) for border in self.metadata.get(RUN_BORDERS, '').split()]

    @property
    def notes(self) -> list[str]:
        """Return a sentence for each file and topic of which not all could be read so far."""
        salvaged = [storage.note for storage in self.storages if storage.note]
        refused = [
            sentence + (f'; {count} such messages were refused' if count > 1 else '')
            for count, sentence in self.refused.values()
        ]
        return [*self._missing, *salvaged, *refused, *self.remarks]

    def refuse(self, message: Message, reason: str) -> str:
        """Count a message that does not decode; return the sentence about it."""
        at = (message.log_time - self.start_time) * 1e-9
        sentence = (
            f'bag {self.path}: the message of {message.topic} at {at:.3f} s does not decode as '
            f'{self.topics[message.topic].type_name} ({len(message.data)} bytes, {reason})'
        )
        count, first = self.refused.get(message.topic, (0, sentence))
        self.refused[message.topic] = count + 1, first
        return sentence

    def remark(self, sentence: str) -> None:
        """Keep what a reader says of the bag, once."""
        if sentence not in self.remarks:
            self.remarks.append(sentence)

    def require(self, topics: Mapping[str, str]) -> None:
        """Raise InputError unless the bag holds messages of all `topics`, given with type."""
        for name, type_name in topics.items():
            if name not in self.topics:
                raise InputError(
                    f'bag {self.path}: topic {name} ({type_name or "any type"}) is missing, the '
                    f'bag holds {", ".join(sorted(self.topics))}'
                )
            problem = _objection(self.topics[name], type_name)
            if problem:
                raise InputError(f'bag {self.path}: topic {name} {problem}')

    def as_written(self, topics: Collection[str] | None = None) -> Iterator[Message]:
        """Yield messages of `topics` in the order of the files; raises InputError on damage."""
        wanted = set(self.topics if topics is None else topics)
        for storage in self.storages:
            yield from map(whole, storage.messages(wanted, as_written=True))

    def messages(self, topics: Collection[str] | None = None) -> Iterator[Message]:
        """Yield messages of `topics` (None: all) by log time; raises InputError on damage."""
        wanted = set(self.topics if topics is None else topics)
        with contextlib.ExitStack() as stack:
            streams = [
                stack.enter_context(contextlib.closing(storage.messages(wanted)))
                for storage in self.storages
            ]
            yield from map(whole, heapq.merge(*streams, key=lambda message: message.log_time))

    def _open(self, file: Path) -> Storage | None:
        """Return an opened file; None for one that is lost, if that is allowed."""
        try:
            return self._storage(file)
        except InputError as error:
            if not self._salvage or not self._is_split:
                raise
            self._missing.append(f'{error}; it is left out')
            return None

    def _storage(self, file: Path) -> Storage:
        if not file.is_file():
            raise InputError(
                f'bag {self.path}: its metadata.yaml names {file.name}, which is missing'
            )
        with damage_is_input(file):
            kind = kind_of(file)
            if kind == 'zstd':
                file = unpack_file(file, scratch_folder(self), salvage=self._salvage)
                kind = kind_of(file)
        if kind == 'rosbag1':
            raise of_ros1(file)
        if kind == 'sqlite3':
            return SqliteStorage(file)
        return McapStorage(file, salvage=self._salvage)

    def _compare(self, stated: Mapping[str, int]) -> None:
        """Note of which topics the files hold another number of messages than is stated."""
        held = {name: info.count for name, info in self.topics.items()}
        names = [
            name
            for name in sorted(stated.keys() | held.keys())
            if stated.get(name, 0) != held.get(name, 0)
        ]
        if not stated or not names:
            return
        pairs = ', '.join(
            f'{stated.get(name, 0)} and {held.get(name, 0)} of {name}'
            for name in names[:MOST_NAMED]
        )
        more = (
            f', and others of {len(names) - MOST_NAMED} more topics' if names[MOST_NAMED:] else ''
        )
        self.remarks.append(
            f'bag {self.path}: its metadata.yaml counts other messages than its files hold: '
            f'{pairs}{more}'
        )

    def _own_metadata(self) -> dict[str, str]:
        """Return the record of this program in the first MCAP file, if it is whole."""
        first = self.storages[0]
        if not isinstance(first, McapStorage) or not first.is_indexed or first.note:
            return {}
        metadata: dict[str, str] = {}
        try:
            with damage_is_input(first.file), first.file.open('rb') as stream:
                for record in read_metadata(stream):
                    metadata |= record.metadata if record.name == OWN else {}
        except InputError as error:
            if not self._salvage:
                raise
            self._missing.append(f'{error}; what it says of itself is left out')
        return metadata


def _objection(info: TopicInfo, type_name: str) -> str:
    """Return what is wrong with a topic that must be of a type, nothing if it is right."""
    if info.encoding != 'cdr':
        return other_encoding(info.encoding)
    if not info.type_name:
        return 'states no type: its schema is missing'
    if info.type_name != type_name:
        return f'is of type {info.type_name}, it must be {type_name}'
    return '' if info.count else 'holds no message, at least one is needed'


def other_encoding(encoding: str) -> str:
    """Return what is said of a topic of another encoding than that of ROS 2."""
    how = CONVERTED.get(encoding, WRITTEN_AGAIN)
    return f'is encoded as {encoding or "nothing"}, it must be cdr, that of ROS 2: {how}'
