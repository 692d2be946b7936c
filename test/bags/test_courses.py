# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Courses in closed form: values, and the times at which they pass a value."""

from courses import constant, Course, moves, Steps
import pytest


def test_lines_between_corners_and_level_beyond_them():
    course = Course(((1.0, 2.0), (3.0, 6.0)))
    assert [course.at(time) for time in (0.0, 1.0, 2.0, 3.0, 9.0)] == [2.0, 2.0, 4.0, 6.0, 6.0]
    assert constant(7.0).at(-1.0) == constant(7.0).at(5.0) == 7.0


def test_a_course_is_at_the_value_when_it_passes_it_and_spans_are_in_order():
    course = moves((1.0, 900.0), (4.0, -900.0), (6.0, 0.0), ramp=0.5)
    times = course.passes(300.0)
    assert len(times) == 2
    assert [course.at(time) for time in times] == pytest.approx([300.0, 300.0])
    assert course.passes(-300.0) == pytest.approx((4.0 + 0.5 * 1200 / 1800, 6.0 + 0.5 * 2 / 3))
    assert not course.passes(1000.0)
    falling = moves((0.0, 10.0), (2.0, 0.0), ramp=1.0)
    assert falling.pass_between(4.0, 6.0, 1) == pytest.approx((2.4, 2.6))
    assert falling.pass_between(6.0, 4.0, 1) == pytest.approx((2.4, 2.6))


def test_steps_leap_at_their_times():
    steps = Steps(((1.0, 5.0), (2.0, -3.0)))
    assert [steps.at(time) for time in (0.5, 1.0, 1.9, 2.0)] == [0.0, 5.0, 5.0, -3.0]
    assert Steps().at(3.0) == 0.0
