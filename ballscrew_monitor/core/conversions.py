# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Units and frames: the only module that knows a unit outside the SI or a sign convention.

Three frames meet here. The *input* is what a topic carries, in its unit. The *machine* frame is
positive along the axis: screw speed [rad/s] and motor torque [N m] are positive when they move the
nut in the positive direction, axial load [N] is the force on the nut. The *surface* frame knows
only the amount of the speed, and a load that is positive when it opposes the motion.

"""

import dataclasses
import datetime
import enum

from surrogate.files import InputError
from surrogate.units import MINUTE, RPM, TURN, ZERO_CELSIUS

SECOND = 1_000_000_000  # [ns]

ROTARY_SPEED_UNITS = {'rad/s': 1.0, 'rev/min': RPM}  # [rad/s]
LINEAR_SPEED_UNITS = {
    'm/s': 1.0,
    'mm/s': 1e-3,
    'mm/min': 1e-3 / MINUTE,
    'm/min': 1.0 / MINUTE,
}  # [m/s]
ROTARY_POSITION_UNITS = {'rad': 1.0, 'rev': TURN, 'deg': TURN / 360.0}  # [rad]
LINEAR_POSITION_UNITS = {'m': 1.0, 'mm': 1e-3}  # [m]
LINEAR_UNITS = LINEAR_SPEED_UNITS.keys() | LINEAR_POSITION_UNITS.keys()
POSITION_UNITS = ROTARY_POSITION_UNITS | LINEAR_POSITION_UNITS
SPEED_UNITS = ROTARY_SPEED_UNITS | LINEAR_SPEED_UNITS
LOAD_UNITS = {'N': 1.0, 'kN': 1e3}  # [N]
TEMPERATURE_UNITS = {'degC': ZERO_CELSIUS, 'K': 0.0}  # zero of the unit [K]
TORQUE_UNITS = ('N m', 'A', '%')  # of current and of the rated torque by stated constants
_ROTARY_UNITS = ROTARY_SPEED_UNITS | ROTARY_POSITION_UNITS
CURRENT_UNITS = {'A': 1.0, 'mA': 1e-3}  # [A]
TIME_UNITS = {'s': 1.0, 'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9, 'min': MINUTE, 'h': 60 * MINUTE}  # [s]
HANDS = {'right': 1.0, 'left': -1.0}


class Direction(enum.IntEnum):
    """Direction of motion along the axis; the numbers of OperatingPoint.DIRECTION_."""

    UNKNOWN = 0
    POSITIVE = 1
    NEGATIVE = 2


class Nut(enum.IntEnum):
    """A nut in the machine frame; the numbers of PointResult.NUT_."""

    UNKNOWN = 0
    POSITIVE = 1
    NEGATIVE = 2


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Scaling:
    """Straight line from the number in a message to the machine frame in SI units."""

    factor: float
    shift: float

    def __call__(self, value: float) -> float:
        """Return the SI value of `value`."""
        return value * self.factor + self.shift


def speed_scaling(
    unit: str, *, scale: float, offset: float, lead: float, handedness: str
) -> Scaling:
    """
    Return the line from a speed in `unit` to the screw speed [rad/s], machine frame.

    A position likewise, to [rad].

    A rotary unit describes the screw: positive rotation moves the nut of a right-hand thread in
    the positive direction and that of a left-hand thread in the negative one. A linear unit
    describes the nut, so that handedness has no say; it is divided by lead / (2 pi), lead [m].

    """
    factor = screw_turn(unit, lead=lead) * (
        _known('handedness', handedness, HANDS) if unit in _ROTARY_UNITS else 1.0
    )
    return Scaling(factor=scale * factor, shift=offset * factor)


def screw_turn(unit: str, *, lead: float) -> float:
    """Return the speed [rad/s] or the position [rad] of the screw that `unit` is; lead [m]."""
    if unit in _ROTARY_UNITS:
        return _ROTARY_UNITS[unit]
    return _known('speed unit', unit, SPEED_UNITS | POSITION_UNITS) * TURN / lead


def load_scaling(unit: str, *, scale: float, offset: float) -> Scaling:
    """Return the line from a force in `unit` to the axial load [N] on the nut, machine frame."""
    factor = _known('load unit', unit, LOAD_UNITS)
    return Scaling(factor=scale * factor, shift=offset * factor)


def temperature_scaling(unit: str, *, scale: float, offset: float) -> Scaling:
    """Return the line from a temperature in `unit` to [K]."""
    zero = _known('temperature unit', unit, TEMPERATURE_UNITS)
    return Scaling(factor=scale, shift=offset + zero)


def torque_scaling(unit: float, *, scale: float, offset: float, handedness: str) -> Scaling:
    """
    Return the line from a torque to that on the screw [N m], machine frame.

    `unit` is the torque at the screw [N m] of one unit, see `torque_unit`. The torque is positive
    along positive rotation of the screw, hence handedness as for speed.

    """
    factor = unit * _known('handedness', handedness, HANDS)
    return Scaling(factor=scale * factor, shift=offset * factor)


def torque_unit(
    unit: str, *, constant: float = 0.0, rated: float = 0.0, gear_ratio: float = 1.0
) -> float:
    """
    Return the torque at the screw [N m] that one `unit` of the motor is; 0 is not stated.

    constant [N m/A] and rated [N m] of the motor, gear_ratio its turns per turn of the screw [-].

    """
    values = {'N m': 1.0, 'A': constant, '%': rated / 100.0}
    if _known('torque unit', unit, values) == 0.0:
        needed = 'torque.constant [N m/A]' if unit == 'A' else 'torque.rated [N m]'
        raise InputError(f'torque unit {unit!r} needs {needed}, it is 0.0, not stated')
    return values[unit] * gear_ratio


def _known(what: str, key: str, table: dict[str, float]) -> float:
    if key not in table:
        raise InputError(f'{what} {key!r} is unknown, allowed are {", ".join(table)}')
    return table[key]


def celsius(temperature: float) -> float:
    """Return a temperature [K] in [degC]."""
    return temperature - ZERO_CELSIUS


def kelvin(temperature: float) -> float:
    """Return a temperature [degC] in [K]."""
    return temperature + ZERO_CELSIUS


def nanoseconds(seconds: float) -> int:
    """Return a time [s] as a whole number of [ns]."""
    return round(seconds * SECOND)


def seconds(nanoseconds: int) -> float:
    """Return a time [ns] in [s]."""
    return nanoseconds / SECOND


def clock_text(stamp: int) -> str:
    """Return a stamp [ns] for people, in UTC, to the second."""
    moment = datetime.datetime.fromtimestamp(stamp // SECOND, datetime.UTC)
    return f'{moment:%Y-%m-%d %H:%M:%S} UTC'


def direction_of(speed: float) -> Direction:
    """Return the direction of a screw speed [rad/s], machine frame; UNKNOWN for zero and NaN."""
    if speed > 0.0:
        return Direction.POSITIVE
    return Direction.NEGATIVE if speed < 0.0 else Direction.UNKNOWN


def opposing_load(axial_load: float, direction: Direction) -> float:
    """Return the load [N] that opposes a motion of an axial load [N], and the other way round."""
    # Subtracted from zero: a zero load must not become -0.0.
    return 0.0 - axial_load if direction is Direction.POSITIVE else axial_load


def rounded(value: float) -> str:
    """Return a number as text within 0.5 %, without decimals from 100 on."""
    return f'{value:.0f}' if abs(value) >= 100.0 else f'{value:.3g}'


def signed(amount: float, direction: Direction) -> float:
    """Return a speed or torque, machine frame, of its amount along a motion."""
    return 0.0 - amount if direction is Direction.NEGATIVE else amount


def machine_nut(nut: int, axial_load: float) -> Nut:
    """
    Return which nut the surface's nut 1 or 2 is, under an axial load [N] in the machine frame.

    Nut 1 of the surface is the one that the load presses, whichever way the screw turns: under a
    positive axial load that is the positive nut. Without a load neither nut is worse.

    """
    if nut not in (1, 2) or not abs(axial_load) > 0.0:
        return Nut.UNKNOWN
    return Nut.POSITIVE if (nut == 1) is (axial_load > 0.0) else Nut.NEGATIVE
