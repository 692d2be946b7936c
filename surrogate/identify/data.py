# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Measured torque over speed without load: what an identification starts from."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError

Array = NDArray[np.float64]

STANDSTILL = 0.01
"""Screw speed below which friction has no sure direction [rad/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NoLoadRun:
    """
    Torque measured at steady speeds, one entry per point; arrays of one length.

    Screw speed [rad/s] and torque on the screw [N m], the sign of both is the direction; standard
    deviation of the torque [N m], None where it is not known; axial load [N], positive when it
    opposes positive motion; oil temperature [K]. `source` names the data, `notes` say what was
    left out.

    """

    speed: Array
    torque: Array
    torque_std: Array | None
    load: Array
    temperature: Array
    source: str
    notes: tuple[str, ...] = ()

    @property
    def direction(self) -> Array:
        """Sign of the motion [-]."""
        return np.sign(self.speed)

    @property
    def both_directions(self) -> bool:
        """Return True if there is a point in either direction."""
        return bool((self.speed > 0).any() and (self.speed < 0).any())

    @property
    def mean_temperature(self) -> float:
        """Mean temperature of the oil [K]."""
        return float(self.temperature.mean())


def no_load_run(
    columns: Mapping[str, Array], *, source: str, temperature: float, notes: tuple[str, ...] = ()
) -> NoLoadRun:
    """
    Return a run made of `columns` in SI units by quantity, without the points at standstill.

    `temperature` [K] holds where there is no such column. Raises InputError for a number that is
    not finite and for a standard deviation that is not positive.

    """
    for name, values in columns.items():
        bad = ~np.isfinite(values) | ((values <= 0) & (name == 'torque_std'))
        if bad.any():
            allowed = 'a finite number' + (' above 0' if name == 'torque_std' else '')
            raise InputError(
                f'{source}: {name} of point {int(np.argmax(bad)) + 1} is '
                f'{values[bad][0]:g}, allowed is {allowed}'
            )
    moving = np.abs(columns['speed']) >= STANDSTILL
    left = int((~moving).sum())
    kept = {name: np.asarray(values, dtype=float)[moving] for name, values in columns.items()}
    zero = np.zeros(int(moving.sum()))
    return NoLoadRun(
        speed=kept['speed'],
        torque=kept['torque'],
        torque_std=kept.get('torque_std'),
        load=kept.get('load', zero),
        temperature=kept.get('temperature', zero + temperature),
        source=source,
        notes=notes + ((f'{left} points at standstill are left out',) if left else ()),
    )
