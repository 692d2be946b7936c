# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Evidence of all days: how seldom nothing alarms, and that a slow loss is found beside it."""

import dataclasses

from ballscrew_monitor.health.causes import CANDIDATES
from ballscrew_monitor.health.change import change_between
from ballscrew_monitor.health.evidence import CERTAIN, gain_of, tables_of
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import CauseCode, Place
import numpy as np
import pytest
from scipy import stats

SPEEDS = (2.0, 8.0, 30.0, 100.0)
DRAWS = 1000


@pytest.fixture(scope='module')
def model(surface):
    return Model(surface)


@pytest.fixture(scope='module')
def change(motion, model):
    """Return no change at places of four speeds, two loads and both directions."""

    def points(first):
        found = []
        for day in range(6):
            for band, speed in enumerate(SPEEDS):
                for load in (0.0, 800.0):
                    for sign in (1, -1):
                        point = motion.point(
                            first_day=motion.today + first + day,
                            place=Place(band, int(load > 0.0), 0, sign),
                            speed=sign * speed,
                            axial_load=load,
                        )
                        drag = model.friction([point])[0] + model.ideal(point)
                        found.append(dataclasses.replace(point, motor_torque=sign * drag))
        return found

    return change_between(points(0), points(40), model)


def test_a_normal_change_is_seldom_certain(change, model):
    """At most the sum over the causes of chi squared of one degree of freedom, three sigma up."""
    tables = tables_of(change.points, model)
    random, told = np.random.default_rng(7), 0
    for apart in random.multivariate_normal(np.zeros(16), change.covariance, DRAWS):
        told += gain_of(dataclasses.replace(change, change=apart), tables).fall > CERTAIN
    expected = DRAWS * len(CANDIDATES) * stats.chi2.sf(CERTAIN, 1)
    assert told <= expected + 3.0 * expected**0.5


def test_a_planted_cause_is_certain_and_named(change, model):
    tables = tables_of(change.points, model)
    planted = dataclasses.replace(change, change=model.warmer(change.points, -8.0))
    gain = gain_of(planted, tables)
    assert gain.fall > CERTAIN
    assert CANDIDATES[gain.cause].code is CauseCode.OIL_THICKER


def test_two_places_gain_nothing(change, model):
    few = dataclasses.replace(
        change,
        groups=change.groups[:2],
        points=change.points[:2],
        change=change.change[:2] + 0.1,
        friction=change.friction[:2],
        covariance=change.covariance[:2, :2],
    )
    assert gain_of(few, tables_of(few.points, model)).fall == 0.0
