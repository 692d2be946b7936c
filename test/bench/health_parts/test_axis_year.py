# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A year of logs says what its truth says: by averages of its samples, and by closed forms."""

from dataclasses import replace
import math

from health_parts.axis_year import (
    axis_year,
    DAY,
    drive_torque,
    indicated_torque,
    NEW_YEAR,
    SCHEDULES,
    stepped,
)
from health_parts.faults import CLEAN, FAULTS
from health_parts.machine import draw_machine, MOUNTED
import numpy as np
import pytest

FAULTY = FAULTS['preload -40 %']


def level(log, speed):
    """Return half the difference of the mean torques of both directions at a speed."""
    steady = np.abs(np.gradient(log.speed)) < 0.02 * speed
    ways = [
        np.mean(log.torque[steady & (np.abs(log.speed / (way * speed) - 1.0) < 0.02)])
        for way in (1.0, -1.0)
    ]
    return 0.5 * (ways[0] - ways[1])


@pytest.mark.parametrize('name', SCHEDULES)
def test_logs_have_the_length_and_rate_of_the_schedule(name):
    year, plan = axis_year(1, schedule=name), SCHEDULES[name]
    assert len(year.logs) == pytest.approx(364.0 / plan.days, rel=0.1)
    for log, date in zip(year.logs, year.day):
        assert log.start == NEW_YEAR + round(date * DAY)
        assert log.time[1] == 1.0 / plan.rate
        assert log.time[-1] + 1.0 / plan.rate == plan.duration
        columns = (log.speed, log.torque, log.position, log.load, log.temperature)
        assert {column.shape for column in columns} == {log.time.shape}


def test_year_of_a_seed_is_the_same_each_time():
    first, again = axis_year(4, FAULTY), axis_year(4, FAULTY)
    assert all(np.array_equal(a.torque, b.torque) for a, b in zip(first.logs, again.logs))
    assert not np.array_equal(first.logs[0].torque, axis_year(5, FAULTY).logs[0].torque)


def test_twins_differ_from_the_fault_on_alone():
    clean, faulty = axis_year(4), axis_year(4, FAULTY)
    assert np.array_equal(clean.day, faulty.day)
    for date, one, other in zip(clean.day, clean.logs, faulty.logs):
        assert np.array_equal(one.torque, other.torque) == (date <= FAULTY.start)
        assert np.array_equal(one.temperature, other.temperature)


def test_columns_can_be_absent():
    year = axis_year(2, load=False, temperature=False)
    assert all(log.load is None and log.temperature is None for log in year.logs)


@pytest.mark.parametrize('seed', range(4))
def test_samples_agree_with_the_truth_on_the_fault(seed):
    """Without scatter and wander, the twins' levels differ by what the truth says."""
    clean, faulty = (axis_year(seed, fault, scatter=0.0, wander=0.0) for fault in (CLEAN, FAULTY))
    speeds = clean.truth.speeds[1:4]
    levels = [[level(year.logs[-1], speed) for speed in speeds] for year in (clean, faulty)]
    expected = faulty.truth.by_speed[-1, 1:4] / clean.truth.by_speed[-1, 1:4]
    # The logs stand at another temperature than the truth, which shifts the shares of the parts.
    assert np.divide(levels[1], levels[0]) == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize('name', FAULTS)
def test_truth_has_the_sign_of_the_fault(name):
    truth = axis_year(6, FAULTS[name]).truth
    assert np.all(truth.fault_change[:25] == 0.0)
    sign = {'clean': 0, 'torque constant -10 %': 0, 'zero': 0, 'load gain': 0}
    sign |= {'preload -10 %': -1, 'preload -20 %': -1, 'preload -40 %': -1, 'wiper torn': -1}
    sign |= {'wiper swollen': 1, 'guideway +25 %': 1, 'support bearing': 1}
    sign |= {'thinner oil': -1, 'thicker oil': 1}
    if name in sign:
        assert np.sign(truth.fault_change[-1]) == sign[name]


