# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Axes beside each other: the one that is apart is named, whatever its own baseline."""

import dataclasses
import itertools

from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.peers import ranked
from ballscrew_monitor.health.records import Place
import numpy as np
import pytest

BANDS = tuple(enumerate((3.0, 12.0, 40.0, 120.0)))
DAYS = 12


@pytest.fixture(scope='module')
def axis(motion, surface):
    """Return what makes the points of an axis whose friction is a factor of the model's."""
    model = Model(surface)

    def make(factor, *, bands=BANDS, seed=0):
        noise = np.random.default_rng(seed).normal(0.0, 0.01, DAYS)
        return [
            at_factor(model, motion, band, sign * speed, motion.today - day, factor + noise[day])
            for (band, speed), sign, day in itertools.product(bands, (1, -1), range(DAYS))
        ]

    return make


def at_factor(model, motion, band, speed, day, factor):
    sign = 1 if speed > 0 else -1
    point = motion.point(
        place=Place(band, 0, 0, sign), speed=speed, axial_load=0.0, first_day=day, torque_squares=0
    )
    torque = sign * factor * model.friction([point])[0]
    return dataclasses.replace(point, motor_torque=torque)


def test_the_axis_that_is_apart_is_named_first_with_its_size(axis, surface):
    points = {name: axis(1.0, seed=seed) for seed, name in enumerate('abc')}
    first, *others = ranked(points | {'d': axis(0.8, seed=9)}, surface)
    assert (first.axis, first.is_apart, first.peers) == ('d', True, 3)
    assert first.difference.low < -0.2 < first.difference.high
    assert first.difference.high < -0.1
    assert 'beyond what these differ by' in first.text
    assert not any(one.is_apart for one in others)
    assert {one.axis for one in others} == set('abc')


def test_axes_that_differ_among_each_other_name_none(axis, surface):
    factors = {'a': 0.9, 'b': 1.0, 'c': 1.1, 'd': 1.15}
    found = ranked({name: axis(one) for name, one in factors.items()}, surface)
    assert len(found) == 4
    assert not any(one.is_apart for one in found)
    assert found[0].range_of_peers > 0.1


def test_the_order_of_the_axes_does_not_matter(axis, surface):
    points = {name: axis(1.0 - 0.1 * (name == 'c'), seed=ord(name)) for name in 'abcd'}
    turned = dict(reversed(points.items()))
    assert ranked(points, surface) == ranked(turned, surface)


@pytest.mark.parametrize('others', [('a',), ('a', 'elsewhere')])
def test_one_peer_or_another_programme_is_no_comparison(axis, surface, others):
    here, elsewhere = BANDS[:2], BANDS[2:]
    made = {'a': axis(1.0, bands=here), 'elsewhere': axis(1.0, bands=elsewhere)}
    points = {name: made[name] for name in others} | {'x': axis(0.8, bands=here)}
    assert ranked(points, surface) == []
