# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bands without holes, each limit on one side, and periods that lie within longer ones."""

from ballscrew_monitor.health.bands import (
    day_of,
    LAST_LOAD,
    load_band,
    period_of,
    SEVERITIES,
    severity_class,
    speed_band,
)
from ballscrew_monitor.health.rows import DAY
from hypothesis import given
from hypothesis import strategies as st
import pytest


@pytest.mark.parametrize(
    ('load', 'band'),
    [(0.0, 0), (50.0, 0), (50.1, 1), (74.9, 1), (75.1, 2), (112.6, 3), (1e9, LAST_LOAD)],
)
def test_load_bands_are_signed_and_of_one_ratio(load, band):
    assert (load_band(load), load_band(-load)) == (band, -band)


@given(st.floats(51.0, 5e5), st.floats(1.0, 1.499))
def test_loads_that_differ_by_less_than_the_ratio_are_at_most_one_band_apart(load, ratio):
    assert 0 <= load_band(load * ratio) - load_band(load) <= 1
    assert load_band(load * 1.51) > load_band(load)


@pytest.mark.parametrize(
    ('speed', 'band'), [(1.0, 0), (1.09, 0), (1.1, 1), (1.2, 1), (1.44, 2), (0.84, -1), (0.92, 0)]
)
def test_speed_bands_have_steps_of_one_fifth_about_one_radian_a_second(speed, band):
    assert speed_band(speed) == band


def test_classes_of_severity_are_decades_with_the_limit_above():
    assert [severity_class(limit) for limit in (0.0, 99.9, *SEVERITIES, 1e12)] == [
        *(0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 8)
    ]
    assert all(b == 10.0 * a for a, b in zip(SEVERITIES[:-1], SEVERITIES[1:], strict=True))


def test_days_are_those_of_utc_since_1970():
    assert (day_of(0), day_of(DAY - 1), day_of(DAY), day_of(-1)) == (0, 0, 1, -1)


def test_a_week_and_a_month_are_merged_the_day_after_their_last_day_is_old_enough():
    """Days 0 to 6 are a week, 0 to 27 a month."""
    assert period_of(3, 1, 66) == (3, 1)
    assert period_of(3, 1, 67) == (0, 7)
    assert period_of(7, 7, 27 + 730) == (7, 7)
    assert period_of(7, 7, 28 + 730) == (0, 28)
    assert period_of(27, 1, 28 + 730) == (0, 28)
    assert period_of(28, 28, 10**6) == (28, 28)


@given(st.integers(0, 3000), st.integers(0, 6000), st.integers(0, 6000))
def test_merging_step_by_step_and_at_once_is_the_same(day, today, later):
    later += today
    step = period_of(*period_of(day, 1, today), later)
    assert step == period_of(day, 1, later)
    assert step[0] <= day < sum(step)
