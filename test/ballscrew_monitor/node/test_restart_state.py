# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Writes of the state: at once, but never in a flood, and again until they work."""

from pathlib import Path
import shutil
import threading

from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.node import restart_state
from ballscrew_monitor.node.restart_state import PAUSE, RestartState, RETRY, state_directory
from ballscrew_monitor.node.state_database import FILE, read_entries, StateDatabase
from ballscrew_monitor.node.state_records import Corrections, entry_of, Kind
import pytest
from surrogate.files import store

SOLVES = '[' + ' ' * 998 + ']'


@pytest.fixture(name='state')
def make_state(tmp_path):
    state = RestartState(tmp_path, limit=400_000)
    yield state
    state.close()


def entry(number):
    return entry_of(Kind.NODE_START, None, number, {})


def record(number, axis='x'):
    return AxisRecord(axis=axis, event=number)


def kept(state):
    """Return what is on the disk: the entries, and the last event of axis x."""
    rows = state._database._database.execute('SELECT event FROM axes').fetchall()
    return [one.stamp_ns for one in read_entries(state.folder)], [row[0] for row in rows]


def test_a_flood_is_written_in_turns(state):
    assert state.work(0.0) is None
    state.keep(record(1), entry(1))
    assert state.work(10.0) is None
    assert kept(state) == ([1], [1])
    state.keep(record(2), entry(2))
    state.keep(record(3))
    assert state.work(10.0) == 10.0 + PAUSE
    assert kept(state) == ([1], [1])
    assert state.recall(record(0)).event == 3
    assert state.work(10.0 + PAUSE) is None
    assert kept(state) == ([1, 2], [3])


def test_what_has_not_changed_is_not_written(state):
    state.keep(record(1))
    state.work(0.0)
    state.keep(record(1))
    assert not state._is_waiting


def refuse(*args):
    raise OSError(28, 'No space left on device')


def fail(*args):
    raise RuntimeError('surprise')


def test_what_cannot_be_written_waits(state, monkeypatch, says):
    with monkeypatch.context() as full:
        full.setattr(StateDatabase, 'write', refuse)
        state.keep(record(1), entry(1))
        assert state.work(0.0) == RETRY
        assert state.problem == says('cannot_written_space', folder=state.folder)
        state.keep(record(2), entry(2))
        assert state.flush() == state.problem
    assert state.work(RETRY) is None
    assert state.problem == ''
    assert kept(state) == ([1, 2], [2])


def test_a_disk_that_is_full_is_tried_until_it_is_not(state, says):
    database = state._database
    database._database.execute('PRAGMA max_page_count = 1')
    for number in range(100):
        state.keep(record(number), entry(number))
    assert state.flush() == says('cannot_written_database', folder=state.folder)
    assert not database.is_open
    assert state.flush() == ''
    assert kept(state) == (list(range(100)), [99])


def test_what_waits_is_bounded_and_the_oldest_go(state, monkeypatch):
    state._entries = type(state._entries)(maxlen=3)
    with monkeypatch.context() as full:
        full.setattr(StateDatabase, 'write', refuse)
        for number in range(5):
            state.keep(None, entry(number))
            state.flush()
    state.flush()
    assert kept(state)[0] == [2, 3, 4]


def test_what_fails_unexpectedly_waits_and_is_told(state, monkeypatch, says):
    state.keep(record(1), entry(1))
    with monkeypatch.context() as broken:
        broken.setattr(StateDatabase, 'write', fail)
        assert state.flush() == says('cannot_written_runtimeerror', folder=state.folder)
    assert state.flush() == ''
    assert kept(state) == ([1], [1])


def test_what_comes_while_all_is_written_is_written_next(state, monkeypatch):
    write = StateDatabase.write

    def slow(*args):
        state.keep(record(2), entry(2))
        write(*args)

    state.keep(record(1), entry(1))
    with monkeypatch.context() as busy:
        busy.setattr(StateDatabase, 'write', slow)
        assert state.work(0.0) == PAUSE
    assert kept(state) == ([1], [1])
    assert state.flush() == ''
    assert kept(state) == ([1, 2], [2])


def test_a_thread_writes_what_comes(state):
    state.start()
    for number in range(100):
        state.keep(record(number), entry(number))
    assert state.flush() == ''
    assert kept(state) == (list(range(100)), [99])
    thread = state._thread
    state.close()
    assert not thread.is_alive()
    state.keep(record(100), entry(100))
    assert state.flush() == f'{state.folder} is closed'
    again = RestartState(state.folder)
    assert again.recall(record(0)).event == 99
    again.close()


def test_nobody_waits_for_a_disk_that_does_not_answer(state, monkeypatch):
    answer = threading.Event()
    monkeypatch.setattr(restart_state, 'PATIENCE', 0.0)
    monkeypatch.setattr(StateDatabase, 'write', lambda *_: answer.wait())
    state.start()
    state.keep(record(1))
    thread = state._thread
    assert state.flush() == state.problem == f'{state.folder} does not answer'
    state.keep(record(2))  # that of a sample, which does not wait
    assert state.keep_corrections(Corrections('x')) == state.problem
    state.close()
    answer.set()
    thread.join()
    state._database.close()


