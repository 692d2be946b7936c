# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The inputs of one axis: the last good sample of each, and how well each does.

Functions of the subset that numba compiles, see `surrogate.surface.compiled`. `memory` is a
`Memory`, `settings` are `Settings`, `event` is an `Event`, `source` the number of an input.

"""

import math
from typing import Any

from ballscrew_monitor.core.inputs import Source, StampSource, Why
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.judge.records import INPUTS, NOT_KNOWN, RATE_SAMPLES, SHOWN, WHYS

TEMPERATURE, LOAD, TORQUE, SPEED = map(int, Source)
UNKNOWN, MEASURED, DEFAULT, HELD, DERIVED = map(int, PointSource)
OTHER_JOINTS = int(Why.OTHER_JOINTS)
HEADER = int(StampSource.HEADER)
SLOW_GAPS = 2
"""Gaps above the timeout in a row from which on an input is slow, not interrupted."""


def lose(memory: Any, source: int, count: int, arrival: int) -> None:
    """Count messages that never arrived before one at `arrival` [ns]."""
    memory.lost_known[source] = 0 if count == NOT_KNOWN else 1
    if count > 0:
        memory.lost[source] += count
        memory.lost_last[source] = arrival


def drop(memory: Any, source: int) -> None:
    """Count a message that is left out, with no harm to the input."""
    memory.received[source] += 1
    memory.dropped[source] += 1


def refuse(memory: Any, source: int, why: int, first: float, second: float, arrival: int) -> None:
    """Count a bad message; the input stays bad until the next good one."""
    drop(memory, source)
    memory.refused[source * WHYS + why] += 1
    memory.refused_last[source * WHYS + why] = arrival
    _count(memory, source, arrival)
    memory.span_refused[source] += 1
    memory.refusal[source] = why
    memory.refusal_first[source] = first
    memory.refusal_second[source] = second


def _count(memory: Any, source: int, arrival: int) -> None:
    """Count a sample or a refusal that arrived at a time [ns] into the span that it lies in."""
    passed = arrival - memory.span_begin[source]
    if passed < 0 or passed >= SHOWN:
        follows = 0 <= passed < 2 * SHOWN
        memory.before_taken[source] = memory.span_taken[source] if follows else 0
        memory.before_refused[source] = memory.span_refused[source] if follows else 0
        memory.span_taken[source] = memory.span_refused[source] = 0
        memory.span_begin[source] = arrival
    memory.span_taken[source] += 1


def take_refusal(memory: Any, event: Any) -> None:
    """Take a message that gave no sample; one about other joints does no harm."""
    source = event.source
    if event.why == OTHER_JOINTS:
        drop(memory, source)
        memory.others[source] += 1
    else:
        refuse(memory, source, event.why, event.first, event.second, event.arrival)


def accept(memory: Any, settings: Any, event: Any, value: float) -> None:
    """Take a good sample, whose value may be a speed that follows from positions."""
    source = event.source
    memory.received[source] += 1
    _count(memory, source, event.arrival)
    memory.refusal[source] = NOT_KNOWN
    gap = event.stamp - memory.sample_stamp[source] if memory.known[source] else 0
    memory.last_gap[source] = gap
    if gap > settings.timeout[source]:
        memory.long_gaps[source] += 1
        memory.longest_gap[source] = max(memory.longest_gap[source], gap)
    else:
        memory.long_gaps[source] = 0
        memory.longest_gap[source] = 0
    memory.others[source] = 0
    memory.known[source] = 1
    memory.value[source] = value
    memory.sample_stamp[source] = event.stamp
    memory.arrival[source] = event.arrival
    memory.stamp_source[source] = event.stamp_source
    _remember(memory.stamps, memory.stamps_taken, source, event.stamp)
    if event.stamp_source == HEADER and event.arrival != 0:
        _remember(memory.lags, memory.lags_taken, source, event.arrival - event.stamp)


def _remember(ring: Any, taken: Any, source: int, number: int) -> None:
    """Put a number into the ring of an input."""
    ring[source * RATE_SAMPLES + taken[source] % RATE_SAMPLES] = number
    taken[source] += 1


def forget(memory: Any, source: int) -> None:
    """Forget the samples, not the counts: they belong to another time line."""
    memory.known[source] = 0
    memory.refusal[source] = NOT_KNOWN
    memory.stamps_taken[source] = 0
    memory.lags_taken[source] = 0
    memory.long_gaps[source] = 0
    memory.others[source] = 0


def is_ahead(memory: Any, source: int, stamp: int) -> bool:
    """Return True if the last sample is newer than `stamp` [ns]."""
    return memory.known[source] != 0 and memory.sample_stamp[source] > stamp


def rebase(memory: Any, now: int) -> None:
    """Let what arrived later than `now` [ns] have arrived now: the clock was set back."""
    for source in range(INPUTS):
        memory.arrival[source] = min(memory.arrival[source], now)


def slow_period(memory: Any, source: int) -> int:
    """Return the last period [ns] of a slow input, 0 for any other."""
    return memory.last_gap[source] if memory.long_gaps[source] >= SLOW_GAPS else 0


def least_lag(memory: Any, source: int) -> int:
    """Return the least of the last lags of stamps behind arrivals [ns]; one must be known."""
    first = source * RATE_SAMPLES
    least = memory.lags[first]
    for place in range(first + 1, first + min(memory.lags_taken[source], RATE_SAMPLES)):
        least = min(least, memory.lags[place])
    return least


def is_lagging(memory: Any, settings: Any, source: int) -> bool:
    """Return True if stamps lie too far behind arrivals."""
    return memory.lags_taken[source] > 0 and least_lag(memory, source) > settings.max_lag


def is_fresh(memory: Any, settings: Any, source: int, now: int) -> bool:
    """Return True if the last message was good and within the timeout before `now` [ns]."""
    return (
        memory.known[source] != 0
        and memory.refusal[source] == NOT_KNOWN
        and now - memory.arrival[source] <= settings.timeout[source]
    )


def value_of(memory: Any, settings: Any, source: int) -> float:
    """Return the last value of an input [SI], NaN if there is none."""
    known = settings.configured[source] != 0 and memory.known[source] != 0
    return memory.value[source] if known else math.nan


def standing_of(memory: Any, settings: Any, source: int, now: int) -> int:
    """Return the PointSource of a value; one that was followed by a bad one is held."""
    if settings.configured[source] == 0:
        return DEFAULT if source == TEMPERATURE else UNKNOWN
    if memory.known[source] == 0:
        return UNKNOWN
    return MEASURED if is_fresh(memory, settings, source, now) else HELD
