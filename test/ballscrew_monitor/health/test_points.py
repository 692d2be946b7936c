# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Points: means and squares of stretches, merging in any order, age, and what is left out."""

import dataclasses
import functools
import math

from ballscrew_monitor.core.conversions import Direction, direction_of
from ballscrew_monitor.health.points import (
    add,
    aged,
    by_place,
    key_of,
    merged,
    model_torque,
    MOST_PLACES,
    surface_id,
)
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.judge.full_point import answer
from ballscrew_monitor.judge.records import Row
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

SUMS = ('speed', 'axial_load', 'temperature', 'motor_torque', 'residual')


@pytest.fixture(name='points', scope='session')
def points_strategy(motion):
    """Return a strategy of points of a few places and days."""
    number = st.floats(-100.0, 100.0)

    def build(day, load, **values):
        place = motion.point().place._replace(load=load)
        return motion.point(first_day=day, place=place, **values)

    return st.builds(
        build,
        day=st.integers(motion.today - 900, motion.today),
        load=st.integers(0, 1),
        stretches=st.integers(1, 50),
        duration=st.floats(0.5, 500.0),
        torque_squares=st.floats(0.0, 10.0),
        **dict.fromkeys(SUMS, number),
    )


def totals(points):
    """Return what no merging changes: counts, sums, and raw second moments of the residual."""
    sums = [sum(one.stretches * getattr(one, name) for one in points) for name in SUMS]
    squares = sum(one.torque_squares + one.stretches * one.residual**2 for one in points)
    return [
        sum(one.stretches for one in points),
        sum(one.duration for one in points),
        *sums,
        squares,
    ]


def test_a_day_has_means_and_squares_of_its_stretches(motion, surface):
    torques = np.array([0.5, 0.56, 0.43])
    speeds = np.array([50.0, 51.0, 52.0])
    points = {}
    for torque, speed in zip(torques, speeds, strict=True):
        stretch = motion.stretch(motor_torque=torque, speed=speed)
        assert add(points, stretch, surface, motion.today) == ''
    (point,) = points.values()
    models = [model_torque(surface, speed, 500.0, 313.0) for speed in speeds]
    assert (point.first_day, point.days, point.stretches) == (motion.today, 1, 3)
    assert (point.surface, len(point.surface)) == (surface_id(surface), 16)
    assert point.duration == 15.0
    assert (point.speed, point.motor_torque) == pytest.approx((51.0, torques.mean()))
    assert point.residual == pytest.approx((torques - models).mean())
    assert point.torque_squares == pytest.approx(3 * (torques - models).var())


def test_other_places_sources_and_surfaces_are_other_points(motion, surface):
    points = {}
    changes = [
        {},
        {'speed': -50.0},
        {'speed': 90.0},
        {'axial_load': -500.0},
        {'temperature': 320.0},
        {'load_source': LoadSource.FREE},
        {'temperature_measured': False},
        {'start': motion.noon + DAY},
    ]
    for change in changes:
        assert add(points, motion.stretch(**change), surface) == ''
    assert len(points) == len(changes)
    assert all(key_of(point) == key for key, point in points.items())
    assert by_place(points.values()) == points


def test_the_torque_of_the_model_is_that_of_the_judgement(surface):
    for speed, load in ((50.0, 500.0), (-50.0, 500.0), (30.0, -800.0), (-30.0, 0.0)):
        direction = int(direction_of(speed))
        row = Row(speed=speed, axial_load=load, temperature=313.0, direction=direction)
        judged = answer(row, surface, rcs_limit=0.01).machine_torque
        assert model_torque(surface, speed, load, 313.0) == judged
    assert Direction.NEGATIVE is direction_of(-30.0)
    assert math.isnan(model_torque(surface, 1e6, 0.0, 313.0))


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'load_source': LoadSource.DERIVED}, 'derived'),
        ({'start': DAY + 1}, 'clock_not_set'),
        ({'speed': 1e5}, 'outside'),
        ({'motor_torque': math.nan}, 'outside'),
    ],
)
def test_a_stretch_that_says_nothing_is_left_out_with_a_sentence(
    motion, surface, says, change, key
):
    points = {}
    assert add(points, motion.stretch(**change), surface) == says(key)
    assert not points


