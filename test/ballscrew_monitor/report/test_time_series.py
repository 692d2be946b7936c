# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The course in time: every sample near the worst events, few of many others."""

from ballscrew_monitor.core.judgement import Level, Zone
from ballscrew_monitor.judge.records import LIGHT_LOAD, STANDSTILL
from ballscrew_monitor.report.buckets import AxisBudget, BUCKETS, MOST_ROWS
from ballscrew_monitor.report.page import script_json
from ballscrew_monitor.report.time_series import coarse_bytes, row_columns, series_record
import numpy as np
import pytest
from surrogate.units import RPM

SHORT = 2 * BUCKETS


def rows_of(case, *numbers):
    return case.row_table.collect(lambda part: part.select(*row_columns(case, numbers)))


def test_around_the_worst_events_every_sample_is_kept_where_there_is_room(five_minutes):
    record = series_record(five_minutes)
    assert record['shown'] == 50
    worst = five_minutes.worst_first[:50]
    assert min(event.event_id for event in worst) == 11  # the last ones are the worst
    for event in worst:
        for end in (five_minutes.since_first(event.start), five_minutes.since_first(event.end)):
            inside = [one for one in record['fine'] if one['begin'] <= end <= one['end']]
            assert len(inside) == 1
            assert inside[0]['count'] == 2000
    record = series_record(five_minutes, 1_000_000)
    assert 5 < record['shown'] < 50
    assert (
        sum(len(one['columns'][key]['data']) for one in record['fine'] for key in one['columns'])
        < 1e6
    )


def test_samples_that_come_in_bursts_and_at_uneven_times_fit_too(judged):
    """The mean rate says nothing of the rate near the events."""
    noise = np.random.default_rng(1)
    number = np.unique(np.concatenate([np.arange(0, 400_000, 100), np.arange(9000, 41_000)]))
    block = judged.rows(count=number.size)
    stamp = block.rows['stamp'][0] + number * 1_000_000 + noise.integers(0, 900_000, number.size)
    block = judged.changed(
        block, stamp=stamp, now=stamp, speed=noise.normal(100.0, 1.0, number.size)
    )
    events = [judged.event(n + 1, 10.0 + 3.0 * n, 1.0) for n in range(10)]
    record = series_record(judged.case([block], events), 100_000)
    assert 1 <= record['shown'] < record['worst'] == 10
    assert 50_000 < len(script_json(record['fine'])) <= 100_000


@pytest.mark.parametrize('count', [500, 2000])
def test_what_a_course_takes_is_known_before(judged, count):
    room = AxisBudget(buckets=500, events=7)
    events = [judged.event(n + 1, 0.123456789 * n, 0.07654321) for n in range(10)]
    case = judged.case([judged.rows(count=count)], events)
    made = len(script_json(series_record(case, 0, room)))
    assert 0.3 * coarse_bytes(case, room) < made <= coarse_bytes(case, room)


def test_a_short_recording_keeps_every_sample_and_its_events(judged):
    case = judged.case([judged.rows(count=SHORT)], [judged.event(1, 1.0, 2.0)])
    record = series_record(case)
    assert (record['bucket'], record['fine']) == (0.0, [])
    assert len(record['time']) == pytest.approx(SHORT * 8 * 4 / 3, abs=4)
    case = judged.case([judged.rows(count=1000)], [judged.event(1, 1.0, 2.0)])
    assert series_record(case)['events'] == [{'begin': 1.0, 'end': 3.0}]


def test_only_the_worst_events_are_shaded(judged):
    events = [
        judged.event(n + 1, 0.01 * n, 0.005, worst_value=0.011 + 1e-5 * n)
        for n in range(MOST_ROWS + 200)
    ]
    shaded = series_record(judged.case([judged.rows(count=1000)], events))['events']
    assert len(shaded) == MOST_ROWS
    assert min(one['begin'] for one in shaded) == pytest.approx(2.0)


def test_torque_has_a_panel_where_it_was_measured_and_oil_is_in_degc(judged, five_minutes):
    titles = [panel['title'] for panel in series_record(judged.case([judged.rows()]))['panels']]
    assert len(titles) == 6
    assert series_record(five_minutes)['panels'][-1]['title'].startswith('Torque')
    block = judged.rows(count=2)
    rows = rows_of(judged.case([block]), 'temperature')
    assert rows['temperature'].to_list() == pytest.approx([40.0, 40.0])


def test_what_is_not_judged_or_only_held_is_a_gap(judged):
    gates = np.array([0, STANDSTILL, LIGHT_LOAD, 0], dtype=np.uint8)
    sources = np.array([1, 1, 1, 3], dtype=np.uint8)
    block = judged.rows(count=4, gates=gates, speed_source=sources)
    rows = rows_of(judged.case([block]), 'speed', 'efficiency', 'rcs')
    assert rows['speed'].is_nan().to_list() == [False, False, False, True]
    assert rows['efficiency'].is_nan().to_list() == [False, True, True, False]
    assert rows['rcs'].is_nan().to_list() == [False, True, False, False]


def test_codes_are_ordered_by_how_bad_they_are(judged):
    block = judged.rows(
        count=3,
        zone=[Zone.OPTIMAL, Zone.UNKNOWN, Zone.OUTSIDE],
        level=[Level.UNKNOWN, Level.OK, Level.WARN],
        regime=[3, 2, 1],
    )
    rows = rows_of(judged.case([block]))
    expected = {'regime': [1, 2, 3], 'zone': [2, 3, 4], 'level': [1, 2, 3]}
    assert rows.drop('time').to_dict(as_series=False) == expected


def test_stray_stamps_do_not_stretch_the_page(judged):
    block = judged.rows(count=100)
    block.rows['stamp'][7] = 1
    case = judged.case([block])
    assert series_record(case)['span'] == pytest.approx(0.99)


def test_the_zone_comes_first_among_the_bars(judged):
    bars = series_record(judged.case([judged.rows()]))['bars']
    assert [bar['title'] for bar in bars] == ['Zone', 'Warning', 'Regime']


def test_a_log_of_feeds_has_a_panel_of_feeds_beside_the_speed_of_the_screw(judged):
    """A feed is the lead times the speed of the screw, in m/min and rev/min."""
    block = judged.rows(count=3, speed=[0.0, 60 * RPM, -1500 * RPM])
    case = judged.case([block], values=judged.values(**{'x.speed.unit': 'mm/s'}))
    lead = case.surface.lead
    panel = series_record(case)['panels'][0]
    assert (panel['title'], panel['unit']) == ('Feed [m/min]', 'm/min')
    assert panel['beside'] == {'unit': 'rev/min', 'factor': pytest.approx(1 / lead)}
    rows = rows_of(case, 'speed')
    assert rows['speed'].to_list() == pytest.approx([0.0, 60 * lead, -1500 * lead])
    turns = series_record(judged.case([block]))['panels'][0]
    assert (turns['title'], turns['beside']) == ('Screw speed [rev/min]', None)
