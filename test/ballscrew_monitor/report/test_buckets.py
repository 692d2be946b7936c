# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Buckets lose no peak, stretches no sample, and holes stay holes."""

import base64
import math

from ballscrew_monitor.report.buckets import (
    between,
    Buckets,
    coarse_record,
    fine_record,
    in_order,
    joined_rows,
    TimedRows,
    with_breaks,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

numbers = st.floats(-1e9, 1e9) | st.just(math.nan)


def make_rows(time, values, codes=None):
    time, values = np.array(time, dtype=float), np.array(values, dtype=float)
    codes = np.zeros(time.size, dtype=np.uint8) if codes is None else np.array(codes, np.uint8)
    return TimedRows(time=time, numbers={'speed': values}, codes={'zone': codes})


@given(
    st.lists(st.tuples(st.floats(0.0, 10.0), numbers), min_size=1, max_size=300),
    st.integers(1, 20),
    st.integers(0, 300),
)
def test_buckets_keep_minima_and_maxima(rows, count, cut):
    time, values = np.array([at for at, _ in rows]), np.array([value for _, value in rows])
    buckets = Buckets(10.0, ['speed'], ['zone'], count=count)
    for part in (slice(0, cut), slice(cut, None)):  # blocks may be of any length
        buckets.add(make_rows(time[part], values[part]))
    kept = buckets.rows().numbers['speed'].reshape(count, 2)
    places = np.minimum((time / buckets.width).astype(int), count - 1)
    for place in range(count):
        inside = values[(places == place) & np.isfinite(values)]
        if inside.size:
            assert kept[place].tolist() == [inside.min(), inside.max()]
        else:
            assert np.isnan(kept[place]).all()


def test_the_worst_code_of_a_bucket_is_kept():
    buckets = Buckets(2.0, ['speed'], ['zone'], count=2)
    buckets.add(make_rows([0.1, 0.2, 1.5], [1.0, 1.0, 1.0], [2, 4, 1]))
    assert buckets.rows().codes['zone'].tolist() == [4, 4, 1, 1]


def test_rows_between_include_both_ends_of_a_stretch_but_its_last_instant():
    rows = make_rows([0.0, 1.0, 2.0, 3.0, 4.0], range(5))
    assert between(rows, [(1.0, 2.5), (4.0, 5.0)]).time.tolist() == [1.0, 2.0, 4.0]
    assert between(rows, []).time.size == 0


def test_a_hole_becomes_a_break():
    rows = with_breaks(make_rows([0.0, 0.1, 5.0], [1.0, 2.0, 3.0], [2, 2, 2]), 1.0)
    assert np.isnan(rows.numbers['speed'][2])
    assert rows.codes['zone'].tolist() == [2, 2, 0, 2]
    assert (np.diff(rows.time) > 0).all()


def test_slices_are_joined_and_sorted():
    rows = in_order(joined_rows([make_rows([2.0], [1.0]), make_rows([1.0], [2.0])]))
    assert rows.numbers['speed'].tolist() == [2.0, 1.0]


def test_times_of_a_day_are_exact():
    time = 86_400.0 + np.arange(5) * 0.001
    sent = base64.b64decode(coarse_record(make_rows(time, range(5)))['time'])
    assert np.frombuffer(sent, dtype='<f8').tolist() == time.tolist()


def test_times_of_a_stretch_are_stated_where_they_are_not_even():
    even = fine_record(make_rows(np.arange(10) * 0.001, np.arange(10)))
    assert 'time' not in even
    assert (even['begin'], even['end'], even['count']) == (0.0, pytest.approx(0.009), 10)
    uneven = fine_record(make_rows([0.0, 0.001, 0.005], [1.0, 2.0, 3.0]))
    assert len(base64.b64decode(uneven['time']['data'])) == 6
