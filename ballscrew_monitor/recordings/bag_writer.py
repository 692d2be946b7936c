# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Writes a bag that rosbag2 accepts: one MCAP file and the `metadata.yaml` beside it.

The file grows as `<name>.mcap.active`, in small chunks that are flushed, so that a crash costs
little; it gets its name, and the metadata, when it is closed. Serialised messages go in as they
are. A product of a command is a `whole_bag`, which appears when it is complete or not at all; its
chunks are larger, so that fewer are to be remembered. Events of a judgement have chunks of their
own: a replay unpacks nothing else.

"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
import contextlib
import dataclasses
import enum
import errno
import os
from pathlib import Path
import tempfile
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.bag_files import OWN
from ballscrew_monitor.recordings.bulk.batches import Batch
from ballscrew_monitor.recordings.frames import EVENTS
from ballscrew_monitor.recordings.mcap_file import (
    Integers,
    McapFile,
    message_definition,
    type_hash,
)
import numpy as np
from surrogate.files import InputError, new_folder, replace_file
import yaml

ACTIVE = '.active'
METADATA, VERSION = 'metadata.yaml', 9
CHUNK_SIZE = 64 * 1024  # [bytes] of what grows while others read it
WHOLE_CHUNK_SIZE = 1024 * 1024  # [bytes] of what is complete or not there
FOREVER = {'sec': 9223372036, 'nsec': 854775807}


class Offer(enum.Enum):
    """Quality of service that the publisher of a topic offered."""

    SENSOR = ('best_effort', 'volatile', 10)
    RELIABLE = ('reliable', 'volatile', 10)
    LATCHED = ('reliable', 'transient_local', 1)

    @property
    def profile(self) -> dict[str, Any]:
        """Return the profile in the words of rosbag2, metadata version 9."""
        reliability, durability, depth = self.value
        return {
            'history': 'keep_last',
            'depth': depth,
            'reliability': reliability,
            'durability': durability,
            'deadline': dict(FOREVER),
            'lifespan': dict(FOREVER),
            'liveliness': 'automatic',
            'liveliness_lease_duration': dict(FOREVER),
            'avoid_ros_namespace_conventions': False,
        }


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Topic:
    """One recorded topic."""

    name: str
    type_name: str
    offer: Offer


