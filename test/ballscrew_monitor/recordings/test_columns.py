# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The table of columns, and what follows from them."""

from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.recordings.columns import COLUMNS, JudgedColumns
import numpy as np


def test_only_a_measured_torque_is_compared():
    arrays = {name: np.zeros(2, dtype=kind) for name, kind in COLUMNS.items()}
    arrays['motor_torque'] = np.array([3.0, 4.0])
    arrays['machine_torque'] = np.array([1.0, 1.0])
    arrays['motor_torque_source'] = np.array([PointSource.MEASURED, PointSource.HELD], np.uint8)
    columns = JudgedColumns(axis='x', **arrays)
    np.testing.assert_array_equal(columns.measured_torque, [3.0, np.nan])
    np.testing.assert_array_equal(columns.torque_residual, [2.0, np.nan])
