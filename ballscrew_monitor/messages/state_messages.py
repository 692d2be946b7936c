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
from ballscrew_monitor.core.advice import speed_advice
from ballscrew_monitor.core.conversions import celsius, Direction, SECOND, seconds
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source
from ballscrew_monitor.core.judgement import (
    Code,
    EventEnd,
    Gate,
    Level,
    PointSource,
    PointValidity,
    Severity,
    Zone,
)
from ballscrew_monitor.core.prerequisites import check_interfaces
from ballscrew_monitor.core.state import MonitorSettings, WINDOW
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import LIGHT_LOAD, Row, STANDSTILL
from ballscrew_monitor.judge.views import SOURCES, total_times
from ballscrew_monitor.judge.zone import ACTIVE
from ballscrew_monitor.messages.unjudged import reason_of
from ballscrew_msgs import msg
from builtin_interfaces.msg import Time
from surrogate.surface import Regime, Surface
from surrogate.units import TURN

check_interfaces(msg)
TIERS = {'closed_form': msg.PointResult.TIER_CLOSED_FORM, 'full': msg.PointResult.TIER_FULL}
NAN = math.nan
NOT_CONFIGURED = InputState.NOT_CONFIGURED
GATES = [gate for gate in Gate if gate]
USUAL = 'nothing has to be done: usual for this axis'


def _names(message: type[Any], kind: str) -> tuple[str, ...]:
    """Return the fields of a message that are of one kind."""
    fields = message.get_fields_and_field_types()
    return tuple(name for name in fields if fields[name] == kind)


NUMBERS = _names(msg.PointResult, 'double')
POINT_NUMBERS, POINT_CODES = (_names(msg.OperatingPoint, kind) for kind in ('double', 'uint8'))
"""Numbers and codes of a row that a PointResult and an OperatingPoint repeat by name."""


def fill_time(message: Time, stamp: int) -> None:
    """Fill in a stamp [ns]."""
    message.sec, message.nanosec = divmod(stamp, SECOND)


def fill_point(message: msg.OperatingPoint, row: Any) -> None:
    """Fill in the operating point of a row."""
    for name in POINT_NUMBERS:
        setattr(message, name, float(getattr(row, name)))
    message.temperature = celsius(message.temperature)
    for name in POINT_CODES:
        setattr(message, name, int(getattr(row, name)))
    message.direction_held = bool(row.direction_held)


def read_point(message: msg.OperatingPoint, *, default_temperature: float) -> Row:
    """
    Return the point of an evaluation request, its direction that of the speed.

    A NaN temperature means `default_temperature` [K]; at zero speed the stated direction counts.

    """
    direction = conversions.direction_of(message.speed)
    if message.speed == 0.0 and message.direction in tuple(Direction):
        direction = Direction(message.direction)
    missing = math.isnan(message.temperature)
    return Row(
        speed=message.speed,
        axial_load=message.axial_load,
        direction=int(direction),
        temperature=default_temperature if missing else conversions.kelvin(message.temperature),
    )


def fill_result(message: msg.PointResult, row: Any, tier: int, reason: str) -> None:
    """Fill in what a row says of its point, `tier` a TIER_ constant; or the `reason` why not."""
    valid = row.validity == PointValidity.VALID
    message.validity = int(row.validity)
    message.tier = tier
    message.reason = reason
    for name in NUMBERS:
        setattr(message, name, float(getattr(row, name)) if valid else NAN)
    message.back_driving = valid and bool(row.back_driving)
    message.corrected = valid and bool(row.corrected)
    message.worst_side = int(row.worst_side) if valid else 0
    message.worst_nut = int(row.machine_nut)
    message.regime = int(row.regime)
    message.contact_state = int(row.contact_state)