def test_starved_film_costs_friction_where_it_is_slow():
    by_speed = [
        axis_year(6, fault).truth.by_speed[-1] for fault in (CLEAN, FAULTS['starved film'])
    ]
    change = by_speed[1] / by_speed[0] - 1.0
    assert change[0] > 0.01
    assert change[-1] < change[0]


def test_deeper_loss_of_preload_lowers_the_friction_further():
    names = ('clean', 'preload -10 %', 'preload -20 %', 'preload -40 %')
    changes = [axis_year(6, FAULTS[name]).truth.fault_change[-1] for name in names]
    assert np.all(np.diff(changes) < 0.0)


def test_weaker_magnets_raise_the_indicated_torque_alone():
    truth = axis_year(6, FAULTS['torque constant -10 %']).truth
    assert truth.fault_change[-1] == 0.0
    assert truth.indicated_change[-1] == pytest.approx(1.0 / 0.9 - 1.0, rel=1e-12)


def test_change_is_relative_to_the_mean_of_the_baseline():
    truth = replace(axis_year(1).truth, friction=np.array([1.0, 3.0, 2.5]))
    assert truth.change(slice(0, 2)) == pytest.approx([-0.5, 0.5, 0.25])


def test_zero_and_weight_average_out_over_both_directions():
    """The mean of the magnitudes is the friction; the asymmetry goes with it."""
    machine = replace(draw_machine(2), torque_gain=1.0, zero=0.3)
    speed = np.array([50.0, -50.0])
    torque = drive_torque(machine, speed, np.zeros(2), np.full(2, 1.7), 400.0)
    shown = indicated_torque(machine, torque, 0.0, replace(MOUNTED, zero=0.5))
    assert 0.5 * (shown[0] - shown[1]) == pytest.approx(1.7, rel=1e-12)


def test_weight_is_held_at_rest():
    """A weight of 1 kN on a lead of 10 mm: 1.592 N m."""
    machine = draw_machine(2, size='40x10')
    held = drive_torque(machine, np.zeros(1), np.zeros(1), np.ones(1), -1000.0)
    assert held == pytest.approx(1.592, abs=5e-4)


def test_warm_magnets_need_more_current():
    machine = replace(draw_machine(2), torque_gain=1.0, zero=0.0)
    shown = indicated_torque(machine, np.array([2.0]), 50.0, MOUNTED)
    assert shown == pytest.approx(2.0 / 0.95, rel=1e-12)


def test_torque_has_whole_steps():
    year = axis_year(3)
    steps = year.logs[0].torque / year.machine.torque_step
    assert steps == pytest.approx(np.round(steps), abs=1e-6)
    assert stepped(np.array([0.24, -0.26]), 0.1) == pytest.approx([0.2, -0.3])


def test_oil_warms_up_during_a_log():
    """By less than a cold start would, as the axis has moved before."""
    year = axis_year(1)
    cold = year.machine.warm_up * (1.0 - math.exp(-150.0 / year.machine.warm_up_time))
    rises = [np.mean(log.temperature[-200:]) - np.mean(log.temperature[:200]) for log in year.logs]
    assert 0.0 < np.mean(rises) < cold * year.machine.thermometer_share


@pytest.mark.parametrize('axis', ['vertical', 'constant'])
def test_load_signal_shows_the_standing_force(axis):
    year = axis_year(2, axis=axis)
    mean = np.mean([np.mean(log.load) for log in year.logs])
    tolerance = 0.001 * year.machine.preload
    assert mean == pytest.approx(year.machine.standing_force, abs=tolerance)


def test_load_gain_is_of_the_load_signal_alone():
    clean, faulty = (
        axis_year(2, fault, axis='constant') for fault in (CLEAN, FAULTS['load gain'])
    )
    last = clean.logs[-1], faulty.logs[-1]
    assert np.array_equal(last[0].torque, last[1].torque)
    assert np.mean(last[1].load) / np.mean(last[0].load) == pytest.approx(0.85, abs=0.005)


def test_cutting_programme_has_process_force_and_free_runs():
    year = axis_year(2, programme='cutting')
    largest = max(move.force for move in year.moves)
    assert min(np.min(log.load) for log in year.logs) < -largest
    assert len(year.truth.speeds) == 3
