# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages of a node as records of frames: plain numbers, words and sentences, no markup."""

import math
from typing import Any

from ballscrew_monitor.core.conversions import Direction, opposing_load, seconds, signed
from ballscrew_monitor.core.inputs import InputState
from ballscrew_monitor.core.judgement import Level, PointSource, PointValidity, Reason, Zone
from ballscrew_monitor.health.records import Condition
from ballscrew_monitor.judge.zone import BY_VALIDITY
from ballscrew_monitor.messages.health_messages import stamp_of
from ballscrew_monitor.page.health_phrases import advice_phrase, verdict_phrase
from ballscrew_monitor.page.phrases import (
    advised,
    detailed,
    free,
    missing,
    Phrase,
    phrase,
    unjudged,
    violated,
)
from ballscrew_msgs import msg
from ballscrew_msgs.msg import BallScrewState
from surrogate.units import RPM

# A code of another version of the interface is unknown, like 0.
LEVELS: dict[int, str] = {Level.OK: 'ok', Level.WARN: 'warn'}
ZONES: dict[int, str] = {Zone.OPTIMAL: 'optimal', Zone.OUTSIDE: 'outside'}
STATES_OF_INPUT = {int(state): state.name.lower() for state in InputState}
CONDITIONS = {
    int(Condition.NORMAL): 'normal',
    int(Condition.WORSE): 'worse',
    int(Condition.SLIGHTLY_CHANGED): 'slightly_changed',
}
UNKNOWN = 'unknown'
QUANTITIES = {msg.Finding.CODE_RCS_HIGH: 'rcs', msg.Finding.CODE_EFFICIENCY_LOW: 'efficiency'}
OF_UNJUDGED = msg.Finding.CODE_OUT_OF_RANGE, msg.Finding.CODE_INPUT_LOST
Pair = tuple[float, float]
OF_TORQUE = Reason.NO_DIRECTION, Reason.LOAD_OUT_OF_RANGE
"""What is said of a point in motion whose load the motor torque does not tell."""
NAN = math.nan


def row_of(state: BallScrewState) -> list[float]:
    """Return a state as a row; efficiency, RCS and film ratio only where they are judged."""
    point, result = state.point, state.result
    still = BallScrewState.GATE_STANDSTILL in state.active_gates
    light = BallScrewState.GATE_LIGHT_LOAD in state.active_gates
    back = point.direction == Direction.NEGATIVE
    direction = Direction.NEGATIVE if back else Direction.POSITIVE
    return [
        seconds(stamp_of(state.header.stamp)),
        _fresh(point.speed / RPM, point.speed_source),
        _fresh(point.axial_load, point.axial_load_source),
        _fresh(point.temperature, point.temperature_source),
        NAN if still or light else result.efficiency,
        NAN if still else result.rcs,
        NAN if still else result.film_ratio,
        NAN if still else signed(result.driving_torque, direction),
        state.measured_torque,
        float(state.level),
    ]


def _fresh(value: float, source: int) -> float:
    """Return a number, NaN where it is only held since its input went quiet."""
    return NAN if source == PointSource.HELD else float(value)


def state_record(state: BallScrewState) -> dict[str, Any]:
    """Return what a state says besides its row."""
    return {
        'level': LEVELS.get(state.level, UNKNOWN),
        'zone': ZONES.get(state.zone, UNKNOWN),
        'at_rest': BallScrewState.GATE_STANDSTILL in state.active_gates,
        'temperature_assumed': state.point.temperature_source == PointSource.DEFAULT,
        'headline': headline(state),
        'inputs': [_input(health) for health in state.inputs],
        'shelved': shelving_record(state),
        'totals': totals_record(state.totals),
    }


def headline(state: BallScrewState) -> Phrase:
    """Return in one sentence why the level or the zone is what it is."""
    worst = max(state.findings, key=lambda finding: finding.severity, default=None)
    if worst is not None and worst.code in QUANTITIES:
        quantity = QUANTITIES[worst.code]
        derived = quantity == 'efficiency' and _is_derived(state)
        return violated(quantity, worst.value, worst.limit, derived=derived)
    if worst is not None:
        return why_unjudged(state) if worst.code in OF_UNJUDGED else free(worst.text)
    if BallScrewState.GATE_STANDSTILL in state.active_gates:
        return _unjudged(state, Reason.STANDSTILL)
    if state.zone == Zone.OPTIMAL:
        light = BallScrewState.GATE_LIGHT_LOAD in state.active_gates
        return phrase('optimal_light' if light else 'optimal')
    return why_unjudged(state) if state.result.reason else phrase('nothing_judged')


def why_unjudged(state: BallScrewState) -> Phrase:
    """Return why an instant has no zone; a code of another version has the words of its node."""
    validity, sentence = state.result.validity, str(state.result.reason)
    if validity == PointValidity.NO_INPUT:
        return missing(_missing(state))
    if validity >= len(BY_VALIDITY):
        return free(sentence)
    reason = BY_VALIDITY[validity]
    if reason in OF_TORQUE and _is_derived(state) and state.point.direction:
        return detailed(_unjudged(state, Reason.NO_DERIVED_LOAD), sentence)
    return _unjudged(state, reason)


