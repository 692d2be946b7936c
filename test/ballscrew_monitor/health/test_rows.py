# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Motion and torque of a row of the judgement."""

from ballscrew_monitor.health.rows import has_torque, moves
from ballscrew_monitor.judge.records import Row


def test_a_row_moves_and_has_torque_by_its_gates_and_sources():
    assert moves(Row(gates=2))
    assert not moves(Row(gates=3))
    assert not moves(Row(tick=True))
    assert has_torque(Row(motor_torque=0.0, motor_torque_source=1))
    assert not has_torque(Row(motor_torque=0.0, motor_torque_source=3))
    assert not has_torque(Row(motor_torque_source=1))
