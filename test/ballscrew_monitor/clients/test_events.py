# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew events`, while a node runs or not."""

import json

from ballscrew_monitor.cli import main
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_records import entry_of, Kind
import pytest


@pytest.fixture(name='state')
def make_state(tmp_path):
    state = RestartState(tmp_path / 'ballscrew_monitor' / 'ballscrew_monitor')
    state.keep(None, entry_of(Kind.NODE_START, None, 1, {}))
    facts = {'event': 4, 'text': '', 'ending': 'ended', 'worst_value': float('nan')}
    state.keep(None, entry_of(Kind.EVENT_END, 'x', 2, facts))
    state.flush()
    yield state
    state.close()


def test_the_log_is_printed_for_people(state, capsys):
    assert main(['events', str(state.folder)]) == 0
    start, end = capsys.readouterr().out.splitlines()
    assert start.split()[1:] == ['-', 'node_start']
    assert end.split()[1:] == ['x', 'event_end', 'event', '4:', 'ended']


def test_the_log_is_exported_as_lines_of_json(state, capsys, monkeypatch, tmp_path):
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    state.close()
    assert main(['events', '--json']) == 0
    start, end = map(json.loads, capsys.readouterr().out.splitlines())
    assert (start['kind'], start['axis'], start['stamp_ns']) == ('node_start', None, 1)
    assert (end['event'], end['worst_value'], end['ending']) == (4, None, 'ended')


def test_a_folder_without_a_log_is_refused(capsys, tmp_path):
    assert main(['events', str(tmp_path)]) == 2
    assert f'{tmp_path} has no state.sqlite3' in capsys.readouterr().err
