# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The map as a page carries it."""

import base64

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.report.encoding import LEVELS
from ballscrew_monitor.report.map_record import COLUMNS, map_record, OPTIMAL, OUTSIDE, ROWS
import numpy as np
import pytest


def floats_of(text):
    return np.frombuffer(base64.b64decode(text), dtype='<f4')


def cells_of(column):
    steps, runs = (
        np.frombuffer(base64.b64decode(column[key]), dtype=kind)
        for key, kind in (('data', '<u2'), ('runs', '<u4'))
    )
    values = column['low'] + (steps - 1.0) * (column['high'] - column['low']) / LEVELS
    return np.repeat(np.rint(values), runs)


def test_time_spent_is_that_in_motion(judged):
    speed = np.where(np.arange(1000) < 400, 0.0, 100.0)
    record = map_record(judged.case([judged.columns(count=1000, speed=speed)]))
    cells = floats_of(record['dwell']['cells'])
    assert cells.size == COLUMNS * ROWS
    assert cells.sum() == pytest.approx(5.99)
    assert record['dwell']['longest'] == pytest.approx(cells.max())


def test_the_border_is_where_the_surface_has_the_limit(judged):
    case = judged.case([judged.columns()])
    record = map_record(case)
    border = next(line for line in record['lines'] if line['kind'] == 'rcs')
    points = floats_of(border['points']).reshape(-1, 2)
    points = points[np.isfinite(points[:, 0])]
    speed, load = points[len(points) // 2]
    found = case.surface.lookup(speed * np.pi / 30.0, float(load), 313.15)
    assert found.rcs == pytest.approx(case.settings.limits.rcs, rel=0.15)


def test_the_zone_is_left_and_right_of_the_border(judged):
    record = map_record(judged.case([judged.columns()]))
    zone = record['zone']
    cells = cells_of(zone['cells']).reshape(zone['rows'], zone['columns'])
    assert (cells[:, 0] == OUTSIDE).all()
    assert (cells[-1, -8:] == OPTIMAL).any()


def test_a_warning_is_marked_where_its_samples_are(judged):
    zone = np.where(np.arange(100) < 50, Zone.OUTSIDE, Zone.OPTIMAL)
    block = judged.columns(speed=50.0, axial_load=-700.0, zone=zone)
    record = map_record(judged.case([block], [judged.event(3, 0.0, 0.49)]))
    mark = record['events'][0]
    assert (mark['number'], mark['load']) == (3, pytest.approx(700.0))
    assert mark['speed'] == pytest.approx(50.0 * 30.0 / np.pi)


def test_only_the_worst_warnings_are_marked_each_by_its_blocks(judged):
    speeds = (50.0, 80.0)
    blocks = [
        judged.columns(100 * n, speed=speed, axial_load=-700.0, zone=Zone.OUTSIDE)
        for n, speed in enumerate(speeds)
    ]
    events = [
        judged.event(n + 1, 0.05 * n, 0.04, worst_value=0.011 + 0.001 * n) for n in range(40)
    ]
    marks = map_record(judged.case(blocks, events))['events']
    assert [one['number'] for one in marks] == list(range(21, 41))
    assert {round(one['speed'] * np.pi / 30.0) for one in marks} == {80}
    both = judged.event(1, 0.5, 1.0)
    (mark,) = map_record(judged.case(blocks, [both]))['events']
    assert 50.0 < mark['speed'] * np.pi / 30.0 < 80.0


def test_other_temperatures_have_a_border_of_their_own(judged):
    block = judged.columns(temperature=np.linspace(303.15, 323.15, 100))
    record = map_record(judged.case([block]))
    assert record['temperature'] == 40.0
    labels = [line['label'] for line in record['lines'] if line['kind'] == 'rcs_other']
    assert labels == ['30 °C', '50 °C']


def test_without_motion_there_is_a_map_of_the_datasheet(judged):
    record = map_record(judged.case([judged.columns(speed=0.0)]))
    assert record['temperature'] == 40.0
    assert floats_of(record['dwell']['cells']).sum() == 0.0