def _unjudged(state: BallScrewState, reason: int) -> Phrase:
    point = state.point
    direction = Direction.NEGATIVE if point.direction == Direction.NEGATIVE else Direction.POSITIVE
    load = opposing_load(point.axial_load, direction)
    return unjudged(reason, abs(point.speed) / RPM, load, point.temperature)


def _is_derived(state: BallScrewState) -> bool:
    """Return True if the load follows from the motor torque."""
    return any(
        health.name == 'load' and health.state == InputState.DERIVED for health in state.inputs
    )


def _missing(state: BallScrewState) -> list[str]:
    """Return the inputs of a point without a valid sample; a derived load rests on the torque."""
    load = 'motor_torque' if _is_derived(state) else 'axial_load'
    fields = {'speed': 'speed', 'load': load, 'temperature': 'temperature'}
    return [
        'torque' if field == 'motor_torque' else name
        for name, field in fields.items()
        if math.isnan(_fresh(getattr(state.point, field), getattr(state.point, f'{field}_source')))
    ]


def _input(health: msg.InputHealth) -> dict[str, Any]:
    return {
        'name': health.name,
        'state': STATES_OF_INPUT.get(health.state, UNKNOWN),
        'age_s': health.age,
        'rate_Hz': health.rate,
        'lost': health.lost if health.lost_known else None,
        'dropped': health.dropped,
        'words': health.refusal,
    }


def shelving_record(state: BallScrewState) -> dict[str, Any] | None:
    """Return how long the warning is shelved still, and why; None if it is not."""
    if not state.shelved:
        return None
    left = stamp_of(state.shelved_until) - stamp_of(state.header.stamp)
    return {'left_s': seconds(left), 'reason': state.shelve_reason}


def totals_record(totals: msg.Totals) -> dict[str, float]:
    """Return sums by the names of their fields, times [s] and energy [J]."""
    names = totals.get_fields_and_field_types()
    return {name: getattr(totals, name) for name in names if name != 'since'}


def limits_record(state: BallScrewState) -> dict[str, float]:
    """Return the limits in force."""
    return {
        'efficiency_limit': state.efficiency_limit,
        'rcs_limit': state.rcs_limit,
        'light_load_N': state.light_load_limit,
        'standstill_rpm': state.standstill_limit / RPM,
    }


def health_record(health: msg.AxisHealth) -> dict[str, Any]:
    """Return what is said of the health of an axis."""
    return {
        'condition': CONDITIONS.get(health.condition, UNKNOWN),
        'verdict': verdict_phrase(health),
        'advice': advice_phrase(health),
        'notes': [free(note) for note in health.notes],
        'quantities': [
            {
                'name': quantity.name,
                'value': quantity.value,
                'low': quantity.low,
                'high': quantity.high,
                'unit': quantity.unit,
                'known': math.isfinite(quantity.value),
                'words': free(quantity.reason) if quantity.reason else '',
            }
            for quantity in health.quantities
        ],
    }


def event_record(event: msg.OutOfZone) -> dict[str, Any]:
    """
    Return an event.

    Why the node ended it, and an advice without a speed, are sentences of the node.

    """
    by_node = event.ending in (msg.OutOfZone.ENDING_STOPPED, msg.OutOfZone.ENDING_RESTARTED)
    seen = event.ending == msg.OutOfZone.ENDING_ACKNOWLEDGED
    words = free(event.advice) if event.advice and not seen else ''
    return {
        'id': event.event_id,
        'begin': seconds(stamp_of(event.start)),
        'duration_s': event.duration,
        'quantity': QUANTITIES.get(event.cause.code, UNKNOWN),
        'worst': event.worst_value,
        'limit': event.cause.limit,
        'active': event.active,
        'shelved': event.shelved,
        'advice': words if by_node else advised(event.cause.target_speed) or words,
        'acknowledged': seen,
        'acknowledged_by': event.acknowledged_by,
        'acknowledge_reason': event.acknowledge_reason,
    }


def surface_record(info: msg.SurfaceInfo, unit: str) -> dict[str, Any]:
    """Return what an axis is, as its surface says; `unit` is that of its speed input."""
    return {
        'unit': unit if unit == 'mm/min' else 'm/min',
        'screw': info.screw,
        'oil': info.oil,
        **range_record(
            (info.speed_min, info.speed_max),
            (info.axial_load_min, info.axial_load_max),
            (info.temperature_min, info.temperature_max),
        ),
    }


def range_record(speed: Pair, load: Pair, temperature: Pair) -> dict[str, float]:
    """Return what a surface spans: speeds [rad/s], opposing loads [N] and temperatures [degC]."""
    return {
        'speed_low_rpm': speed[0] / RPM,
        'speed_high_rpm': speed[1] / RPM,
        'load_low_N': load[0],
        'load_high_N': load[1],
        'temperature_low_degC': temperature[0],
        'temperature_high_degC': temperature[1],
    }


def place_of(name: str) -> tuple[str, str, str] | None:
    """Return node, axis and part that a status is of; the axis is empty for a node as a whole."""
    parts = name.split(': ')
    if len(parts) == 2:
        parts.insert(1, '')
    return (f'/{parts[0]}', parts[1], parts[2]) if len(parts) == 3 else None
