# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of every kind with some bytes changed: read, or refused in a sentence."""

import contextlib
import itertools
from pathlib import Path
import shutil
import sqlite3

from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_monitor.node.state_records import entry_of, Kind
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk.batches import batches
from ballscrew_monitor.recordings.log_facts import facts_of, LogFacts
from ballscrew_monitor.recordings.recover import recover
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.tables.points import PointColumns, read_points
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.settings.parameters import read_file
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer
import numpy as np
import polars as pl
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64
from surrogate.contact.case import load_case
from surrogate.files import InputError
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.import_file import read_surface
from surrogate.surface import SurfaceError
from surrogate.surface.file import read as read_surface_file
import zstandard

ROOT = Path(__file__).resolve().parents[2]
COUNT, TOPIC = 60, '/a'
TOKENS = (
    *(
        b'\x00',
        b'\xff' * 8,
        b'\n',
        b'\r',
        b'\x1b[2J',
        b'"',
        b"'",
        b',',
        b';',
        b'9' * 400,
        b'-1',
        b'nan',
    ),
    *(
        b'[',
        b'{',
        b']',
        b': ',
        b'- ',
        b'*a ',
        b'&a ',
        b'<<: ',
        b'!!int ',
        b'2020-13-45',
        b'null',
        b'1e999',
    ),
)
CHANGES = st.lists(
    st.tuples(
        st.sampled_from(['flip', 'put', 'insert', 'cut', 'double', 'end']),
        st.floats(0.0, 1.0, exclude_max=True),
        st.integers(1, 255),
        st.one_of(st.sampled_from(TOKENS), st.binary(min_size=1, max_size=9)),
    ),
    min_size=1,
    max_size=4,
)
NO_NOTICE = {'source': 'a.csv', 'parameters': {'axes': ['x']}, 'mapping': {'axes': {'x': {}}}}


def changed(data, changes):
    """Return data with changes at places that are parts of its length."""
    data = bytearray(data)
    for kind, part, number, content in changes:
        at = int(part * len(data))
        end = min(at + number, len(data))
        if kind == 'flip' and data:
            data[at] ^= number
        elif kind == 'put':
            data[slice(at, at + len(content))] = content
        elif kind == 'insert':
            data[at:at] = content
        elif kind == 'cut':
            del data[at:end]
        elif kind == 'double':
            data[at:at] = data[at:end]
        elif kind == 'end':
            del data[at:]
    return bytes(data)


def messages():
    data = [serialize_message(Float64(data=float(number))) for number in range(COUNT)]
    return [(10**18 + number * 10**7, one) for number, one in enumerate(data)]


def own_bag(folder):
    facts = LogFacts(**NO_NOTICE, assumptions=(), notes=('one',))
    with BagWriter(folder, 'own', chunk_size=300) as writer:
        writer.add_metadata(facts.texts())
        writer.add_topic(Topic(name=TOPIC, type_name='std_msgs/msg/Float64', offer=Offer.SENSOR))
        for log_time, data in messages():
            writer.write(TOPIC, data, log_time=log_time, publish_time=log_time)
    return folder / 'own.mcap'


def other_bag(compression, *, chunks=True):
    def make(folder):
        path = folder / 'other.mcap'
        with path.open('wb') as stream:
            writer = Writer(stream, chunk_size=300, compression=compression, use_chunking=chunks)
            writer.start('ros2', 'test')
            schema = writer.register_schema('std_msgs/msg/Float64', 'ros2msg', b'float64 data')
            channel = writer.register_channel(TOPIC, 'cdr', schema)
            for log_time, data in messages():
                writer.add_message(channel, log_time, data, log_time)
            writer.finish()
        return path

    return make


def packed_bag(folder):
    path = own_bag(folder)
    packed = path.with_name('own.mcap.zstd')
    packed.write_bytes(zstandard.compress(path.read_bytes()))
    return packed


def metadata(folder):
    own_bag(folder)
    return folder / 'metadata.yaml'


def database(folder):
    path = folder / 'a.db3'
    with contextlib.closing(sqlite3.connect(path)) as base, base:
        base.executescript(
            'CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, '
            'serialization_format TEXT, offered_qos_profiles TEXT);'
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, '
            'data BLOB); CREATE INDEX timestamp_idx ON messages (timestamp ASC);'
        )
        base.execute("INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/Float64', 'cdr', '')")
        rows = [(1, *one) for one in messages()]
        base.executemany('INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)', rows)
    return path