def test_what_was_left_is_read_before_anything_is_written(state, monkeypatch, says):
    state.keep(record(41))
    state.close()
    with monkeypatch.context() as broken:
        broken.setattr(store, 'is_empty', fail)
        again = RestartState(state.folder)
        again.keep(record(1))
        assert again.flush() == says('cannot_written_runtimeerror', folder=state.folder)
    assert again.flush() == ''
    assert kept(again) == ([], [41])
    again.close()


def test_a_second_node_takes_over_when_the_first_is_gone(state, says):
    state.keep(record(41))
    second = RestartState(state.folder)
    assert second.problem == says('use_by_another', folder=state.folder)
    second.keep(record(1), entry(1))
    assert second.work(0.0) == RETRY
    state.close()
    assert second.work(RETRY) == RETRY + PAUSE
    # What the first has left is not replaced before somebody has seen it.
    assert kept(second) == ([1], [41])
    assert second.is_late('x')
    assert second.recall(record(0)).event == 41
    assert second.recall(record(0)).event == 1
    second.keep(record(42))
    assert second.work(RETRY + PAUSE) is None
    assert (second.problem, kept(second)) == ('', ([1], [42]))
    second.close()


def test_a_directory_is_taken_as_soon_as_it_is_there(tmp_path):
    place = tmp_path / 'disk'
    place.write_text('not mounted yet')
    state = RestartState(place / 'state')
    assert state.problem == f'{place / "state"} cannot be written, Not a directory'
    state.keep(record(1), entry(1))
    place.unlink()
    assert state.flush() == ''
    assert kept(state) == ([1], [1])
    state.close()


@pytest.mark.parametrize('content', [None, b'no database' * 1000])
def test_a_file_that_is_gone_or_damaged_is_written_once_more(state, content):
    state.keep(record(7))
    state.keep_corrections(Corrections('x', 'abc'))
    (state.folder / FILE).unlink()
    if content:
        (state.folder / FILE).write_bytes(content)
        state._database.let_go()
    assert state.flush() == ''
    assert kept(state) == ([], [7])
    assert state.recall(Corrections('x')).surface == 'abc'
    assert bool(state.damage) is bool(content)
    state.forget_problems()
    assert state.problem == ''


@pytest.mark.parametrize('makes_anew', [True, False])
def test_a_folder_that_is_gone_is_taken_again(state, says, makes_anew):
    """Without anything to write, and for this node alone: the lock went with the folder."""
    state.keep(record(7), entry(1))
    state.work(0.0)
    state.look()
    assert state.work(1.0) is None
    shutil.rmtree(state.folder)
    if makes_anew:
        state.folder.mkdir()
        (state.folder / FILE).touch()
    assert not state.is_held
    state.look()
    assert state.problem == says('gone', folder=state.folder)
    assert state.work(2.0) is None
    assert state.is_held
    assert kept(state) == ([], [7])
    assert state.problem == says('lost', folder=state.folder)
    second = RestartState(state.folder)
    assert second.problem == says('use_by_another', folder=state.folder)
    second.close()


def test_a_folder_that_another_node_has_made_anew_is_its_own(state, says):
    state.keep(record(7))
    state.work(0.0)
    shutil.rmtree(state.folder)
    second = RestartState(state.folder)
    second.keep(record(1))
    second.flush()
    state.keep(record(8))
    assert state.flush() == says('use_by_another', folder=state.folder)
    assert not state.is_held
    assert kept(second) == ([], [1])
    second.close()


def test_corrections_leave_room_for_the_sums(state):
    full = f'{state.folder} is at its state_limit of 0.4 MB'
    assert state.keep_corrections(Corrections('x', 'abc', SOLVES * 50)) == ''
    assert state.keep_corrections(Corrections('y', 'abc', SOLVES * 51)) == full
    assert state.problem == f'corrections of y are not kept, {full}'
    assert state.keep_corrections(Corrections('y', 'abc', SOLVES * 50)) == state.problem == ''


def test_no_directory_keeps_nothing():
    state = RestartState(None)
    state.start()
    assert state.keep_corrections(Corrections('x')) == 'state_dir is empty'
    assert (state.flush(), state.problem) == ('', '')
    state.close()


@pytest.mark.parametrize(
    ('wanted', 'variable', 'place'),
    [
        ('', '/state', None),
        ('/var/lib/screw', '/state', '/var/lib/screw'),
        ('auto', '/state', '/state/ballscrew_monitor/cell/monitor'),
        ('auto', '', '/someone/.local/state/ballscrew_monitor/cell/monitor'),
    ],
)
def test_where_things_are_kept(monkeypatch, wanted, variable, place):
    """Without the variable it is the place of the specification."""
    monkeypatch.delenv('XDG_STATE_HOME', raising=False)
    monkeypatch.setenv('HOME', '/someone')
    if variable:
        monkeypatch.setenv('XDG_STATE_HOME', variable)
    assert state_directory(wanted, '/cell/monitor') == (place and Path(place))