def test_a_clock_that_leaps_by_a_year_is_told_and_one_day_off_is_not(motion, surface, says):
    points = {}
    leap = motion.stretch(start=motion.noon + 365 * DAY)
    assert add(points, leap, surface, motion.today) == says('clock_leaps')
    for day in (-1, 0, 1):
        assert (
            add(points, motion.stretch(start=motion.noon + day * DAY), surface, motion.today) == ''
        )
    assert add(points, motion.stretch(start=motion.noon - 2 * DAY), surface, motion.today)
    assert len(points) == 3


def test_points_of_days_to_come_do_not_count_and_are_kept(motion, says):
    tomorrow, ahead = (motion.point(first_day=motion.today + days) for days in (1, 366))
    found = aged([motion.point(), ahead, tomorrow], motion.today)
    assert len(found.points) == 2
    assert found.future == (ahead,)
    assert found.notes == (says('clock_ahead'),)
    assert aged([*found.points, *found.future], motion.today + 366).future == ()


def test_a_period_has_a_bounded_number_of_places(motion, surface, says):
    """The rare places go, and a new one of a full day is rare."""
    place = motion.point().place
    many = [
        motion.point(place=place._replace(load=100 + number), stretches=2 + number)
        for number in range(MOST_PLACES + 5)
    ]
    found = aged(many, motion.today)
    assert (found.dropped, found.notes) == (5, (says('rare'),))
    assert min(one.stretches for one in found.points) == 7
    points = by_place(found.points)
    assert add(points, motion.stretch(), surface) == says('full_day')
    assert add(points, motion.stretch(start=motion.noon + DAY), surface) == ''
    assert len(points) == MOST_PLACES + 1


def test_points_without_a_residual_bound_their_squares_by_the_torque(motion):
    one, other = (motion.point(motor_torque=torque, residual=math.nan) for torque in (0.5, 0.7))
    both = merged(one, other)
    assert math.isnan(both.residual)
    assert both.torque_squares == pytest.approx(8 * 0.1**2)


@given(data=st.data())
def test_merging_is_associative_and_keeps_counts_and_moments(points, data):
    one, two, three = (
        dataclasses.replace(data.draw(points), first_day=0, place=(0, 0, 0, 1)) for _ in range(3)
    )
    found = merged(merged(one, two), three)
    other = merged(one, merged(three, two))
    for name in (*SUMS, 'stretches', 'duration', 'torque_squares'):
        assert getattr(found, name) == pytest.approx(getattr(other, name), abs=1e-9)
    assert totals([found]) == pytest.approx(totals([one, two, three]), abs=1e-9)
    assert found.torque_squares >= one.torque_squares + two.torque_squares - 1e-9


@given(data=st.data())
def test_merging_of_single_stretches_is_the_variance(motion, data):
    residuals = data.draw(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=20))
    single = [motion.point(stretches=1, residual=one) for one in residuals]
    found = functools.reduce(merged, single)
    assert found.stretches == len(residuals)
    assert found.residual == pytest.approx(np.mean(residuals), abs=1e-12)
    assert found.torque_squares == pytest.approx(len(residuals) * np.var(residuals), abs=1e-12)


@given(data=st.data(), later=st.integers(0, 2000))
def test_age_merges_and_loses_nothing_whenever_it_is_done(motion, points, data, later):
    many = data.draw(st.lists(points, max_size=15))
    once = aged(many, motion.today + later)
    twice = aged(aged(many, motion.today).points, motion.today + later)
    assert totals(once.points) == pytest.approx(totals(many), rel=1e-6, abs=1e-6)
    assert [key_of(one) for one in once.points] == [key_of(one) for one in twice.points]
    for one, other in zip(once.points, twice.points, strict=True):
        assert one.torque_squares == pytest.approx(other.torque_squares, rel=1e-6, abs=1e-6)
    assert (once.future, once.dropped, once.notes) == ((), 0, ())
    for one in once.points:
        assert one.days == 1 or one.first_day % one.days == 0
