# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Positions of motor and table out of tables and bags, against the numbers that were written."""

from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.positions import positions_of
from ballscrew_monitor.recordings.tables.convert import make_bag
from ballscrew_monitor.report.parameters import parameters_for
import pytest

ROWS = [(0.1 * n, 3.0 * n, 3.0 * n + 0.004) for n in range(40)]  # s, mm, mm
MAP = """
time: {column: t, unit: s, epoch: 2026-01-05T06:00:00Z}
axes:
  x:
    speed: {column: v, unit: rad/s}
    position: {column: motor, unit: mm}
    table_position: {column: scale, unit: mm}
    load: {unknown: none}
    lead_mm: 10.0
"""


@pytest.fixture
def log(tmp_path):
    """Return a CSV of positions, and its map."""
    lines = [f'{time:.1f},18.85,{motor},{scale}' for time, motor, scale in ROWS]
    (tmp_path / 'log.csv').write_text('\n'.join(['t,v,motor,scale', *lines]) + '\n')
    (tmp_path / 'map.yaml').write_text(MAP)
    return tmp_path / 'log.csv', tmp_path / 'map.yaml'


def positions(bag, params):
    return positions_of(bag, 'x', parameters_for(bag, None, params).values)


def test_a_table_gives_both_positions(log):
    path, mapping = log
    found = positions(opened_log(path, mapping=mapping), mapping)
    assert found.motor == pytest.approx([1e-3 * motor for _, motor, _ in ROWS])
    assert found.table == pytest.approx([1e-3 * scale for _, _, scale in ROWS])
    assert (found.stamps - found.stamps[0]) / 1e9 == pytest.approx([time for time, _, _ in ROWS])


def test_a_map_without_a_position_gives_none(log):
    path, mapping = log
    text = mapping.read_text().replace('    position: {column: motor, unit: mm}\n', '')
    mapping.write_text(text)
    assert positions(opened_log(path, mapping=mapping), mapping) is None


def test_a_bag_gives_the_position_beside_the_speed(log, tmp_path):
    path, mapping = log
    make_bag(path, mapping, tmp_path / 'bag')
    found = positions(opened_log(tmp_path / 'bag'), mapping)
    assert found.motor == pytest.approx([1e-3 * motor for _, motor, _ in ROWS])
    assert found.table is None


def test_a_bag_without_a_position_gives_none(log, tmp_path):
    path, mapping = log
    text = mapping.read_text().replace('    position: {column: motor, unit: mm}\n', '')
    mapping.write_text(text)
    make_bag(path, mapping, tmp_path / 'bag')
    assert positions(opened_log(tmp_path / 'bag'), mapping) is None