def findings_of(row: Any, limits: judgement.Limits, reason: str) -> list[msg.Finding]:
    """Return what is wrong with the instant of a row; `reason` is why it has no answer."""
    rcs, efficiency = float(row.rcs), float(row.efficiency)
    still, light = row.gates & STANDSTILL, row.gates & LIGHT_LOAD
    findings: list[msg.Finding] = []
    if row.zone == Zone.OUTSIDE and rcs >= limits.rcs:
        findings.append(violation(Code.RCS_HIGH, rcs, limits.rcs))
    if row.zone == Zone.OUTSIDE and not light and efficiency < limits.efficiency:
        derived = bool(row.derived)
        findings.append(
            violation(Code.EFFICIENCY_LOW, efficiency, limits.efficiency, derived=derived)
        )
    lost = row.validity == PointValidity.NO_INPUT
    if row.zone == Zone.UNKNOWN and (not still or lost):
        findings.append(
            finding(
                Code.INPUT_LOST if lost else Code.OUT_OF_RANGE,
                Severity.ERROR if lost else Severity.WARN,
                reason or 'the surface holds no number here',
            )
        )
    return findings


def finding(code: Code, severity: Severity, text: str) -> msg.Finding:
    """Return a finding that has no numbers; no load is ever advised."""
    nothing = dict.fromkeys(('value', 'limit', 'target_speed', 'target_load'), NAN)
    return msg.Finding(code=int(code), severity=int(severity), unit='-', text=text, **nothing)


def violation(code: Code, value: float, limit: float, *, derived: bool = False) -> msg.Finding:
    """Return the finding that a criterion is not met [-]; a `derived` load is named."""
    if code is Code.RCS_HIGH:
        text = f'asperities carry too much: RCS {value:.3g}, limit {limit:.3g}'
    elif code is not Code.UNKNOWN:
        text = f'too much power is lost: efficiency {value:.3g}, limit {limit:.3g}'
        text += ', efficiency judged from a load derived from the motor torque' if derived else ''
    else:
        return finding(code, Severity.UNKNOWN, '')
    message = finding(code, Severity.WARN, text)
    message.value, message.limit = float(value), float(limit)
    return message


def fill_window(message: msg.WindowStatistics, memory: Any) -> None:
    """Fill in the statistics of the window since the last state; NaN where there was nothing."""
    message.count = int(memory.window_count[Source.SPEED])
    for column, name in enumerate(WINDOW):
        count = int(memory.window_count[column])
        low, high = float(memory.window_low[column]), float(memory.window_high[column])
        mean = float(memory.window_total[column]) / count if count else NAN
        setattr(message, f'{name}_min', low if count else NAN)
        setattr(message, f'{name}_mean', mean)
        setattr(message, f'{name}_max', high if count else NAN)


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


def fill_totals(message: msg.Totals, memory: Any) -> None:
    """Fill in the totals that a memory holds."""
    for name, time in total_times(memory).items():
        setattr(message, name, seconds(time))
    message.revolutions = float(memory.angle) / TURN
    message.energy_lost = float(memory.energy_lost)
    fill_time(message.since, int(memory.since))


def empty_state(axis: str) -> msg.BallScrewState:
    """Return a state of an axis to be filled."""
    message = msg.BallScrewState(axis=axis, inputs=[msg.InputHealth() for _ in SOURCES])
    message.header.frame_id = axis
    return message


