# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Reads a bag: serialised messages in the order in which they were recorded.

A bag is a directory with one or more MCAP files, named by its `metadata.yaml` if there is one, or
an MCAP file itself. Whatever is wrong with it is one sentence in an InputError.

"""

from collections.abc import Collection, Iterator, Mapping
import contextlib
import dataclasses
import heapq
from pathlib import Path
import struct
from typing import Any

from mcap.exceptions import McapError
from mcap.reader import make_reader, McapReader
from surrogate.files import InputError
import yaml
from zstandard import ZstdError

# What the reader is known to raise for a file that is not as it should be.
DAMAGE = (
    McapError,
    ValueError,
    KeyError,
    IndexError,
    TypeError,
    AttributeError,
    EOFError,
    struct.error,
    MemoryError,
    OverflowError,
    RuntimeError,
    ZstdError,
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Message:
    """One serialised message; times [ns]."""

    topic: str
    data: bytes
    log_time: int
    publish_time: int
    sequence: int = 0


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class TopicInfo:
    """Type, encoding and number of messages of one topic."""

    type_name: str
    encoding: str
    count: int


class Bag:
    """An opened bag: its topics and its time span; the messages are read on demand."""

    def __init__(self, path: str | Path) -> None:
        """Open the bag at `path`; raises InputError when it is not readable to its end."""
        self.path = Path(path)
        self.files = _mcap_files(self.path)
        self.topics: dict[str, TopicInfo] = {}
        spans = [self._read_summary(file) for file in self.files]
        spans = [span for span in spans if span[1]]
        if not self.topics or not spans:
            raise InputError(f'bag {self.path} holds no message, at least one is needed')
        self.start_time = min(span[0] for span in spans)
        self.end_time = max(span[1] for span in spans)

    @property
    def duration(self) -> float:
        """Return the time from the first to the last message [s]."""
        return (self.end_time - self.start_time) * 1e-9

    @property
    def types(self) -> dict[str, str]:
        """Return the message type of each topic."""
        return {name: info.type_name for name, info in self.topics.items()}

    def require(self, topics: Mapping[str, str]) -> None:
        """Raise InputError unless the bag holds messages of all `topics`, given with type."""
        for name, type_name in topics.items():
            if name not in self.topics:
                raise InputError(
                    f'bag {self.path}: topic {name} ({type_name or "any type"}) is missing, the '
                    f'bag holds {", ".join(sorted(self.topics))}'
                )
            found = self.topics[name]
            if found.type_name != type_name:
                raise InputError(
                    f'bag {self.path}: topic {name} is of type {found.type_name}, '
                    f'it must be {type_name}'
                )
            if found.encoding != 'cdr':
                raise InputError(
                    f'bag {self.path}: topic {name} is encoded as {found.encoding}, it must be cdr'
                )
            if not found.count:
                raise InputError(
                    f'bag {self.path}: topic {name} holds no message, at least one is needed'
                )

    def messages(
        self, topics: Collection[str] | None = None, *, as_written: bool = False
    ) -> Iterator[Message]:
        """
        Yield messages of `topics` (None: all) by log time; raises InputError on damage.

        Or `as_written`, file after file.

        """
        wanted = list(self.topics if topics is None else topics)
        if as_written:
            for file in self.files:
                with contextlib.ExitStack() as stack:
                    yield from self._read(stack, file, wanted, as_written=True)
            return
        with contextlib.ExitStack() as stack:
            streams = [self._read(stack, file, wanted) for file in self.files]
            yield from heapq.merge(*streams, key=lambda message: message.log_time)

    def verify(self) -> None:
        """Read everything once; raises InputError when something is damaged."""
        for _ in self.messages():
            pass

    def _read(
        self,
        stack: contextlib.ExitStack,
        file: Path,
        wanted: list[str],
        *,
        as_written: bool = False,
    ) -> Iterator[Message]:
        with self._damage_is_input(file):
            reader = make_reader(stack.enter_context(file.open('rb')), validate_crcs=True)
            for _, channel, message in reader.iter_messages(
                topics=wanted, log_time_order=not as_written
            ):
                yield Message(
                    topic=channel.topic,
                    data=message.data,
                    log_time=message.log_time,
                    publish_time=message.publish_time,
                    sequence=message.sequence,
                )

    def _read_summary(self, file: Path) -> tuple[int, int]:
        """Add the topics of one file; return its first and last log time [ns], 0 if empty."""
        with self._damage_is_input(file), file.open('rb') as stream:
            reader = make_reader(stream, validate_crcs=True)
            summary = _complete_summary(reader)
            for number, channel in summary.channels.items():
                known = self.topics.get(channel.topic)
                self.topics[channel.topic] = TopicInfo(
                    type_name=summary.schemas[channel.schema_id].name,
                    encoding=channel.message_encoding,
                    count=(known.count if known else 0)
                    + summary.statistics.channel_message_counts.get(number, 0),
                )
            return summary.statistics.message_start_time, summary.statistics.message_end_time

    @contextlib.contextmanager
    def _damage_is_input(self, file: Path) -> Iterator[None]:
        try:
            yield
        except InputError:
            raise
        except OSError as error:
            raise InputError(f'bag {file} cannot be read: {error.strerror}') from None
        except DAMAGE as error:
            reason = ' '.join(str(error).split()) or type(error).__name__
            raise InputError(
                f'bag {file} is truncated or damaged, it must be a complete MCAP file ({reason})'
            ) from None


def _complete_summary(reader: McapReader) -> Any:
    summary = reader.get_summary()
    if summary is None or summary.statistics is None:
        raise McapError('it has no summary')
    return summary


def _mcap_files(path: Path) -> list[Path]:
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise InputError(f'bag {path} does not exist, it must be a bag directory or an MCAP file')
    metadata = path / 'metadata.yaml'
    files = _named_files(metadata) if metadata.is_file() else sorted(path.glob('*.mcap'))
    if not files:
        unfinished = ', '.join(sorted(file.name for file in path.glob('*.mcap.active')))
        hint = f', only the unfinished {unfinished}' if unfinished else ''
        raise InputError(f'bag {path} holds no MCAP file{hint}')
    for file in files:
        if not file.is_file():
            raise InputError(f'bag {path}: its metadata.yaml names {file.name}, which is missing')
    return files


def _named_files(metadata: Path) -> list[Path]:
    try:
        content = yaml.safe_load(metadata.read_text())['rosbag2_bagfile_information']
        kind, names = content['storage_identifier'], content['relative_file_paths']
        if kind != 'mcap':
            raise InputError(f'bag {metadata.parent} is stored as {kind}, it must be mcap')
        return [metadata.parent / str(name) for name in names]
    except (OSError, UnicodeDecodeError, yaml.YAMLError, KeyError, TypeError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'{metadata} is not a rosbag2 metadata file: {reason}') from None
