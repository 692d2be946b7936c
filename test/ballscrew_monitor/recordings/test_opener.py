# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Any log as a bag, and what is said of those that are none."""

import gzip
import shutil

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.opener import opened_log
import pytest
from surrogate.files import InputError


def sentence(path, **how):
    with pytest.raises(InputError) as caught:
        opened_log(path, **how)
    assert '\n' not in str(caught.value)
    return str(caught.value)


def test_a_bag_is_opened_and_what_is_whole_of_a_damaged_one(short_bag, tmp_path):
    bag = opened_log(short_bag)
    whole = list(bag.messages())
    assert not bag.notes
    data = (short_bag / 'short.mcap').read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(data[: 3 * len(data) // 4])
    bag = opened_log(tmp_path / 'cut.mcap')
    assert 0 < len(list(bag.messages())) < len(whole)
    assert 'is truncated or damaged: used are the' in bag.notes[0]


def test_a_table_needs_a_map_and_a_bag_none(short_bag, tmp_path):
    table, mapping = tmp_path / 'log.csv', tmp_path / 'map.yaml'
    table.write_text('t,v,f\n0,100,1\n0.1,100,1\n')
    mapping.write_text(
        'time: {column: t, unit: s, epoch: 2000-01-01}\n'
        'axes: {x: {lead_mm: 10.0, speed: {column: v, unit: mm/s}, '
        'load: {column: f, unit: N}}}\n'
    )
    assert 'a table needs a map: ballscrew import' in sentence(table)
    assert 'is a bag, a map is for tables' in sentence(short_bag, mapping=mapping)
    bag = opened_log(table, mapping=mapping)
    assert bag.path == table
    assert len(list(bag.messages())) == 4
    assert sorted(path.name for path in tmp_path.iterdir()) == ['log.csv', 'map.yaml']


@pytest.mark.parametrize('name', ['log.csv.gz', 'log.txt', 'LOG'])
@pytest.mark.parametrize(
    'coded',
    [
        lambda text: gzip.compress(text.encode()),
        lambda text: gzip.compress(text.encode('utf-16')),
        *(
            lambda text, coding=coding: text.encode(coding)
            for coding in ('utf-8', 'utf-16', 'utf-16-le', 'utf-16-be', 'utf-32', 'utf-32-be')
        ),
    ],
)
def test_a_table_is_one_in_whatever_coding_and_by_any_name(name, coded, tmp_path):
    table, mapping = tmp_path / name, tmp_path / 'map.yaml'
    table.write_bytes(coded('t,v,f\n' + ''.join(f'{at / 10},100,1\n' for at in range(20))))
    mapping.write_text(
        'time: {column: t, unit: s, epoch: 2000-01-01}\n'
        'axes: {x: {lead_mm: 10.0, speed: {column: v, unit: mm/s}, '
        'load: {column: f, unit: N}}}\n'
    )
    assert len(list(opened_log(table, mapping=mapping).messages())) == 40


def test_no_log_at_all(tmp_path, says):
    assert 'does not exist' in sentence(tmp_path / 'nothing')
    assert 'holds no log' in sentence(tmp_path)
    (tmp_path / 'one.csv').touch()
    assert sentence(tmp_path).endswith(says('tables_such_as'))
    odd = tmp_path / 'picture.png'
    odd.write_bytes(b'\x89PNG')
    assert 'is neither a bag nor a table' in sentence(odd)
    bag1 = tmp_path / 'old.mcap'
    bag1.write_bytes(b'#ROSBAG V2.0\n')
    assert 'is of ROS 1, it must be converted' in sentence(bag1)


def test_an_unfinished_recording_is_a_log(short_bag, tmp_path):
    shutil.copy(short_bag / 'short.mcap', tmp_path / 'run.mcap.active')
    bag = opened_log(tmp_path)
    assert len(list(bag.messages())) == len(list(Bag(short_bag).messages()))
