# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Causes explain a change: sign, pattern and size, joint answers, and marks of the inputs."""

import math

from ballscrew_monitor.health.causes import causes_of, likely, preload_bound
from ballscrew_monitor.health.change import GroupChange, Marks, Shift, shift
from ballscrew_monitor.health.records import CauseCode
import numpy as np
import pytest

PRELOAD, CONSTANT, WIPER = (CauseCode.PRELOAD_LOST, CauseCode.TORQUE_CONSTANT, CauseCode.WIPER)
SPEED = np.array([5.0, 10.0, 20.0, 40.0, 80.0, 160.0])
FRICTION = np.array([0.9, 0.75, 0.65, 0.7, 0.9, 1.3])
"""A Stribeck curve: it falls and then rises."""
NO_MARKS = Marks(Shift(), Shift(), Shift(), 0.0)
GROWN = NO_MARKS._replace(lost_motion=True)


def groups(change, *, load=None, friction=FRICTION):
    size = len(friction)
    return GroupChange(
        change=np.asarray(change, dtype=float) * np.ones(size),
        deviation=np.full(size, 0.005),
        friction=np.asarray(friction),
        speed=SPEED[:size],
        load=np.zeros(size) if load is None else load,
        time=np.ones(size),
    )


def told(change, reported, *, marks=NO_MARKS, preload=math.nan, **parts):
    return {
        one.code for one in likely(causes_of(groups(change, **parts), marks, reported, preload))
    }


def test_a_loss_at_all_speeds_alike_is_the_preload_or_what_else_is_alike():
    found = told(-0.11, -0.11)
    assert {PRELOAD, CONSTANT} <= found
    assert not found & {CauseCode.OIL_THICKER, CauseCode.FILM_STARVED}


def test_more_friction_is_never_a_loss_of_preload_or_a_thinner_oil():
    found = told(0.11, 0.11)
    assert CONSTANT in found
    assert not found & {PRELOAD, CauseCode.OIL_THINNER}


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_constant_drag_is_told_by_its_shape(sign):
    """Of 0.15 N m more, or less, most where the friction is least; the mean friction has it."""
    friction = np.array([3.0, 2.0, 1.0, 0.5, 0.4, 0.4])
    change = np.log1p(sign * 0.15 / friction)
    mean = math.log1p(sign * 0.15 / friction.mean())
    found = causes_of(groups(change, friction=friction), NO_MARKS, mean, math.nan)
    assert found[0].code is WIPER
    assert {one.code for one in likely(found)} <= {WIPER, PRELOAD}
    assert found[0].size.value == pytest.approx(sign * 0.15, rel=0.02)


def test_a_starved_film_raises_low_speeds():
    change = 0.5 * (SPEED[0] / SPEED) ** 0.7
    assert told(change, float(change.mean())) == {CauseCode.FILM_STARVED}


def test_a_thinner_oil_moves_the_curve():
    """A viscosity of 0.7 along a power law of the speed."""
    friction = 0.1 * SPEED**0.5
    found = told(np.full(6, 0.5 * math.log(0.7)), 0.5 * math.log(0.7), friction=friction)
    assert CauseCode.OIL_THINNER in found


def test_a_cause_that_does_not_carry_the_change_is_excluded():
    assert told(-0.03, -0.11) == set()


def test_what_is_told_together_carries_the_reported_change():
    """Of a mean friction that is 17 % less, a constant of 17 % less and a drag of that torque."""
    factor = np.array([0.72, 0.72, 0.75, 0.8, 0.86, 0.89])
    lost = 1.0 - float(factor @ FRICTION) / float(FRICTION.sum())
    found = causes_of(groups(np.log(factor)), NO_MARKS, math.log1p(-lost), math.nan)
    sizes = {one.code: one for one in likely(found)}
    assert sizes[CONSTANT].size.value == pytest.approx(-lost)
    assert f'({-100.0 * lost:+.0f} % of torque)' in sizes[CONSTANT].text
    assert sizes[WIPER].size.value == pytest.approx(-lost * FRICTION.mean())
    assert 1.0 - sizes[PRELOAD].size.high == pytest.approx(lost / 1.2)


