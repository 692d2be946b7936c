# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The bench that thins the shipped surface: what it keeps, counts and compares."""

import importlib.util
from pathlib import Path
import sys

import numpy as np
import pytest
from surrogate.surface import find_surface, Surface
from surrogate.surface.file import read

SPEC = importlib.util.spec_from_file_location(
    'surface_nodes', Path(__file__).resolve().parents[2] / 'studies' / 'surface_nodes.py'
)
bench = importlib.util.module_from_spec(SPEC)
sys.modules['surface_nodes'] = bench
SPEC.loader.exec_module(bench)


@pytest.fixture(name='data', scope='module')
def read_shipped():
    """Return the shipped surface of solved contacts."""
    return read(find_surface('full'))


def test_ends_and_breaks_stay(data):
    """Every second node goes but these; fields follow, and fewer points are solved."""
    less = bench.thin(data, 2, 2)
    assert set(data.header['load_breaks']) <= set(less.load)
    assert less.load[[0, -1]].tolist() == data.load[[0, -1]].tolist()
    assert less.speed_coordinate[[0, -1]].tolist() == data.speed_coordinate[[0, -1]].tolist()
    assert np.array_equal(less.load, -less.load[::-1])
    for i, s in enumerate(less.speed_coordinate):
        for j, load in enumerate(less.load):
            whole = (data.speed_coordinate == s, data.load == load)
            there = data.fields['rcs'][np.ix_(*whole)][0, 0]
            assert np.array_equal(less.fields['rcs'][i, j], there, equal_nan=True)
    assert 0 < bench.solved_points(less) < bench.solved_points(data)


def test_all_nodes_differ_by_nothing_and_fewer_by_something(data, monkeypatch):
    """In the errors that are allowed."""
    monkeypatch.setattr(bench, 'POINTS', 100)
    whole = Surface(data)
    same, fewer = (bench.compare(whole, bench.thin(data, step, step)) for step in (1, 3))
    assert len(same) == 100
    assert max(same) == 0
    assert np.median(fewer) > 0
    assert max(fewer) > 1
