# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The cost bench builds, prints and draws; on a stand-in for the solver."""

from functools import partial
import importlib.util
from pathlib import Path
import sys

import pytest
from surrogate.builder.full.run import ChainRun

FILE = Path(__file__).resolve().parents[2] / 'studies' / 'surface.py'


@pytest.fixture(name='bench')
def load_bench(monkeypatch):
    """Return the bench as a module that dataclasses find."""
    spec = importlib.util.spec_from_file_location('bench_surface', FILE)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, 'bench_surface', module)
    spec.loader.exec_module(module)
    return module


def test_cost_is_measured_and_drawn(bench, stand_in, here, monkeypatch, tmp_path, capsys):
    """Two accuracies: the finer one has more nodes and no larger error of RCS."""
    monkeypatch.setattr(bench, 'open_pool', lambda workers: here())
    monkeypatch.setattr(bench, 'ChainRun', partial(ChainRun, task=stand_in.solve))
    words = ['surface.py', '--accuracy', '8', '1', '--draws', '2', '--out', str(tmp_path)]
    monkeypatch.setattr(sys, 'argv', words)
    bench.main()
    head, *rows = capsys.readouterr().out.splitlines()
    assert head.startswith('accuracy  nodes')
    coarse, fine = ([float(word) for word in row.split()] for row in rows)
    assert fine[1] > coarse[1]
    assert fine[-1] < coarse[-1]
    files = sorted(path.name for path in tmp_path.iterdir())
    assert files == ['surface_cost.csv', 'surface_cost.png']


def test_rows_are_kept_and_replaced(bench, tmp_path):
    """By accuracy and draws; numbers come back as they were."""
    cost = bench.Cost(2.0, 4, 100, 200, 61.5, 31.25, 1e-3, 2e-3, 1.75)
    finer, other = bench.replace(cost, accuracy=1.0), bench.replace(cost, draws=2)
    table = tmp_path / 'surface_cost.csv'
    assert bench.kept(table) == []
    for one in (finer, cost, other, bench.replace(finer, nodes=7)):
        bench.keep(one, table)
    assert bench.kept(table) == [cost, other, bench.replace(finer, nodes=7)]
