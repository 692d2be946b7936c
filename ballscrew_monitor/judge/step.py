# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The judgement of one axis, event by event: the only place that judges.

A speed sample is judged when it arrives, with the last sample of every other input: no delay is
added. Ticks lie on a fixed grid of stamps and give a row only while the speed is missing or
stale. There is no clock in here, so the same list of events gives the same list of rows, bit for
bit, interpreted as well as compiled. A step of the clock of the node is an event: it moves all
times that have begun, so it is no part of any duration. The arguments are as in `point`;
`positions` is the slope of the positions.

"""

import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import StampSource, Why
from ballscrew_monitor.core.judgement import Level
from ballscrew_monitor.judge.inputs import (
    accept,
    drop,
    forget,
    is_ahead,
    is_lagging,
    least_lag,
    lose,
    rebase,
    refuse,
    slow_period,
    SPEED,
    take_refusal,
)
from ballscrew_monitor.judge.point import NO_DIRECTION, opposing_load, set_answer, set_point
from ballscrew_monitor.judge.records import INPUTS, RATE_SAMPLES, REFUSAL, RUN, STEP, TICK, WHYS
from ballscrew_monitor.judge.slopes import (
    slope_last,
    slope_move,
    slope_of,
    slope_restart,
    slope_shift,
    slope_take,
)
from ballscrew_monitor.judge.zone import (
    ACTIVE,
    add_to_totals,
    add_to_window,
    clear_window,
    end_excursion,
    follow_excursion,
    hold_level,
    is_judged,
    PENDING,
    set_reason,
    set_zone,
    shut_gates,
)
from surrogate.surface import look_up_rest

NOTHING, ROW, STATE = 0, 1, 2
"""What an event gives: nothing, a row, or a row of which a state is published."""
BACKWARD_JUMP = SECOND
"""Longest step back of one input that is no clock set back [ns]."""
MOST_TURNS = 1e9
"""Jump of a position over the position at which it begins again that is no such turn [-]."""
NOT_A_NUMBER, IMPLAUSIBLE, HOLE = int(Why.NOT_A_NUMBER), int(Why.IMPLAUSIBLE), int(Why.HOLE)
HEADER = int(StampSource.HEADER)
NO_LEVEL = int(Level.UNKNOWN)


def step(
    tables: Any, settings: Any, memory: Any, speeds: Any, positions: Any, event: Any, row: Any
) -> int:
    """Take one event; return NOTHING, or that `row` is a ROW or the row of a STATE."""
    if event.kind == STEP:
        _set_clock(memory, speeds, positions, event.arrival - event.stamp)
        return NOTHING
    if event.kind == RUN:
        begin_run(memory, speeds, positions, event.stamp)
        return NOTHING
    if event.kind == TICK:
        if not _is_tick_due(settings, memory, event.stamp):
            return NOTHING
        row.now, row.tick = event.stamp, True
        row.stamp = event.stamp
        if is_lagging(memory, settings, SPEED):
            # The time line of the stamps, which a tick must not leave.
            row.stamp -= least_lag(memory, SPEED)
    else:
        if not _take(settings, memory, speeds, positions, event):
            return NOTHING
        if settings.derives and settings.inertia != 0.0:
            window, gap = settings.acceleration_window, settings.timeout[SPEED]
            slope_take(speeds, window, gap, event.stamp, memory.value[SPEED])
        row.stamp, row.now, row.tick = event.stamp, event.arrival, False
    return _judge(tables, settings, memory, speeds, row)


def step_many(
    tables: Any,
    settings: Any,
    memory: Any,
    speeds: Any,
    positions: Any,
    events: Any,
    rows: Any,
    places: Any,
    memories: Any,
    every: bool,
) -> tuple[int, int, int]:
    """
    Take events while `memories` has room; return the numbers of events, rows and memories.

    `settings`, `memory`, `speeds` and `positions` are arrays of one record. `rows` has room for a
    row of every event, `places` takes the event of each. `memories` takes the memory after `every`
    row of a state, or after those alone that begin or end an excursion.

    """
    count = kept = 0
    for at in range(len(events)):
        if kept == len(memories):
            return at, count, kept
        outcome = step(
            tables, settings[0], memory[0], speeds[0], positions[0], events[at], rows[count]
        )
        if outcome == NOTHING:
            continue
        if outcome == STATE and (every or rows[count].edge != 0):
            memories[kept] = memory[0]
            kept += 1
        places[count] = at
        count += 1
    return len(events), count, kept


def begin_run(memory: Any, speeds: Any, positions: Any, stamp: int) -> None:
    """
    Begin another run of a log at `stamp` [ns], which is judged apart from the one before.

    An excursion ends with the last row; no sample, level, delay or window goes on. Counts and
    totals do.

    """
    end_excursion(memory, memory.stamp)
    memory.level, memory.level_since = NO_LEVEL, stamp
    memory.raising = memory.clearing = memory.pending = False
    memory.moment = memory.published = memory.light = False
    memory.direction, memory.held_load = NO_DIRECTION, math.nan
    memory.window_told = True
    clear_window(memory)
    for source in range(INPUTS):
        forget(memory, source)
    speeds.count = positions.count = 0


def _take(settings: Any, memory: Any, speeds: Any, positions: Any, event: Any) -> bool:
    """Take a sample or a refusal; return True if it is a speed to judge."""
    source = event.source
    lose(memory, source, event.lost, event.arrival)
    if event.kind == REFUSAL:
        take_refusal(memory, event)
        return False
    if not math.isfinite(event.value):
        refuse(memory, source, NOT_A_NUMBER, 0.0, math.nan, event.arrival)
        return False
    # Of a position: plausible or not is the speed that follows from it.
    is_position = source == SPEED and settings.positions
    if not is_position and not _is_plausible(settings, memory, event, event.value):
        return False
    if source == SPEED:
        _follow_clock(memory, speeds, positions, event)
    if memory.known[source] != 0 and event.stamp < memory.sample_stamp[source]:
        if memory.sample_stamp[source] - event.stamp <= BACKWARD_JUMP:
            drop(memory, source)
            return False
        if source == SPEED:
            _jump_back(memory, event.stamp)
        forget(memory, source)
    if source != SPEED:
        accept(memory, settings, event, event.value)
        return False
    if settings.positions:
        return _take_position(settings, memory, positions, event)
    _accept_speed(settings, memory, event, event.value)
    return True


def _set_clock(memory: Any, speeds: Any, positions: Any, step: int) -> None:
    """
    Take a step [ns] of the clock of the node: all is as old as before.

    Arrivals are times of that clock. Whether the stamps follow it, the next speed sample shows.

    """
    memory.clock_step += step
    memory.last_tick += step
    for source in range(INPUTS):
        memory.arrival[source] += step
        memory.lost_last[source] += step
        memory.span_begin[source] += step
        if source != SPEED:
            _move_stamps(memory, source, step)
    for place in range(INPUTS * WHYS):
        memory.refused_last[place] += step
    if memory.shelved_until > 0:
        memory.shelved_until = max(1, memory.shelved_until + step)
    _move(memory, speeds, positions, step)


def _follow_clock(memory: Any, speeds: Any, positions: Any, event: Any) -> None:
    """
    Undo a step of the node's clock that the stamps of the speed, as a sample shows, do not follow.

    They lag by that step more then.

    """
    step, memory.clock_step = memory.clock_step, 0
    if step == 0 or event.stamp_source != HEADER or memory.lags_taken[SPEED] == 0:
        return
    change = event.arrival - event.stamp - least_lag(memory, SPEED)
    if abs(change - step) < abs(change):
        _move(memory, speeds, positions, -step)
        for place in range(SPEED * RATE_SAMPLES, (SPEED + 1) * RATE_SAMPLES):
            memory.lags[place] += step


def _move(memory: Any, speeds: Any, positions: Any, step: int) -> None:
    """Move the times that have begun by a `step` [ns], so that they have lasted as long."""
    _move_times(memory, step)
    memory.raising_start += step
    memory.raising_last += step
    memory.clearing_start += step
    memory.clearing_last += step
    memory.event_start[PENDING] += step
    memory.stamp += step
    memory.last_published += step
    memory.moment_stamp += step
    _move_stamps(memory, SPEED, step)
    slope_move(speeds, step)
    slope_move(positions, step)


def _move_stamps(memory: Any, source: int, step: int) -> None:
    memory.sample_stamp[source] += step
    for place in range(source * RATE_SAMPLES, (source + 1) * RATE_SAMPLES):
        memory.stamps[place] += step


def _accept_speed(settings: Any, memory: Any, event: Any, speed: float) -> None:
    """
    Take a good speed [rad/s]; a leap of its stamp ahead of the time that passed is no time.

    The source has set its clock forward: it lags less behind the arrivals than it did for long.
    The leap is left out of what has begun and still goes on.

    """
    gap = event.stamp - memory.sample_stamp[SPEED]
    known = memory.known[SPEED] != 0 and memory.lags_taken[SPEED] != 0
    if known and gap > BACKWARD_JUMP and event.stamp_source == HEADER:
        leap = min(least_lag(memory, SPEED) - (event.arrival - event.stamp), gap)
        if leap > BACKWARD_JUMP:
            if memory.event_active:
                memory.event_start[ACTIVE] += leap
                memory.event_stamp += leap
            memory.raising = memory.clearing = memory.moment = False
    accept(memory, settings, event, speed)


def _is_plausible(settings: Any, memory: Any, event: Any, value: float) -> bool:
    if abs(value) <= settings.plausible[event.source]:
        return True
    refuse(memory, event.source, IMPLAUSIBLE, value, math.nan, event.arrival)
    return False


def _take_position(settings: Any, memory: Any, positions: Any, event: Any) -> bool:
    """
    Take the speed at the stamp of a position; return True if there is one.

    A position that asks for more than the plausible speed is refused, and so is the first one
    after a hole: no speed is known there. Both begin a new window.

    """
    value, timeout = event.value, settings.timeout[SPEED]
    if positions.count > 0:
        last = slope_last(positions)
        change = value - positions.values[last]
        if settings.wrap != 0.0 and abs(change) <= MOST_TURNS * settings.wrap:
            # The way to the new position is the shorter one.
            turns = settings.wrap * round(change / settings.wrap)
            slope_shift(positions, turns)
            change -= turns
        gap, change = event.stamp - positions.stamps[last], abs(change)
        is_hole = gap > timeout
        length = gap / SECOND
        if event.stamp_source != HEADER:  # a burst of messages is no jump
            gap = max(gap, settings.position_window)
        if is_hole or (gap > 0 and change > settings.plausible[SPEED] * (gap / SECOND)):
            slope_restart(positions, event.stamp, value)
            if is_hole:
                refuse(memory, SPEED, HOLE, length, math.nan, event.arrival)
            else:
                refuse(memory, SPEED, IMPLAUSIBLE, change, gap / SECOND, event.arrival)
            return False
    slope_take(positions, settings.position_window, timeout, event.stamp, value)
    speed = slope_of(positions)
    if math.isnan(speed):
        drop(memory, SPEED)
        return False
    if not _is_plausible(settings, memory, event, speed):
        return False
    _accept_speed(settings, memory, event, speed)
    return True


def _is_tick_due(settings: Any, memory: Any, now: int) -> bool:
    """Take the grid stamp `now` [ns]; return True if the speed is missing or stale there."""
    # Both the clock and the speed: stamps may run ahead of the clock, as far as is allowed.
    if memory.last_tick - now > BACKWARD_JUMP:
        if is_ahead(memory, SPEED, now + BACKWARD_JUMP):
            _jump_back(memory, now)
        rebase(memory, now)
    memory.last_tick = now
    # Samples further ahead than is allowed were taken while the clock stood at zero, and would
    # not go stale for as long.
    limit = now + settings.tick_period + settings.max_future + BACKWARD_JUMP
    for source in range(INPUTS):
        if now != 0 and is_ahead(memory, source, limit):
            if source == SPEED:
                _jump_back(memory, now)
            forget(memory, source)
    timeout = settings.timeout[SPEED]
    return memory.known[SPEED] == 0 or now - memory.arrival[SPEED] > timeout


def _judge(tables: Any, settings: Any, memory: Any, speeds: Any, row: Any) -> int:
    """Judge the instant of a row, hold the level, follow the excursion."""
    set_point(tables, settings, memory, speeds, row)
    set_answer(tables, settings, row)
    shut_gates(settings, memory, row)
    set_zone(settings, row)
    set_reason(row)
    clear_window(memory)
    max_gap = settings.timeout[SPEED]
    if not row.tick:
        if is_judged(row):
            memory.judged += 1
        add_to_totals(memory, row, max_gap)
        add_to_window(memory, row)
    before = memory.level
    hold_level(settings, memory, row, max_gap, slow_period(memory, SPEED))
    memory.stamp = row.stamp
    follow_excursion(settings, memory, row, before)
    row.level, row.level_since = memory.level, memory.level_since
    row.event_id = memory.event_number
    period = settings.publish_period  # the first row in each is published
    due = period == 0 or not memory.published
    due = due or memory.stamp // period != memory.last_published // period
    row.published = row.edge != 0 or memory.level != before or due
    if not row.published:
        return ROW
    look_up_rest(tables, opposing_load(row), row)
    memory.published, memory.last_published, memory.window_told = True, row.stamp, True
    return STATE


def _jump_back(memory: Any, stamp: int) -> None:
    """
    Begin a new time line at `stamp` [ns], which is that of a speed sample or of a tick.

    Samples in its future are forgotten and the filters start over; level, event and totals stand,
    with their times moved so that they have lasted as long as before.

    """
    if memory.known[SPEED] != 0:
        _move_times(memory, stamp - memory.sample_stamp[SPEED])
        memory.raising = memory.clearing = False
    memory.stamp = stamp
    memory.moment = memory.pending = memory.published = False
    memory.direction, memory.light = NO_DIRECTION, False
    for source in range(INPUTS):
        if is_ahead(memory, source, stamp + BACKWARD_JUMP):
            forget(memory, source)


def _move_times(memory: Any, shift: int) -> None:
    """Move the times that have begun by `shift` [ns] with the clock."""
    memory.level_since = max(0, memory.level_since + shift)
    if memory.event_active:
        memory.event_start[ACTIVE] = max(0, memory.event_start[ACTIVE] + shift)
        memory.event_stamp = max(0, memory.event_stamp + shift)
    if memory.since != 0:
        memory.since = max(0, memory.since + shift)
