# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Programmes move as a table does: position, speed and acceleration belong together."""

import math

from health_parts.cycles import cutting, feed_passes, motion, Move, varied
from health_parts.machine import draw_machine
import numpy as np
import pytest

TIME = np.arange(15000) / 100.0
MACHINE = draw_machine(5)


@pytest.fixture(params=['passes', 'cutting'])
def moves(request):
    """Return the moves of both programmes."""
    rng = np.random.default_rng(1)
    return feed_passes(rng) if request.param == 'passes' else cutting(rng, MACHINE)


def test_position_is_the_integral_of_the_speed(moves):
    moved = motion(moves, MACHINE, TIME)
    pitch = MACHINE.size.lead / (2.0 * math.pi)
    steps = 0.5 * (moved.speed[1:] + moved.speed[:-1]) * 0.01 * pitch
    # Between samples the speed bends by at most the rate of 1.5 m/s2.
    bend = 1.5 * 0.01**2 / 4.0
    assert np.max(np.abs(np.diff(moved.position) - steps)) <= bend
    ramp = (moved.acceleration[1:] == moved.acceleration[:-1]) & (moved.acceleration[1:] != 0.0)
    assert ramp.sum() > 100
    rise = 0.01 * moved.acceleration[1:][ramp]
    assert np.diff(moved.speed)[ramp] == pytest.approx(rise, rel=1e-9)


def test_table_stays_on_its_stroke(moves):
    moved = motion(moves, MACHINE, TIME)
    assert np.min(moved.position) > -1e-9
    assert np.max(moved.position) < MACHINE.stroke


def test_each_speed_runs_both_ways(moves):
    moved = motion(moves, MACHINE, TIME)
    steady = moved.speed[moved.acceleration == 0.0]
    for move in moves:
        for way in (1.0, -1.0):
            assert np.isclose(steady, way * move.speed).sum() > 20


def test_process_force_opposes_the_cut_alone():
    moved = motion([Move(speed=20.0, force=500.0)], MACHINE, TIME)
    cutting_now = moved.force != 0.0
    assert set(np.unique(moved.force)) == {-500.0, 0.0}
    assert np.all(moved.speed[cutting_now] > 19.9)


def test_move_too_fast_for_the_stroke_has_its_peak_in_the_middle():
    moved = motion([Move(speed=1e5)], MACHINE, TIME)
    pitch = MACHINE.size.lead / (2.0 * math.pi)
    highest = math.sqrt(1.5 * 0.9 * MACHINE.stroke)  # [m/s]
    assert np.max(moved.speed) * pitch == pytest.approx(highest, rel=0.02)
    assert np.max(moved.position) == pytest.approx(0.9 * MACHINE.stroke, rel=1e-3)


def test_another_workpiece_has_the_same_speeds(moves):
    others = varied(moves, np.random.default_rng(2))
    assert sorted(move.speed for move in others) == sorted(move.speed for move in moves)
    least, most = sum(move.force for move in moves) * np.array([0.8, 1.2])
    assert least <= sum(move.force for move in others) <= most
