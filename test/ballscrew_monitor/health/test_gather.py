# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Stretches of known motions: their means, where they begin and end, and what counts as one."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.collect import Collector
from ballscrew_monitor.health.gather import (
    BLOCK,
    finish,
    GatherMemory,
    GatherSettings,
    LONGEST,
    SETTLING,
    step,
)
from ballscrew_monitor.health.records import LoadSource, Stretch
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

HELD, DERIVED, DEFAULT = 3, 4, 2
MASKED = 6


@pytest.fixture(name='gather', scope='session')
def gather_rows(motion):
    def gather(rows, settings=None):
        settings, memory, made, found = (
            settings or GatherSettings(),
            GatherMemory(),
            Stretch(),
            [],
        )
        for row in motion.single(rows):
            if step(settings, memory, row, made):
                found.append(dataclasses.replace(made))
        return [*found, made] if finish(settings, memory, made) else found

    return gather


@pytest.mark.parametrize('rate', [10, 20, 1000])
def test_a_steady_motion_is_one_stretch_of_its_means(gather, motion, rate):
    """The settling torque before and the last block are left out, nothing else."""
    number = 7 * rate + 1
    torque = np.where(np.arange(number) < 0.2 * rate, 9.0, 0.5)
    torque[-1] = 9.0
    rows = motion.rows(np.full(number, -50.0), rate=rate, torque=torque, load=700.0)
    (found,) = gather(rows)
    assert (found.speed, found.axial_load, found.temperature) == (-50.0, 700.0, 313.0)
    assert found.motor_torque == pytest.approx(0.5)
    assert found.start == rows['stamp'][0] + SETTLING
    assert (found.samples - 1) / rate == pytest.approx(found.duration)
    assert 6.8 - found.duration <= 2 * BLOCK / SECOND + 0.001
    assert found.load_source == LoadSource.MEASURED
    assert found.temperature_measured


def test_a_long_motion_gives_several_and_a_short_one_no_stretch(gather, motion):
    found = gather(motion.steady(35.0))
    assert [round(one.duration, 1) for one in found] == [10.1, 10.1, 10.1, 4.3]
    assert all(one.duration >= LONGEST / SECOND for one in found[:3])
    assert found[1].start == found[0].start + round(found[0].duration * SECOND) + SECOND // 100
    assert not gather(motion.steady(0.5))
    assert len(gather(motion.steady(0.8))) == 1
    assert not gather(motion.steady(1.0, rate=4))  # too few samples


def test_ramps_and_reversals_are_left_out(gather, motion):
    """Absurd torques of the ramps reach no stretch."""
    plateaus = [0.0, 60.0, 0.0, -60.0, 30.0, 0.0]
    speeds, torque = [], []
    for before, after in zip(plateaus[:-1], plateaus[1:], strict=True):
        speeds += [np.linspace(before, after, 50, endpoint=False), np.full(300, after)]
        torque += [np.full(50, 99.0), np.full(300, math.copysign(0.4, after))]
    rows = motion.rows(np.concatenate(speeds), torque=np.concatenate(torque))
    found = gather(rows)
    assert [one.speed for one in found] == pytest.approx([60.0, -60.0, 30.0])
    assert [one.motor_torque for one in found] == pytest.approx([0.4, -0.4, 0.4])


def test_a_ramp_that_begins_within_a_block_is_left_out(gather, motion):
    """Whatever the phase of the blocks, no sample of the ramp counts."""
    for length in range(200, 215):
        speeds = np.concatenate([np.full(length, 60.0), np.linspace(60.0, 0.0, 20)])
        torque = np.where(np.arange(length + 20) < length, 0.4, -9.0)
        (found,) = gather(motion.rows(speeds, torque=torque))
        assert found.motor_torque == pytest.approx(0.4)


def test_noise_of_single_samples_ends_nothing(gather, motion):
    noise = 3.0 * np.random.default_rng(1).standard_normal(5000)
    found = gather(motion.rows(50.0 + noise, rate=1000))
    assert len(found) == 1
    assert found[0].speed == pytest.approx(50.0, abs=0.3)


@pytest.mark.parametrize(
    ('name', 'value', 'ends'),
    [
        ('speed', 50.9, False),
        ('speed', 51.5, True),
        ('axial_load', 599.0, False),
        ('axial_load', 605.0, True),
        ('temperature', 313.9, False),
        ('temperature', 314.5, True),
        ('motor_torque', 3.0, False),
        ('temperature_source', DEFAULT, True),
        ('axial_load_source', DERIVED, True),
        ('direction', 2, True),
    ],
)
def test_a_step_out_of_the_band_ends_a_stretch(gather, motion, name, value, ends):
    before, after = motion.steady(3.0), motion.steady(3.0)
    after[name] = value
    assert len(gather(motion.then(before, after))) == 1 + ends


