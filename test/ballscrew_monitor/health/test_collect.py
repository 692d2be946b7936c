# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows taken one by one, interpreted, and in blocks, compiled: the same to the last bit."""

import math
from pathlib import Path
import subprocess
import sys

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.health.collect import Collector
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.history import history_of
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.summary import add, array_of
from ballscrew_monitor.recordings.axis_run import AxisRows
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay_parts
from ballscrew_monitor.settings import parameters
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

CONFIG = Path(__file__).resolve().parents[3] / 'config' / 'nominal_cycle.yaml'


def one_by_one(collector, motion, rows):
    stretches, bins = [], []
    for row in motion.single(rows):
        found = collector.take(row)
        if found is not None:
            stretches += found.stretches
            bins += found.bins
    last = collector.finish()
    return stretches + last.stretches, bins + last.bins


def in_blocks(collector, rows, cuts):
    stretches, bins = [], []
    for block in np.split(rows, cuts):
        found = collector.take_many(block)
        stretches += found.stretches
        bins += found.bins
    last = collector.finish()
    return stretches + last.stretches, bins + last.bins


def restless(motion, seed, parts):
    """Return rows of noisy plateaus with holes, other sources, midnights and NaN."""
    draw = np.random.default_rng(seed)
    made = []
    for _ in range(parts):
        speeds = draw.choice([-90.0, -20.0, 0.0, 20.0, 20.2, 90.0]) + draw.normal(0.0, 0.1, 300)
        part = motion.rows(speeds, rate=int(draw.choice([4, 100, 1000])), load=draw.normal(0, 900))
        part['axial_load'] += draw.normal(0.0, 9.0, len(part))
        part['motor_torque'] += draw.normal(0.0, 0.2, len(part))
        part['motor_torque'][draw.integers(300)] = math.nan
        part['temperature'] = draw.choice([290.0, 313.0, 330.0])
        part['axial_load_source'] = draw.choice([1, 1, 3, 4])
        part['validity'] = draw.choice([1, 1, 1, 7, 3])
        part['tick'][:3] = draw.random() < 0.2
        made.append(part)
    after = draw.choice([0, 10_000_000, SECOND, -2 * SECOND, DAY])
    return motion.then(*made, after=int(after))


@settings(max_examples=settings.default.max_examples // 5)
@given(seed=st.integers(0, 10**6), cuts=st.lists(st.integers(0, 1800), max_size=4).map(sorted))
def test_both_ways_give_the_same_bits(motion, surface, seed, cuts):
    rows = restless(motion, seed, 6)
    free = GatherSettings(max_gap=SECOND // 3, free_load=10.0, always_free=seed % 3 == 0)
    wanted = one_by_one(Collector(surface, free), motion, rows)
    found = in_blocks(Collector(surface, free), rows, cuts)
    assert repr(found) == repr(wanted)  # NaN is NaN


def test_a_torque_beyond_the_model_is_found_in_a_recording(nominal_bag, surface):
    """The nominal cycle, with the torque of the model and 0.03 N m more against every motion."""
    values = parameters.read_file(CONFIG) | {'x.publish_period': 0.1}
    collector, cells, stretches = Collector(surface), {}, []
    for part in replay_parts(Bag(nominal_bag), values, states=False):
        if isinstance(part, AxisRows):
            rows = part.rows.copy()
            rows['motor_torque'] = rows['machine_torque'] + 0.03 * np.sign(rows['speed'])
            rows['motor_torque_source'] = PointSource.MEASURED
            stretches += collector.take_many(rows).stretches
    for stretch in stretches:
        assert add(cells, stretch) == ''
    assert len(cells) > 10
    bins = [one for one in collector.finish().bins if one.energy_measured > 0.0]
    more = sum(one.energy_measured - one.energy_expected for one in bins)
    assert more == pytest.approx(0.03 * sum(one.angle for one in bins), rel=0.02)


def test_more_stretches_than_there_is_room_for(motion, surface, monkeypatch):
    monkeypatch.setattr('ballscrew_monitor.health.collect.ROOM', 2)
    rows = motion.then(*[motion.steady(2.0, speed) for speed in (10, 20, 30, 40, 50)])
    stretches, bins = in_blocks(Collector(surface), rows, [])
    assert [one.speed for one in stretches] == pytest.approx([10, 20, 30, 40, 50])
    assert len(bins) == 1


def test_a_look_in_between_ends_no_stretch(motion, surface):
    """The bins of a day so far are taken, and what follows comes on top."""
    collector, rows = Collector(surface), motion.steady(6.0)
    assert collector.take_many(rows[:300]) == ([], [])
    first = collector.finish(rows_end=False)
    collector.use_surface(surface)
    assert (first.stretches, first.bins[0].time) == ([], pytest.approx(2.99))
    assert collector.take_many(rows[300:]) == ([], [])
    last = collector.finish()
    assert last.stretches[0].duration == pytest.approx(5.6, abs=0.1)
    assert last.bins[0].time == pytest.approx(3.0)


def test_a_torque_that_is_nan_for_a_while_leaves_the_friction_as_it_is(motion, surface):
    """Half a minute forth and back, of which some seconds have no torque."""

    def frictions(*lost):
        rows = motion.then(motion.steady(15.0), motion.steady(15.0, -50.0, torque=-0.5))
        for begin in lost:
            rows['motor_torque'][slice(begin, begin + 200)] = math.nan
        stretches, _ = in_blocks(Collector(surface), rows, [])
        cells = {}
        for stretch in stretches:
            assert math.isfinite(stretch.motor_torque)
            add(cells, stretch, motion.noon)
        history = history_of(array_of(cells.values()), surface.lead)
        return history.friction

    assert frictions(300, 700, 1900) == pytest.approx(frictions())


def test_rows_that_come_after_the_preparation_compile_nothing():
    code = """
from ballscrew_monitor.health import collect
from ballscrew_monitor.health.gather import step_many
from ballscrew_monitor.health.spectrum import count_many
collect.prepare()
print(*(len(collect._compiled(function).signatures) for function in (step_many, count_many)))
"""
    done = subprocess.run([sys.executable, '-c', code], check=True, capture_output=True, text=True)
    assert done.stdout.split() == ['1', '1']
