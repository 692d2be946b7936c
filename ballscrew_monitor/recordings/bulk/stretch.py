# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A stretch of ordered entries of one axis, judged at once from what its monitor remembers.

The rows are what the monitor would tell of; at the end it remembers what it would have. A stretch
stops before an entry of which the monitor itself must judge, such as one after a jump of stamps.

"""

import dataclasses
from typing import Any

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.monitor import BACKWARD_JUMP
from ballscrew_monitor.core.remembered import Remembered
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.recordings.bulk.entries import Entries, Kind
from ballscrew_monitor.recordings.bulk.estimates import Points
from ballscrew_monitor.recordings.bulk.lanes import Lane, make_lane, NEVER
import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.intp]
Times = NDArray[np.int64]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Rows:
    """
    The rows of a stretch: speed samples and the ticks that found no fresh speed.

    `at` are their places among the entries, `stamp` and `now` [ns], `period` that of a slow speed
    [ns].

    """

    at: Places
    tick: NDArray[np.bool_]
    stamp: Times
    now: Times
    period: Times


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Stretch:
    """The inputs over a stretch of `entries` up to `stop`, and its rows."""

    entries: Entries
    stop: int
    lanes: dict[Source, Lane]
    ticks: Places
    rows: Rows


def make_stretch(settings: MonitorSettings, memory: Remembered, entries: Entries) -> Stretch:
    """Return the longest stretch from the first of the entries on; it may be empty."""
    lanes = {
        source: make_lane(entries, tracker, settings.plausible.get(source, np.inf))
        for source, tracker in memory.inputs.items()
    }
    ticks = np.flatnonzero(entries.kind == Kind.TICK)
    speed = lanes[Source.SPEED]
    stale = ticks[~speed.fresh(ticks, entries.stamp[ticks])]
    stop = min(
        [
            len(entries),
            *(int(lane.jumps[0]) for lane in lanes.values() if len(lane.jumps)),
            *_first(ticks, _odd_ticks(settings, memory, lanes, entries, ticks)),
            *([int(stale[0])] if len(stale) and speed.may_lag() else []),
        ]
    )
    lanes = {source: lane.part(0, stop) for source, lane in lanes.items()}
    return Stretch(
        entries=entries,
        stop=stop,
        lanes=lanes,
        ticks=ticks[: np.searchsorted(ticks, stop)],
        rows=_rows(entries, lanes[Source.SPEED], stale[: np.searchsorted(stale, stop)]),
    )


def _first(places: Places, which: NDArray[np.bool_]) -> list[int]:
    return [int(places[which.argmax()])] if which.any() else []


def _odd_ticks(
    settings: MonitorSettings,
    memory: Remembered,
    lanes: dict[Source, Lane],
    entries: Entries,
    ticks: Places,
) -> NDArray[np.bool_]:
    """Tell which ticks find the clock set back, or samples of its future."""
    now = entries.stamp[ticks]
    before = np.concatenate([[memory.last_tick], now])[:-1]
    ahead = now + settings.tick_period + settings.max_future + BACKWARD_JUMP
    odd: NDArray[np.bool_] = before - now > BACKWARD_JUMP
    for lane in lanes.values():
        stamps = lane.stamps(ticks)
        odd |= (now != 0) & (stamps != NEVER) & (stamps > ahead)
    return odd


def _rows(entries: Entries, speed: Lane, stale: Places) -> Rows:
    at = np.concatenate([speed.good, stale])
    period = np.concatenate([speed.slow_periods(), np.zeros(len(stale), dtype=np.int64)])
    order = np.argsort(at, kind='stable')
    at = at[order]
    return Rows(
        at=at,
        tick=entries.kind[at] == Kind.TICK,
        stamp=entries.stamp[at],
        now=entries.arrival[at],
        period=period[order],
    )


def points_of(settings: MonitorSettings, memory: Remembered, stretch: Stretch) -> Points:
    """Return the operating points of the rows."""
    rows = stretch.rows
    columns: dict[str, Any] = {}
    for source, name in (
        (Source.SPEED, 'speed'),
        (Source.LOAD, 'axial_load'),
        (Source.TEMPERATURE, 'temperature'),
        (Source.TORQUE, 'motor_torque'),
    ):
        value, standing = stretch.lanes[source].values(rows.at, rows.now)
        if source not in settings.timeouts:
            default = source is Source.TEMPERATURE
            value = np.full(len(value), settings.default_temperature if default else np.nan)
            standing[:] = PointSource.DEFAULT if default else PointSource.UNKNOWN
        columns[name], columns[f'{name}_source'] = value, standing
    with np.errstate(invalid='ignore'):
        moving = np.abs(columns['speed']) >= settings.limits.standstill_speed
    direction = _directions(memory.direction, columns['speed'], moving & ~rows.tick)
    return Points(**columns, direction=direction, held=~moving & (direction != Direction.UNKNOWN))


def _directions(
    before: Direction, speed: NDArray[np.float64], moves: NDArray[np.bool_]
) -> NDArray[np.uint8]:
    """Return the last direction of motion at each row."""
    own = np.where(speed > 0.0, Direction.POSITIVE, Direction.NEGATIVE)
    last = np.maximum.accumulate(np.where(moves, np.arange(len(speed)), -1))
    return np.where(last < 0, before, own[last]).astype(np.uint8)