def test_lost_motion_that_has_grown_leaves_the_nut_and_the_support_bearing():
    loss = groups(np.log([0.88, 0.86, 0.86, 0.86, 0.88, 0.9]))
    alone = [one.code for one in likely(causes_of(loss, NO_MARKS, -0.13, math.nan))]
    assert {PRELOAD, CONSTANT, WIPER} <= set(alone)
    found = causes_of(loss, GROWN, -0.13, math.nan)
    assert [one.code for one in likely(found)] == [PRELOAD, WIPER]
    assert 'the support bearing has play' in found[1].text
    (constant,) = [one for one in found if one.code is CONSTANT]
    assert 'lost motion' in constant.text
    assert sum(one.weight for one in found) == pytest.approx(1.0)


def test_lost_motion_tells_the_nut_alone_where_no_constant_drag_fits():
    """The friction of a bearing that falls is one torque, so the ratio falls with it."""
    loss = groups(-0.2, friction=[3.0, 2.0, 1.0, 0.3, 0.2, 0.15])
    assert [one.code for one in likely(causes_of(loss, GROWN, -0.2, math.nan))] == [PRELOAD]


def test_lost_motion_says_nothing_of_more_friction():
    """Less preload never raises the friction, so play that has grown is another matter."""
    (grown, plain) = (causes_of(groups(0.11), one, 0.11, math.nan) for one in (GROWN, NO_MARKS))
    assert grown == plain


def test_the_torque_constant_is_told_by_the_torque_over_the_load():
    gain = Marks(Shift(), Shift(0.11, 0.005), Shift(), 0.0)
    assert told(0.11, 0.11, marks=gain) == {CONSTANT}
    still = Marks(Shift(), Shift(0.0, 0.005), Shift(), 0.0)
    assert CONSTANT not in told(-0.11, -0.11, marks=still)
    assert PRELOAD in told(-0.11, -0.11, marks=still)


def test_a_load_that_frees_a_nut_tells_the_preload_alone():
    """At 2.83 preloads the preload has no part in the friction."""
    load = np.array([0.0, 0.0, 0.0, 2000.0, 2830.0, 2830.0])
    change = -0.2 * (1.0 - load / 2830.0)
    found = told(change, float(change.mean()), load=load, preload=1000.0, friction=[0.7] * 6)
    assert found == {PRELOAD}


def test_weights_add_up_and_each_excluded_cause_says_why():
    causes = causes_of(groups(-0.11), NO_MARKS, -0.11, math.nan)
    assert sum(one.weight for one in causes) == pytest.approx(1.0)
    assert all(one.text for one in causes)
    assert all(one.weight == 0.0 for one in causes if one.excluded)
    assert causes_of(groups([-0.1], friction=[1.0]), NO_MARKS, -0.1, math.nan) == []


def test_a_loss_of_drag_bounds_the_loss_of_preload():
    """Of 11 %: 9 % if all drag is that of the nut, 28 % if a third of it is."""
    bound = preload_bound(0.11)
    assert 1.0 - bound.high == pytest.approx(0.11 / 1.2)
    assert 1.0 - bound.low == pytest.approx(0.28, abs=0.01)
    assert 1.0 - bound.value == pytest.approx(0.14, abs=0.01)


def test_a_shift_is_proven_beyond_its_scatter_and_its_least_size():
    values = np.r_[np.tile([0.01, -0.01], 5), np.full(4, 0.1)]
    before = np.arange(14) < 10
    found = shift(values, before, ~before)
    assert found.value == pytest.approx(0.1)
    assert found.is_proven(0.03)
    assert not found.is_proven(0.2)
    assert not shift(values[:4], before[:4], ~before[:4]).is_proven(0.0)
