# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The event log: whole lines, one file after the other, whatever tears or fills them."""

import json
import os

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.node.event_log import event_facts, EventLog, Kind, line_of
from ballscrew_monitor.node.state_folder import StateFolder
import pytest

TIME = '2026-11-23T12:00:00.000+00:00'


@pytest.fixture(name='log')
def make_log(tmp_path):
    folder = StateFolder(tmp_path, limit=20_000)
    yield EventLog(folder)
    folder.close()


def event_line(kind, number, axis='x'):
    event = Event(number=number, stamp=3 * SECOND, start=SECOND)
    return line_of(kind, time=TIME, stamp=event.stamp, axis=axis, **event_facts(event))


def lines_of(tmp_path):
    return [json.loads(line) for line in (tmp_path / 'events.jsonl').read_text().splitlines()]


def test_a_line_says_what_when_where_and_why(log, tmp_path):
    assert log.append([event_line(Kind.EVENT_END, 4)]) == ''
    (line,) = lines_of(tmp_path)
    assert list(line)[:5] == ['time', 'stamp_ns', 'axis', 'kind', 'event']
    assert (line['time'], line['stamp_ns'], line['axis']) == (TIME, 3 * SECOND, 'x')
    assert (line['kind'], line['event'], line['duration_s']) == ('event_end', 4, 2.0)
    assert (line['cause'], line['value'], line['limit']) == ('UNKNOWN', None, None)


def test_a_torn_line_is_skipped_and_the_next_one_begins_anew(log, tmp_path):
    log.append([event_line(Kind.EVENT_BEGIN, 1), event_line(Kind.EVENT_BEGIN, 2)])
    path = tmp_path / 'events.jsonl'
    os.truncate(path, path.stat().st_size - 9)
    assert log.last_events()['x'].number == 1
    log.append([event_line(Kind.EVENT_BEGIN, 3)])
    assert log.last_events()['x'].number == 3
    whole = [line.endswith('}') for line in path.read_text().splitlines()]
    assert whole == [True, False, True]


def test_the_last_event_of_each_axis_and_whether_it_is_open(log):
    log.append(
        [
            event_line(Kind.EVENT_BEGIN, 1),
            event_line(Kind.EVENT_END, 1),
            event_line(Kind.EVENT_BEGIN, 2),
            event_line(Kind.EVENT_BEGIN, 9, axis='y'),
            line_of(Kind.NODE_STOP, time=TIME, stamp=0, axis=None),
            event_line(Kind.EVENT_END, 9, axis='y'),
            '{"kind": "event_begin", "axis": "z"}',
            '[1, 2]',
        ]
    )
    found = log.last_events()
    assert {axis: (one.number, one.active) for axis, one in found.items()} == {
        'x': (2, True),
        'y': (9, False),
    }


def test_it_is_rotated_and_stays_within_the_limit(log, tmp_path):
    for number in range(1, 201):
        assert log.append([event_line(Kind.EVENT_BEGIN, number)]) == ''
        assert sum(path.stat().st_size for path in tmp_path.iterdir()) <= 20_000
        assert log.last_events()['x'].number == number
    names = sorted(path.name for path in tmp_path.glob('events.*.jsonl'))
    assert len(names) > 4
    assert 'events.000001.jsonl' not in names


def test_a_copy_beside_the_log_is_neither_counted_nor_removed(log, tmp_path):
    copies = [tmp_path / name for name in ('events.old.jsonl', 'events.1 (copy).jsonl')]
    for path in copies:
        path.write_text('my own')
    for number in range(1, 201):
        assert log.append([event_line(Kind.EVENT_BEGIN, number)]) == ''
    assert log.last_events()['x'].number == 200
    assert [path.read_text() for path in copies] == ['my own', 'my own']


def test_a_full_disk_is_told_and_nothing_half_written_stays(log, tmp_path, monkeypatch):
    log.append([event_line(Kind.EVENT_BEGIN, 1)])
    path = tmp_path / 'events.jsonl'
    before = path.read_bytes()

    def refuse(number):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(os, 'fsync', refuse)
    told = log.append([event_line(Kind.EVENT_END, 1)])
    assert told == f'{tmp_path} cannot be written, No space left on device'
    assert path.read_bytes() == before
    monkeypatch.undo()
    assert log.append([event_line(Kind.EVENT_END, 1)]) == ''
    assert not log.last_events()['x'].active


def test_a_device_that_is_full(log, tmp_path):
    (tmp_path / 'events.jsonl').symlink_to('/dev/full')
    assert 'No space left on device' in log.append([event_line(Kind.EVENT_BEGIN, 1)])
