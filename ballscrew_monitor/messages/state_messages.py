# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Messages of states, events and surfaces.

A number that goes into a message is always passed through float(): the generated classes store
anything else as garbage when their checks are off.

"""

import math
from typing import Any

from ballscrew_monitor.core import conversions, judgement
from ballscrew_monitor.core import state as states
from ballscrew_monitor.core.advice import Advice
from ballscrew_monitor.core.conversions import celsius, Direction, SECOND, seconds
from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate
from ballscrew_monitor.core.inputs import InputStatus
from ballscrew_monitor.core.state import Event, MonitorSettings, State, TIMES, WINDOW
from ballscrew_monitor.judge.views import SOURCES
from ballscrew_msgs import msg
from builtin_interfaces.msg import Time
from surrogate.surface import Surface

TIERS = {'closed_form': msg.PointResult.TIER_CLOSED_FORM, 'full': msg.PointResult.TIER_FULL}
NAN = math.nan
NO_ADVICE = Advice()
NUMBERS = tuple(
    name
    for name, kind in msg.PointResult.get_fields_and_field_types().items()
    if kind == 'double' and name not in ('efficiency', 'rcs')
)
"""The numbers of a surface that a PointResult repeats under the same name."""


def fill_time(message: Time, stamp: int) -> None:
    """Fill in a stamp [ns]."""
    message.sec, message.nanosec = divmod(stamp, SECOND)


def fill_point(message: msg.OperatingPoint, point: MachinePoint) -> None:
    """Fill in an operating point."""
    message.speed = float(point.speed)
    message.axial_load = float(point.axial_load)
    message.temperature = celsius(float(point.temperature))
    message.motor_torque = float(point.motor_torque)
    message.speed_source = int(point.speed_source)
    message.axial_load_source = int(point.axial_load_source)
    message.temperature_source = int(point.temperature_source)
    message.motor_torque_source = int(point.motor_torque_source)
    message.direction = int(point.direction)
    message.direction_held = point.direction_held
    message.axial_load_uncertainty = float(point.axial_load_uncertainty)


def read_point(message: msg.OperatingPoint, *, default_temperature: float) -> MachinePoint:
    """
    Return the point of an evaluation request, its direction that of the speed.

    A NaN temperature means `default_temperature` [K]; at zero speed the stated direction counts.

    """
    direction = conversions.direction_of(message.speed)
    if message.speed == 0.0 and message.direction in tuple(Direction):
        direction = Direction(message.direction)
    missing = math.isnan(message.temperature)
    return MachinePoint(
        speed=message.speed,
        axial_load=message.axial_load,
        direction=direction,
        temperature=default_temperature if missing else conversions.kelvin(message.temperature),
    )


def fill_result(message: msg.PointResult, result: PointEstimate, tier: int) -> None:
    """Fill in what the model says, `tier` a TIER_ constant."""
    numbers = result.numbers
    message.validity = int(result.validity)
    message.tier = tier
    message.reason = result.reason
    message.efficiency = float(result.efficiency)
    message.rcs = float(result.rcs)
    for name in NUMBERS:
        setattr(message, name, NAN if numbers is None else float(getattr(numbers, name)))
    message.back_driving = numbers is not None and bool(numbers.back_driving)
    message.corrected = numbers is not None and bool(numbers.corrected)
    message.worst_side = 0 if numbers is None else int(numbers.worst_side)
    message.worst_nut = int(result.worst_nut)
    message.regime = int(result.regime)
    message.contact_state = int(result.contact_state)


def finding_message(finding: judgement.Finding, advice: Advice = NO_ADVICE) -> msg.Finding:
    """Return a finding as a message, with the advice on it."""
    return msg.Finding(
        code=int(finding.code),
        severity=int(finding.severity),
        value=float(finding.value),
        limit=float(finding.limit),
        unit=finding.unit,
        text=finding.text,
        target_speed=float(advice.target_speed),
        target_load=NAN,  # no load is ever advised
    )


def fill_window(message: msg.WindowStatistics, window: states.WindowStatistics) -> None:
    """Fill in the statistics of a window."""
    message.count = window.count
    for name in WINDOW:
        extremes = getattr(window, name)
        setattr(message, f'{name}_min', float(extremes.low))
        setattr(message, f'{name}_mean', float(extremes.mean))
        setattr(message, f'{name}_max', float(extremes.high))


def fill_input(message: msg.InputHealth, status: InputStatus) -> None:
    """Fill in the status of one input."""
    message.name = status.source.name.lower()
    message.state = int(status.state)
    message.stamp_source = int(status.stamp_source)
    message.age = float(status.age)
    message.rate = float(status.rate)
    message.received = status.received
    message.dropped = status.dropped
    message.lost = status.lost or 0
    message.lost_known = status.lost is not None
    message.lag = float(status.lag)
    message.refusal = status.refusal


def fill_totals(message: Any, totals: states.Totals) -> None:
    """Fill in the totals."""
    for name in TIMES:
        setattr(message, name, seconds(getattr(totals, name)))
    message.revolutions = float(totals.revolutions)
    message.energy_lost = float(totals.energy_lost)
    fill_time(message.since, totals.since)


class StateWriter:
    """Writes states of one axis into one message that is used again and again."""

    def __init__(self, axis: str, tier: int) -> None:
        """Begin with an empty message, `tier` a TIER_ constant."""
        self.tier = tier
        self._message = msg.BallScrewState(axis=axis, inputs=[msg.InputHealth() for _ in SOURCES])
        self._message.header.frame_id = axis

    def write(self, state: State) -> msg.BallScrewState:
        """Return the message of `state`; it is good until the next call."""
        message = self._message
        fill_time(message.header.stamp, state.stamp)
        fill_time(message.level_since, state.level_since)
        fill_point(message.point, state.point)
        fill_result(message.result, state.estimate, self.tier)
        fill_window(message.window, state.window)
        fill_totals(message.totals, state.totals)
        for part, status in zip(message.inputs, state.inputs):
            fill_input(part, status)
        _fill_judgement(message, state)
        message.measured_torque = float(state.measured_torque)
        message.torque_residual = float(state.torque_residual)
        message.surface_id = state.surface_id
        message.shelved = state.shelving.until != 0
        fill_time(message.shelved_until, state.shelving.until)
        message.shelve_reason = state.shelving.reason
        return message


def _fill_judgement(message: msg.BallScrewState, state: State) -> None:
    message.level = int(state.level)
    message.event_id = state.event_id
    message.zone = int(state.verdict.zone)
    message.findings = [finding_message(finding) for finding in state.verdict.findings]
    message.active_gates = [int(gate) for gate in state.verdict.gates]
    message.rcs_limit = float(state.limits.rcs)
    message.efficiency_limit = float(state.limits.efficiency)
    message.light_load_limit = float(state.limits.light_load)
    message.standstill_limit = float(state.limits.standstill_speed)
    message.judged = state.judged


def plain_values(state: State) -> dict[str, float | str | bool]:
    """Return what each plain topic says of a state; numbers that are not known are NaN."""
    result = state.estimate
    return {
        'efficiency': float(result.efficiency),
        'rcs': float(result.rcs),
        'film_ratio': float(result.film_ratio),
        'regime': result.regime.name,
        'out_of_zone': state.level is judgement.Level.WARN and not state.shelving.until,
    }


def out_of_zone_message(axis: str, event: Event, *, shelved: bool) -> msg.OutOfZone:
    """Return an event as a message; event 0 is inactive and says that there has been none."""
    message = msg.OutOfZone(
        axis=axis,
        event_id=event.number,
        active=event.active,
        duration=seconds(event.stamp - event.start),
        worst_value=float(event.worst_value),
        cause=finding_message(event.cause, event.advice),
        advice=event.ending or event.advice.text,
        shelved=shelved,
    )
    message.header.frame_id = axis
    fill_time(message.header.stamp, event.stamp)
    fill_time(message.start, event.start)
    return message


def surface_info_message(
    axis: str, surface: Surface, settings: MonitorSettings, *, stamp: int
) -> msg.SurfaceInfo:
    """Return what a surface is and what is judged with it, `stamp` [ns]."""
    errors = surface.errors
    message = msg.SurfaceInfo(
        axis=axis,
        screw=surface.screw_name,
        oil=surface.oil_name,
        tier=TIERS[surface.tier],
        sha256=surface.sha256,
        rcs_limit=settings.limits.rcs,
        efficiency_limit=settings.limits.efficiency,
        error_field=list(errors),
        error_max=[float(error[0]) for error in errors.values()],
        error_p95=[float(error[1]) for error in errors.values()],
        default_temperature=celsius(settings.default_temperature),
    )
    message.limit_factor_low, message.limit_factor_high = surface.limit_band
    message.numerical_factor_low, message.numerical_factor_high = surface.numerical_band
    for one in surface.corrections:
        message.corrected_speed.append(float(one.speed))
        message.corrected_load.append(float(one.opposing_load))
        message.corrected_temperature.append(celsius(float(one.temperature)))
    message.header.frame_id = axis
    fill_time(message.header.stamp, stamp)
    ranges = {
        'speed': surface.speed_range,
        'axial_load': surface.load_range,
        'temperature': map(celsius, surface.temperature_range),
    }
    for name, (low, high) in ranges.items():
        setattr(message, f'{name}_min', float(low))
        setattr(message, f'{name}_max', float(high))
    return message
