# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Buckets lose no peak, stretches no sample, and holes stay holes."""

import base64
import json
import math
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.report import buckets, log_page
from ballscrew_monitor.report.buckets import axis_budgets, fair_shares, MOST_ROWS, shares_of_worst
from ballscrew_monitor.report.log_page import report_page
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import polars as pl
import pytest

numbers = st.floats(-1e9, 1e9) | st.just(math.nan)


def make_rows(time, values, codes=0):
    return pl.DataFrame(
        {
            'time': np.asarray(time, float),
            'speed': np.asarray(values, float),
            'zone': np.broadcast_to(np.asarray(codes, np.uint8), len(time)),
        }
    )


class Parts:
    """A table whose parts are frames."""

    def __init__(self, *frames):
        self.frames = frames

    def collect(self, query):
        return pl.concat([query(frame.lazy()).collect() for frame in self.frames])


@given(
    st.lists(st.tuples(st.floats(0.0, 10.0), numbers), min_size=1, max_size=300),
    st.integers(1, 20),
    st.integers(0, 300),
)
def test_buckets_keep_minima_and_maxima(rows, count, cut):
    time, values = np.array([at for at, _ in rows]), np.array([value for _, value in rows])
    parts = make_rows(time[:cut], values[:cut]), make_rows(time[cut:], values[cut:])
    kept, width = buckets.bucketed(Parts(*parts), [pl.all()], 10.0, count)
    ends = kept['speed'].to_numpy().reshape(count, 2)
    places = np.minimum((time / width).astype(int), count - 1)
    for place in range(count):
        inside = values[(places == place) & np.isfinite(values)]
        if inside.size:
            assert ends[place].tolist() == [inside.min(), inside.max()]
        else:
            assert np.isnan(ends[place]).all()


def test_the_worst_code_of_a_bucket_is_kept():
    rows = make_rows([0.1, 0.2, 1.5], [1.0, 1.0, 1.0], [2, 4, 1])
    kept, _ = buckets.bucketed(Parts(rows), [pl.all()], 3.0, 3)
    assert kept['zone'].to_list() == [4, 4, 1, 1, 0, 0]


def test_rows_are_cut_and_broken_at_a_hole():
    rows = make_rows([0.0, 1.0, 2.0, 3.0, 4.0], range(5))
    inside = rows.filter(buckets.between([(1.0, 2.5), (4.0, 5.0)]))
    assert inside['time'].to_list() == [1.0, 2.0, 4.0]
    assert rows.filter(buckets.between([])).is_empty()
    rows = buckets.with_breaks(make_rows([0.0, 0.1, 5.0], [1.0, 2.0, 3.0], [2, 2, 2]), 1.0)
    assert np.isnan(rows['speed'][2])
    assert rows['zone'].to_list() == [2, 2, 0, 2]
    assert (np.diff(rows['time']) > 0).all()


def test_times_of_a_day_are_exact_and_those_of_a_stretch_stated_where_they_are_not_even():
    time = 86_400.0 + np.arange(5) * 0.001
    sent = base64.b64decode(buckets.coarse_record(make_rows(time, range(5)))['time'])
    assert np.frombuffer(sent, dtype='<f8').tolist() == time.tolist()
    even = buckets.fine_record(make_rows(np.arange(10) * 0.001, np.arange(10)))
    assert 'time' not in even
    assert (even['begin'], even['end'], even['count']) == (0.0, pytest.approx(0.009), 10)
    uneven = buckets.fine_record(make_rows([0.0, 0.001, 0.005], [1.0, 2.0, 3.0]))
    assert len(base64.b64decode(uneven['time']['data'])) == 6


MOST_BYTES = 5_000_000
HOUR, RATE, SPARSE = 3600, 1000, 100  # [s], [Hz], every so many samples


@pytest.fixture
def axis(judged):
    """Make an axis of an hour at 1 kHz about its worst events, at 10 Hz else, with gaps."""

    def make(name, count, *, gaps=0):
        step = HOUR / count
        depths = np.random.default_rng(1).permutation(count) / count
        events = [
            judged.event(n + 1, step * (n + 0.3), 0.4 * step, worst_value=0.011 + 0.5 * depth)
            for n, depth in enumerate(depths.tolist())
        ]
        keep = np.zeros(HOUR * RATE, dtype=bool)
        keep[::SPARSE] = True
        for n in range(gaps):
            keep[slice(3000 * n + 1, 3000 * n + 1200)] = False
        for place in np.argsort(depths)[-10:]:
            for end in (events[place].start, events[place].end):
                at = (end - judged.begin) * RATE // SECOND
                keep[slice(max(0, at - RATE), at + RATE)] = True
        return _case(judged, name, np.flatnonzero(keep), events)

    return make


