# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Claims of health on an axis whose friction is that of textbooks, not that of a surface.

The drag of a preloaded nut is that of catalogues, times what makers scatter by; it falls and rises
with the speed by Coulomb, Stribeck and a square root, and beside it stand wipers and bearings.

"""

import math

from ballscrew_monitor.health.assess import assess, DRAG, HealthSettings
from ballscrew_monitor.health.bands import place_of
from ballscrew_monitor.health.baseline import learned
from ballscrew_monitor.health.companions import NONE_BUILT
from ballscrew_monitor.health.records import CauseCode, ComparablePoint, Condition, LoadSource
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.words import explained
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM

LEAD, RADIUS, PRELOAD = 0.01, 0.016, 990.0  # of the screw [m], [m], [N]
SPEEDS = 10, 30, 60, 120, 300, 600, 1200  # [rev/min]
FIRST, WEEKS = 20_000, 52
LOOKS = 18, 30, 42, 51  # weeks
CHANGED = 12  # week


def catalogue_drag(speed, heat, preload):
    """Return the drag of a preloaded nut [N m] by JIS B 1192, over speed [rev/min] and degC."""
    slope = LEAD / (2.0 * math.pi * RADIUS)
    torque = 0.05 * slope**-0.5 * preload * PRELOAD * LEAD / (2.0 * math.pi)
    viscous = math.sqrt(speed / 1000.0) * math.exp(-0.015 * (heat - 25.0))
    return torque * (0.6 + 0.25 * math.exp(-speed / 40.0) + 0.4 * viscous)


def sound(week):
    return {}


def lost_and_offset(week):
    """Return a preload that falls slowly by a quarter, and an offset of the torque sensor."""
    late = week > CHANGED
    return {'preload': 1.0 - 0.25 * late * (week - CHANGED) / 39, 'offset': -0.04 * late}


def offset(week):
    return {'offset': 0.05 * (week > CHANGED)}


def swollen_wiper(week):
    return {'drag': 0.15 * (week > CHANGED)}


class Axis:
    """An axis-year of weekly logs, each of all speeds both ways, without process force."""

    def __init__(self, motion, seed, change):
        self.random = np.random.default_rng(seed)
        ranges = (0.6, 0.03, 0.01), (1.6, 0.12, 0.05)
        self.maker, self.wiper, self.bearing = self.random.uniform(*ranges)
        self.points = [
            one for week in range(WEEKS) for one in self.log(motion, week, change(week))
        ]

    def log(self, motion, week, change):
        heat = 28.0 + 7.0 * math.sin(2.0 * math.pi * week / 52.0) + self.random.normal(0.0, 1.5)
        warm = 1.0 + self.random.normal(0.0, 0.012)
        for speed in SPEEDS:
            for sign in (1, -1):
                drag = self.maker * catalogue_drag(speed, heat, change.get('preload', 1.0))
                drag *= warm * (1.0 + self.random.normal(0.0, 0.01))
                drag += self.wiper + self.bearing * (1.0 + speed / 3000.0)
                drag += change.get('drag', 0.0)
                torque = sign * drag + change.get('offset', 0.0)
                yield self.point(motion, FIRST + 7 * week, sign * speed * RPM, heat, torque)

    def point(self, motion, day, speed, heat, torque):
        values = {
            'speed': speed,
            'axial_load': 0.0,
            'temperature': 273.15 + heat,
            'motor_torque': torque,
            'load_source': LoadSource.FREE,
        }
        return ComparablePoint(
            first_day=day,
            place=place_of(motion.stretch(**values)),
            surface='a',
            stretches=2,
            duration=16.0,
            torque_squares=2.0 * (0.01 * torque) ** 2,
            **values,
        )

    def healths(self, surface, limits):
        """Yield the health at each of the looks."""
        for week in LOOKS:
            today = FIRST + 7 * week
            points = [one for one in self.points if one.first_day <= today]
            baseline = learned(points, over=600.0, today=today + 1, screw=surface.screw_name)
            stamp, settings = (today + 1) * DAY - 1, HealthSettings(limits=limits)
            yield assess('x', stamp, baseline, points, (), surface, NONE_BUILT, settings)


@pytest.fixture(scope='module')
def years(motion, usual_limits):
    """Return what gives the healths of some axes with a change, which are kept."""
    surface, kept = Surface.load(shipped_surface()), {}

    def make(change):
        if change not in kept:
            axes = (Axis(motion, seed, change) for seed in range(3))
            kept[change] = [one for axis in axes for one in axis.healths(surface, usual_limits)]
        return kept[change]

    return make


EVERY = pytest.mark.parametrize(
    'change', [sound, lost_and_offset, offset, swollen_wiper], ids=lambda one: one.__name__
)


def likely(health):
    return explained(health.quantity(DRAG).value, health.causes)[1]


def test_an_offset_is_no_cause_of_a_friction_that_fell(years):
    """The sensor has one, too, but both directions together have changed by something else."""
    worse = [one for one in years(lost_and_offset) if one.condition is Condition.WORSE]
    fallen = [one for one in worse if one.quantity(DRAG).value < -0.03]
    assert len(fallen) >= 3
    for health in fallen:
        assert 'has an offset of' not in health.verdict
        assert CauseCode.SENSOR_OFFSET not in [one.code for one in likely(health)]
        text = next(one.text for one in health.causes if one.code is CauseCode.SENSOR_OFFSET)
        assert 'which alone changes the drag by ' in text


def test_an_offset_of_a_friction_that_stayed_is_told(years):
    found = [one for one in years(offset) if abs(one.quantity(DRAG).value) <= 0.03]
    assert len(found) >= 3
    for health in found:
        assert likely(health)[0].code is CauseCode.SENSOR_OFFSET
        assert likely(health)[0].size.low <= 0.05 <= likely(health)[0].size.high


def test_a_swollen_wiper_is_among_the_likely_causes(years):
    worse = [one for one in years(swollen_wiper) if one.condition is Condition.WORSE]
    named = [CauseCode.WIPER in [one.code for one in likely(health)] for health in worse]
    assert worse
    assert sum(named) > 0.5 * len(named)


@EVERY
def test_no_alarm_has_words_that_calm_beside_it(years, change):
    for health in years(change):
        words = ' '.join([health.verdict, health.advice, *health.notes])
        assert 'nothing has to be done' not in words
        if health.condition is Condition.WORSE:
            assert 'is normal' not in words


def test_boundary_running_that_is_usual_asks_for_no_other_oil(years):
    quiet = [one for one in years(sound) if one.condition is not Condition.WORSE]
    usual = [one for one in quiet if any(note.startswith('boundary ') for note in one.notes)]
    assert len(usual) >= 3
    assert {one.advice for one in usual} == {''}


@EVERY
def test_the_torque_constant_is_not_judged_by_a_drag_that_was_never_identified(years, change):
    """The shipped surface has the contacts alone, which are a tenth to a half of such a drag."""
    notes = [note for health in years(change) for note in health.notes]
    assert not [one for one in notes if 'times that of the surface' in one]
    assert [one for one in notes if 'identify it by a run without load' in one]
    assert not [one for one in years(change) if 'torque constant' in one.advice]