def read_bag(path):
    bag = Bag(path.parent if path.name == 'metadata.yaml' else path, salvage=True)
    found = [(one.log_time, one.data) for one in bag.messages()]
    list(bag.as_written())
    many = [batch.topics[TOPIC] for batch in batches(bag, [TOPIC]) if TOPIC in batch.topics]
    assert sum(map(len, many)) == sum(1 for _ in bag.messages([TOPIC]))
    list(batches(bag, [TOPIC], as_written=True))
    with contextlib.suppress(InputError):
        facts_of(bag)
    assert all(isinstance(note, str) for note in bag.notes)
    return found


def read_own_bag(path):
    """Every message of a file with checksums is a true one."""
    assert set(read_bag(path)) <= set(messages())
    target = path.with_name('own_recovered')
    shutil.rmtree(target, ignore_errors=True)
    recover(path)


def csv_log(folder):
    path = folder / 'a.csv'
    lines = [f'{number / 100},{number % 7},"{number}"' for number in range(COUNT)]
    path.write_text('\n'.join(['time_s,x_speed,x_load', *lines]))
    return path


def parquet_log(folder):
    path = folder / 'a.parquet'
    times, speeds = np.arange(COUNT) / 100, np.arange(COUNT) % 7
    pl.DataFrame({'time_s': times, 'x_speed': speeds}).write_parquet(path)
    return path


def read_log(path):
    guess(path)
    names = source_of(path).names()
    list(open_table(path, names, optional=names).blocks())


def log_map(folder):
    path = folder / 'map.yaml'
    path.write_text(
        'time: {column: t, unit: s}\naxes: {x: {lead_mm: 10.0, speed: {column: v, unit: rad/s}}}\n'
        'assumed: {time.epoch: {value: 2000-01-01T00:00:00Z, reason: none}}\n'
        'parameters: {publish_period: 1.0}\n'
    )
    return path


def copy_of(name):
    return lambda folder: Path(shutil.copy(ROOT / name, folder))


def state(folder):
    kept = RestartState(folder)
    kept.keep(None, entry_of(Kind.NODE_START, None, 1, {'reason': 'none'}))
    kept.flush()
    kept.close()
    return folder / 'state.sqlite3'


def read_state(path):
    with contextlib.suppress(InputError):
        for entry in read_entries(path.parent):
            entry.record()
    kept = RestartState(path.parent)
    assert isinstance(kept.problem, str)
    kept.close()


def drag_log(folder):
    path = folder / 'a.csv'
    path.write_text('speed_rpm,torque_Nm\n' + ''.join(f'{n},0.{n}\n' for n in range(1, 30)))
    return path


def profile(folder):
    path = folder / 'a.csv'
    path.write_text('x_um,z_um\n' + ''.join(f'{n / 10},0.{n % 7}\n' for n in range(64)))
    return path


SEEDS = {
    'own bag': (own_bag, read_own_bag),
    'lz4': (other_bag(CompressionType.LZ4), read_bag),
    'unchunked': (other_bag(CompressionType.NONE, chunks=False), read_bag),
    'packed': (packed_bag, read_bag),
    'metadata': (metadata, read_bag),
    'database': (database, read_bag),
    'csv': (csv_log, read_log),
    'parquet': (parquet_log, read_log),
    'map': (log_map, read_map),
    'parameters': (copy_of('config/nominal_cycle.yaml'), read_file),
    'screw': (copy_of('surrogate/data/screws/nominal.yaml'), load_screw),
    'oil': (copy_of('surrogate/data/lubricants/iso_vg_68.yaml'), load_lubricant),
    'case': (copy_of('surrogate/data/cases/nominal_smooth.yaml'), load_case),
    'surface': (copy_of('test/data/golden_surface.npz'), read_surface_file),
    'state': (state, read_state),
    'drag': (drag_log, lambda path: read_points(path, PointColumns(lead=0.01))),
    'profile': (profile, read_surface),
}


@pytest.fixture(scope='module')
def seeds(tmp_path_factory):
    """Return the function that gives a whole file by name: path, content, and its reader."""
    found = {}
    for name, (make, read) in SEEDS.items():
        folder = tmp_path_factory.mktemp('seed')
        path = make(folder)
        found[name] = path, path.read_bytes(), read
        read(path)

    def seed(name):  # which is not printed with all files
        return found[name]

    return seed


NUMBER = itertools.count()


@pytest.mark.parametrize('name', SEEDS)
@given(changes=CHANGES)
@settings(max_examples=settings.default.max_examples // 3)
def test_a_changed_file_is_read_or_refused(name, seeds, tmp_path_factory, changes):
    path, data, read = seeds(name)
    folder = path.parent / f'{next(NUMBER)}'
    folder.mkdir()
    if name == 'metadata':
        shutil.copy(path.parent / 'own.mcap', folder)
    target = folder / path.name
    target.write_bytes(changed(data, changes))
    with contextlib.suppress(InputError, SurfaceError):
        read(target)
    shutil.rmtree(folder)
