# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The words of a judgement: sources, validity, levels, zones, gates and limits."""

import dataclasses
import enum
import math
from typing import Self

from surrogate.files import InputError

NAN = math.nan
DOMINANT_RCS = 0.5  # [-] from here on asperities carry the larger part of the load


class PointSource(enum.IntEnum):
    """Where a number of an operating point comes from; OperatingPoint.SOURCE_."""

    UNKNOWN = 0
    MEASURED = 1
    DEFAULT = 2
    HELD = 3
    DERIVED = 4  # the load, from the motor torque


class PointValidity(enum.IntEnum):
    """Whether an instant could be judged; PointResult.VALIDITY_, up to 6 those of a surface."""

    UNKNOWN = 0
    VALID = 1
    SPEED_BELOW_RANGE = 2
    SPEED_ABOVE_RANGE = 3
    LOAD_OUT_OF_RANGE = 4
    TEMPERATURE_OUT_OF_RANGE = 5
    MASKED = 6
    NO_INPUT = 7
    NO_SURFACE = 8  # reserved by the message; without a surface the node is not active


class ContactState(enum.IntEnum):
    """Asperity contact by RCS; PointResult.CONTACT_."""

    UNKNOWN = 0
    NONE = 1
    PARTIAL = 2
    DOMINANT = 3


class Level(enum.IntEnum):
    """The held judgement; BallScrewState.LEVEL_."""

    UNKNOWN = 0
    OK = 1
    WARN = 2


class Zone(enum.IntEnum):
    """The judgement of one instant; BallScrewState.ZONE_."""

    UNKNOWN = 0
    OPTIMAL = 1
    OUTSIDE = 2


class Gate(enum.IntEnum):
    """Why a criterion is not applied; BallScrewState.GATE_."""

    UNKNOWN = 0
    STANDSTILL = 1
    LIGHT_LOAD = 2


class Code(enum.IntEnum):
    """What a finding is about; Finding.CODE_."""

    UNKNOWN = 0
    RCS_HIGH = 1
    EFFICIENCY_LOW = 2
    OUT_OF_RANGE = 3
    INPUT_LOST = 4
    MODEL_RANGE = 5  # reserved by the message; no surface says so yet


class EventEnd(enum.IntEnum):
    """How a stay outside the optimal zone ended; OutOfZone.ENDING_."""

    UNKNOWN = 0  # or it has not ended
    CLEARED = 1
    ACKNOWLEDGED = 2
    STOPPED = 3
    RESTARTED = 4
    RUN_ENDED = 5


class WarningPolicy(enum.StrEnum):
    """What diagnostics and messages warn of; no judgement knows it."""

    ZONE = 'zone'
    CHANGE = 'change'
    BOTH = 'both'

    @property
    def of_zone(self) -> bool:
        """Return True if they warn of a point outside the optimal zone."""
        return self is not WarningPolicy.CHANGE

    @property
    def of_change(self) -> bool:
        """Return True if they warn of an axis that is worse than its baseline."""
        return self is not WarningPolicy.ZONE


class Worded(enum.IntEnum):
    """Number that stands for a text."""

    text: str

    def __new__(cls, number: int, text: str) -> Self:
        """Return the member of a number and a text."""
        member = int.__new__(cls, number)
        member._value_, member.text = number, text
        return member


class Reason(Worded):
    """Why an instant has no zone, its number and in words; JUDGED where it has one."""

    JUDGED = 0, 'judged'
    STANDSTILL = 1, 'the screw stands still'
    NO_DIRECTION = 2, 'the screw has not moved yet, its direction is unknown'
    SPEED_BELOW_RANGE = 3, 'the speed is below the surface'
    SPEED_ABOVE_RANGE = 4, 'the speed is above the surface'
    LOAD_OUT_OF_RANGE = 5, 'the load is outside the surface'
    TEMPERATURE_OUT_OF_RANGE = 6, 'the oil temperature is outside the surface'
    MASKED = 7, 'the model did not converge near this point'
    NO_NUMBER = 8, 'the surface holds no number here'
    NO_SPEED = 9, 'no valid sample of the speed'
    NO_LOAD = 10, 'no valid sample of the load'
    NO_TEMPERATURE = 11, 'no valid sample of the temperature'
    NO_INPUTS = 12, 'no valid sample of several inputs'
    NO_TORQUE = 13, 'no valid sample of the motor torque, which the load is derived from'
    NO_DERIVED_LOAD = 14, 'the motor torque does not tell the load'


class Severity(enum.IntEnum):
    """How bad a finding is; Finding.SEVERITY_."""

    UNKNOWN = 0
    INFO = 1
    WARN = 2
    ERROR = 3


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Limits:
    """
    What an operating point is held against.

    rcs and efficiency [-], light_load [N], standstill_speed [rad/s], raise_delay and clear_delay
    [ns], hysteresis [-]. To clear a warning RCS must be below (1 - hysteresis) of its limit, and
    the loss 1 - efficiency at most (1 - hysteresis) of what the limit allows.

    """

    rcs: float
    efficiency: float
    light_load: float
    standstill_speed: float
    raise_delay: int
    clear_delay: int
    hysteresis: float

    def __post_init__(self) -> None:
        """Refuse limits without meaning."""
        for name in ('rcs', 'efficiency'):
            _check(name, getattr(self, name), 0.0 < getattr(self, name) < 1.0, 'between 0 and 1')
        for name in ('light_load', 'raise_delay', 'clear_delay'):
            value = getattr(self, name)
            _check(name, value, 0.0 <= value < math.inf, 'at least 0')
        slowest = self.standstill_speed
        _check('standstill_speed', slowest, 0.0 < slowest < math.inf, 'above 0')
        _check('hysteresis', self.hysteresis, 0.0 <= self.hysteresis < 1.0, 'from 0 to below 1')


def rcs_to_clear(limits: Limits) -> float:
    """Return the RCS [-] below which a warning may clear, by limits or `Settings`."""
    return limits.rcs * (1.0 - limits.hysteresis)


def efficiency_to_clear(limits: Limits) -> float:
    """Return the efficiency [-] from which a warning may clear, by limits or `Settings`."""
    return limits.efficiency + (1.0 - limits.efficiency) * limits.hysteresis


def _check(name: str, value: float, good: bool, allowed: str) -> None:
    if not good:
        raise InputError(f'limit {name} is {value!r}, it must be {allowed}')
