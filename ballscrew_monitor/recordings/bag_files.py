# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of a bag and their kinds, by metadata.yaml and by their first bytes."""

import contextlib
from pathlib import Path, PureWindowsPath
import re
import shlex

from surrogate.files import InputError
from surrogate.files.limits import read_text
from surrogate.files.plain_yaml import plain_values

MAGIC = {
    b'\x89MCAP': 'mcap',
    b'SQLite format 3\0': 'sqlite3',
    b'\x28\xb5\x2f\xfd': 'zstd',
    b'#ROSBAG V': 'rosbag1',
    b'#ROSRECORD V': 'rosbag1',
    b'PAR1': 'parquet',
}
"""Kinds of files by how they begin."""
ZSTD = next(magic for magic, kind in MAGIC.items() if kind == 'zstd')
ENDINGS = ('.mcap', '.db3', '.mcap.zstd', '.db3.zstd')
ACTIVE = '.mcap.active'
TABLES = (
    '.csv', '.tsv', '.tab', '.txt', '.log', '.dat', '.asc', '.lvm', '.prn', '.parquet', '.xlsx',
    '.mat', '.h5', '.hdf5', '.tdms', '.mf4', '.mdf', '.shdr',
)  # fmt: skip
"""Endings of tables in a folder; a file that is named is read whatever its ending."""
STORAGES = ('mcap', 'sqlite3')
NO_METADATA = (OSError, ValueError, KeyError, TypeError, AttributeError)
OWN = 'ballscrew_monitor'
"""Name of the metadata record in which an MCAP file holds what this program says of it."""


Manifest = tuple[list[Path], dict[str, str], dict[str, int]]
"""Files of a bag in order, and of its metadata the custom data and the messages by topic."""


def kind_of(file: Path) -> str:
    """Return what a file is by its first bytes: a word of `MAGIC`, or nothing."""
    with file.open('rb') as stream:
        head = stream.read(max(map(len, MAGIC)))
    return next((kind for magic, kind in MAGIC.items() if head.startswith(magic)), '')


def is_bag(path: Path) -> bool:
    """Return True if something is to be opened as a bag: a directory of one, or a file of it."""
    if path.is_dir():
        return (path / 'metadata.yaml').is_file() or bool(_bag_files(path))
    return path.name.endswith((*ENDINGS, ACTIVE)) or (
        path.is_file() and kind_of(path) in (*STORAGES, 'zstd', 'rosbag1')
    )


def is_table(path: Path) -> bool:
    """Return True if something is to be read as a table: a file that is one by name or content."""
    return path.is_file() and (path.suffix.lower() in TABLES or kind_of(path) == 'parquet')


def manifest(path: Path, *, salvage: bool) -> Manifest:
    """Return the files of the bag at `path`; raises InputError when there is none."""
    if path.is_file():
        return [path], {}, {}
    if not path.is_dir():
        raise InputError(f'bag {path} does not exist, it must be a bag directory or an MCAP file')
    metadata = path / 'metadata.yaml'
    files, custom, counts = (
        _read_metadata(metadata) if metadata.is_file() else (_bag_files(path), {}, {})
    )
    unfinished = sorted(path.glob(f'*{ACTIVE}'), key=_by_number)
    if not files and salvage:
        files = unfinished
    if not files:
        names = ', '.join(file.name for file in unfinished)
        hint = f', only the unfinished {names}' if names else ''
        raise InputError(f'bag {path} holds no MCAP file and no sqlite3 file{hint}')
    return files, custom, counts


def of_ros1(file: Path) -> InputError:
    """Return what is said of a bag of ROS 1."""
    source, target = (shlex.quote(str(path)) for path in (file, file.with_suffix('')))
    return InputError(
        f'bag {file} is of ROS 1, it must be converted to ROS 2: rosbags-convert --src {source} '
        f'--dst {target} --dst-typestore ros2_jazzy does so (pip install rosbags)'
    )


def _bag_files(path: Path) -> list[Path]:
    parts = [
        file
        for file in path.iterdir()
        if file.name.endswith(ENDINGS)
        or (file.name.endswith('.bag') and file.is_file() and kind_of(file) == 'rosbag1')
    ]
    return sorted(parts, key=_by_number)


def _by_number(file: Path) -> list[str | int]:
    """Return what sorts the parts of a bag: the tenth comes after the second."""
    pieces = re.split(r'(\d+)', file.name)
    return [int(piece) if piece.isdecimal() else piece for piece in pieces]


def _read_metadata(metadata: Path) -> Manifest:
    try:
        content = plain_values(read_text(metadata))['rosbag2_bagfile_information']
        kind, names = content.get('storage_identifier'), content['relative_file_paths']
        packing = str(content.get('compression_format') or 'zstd')
        custom = dict(content.get('custom_data') or {})
    except NO_METADATA as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'{metadata} is not a rosbag2 metadata file: {reason}') from None
    bag = metadata.parent
    if not isinstance(names, list):
        raise InputError(f'{metadata} is not a rosbag2 metadata file: it names no list of files')
    files = [_place(bag, str(name)) for name in names]
    if not any(file.is_file() and kind_of(file) for file in files):  # the first bytes decide
        if kind and str(kind).lower() not in STORAGES:
            raise InputError(f'bag {bag} is stored as {kind}, it must be {" or ".join(STORAGES)}')
        if packing.lower() != 'zstd':
            raise InputError(f'bag {bag} is compressed as {packing}, it must be zstd')
    counts = {}
    with contextlib.suppress(*NO_METADATA):  # those that count well
        counts = {
            str(topic['topic_metadata']['name']): int(topic['message_count'])
            for topic in content['topics_with_message_count']
        }
    return (files, {str(key): str(value) for key, value in custom.items()}, counts)


def _place(bag: Path, name: str) -> Path:
    """Return where a file is: old metadata name the folder of the bag, of Windows another."""
    windows = PureWindowsPath(name)
    places = (bag / name, bag / windows.as_posix())
    return next((place for place in places if place.is_file()), bag / windows.name)
