# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The model's answer to an operating point, from a surface; no state, no clock."""

import dataclasses
import enum
import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import celsius, Direction, Nut
from surrogate.surface import Found, Regime, regime_of, Surface

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


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class MachinePoint:
    """
    Where the screw is operated, in the machine frame.

    speed [rad/s], axial_load and its uncertainty [N], temperature [K], motor_torque [N m]; NaN is
    unknown. `derived` tells that the load follows from the motor torque; the uncertainty is the
    half width of the range of such a load, NaN for any other.

    """

    speed: float
    axial_load: float
    temperature: float
    motor_torque: float = NAN
    speed_source: PointSource = PointSource.UNKNOWN
    axial_load_source: PointSource = PointSource.UNKNOWN
    temperature_source: PointSource = PointSource.UNKNOWN
    motor_torque_source: PointSource = PointSource.UNKNOWN
    direction: Direction = Direction.UNKNOWN
    direction_held: bool = False
    derived: bool = False
    axial_load_uncertainty: float = NAN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class PointEstimate:
    """
    What the model says of a point.

    `numbers` are those of the surface and None unless validity is VALID, when rcs [-] and
    efficiency [-] repeat the two that are judged. `machine_torque` [N m] is the driving torque in
    the machine frame. `reason` is a sentence that is empty for VALID.

    """

    validity: PointValidity
    reason: str = ''
    numbers: Found | None = None
    rcs: float = NAN
    efficiency: float = NAN
    machine_torque: float = NAN
    worst_nut: Nut = Nut.UNKNOWN
    regime: Regime = Regime.UNKNOWN
    contact_state: ContactState = ContactState.UNKNOWN

    @property
    def film_ratio(self) -> float:
        """Return the film ratio [-], NaN while it is not known."""
        return NAN if self.numbers is None else self.numbers.film_ratio


def contact_state_of(rcs: float, *, limit: float) -> ContactState:
    """
    Return the contact state of an RCS [-] under an RCS limit [-]; NaN is unknown.

    NONE below the limit, PARTIAL from there to below 0.5, DOMINANT from 0.5; with a limit above
    0.5 the limit decides.

    """
    if math.isnan(rcs):
        return ContactState.UNKNOWN
    if rcs < limit:
        return ContactState.NONE
    return ContactState.PARTIAL if rcs < DOMINANT_RCS else ContactState.DOMINANT


def estimate(point: MachinePoint, surface: Surface, *, rcs_limit: float) -> PointEstimate:
    """Return what `surface` says of `point`; `rcs_limit` [-] names the contact state."""
    if not math.isfinite(point.speed + point.axial_load + point.temperature):
        validity = PointValidity.NO_INPUT
    elif point.direction is Direction.UNKNOWN:
        validity = PointValidity.UNKNOWN
    else:
        numbers = surface.lookup(abs(point.speed), opposing_load_of(point), point.temperature)
        validity = PointValidity(int(numbers.validity))
        if validity is PointValidity.VALID:
            return estimate_from(point, numbers, rcs_limit=rcs_limit)
    return PointEstimate(validity=validity, reason=reason_text(validity, point, surface))


def estimate_from(point: MachinePoint, numbers: Found, *, rcs_limit: float) -> PointEstimate:
    """Return what valid `numbers` say of `point`, in the machine frame."""
    return PointEstimate(
        validity=PointValidity.VALID,
        numbers=numbers,
        rcs=numbers.rcs,
        efficiency=numbers.efficiency,
        machine_torque=conversions.signed(numbers.driving_torque, point.direction),
        worst_nut=conversions.machine_nut(numbers.worst_nut, point.axial_load),
        regime=regime_of(numbers.film_ratio),
        contact_state=contact_state_of(numbers.rcs, limit=rcs_limit),
    )


def opposing_load_of(point: MachinePoint) -> float:
    """Return the load [N] of a point that opposes its motion."""
    return conversions.opposing_load(point.axial_load, point.direction)


def _missing_text(point: MachinePoint) -> str:
    """Return which inputs of a point are missing, as a sentence."""
    load = 'load', point.axial_load, point.axial_load_source
    if point.derived:  # what the load rests on
        load = 'torque', point.motor_torque, point.motor_torque_source
    inputs = (
        ('speed', point.speed, point.speed_source),
        load,
        ('temperature', point.temperature, point.temperature_source),
    )
    lost = [
        name
        for name, value, source in inputs
        if not math.isfinite(value) or source is PointSource.HELD
    ]
    if not lost:  # finite numbers with an infinite sum
        return 'an input is beyond any range'
    return f'no valid sample of {" and ".join(lost)}'


def reason_text(validity: PointValidity, point: MachinePoint, surface: Surface) -> str:
    """Return why a point has no numbers of the surface, as a sentence."""
    if validity is PointValidity.NO_INPUT:
        return _missing_text(point)
    if point.direction is Direction.UNKNOWN:
        return 'the direction of motion is unknown, the screw has not moved yet'
    slowest, fastest = surface.speed_range
    if validity is PointValidity.SPEED_BELOW_RANGE:
        return f'speed {abs(point.speed):.4g} rad/s is below the surface, from {slowest:.4g} rad/s'
    if validity is PointValidity.SPEED_ABOVE_RANGE:
        return f'speed {abs(point.speed):.4g} rad/s is above the surface, to {fastest:.4g} rad/s'
    if validity is PointValidity.LOAD_OUT_OF_RANGE:
        low, high = surface.load_range
        load = opposing_load_of(point)
        return f'opposing load {load:.4g} N is outside the surface, {low:.4g} to {high:.4g} N'
    if validity is PointValidity.TEMPERATURE_OUT_OF_RANGE:
        low, high = (celsius(limit) for limit in surface.temperature_range)
        return (
            f'oil temperature {celsius(point.temperature):.4g} degC is outside the surface, '
            f'{low:.4g} to {high:.4g} degC'
        )
    if validity is PointValidity.MASKED:
        return 'the model did not converge near this point'
    return 'the surface gives no reason'
