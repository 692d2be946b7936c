# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Warnings of a kind, speed and load that the baseline had are usual, all others are not."""

import dataclasses
import math

from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.health.bands import load_band, speed_band
from ballscrew_monitor.health.records import Baseline, Condition, Health
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.usual import is_usual, usual_warnings
from ballscrew_monitor.judge.records import Row
import pytest

FIRST = 20_000
BASELINE = Baseline(begin=FIRST * DAY, end=(FIRST + 10) * DAY, reason='learned')
SLOW, FAST = 4.0, 100.0  # [rad/s] where the film is too thin, and where it is not


@pytest.fixture
def cell(motion):
    """Return a function that gives a cell of steady motion at a speed in the baseline."""

    def make(speed):
        places = {'speed_band': speed_band(speed), 'load_band': load_band(500.0)}
        return motion.cell(first_day=FIRST + 2, speed=speed, axial_load=500.0, **places)

    return make


@pytest.fixture
def usual(surface, usual_limits):
    """Return a function that says whether a warning is usual after cells."""

    def says(cells, *, code=Code.RCS_HIGH, baseline=BASELINE, speed=SLOW, load=500.0):
        known = usual_warnings(cells, baseline, surface, usual_limits)
        normal = {'condition': Condition.NORMAL, 'verdict': '', 'usual_warnings': known}
        row = Row(speed=speed, axial_load=load)
        return is_usual(Health(axis='x', stamp=0, **normal), code, row)

    return says


def test_a_warning_where_the_baseline_was_outside_is_usual(surface, usual_limits, cell, usual):
    assert surface.lookup(SLOW, -500.0, 313.0).rcs >= usual_limits.rcs
    assert usual([cell(SLOW)])
    assert usual([cell(SLOW)], speed=1.05 * SLOW)


@pytest.mark.parametrize(
    'changes',
    [
        {'code': Code.EFFICIENCY_LOW},
        {'speed': 1.5 * SLOW},
        {'speed': -SLOW},
        {'speed': 0.0},
        {'speed': math.nan},
        {'load': 1500.0},
        {'load': -500.0},
        {'load': math.nan},
        {'baseline': None},
        {'baseline': dataclasses.replace(BASELINE, end=(FIRST + 1) * DAY)},
    ],
)
def test_another_kind_speed_load_direction_or_time_is_not(cell, usual, changes):
    assert not usual([cell(SLOW)], **changes)


def test_a_place_where_the_baseline_was_inside_is_not(surface, usual_limits, cell, usual):
    """A warning there is news: only another temperature or another oil can have raised it."""
    assert surface.lookup(FAST, -500.0, 313.0).rcs < usual_limits.rcs
    assert not usual([cell(FAST)], speed=FAST)
