# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Turns are judged compiled where events come fast, once the code is there; else interpreted."""

import importlib
from pathlib import Path
import sys
import threading

from ballscrew_monitor.node import compiled_turns
from ballscrew_monitor.node.compiled_turns import COMPILED_FROM, CompiledTurns, SPAN
import pytest
from surrogate.files import InputError

DEADLINE = 600.0  # [s] which only ends a hang


class Bench:
    """Turns whose events come at a rate on a clock of their own, and what is done for them."""

    def __init__(self, monkeypatch):
        self.warnings, self.done, self.now = [], [], 0.0
        self.turns = CompiledTurns(self.warnings.append)
        monkeypatch.setattr(compiled_turns, 'result_apart', self._compile)
        monkeypatch.setattr(compiled_turns, 'load', lambda inputs: self.done.append('loaded'))
        self.refusal = None

    def _compile(self, task, inputs, **options):
        self.done.append(task)
        if self.refusal is not None:
            raise self.refusal

    def run(self, rate, seconds=2.0 * SPAN):
        """Let events come at a rate [1/s]; return whether turns are judged compiled then."""
        for _ in range(round(100 * seconds)):
            self.now += 0.01
            self.turns.count(round(rate / 100), self.now)
        if self.turns._thread is not None:
            self.turns._thread.join(DEADLINE)
        return self.turns.are_due


@pytest.fixture(name='bench')
def make_bench(monkeypatch):
    bench = Bench(monkeypatch)
    bench.run(0.0)
    return bench


def test_slow_events_load_nothing(bench):
    assert not bench.run(0.9 * COMPILED_FROM, seconds=60.0)
    assert bench.done == []


def test_fast_ones_are_judged_compiled_as_long_as_they_come(bench):
    assert bench.run(1.1 * COMPILED_FROM)
    assert not bench.run(0.9 * COMPILED_FROM)
    assert bench.run(1.1 * COMPILED_FROM)
    assert bench.done == ['ballscrew_monitor.node.compiled_turns:load', 'loaded']
    assert bench.warnings == []


@pytest.mark.parametrize(
    'refusal',
    [
        InputError("the judgement is not compiled: No module named 'numba'"),
        RuntimeError('cannot cache function: no locator available'),
        OSError('no process'),
    ],
)
def test_what_cannot_be_compiled_is_warned_of_once(bench, refusal, says):
    bench.refusal = refusal
    assert not bench.run(1.1 * COMPILED_FROM, seconds=10.0)
    assert not bench.run(0.9 * COMPILED_FROM)
    assert not bench.run(1.1 * COMPILED_FROM, seconds=10.0)
    assert bench.warnings == [says('not_compiled', why=str(refusal))]
    assert len(bench.done) == 1


@pytest.mark.parametrize('breaks', [False, True])
def test_before_each_module_that_it_loads_the_thread_waits_until_nothing_waits(
    bench, monkeypatch, tmp_path, breaks
):
    """Another thread that imports meanwhile does not wait for the inputs itself."""
    for name in ('turns_first', 'turns_second', 'turns_aside'):
        (tmp_path / f'{name}.py').write_text('1 / 0' if breaks and 'second' in name else '')
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.syspath_prepend(tmp_path)

    def wait(timeout):
        bench.done.append(sorted(name for name in sys.modules if name.startswith('turns_')))

    def load(inputs):
        importlib.import_module('turns_first')
        aside = threading.Thread(target=importlib.import_module, args=('turns_aside',))
        aside.start()
        aside.join(DEADLINE)
        importlib.import_module('turns_second')

    monkeypatch.setattr(bench.turns.at_rest, 'wait', wait)
    monkeypatch.setattr(compiled_turns, 'load', load)
    before = list(sys.meta_path)
    assert bench.run(1.1 * COMPILED_FROM) is not breaks
    assert bench.done[1:] == [[], ['turns_aside', 'turns_first']]
    assert sys.meta_path == before


def test_the_guide_states_the_rate():
    guide = (Path(__file__).parents[3] / 'docs' / 'guide' / 'own_machine.md').read_text()
    assert f'From {COMPILED_FROM:g} messages a second on' in guide
