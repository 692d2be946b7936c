# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Memory as the typed values that messages and reports are made of."""

import math
from typing import Any

from ballscrew_monitor.core import inputs
from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source, StampSource, Why
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.judge.inputs import is_fresh, least_lag, SLOW_GAPS
from ballscrew_monitor.judge.records import NOT_KNOWN, RATE_SAMPLES, SHOWN, WHYS
from surrogate.surface import REGIMES

NAN = math.nan

SOURCES = (Source.SPEED, Source.LOAD, Source.TEMPERATURE, Source.TORQUE)
"""Inputs in the order of a state."""
PARTS = {f'{regime.word}_time': ('regime_time', int(regime)) for regime in REGIMES} | {
    f'{zone.name.lower()}_time': ('zone_time', int(zone)) for zone in (Zone.OPTIMAL, Zone.OUTSIDE)
}
"""Times of the totals that are parts of a list in a memory, and their places there."""
TIMES = 'running_time', 'unjudged_time', *PARTS
"""Times of the totals, by the names of the message."""


def total_times(memory: Any) -> dict[str, int]:
    """Return the times of the totals [ns] by the names of the message."""
    whole = {'running_time': memory.running_time, 'unjudged_time': memory.unjudged_time}
    return whole | {
        name: int(getattr(memory, part)[place]) for name, (part, place) in PARTS.items()
    }


def clear_totals(memory: Any) -> None:
    """Set the totals to zero."""
    memory.running_time = memory.unjudged_time = memory.since = 0
    memory.angle = memory.energy_lost = 0.0
    for times in (memory.regime_time, memory.zone_time):
        times[:] = [0] * len(times)


def input_state_of(memory: Any, settings: Any, source: Source, now: int) -> InputState:
    """
    Return the state of an input at `now` [ns] of the clock that arrivals are timed by.

    A sample that arrived exactly the timeout ago is still good.

    """
    if not settings.configured[source]:
        derived = source is Source.LOAD and settings.derives
        return InputState.DERIVED if derived else InputState.NOT_CONFIGURED
    if memory.refusal[source] != NOT_KNOWN:
        return InputState.BAD
    if not memory.known[source]:
        return InputState.MISSING
    return InputState.OK if is_fresh(memory, settings, source, now) else InputState.STALE


def input_status_of(
    memory: Any, settings: Any, source: Source, now: int, field: str, joints: Any = None
) -> InputStatus:
    """
    Return how well an input does at `now` [ns].

    `field` is the path of its number, `joints` are those that other messages name.

    """
    state = input_state_of(memory, settings, source, now)
    if state is InputState.NOT_CONFIGURED:
        return InputStatus(source=source, state=state)
    why = int(memory.refusal[source])
    slow = bool(memory.long_gaps[source] >= SLOW_GAPS)
    lag_known = bool(memory.lags_taken[source])
    known = bool(memory.known[source])
    lag = int(least_lag(memory, source)) if lag_known else 0
    causes = source * WHYS
    newest = max(memory.refused_last[slice(causes, causes + WHYS)])
    taken = int(memory.span_taken[source] + memory.before_taken[source])
    refused = int(memory.span_refused[source] + memory.before_refused[source])
    refusal = ''
    if why != NOT_KNOWN:
        numbers = float(memory.refusal_first[source]), float(memory.refusal_second[source])
        most = float(settings.plausible[source])
        refusal = inputs.refusal_text(source, Why(why), *numbers, most=most, field=field)
    return InputStatus(
        source=source,
        state=state,
        rate=_rate(memory, source),
        stamp_source=StampSource(int(memory.stamp_source[source]) if known else 0),
        age=max(0.0, seconds(now - int(memory.arrival[source]))) if known else NAN,
        received=int(memory.received[source]),
        dropped=int(memory.dropped[source]),
        slow=slow,
        longest_gap=seconds(int(memory.longest_gap[source])) if slow else NAN,
        lag=seconds(lag) if lag_known else NAN,
        lagging=lag_known and lag > settings.max_lag,
        lost=int(memory.lost[source]) if memory.lost_known[source] else None,
        losing=bool(0 <= now - memory.lost_last[source] < SHOWN),
        implausible=int(memory.refused[causes + Why.IMPLAUSIBLE]),
        refusing=()
        if now - newest >= SHOWN
        else tuple(
            cause for cause in Why if 0 <= now - memory.refused_last[causes + cause] < SHOWN
        ),
        refused_share=refused / taken if taken else 0.0,
        why=None if why == NOT_KNOWN else Why(why),
        refusal=refusal,
        joints=joints if memory.others[source] else None,
    )


def _rate(memory: Any, source: Source) -> float:
    taken = int(memory.stamps_taken[source])
    count = min(taken, RATE_SAMPLES)
    if count < 2:
        return NAN
    first, last = (
        int(memory.stamps[source * RATE_SAMPLES + at % RATE_SAMPLES])
        for at in (taken - count, taken - 1)
    )
    return (count - 1) / seconds(last - first) if last > first else NAN


def refused_of(memory: Any) -> dict[Source, dict[Why, int]]:
    """Return how many messages of each input were refused, by why."""
    return {
        source: {
            why: int(memory.refused[source * WHYS + why])
            for why in Why
            if memory.refused[source * WHYS + why]
        }
        for source in SOURCES
    }
