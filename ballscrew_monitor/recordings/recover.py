# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mends a recording whose writer was killed: its intact part becomes a complete bag.

The file itself is left as it is. Nothing is decoded, so the types need not be installed.

"""

from pathlib import Path

from ballscrew_monitor.recordings.bag_writer import ACTIVE, Announced, BagWriter, whole_bag
from ballscrew_monitor.recordings.mcap_damage import whole_records
from mcap.records import Channel, Metadata, Schema
from mcap.records import Message as McapMessage
from surrogate.files import InputError
import yaml

SUFFIX = '.mcap'


def recover(path: Path) -> tuple[Path, int, float]:
    """
    Write the intact part of a recording; return the new file, its messages and its seconds.

    `path` is an MCAP file, unfinished or damaged, or the folder of an unfinished one. A finished
    name is taken away from an unfinished file, any other gets `_recovered` behind its name. Raises
    InputError when there is nothing to be had.

    """
    file = _unfinished(path) if path.is_dir() else path
    if not file.is_file():
        raise InputError(f'{file} does not exist, it must be an MCAP file or the folder of one')
    target = _target(file)
    if target.exists():
        raise InputError(f'{target} is there already, it would be written over: move it away')
    topics = _topics(file)
    if not topics:
        raise InputError(f'{file} holds no message that is whole, nothing can be recovered')
    with whole_bag(target.parent, target.name.removesuffix(SUFFIX)) as writer:
        _copy(file, topics, writer)
    return target, writer.total, (writer.last - writer.first) * 1e-9


def _unfinished(folder: Path) -> Path:
    found = sorted(folder.glob(f'*{SUFFIX}{ACTIVE}'))
    if len(found) != 1:
        raise InputError(f'{folder} holds {len(found)} unfinished recordings, it must be one')
    return found[0]


def _target(file: Path) -> Path:
    if file.name.endswith(ACTIVE):
        return file.with_name(file.name.removesuffix(ACTIVE))
    name = f'{file.name.removesuffix(SUFFIX)}_recovered'
    return file.with_name(name) / f'{name}{SUFFIX}'


def _topics(file: Path) -> dict[int, Announced]:
    """Return the topics that hold a message, by the number of their channel."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    used: set[int] = set()
    for record in whole_records(file):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, McapMessage):
            used.add(record.channel_id)
    return {
        number: _announced(channels[number], schemas[channels[number].schema_id])
        for number in sorted(used & channels.keys())
        if channels[number].schema_id in schemas
    }


def _announced(channel: Channel, schema: Schema) -> Announced:
    return Announced(
        name=channel.topic,
        type_name=schema.name,
        definition=schema.data,
        type_hash=channel.metadata.get('topic_type_hash', ''),
        profiles=yaml.safe_load(channel.metadata.get('offered_qos_profiles', '')) or [],
    )


def _copy(file: Path, topics: dict[int, Announced], writer: BagWriter) -> None:
    """Copy messages and what the file says of itself."""
    for topic in topics.values():
        writer.announce(topic)
    for message in whole_records(file):
        if isinstance(message, Metadata):
            writer.add_metadata(message.metadata, name=message.name)
        if not isinstance(message, McapMessage) or message.channel_id not in topics:
            continue
        writer.write(
            topics[message.channel_id].name,
            message.data,
            log_time=message.log_time,
            publish_time=message.publish_time,
            sequence=message.sequence,
        )
