# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A cause is told only if it carries the change that is reported; torques are made by hand."""

import math

from ballscrew_monitor.health.causes import (
    CANDIDATES,
    carries,
    carrying,
    causes_of,
    Fit,
    fits_of,
    NOT_IDENTIFIED,
)
from ballscrew_monitor.health.change import Change
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import CauseCode, Place
from ballscrew_monitor.health.scatter import Group
import numpy as np
import pytest

SPEEDS = 1.0, 5.0, 30.0, 84.0
"""[rad/s], 30 in the mean."""
FALLEN = -0.17
"""Change of a friction of 1 N m, everywhere."""


@pytest.fixture(scope='module')
def model(surface):
    return Model(surface)


@pytest.fixture
def change(motion):
    """Return what makes a change of a friction of 1 N m at each speed, both directions [N m]."""

    def make(added):
        points = [
            motion.point(
                place=Place(band, 0, 0, sign),
                speed=sign * speed,
                axial_load=0.0,
                motor_torque=float(sign),
                residual=math.nan,
            )
            for band, speed in enumerate(SPEEDS)
            for sign in (1, -1)
        ]
        seen = np.array([added(one) for one in points])
        return Change(
            groups=tuple(Group(one.place.speed, 0, one.place.direction) for one in points),
            points=tuple(points),
            change=seen,
            friction=np.ones(len(points)),
            covariance=1e-4 * np.eye(len(points)) + 1e-4,
            common=float(seen.mean()),
            deviation=0.01,
            freedom=8,
            stretches=80,
        )

    return make


def told(code, size, seen, model):
    """Return the cause of a code that has a size, held against a change."""
    (candidate,) = (one for one in CANDIDATES if one.code is code)
    fits = [Fit(candidate, size, size, size, 0.0)]
    (cause,) = carrying(causes_of(seen, fits), fits, seen, model)
    return cause


@pytest.mark.parametrize(
    ('code', 'size'),
    [
        (CauseCode.SENSOR_OFFSET, -0.020),  # helps one direction and hinders the other
        (CauseCode.SENSOR_OFFSET, -0.17),
        (CauseCode.WIPER, 0.17),  # the wrong sign
        (CauseCode.WIPER, -0.05),  # too little
        (CauseCode.WIPER, -0.40),  # too much
        (CauseCode.LOAD_SIGN_OR_UNIT, -0.3),  # there is no load
        (CauseCode.CHURNING, 0.17 / 30.0),
        (CauseCode.TORQUE_CONSTANT, 0.17),
    ],
)
def test_what_does_not_carry_the_change_is_not_told(code, size, change, model):
    cause = told(code, size, change(lambda one: FALLEN), model)
    assert cause.excluded
    assert cause.text.endswith(' %, not by -17 %')


@pytest.mark.parametrize(
    ('code', 'size'),
    [
        (CauseCode.WIPER, -0.17),
        (CauseCode.WIPER, -0.10),
        (CauseCode.CHURNING, -0.17 / 30.0),  # 30 rad/s in the mean
    ],
)
def test_a_cause_that_carries_the_change_stays_told(code, size, change, model):
    cause = told(code, size, change(lambda one: FALLEN), model)
    assert not cause.excluded
    assert 'not by' not in cause.text


def test_the_torque_constant_is_a_cause_beside_an_identified_drag_alone(change, model, identified):
    seen = change(lambda one: FALLEN)
    assert not told(CauseCode.TORQUE_CONSTANT, -0.17, seen, Model(identified)).excluded
    cause = told(CauseCode.TORQUE_CONSTANT, -0.17, seen, model)
    assert cause.excluded
    assert cause.text == NOT_IDENTIFIED


def test_an_offset_of_a_mean_that_did_not_change_stays_told(change, model):
    cause = told(
        CauseCode.SENSOR_OFFSET, 0.1, change(lambda one: 0.1 * one.place.direction), model
    )
    assert not cause.excluded


@pytest.mark.parametrize(
    ('alone', 'reported', 'expected'),
    [
        (-0.25, -0.25, True),
        (-0.125, -0.25, True),
        (-0.5, -0.25, True),
        (-0.124, -0.25, False),
        (-0.501, -0.25, False),
        (0.25, -0.25, False),
        (0.0, 0.25, False),
        (0.03, -0.03, True),  # both count as normal
        (0.031, -0.03, False),
        (-0.04, -0.03, True),
        (0.0, 0.031, False),
        (0.1, 0.0, False),
        (math.nan, 0.25, False),
        (math.nan, 0.0, False),
    ],
)
def test_the_limits_of_what_carries_a_change(alone, reported, expected):
    assert carries(alone, reported) is expected


def test_the_excluded_ones_come_last_and_keep_their_weight(change, model):
    """A lower drag beside an offset: the pattern is that of the offset, the mean is not."""
    seen = change(lambda one: FALLEN + 0.1 * one.place.direction)
    fits = fits_of(seen, model)
    before = causes_of(seen, fits)
    found = carrying(before, fits, seen, model)
    assert [one.excluded for one in found] == sorted(one.excluded for one in found)
    assert {one.code: one.weight for one in found} == {one.code: one.weight for one in before}
    (offset,) = (one for one in found if one.code is CauseCode.SENSOR_OFFSET)
    assert offset.excluded
    assert found[0].code is not CauseCode.SENSOR_OFFSET
