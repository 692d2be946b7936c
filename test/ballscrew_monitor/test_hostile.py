# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Small files that state too much or contradict themselves: one sentence, in bounded memory."""

import dataclasses
import io
import json
import os
from pathlib import Path
import sqlite3
import struct
import subprocess
import sys
import zipfile

from ballscrew_monitor import cli
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.mcap_file import message_definition
import lz4.frame
from mcap.writer import CompressionType, Writer
import openpyxl
import pytest
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagWriter
from rosbags.typesys import get_typestore, Stores
from surrogate.files import printable
from surrogate.surface import file as surface_file
import zstandard

ROOT = Path(__file__).resolve().parents[2]
PARAMS = ROOT / 'config' / 'nominal_cycle.yaml'
DEADLINE = 600.0  # [s] which only ends a hang
MOST = 500  # [MB] above an ordinary replay
TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/axial_load': 'geometry_msgs/msg/WrenchStamped',
    '/oil_temperature': 'sensor_msgs/msg/Temperature',
}
CHUNK, CHUNK_INDEX, STATISTICS, PRIVATE = 6, 8, 11, 0x80  # operation codes
CHILD = """
import contextlib, io, json, resource, sys
from ballscrew_monitor import cli
for line in sys.stdin:
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
        code = cli.main(json.loads(line))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    print(json.dumps([code, said.getvalue(), peak]), flush=True)
"""
PREFIX = 'ballscrew_monitor.'
LOG = {f'{PREFIX}source': 'a.csv', f'{PREFIX}mapping': '{}'}
LOG |= {f'{PREFIX}assumptions': '[]', f'{PREFIX}notes': '[]'}


def laughs(key='a'):
    """Return YAML lines of 9 values each, which come to 9**9."""
    first = f'{key}0: &{key}0 {{{", ".join(f"k{part}: ha" for part in range(9))}}}'
    return [first] + [
        f'{key}{n}: &{key}{n} {{{", ".join(f"k{part}: *{key}{n - 1}" for part in range(9))}}}'
        for n in range(1, 9)
    ]


