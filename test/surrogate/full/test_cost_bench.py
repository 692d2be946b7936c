# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The benches of the full tier solve, print and draw; on a stand-in for the solver."""

from functools import partial
import importlib.util
from pathlib import Path
import sys

import numpy as np
import pytest
from surrogate.full.run import ChainRun

BENCH = Path(__file__).resolve().parents[3] / 'bench'


@pytest.fixture(name='bench')
def make_bench(monkeypatch, stand_in, here):
    """Return a bench by its name, as a module that dataclasses find, on the stand-in."""

    def bench(name):
        file = BENCH / f'{name}.py'
        spec = importlib.util.spec_from_file_location(f'bench_{name}', file)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, f'bench_{name}', module)
        spec.loader.exec_module(module)
        monkeypatch.setattr(module, 'open_pool', lambda workers: here())
        monkeypatch.setattr(module, 'ChainRun', partial(ChainRun, task=stand_in.solve))
        return module

    return bench


def test_half_grid_tells_more_than_a_cubic(bench, monkeypatch, capsys):
    """A table of all speeds; draws correlate, and the half grid finds what was left out."""
    monkeypatch.setattr(sys, 'argv', ['half_grid.py', '--draws', '6', '--load-N', '500'])
    bench('half_grid').main()
    head, titles, *rows = capsys.readouterr().out.splitlines()
    assert head.startswith('6 draws, 500 N; fine over half grid: ')
    assert len(rows) == 8
    table = np.array([[float(word) for word in row.split()] for row in rows])
    touching = table[:, 1] > 0
    assert touching.sum() > 3
    assert (table[touching, 5] > 0.8).all()
    cubic, half = np.abs(table[1:-1, 6:]).T
    assert half.max() < cubic.max()


def test_cost_is_measured_and_drawn(bench, monkeypatch, tmp_path, capsys):
    """Two accuracies: the finer one has more nodes and no larger error of RCS."""
    words = ['surface.py', '--accuracy', '8', '1', '--draws', '2', '--out', str(tmp_path)]
    monkeypatch.setattr(sys, 'argv', words)
    bench('surface').main()
    head, *rows = capsys.readouterr().out.splitlines()
    assert head.startswith('accuracy  nodes')
    coarse, fine = ([float(word) for word in row.split()] for row in rows)
    assert fine[1] > coarse[1]
    assert fine[-1] < coarse[-1]
    assert [path.name for path in tmp_path.iterdir()] == ['surface_cost.png']
