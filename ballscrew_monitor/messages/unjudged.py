# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reasons for which a point has no answer of the surface, as sentences made of a row."""

import math
from typing import Any

from ballscrew_monitor.core.conversions import celsius, Direction, opposing_load
from ballscrew_monitor.core.judgement import PointSource, PointValidity
from ballscrew_monitor.judge import derived_load
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Row
from surrogate.surface import Surface


def reason_of(row: Any, surface: Surface) -> str:
    """Return why a row has no answer of the surface, empty if it has one."""
    validity = PointValidity(int(row.validity))
    if validity is PointValidity.VALID:
        return ''
    if validity is PointValidity.NO_INPUT:
        return _missing_text(row)
    if row.direction == Direction.UNKNOWN:
        return 'the direction of motion is unknown, the screw has not moved yet'
    if row.derived:
        text = derived_text(row)
        if text or validity is PointValidity.UNKNOWN:
            return text
    speed = f'speed {abs(float(row.speed)):.4g} rad/s'
    slowest, fastest = surface.speed_range
    if validity is PointValidity.SPEED_BELOW_RANGE:
        return f'{speed} is below the surface, from {slowest:.4g} rad/s'
    if validity is PointValidity.SPEED_ABOVE_RANGE:
        return f'{speed} is above the surface, to {fastest:.4g} rad/s'
    if validity is PointValidity.LOAD_OUT_OF_RANGE:
        low, high = surface.load_range
        load = opposing_load(float(row.axial_load), Direction(int(row.direction)))
        return f'opposing load {load:.4g} N is outside the surface, {low:.4g} to {high:.4g} N'
    if validity is PointValidity.TEMPERATURE_OUT_OF_RANGE:
        low, high = (celsius(limit) for limit in surface.temperature_range)
        return (
            f'oil temperature {celsius(float(row.temperature)):.4g} degC is outside the surface, '
            f'{low:.4g} to {high:.4g} degC'
        )
    if validity is PointValidity.MASKED:
        return 'the model did not converge near this point'
    return 'the surface gives no reason'


def point_or_reason(monitor: Monitor, now: int) -> Row | str:
    """Return the operating point at `now` [ns] as a row, or in a sentence why it is not known."""
    row = monitor.row_at(now)
    no_input = PointValidity.NO_INPUT, PointValidity.UNKNOWN
    if math.isnan(row.axial_load) or row.validity in no_input:
        return reason_of(row, monitor.surface)
    if abs(row.speed) < monitor.settings.limits.standstill_speed:
        return 'the screw stands still'
    return row


def derived_text(row: Any) -> str:
    """Return why the motor torque does not tell the load; empty where the surface says why."""
    first, second = float(row.derived_first), float(row.derived_second)
    if row.derived == derived_load.STANDSTILL:
        return 'the screw stands still, friction may hold any part of the load'
    if row.derived == derived_load.NO_ACCELERATION:
        return 'the acceleration is not known yet, and with it the torque that inertia takes'
    if row.derived == derived_load.TOO_MUCH_INERTIA:
        return (
            f'inertia and drag take {first:.3g} N m and the torque is {second:.3g} N m, '
            f'allowed is a share of {float(row.derived_third):g}: too little is left for the load'
        )
    if row.derived == derived_load.SEVERAL_LOADS:
        return (
            f'the torque is that of several loads, from {first:.4g} to {second:.4g} N that oppose '
            'the motion'
        )
    if row.derived == derived_load.OUTSIDE:
        return (
            f'the torque along the motion, {first:.3g} N m, asks for a load outside the surface, '
            f'{second:.4g} to {float(row.derived_third):.4g} N that oppose the motion'
        )
    return ''


def _missing_text(row: Any) -> str:
    """Return which inputs of a row are missing."""
    load = 'load', row.axial_load, row.axial_load_source
    if row.derived:  # what the load rests on
        load = 'torque', row.motor_torque, row.motor_torque_source
    inputs = (
        ('speed', row.speed, row.speed_source),
        load,
        ('temperature', row.temperature, row.temperature_source),
    )
    lost = [
        name
        for name, value, source in inputs
        if not math.isfinite(value) or source == PointSource.HELD
    ]
    if not lost:  # finite numbers with an infinite sum
        return 'an input is beyond any range'
    return f'no valid sample of {" and ".join(lost)}'
