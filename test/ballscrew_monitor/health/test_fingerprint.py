# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reference runs: planned, printed, and known again among other motion."""

import itertools

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.fingerprint import PAUSE, Recogniser, STAIRCASE
from ballscrew_monitor.health.records import LoadSource
from hypothesis import given
from hypothesis import strategies as st
import pytest

DERIVED = LoadSource.DERIVED


def run_of(motion, steps=STAIRCASE, source=DERIVED, pause=2 * SECOND):
    """Return the stretches of a run, one each way at each step."""
    speeds = [sign * speed for speed in steps for sign in (1, -1)]
    start = motion.noon
    made = []
    for speed in speeds:
        made.append(motion.stretch(speed=speed, start=start, axial_load=321.0, load_source=source))
        start += round(made[-1].duration * SECOND) + pause
    return made


def recognised(stretches, free_load=0.0):
    run = Recogniser(free_load)
    return run.take(stretches) + run.finish()


def sources(stretches):
    return [one.load_source for one in recognised(stretches)]


def test_a_run_is_free_of_load_and_motion_before_and_after_is_not(motion):
    run = run_of(motion)
    before = motion.stretch(speed=77.0, start=motion.noon - 60 * SECOND, load_source=DERIVED)
    after = motion.stretch(speed=77.0, start=run[-1].start + 20 * SECOND, load_source=DERIVED)
    found = recognised([before, *run, after], free_load=-50.0)
    assert [one.load_source for one in found] == [DERIVED, *[LoadSource.FREE] * 12, DERIVED]
    assert {one.axial_load for one in found[1:-1]} == {-50.0}
    assert [one.start for one in found] == [one.start for one in (before, *run, after)]


@pytest.mark.parametrize(
    'broken',
    [
        lambda motion: run_of(motion)[:7],  # the fourth step one way only
        lambda motion: run_of(motion)[2:],  # not from the first step
        lambda motion: run_of(motion)[::2],  # one way only
        lambda motion: run_of(motion, pause=PAUSE + 1),
        lambda motion: run_of(motion, [1.06 * one for one in STAIRCASE]),
        lambda motion: run_of(motion)[:4] + run_of(motion)[6:],  # a step is missing
    ],
)
def test_what_is_no_run_stays_as_it_is(motion, broken):
    made = broken(motion)
    assert recognised(made) == made


def test_four_steps_are_enough_and_a_second_run_may_follow(motion):
    first = run_of(motion)[:8]
    assert set(sources(first)) == {LoadSource.FREE}
    later = [run_of(motion, pause=3 * SECOND)[at] for at in range(12)]
    shift = first[-1].start + 10 * SECOND - later[0].start
    second = [
        motion.stretch(speed=one.speed, start=one.start + shift, load_source=DERIVED)
        for one in later
    ]
    assert sources([*first, *second]) == [LoadSource.FREE] * 20


def test_a_measured_load_stays_measured(motion):
    made = run_of(motion, source=LoadSource.MEASURED)
    assert recognised(made) == made


@given(st.lists(st.sampled_from([*STAIRCASE, 33.0]), max_size=30), st.randoms())
def test_nothing_is_lost_or_turned_whatever_comes(motion, speeds, draw):
    made = [
        motion.stretch(speed=draw.choice((1, -1)) * one, start=motion.noon + n * 6 * SECOND)
        for n, one in enumerate(speeds)
    ]
    run = Recogniser(0.0)
    parts = [run.take([one]) for one in made]
    found = [*itertools.chain(*parts), *run.finish()]
    assert [one.start for one in found] == [one.start for one in made]
