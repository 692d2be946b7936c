# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The zone of one instant, the level that is held over time, excursions out of the zone, and sums.

Equality has one side: rcs == limit is outside, efficiency == limit is optimal, speed at the
standstill limit moves, load at the light limit is judged, a delay that is exactly over is over.
Sums are statistics of the window since the last state, and totals since their reset.
Functions of the subset that numba compiles; `row` is a `Row`, the others as in `inputs`.

"""

import math
from typing import Any

from ballscrew_monitor.core import judgement
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import (
    efficiency_to_clear,
    PointSource,
    PointValidity,
    rcs_to_clear,
    Reason,
)
from ballscrew_monitor.judge.records import (
    COLUMNS,
    EVENT_BEGINS,
    EVENT_ENDS,
    LIGHT_LOAD,
    STANDSTILL,
)

HELD = int(PointSource.HELD)
VALID, NO_INPUT = int(PointValidity.VALID), int(PointValidity.NO_INPUT)
NO_ZONE, OPTIMAL, OUTSIDE = map(int, judgement.Zone)
_, OK, WARN = map(int, judgement.Level)
RCS_HIGH, EFFICIENCY_LOW = int(judgement.Code.RCS_HIGH), int(judgement.Code.EFFICIENCY_LOW)
NO_SPEED, NO_LOAD = int(Reason.NO_SPEED), int(Reason.NO_LOAD)
NO_TEMPERATURE, NO_TORQUE = int(Reason.NO_TEMPERATURE), int(Reason.NO_TORQUE)
NO_INPUTS, NO_DERIVED_LOAD = int(Reason.NO_INPUTS), int(Reason.NO_DERIVED_LOAD)
STANDS_STILL = int(Reason.STANDSTILL)
BY_VALIDITY = (int(Reason.NO_DIRECTION), int(Reason.NO_NUMBER)) + tuple(
    int(Reason[validity.name]) for validity in PointValidity if validity.name in Reason.__members__
)
"""The reason of a validity of the surface, where the screw moves and there is no zone."""
ACTIVE, PENDING = 0, 1
"""Places of an excursion in `Memory`: active or the last, and one that may be raised."""


def shut_gates(settings: Any, memory: Any, row: Any) -> None:
    """
    Shut the gates of a row; numbers that are unknown or held shut none.

    The light-load gate opens only from (1 + hysteresis) of its limit on, so that a load about the
    limit does not judge and leave out the efficiency in turn.

    """
    row.gates = 0
    if abs(row.speed) < settings.standstill_speed and row.speed_source != HELD:
        row.gates = STANDSTILL
    if math.isnan(row.axial_load) or row.axial_load_source == HELD:
        return
    least = settings.light_load
    if memory.light:
        least *= 1.0 + settings.hysteresis
    memory.light = abs(row.axial_load) < least
    if memory.light:
        row.gates += LIGHT_LOAD


def set_zone(settings: Any, row: Any) -> None:
    """
    Set the zone of a row and whether it counts towards clearing a warning.

    UNKNOWN without a VALID answer and at standstill; OPTIMAL when every criterion that applies is
    met, OUTSIDE when one is not. Under a light load only RCS applies.

    """
    row.zone, row.clears = NO_ZONE, False
    if row.validity != VALID or row.gates & STANDSTILL != 0:
        return
    if math.isnan(row.rcs + row.efficiency):
        return
    light = row.gates & LIGHT_LOAD != 0
    if row.rcs >= settings.rcs or (not light and row.efficiency < settings.efficiency):
        row.zone = OUTSIDE
        return
    row.zone = OPTIMAL
    row.clears = row.rcs < rcs_to_clear(settings) and (
        light or row.efficiency >= efficiency_to_clear(settings)
    )


def set_reason(row: Any) -> None:
    """Set why a row has no zone, 0 where it has one."""
    row.reason = 0
    if row.zone != NO_ZONE:
        return
    if row.gates & STANDSTILL != 0:  # whatever else is missing, there is nothing to judge
        row.reason = STANDS_STILL
    elif row.validity == NO_INPUT:
        lost, count = NO_INPUTS, 0  # the only one that is missing
        if not math.isfinite(row.speed) or row.speed_source == HELD:
            lost, count = NO_SPEED, 1
        if row.derived != 0:
            if not math.isfinite(row.motor_torque) or row.motor_torque_source == HELD:
                lost, count = NO_TORQUE, count + 1
        elif not math.isfinite(row.axial_load) or row.axial_load_source == HELD:
            lost, count = NO_LOAD, count + 1
        if not math.isfinite(row.temperature) or row.temperature_source == HELD:
            lost, count = NO_TEMPERATURE, count + 1
        row.reason = lost if count == 1 else NO_INPUTS
    elif row.derived != 0 and row.validity == 0:
        row.reason = NO_DERIVED_LOAD
    else:
        row.reason = BY_VALIDITY[row.validity]


def is_judged(row: Any) -> bool:
    """Return True if a verdict was possible; that nothing applies at standstill is one too."""
    return row.zone != NO_ZONE or row.gates & STANDSTILL != 0


def hold_level(settings: Any, memory: Any, row: Any, max_gap: int, period: int) -> None:
    """
    Hold the level after one more row.

    WARN is raised by rows outside for `raise_delay` without an optimal one between them; a row
    without a zone neither adds nor takes away, a hole of more than `max_gap` [ns] and of more than
    the `period` [ns] of a slow input starts over. OK needs rows that count towards clearing for
    `clear_delay` and nothing else between them: a row without a zone and any hole start that over.
    So an unknown never brings OK nearer and never sends a warning away.

    """
    if row.zone == OUTSIDE:
        memory.clearing = False
        if memory.level == WARN:
            return
        if not memory.raising or row.stamp - memory.raising_last > max(max_gap, period):
            memory.raising_start = row.stamp
        memory.raising, memory.raising_last = True, row.stamp
        if row.stamp - memory.raising_start >= settings.raise_delay:
            _set_level(memory, WARN, row.stamp)
    elif row.zone == OPTIMAL:
        memory.raising = False
        if memory.level == OK or (memory.level == WARN and not row.clears):
            memory.clearing = False
            return
        if not memory.clearing or row.stamp - memory.clearing_last > max_gap:
            memory.clearing_start = row.stamp
        memory.clearing, memory.clearing_last = True, row.stamp
        if row.stamp - memory.clearing_start >= settings.clear_delay:
            _set_level(memory, OK, row.stamp)
    else:
        memory.clearing = False


def _set_level(memory: Any, level: int, stamp: int) -> None:
    memory.level, memory.level_since = level, stamp
    memory.raising = memory.clearing = False


def follow_excursion(settings: Any, memory: Any, row: Any, level_before: int) -> None:
    """Keep the worst value of the excursion, and set which edge of it the row is."""
    row.edge = 0
    if row.zone == OPTIMAL and memory.level != WARN:
        memory.pending = False
    if row.zone == OUTSIDE:
        if memory.event_active:
            _worsen(settings, memory, row, ACTIVE)
        else:
            if not memory.pending or (memory.raising and memory.raising_start == row.stamp):
                memory.pending = True
                _begin(settings, memory, row)
            _worsen(settings, memory, row, PENDING)
    if memory.level == WARN:
        if level_before != WARN and memory.pending:
            row.edge = EVENT_BEGINS
            memory.event_number += 1
            memory.event_active, memory.pending, memory.event_stamp = True, False, row.stamp
            memory.event_start[ACTIVE] = memory.event_start[PENDING]
            memory.event_code[ACTIVE] = memory.event_code[PENDING]
            memory.event_worst[ACTIVE] = memory.event_worst[PENDING]
            memory.event_limit[ACTIVE] = memory.event_limit[PENDING]
            memory.event_speed[ACTIVE] = memory.event_speed[PENDING]
            memory.event_load[ACTIVE] = memory.event_load[PENDING]
            memory.event_temperature[ACTIVE] = memory.event_temperature[PENDING]
            memory.event_direction[ACTIVE] = memory.event_direction[PENDING]
            memory.event_derived[ACTIVE] = memory.event_derived[PENDING]
    elif end_excursion(memory, row.stamp):
        row.edge = EVENT_ENDS


def end_excursion(memory: Any, stamp: int) -> bool:
    """End the active excursion at `stamp` [ns]; return True if there is one."""
    if not memory.event_active:
        return False
    memory.event_active, memory.event_stamp = False, stamp
    return True


def _begin(settings: Any, memory: Any, row: Any) -> None:
    """Begin an excursion that is not raised yet; its cause is the first criterion not met."""
    memory.event_start[PENDING] = row.stamp
    memory.event_code[PENDING] = RCS_HIGH if row.rcs >= settings.rcs else EFFICIENCY_LOW
    memory.event_worst[PENDING] = math.nan


def _worsen(settings: Any, memory: Any, row: Any, which: int) -> None:
    """Keep value, limit and operating point of the worst row of an excursion."""
    worst = memory.event_worst[which]
    if memory.event_code[which] == RCS_HIGH:
        value, limit = row.rcs, settings.rcs
        if not row.rcs >= settings.rcs or worst >= value:
            return
    else:
        value, limit = row.efficiency, settings.efficiency
        if row.gates & LIGHT_LOAD != 0 or not value < limit or worst <= value:
            return
    memory.event_worst[which], memory.event_limit[which] = value, limit
    memory.event_speed[which], memory.event_load[which] = row.speed, row.axial_load
    memory.event_temperature[which] = row.temperature
    memory.event_direction[which] = row.direction
    memory.event_derived[which] = 1 if row.derived != 0 else 0


SPEED, AXIAL_LOAD, EFFICIENCY, RCS, FILM_RATIO = range(COLUMNS)


def clear_window(memory: Any) -> None:
    """Begin a window if a state has published the last one."""
    if not memory.window_told:
        return
    memory.window_told = False
    for column in range(COLUMNS):
        memory.window_count[column] = 0
        memory.window_low[column] = math.inf
        memory.window_high[column] = -math.inf
        memory.window_total[column] = 0.0


def add_to_window(memory: Any, row: Any) -> None:
    """Add a row with a zone; its efficiency only where that was judged."""
    if row.zone == NO_ZONE:
        return
    _add(memory, SPEED, row.speed)
    _add(memory, AXIAL_LOAD, row.axial_load)
    _add(memory, RCS, row.rcs)
    _add(memory, FILM_RATIO, row.film_ratio)
    if row.gates & LIGHT_LOAD == 0:
        _add(memory, EFFICIENCY, row.efficiency)


def _add(memory: Any, column: int, value: float) -> None:
    memory.window_count[column] += 1
    memory.window_total[column] += value
    if value < memory.window_low[column]:
        memory.window_low[column] = value
    if value > memory.window_high[column]:
        memory.window_high[column] = value


def add_to_totals(memory: Any, row: Any, max_gap: int) -> None:
    """Add the time since the last sample, unless it is longer than `max_gap` [ns]."""
    if memory.since == 0:
        memory.since = row.stamp
    span = row.stamp - memory.moment_stamp
    if memory.moment and memory.moment_speed != 0.0 and 0 < span <= max_gap:
        _add_span(memory, span)
    memory.moment, memory.moment_stamp = True, row.stamp
    memory.moment_speed = 0.0 if row.gates & STANDSTILL != 0 else abs(row.speed)
    power = row.friction_torque * memory.moment_speed if row.validity == VALID else 0.0
    memory.moment_power = power if math.isfinite(power) else 0.0
    memory.moment_regime, memory.moment_zone = row.regime, row.zone


def _add_span(memory: Any, span: int) -> None:
    """Add a time [ns] during which the last sample held."""
    memory.running_time += span
    memory.angle += memory.moment_speed * (span / SECOND)
    memory.energy_lost += memory.moment_power * (span / SECOND)
    if memory.moment_zone == NO_ZONE:
        memory.unjudged_time += span
    else:
        memory.regime_time[memory.moment_regime] += span
        memory.zone_time[memory.moment_zone] += span
