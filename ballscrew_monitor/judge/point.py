# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The operating point of one instant out of the last samples, and what the surface says of it.

Functions of the subset that numba compiles: `tables` are those of the surface, `speeds` the slope
of the speeds, the other arguments as in `zone`.

"""

import math
from typing import Any

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.judgement import ContactState, DOMINANT_RCS
from ballscrew_monitor.judge.derived_load import derive_load, no_load, NOT_FRESH, STANDSTILL
from ballscrew_monitor.judge.inputs import (
    DEFAULT,
    DERIVED,
    HELD,
    LOAD,
    MEASURED,
    SPEED,
    standing_of,
    TEMPERATURE,
    TORQUE,
    UNKNOWN,
    value_of,
)
from ballscrew_monitor.judge.slopes import slope_change, slope_of
from ballscrew_monitor.judge.zone import NO_INPUT, VALID
from surrogate.surface import FILM_RATIO_LIMITS, leave, look_up, Regime

NO_DIRECTION, POSITIVE, NEGATIVE = map(int, Direction)
NO_NUT, POSITIVE_NUT, NEGATIVE_NUT = map(int, Nut)
NO_REGIME, BOUNDARY, MIXED, HYDRODYNAMIC = map(int, Regime)
MIXED_FROM, HYDRODYNAMIC_FROM = FILM_RATIO_LIMITS
NO_STATE, NO_CONTACT, PARTIAL, DOMINANT = map(int, ContactState)


def set_point(tables: Any, settings: Any, memory: Any, speeds: Any, row: Any) -> None:
    """Set the operating point of a row: what has arrived by its `now`."""
    now = row.now
    row.speed = value_of(memory, settings, SPEED)
    row.speed_source = standing_of(memory, settings, SPEED, now)
    row.temperature = value_of(memory, settings, TEMPERATURE)
    row.temperature_source = standing_of(memory, settings, TEMPERATURE, now)
    if row.temperature_source == DEFAULT:
        row.temperature = settings.default_temperature
    row.motor_torque = value_of(memory, settings, TORQUE)
    row.motor_torque_source = standing_of(memory, settings, TORQUE, now)
    moving = abs(row.speed) >= settings.standstill_speed
    if moving and row.speed_source == MEASURED:
        memory.direction = POSITIVE if row.speed > 0.0 else NEGATIVE
    row.direction = memory.direction
    row.direction_held = not moving and memory.direction != NO_DIRECTION
    row.axial_load_uncertainty = math.nan
    row.derived = 0
    row.derived_first = row.derived_second = row.derived_third = math.nan
    if settings.derives:
        _set_derived_load(tables, settings, memory, speeds, row, moving)
        return
    row.axial_load = value_of(memory, settings, LOAD)
    row.axial_load_source = standing_of(memory, settings, LOAD, now)


def _set_derived_load(
    tables: Any, settings: Any, memory: Any, speeds: Any, row: Any, moving: bool
) -> None:
    """Set the load that follows from the motor torque; it is held while an input is not fresh."""
    row.axial_load_source = UNKNOWN
    if (
        row.speed_source != MEASURED
        or row.motor_torque_source != MEASURED
        or (row.temperature_source != MEASURED and row.temperature_source != DEFAULT)
    ):
        row.derived, row.validity = NOT_FRESH, 0
        row.axial_load = memory.held_load
        if math.isfinite(memory.held_load):
            row.axial_load_source = HELD
        return
    if moving:
        acceleration, change = math.nan, math.nan
        if settings.inertia != 0.0:
            acceleration = slope_of(speeds)
            change = slope_change(speeds, settings.acceleration_window)
        derive_load(tables, settings, row, acceleration, change)
    else:
        no_load(row, 0, STANDSTILL, math.nan, math.nan, math.nan)
    memory.held_load = row.axial_load
    if math.isfinite(row.axial_load):
        row.axial_load_source = DERIVED


def set_answer(tables: Any, settings: Any, row: Any) -> None:
    """Set what the surface says of a row; that of a derived load tells whether there is one."""
    loading, source = row.axial_load, row.axial_load_source
    if row.derived != 0:
        loading, source = row.motor_torque, row.motor_torque_source
    is_number = math.isfinite(row.speed + loading + row.temperature)
    is_held = row.speed_source == HELD or source == HELD or row.temperature_source == HELD
    if is_held or not is_number:  # what is only held is never judged
        leave(row, NO_INPUT)
    elif row.direction == NO_DIRECTION:
        leave(row, 0)
    elif row.derived != 0 and row.validity != VALID:
        leave(row, row.validity)
    else:
        look_up(tables, abs(row.speed), opposing_load(row), row.temperature, row)
    set_words(settings, row)


def opposing_load(row: Any) -> float:
    """Return the load [N] of a row that opposes its motion."""
    # Subtracted from zero: a zero load must not become -0.0.
    return 0.0 - row.axial_load if row.direction == POSITIVE else row.axial_load


def set_words(settings: Any, row: Any) -> None:
    """Set torque and nut in the machine frame, regime and contact state of a row."""
    row.machine_torque, row.machine_nut = math.nan, NO_NUT
    row.regime, row.contact_state = NO_REGIME, NO_STATE
    if row.validity != VALID:
        return
    row.machine_torque = row.driving_torque
    if row.direction == NEGATIVE:
        row.machine_torque = 0.0 - row.driving_torque
    # Nut 1 of the surface is the one that the load presses, whichever way the screw turns.
    if row.worst_contact >= 0 and abs(row.axial_load) > 0.0:
        pressed = row.worst_contact // 2 == 0
        row.machine_nut = POSITIVE_NUT if pressed == (row.axial_load > 0.0) else NEGATIVE_NUT
    if row.film_ratio >= HYDRODYNAMIC_FROM:
        row.regime = HYDRODYNAMIC
    elif row.film_ratio >= MIXED_FROM:
        row.regime = MIXED
    elif row.film_ratio < MIXED_FROM:
        row.regime = BOUNDARY
    if row.rcs < settings.rcs:
        row.contact_state = NO_CONTACT
    elif row.rcs >= DOMINANT_RCS:
        row.contact_state = DOMINANT
    elif row.rcs >= settings.rcs:
        row.contact_state = PARTIAL
