# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Change of the friction by groups of places, and of what the inputs have beside it.

A torque constant, a zero or a gain that drifts leaves its mark on the ratio of the directions and
on the torque over the load, which no friction of a screw does.

"""

import math
from typing import NamedTuple

from ballscrew_monitor.health.detection import Look
from ballscrew_monitor.health.history import effects_of, History
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OWN_SCATTER = 0.006  # least scatter of a group of a log beside that of the log [-]
SIGMAS = 4.5  # standard deviations from which a mark of an input counts
LEAST_OFFSET, LEAST_GAIN = 0.03, 0.04  # least offset over the friction, least change of a gain [-]


class GroupChange(NamedTuple):
    """
    Change of ln(friction) of each group that ran before and now [-], with its standard deviation.

    The deviation is beside that which all groups share. `friction` [N m], `speed` [rad/s] and
    `load` [N] are those of the baseline; `time` weighs the groups [-].

    """

    change: Array
    deviation: Array
    friction: Array
    speed: Array
    load: Array
    time: Array


class Shift(NamedTuple):
    """A change of a number of the inputs with its standard deviation; NaN where not known."""

    value: float = math.nan
    deviation: float = math.nan

    def is_proven(self, least: float) -> bool:
        """Return True if the shift is at least as large, and far beyond its scatter."""
        size = abs(self.value)
        return math.isfinite(size) and size > max(least, SIGMAS * self.deviation)


class Marks(NamedTuple):
    """
    What else has changed since the baseline.

    `offset` is the half sum of the torques of both directions over the friction [-], `gain` the
    logarithm of the torque over the measured load [-], `standstill` the torque at rest over the
    friction [-]; `new_share` [-] is that of places that the baseline lacks. `lost_motion` at
    reversals has grown since the change began.

    """

    offset: Shift
    gain: Shift
    standstill: Shift
    new_share: float
    lost_motion: bool = False


def changes_of(history: History, look: Look) -> GroupChange:
    """Return the change of each group of a history, by the logs of baseline and now of a look."""
    before, now = parts_of(history, look)
    slope = look.slope if history.warm else 0.0
    friction = np.log(np.where(history.weight > 0.0, history.friction, np.nan))
    friction = friction - slope * (history.temperature - np.nanmean(history.temperature))
    seen = np.isfinite(friction)
    both = seen[before].any(axis=0) & seen[now].any(axis=0)
    rest = effects_of(history).rest[:, both]
    free = max(int(np.isfinite(rest).sum() - both.sum() - len(history.start)), 1)
    own = max(math.sqrt(float(np.nansum(rest**2)) / free), OWN_SCATTER)
    counts = [seen[part][:, both].sum(axis=0) for part in (before, now)]

    def mean(values: Array, part: NDArray[np.bool_]) -> Array:
        return np.asarray(np.nanmean(values[part][:, both], axis=0))

    return GroupChange(
        change=mean(friction, now) - mean(friction, before),
        deviation=own * np.sqrt(1.0 / counts[0] + 1.0 / counts[1]),
        friction=np.exp(mean(friction, before)),
        speed=mean(history.speed, before),
        load=mean(history.load, before),
        time=history.weight[now][:, both].sum(axis=0),
    )


def parts_of(history: History, look: Look) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which logs are those of the baseline and of now of a look."""
    time = history.time
    before, now = time <= look.baseline_end, time >= look.now_begin
    return before, now & (time <= look.time)


def marks_of(history: History, look: Look) -> Marks:
    """Return what else has changed by a look."""
    before, now = parts_of(history, look)
    friction = float(np.nanmedian(history.friction[before]))
    free = np.array([group.load == 0 for group in history.groups])
    weight = history.weight * free * np.isfinite(history.offset)
    with np.errstate(invalid='ignore', divide='ignore'):
        offset = (weight * np.nan_to_num(history.offset)).sum(axis=1) / weight.sum(axis=1)
    seen = history.weight > 0.0
    known = seen[before].any(axis=0)
    total = float(history.weight[now].sum())
    return Marks(
        offset=shift(offset / friction, before, now),
        gain=shift(np.log(np.maximum(history.gain, 1e-3)), before, now),
        standstill=shift(history.standstill / friction, before, now),
        new_share=float(history.weight[now][:, ~known].sum()) / total if total else 0.0,
    )


def shift(values: Array, before: NDArray[np.bool_], now: NDArray[np.bool_]) -> Shift:
    """Return the change of the mean of logs now against those before, by their scatter."""
    first, last = (part[np.isfinite(part)] for part in (values[before], values[now]))
    if len(first) < 3 or len(last) < 2:
        return Shift()
    spread = math.sqrt(float(np.var(first, ddof=1) + np.var(last, ddof=1)) / 2.0 + 0.005**2)
    deviation = spread * math.sqrt(1.0 / len(first) + 1.0 / len(last))
    return Shift(float(last.mean() - first.mean()), deviation)