def _case(judged, name, numbers, events):
    count, noise = numbers.size, np.random.default_rng(1)
    made = judged.rows(count=count, axis=name, motor_torque_source=1)
    stamp = judged.begin + numbers * (SECOND // RATE)
    columns = ('speed', 'axial_load', 'temperature', 'efficiency', 'film_ratio')
    block = judged.changed(
        made,
        stamp=stamp,
        now=stamp,
        motor_torque=noise.normal(1.6, 0.05, count),
        rcs=made.rows['rcs'] * np.exp(noise.normal(0.0, 0.5, count)),
        **{key: made.rows[key] * noise.normal(1.0, 0.01, count) for key in columns},
    )
    topic = {f'{name}.torque.topic': 'torque', f'{name}.torque.field': 'data'}
    return judged.case([block], events, values=judged.values(name, **topic))


@pytest.fixture
def one_map(monkeypatch):
    """Let all axes of a page have the map of the first one, which takes long to make."""
    made, make = [], log_page.operating_map

    def make_once(case):
        if not made:
            made.append(make(case))
        return made[0]

    monkeypatch.setattr(log_page, 'operating_map', make_once)


def courses_of(page):
    data = re.search(r'id="data">(.*?)</script>', page, re.DOTALL)[1]
    return [axis['course'] for axis in json.loads(data)['axes']]


def test_a_page_of_minutes_at_1_khz_is_small(judged, five_minutes):
    page = report_page(judged.log(five_minutes))
    assert len(page.encode()) < MOST_BYTES
    assert courses_of(page)[0]['shown'] == 50


@pytest.mark.parametrize(
    ('axes', 'events', 'gaps', 'least'), [(16, 60, 0, 16), (4, 3000, 1200, 4), (16, 3000, 1200, 0)]
)
def test_a_page_of_many_is_small(judged, axis, one_map, axes, events, gaps, least):
    case = axis('x', events, gaps=gaps)
    page = report_page(judged.log(*[case] * axes))
    assert 0.85 * MOST_BYTES < len(page.encode()) < MOST_BYTES
    shown = [course['shown'] for course in courses_of(page)]
    assert least <= sum(shown)
    assert max(shown) < 50 == courses_of(page)[0]['worst']
    rows = min(MOST_ROWS, events, 4 * MOST_ROWS // axes)
    assert page.count('<tr class="bad" data-begin') == axes
    if rows < events:
        assert page.count(f'The worst {rows} of {events} are shown.') == axes
    if gaps:
        assert page.count(f', the longest {min(MOST_ROWS, 4 * MOST_ROWS // axes)} are') == axes


def test_shares_are_fair_and_samples_are_for_the_worst_events_of_all_axes(judged):
    assert fair_shares(90.0, [10.0, 100.0, 60.0]) == [10.0, 40.0, 40.0]
    assert fair_shares(500.0, [10.0, 100.0, 60.0]) == [10.0, 100.0, 60.0]
    assert fair_shares(-1.0, [10.0]) == [0.0]
    assert fair_shares(1.0, []) == []

    def case(*depths):
        events = [judged.event(n + 1, n, 0.5, worst_value=d) for n, d in enumerate(depths)]
        return judged.case([judged.rows()], events)

    cases = [case(0.1, 0.2), case(0.9, 0.8, 0.7), case()]
    assert shares_of_worst(3.0, cases, [1.0, 1.0, 1.0]) == [0.0, 3.0, 0.0]
    assert shares_of_worst(4.75, cases, [1.0, 1.0, 1.0]) == [1.25, 3.25, 0.25]
    assert shares_of_worst(-1.0, cases, [1.0, 1.0, 1.0]) == [0.0, 0.0, 0.0]


def test_a_few_axes_have_all_and_many_as_much_as_there_is(judged):
    quiet = judged.case([judged.rows()])
    assert axis_budgets([quiet])[0].buckets == axis_budgets([quiet] * 4)[0].buckets == 3000
    rooms = axis_budgets([quiet] * 16)
    assert {(room.buckets, room.events) for room in rooms} == {(750, 0)}
