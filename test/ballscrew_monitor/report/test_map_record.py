# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The map for page and picture."""

from ballscrew_monitor.recordings.declared import plain
from ballscrew_monitor.report import row_table
from ballscrew_monitor.report.map_record import COLUMNS, operating_map, OPTIMAL, OUTSIDE, ROWS
import numpy as np
import pytest


def test_time_spent_is_that_in_motion_and_without_it_the_datasheet_is_shown(judged):
    speed = np.where(np.arange(1000) < 400, 0.0, 100.0)
    record = operating_map(judged.case([judged.rows(count=1000, speed=speed)]))
    cells = record.dwell
    assert cells.size == COLUMNS * ROWS
    assert cells.sum() == pytest.approx(5.99)
    assert plain(record)['dwell']['longest'] == pytest.approx(cells.max())
    record = operating_map(judged.case([judged.rows(speed=0.0)]))
    assert record.temperature == 40.0
    assert record.dwell.sum() == 0.0


def test_each_step_counts_however_the_rows_came(judged, monkeypatch):
    monkeypatch.setattr(row_table, 'PART', 30)
    blocks = [judged.rows(0, 50), judged.rows(50, 1), judged.rows(51, 49)]
    assert operating_map(judged.case(blocks)).dwell.sum() == pytest.approx(0.99)


def test_the_border_is_where_the_surface_has_the_limit_and_the_zone_on_both_sides_of_it(judged):
    case = judged.case([judged.rows()])
    record = operating_map(case)
    border = next(line for line in record.lines if line.kind == 'rcs')
    points = border.points
    points = points[np.isfinite(points[:, 0])]
    speed, load = points[len(points) // 2]
    found = case.surface.lookup(speed * np.pi / 30.0, float(load), 313.15)
    assert found.rcs == pytest.approx(case.settings.limits.rcs, rel=0.15)
    assert (record.zone[:, 0] == OUTSIDE).all()
    assert (record.zone[-1, -8:] == OPTIMAL).any()


def test_a_warning_is_marked_at_its_worst_sample(judged):
    event = judged.event(3, 0.0, 0.49, speed=-50.0, axial_load=700.0)  # backward, against it
    (mark,) = operating_map(judged.case([judged.rows()], [event])).events
    assert (mark['number'], mark['load']) == (3, 700.0)
    assert mark['speed'] == pytest.approx(50.0 * 30.0 / np.pi)
    unknown = judged.event(4, 0.0, 0.49, speed=np.nan)
    assert operating_map(judged.case([judged.rows()], [unknown])).events == []


def test_only_the_worst_warnings_are_marked(judged):
    events = [
        judged.event(n + 1, 0.05 * n, 0.04, worst_value=0.011 + 0.001 * n, speed=50.0 + n)
        for n in range(40)
    ]
    marks = operating_map(judged.case([judged.rows()], events)).events
    assert [one['number'] for one in marks] == list(range(21, 41))
    assert [round(one['speed'] * np.pi / 30.0) for one in marks] == list(range(70, 90))


def test_other_temperatures_have_a_border_of_their_own(judged):
    block = judged.rows(temperature=np.linspace(303.15, 323.15, 100))
    record = operating_map(judged.case([block]))
    assert record.temperature == 40.0
    labels = [line.label for line in record.lines if line.kind == 'rcs_other']
    assert labels == ['30 °C', '50 °C']


def test_a_map_knows_the_feed_where_the_log_speaks_of_it(judged):
    case = judged.case([judged.rows()], values=judged.values(**{'x.speed.unit': 'm/min'}))
    assert operating_map(case).feed == case.surface.lead
    assert plain(operating_map(judged.case([judged.rows()])))['feed'] is None
