# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Buckets lose no peak, stretches no sample, and holes stay holes."""

import base64
import math

from ballscrew_monitor.report import buckets
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

KIND = buckets.row_type(['speed'], ['zone'])
numbers = st.floats(-1e9, 1e9) | st.just(math.nan)


def make_rows(time, values, codes=0):
    rows = np.zeros(len(time), KIND)
    rows['time'], rows['speed'], rows['zone'] = time, values, codes
    return rows


@given(
    st.lists(st.tuples(st.floats(0.0, 10.0), numbers), min_size=1, max_size=300),
    st.integers(1, 20),
    st.integers(0, 300),
)
def test_buckets_keep_minima_and_maxima(rows, count, cut):
    time, values = np.array([at for at, _ in rows]), np.array([value for _, value in rows])
    kept = buckets.Buckets(10.0, KIND, count=count)
    for part in (slice(0, cut), slice(cut, None)):  # blocks may be of any length
        kept.add(make_rows(time[part], values[part]))
    ends = kept.rows()['speed'].reshape(count, 2)
    places = np.minimum((time / kept.width).astype(int), count - 1)
    for place in range(count):
        inside = values[(places == place) & np.isfinite(values)]
        if inside.size:
            assert ends[place].tolist() == [inside.min(), inside.max()]
        else:
            assert np.isnan(ends[place]).all()


def test_the_worst_code_of_a_bucket_is_kept():
    kept = buckets.Buckets(2.0, KIND, count=2)
    kept.add(make_rows([0.1, 0.2, 1.5], [1.0, 1.0, 1.0], [2, 4, 1]))
    assert kept.rows()['zone'].tolist() == [4, 4, 1, 1]


def test_rows_are_cut_joined_and_broken_at_a_hole():
    rows = make_rows([0.0, 1.0, 2.0, 3.0, 4.0], range(5))
    assert buckets.between(rows, [(1.0, 2.5), (4.0, 5.0)])['time'].tolist() == [1.0, 2.0, 4.0]
    assert buckets.between(rows, []).size == 0
    rows = buckets.in_order(np.concatenate([make_rows([2.0], [1.0]), make_rows([1.0], [2.0])]))
    assert rows['speed'].tolist() == [2.0, 1.0]
    rows = buckets.with_breaks(make_rows([0.0, 0.1, 5.0], [1.0, 2.0, 3.0], [2, 2, 2]), 1.0)
    assert np.isnan(rows['speed'][2])
    assert rows['zone'].tolist() == [2, 2, 0, 2]
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
