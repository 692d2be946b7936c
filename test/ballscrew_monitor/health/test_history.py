# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Friction of both directions: weight, zero and counterbalance cancel, and tables of two ways."""

import math

from ballscrew_monitor.health.history import connected, effects_of, history_of, two_ways
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.health.summary import array_of
import numpy as np
import pytest

LEAD = 0.01


def both_ways(motion, *, friction=0.8, offset=0.0, force=0.0, opposes=False, **changes):
    """Return cells of both directions; the force pushes towards positive, or against motion."""
    cells = []
    for way in (1, -1):
        load = -way * force if opposes else force
        torque = way * friction - load * LEAD / (2.0 * math.pi) + offset
        cells.append(
            motion.cell(
                direction=way,
                speed=way * 50.0,
                axial_load=load,
                load_band=round(load / 100.0),
                motor_torque=torque,
                **changes,
            )
        )
    return cells


@pytest.mark.parametrize(
    'changes', [{}, {'offset': 0.3}, {'force': 900.0}, {'force': 900.0, 'opposes': True}]
)
def test_the_friction_is_that_of_both_directions(motion, changes):
    history = history_of(array_of(both_ways(motion, **changes)), LEAD)
    assert history.friction == pytest.approx(np.array([[0.8]]))
    assert history.offset == pytest.approx(np.array([[changes.get('offset', 0.0)]]), abs=1e-12)
    assert history.load_known
    assert history.groups[0].way == 0


def test_the_weight_of_an_axis_without_a_load_cell_is_an_offset(motion):
    cells = both_ways(motion, offset=1.2, load_source=LoadSource.FREE)
    history = history_of(array_of(cells), LEAD)
    assert (history.friction[0, 0], history.offset[0, 0]) == pytest.approx((0.8, 1.2))


def test_an_unknown_load_counts_only_where_there_is_no_other(motion):
    unknown = both_ways(motion, friction=2.0, load_source=LoadSource.DERIVED)
    assert not history_of(array_of(unknown), LEAD).load_known
    known = both_ways(motion)
    history = history_of(array_of([*unknown, *known]), LEAD)
    assert (history.load_known, history.friction[0, 0]) == (True, pytest.approx(0.8))


def test_one_direction_alone_counts_only_where_there_is_no_other(motion):
    ahead, back = both_ways(motion)
    assert [one.way for one in history_of(array_of([ahead]), LEAD).groups] == [1]
    assert [one.way for one in history_of(array_of([ahead, back]), LEAD).groups] == [0]
    assert history_of(array_of([]), LEAD) is None


def test_effects_of_a_table_with_holes_are_its_sums(motion):
    """Of values that are sums of two effects, whichever entries are missing."""
    random = np.random.default_rng(1)
    rows, columns = random.normal(0.0, 0.1, 12), random.normal(0.0, 1.0, 5)
    rows -= rows.mean()
    weight = (random.random((12, 5)) > 0.4).astype(float)
    weight[0] = 1.0
    row, column = two_ways(np.where(weight > 0.0, rows[:, None] + columns, 9.0), weight)
    assert row == pytest.approx(rows, abs=1e-3)
    assert column == pytest.approx(columns, abs=1e-3)


def test_logs_that_share_no_group_are_not_compared(motion):
    seen = np.array([[1, 1, 0, 0], [0, 1, 1, 0], [0, 0, 0, 1], [0, 0, 1, 0]], dtype=bool)
    assert connected(seen).tolist() == [True, True, False, True]


def test_screws_of_every_size_have_the_same_effects(motion):
    """Ratios, never newton metres."""
    small, large = [], []
    for day in range(6):
        for scale, cells in ((0.05, small), (5.0, large)):
            friction = scale * (1.0 + 0.02 * day)
            cells += both_ways(motion, friction=friction, first_day=motion.today + day)
    effects = [effects_of(history_of(array_of(cells), LEAD)).logs for cells in (small, large)]
    assert effects[0].effect == pytest.approx(effects[1].effect)
    wanted = np.log(1.0 + 0.02 * np.arange(6))
    assert effects[0].effect - effects[0].effect[0] == pytest.approx(wanted)


@pytest.mark.parametrize('constant', [1.0, 0.9])
def test_the_gain_is_that_of_the_load_though_only_one_way_is_loaded(motion, constant):
    """Free both ways at two speeds, and a cut one way between them."""
    cells = []
    for speed, friction in ((20.0, 0.6), (60.0, 1.0)):
        for way in (1, -1):
            place = {'direction': way, 'speed': way * speed, 'speed_band': round(speed)}
            torque = (way * friction + 0.05) / constant
            cells.append(motion.cell(motor_torque=torque, axial_load=0.0, load_band=0, **place))
    torque = (0.8 + 0.05 + 900.0 * LEAD / (2.0 * math.pi)) / constant
    cells.append(
        motion.cell(
            direction=1,
            speed=40.0,
            speed_band=40,
            axial_load=-900.0,
            load_band=-8,
            motor_torque=torque,
        )
    )
    history = history_of(array_of(cells), LEAD)
    assert history.gain == pytest.approx([1.0 / constant])
