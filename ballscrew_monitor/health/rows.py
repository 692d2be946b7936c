# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of the judgement as health reads them, whether they come one by one or as arrays."""

import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.inputs import MEASURED
from ballscrew_monitor.judge.records import STANDSTILL
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.records import dtype_of

NAN = math.nan
DAY = 86_400 * SECOND
"""One day [ns]."""
MAX_GAP = SECOND // 2
"""Longest time for which a sample is taken to hold [ns], unless the axis states another."""


@dataclasses.dataclass(slots=True)
class JudgedRow:
    """
    What health reads of a row of the judgement; the fields are those of `judge.records.Row`.

    stamp [ns]; speed [rad/s], axial_load [N], motor_torque [N m] in the machine frame,
    temperature [K], friction_torque of the model [N m].

    """

    stamp: int = 0
    tick: bool = False
    speed: float = NAN
    axial_load: float = NAN
    temperature: float = NAN
    motor_torque: float = NAN
    axial_load_source: int = 0
    temperature_source: int = 0
    motor_torque_source: int = 0
    direction: int = 0
    validity: int = 0
    gates: int = 0
    friction_torque: float = NAN


JUDGED_ROW = dtype_of(JudgedRow)


def rows_of(judged: Any) -> NDArray[Any]:
    """
    Return the rows of a block as an array of JUDGED_ROW.

    `judged` are rows of the judgement, an array of records, or their columns by name.

    """
    columns = {
        name: judged[name] if isinstance(judged, np.ndarray) else getattr(judged, name)
        for name in JUDGED_ROW.names or ()
    }
    made = np.empty(len(columns['stamp']), dtype=JUDGED_ROW)
    for name, column in columns.items():
        made[name] = column
    return made


def moves(row: Any) -> bool:
    """Tell whether a row is a sample of motion."""
    return not row.tick and row.gates & STANDSTILL == 0


def has_torque(row: Any) -> bool:
    """Tell whether the motor torque of a row was measured."""
    return row.motor_torque_source == MEASURED and math.isfinite(row.motor_torque)