@pytest.mark.parametrize(
    ('changes', 'number'),
    [
        ({'motor_torque': math.nan}, 1),
        ({'motor_torque_source': HELD}, 1),
        ({'axial_load': math.nan}, 1),
        ({'temperature_source': HELD}, 1),
        ({'validity': MASKED}, 1),
        ({'tick': True}, 2),
        ({'gates': 1}, 2),
        ({'gates': 2}, 1),  # a light load
    ],
)
def test_rows_that_do_not_belong_end_a_stretch_or_are_left_out(gather, motion, changes, number):
    rows = motion.steady(6.0)
    for name, value in changes.items():
        rows[name][300:310] = value
    if 'motor_torque_source' in changes:
        rows['motor_torque'][300:310] = 99.0
    found = gather(rows)
    assert len(found) == number
    assert {one.motor_torque for one in found} == {0.5}
    for name, value in changes.items():  # all along
        rows[name] = value
    counts = changes in ({'gates': 2}, {'validity': MASKED})
    assert len(gather(rows)) == counts


@pytest.mark.parametrize(
    ('after', 'number'),
    [(SECOND // 2, 1), (SECOND // 2 + 1, 2), (-SECOND, 2), (365 * 86_400 * SECOND, 2), (0, 1)],
)
def test_stamps_that_leap_or_go_back_end_a_stretch(gather, motion, after, number):
    rows = motion.then(motion.steady(3.0), motion.steady(3.0), after=after)
    found = gather(rows)
    assert len(found) == number
    assert all(0.0 < one.duration < 10.0 for one in found)


@pytest.mark.parametrize(('rate', 'longest'), [(5, 1.0), (4, 1.25), (2, 2.0)])
def test_a_slow_log_may_have_longer_gaps_up_to_two_seconds(gather, motion, rate, longest):
    """Of five periods, as the samples before have shown them."""
    for more, number in ((0, 1), (1, 2)):
        parts = motion.steady(4.0, rate=rate), motion.steady(4.0, rate=rate)
        rows = motion.then(*parts, after=round(longest * SECOND) + more)
        assert len(gather(rows)) == number


def test_a_log_of_one_sample_a_second_gives_stretches_after_its_first_gap(gather, motion):
    (found,) = gather(motion.steady(11.0, rate=1))
    assert (found.start - motion.noon, found.samples) == (2 * SECOND, 7)


def test_the_load_is_measured_derived_or_declared_free(gather, motion):
    rows = motion.steady(3.0)
    free = GatherSettings(free_load=-120.0, always_free=True)
    (found,) = gather(rows, free)
    assert (found.load_source, found.axial_load) == (LoadSource.MEASURED, 500.0)
    rows['axial_load_source'] = DERIVED
    for settings in (GatherSettings(), GatherSettings(free_load=-120.0)):
        (found,) = gather(rows, settings)
        assert found.load_source == LoadSource.DERIVED
    (found,) = gather(rows, free)
    assert (found.load_source, found.axial_load) == (LoadSource.FREE, -120.0)
    rows['temperature_source'] = DEFAULT
    assert not gather(rows)[0].temperature_measured


@given(
    speeds=st.lists(st.sampled_from([-80.0, 0.0, 49.5, 50.0, 50.5, 80.0]), max_size=12),
    lengths=st.lists(st.integers(1, 160), min_size=12, max_size=12),
    holes=st.lists(st.sampled_from([-(10**9), 0, 10**7, 6 * 10**8]), min_size=12, max_size=12),
)
def test_stretches_are_within_the_rows_and_apart(gather, motion, speeds, lengths, holes):
    parts = [np.full(length, speed) for speed, length in zip(speeds, lengths)]
    rows = motion.rows(np.concatenate([[0.0], *parts]))
    at = 1
    for part, hole in zip(parts, holes):
        rows['stamp'][at:] += hole
        at += len(part)
    found = gather(rows)
    assert sum(one.samples for one in found) <= len(rows)
    for one in found:
        assert one.samples >= 3
        assert 0.25 <= one.duration <= 10.2
        assert min(abs(one.speed - speed) for speed in (-80.0, 49.5, 50.0, 50.5, 80.0)) <= 0.5
        assert one.start in rows['stamp']


def test_a_reported_speed_with_ripple_is_steady_as_far_as_it_ripples(gather, motion):
    """At 10 samples a second each block is one sample, and 3 % of ripple are the drive's own."""
    noise = np.random.default_rng(2).normal(0.0, 0.03, 600)
    speeds = 50.0 * (1.0 + noise)
    found = gather(motion.rows(speeds, rate=10))
    assert sum(one.duration for one in found) > 30.0
    ramp = motion.rows(np.linspace(5.0, 80.0, 30), rate=10)
    assert sum(one.duration for one in gather(ramp)) == 0.0


def test_rest_with_a_torque_is_one_stretch_of_the_log(motion, surface):
    collector = Collector(surface)
    still = motion.rows(np.zeros(300), torque=0.07)
    moving = motion.steady(3.0)
    collector.take_many(motion.then(still, moving, still.copy()))
    *_, rest = collector.finish().stretches
    assert (rest.speed, rest.motor_torque) == (0.0, pytest.approx(0.07))
    assert rest.duration == pytest.approx(5.98, abs=0.02)
