# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The course of an axis in sentences: normal, worse with a date, not known with a reason."""

import json

from ballscrew_monitor.health.assess import course, DRAG, HealthSettings, SMALLEST
from ballscrew_monitor.health.records import (
    Baseline,
    CauseCode,
    Condition,
    KeptHealth,
    LoadSource,
    Missing,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.summary import nothing
from ballscrew_monitor.health.words import health_record
import numpy as np
import pytest

FIRST = 20_000
FRICTION = {3.0: 0.5, 12.0: 0.35, 40.0: 0.4, 120.0: 0.6}
"""Friction [N m] by speed [rad/s]."""


@pytest.fixture(name='axis')
def make_axis(motion, surface, usual_limits):
    return Axis(motion, surface, usual_limits)


class Axis:
    """An axis with weekly logs of a scatter of 1 %, and the factor that a week has on it."""

    def __init__(self, motion, surface, limits):
        self.motion, self.surface = motion, surface
        self.settings = HealthSettings(limits=limits)

    def cells(self, weeks, factor=lambda week, speed: 1.0, *, step=7, offset=0.0, **changes):
        random, cells = np.random.default_rng(1), []
        for week in range(weeks):
            scatter = 1.0 + random.normal(0.0, 0.01)
            for speed, friction in FRICTION.items():
                for way in (1, -1):
                    torque = friction * scatter * factor(week, speed)
                    values = {
                        'speed': way * speed,
                        'speed_band': round(speed),
                        'direction': way,
                        'axial_load': 0.0,
                        'load_band': 0,
                        'motor_torque': way * torque + (offset if week >= 20 else 0.0),
                    }
                    day = FIRST + step * week
                    cells.append(self.motion.cell(first_day=day, **values | changes))
        return cells

    def course(self, cells, baselines=()):
        kept = KeptHealth(cells, baselines=baselines)
        return course('x', kept, self.surface, self.settings)


def lost(week, speed):
    return 0.85 if week >= 20 else 1.0


def test_a_year_without_a_change_is_normal(axis, says):
    found = axis.course(axis.cells(30))
    assert len(found) == 30
    assert [one.condition for one in found[8:]] == [Condition.NORMAL] * 22
    assert found[-1].verdict == says('normal')
    assert found[-1].quantity(SMALLEST).value < 0.09
    assert (list(found[-1].causes), found[-1].since) == ([], 0)
    assert found[2].verdict == says('too_few')


def test_a_loss_is_worse_with_its_date_size_and_causes(axis, says):
    found = axis.course(axis.cells(32, lost))
    conditions = [one.condition for one in found]
    first = conditions.index(Condition.WORSE)
    assert 20 <= first <= 24
    assert set(conditions[first:]) == {Condition.WORSE}
    last = found[-1]
    assert last.since == (FIRST + 140) * DAY
    assert last.verdict == says('worse')
    drag = last.quantity(DRAG)
    assert drag.low < -0.15 < drag.high
    assert CauseCode.PRELOAD_LOST in {one.code for one in last.causes if not one.excluded}
    assert 'backlash' in last.advice


def test_each_log_of_a_course_has_condition_interval_date_and_causes(axis):
    record = health_record(axis.course(axis.cells(32, lost))[28])
    assert record['condition'] == 'worse'
    assert record['since_ns'] == (FIRST + 140) * DAY
    drag = record['quantities'][DRAG]
    assert drag['low'] < drag['value'] < drag['high'] < 0.0
    assert record['causes']
    json.dumps(record)


def test_a_service_event_begins_anew(axis):
    cells = axis.cells(45, lost)
    event = Baseline(begin=(FIRST + 7 * 30) * DAY, end=0, reason='new nut')
    found = axis.course(cells, (event,))
    assert len(found) == 15
    assert found[-1].condition is Condition.NORMAL
    assert found[-1].baseline.reason == 'new nut'


def test_twelve_monthly_runs_are_judged(axis):
    """The first three are a baseline, of which the fifth is judged with the interval it has."""
    found = axis.course(axis.cells(12, step=30))
    assert found[4].quantity(DRAG).is_known
    assert found[-1].condition is Condition.NORMAL
    worse = axis.course(axis.cells(12, lambda month, _: 0.8 if month >= 8 else 1.0, step=30))
    assert worse[8].condition is not Condition.WORSE
    assert worse[9].condition is Condition.WORSE


def test_a_zero_that_moves_is_a_note_and_no_change_of_friction(axis, says):
    found = axis.course(axis.cells(30, offset=0.05))[-1]
    assert found.condition is Condition.NORMAL
    assert says('zero') in found.notes


def test_without_load_or_temperature_the_notes_say_so(axis, says):
    cells = axis.cells(30, load_source=LoadSource.DERIVED, temperature_measured=False)
    found = axis.course(cells)[-1]
    assert {says('no_load'), says('no_temperature')} <= set(found.notes)
    known = axis.course(axis.cells(30))[-1]
    widths = [one.quantity(DRAG).high - one.quantity(DRAG).low for one in (found, known)]
    assert widths[0] > 1.2 * widths[1]


def test_a_programme_without_a_common_speed_is_not_compared(axis):
    cells = axis.cells(14)
    for cell in cells:
        if cell.first_day > FIRST + 70:
            cell.speed_band += 100
    found = axis.course(cells)[-1]
    assert not found.quantity(DRAG).is_known
    assert 'shares no speed and load' in found.verdict


@pytest.mark.parametrize(
    ('why', 'key'),
    [
        (Missing.LOAD, 'torque_is_load'),
        (Missing.TORQUE, 'no_torque'),
        (Missing.STEADY, 'not_steady'),
        (Missing.MOTION, 'no_motion'),
    ],
)
def test_logs_without_motion_that_counts_say_why(axis, says, why, key):
    (found,) = axis.course([nothing(FIRST * DAY, why)])
    assert (found.condition, found.verdict) == (Condition.UNKNOWN, says(key))


@pytest.mark.parametrize('factor', [1.0, 0.85])
def test_torque_only_while_cutting_is_not_known(axis, says, factor):
    """Under one load and one way, an error of the load is as good as a change of the friction."""
    cells = axis.cells(30, lambda week, _: factor if week >= 20 else 1.0)
    for cell in cells:
        cell.axial_load, cell.load_band = -900.0, -8
        cell.motor_torque += 900.0 * axis.surface.lead / (2.0 * np.pi)
    last = axis.course([cell for cell in cells if cell.direction > 0])[-1]
    assert (last.condition, last.verdict) == (Condition.UNKNOWN, says('only_cutting'))


def test_a_torque_below_that_of_the_load_is_not_known(axis, says):
    """As by twice the lead; half a load in each direction would be a friction below zero."""
    cells = axis.cells(30, axial_load=0.0)
    for cell in cells:
        cell.axial_load, cell.load_band = -9000.0 * cell.direction, -16 * cell.direction
    last = axis.course(cells)[-1]
    assert (last.condition, last.verdict) == (Condition.UNKNOWN, says('too_little'))