def zeros(count, stated=None):
    """Return a zstd frame of zeros in blocks of four bytes each, which may state its size."""
    block = 128 * 1024
    head = b'\x28\xb5\x2f\xfd' + (
        b'\x008' if stated is None else struct.pack('<BBQ', 0xC0, 56, stated)
    )
    blocks = -(-count // block)
    parts = [
        ((block << 3) | 2 | (n == blocks - 1)).to_bytes(3, 'little') + b'\0' for n in range(blocks)
    ]
    return head + b''.join(parts)


def mcap(path, messages, *, metadata=None, offered=''):
    with path.open('wb') as stream:
        writer = Writer(stream, chunk_size=20_000, compression=CompressionType.NONE)
        writer.start('ros2', 'test')
        numbers = {}
        for topic, kind in TYPES.items():
            schema = writer.register_schema(kind, 'ros2msg', message_definition(kind).encode())
            said = {'offered_qos_profiles': offered}
            numbers[topic] = writer.register_channel(topic, 'cdr', schema, said)
        if metadata is not None:
            writer.add_metadata('ballscrew_monitor', metadata)
        for topic, log_time, data in messages:
            writer.add_message(numbers[topic], log_time, data, log_time)
        writer.finish()
    return path


def records(data):
    """Yield code, begin and length of the records of a file, without magic."""
    at = 8
    while at < len(data) - 8:
        code, length = struct.unpack_from('<BQ', data, at)
        yield code, at + 9, length
        at += 9 + length


def with_chunk(path, compression, packed, size):
    """Put other content into the second chunk of a file, and mend the indexes."""
    data = bytearray(path.read_bytes())
    at, length = [(at, length) for code, at, length in records(data) if code == CHUNK][1]
    name = compression.encode()
    body = data[slice(at, at + 16)] + struct.pack('<QII', size, 0, len(name)) + name
    body += struct.pack('<Q', len(packed)) + packed
    shift = len(body) - length
    data[slice(at - 8, at + length)] = struct.pack('<Q', len(body)) + body
    for code, place, _ in [*records(data)]:
        if code == CHUNK_INDEX:
            (begin,) = struct.unpack_from('<Q', data, place + 16)
            if begin == at - 9:
                struct.pack_into('<Q', data, place + 24, len(body) + 9)
            elif begin > at:
                struct.pack_into('<Q', data, place + 16, begin + shift)
    footer = len(data) - 8 - 20
    begin, offsets, _ = struct.unpack_from('<QQI', data, footer)
    struct.pack_into('<QQI', data, footer, begin + shift, offsets + shift, 0)
    path.write_bytes(data)


def without_checksum(data):
    """Let a summary state no checksum of itself."""
    data[-12:-8] = bytes(4)


def lose_index(data):
    """Take the second chunk out of the index."""
    place = [place for code, place, _ in records(data) if code == CHUNK_INDEX][1]
    data[place - 9] = PRIVATE
    without_checksum(data)


def count_more(data):
    """Let the statistics count 8 more messages of each topic."""
    place = next(place for code, place, _ in records(data) if code == STATISTICS)
    (total,) = struct.unpack_from('<Q', data, place)
    struct.pack_into('<Q', data, place, total + 8 * len(TYPES))
    for number in range(len(TYPES)):
        at = place + 46 + 10 * number + 2
        struct.pack_into('<Q', data, at, struct.unpack_from('<Q', data, at)[0] + 8)
    without_checksum(data)


def flip_index(data):
    """Change a byte of the begin of a chunk in the index."""
    place = next(place for code, place, _ in records(data) if code == CHUNK_INDEX)
    data[place + 17] ^= 0x55


DATABASES = {
    'text_data': "UPDATE messages SET data = 'abc' WHERE id % 7 = 3",
    'text_time': "UPDATE messages SET timestamp = 'abc' WHERE id % 7 = 3",
    'no_topic': 'UPDATE messages SET topic_id = 77 WHERE id % 2 = 0',
    'huge_blob': 'UPDATE messages SET data = zeroblob(100000000) WHERE id = 50',
}
FLAWS = {'lost_index': lose_index, 'more_counted': count_more, 'flipped_index': flip_index}


class Hostile:
    """Files in a folder, by name the command that reads each."""

    def __init__(self, folder, messages):
        self.folder, self.messages = folder, messages
        self.commands = {}
        self.replay('good', mcap(folder / 'good.mcap', messages))
        for part in (self.bags, self.flawed, self.databases, self.texts, self.tables):
            part()

    def replay(self, name, path, *more):
        self.commands[name] = ['replay', str(path), *map(str, more)]

    def text(self, name, content):
        path = self.folder / name
        path.write_text(content, encoding='utf-8')
        return path

    def bag(self, name, messages=None, **more):
        path = mcap(self.folder / f'{name}.mcap', messages or self.messages, **more)
        self.replay(name, path)
        return path

    def bags(self):
        half, huge = len(self.messages) // 2, 6 << 30
        topic, log_time, _ = self.messages[half]
        packed = [(one, at, zstandard.compress(data)) for one, at, data in self.messages]
        for name, data in (('huge_message', zeros(huge, huge)), ('endless_message', zeros(huge))):
            packed[half] = topic, log_time, data
            self.bag(name, packed)
        lz4_zeros = lz4.frame.compress(bytes(300 << 20))
        for name, compression, content, size in (
            ('zstd_frame', 'zstd', zeros(3 << 30, 3 << 30), 20_000),
            ('zstd_both', 'zstd', zeros(3 << 30, 3 << 30), 3 << 30),
            ('zstd_endless', 'zstd', zeros(3 << 30), 60 << 20),
            ('lz4_chunk', 'lz4', lz4_zeros, 20_000),
            ('lz4_both', 'lz4', lz4_zeros, 300 << 20),
        ):
            with_chunk(self.bag(name), compression, content, size)
        path = self.folder / 'large.mcap.zstd'
        path.write_bytes(zeros(3_400_000_000))
        self.replay('large', path)

    def flawed(self):
        for name, change in FLAWS.items():
            path = self.bag(name)
            data = bytearray(path.read_bytes())
            change(data)
            path.write_bytes(data)

    def databases(self):
        store = get_typestore(Stores.ROS2_JAZZY)
        for name, change in DATABASES.items():
            path = self.folder / name
            with RosbagWriter(path, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
                known = {
                    topic: writer.add_connection(topic, kind, typestore=store)
                    for topic, kind in TYPES.items()
                }
                for topic, log_time, data in self.messages:
                    writer.write(known[topic], log_time, data)
            with sqlite3.connect(path / f'{name}.db3') as database:
                database.execute(change)
            database.close()
            self.replay(name, path)

    def texts(self):
        good, below = self.folder / 'good.mcap', '\n      '.join
        head = '/**/ballscrew_monitor:\n  ros__parameters:\n    axes: [x]\n    x:\n      '
        deep = '[' * 5000 + ']' * 5000
        self.bag('laughing_bag', metadata=LOG | {f'{PREFIX}mapping': '\n'.join(laughs())})
        self.bag('deep_bag', metadata=LOG | {f'{PREFIX}mapping': deep})
        self.bag('dated_bag', metadata=LOG | {f'{PREFIX}notes': '[2020-13-45]'})
        for name, content in (
            ('laughing_parameters', head + below(laughs())),
            ('deep_parameters', f'{head}screw: {deep}'),
            ('dated_parameters', f'{head}screw: 2020-13-45'),
        ):
            self.replay(name, good, '--params', self.text(f'{name}.yaml', content))
        for name, content in (('laughing', '\n'.join(laughs())), ('deep', deep)):
            folder = self.folder / name
            folder.mkdir()
            os.link(good, folder / 'a.mcap')
            (folder / 'metadata.yaml').write_text(content)
            self.replay(f'{name}_metadata', folder)
        for name, content in (('dated_sheet', 'name: 2020-13-45'), ('twice', '1: a\n01: b')):
            sheet = self.text(f'{name}.yaml', content)
            self.commands[name] = [
                'point',
                '--screw',
                str(sheet),
                '--speed-rpm',
                '6',
                '--load-N',
                '1',
            ]

    def tables(self):
        log = self.text('log.csv', 't,v\n0,1\n1,2\n')
        axes = 'axes:\n  x:\n    lead_mm: 10\n    '
        for name, content in (
            ('laughing_map', axes + '\n    '.join(laughs())),
            ('deep_map', '[' * 100_000),
            ('dated_map', 'time: {column: t, unit: s, epoch: 2020-13-45}'),
        ):
            self.replay(name, log, '--map', self.text(f'{name}.yaml', content))
        names = ','.join(f'c{number}' for number in range(100_000))
        for name, content in (
            ('wide', f'{names}\n'),
            ('wide_returns', f'{names}\r1\r'),
            ('long', f't,v\n1,{"9" * 4_100_000}\n'),
            ('long_return', f't,v\r1,{"9" * 4_100_000}\r'),
            ('longest', f't,v\n1,2\n{"9," * 25_000_000}\n'),
            ('long_name', f'{"n" * 100_000},v\x1b[31m\n1,2\n'),
            ('longer_name', f'"{"n" * 1_000_000}",v\n1,2\n'),
            ('long_cell', f'x_speed,t\n{"9" * 100_000}x,2\n'),
            ('wide_letters', ('t,v\n' + 40_000 * '1,2\n').encode('utf-16')[:-1]),
        ):
            self.guess(name, content)
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, 'w', zipfile.ZIP_DEFLATED) as archive:
            with archive.open('xl/worksheets/sheet1.xml', 'w') as part:
                for _ in range(300):
                    part.write(bytes(1_000_000))
        self.guess('packed_sheet', packed.getvalue())
        book, content = openpyxl.Workbook(), io.BytesIO()
        book.active.append(['t', 'v'])
        book.active['Z1048576'] = 1
        book.save(content)
        self.guess('far_cell', content.getvalue())

    def guess(self, name, content):
        path = self.folder / f'{name}.csv'
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.commands[name] = ['import', str(path), '--guess']


@pytest.fixture(scope='module')
def results(short_bag, tmp_path_factory):
    """Return by name exit code, words and growth of memory so far [MB]."""
    messages = [(one.topic, one.log_time, one.data) for one in Bag(short_bag).messages()]
    hostile = Hostile(tmp_path_factory.mktemp('hostile'), messages)
    done = subprocess.run(
        [sys.executable, '-c', CHILD],
        input=''.join(f'{json.dumps(one)}\n' for one in hostile.commands.values()),
        cwd=ROOT,
        env=child_environment(0),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=DEADLINE,
    )
    found = dict(zip(hostile.commands, map(json.loads, done.stdout.splitlines()), strict=True))
    idle = found['good'][2]
    return {name: (code, said, peak - idle) for name, (code, said, peak) in found.items()}


MOST_WORDS = 2000  # letters of a refusal
REFUSED = (
    *('large', 'laughing_bag', 'deep_bag', 'dated_bag', 'laughing_parameters', 'deep_parameters'),
    *('dated_parameters', 'laughing_metadata', 'deep_metadata', 'dated_sheet', 'twice'),
    *('laughing_map', 'deep_map', 'dated_map', 'wide', 'wide_returns', 'long', 'long_return'),
    'longest',
    *('long_name', 'longer_name', 'long_cell', 'wide_letters', 'packed_sheet', 'far_cell'),
)
DAMAGED = ('zstd_frame', 'zstd_both', 'zstd_endless', 'lz4_chunk', 'lz4_both')
NOTED = ('huge_message', 'endless_message', *FLAWS, *DATABASES)


def test_all_are_within_memory(results):
    grown = {name: peak for name, (_, _, peak) in results.items()}
    assert max(grown.values()) < MOST, grown


@pytest.mark.parametrize('name', REFUSED)
def test_what_is_refused_is_one_sentence(name, results, says):
    code, said, _ = results[name]
    assert code == 2
    assert says(name) in said
    assert said.count('ballscrew: ') == 1
    assert len(said) < MOST_WORDS
    assert printable(said) == said


@pytest.mark.parametrize('name', DAMAGED)
def test_a_chunk_that_cannot_be_read_ends_the_replay_with_a_sentence(name, results, says):
    code, said, _ = results[name]
    assert code == 2
    assert says(name) in said.splitlines()[-1]


MOSTLY_UNJUDGED = 'text_data', 'text_time', 'no_topic'


@pytest.mark.parametrize('name', NOTED)
def test_what_is_judged_in_part_says_what_is_left_out(name, results, says):
    code, said, _ = results[name]
    assert code == int(name in MOSTLY_UNJUDGED)
    assert says(name) in said


@pytest.mark.parametrize(
    'field', ['minimum_temperature', 'density', 'viscosity', 'source', 'name']
)
def test_a_surface_of_this_format_whose_oil_lacks_a_field_is_one_sentence(
    field, tmp_path, capsys, says
):
    """Written whole and sound but for one field of its oil, as by another program."""
    whole, path = (
        surface_file.read(ROOT / 'test' / 'data' / 'golden_surface.npz'),
        tmp_path / 'a.npz',
    )
    header = json.loads(json.dumps(dict(whole.header)))
    del header['inputs']['lubricant'][field]
    surface_file.write(path, dataclasses.replace(whole, header=header))
    assert header['format_version'] == surface_file.FORMAT_VERSION
    code = cli.main(['surface', 'info', str(path)])
    said = capsys.readouterr().err
    assert code == 2, said
    assert said.count('ballscrew: ') == 1
    assert says('oil_lacks' if field != 'name' else 'oil_lacks_name', field=repr(field)) in said
