# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns of the outcome of every sample of a recording, and their sums for an axis.

A row is a speed sample that was judged, or a tick that found no fresh speed; states are published
of some rows only. A long recording is many blocks of rows, so that it need not fit into memory.

"""

from collections.abc import Mapping, Sequence
import dataclasses
import enum
from typing import Any

from ballscrew_monitor.core.conversions import Direction, Nut, seconds
from ballscrew_monitor.core.inputs import InputStatus, Source, Why
from ballscrew_monitor.core.judgement import (
    ContactState,
    Level,
    Limits,
    PointSource,
    PointValidity,
    Reason,
    Zone,
)
from ballscrew_monitor.core.state import TIMES, Totals
from ballscrew_monitor.recordings.summary import EventRecord, Summary
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Regime

Floats = NDArray[np.float64]
Times = NDArray[np.int64]
Codes = NDArray[np.uint8]
Flags = NDArray[np.bool_]

STANDSTILL, LIGHT_LOAD = 1, 2
"""Bits of the column `gates`."""


def _column(kind: Any = np.uint8, *, codes: type[enum.IntEnum] | None = None) -> Any:
    """Declare an array by the type of its numbers, and by the class of codes without a hole."""
    return dataclasses.field(metadata={'kind': kind, 'codes': codes})


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class JudgedColumns:
    """
    A stretch of rows of one axis, one array per quantity.

    stamp and log_time [ns]; speed [rad/s], axial_load [N], motor_torque and machine_torque [N m]
    in the machine frame, temperature [K], friction_torque [N m]; efficiency, rcs and film_ratio
    [-]; NaN is not known. The sources are PointSource, the other codes those of the classes that
    are named like them; `gates` has the bits STANDSTILL and LIGHT_LOAD; `machine_torque` is what
    the model says that drives the screw, `motor_torque` what was measured or is held,
    `axial_load_uncertainty` [N] the half width of the range of a derived load, NaN for any other.
    `tick` tells rows without a sample, `published` those of which the node publishes a state.

    """

    axis: str
    stamp: Times = _column(np.int64)
    log_time: Times = _column(np.int64)
    speed: Floats = _column(np.float64)
    axial_load: Floats = _column(np.float64)
    temperature: Floats = _column(np.float64)
    motor_torque: Floats = _column(np.float64)
    speed_source: Codes = _column(codes=PointSource)
    axial_load_source: Codes = _column(codes=PointSource)
    temperature_source: Codes = _column(codes=PointSource)
    motor_torque_source: Codes = _column(codes=PointSource)
    direction: Codes = _column(codes=Direction)
    validity: Codes = _column(codes=PointValidity)
    efficiency: Floats = _column(np.float64)
    rcs: Floats = _column(np.float64)
    film_ratio: Floats = _column(np.float64)
    friction_torque: Floats = _column(np.float64)
    machine_torque: Floats = _column(np.float64)
    axial_load_uncertainty: Floats = _column(np.float64)
    worst_nut: Codes = _column(codes=Nut)
    regime: Codes = _column(codes=Regime)
    contact_state: Codes = _column(codes=ContactState)
    gates: Codes = _column(np.uint8)
    zone: Codes = _column(codes=Zone)
    reason: Codes = _column(codes=Reason)
    level: Codes = _column(codes=Level)
    event_id: NDArray[np.uint32] = _column(np.uint32)
    tick: Flags = _column(np.bool_)
    published: Flags = _column(np.bool_)

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.stamp)

    @property
    def measured_torque(self) -> Floats:
        """Return the motor torque where it is measured [N m], else NaN."""
        measured = self.motor_torque_source == PointSource.MEASURED
        return np.where(measured, self.motor_torque, np.nan)

    @property
    def torque_residual(self) -> Floats:
        """
        Return measured less modelled torque [N m], machine frame, NaN where not known.

        Of a load derived from it, the torque of the model says nothing new.

        """
        derived = self.axial_load_source == PointSource.DERIVED
        return np.where(derived, np.nan, self.measured_torque - self.machine_torque)

    @property
    def judged(self) -> Flags:
        """Return which rows count as judged: those with a zone, and standstill."""
        return (self.zone != Zone.UNKNOWN) | (self.gates & STANDSTILL != 0)

    @property
    def time_to_next(self) -> Times:
        """Return the time from each row to the next [ns], zero at the end of the block."""
        return np.diff(self.stamp, append=self.stamp[-1:])


_ARRAYS = [one for one in dataclasses.fields(JudgedColumns) if one.metadata]
COLUMNS = {one.name: one.metadata['kind'] for one in _ARRAYS}
"""Type of each array of `JudgedColumns`, in their order."""
CODED = {one.name: one.metadata['codes'] for one in _ARRAYS if one.metadata['codes']}
"""Class of the codes of each array that holds some."""


def joined(blocks: Sequence[JudgedColumns]) -> JudgedColumns:
    """Return blocks of one axis, at least one, as one."""
    arrays = {name: np.concatenate([getattr(one, name) for one in blocks]) for name in COLUMNS}
    return JudgedColumns(axis=blocks[0].axis, **arrays)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisOutcome:
    """
    What a recording comes to for one axis.

    `first` and `last` are stamps of states [ns]; `events` in order, one that is still on as far
    as it is known; `inputs` as they stood at the last row, `refused` messages by input and
    why; `reason` tells why the last row has no answer, if it has none.

    """

    axis: str
    first: int
    last: int
    rows: int
    states: int
    judged: int
    totals: Totals
    events: tuple[EventRecord, ...]
    inputs: tuple[InputStatus, ...]
    refused: Mapping[Source, Mapping[Why, int]]
    limits: Limits
    reason: str = ''

    def summary(self) -> Summary | None:
        """Return the summary, None without a state."""
        if not self.states:
            return None
        return Summary(
            axis=self.axis,
            first=self.first,
            last=self.last,
            states=self.states,
            judged=self.judged,
            events=self.events,
            revolutions=self.totals.revolutions,
            energy_lost=self.totals.energy_lost,
            **{name: seconds(getattr(self.totals, name)) for name in TIMES},
        )
