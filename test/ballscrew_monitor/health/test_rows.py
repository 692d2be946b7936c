# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows as health reads them: out of rows of the judgement and out of columns alike."""

import dataclasses

from ballscrew_monitor.health.rows import has_torque, JUDGED_ROW, JudgedRow, moves, rows_of
from ballscrew_monitor.judge.many import ROW
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.recordings.axis_run import columns_of
from ballscrew_monitor.recordings.columns import COLUMNS
import numpy as np


def test_rows_and_columns_of_the_judgement_have_what_health_reads():
    rows = np.zeros(3, ROW)
    rows['stamp'], rows['speed'], rows['tick'] = (1, 2, 3), 5.0, (False, True, False)
    rows['motor_torque_source'], rows['friction_torque'] = (1, 3, 4), 0.25
    found = rows_of(rows)
    assert found.dtype == JUDGED_ROW
    np.testing.assert_array_equal(found, rows_of(columns_of('x', rows)))
    assert found['speed'][1] == 5.0
    names = {field.name for field in dataclasses.fields(JudgedRow)}
    assert names <= set(COLUMNS)
    assert names <= {field.name for field in dataclasses.fields(Row)}


def test_a_row_moves_and_has_torque_by_its_gates_and_sources():
    assert moves(JudgedRow(gates=2))
    assert not moves(JudgedRow(gates=3))
    assert not moves(JudgedRow(tick=True))
    assert has_torque(JudgedRow(motor_torque=0.0, motor_torque_source=1))
    assert not has_torque(JudgedRow(motor_torque=0.0, motor_torque_source=3))
    assert not has_torque(JudgedRow(motor_torque_source=1))