class BagWriter(contextlib.AbstractContextManager['BagWriter']):
    """
    One growing bag; use it as a context manager or call `close`.

    `first` and `last` are log times of what was written so far [ns].

    """

    def __init__(
        self, directory: Path, name: str, *, compress: bool = True, chunk_size: int = CHUNK_SIZE
    ) -> None:
        """Begin `directory/name.mcap.active`, in chunks of a size [bytes]; raises InputError."""
        self.path = directory / f'{name}.mcap'
        self._topics: dict[str, dict[str, Any]] = {}  # as the metadata name them
        self._channels: dict[str, int] = {}
        self._apart: set[str] = set()  # topics whose messages have chunks of their own
        self._counts: Counter[str] = Counter()
        self._custom: dict[str, str] = {}
        self.first = self.last = 0
        self._chunk = 0
        self._file = self._open(directory)
        self._writer = McapFile(self._file, chunk_size=chunk_size, compress=compress)

    def __exit__(self, *unused: object) -> None:
        """Close the bag; what was written before an error is kept."""
        self.close()

    def add_metadata(self, texts: Mapping[str, str], *, name: str = OWN) -> None:
        """Let the file say `texts` of itself, and the metadata beside it those of this program."""
        if name == OWN:
            self._custom |= texts
        self._writer.add_metadata(name, texts)

    def add_topic(self, topic: Topic) -> None:
        """Announce a topic; raises InputError when its type is not installed."""
        definition, kind = message_definition(topic.type_name).encode(), topic.type_name
        profiles = [topic.offer.profile]
        self.announce(topic.name, kind, definition, type_hash=type_hash(kind), profiles=profiles)

    def announce(
        self,
        name: str,
        type_name: str,
        definition: bytes,
        *,
        type_hash: str,
        profiles: list[dict[str, Any]],
    ) -> None:
        """Announce a topic by all that is said of it, whether or not its type is installed."""
        offered = yaml.safe_dump(profiles, sort_keys=False)
        metadata = {'offered_qos_profiles': offered, 'topic_type_hash': type_hash}
        self._channels[name] = self._writer.add_channel(
            topic=name, kind=type_name, definition=definition, metadata=metadata
        )
        if type_name == EVENTS:
            self._apart.add(name)
        self._topics[name] = {
            'name': name,
            'type': type_name,
            'serialization_format': 'cdr',
            'offered_qos_profiles': profiles,
            'type_description_hash': type_hash,
        }

    def write(
        self,
        topic: str,
        data: bytes,
        *,
        log_time: int,
        publish_time: int,
        sequence: int | None = None,
    ) -> None:
        """Append a serialised message of an announced topic, by default numbered; times [ns]."""
        if topic in self._apart:
            self._writer.flush()
        self._writer.add_message(
            self._channels[topic],
            data,
            log_time=log_time,
            publish_time=publish_time,
            sequence=self._counts[topic] if sequence is None else sequence,
        )
        self._note(topic, 1, log_time, log_time)
        if topic in self._apart:
            self._writer.flush()
        self._chunk += len(data)
        if self._chunk >= CHUNK_SIZE:
            self._file.flush()
            self._chunk = 0

    def write_batch(self, batch: Batch) -> None:
        """Append the messages of a batch in the order of their log times; see `write_many`."""
        parts, order = list(batch.topics.values()), batch.order()
        if not len(order):
            return
        starts, contents = {}, b''  # messages of several topics may lie in the same bytes
        for part in parts:
            if id(part.data) not in starts:
                starts[id(part.data)] = len(contents)
                contents = contents + part.data if contents else part.data
        which = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
        times, sizes = (
            np.concatenate([getattr(part, name) for part in parts])
            for name in ('log_time', 'size')
        )
        begins = np.concatenate([part.begin + starts[id(part.data)] for part in parts])
        columns = (which[order], times[order], contents, begins[order], sizes[order])
        self.write_many(list(batch.topics), *columns)

    def write_many(
        self,
        topics: Sequence[str],
        which: Integers,
        times: Integers,
        data: bytes,
        begin: Integers,
        size: Integers,
    ) -> None:
        """
        Append serialised messages, each of one `which` of the `topics`, and number them.

        They lie in `data` [bytes]; `times` [ns] are those at which they were logged and count as
        published.

        """
        sequence = np.empty(len(which), np.int64)
        for number, topic in enumerate(topics):
            own = np.flatnonzero(which == number)
            if len(own):
                sequence[own] = np.arange(self._counts[topic], self._counts[topic] + len(own))
                self._note(topic, len(own), int(times[own].min()), int(times[own].max()))
        channels = np.array([self._channels[topic] for topic in topics])
        self._writer.add_messages(
            channels[which], data, begin, size, log_time=times, sequence=sequence
        )

    def _note(self, topic: str, count: int, first: int, last: int) -> None:
        """Count messages and widen the span of log times [ns]."""
        self.first = min(self.first, first) if self._counts else first
        self.last = max(self.last, last)
        self._counts[topic] += count

    @property
    def total(self) -> int:
        """Return the number of messages written."""
        return sum(self._counts.values())

    def close(self) -> None:
        """Finish the file, give it its name, write the metadata; a second call does nothing."""
        if self._file.closed:
            return
        self._writer.finish()
        self._file.close()
        Path(f'{self.path}{ACTIVE}').replace(self.path)
        text = yaml.safe_dump({'rosbag2_bagfile_information': self._metadata()}, sort_keys=False)
        replace_file(self.path.with_name(METADATA), text.encode())

    def _metadata(self) -> dict[str, Any]:
        """Return what the bag says of itself in the words of rosbag2, metadata version 9."""
        topics = [
            {'topic_metadata': topic, 'message_count': self._counts[name]}
            for name, topic in self._topics.items()
        ]
        name = self.path.name
        return {
            'version': VERSION,
            'storage_identifier': 'mcap',
            **self._span(),
            'message_count': self.total,
            'topics_with_message_count': topics,
            'compression_format': '',
            'compression_mode': '',
            'relative_file_paths': [name],
            'files': [{'path': name, **self._span(), 'message_count': self.total}],
            'custom_data': self._custom or None,
            'ros_distro': 'jazzy',
        }

    def _span(self) -> dict[str, Any]:
        """Return duration and begin; made again each time, or YAML refers to the first one."""
        return {
            'duration': {'nanoseconds': self.last - self.first},
            'starting_time': {'nanoseconds_since_epoch': self.first},
        }

    def sync(self) -> None:
        """Let the disk have all that was written; it ends the chunk."""
        self._writer.flush()
        os.fsync(self._file.fileno())

    def abandon(self) -> None:
        """Let go of a file that cannot be finished; what it holds stays as it is."""
        try:
            self._file.close()
        except OSError:  # the same that made it impossible to finish
            pass

    def _open(self, directory: Path) -> BinaryIO:
        try:
            directory.mkdir(parents=True, exist_ok=True)
            # A bag is one MCAP: an older one of this name must not stay beside its successor.
            for stale in (self.path, directory / METADATA):
                stale.unlink(missing_ok=True)
            return open(f'{self.path}{ACTIVE}', 'wb')
        except OSError as error:
            raise _unwritable(directory, error) from None


@contextlib.contextmanager
def whole_bag(directory: Path, name: str, *, compress: bool = True) -> Iterator[BagWriter]:
    """
    Yield the writer of a bag that is in `directory` when the block ends.

    It takes the place of an older one of its name. Raises InputError when it cannot be written;
    then, and when the block raises, the older one stays and nothing half-written does.

    """
    directory = directory.resolve()
    # It grows in `directory`, or beside it if that is yet to be made.
    place = directory if directory.is_dir() else directory.parent
    with contextlib.ExitStack() as stack:
        try:
            if directory.is_file():
                raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
            stack.enter_context(new_folder(place))
            growing = tempfile.TemporaryDirectory(dir=place, prefix=f'.{name}.')
        except OSError as error:
            raise _unwritable(directory, error) from None
        folder = Path(stack.enter_context(growing))
        writer = BagWriter(folder, name, compress=compress, chunk_size=WHOLE_CHUNK_SIZE)
        try:
            yield writer
            writer.close()
        finally:
            writer.abandon()
        directory.mkdir(exist_ok=True)
        (directory / METADATA).unlink(missing_ok=True)  # not of this bag until its own comes
        for file in sorted(folder.iterdir()):
            file.replace(directory / file.name)


def _unwritable(directory: Path, error: OSError) -> InputError:
    return InputError(f'output directory {directory} cannot be written: {error.strerror}')
