# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A study goes on where it stopped, and says what failed."""

import importlib

from surrogate.tasks.kept import run_kept
from surrogate.tasks.store import store_path, TaskStore


def test_kept_results_are_returned_and_failures_told(tmp_path, capsys, monkeypatch):
    """By name; a second run asks no task again that has a result."""
    (tmp_path / 'kept_tasks.py').write_text(
        "def turn(inputs):\n    return {1 if inputs['bad'] else 'value': inputs['value']}\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    turn = importlib.import_module('kept_tasks').turn
    good, bad = {'value': 1.0, 'bad': False}, {'value': 2.0, 'bad': True}
    inputs = {'good': good, 'bad': bad}
    out = tmp_path / 'table.csv'
    assert run_kept(out, 'test 1', turn, inputs, workers=1) == {'good': {'value': 1.0}}
    told = capsys.readouterr().err
    assert 'bad: TypeError: keys of a result are words' in told
    assert '2/2 tasks' in told
    with TaskStore(out, 'test 1') as store:
        assert len(store) == 1
    assert store_path(out).exists()
    expected = {'other name': {'value': 1.0}}
    assert run_kept(out, 'test 1', turn, {'other name': good}) == expected
