# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A run without load out of columns."""

import math

import numpy as np
import pytest
from surrogate.identify.data import no_load_run

WARM = 313.15


def test_points_at_standstill_are_left_out_and_counted():
    """Friction has no direction there; the columns that are absent get their defaults."""
    run = no_load_run(
        {'speed': np.array([0.0, 1.0, -2.0]), 'torque': np.array([9.0, 1.0, -1.0])},
        source='data',
        temperature=WARM,
    )
    assert run.speed.tolist() == [1.0, -2.0]
    assert run.torque.tolist() == [1.0, -1.0]
    assert run.load.tolist() == [0.0, 0.0]
    assert run.temperature.tolist() == [WARM, WARM]
    assert run.torque_std is None
    assert run.both_directions
    assert run.notes == ('1 points at standstill are left out',)


@pytest.mark.parametrize(
    ('name', 'value'), [('torque', math.nan), ('speed', math.inf), ('torque_std', 0.0)]
)
def test_numbers_that_are_none_are_refused(name, value, refused):
    """Whoever reads the data: a run holds finite numbers only."""
    columns = {'speed': np.ones(2), 'torque': np.ones(2), 'torque_std': np.ones(2)}
    columns[name][1] = value
    with refused('point_2_finite', name=name):
        no_load_run(columns, source='data', temperature=WARM)
