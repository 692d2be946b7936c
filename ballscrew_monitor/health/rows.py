# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Motion and torque of a row of the judgement, one by one or in an array."""

import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.inputs import MEASURED
from ballscrew_monitor.judge.records import STANDSTILL
import numpy as np
from numpy.typing import NDArray

DAY = 86_400 * SECOND
"""One day [ns]."""
MAX_GAP = SECOND // 2
"""Longest time for which a sample is taken to hold [ns], unless the axis states another."""


def moves(row: Any) -> bool:
    """Return True if a row is a sample of motion."""
    return not row.tick and row.gates & STANDSTILL == 0


def has_torque(row: Any) -> bool:
    """Return True if the motor torque of a row was measured."""
    return row.motor_torque_source == MEASURED and math.isfinite(row.motor_torque)


def moves_many(rows: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which rows of an array are samples of motion."""
    return np.asarray(~rows['tick'] & (rows['gates'] & STANDSTILL == 0))


def has_torque_many(rows: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which rows of an array have a measured motor torque."""
    measured = rows['motor_torque_source'] == MEASURED
    return np.asarray(measured & np.isfinite(rows['motor_torque']))
