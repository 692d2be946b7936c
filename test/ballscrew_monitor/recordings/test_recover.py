# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The intact part of a recording whose writer was killed becomes a complete bag."""

import contextlib
import os
from pathlib import Path
import signal
import sqlite3
import subprocess
import sys

from ballscrew_monitor.recordings import bag_writer
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_files import OWN
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.recover import recover
from mcap.reader import make_reader
import pytest
import yaml

DEADLINE = 600.0  # [s] which only ends a hang
TOPIC = Topic(name='/a', type_name='std_msgs/msg/Float64', offer=Offer.LATCHED)
KILLED = """
import os, signal, sys
from pathlib import Path
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
writer = BagWriter(Path(sys.argv[1]), 'flight')
writer.add_topic(Topic(name='/a', type_name='std_msgs/msg/Float64', offer=Offer.LATCHED))
for number in range(200):
    writer.write('/a', os.urandom(4096), log_time=number * 10**9, publish_time=7, sequence=number)
os.kill(os.getpid(), signal.SIGKILL)
"""


def numbers(path):
    return [
        (one.log_time // 10**9, one.publish_time, one.sequence) for one in Bag(path).messages()
    ]


def test_a_writer_that_was_killed_loses_its_last_chunk_at_most(tmp_path):
    killed = [sys.executable, '-c', KILLED, str(tmp_path)]
    done = subprocess.run(killed, check=False, timeout=DEADLINE)
    assert done.returncode == -signal.SIGKILL
    active = tmp_path / 'flight.mcap.active'
    before = active.read_bytes()
    path, count, seconds, lost = recover(tmp_path)
    assert (path, active.read_bytes()) == (tmp_path / 'flight.mcap', before)
    assert count > 200 - 2 * 64 * 1024 // 4096
    assert seconds == count - 1
    assert lost == ''
    assert numbers(tmp_path) == [(number, 7, number) for number in range(count)]
    stated = yaml.safe_load((tmp_path / 'metadata.yaml').read_text())
    topic = stated['rosbag2_bagfile_information']['topics_with_message_count'][0]
    assert topic['topic_metadata']['offered_qos_profiles'] == [Offer.LATCHED.profile]


@pytest.fixture
def whole(tmp_path):
    with BagWriter(tmp_path, 'whole') as writer:
        writer.add_topic(TOPIC)
        for number in range(100):
            writer.write('/a', os.urandom(9000), log_time=number * 10**9, publish_time=7)
    return tmp_path / 'whole.mcap'


@pytest.mark.parametrize('share', [0.1, 0.33, 0.5, 0.9, 0.999])
def test_a_file_that_was_cut_gives_what_lies_before_the_cut(whole, share):
    data = whole.read_bytes()
    whole.write_bytes(data[: int(share * len(data))])
    path, count, *_ = recover(whole)
    assert path.parent.name == 'whole_recovered'
    assert numbers(path.parent) == [(number, 7, number) for number in range(count)]
    assert count >= int(100 * share) - 9


def test_what_lies_before_damage_is_recovered_and_what_is_lost_is_said(whole, says):
    with whole.open('rb') as stream:
        begins = [
            one.chunk_start_offset for one in make_reader(stream).get_summary().chunk_indexes
        ]
    data = bytearray(whole.read_bytes())
    data[begins[1] + 100] ^= 0x55
    whole.write_bytes(data)
    path, count, _, lost = recover(whole)
    assert numbers(path.parent) == [(number, 7, number) for number in range(count)]
    assert 0 < count < 200 / len(begins)
    assert lost == says('lost', bytes=len(data) - begins[1], at=begins[1])


@pytest.mark.parametrize(
    'text', ['', '2020-13-45', 'a text', '[: {', '[' * 5000, '- a', '!!python/object:os.x {}']
)
def test_what_a_topic_offers_may_be_rubbish(text, tmp_path, monkeypatch):
    monkeypatch.setattr(bag_writer.yaml, 'safe_dump', lambda *_, **__: text)
    with BagWriter(tmp_path, 'a') as writer:
        writer.announce('/a', 'T', b'', type_hash='', profiles=[])
        writer.write('/a', bytes(8), log_time=1, publish_time=1)
    monkeypatch.undo()
    path, count, *_ = recover(tmp_path / 'a.mcap')
    assert (numbers(path), count) == ([(0, 1, 0)], 1)


@pytest.mark.parametrize('content', [b'', b'\x89MCAP0\r\n', b'not a recording at all'])
def test_where_nothing_is_whole_a_sentence_says_so(tmp_path, content, refused):
    file = tmp_path / 'a.mcap.active'
    file.write_bytes(content)
    refused('holds_message_whole', recover, file)
    assert [*tmp_path.iterdir()] == [file]


def test_a_sqlite3_file_is_not_said_to_hold_no_message(tmp_path, refused):
    file = tmp_path / 'a_0.db3'
    with contextlib.closing(sqlite3.connect(file)) as base, base:
        base.execute('CREATE TABLE messages(id INTEGER PRIMARY KEY)')
    for path in (file, tmp_path):
        with refused('of_sqlite', file=file):
            recover(path)
    assert [*tmp_path.iterdir()] == [file]


def test_nothing_is_written_over_and_what_is_not_there_is_said(tmp_path, whole, refused):
    active = Path(f'{whole}.active')
    active.write_bytes(whole.read_bytes())
    refused('there_already', recover, active)
    refused('does_exist', recover, tmp_path / 'none.mcap')
    active.unlink()
    refused('holds_0_unfinished', recover, tmp_path)


def test_types_that_are_not_installed_and_what_a_file_says_of_itself_are_kept(tmp_path):
    with BagWriter(tmp_path, 'b') as writer:
        kind, definition = 'mill_msgs/msg/Mill', b'float64 data'
        writer.announce('/a', kind, definition, type_hash='RIHS01_0', profiles=[])
        writer.add_metadata({'source': 'mill.csv'})
        writer.add_metadata({'key': 'value'}, name='of others')
        writer.write('/a', bytes(12), log_time=5, publish_time=7)
    (tmp_path / 'b.mcap').rename(tmp_path / 'b.mcap.active')
    path, *_ = recover(tmp_path / 'b.mcap.active')
    assert Bag(path).types == {'/a': 'mill_msgs/msg/Mill'}
    with path.open('rb') as stream:
        said = {one.name: one.metadata for one in make_reader(stream).iter_metadata()}
    assert said == {OWN: {'source': 'mill.csv'}, 'of others': {'key': 'value'}}
    stated = yaml.safe_load((path.parent / 'metadata.yaml').read_text())
    assert stated['rosbag2_bagfile_information']['custom_data'] == {'source': 'mill.csv'}


@pytest.mark.parametrize(
    ('key', 'begin'), [('of_zstd', b'\x28\xb5\x2f\xfd'), ('of_parquet', b'PAR1')]
)
def test_a_file_of_another_kind_is_named(tmp_path, refused, key, begin):
    path = tmp_path / 'a.mcap'
    path.write_bytes(begin + bytes(500))
    with refused(key, file=path):
        recover(path)
