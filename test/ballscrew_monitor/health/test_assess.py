# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Normal or worse, in a sentence, with the right cause, or not known yet with what is missing."""

import dataclasses
import json
import math

from ballscrew_monitor.health.assess import assess, DRAG, HealthSettings
from ballscrew_monitor.health.baseline import learned
from ballscrew_monitor.health.companions import Companions, NONE_BUILT
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import (
    Cause,
    CauseCode,
    Condition,
    LoadSource,
    Place,
    Quantity,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.words import ADVICE, advice_of, health_record, verdict_of
import numpy as np
import pytest
from surrogate.surface import PRELOAD_SHARES

SPEEDS = 3.0, 12.0, 40.0, 120.0
MORE = 1.0, 3.0, 8.0, 14.0, 25.0, 50.0, 120.0
FIRST = 20_000


class OfShare:
    """A surface at a share of the preload: friction lower, most of all at low speed."""

    def __init__(self, surface, share):
        self.surface, self.share = surface, share

    def lookup(self, *place):
        found = self.surface.lookup(*place)
        power = 0.8 / (1.0 + place[0] / 60.0)
        return dataclasses.replace(
            found, friction_torque=found.friction_torque * self.share**power
        )


@pytest.fixture(scope='module')
def axis(surface, usual_limits):
    return Axis(surface, usual_limits)


class Axis:
    """An axis whose torque is that of the model, with what each day adds, and its scatter."""

    def __init__(self, surface, limits):
        self.surface, self.limits = surface, limits
        self.companions = Companions({share: OfShare(surface, share) for share in PRELOAD_SHARES})
        self.model = Model(surface, self.companions)

    def days(self, motion, count, added, seed=1, speeds=SPEEDS):
        """Return the points of days that follow one another."""
        random = np.random.default_rng(seed)
        found = []
        for day in range(count):
            warm = 1.0 + random.normal(0.0, 0.015)
            for band, speed in enumerate(speeds):
                for sign in (1, -1):
                    point = motion.point(
                        first_day=FIRST + day,
                        place=Place(band, 0, 0, sign),
                        speed=sign * speed,
                        axial_load=0.0,
                        residual=math.nan,
                        stretches=8,
                        duration=160.0,
                        torque_squares=8e-6,
                    )
                    friction = self.model.friction([point])[0]
                    torque = sign * (warm * friction + added(point, day))
                    found.append(dataclasses.replace(point, motor_torque=torque))
        return found

    def health(self, points, *, companions=None, over=3600.0, last=None, spectrum=(), **changes):
        """Return the health on the last day."""
        today = max((one.first_day for one in points), default=FIRST) if last is None else last
        settings = HealthSettings(limits=self.limits, **changes)
        found = learned(points, over=over, today=today + 1, screw=self.surface.screw_name)
        return assess(
            'x',
            (today + 1) * DAY - 1,
            found,
            points,
            spectrum,
            self.surface,
            companions or self.companions,
            settings,
        )


def test_an_axis_that_does_not_change_is_normal(axis, motion):
    health = axis.health(axis.days(motion, 40, lambda point, day: 0.0))
    assert health.condition is Condition.NORMAL
    drag = health.quantity(DRAG)
    assert drag.low <= 0.0 <= drag.high
    assert health.verdict.startswith('Axis x is normal: its drag has changed by ')
    assert advice_of(health.condition, health.causes) == ''


@pytest.mark.parametrize('rise', [0.008, 0.010])  # [N m], about a tenth of the friction
def test_a_narrow_interval_without_zero_is_not_normal(rise, axis, motion):
    health = axis.health(axis.days(motion, 40, lambda point, day: rise if day > 12 else 0.0))
    drag = health.quantity(DRAG)
    assert drag.low > 0.0
    assert drag.high - drag.low < 0.2
    assert health.condition is Condition.UNKNOWN
    assert health.verdict.endswith(', which does not tell yet.')


def test_a_preload_that_falls_is_named_with_its_size(axis, motion):
    """It falls over 40 days to 60 % of what it was; the last week has 62 % in the mean."""

    def added(point, day):
        share = 1.0 - 0.4 * max(day - 5, 0) / 34
        return axis.model.relieved([point], share)[0]

    health = axis.health(axis.days(motion, 40, added))
    assert health.condition is Condition.WORSE
    preload = health.quantity('preload')
    assert preload.low <= 0.64 <= preload.high
    assert health.causes[0].code is CauseCode.PRELOAD_LOST
    assert 'the preload is' in health.verdict
    assert health.advice == ADVICE[CauseCode.PRELOAD_LOST]


def test_a_film_that_gets_thinner_is_an_onset_at_higher_speeds(axis, motion):
    def added(point, day):
        return axis.model.starved([point], 0.6)[0] if day > 12 else 0.0

    health = axis.health(axis.days(motion, 42, added, speeds=MORE))
    onset = health.quantity('onset of contact')
    assert 1.0 < onset.low <= 0.6 ** (-1 / 0.67) <= onset.high
    assert any(one.startswith('contact begins at ') for one in health.notes)
    clean = axis.health(axis.days(motion, 42, lambda point, day: 0.0, speeds=MORE))
    onset = clean.quantity('onset of contact')
    assert onset.low <= 1.0 <= onset.high
    assert not any(one.startswith('contact begins at ') for one in clean.notes)


def test_what_is_missing_is_said(axis, motion):
    none = axis.health([])
    assert none.condition is Condition.UNKNOWN
    assert none.verdict == (
        'Axis x: whether it is normal or worse is not known: no steady motion with a measured '
        'torque and an independent load yet.'
    )
    short = axis.health(axis.days(motion, 40, lambda point, day: 0.0), over=1e9)
    assert 'no baseline yet' in short.verdict
    old = axis.health(axis.days(motion, 4, lambda point, day: 0.0), last=FIRST + 400)
    assert 'in the last 28 days' in old.verdict
    points = axis.days(motion, 40, lambda point, day: 0.0)
    learning = axis.health(points, over=51_000.0)
    assert 'no steady motion after the baseline, add later' in learning.verdict
    others = [
        dataclasses.replace(one, place=one.place._replace(speed=40))
        if one.first_day > FIRST + 9
        else one
        for one in points
    ]
    assert 'that the baseline has, too' in axis.health(others).verdict
    unbuilt = axis.health(points, companions=NONE_BUILT)
    assert unbuilt.quantity('preload').reason == NONE_BUILT


def test_a_leap_everywhere_asks_for_another_screw(axis, motion):
    health = axis.health(axis.days(motion, 40, lambda point, day: 0.2 if day > 20 else 0.0))
    assert any('if the screw was changed, name a new baseline' in one for one in health.notes)


def test_reference_runs_that_change_are_a_note(axis, motion, bin_of_day):
    points = axis.days(motion, 40, lambda point, day: 0.05 if day > 20 else 0.0)
    runs = [dataclasses.replace(one, load_source=LoadSource.FREE) for one in points]
    bins = [bin_of_day(day) for day in sorted({one.first_day for one in points})]
    notes = axis.health(runs, spectrum=bins).notes
    assert [one for one in notes if one.startswith('the friction without process ')]
    for quiet in (axis.health(runs), axis.health(points, spectrum=bins)):
        assert not [one for one in quiet.notes if one.startswith('the friction without process ')]


@pytest.mark.parametrize('seed', range(6))
def test_clean_days_never_warn(seed, axis, motion):
    points = axis.days(motion, 60, lambda point, day: 0.0, seed=seed)
    for day in range(10, 60, 10):
        until = [one for one in points if one.first_day <= FIRST + day]
        assert axis.health(until).condition is not Condition.WORSE


def quantity(value, low, high, name=DRAG):
    return Quantity(name=name, value=value, low=low, high=high)


def cause(code, weight, excluded=False):
    return Cause(code=code, size=quantity(1, 1, 1), weight=weight, excluded=excluded, text='T')


@pytest.mark.parametrize(
    ('condition', 'causes', 'end'),
    [
        (Condition.UNKNOWN, (), 'which does not tell yet.'),
        (Condition.WORSE, (), 'the cause is not known.'),
        (Condition.WORSE, (cause(CauseCode.WIPER, 1.0),), 'the cause is that T.'),
        (
            Condition.WORSE,
            (cause(CauseCode.WIPER, 0.6), cause(CauseCode.CHURNING, 0.4)),
            'most likely T.',
        ),
    ],
)
def test_the_verdict_says_how_sure_its_cause_is(condition, causes, end):
    drag, preload = quantity(-0.1, -0.15, -0.05), Quantity(name='preload')
    causes = causes and (*causes, cause(CauseCode.PRELOAD_LOST, 0.0, excluded=True))
    found = verdict_of('x', condition, drag, preload, causes)
    assert found.endswith(end)
    assert '-10 % (-15 to -5 %)' in found


def test_a_loss_of_drag_may_be_the_preload_where_that_cannot_be_tried():
    causes, preload = (cause(CauseCode.FILM_STARVED, 1.0),), Quantity(name='preload')
    less, more = quantity(-0.1, -0.15, -0.05), quantity(0.1, 0.05, 0.15)
    said = verdict_of('x', Condition.WORSE, less, preload, causes)
    assert said.endswith('; perhaps T, or the preload is lost, which could not be tried.')
    assert verdict_of('x', Condition.WORSE, more, preload, causes).endswith('the cause is that T.')


def test_what_fits_far_worse_than_an_excluded_cause_is_not_likely():
    """The pattern is that of an offset, which cannot carry the change: no other cause steps in."""
    offset = cause(CauseCode.SENSOR_OFFSET, 0.9, excluded=True)
    drag, preload = quantity(-0.17, -0.2, -0.14), Quantity(name='preload')
    for weight, end in ((0.1, 'the cause is not known.'), (0.4, 'perhaps T, or the preload is')):
        causes = cause(CauseCode.WIPER, weight), offset
        said = verdict_of('x', Condition.WORSE, drag, preload, causes)
        assert end in said


def test_a_drag_that_stayed_is_no_lost_preload():
    causes, preload = (cause(CauseCode.SENSOR_OFFSET, 1.0),), Quantity(name='preload')
    said = verdict_of('x', Condition.WORSE, quantity(-0.02, -0.1, 0.06), preload, causes)
    assert said.endswith('; the cause is that T.')


def test_advice_is_that_of_every_likely_cause_and_every_cause_has_one():
    both = (cause(CauseCode.WIPER, 0.6), cause(CauseCode.CHURNING, 0.4))
    expected = f'{ADVICE[CauseCode.WIPER]}; or {ADVICE[CauseCode.CHURNING]}'
    assert advice_of(Condition.WORSE, both) == expected
    assert advice_of(Condition.NORMAL, both) == ''
    assert set(ADVICE) == set(CauseCode)


def test_a_record_is_strict_json_and_what_is_not_known_is_null(axis, motion):
    health = axis.health(axis.days(motion, 40, lambda point, day: 0.0), companions=NONE_BUILT)
    record = json.loads(json.dumps(health_record(health), allow_nan=False))
    assert record['condition'] == 'normal'
    assert record['quantities']['preload']['value'] is None
    assert record['baseline']['begin'] == FIRST * DAY
    assert [one['code'] for one in record['causes']] == [
        one.code.name.lower() for one in health.causes
    ]