def fill_state(message: msg.BallScrewState, row: Any, monitor: Monitor) -> tuple[InputStatus, ...]:
    """
    Fill in the state that a row is published as, `monitor` remembering what it did after the row.

    Return how well the inputs do.

    """
    reason, inputs = reason_of(row, monitor.surface), monitor.input_status(int(row.now))
    fill_time(message.header.stamp, int(row.stamp))
    fill_point(message.point, row)
    fill_result(message.result, row, TIERS[monitor.surface.tier], reason)
    fill_window(message.window, monitor.memory)
    fill_totals(message.totals, monitor.memory)
    for part, status in zip(message.inputs, inputs):
        if part.state != NOT_CONFIGURED or status.state is not NOT_CONFIGURED:  # which stays
            fill_input(part, status)
    limits = monitor.settings.limits
    message.level, message.zone = int(row.level), int(row.zone)
    fill_time(message.level_since, int(row.level_since))
    message.event_id = int(row.event_id)
    message.findings = findings_of(row, limits, reason)
    gates = int(row.gates)
    message.active_gates = [int(gate) for gate in GATES if gates & 1 << gate - 1] if gates else []
    message.rcs_limit = float(limits.rcs)
    message.efficiency_limit = float(limits.efficiency)
    message.light_load_limit = float(limits.light_load)
    message.standstill_limit = float(limits.standstill_speed)
    message.judged = int(monitor.memory.judged)
    measured = row.motor_torque_source == PointSource.MEASURED
    message.measured_torque = torque = float(row.motor_torque) if measured else NAN
    # Of a load derived from it, the torque of the model says nothing new.
    message.torque_residual = NAN if row.derived else torque - float(row.machine_torque)
    message.surface_id = monitor.surface.sha256[:16]
    fill_shelving(message, monitor.shelving.at(int(row.now)))
    return inputs


def fill_shelving(message: msg.BallScrewState, shelving: states.Shelving) -> None:
    """Fill in until when the warning is shelved, and why."""
    message.shelved = shelving.until != 0
    fill_time(message.shelved_until, shelving.until)
    message.shelve_reason = shelving.reason


def plain_values(state: msg.BallScrewState) -> dict[str, float | str | bool]:
    """Return what each plain topic says of a state; numbers that are not known are NaN."""
    result = state.result
    return {
        'efficiency': result.efficiency,
        'rcs': result.rcs,
        'film_ratio': result.film_ratio,
        'regime': Regime(result.regime).name,
        'out_of_zone': state.level == Level.WARN and not state.shelved,
    }


def advice_text(target_speed: float, health: Health | None = None, *, usual: bool = False) -> str:
    """
    Return what to do about an event, empty where nothing is known to help.

    First comes what the workshop can change by itself, as the last `health` tells it, then a speed
    [rad/s] where the process leaves it free. No load is ever named. `usual`: the baseline of the
    axis already had this warning.

    """
    workshop = '' if health is None else health.advice
    ways = [way for way in (workshop, speed_advice(target_speed)) if way]
    if not ways and (usual or (health is not None and health.usual)):
        return USUAL
    return '; or '.join(ways)


def event_cause(memory: Any) -> msg.Finding:
    """Return by what the last event of a memory was raised, as the finding of its worst sample."""
    return violation(
        Code(int(memory.event_code[ACTIVE])),
        float(memory.event_worst[ACTIVE]),
        float(memory.event_limit[ACTIVE]),
        derived=bool(memory.event_derived[ACTIVE]),
    )


def out_of_zone_message(
    monitor: Monitor, *, shelved: bool, health: Health | None = None, usual: bool = False
) -> msg.OutOfZone:
    """
    Return the last event as a message; event 0 is inactive and says that there has been none.

    `health` is the last assessment of the axis, if there is one.

    """
    axis, memory, ending = monitor.settings.axis, monitor.memory, monitor.ending
    stamp, start = int(memory.event_stamp), int(memory.event_start[ACTIVE])
    message = msg.OutOfZone(
        axis=axis,
        event_id=int(memory.event_number),
        active=bool(memory.event_active),
        duration=seconds(stamp - start),
        worst_value=float(memory.event_worst[ACTIVE]),
        cause=event_cause(memory),
        advice=ending.text or advice_text(monitor.target_speed, health, usual=usual),
        shelved=shelved,
        ending=int(ending.kind),
    )
    message.cause.target_speed = float(monitor.target_speed)
    if ending.kind is EventEnd.ACKNOWLEDGED:
        message.acknowledged_by = ending.name
        message.acknowledge_reason = ending.reason
    message.header.frame_id = axis
    fill_time(message.header.stamp, stamp)
    fill_time(message.start, start)
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
    for correction in surface.corrections:
        message.corrected_speed.append(float(correction.speed))
        message.corrected_load.append(float(correction.opposing_load))
        message.corrected_temperature.append(celsius(float(correction.temperature)))
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
