# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Baselines of complete days: how many of them, what is refused, and a screw that was changed."""

import math

from ballscrew_monitor.health.baseline import (
    changed_screw,
    FEWEST_STRETCHES,
    LEARNED,
    learned,
    LEAST_MOTION,
    motion_by_day,
    named,
    RUNNING_IN,
)
from ballscrew_monitor.health.records import Baseline, LoadSource, SpectrumBin
from ballscrew_monitor.health.rows import DAY
from hypothesis import given
from hypothesis import strategies as st
import pytest

HOUR = 3600.0


@pytest.fixture(name='days')
def points_of_days(motion):
    """Return a function that makes a point of each day from today on, of hours of motion."""

    def days(*hours, stretches=10):
        return [
            motion.point(first_day=motion.today + number, duration=one * HOUR, stretches=stretches)
            for number, one in enumerate(hours)
        ]

    return days


def test_the_first_complete_days_make_eight_hours(days, motion):
    points = days(3.0, 3.0, 2.0, 5.0)
    found = learned(points, screw='40x10')
    assert (found.begin, found.end) == (motion.today * DAY, (motion.today + 3) * DAY)
    assert found.points == tuple(points[:3])
    assert (found.reason, found.named_at, found.screw) == (LEARNED, 0, '40x10')
    assert learned(points, over=8.01 * HOUR).end == (motion.today + 4) * DAY
    assert learned(points[:2], over=6.0 * HOUR).points == tuple(points[:2])


def test_a_baseline_is_not_known_before_its_days_are_over(days, motion, says):
    points = days(3.0, 3.0, 2.0)
    assert learned(points[:2]) == says('not_yet')
    assert learned(points, today=motion.today + 2) == says('not_yet')
    assert learned(points, today=motion.today + 3).points == tuple(points)


def test_running_in_is_left_out(days, motion, says):
    """The day on which the two hours are over is left out too."""
    points = days(1.5, 1.0, 4.0, 4.0)
    found = learned(points, left_out=RUNNING_IN)
    assert found.points == tuple(points[2:])
    assert found.begin == (motion.today + 2) * DAY
    assert learned(points[:2], left_out=RUNNING_IN) == says('no_complete_day')


def test_a_change_of_oil_begins_a_baseline_with_the_next_complete_day(days, motion):
    points = days(8.0, 8.0, 8.0, stretches=20)
    assert learned(points, since=motion.today * DAY).points == (points[0],)
    found = learned(points, since=motion.today * DAY + 1, reason='oil change', named_at=7)
    assert found.points == (points[1],)
    assert (found.reason, found.named_at) == ('oil change', 7)


def test_motion_is_that_of_the_spectrum_where_it_is_known(days, motion):
    points = days(0.1, 0.1, 0.1)
    bins = [
        SpectrumBin(
            first_day=one.first_day, load_band=band, axial_load=0, angle=1, speed=1, time=2 * HOUR
        )
        for one in points
        for band in (0, 1)
    ]
    known = motion_by_day(bins)
    assert known == {one.first_day: 4 * HOUR for one in points}
    assert learned(points, motion=known).points == tuple(points[:2])


def test_few_stretches_make_it_longer_until_there_are_enough(days, says):
    points = days(9.0, 1.0, 1.0, stretches=7)
    assert learned(points).points == tuple(points)
    (few,) = days(0.5, stretches=19)
    assert learned([few], over=0.1 * HOUR) == says('too_few_stretches')


def test_weeks_of_an_old_store_count_as_they_are(motion):
    weeks = [
        motion.point(first_day=7 * week, days=7, duration=5 * HOUR, stretches=30)
        for week in range(2500, 2504)
    ]
    found = learned(weeks, today=motion.today)
    assert found.points == tuple(weeks[:2])
    assert (found.begin, found.end) == (17500 * DAY, 17514 * DAY)


def test_derived_loads_make_no_baseline(days, motion):
    derived = motion.point(load_source=LoadSource.DERIVED, duration=99 * HOUR, stretches=999)
    assert isinstance(learned([derived]), str)
    points = days(8.0, stretches=20)
    assert learned([derived, *points]).points == tuple(points)


def test_a_named_interval_takes_the_days_within_it(days, motion):
    points = days(1.0, 1.0, 1.0, 1.0)
    begin, end = (motion.today + 1) * DAY, (motion.today + 3) * DAY
    found = named(points, begin, end, reason='new screw', named_at=end + 5, screw='20x5')
    assert found == Baseline(
        begin=begin,
        end=end,
        reason='new screw',
        named_at=end + 5,
        screw='20x5',
        points=tuple(points[1:3]),
    )


def test_a_baseline_of_two_minutes_or_without_a_reason_is_refused(days, motion, refused):
    begin, end = motion.today * DAY, (motion.today + 1) * DAY
    points = days(2.0 / 60.0, stretches=40)
    told = {'reason': 'oil change', 'named_at': 0}
    refused('two_minutes', lambda: named(points, begin, end, **told))
    refused('ends_before', lambda: named(points, begin, begin, **told))
    refused('no_reason', lambda: named(points, begin, end, reason=' ', named_at=0))


def test_just_enough_is_enough(days, motion):
    begin, end = motion.today * DAY, (motion.today + 1) * DAY
    points = days(LEAST_MOTION / HOUR, stretches=FEWEST_STRETCHES)
    assert named(points, begin, end, reason='new', named_at=0).points == tuple(points)


def test_another_screw_is_told_by_its_name_or_by_a_leap_everywhere(motion, says):
    baseline = Baseline(begin=0, end=1, reason=LEARNED, screw='40x10')
    assert changed_screw(baseline, '20x5', []) == says('another_screw')
    assert changed_screw(baseline, '40x10', [-0.31, -0.6, math.nan, -0.4]) == says('leaps')
    for changes in ([-0.3, -0.6, -0.4], [0.4, -0.4, 0.4], [0.9, 0.9], [math.nan] * 3):
        assert changed_screw(baseline, '40x10', changes) == ''
    assert changed_screw(baseline, '', [0.5] * 3) != ''


@given(
    hours=st.lists(st.floats(0.01, 6.0), max_size=12),
    over=st.floats(0.5, 12.0),
    left_out=st.floats(0.0, 4.0),
)
def test_a_learned_baseline_has_the_motion_that_it_asks_for_and_no_day_more(
    motion, hours, over, left_out
):
    points = [
        motion.point(first_day=motion.today + number, duration=one * HOUR, stretches=20)
        for number, one in enumerate(hours)
    ]
    found = learned(points, over=over * HOUR, left_out=left_out * HOUR)
    if isinstance(found, str):
        assert found.startswith('no baseline')
        return
    spent = sum(one.duration for one in found.points)
    before = sum(hours[: (found.begin // DAY) - motion.today])
    assert spent >= over * HOUR * (1 - 1e-9)
    assert before >= left_out * (1 - 1e-9)
    assert spent - found.points[-1].duration < over * HOUR * (1 + 1e-9)
