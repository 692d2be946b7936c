# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Programmes of an axis: moves with a trapezoid of speed, some under a process force."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from health_parts.machine import Array, Machine, PER_MINUTE
import numpy as np

DWELL = 0.6  # [s] between moves
HOLD = 6.0  # [s] at most at a speed


@dataclass(frozen=True, kw_only=True, slots=True)
class Move:
    """A move there and back at a speed, with a process force that opposes the way there."""

    speed: float  # [rad/s]
    force: float = 0.0  # [N]


@dataclass(frozen=True, kw_only=True, slots=True)
class Motion:
    """Motion on the samples of a log."""

    speed: Array  # [rad/s]
    acceleration: Array  # [rad/s2]
    position: Array  # [m]
    force: Array  # [N] of the process, towards positive


def feed_passes(rng: np.random.Generator) -> tuple[Move, ...]:
    """Return a reference programme: free runs at six speeds from 40 rev/min to a rapid."""
    fastest = rng.uniform(1000.0, 2500.0)
    return tuple(Move(speed=turns * PER_MINUTE) for turns in np.geomspace(40.0, fastest, 6))


def cutting(rng: np.random.Generator, machine: Machine) -> tuple[Move, ...]:
    """Return a programme of work: cuts at three feeds, approaches and rapids without force."""
    fastest = rng.uniform(1000.0, 2500.0)
    feeds = fastest * rng.uniform(0.03, 0.3, 3)
    forces = machine.preload * rng.uniform(0.4, 1.5, 3)
    free = [Move(speed=share * fastest * PER_MINUTE) for share in (0.05, 0.2, 1.0)]
    cuts = [Move(speed=feed * PER_MINUTE, force=force) for feed, force in zip(feeds, forces)]
    return tuple(move for pair in zip(free, cuts) for move in pair)


def varied(moves: Sequence[Move], rng: np.random.Generator) -> tuple[Move, ...]:
    """Return the moves of another workpiece: in another order, with forces 20 % about theirs."""
    return tuple(
        Move(speed=moves[k].speed, force=moves[k].force * rng.uniform(0.8, 1.2))
        for k in rng.permutation(len(moves))
    )


def motion(moves: Sequence[Move], machine: Machine, time: Array, *, rate: float = 1.5) -> Motion:
    """
    Return the moves, repeated over the samples' times [s] from the left end of the stroke.

    The table accelerates with `rate` [m/s2].

    """
    pitch = machine.size.lead / (2.0 * math.pi)  # [m/rad]
    spans, speeds, forces = [], [], []
    for move in moves:
        ramp = move.speed * pitch / rate
        hold = min(HOLD, 0.9 * machine.stroke / (move.speed * pitch) - ramp)
        if hold < 0.0:
            ramp, hold = math.sqrt(0.9 * machine.stroke / rate), 0.0
        peak = min(move.speed, ramp * rate / pitch)
        for way, force in ((1.0, -move.force), (-1.0, 0.0)):
            spans += [DWELL, ramp, hold, ramp]
            speeds += [0.0, way * peak, way * peak, 0.0]  # at the end of each span
            forces += [0.0, 0.0, force, 0.0]
    rounds = int(time[-1] / sum(spans)) + 1
    span = np.tile(spans, rounds)
    ends = np.cumsum(span)
    last = np.tile(speeds, rounds)
    first = np.concatenate(([0.0], last[:-1]))
    slope = np.divide(last - first, span, out=np.zeros_like(span), where=span > 0.0)
    travelled = np.concatenate(([0.0], np.cumsum(0.5 * (first + last) * span)[:-1]))
    k = np.minimum(np.searchsorted(ends, time, side='right'), len(ends) - 1)
    since = time - (ends - span)[k]
    return Motion(
        speed=first[k] + slope[k] * since,
        acceleration=slope[k],
        position=pitch * (travelled[k] + first[k] * since + 0.5 * slope[k] * since**2),
        force=np.tile(forces, rounds)[k],
    )
