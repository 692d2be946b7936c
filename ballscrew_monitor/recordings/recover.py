# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A complete bag of an MCAP file that has lost its end, as when its writer was killed.

The file itself is left as it is.

"""

import contextlib
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.bag import other_encoding
from ballscrew_monitor.recordings.bag_files import kind_of, of_ros1
from ballscrew_monitor.recordings.bag_writer import ACTIVE, BagWriter, whole_bag
from ballscrew_monitor.recordings.mcap_records import RecordDamage, whole_records
from mcap.records import Channel, Metadata, Schema
from mcap.records import Message as McapMessage
from surrogate.files import InputError
from surrogate.files.plain_yaml import plain_values

SUFFIX = '.mcap'
OTHERS = {
    'sqlite3': '{file} is a sqlite3 file of a bag, only MCAP files are recovered: ballscrew '
    'replay reads that of a recorder that was killed as it is, sqlite3 {file} .recover mends a '
    'damaged one',
    'zstd': '{file} is packed by zstd, only MCAP files are recovered: ballscrew replay reads a '
    'packed file as it is; zstd -d {file} unpacks it',
    'parquet': '{file} is a Parquet file, only MCAP files are recovered',
}
"""What is said of files of other kinds."""


def recover(path: Path) -> tuple[Path, int, float, str]:
    """
    Write what a recording holds before its first damage.

    Returns the new file, its messages, its seconds, and a sentence of what is left out, if any.

    `path` is an MCAP file, unfinished or damaged, or the folder of an unfinished one. A finished
    name is taken away from an unfinished file, any other gets `_recovered` behind its name. Raises
    InputError when there is nothing to be had.

    """
    file = path
    if path.is_dir():
        files = sorted(path.glob(f'*{SUFFIX}{ACTIVE}'))
        if not files and (stored := sorted(path.glob('*.db3'))):
            raise InputError(OTHERS['sqlite3'].format(file=stored[0]))
        if len(files) != 1:
            raise InputError(f'{path} holds {len(files)} unfinished recordings, it must be one')
        file = files[0]
    if not file.is_file():
        raise InputError(f'{file} does not exist, it must be an MCAP file or the folder of one')
    kind = kind_of(file)
    if kind == 'rosbag1':
        raise of_ros1(file)
    if kind in OTHERS:
        raise InputError(OTHERS[kind].format(file=file))
    target = file.with_name(file.name.removesuffix(ACTIVE))
    if not file.name.endswith(ACTIVE):
        name = f'{file.name.removesuffix(SUFFIX)}_recovered'
        target = file.with_name(name) / f'{name}{SUFFIX}'
    if target.exists():
        raise InputError(f'{target} is there already, it would be written over: move it away')
    topics, lost = _topics(file)
    if not topics:
        raise InputError(f'{file} holds no message that is whole, nothing can be recovered')
    for channel, _ in topics.values():
        if channel.message_encoding != 'cdr':
            raise InputError(
                f'{file}: topic {channel.topic} {other_encoding(channel.message_encoding)}'
            )
    with whole_bag(target.parent, target.name.removesuffix(SUFFIX)) as writer:
        _copy(file, topics, writer)
    return target, writer.total, (writer.last - writer.first) * 1e-9, lost


def _topics(file: Path) -> tuple[dict[int, tuple[Channel, Schema]], str]:
    """Return the channels that hold a message, each with its schema, by number; what is lost."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    used: set[int] = set()
    lost = ''
    try:
        for record in whole_records(file):
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, McapMessage):
                used.add(record.channel_id)
    except RecordDamage as damage:
        lost = damage.lost
    topics = {
        number: (channels[number], schemas[channels[number].schema_id])
        for number in sorted(used & channels.keys())
        if channels[number].schema_id in schemas
    }
    return topics, lost


def _copy(file: Path, topics: dict[int, tuple[Channel, Schema]], writer: BagWriter) -> None:
    for channel, schema in topics.values():
        metadata = channel.metadata
        profiles: list[dict[str, Any]] = []
        with contextlib.suppress(InputError):
            stated = plain_values(metadata.get('offered_qos_profiles', ''))
            if isinstance(stated, list) and all(isinstance(part, dict) for part in stated):
                profiles = stated
        kind = metadata.get('topic_type_hash', '')
        names = channel.topic, schema.name
        writer.announce(*names, schema.data, type_hash=kind, profiles=profiles)
    with contextlib.suppress(RecordDamage):
        for message in whole_records(file):
            if isinstance(message, Metadata):
                writer.add_metadata(message.metadata, name=message.name)
            if not isinstance(message, McapMessage) or message.channel_id not in topics:
                continue
            writer.write(
                topics[message.channel_id][0].topic,
                message.data,
                log_time=message.log_time,
                publish_time=message.publish_time,
                sequence=message.sequence,
            )
