# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages of a node as records of frames: plain numbers, words and sentences, no markup."""

import math
from typing import Any

from ballscrew_monitor.core.advice import Advice
from ballscrew_monitor.core.conversions import Direction, seconds, signed
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.inputs import InputState
from ballscrew_monitor.core.judgement import Level, Zone
from ballscrew_monitor.core.state import ACKNOWLEDGED
from ballscrew_monitor.messages.health_messages import stamp_of
from ballscrew_monitor.messages.state_messages import TIERS
from ballscrew_msgs import msg
from ballscrew_msgs.msg import BallScrewState
from surrogate.surface import REGIMES
from surrogate.units import RPM

# A code of another version of the interface is unknown, like 0.
LEVELS: dict[int, str] = {Level.OK: 'ok', Level.WARN: 'warn'}
ZONES: dict[int, str] = {Zone.OPTIMAL: 'optimal', Zone.OUTSIDE: 'outside'}
WORDS_OF_REGIME = {int(regime): regime.word for regime in REGIMES}
STATES_OF_INPUT = {int(state): state.name.lower() for state in InputState}
CONDITIONS = {msg.AxisHealth.CONDITION_NORMAL: 'normal', msg.AxisHealth.CONDITION_WORSE: 'worse'}
UNKNOWN = 'unknown'
QUANTITIES = {msg.Finding.CODE_RCS_HIGH: 'rcs', msg.Finding.CODE_EFFICIENCY_LOW: 'efficiency'}
WORDS_OF_TIER = {code: tier for tier, code in TIERS.items()}
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
        'headline': headline(state),
        'regime': WORDS_OF_REGIME.get(state.result.regime, UNKNOWN),
        'inputs': [_input(one) for one in state.inputs],
        'shelved': shelving_record(state),
        'totals': totals_record(state.totals),
        'judged': state.judged,
    }


def headline(state: BallScrewState) -> str:
    """Return in one sentence why the level or the zone is what it is."""
    found = sorted(state.findings, key=lambda one: -one.severity)
    if found:
        return str(found[0].text)
    if BallScrewState.GATE_STANDSTILL in state.active_gates:
        return 'the screw stands still'
    if state.zone == Zone.OPTIMAL:
        light = BallScrewState.GATE_LIGHT_LOAD in state.active_gates
        return 'optimal, the load is too light to judge the efficiency' if light else 'optimal'
    return str(state.result.reason) or 'nothing has been judged yet'


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
        'warning': health.warning,
        'verdict': health.verdict,
        'advice': health.advice,
        'notes': list(health.notes),
        'quantities': [
            {
                'name': one.name,
                'value': one.value,
                'low': one.low,
                'high': one.high,
                'unit': one.unit,
                'known': math.isfinite(one.value),
                'words': one.reason or one.evidence,
            }
            for one in health.quantities
        ],
    }


def event_record(event: msg.OutOfZone) -> dict[str, Any]:
    """Return an event, without the advice in terms of its axis."""
    advice, ending = str(event.advice), ''
    if advice.startswith(ACKNOWLEDGED):
        targets = {name: getattr(event.cause, name) for name in ('target_speed', 'target_load')}
        advice, ending = Advice(**targets).text, advice
    return {
        'id': event.event_id,
        'begin': seconds(stamp_of(event.start)),
        'duration_s': event.duration,
        'quantity': QUANTITIES.get(event.cause.code, UNKNOWN),
        'worst': event.worst_value,
        'limit': event.cause.limit,
        'active': event.active,
        'shelved': event.shelved,
        'words': advice,
        'acknowledged': bool(ending),
        'acknowledged_by': ending.partition(' by ')[2],
    }


def surface_record(info: msg.SurfaceInfo, unit: str) -> dict[str, Any]:
    """Return what an axis is, as its surface says; `unit` is that of its speed input."""
    return {
        'unit': unit if unit == 'mm/min' else 'm/min',
        'screw': info.screw,
        'oil': info.oil,
        'tier': WORDS_OF_TIER.get(info.tier, UNKNOWN),
        'temperature_low_degC': info.temperature_min,
        'temperature_high_degC': info.temperature_max,
    }


def place_of(name: str) -> tuple[str, str, str] | None:
    """Return node, axis and part that a diagnostic status is of, None if it is of no axis."""
    parts = name.split(': ')
    return (f'/{parts[0]}', parts[1], parts[2]) if len(parts) == 3 else None
