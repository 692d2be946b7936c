# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One file to send when something fails: a zip of what is needed to look for the cause.

Versions, failures of the program, parameters, what a node keeps, and the end of its last recording
or of the logs that are named. Each part has a largest size, and so has the whole. A mask hides
hosts, users and persons; `contents.txt` says what is inside and what was hidden.

"""

import argparse
from collections import deque
from collections.abc import Callable, Collection, Mapping, Sequence
import contextlib
import dataclasses
from importlib import metadata
import io
import json
import os
from pathlib import Path
import platform
import stat
import tempfile
from typing import Any, BinaryIO
import zipfile

from ballscrew_monitor.clients.mask import holds_bytes, Mask, Secret, with_short
from ballscrew_monitor.messages.diagnostics import HOST as HOST_KEY
from ballscrew_monitor.node.restart_state import AUTO, state_directory
from ballscrew_monitor.node.state_database import FILE, VERSION
from ballscrew_monitor.node.state_records import AXES, CORRECTIONS, EVENTS
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.event_messages import read as read_events
from ballscrew_monitor.recordings.frames import EVENTS as EVENTS_TYPE
from ballscrew_monitor.recordings.storages import Message
from ballscrew_monitor.settings.parameters import NODE_NAME
from ballscrew_msgs.msg import AxisHealth, BallScrewState, OutOfZone
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import deserialize_message
from surrogate.files import InputError, json_text, printable, replace_file
from surrogate.files.store import opened_to_read, readable
from surrogate.units import MINUTE

FAILURES = 'ballscrew_failure_*.txt'
LARGEST = 25_000_000  # [byte] of all, before it is packed
LARGEST_TEXT, LARGEST_LOGS = 1_000_000, 16_000_000  # [byte] of a text, of all logs
HEAD = 64_000  # [byte] of a table that is kept before its end
MOST_ENTRIES, MOST_FAILURES = 2000, 3
PACKAGES = (
    *('ballscrew_monitor', 'ballscrew_msgs', 'rclpy', 'numpy', 'numba', 'polars', 'mcap'),
    *('zstandard', 'starlette', 'uvicorn', 'websockets', 'matplotlib', 'PyYAML'),
)
SETTINGS = ('RMW_IMPLEMENTATION', 'ROS_DOMAIN_ID', 'ROS_AUTOMATIC_DISCOVERY_RANGE', 'ROS_DISTRO')
"""Variables of the environment that are told."""
NO_RECORDING = 'no recording of the node: it keeps one where its parameter record says so'
WIDE = {b'\xff\xfe': 'utf-16-le', b'\xfe\xff': 'utf-16-be'}
BINARY = (
    '{name} is a table that is no text, in which nothing can be hidden: save it as CSV, or put it '
    'in as it is with --include tables'
)


@dataclasses.dataclass(frozen=True, kw_only=True)
class FaultCase:
    """
    What goes into a report: logs and state directories, texts by name, and failures.

    Of a log go the last `seconds` [s]. `shown` is not hidden. A table that is no text goes in as
    it is with `tables`; else it is refused, or left out unless `table_refused`. `failures` None
    stands for those of this user. `tokens`, `names` of persons and their `reasons` are hidden.

    """

    paths: Sequence[Path] = ()
    texts: Mapping[str, str] = dataclasses.field(default_factory=dict)
    failures: Sequence[Path] | None = None
    seconds: float = 2.0 * MINUTE
    shown: Collection[Secret] = ()
    tables: bool = False
    table_refused: bool = True
    tokens: Sequence[str] = ()
    names: Sequence[str] = ()
    reasons: Sequence[str] = ()


def fault_report(case: FaultCase) -> tuple[bytes, list[str]]:
    """
    Return the zip, and what it holds in lines, and what stood in the way of other parts.

    Raises InputError for a table or a failure that is asked for and cannot be read.

    """
    parts = _Parts(case)
    failures = own_failures() if case.failures is None else map(_text_of, case.failures)
    parts.add_text('versions.json', json_text(versions()))
    for number, text in enumerate(failures, 1):
        parts.add_text(f'failure_{number}.txt', text)
    for path in case.paths:
        if is_state(path):
            parts.attempt(parts.add_state, path)
            parts.attempt(parts.add_last, path / 'recordings')
        elif is_bag(path):
            parts.attempt(parts.add_bag, path)
        elif path.is_dir():
            parts.attempt(parts.add_last, path)
        elif case.table_refused:
            parts.add_table(path)
        else:
            parts.attempt(parts.add_table, path)
    for name, text in case.texts.items():
        parts.add_text(name, text)
    return parts.packed()


def is_state(path: Path) -> bool:
    """Return True if a folder is the state directory of a node."""
    return (path / FILE).is_file()


def own_failures() -> list[str]:
    """Return the last failures of commands that this user has run, the newest first."""
    no_link, failures = os.O_NOFOLLOW | os.O_NONBLOCK, []
    for path in Path(tempfile.gettempdir()).glob(FAILURES):
        with (
            contextlib.suppress(OSError),  # it is another user's
            open(path, 'rb', opener=lambda name, flags: os.open(name, flags | no_link)) as stream,
        ):
            about = os.fstat(stream.fileno())
            is_file = stat.S_ISREG(about.st_mode) and about.st_nlink == 1
            if is_file and about.st_uid == os.getuid():
                failures.append((about.st_mtime, _end_of(stream)))
    return [text for _, text in sorted(failures, reverse=True)[:MOST_FAILURES]]


def versions() -> dict[str, Any]:
    """Return versions of what this runs with."""
    packages = {}
    for name in PACKAGES:
        with contextlib.suppress(metadata.PackageNotFoundError):
            packages[name] = metadata.version(name)
    return {
        'python': platform.python_version(),
        'system': f'{platform.system()} {platform.machine()}',
        'packages': packages,
        'settings': {name: os.environ[name] for name in SETTINGS if name in os.environ},
    }


class _Parts:
    """Parts of the zip as they come together: what is hidden in one is hidden in all."""

    def __init__(self, case: FaultCase) -> None:
        self._case, self._mask = case, Mask(case.shown, case.tokens)
        self._mask.learn(Secret.NAME, case.names)
        self._mask.learn_reasons(case.reasons)
        self._texts: list[tuple[str, str]] = []
        self._files: list[tuple[str, bytes]] = []
        self._bags: list[tuple[str, Bag, list[Message]]] = []
        self._remarks: list[str] = []
        self._room = LARGEST_LOGS / max(len(case.paths), 1)  # [byte] for each log

    def attempt(self, add: Callable[[Path], None], path: Path) -> None:
        """Add a part; what stands in its way becomes a remark, so that all others are sent."""
        try:
            add(path)
        except InputError as error:
            self._remarks.append(str(error))
        except Exception as error:
            self._remarks.append(f'{path} is left out: {type(error).__name__}: {error}')

    def add_text(self, name: str, text: str) -> None:
        """Add a text, of a long one its end."""
        self._texts.append((name, text[-LARGEST_TEXT:]))

    def add_state(self, folder: Path) -> None:
        """Add what a node keeps."""
        tables = (AXES, CORRECTIONS, EVENTS)
        with opened_to_read(folder, FILE, tables, VERSION) as store:
            last = f'ORDER BY number DESC LIMIT {MOST_ENTRIES}'
            rows = [store.rows(table, last if table is EVENTS else '') for table in tables]
        axes, corrections, events = (
            [record for _, record in readable(table, found)]
            for table, found in zip(tables, rows, strict=True)
        )
        entries = [entry.record() for entry in reversed(events)]
        for entry in entries:
            self._mask.learn(Secret.NAME, [entry.get('name', '')])
            self._mask.learn_reasons([entry.get('reason', '')])
        for axis in axes:
            self._mask.learn(Secret.NAME, [axis.ended_by])
            self._mask.learn_reasons([axis.end_reason, axis.reason])
        kept = {'axes': axes, 'corrections': corrections}
        self.add_text(
            'state.json',
            json_text({name: [*map(dataclasses.asdict, each)] for name, each in kept.items()}),
        )
        self.add_text('events.jsonl', '\n'.join(map(json.dumps, entries)))

    def add_last(self, folder: Path) -> None:
        """Add the last recording of a folder, if there is one."""
        bags = sorted(filter(is_bag, folder.glob('*/')), key=lambda path: path.stat().st_mtime)
        if not bags:
            raise InputError(NO_RECORDING)
        self.add_bag(bags[-1])

    def add_bag(self, path: Path) -> None:
        """Add the end of a bag, and the parameters that it holds."""
        bag, size, kept = Bag(path, salvage=True), 0, deque[Message]()
        topics = []  # those in which secrets can be hidden
        for topic, kind in bag.types.items():
            try:
                why = 'holds bytes, in which nothing can be hidden' if holds_bytes(kind) else ''
            except InputError:
                why = 'is not installed here'
            if why:
                self._remarks.append(f'{topic} is left out: its type {kind} {why}')
            else:
                topics.append(topic)
        for message in bag.messages(topics):
            kept.append(message)
            size += len(message.data)
            first = message.log_time - self._case.seconds * 1e9
            while kept and (size > self._room or kept[0].log_time < first):
                size -= len(kept.popleft().data)
        parameters: dict[str, Any] = {}
        sound = []
        for message in kept:
            try:
                parameters |= self._learn_from(bag.types[message.topic], message.data)
                sound.append(message)
            except Exception as error:  # as of an older interface
                bag.refuse(message, str(error))
        self._bags.append((f'log_{len(self._bags) + 1}', bag, sound))
        if parameters:
            self.add_text('parameters.json', json_text(parameters))

    def _learn_from(self, type_name: str, data: bytes) -> dict[str, Any]:
        """Learn who is named in a message; return the parameters that it holds."""
        values: dict[str, Any] = {}
        if type_name == EVENTS_TYPE:
            for taken in map(json.loads, read_events(data).snapshots):
                memory = taken.get('memory', {})
                _, name, reason = (*memory.get('ending', ()), '', '', '')[:3]
                self._mask.learn(Secret.NAME, [name])
                self._mask.learn_reasons([memory.get('shelve_reason', ''), reason])
                values |= taken.get('values', {})
        elif kind := NAMING.get(type_name):
            message: Any = deserialize_message(data, kind)
            self._mask.learn(Secret.NAME, [getattr(message, 'acknowledged_by', '')])
            self._mask.learn_reasons(getattr(message, name, '') for name in REASONS)
            statuses = message.status if isinstance(message, DiagnosticArray) else ()
            pairs = [pair for status in statuses for pair in status.values]
            for host in (pair.value for pair in pairs if pair.key == HOST_KEY):
                self._mask.learn(Secret.HOST, with_short(host.partition(' (process ')[0]))
        return values

    def add_table(self, path: Path) -> None:
        """Add a table: its first lines and its end."""
        end = b''
        try:
            with path.open('rb') as stream:
                size = stream.seek(0, os.SEEK_END)
                stream.seek(0)
                head = stream.read(HEAD if size > self._room else -1)
                if size > self._room:
                    stream.seek((size - int(self._room)) // 2 * 2)  # a wide letter stays whole
                    end = stream.read()
        except OSError as error:
            raise InputError(f'log {path} cannot be read: {error.strerror}') from None
        name = f'log_{path.name}'
        wide = WIDE.get(head[:2])
        if b'\0' not in head or wide:
            coding = (wide, 'replace') if wide else ('utf-8', 'surrogateescape')
            first, last = (part.decode(*coding) for part in (head, end))
            if end:  # both in whole lines
                first, last = first.rpartition('\n')[0] + '\n', last.partition('\n')[2]
            self._texts.append((name, (first + last).removeprefix('\ufeff')))
        elif self._case.tables and not end:
            self._files.append((name, head))
        elif self._case.tables:
            raise InputError(f'{path} has {size} bytes, allowed are {self._room:.0f}')
        else:
            raise InputError(BINARY.format(name=path))

    def packed(self) -> tuple[bytes, list[str]]:
        """Return the zip, and what it holds in lines."""
        contents = [
            (name, self._mask.text(text).encode('utf-8', 'surrogateescape'))
            for name, text in self._texts
        ]
        contents += self._files
        for name, bag, messages in self._bags:
            topics = {message.topic: self._mask.text(message.topic) for message in messages}
            with tempfile.TemporaryDirectory() as folder, BagWriter(Path(folder), name) as writer:
                for topic, shown in topics.items():
                    kind = bag.types[topic]
                    writer.add_topic(Topic(name=shown, type_name=kind, offer=Offer.RELIABLE))
                for message in messages:
                    try:
                        data = self._mask.message(bag.types[message.topic], message.data)
                    except Exception as error:
                        bag.refuse(message, str(error))
                        continue
                    times = {'log_time': message.log_time, 'publish_time': message.publish_time}
                    writer.write(topics[message.topic], data, **times)
                writer.close()
                self._remarks += bag.notes
                files = sorted(file for file in Path(folder).iterdir() if file.is_file())
                contents += [(f'{name}/{file.name}', file.read_bytes()) for file in files]
        contents = self._bounded(contents)
        lines = self._lines(contents)
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, 'w', zipfile.ZIP_DEFLATED) as archive:
            for name, content in [('contents.txt', '\n'.join(lines).encode()), *contents]:
                archive.writestr(name, content)
        return buffer.getvalue(), lines

    def _bounded(self, contents: Sequence[tuple[str, bytes]]) -> list[tuple[str, bytes]]:
        """Return what there is room for; a name that is there already gets a number."""
        kept: dict[str, bytes] = {}
        for name, content in contents:
            if sum(map(len, kept.values())) + len(content) > LARGEST:
                self._remarks.append(f'{name} is left out: {len(content)} bytes are too many')
                continue
            masked = self._mask.text(name)
            kept[f'{len(kept)}_{masked}' if masked in kept else masked] = content
        return list(kept.items())

    def _lines(self, contents: Sequence[tuple[str, bytes]]) -> list[str]:
        hidden = self._mask.count
        counts = ', '.join(f'{hidden[kind]} x {kind}' for kind in Secret if hidden[kind])
        shown = ', '.join(sorted(self._case.shown)) or 'nothing'
        return [
            *(f'{name}  {len(content)} bytes' for name, content in contents),
            f'hidden: {counts or "nothing"}; shown as asked for: {shown}',
            *map(self._mask.text, self._remarks),
        ]


NAMING = {
    'ballscrew_msgs/msg/OutOfZone': OutOfZone,
    'ballscrew_msgs/msg/BallScrewState': BallScrewState,
    'ballscrew_msgs/msg/AxisHealth': AxisHealth,
    'diagnostic_msgs/msg/DiagnosticArray': DiagnosticArray,
}
"""Messages that name persons or machines."""
REASONS = ('acknowledge_reason', 'shelve_reason', 'baseline_reason')


def _end_of(stream: BinaryIO) -> str:
    stream.seek(max(0, stream.seek(0, os.SEEK_END) - LARGEST_TEXT))
    return stream.read(LARGEST_TEXT).decode('utf-8', 'replace')


def _text_of(path: Path) -> str:
    try:
        with path.open('rb') as stream:
            return _end_of(stream)
    except OSError as error:
        raise InputError(f'{path} cannot be read: {error.strerror}') from None


def report_command(args: argparse.Namespace) -> int:
    """Write the file and print what it holds; raises InputError for what cannot be read."""
    kinds = {'hosts': Secret.HOST, 'users': Secret.USER, 'names': Secret.NAME}
    if not args.minutes > 0.0:
        raise InputError(f'--minutes is {args.minutes:g}, it must be above 0')
    own = state_directory(AUTO, NODE_NAME)
    default = [own] if own is not None and is_state(own) else []
    for path in args.paths:
        if not path.exists():
            raise InputError(f'{path} does not exist, it must be a log or the state_dir of a node')
    content, lines = fault_report(
        FaultCase(
            paths=args.paths or default,
            texts={'parameters.yaml': _text_of(args.params)} if args.params else {},
            failures=args.failure,
            seconds=args.minutes * MINUTE,
            shown=[kinds[name] for name in args.include if name in kinds],
            tables='tables' in args.include,
        )
    )
    replace_file(args.out, content)
    print(printable('\n'.join([f'{args.out}: {len(content)} bytes to send', *lines])))
    return 0
