# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Generate the bag of a nominal machine cycle: 60 s of one milling machine axis.

A table of 200 kg on the nominal screw (lead 10 mm), from cold to warm oil: homing, rapids, a
slow feed, a facing cut with climb return, light finishing, a deep cut near the unloading load
that ends creeping, a dwell, warm-up by rapid reversals, the slow feed again and fast cuts. A
warm-up takes the better part of an hour; here the oil heats up within the cycle. The bytes are
the same every time.

"""

import argparse
from collections.abc import Sequence
import dataclasses
import math
from pathlib import Path
import sys

from ballscrew_monitor.recordings.bag_writer import Topic
import numpy as np
from numpy.typing import NDArray
from recording import (
    AXIAL_LOAD,
    BEGIN,
    joint_state,
    JOINT_STATES,
    OIL_TEMPERATURE,
    Record,
    temperature,
    wrench,
    write_bag,
)

Array = NDArray[np.float64]

LEAD = 0.010  # [m]
TABLE_MASS = 200.0  # [kg]
GUIDE_FRICTION = 90.0  # [N] way covers and wipers
GUIDE_DAMPING = 180.0  # [N s/m]
ACCELERATION = 2.5  # [m/s2]
JERK_TIME = 0.04  # [s] acceleration is smoothed over this time
ENGAGEMENT_TIME = 0.12  # [s] a cutter enters and leaves the work over this time
FINE_STEP = 0.001  # [s] of the simulation
PERIOD = 0.010  # [s] of speed and load samples
LOAD_PHASE = 0.004  # [s] load samples come before speed samples by this time
COUNTS = 2**17  # encoder counts per revolution
SPEED_WINDOW = 0.001  # [s] over which the drive counts to get a speed
SEED = 2026


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Phase:
    """
    A stretch of the cycle.

    Duration [s]; commanded speed [rev/min]; cutting force that opposes the motion [N], negative in
    climb milling, when the cut pulls the table along; tooth-passing frequency [Hz].

    """

    name: str
    duration: float
    speed: float = 0.0
    cut: float = 0.0
    tooth: float = 23.0


def _reversals(number: int) -> tuple[Phase, ...]:
    return tuple(
        Phase(name='warm-up', duration=1.45, speed=1900.0 * (-1) ** turn) for turn in range(number)
    )


CYCLE = (
    Phase(name='drives on', duration=1.7),
    Phase(name='homing', duration=2.0, speed=-500.0),
    Phase(name='homing', duration=1.3, speed=450.0),
    Phase(name='homing', duration=1.7, speed=-400.0),
    Phase(name='at home', duration=0.8),
    Phase(name='rapid', duration=1.6, speed=2000.0),
    Phase(name='at work', duration=0.3),
    Phase(name='rapid', duration=1.6, speed=-2000.0),
    Phase(name='at work', duration=0.4),
    Phase(name='slow feed', duration=3.0, speed=-250.0, cut=1500.0, tooth=11.0),
    Phase(name='at work', duration=0.3),
    Phase(name='facing', duration=2.4, speed=900.0, cut=1150.0, tooth=27.0),
    Phase(name='reversal', duration=0.3),
    Phase(name='climb return', duration=2.4, speed=-900.0, cut=-1250.0, tooth=27.0),
    Phase(name='reversal', duration=0.3),
    Phase(name='finishing', duration=1.9, speed=1800.0, cut=330.0, tooth=41.0),
    Phase(name='reversal', duration=0.3),
    Phase(name='finishing', duration=1.9, speed=-1800.0, cut=330.0, tooth=41.0),
    Phase(name='at work', duration=0.4),
    Phase(name='rapid', duration=1.6, speed=2000.0),
    Phase(name='at work', duration=0.3),
    Phase(name='rapid', duration=1.6, speed=-2000.0),
    Phase(name='at work', duration=0.8),
    Phase(name='deep cut', duration=2.8, speed=900.0, cut=2750.0, tooth=17.0),
    Phase(name='deep cut, creeping', duration=3.8, speed=100.0, cut=2850.0, tooth=13.0),
    Phase(name='dwell', duration=3.75),
    *_reversals(5),
    Phase(name='at work', duration=0.8),
    Phase(name='slow feed, warm', duration=3.8, speed=-250.0, cut=1500.0, tooth=11.0),
    Phase(name='reversal', duration=0.4),
    Phase(name='climb return, fast', duration=1.7, speed=-2050.0, cut=-1700.0, tooth=37.0),
    Phase(name='reversal', duration=0.3),
    Phase(name='facing, fast', duration=1.7, speed=2050.0, cut=1500.0, tooth=37.0),
    Phase(name='at work', duration=0.8),
    Phase(name='park', duration=0.35, speed=-9.0),
    Phase(name='parked', duration=3.65),
)


def starts(phases: Sequence[Phase] = CYCLE) -> tuple[tuple[float, Phase], ...]:
    """Return every phase with its begin [s]."""
    times = np.cumsum([0.0] + [phase.duration for phase in phases])
    return tuple(zip(times.tolist(), phases))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Motion:
    """Times [s], screw angle [rad] and speed [rad/s], load on the nut [N] and oil [degC]."""

    time: Array
    angle: Array
    speed: Array
    load: Array
    oil: Array


def simulate(phases: Sequence[Phase] = CYCLE) -> Motion:
    """Return the phases without sensors, on a fine grid of times."""
    time = np.arange(0.0, sum(phase.duration for phase in phases), FINE_STEP)
    number = np.searchsorted([begin for begin, _ in starts(phases)], time, side='right') - 1
    target = np.array([phase.speed for phase in phases])[number] / 60.0 * LEAD
    velocity = _smooth(_limit_slope(target, ACCELERATION * FINE_STEP), JERK_TIME)
    acceleration = np.gradient(velocity, FINE_STEP)
    along = np.tanh(velocity / 2e-4)  # direction of motion
    friction = along * GUIDE_FRICTION + GUIDE_DAMPING * velocity
    cut = along * _cutting_force(phases, time, number, velocity)
    load = -TABLE_MASS * acceleration - friction - cut
    angle = np.cumsum(velocity) * FINE_STEP * 2 * math.pi / LEAD
    return Motion(
        time=time, angle=angle, speed=velocity * 2 * math.pi / LEAD, load=load, oil=_oil(time)
    )


def _cutting_force(
    phases: Sequence[Phase], time: Array, number: NDArray[np.int64], velocity: Array
) -> Array:
    """Return the force along the feed [N]: engagement, tooth passing and spindle runout."""
    level = np.array([phase.cut for phase in phases])[number]
    tooth = np.array([phase.tooth for phase in phases])[number]
    moving = (
        np.abs(velocity)
        > 0.5 * np.abs(np.array([phase.speed for phase in phases])[number]) / 60.0 * LEAD
    )
    engaged = _smooth(np.where(moving, level, 0.0), ENGAGEMENT_TIME)
    ripple = 0.05 * np.sin(2 * math.pi * tooth * time) ** 2 + 0.02 * np.sin(
        2 * math.pi * tooth / 4 * time
    )
    return engaged * (0.98 + ripple)


def _oil(time: Array) -> Array:
    """Return the oil temperature [degC]: 25 to 45 along a smooth step, slow at both ends."""
    part = np.clip((time - 6.0) / 44.0, 0.0, 1.0)
    return 25.0 + 20.0 * part * part * (3.0 - 2.0 * part)


def _limit_slope(target: Array, step: float) -> Array:
    """Follow `target` by at most `step` per sample."""
    followed = np.empty_like(target)
    here = 0.0
    for index, goal in enumerate(target.tolist()):
        here += min(max(goal - here, -step), step)
        followed[index] = here
    return followed


def _smooth(values: Array, time: float) -> Array:
    """Return the mean over the last `time` [s]."""
    width = round(time / FINE_STEP)
    padded = np.concatenate([np.full(width, values[0]), values])
    sums = np.cumsum(padded)
    return (sums[width:] - sums[:-width]) / width


def records() -> list[Record]:
    """Return every message of the cycle in the order of log time."""
    motion, random = simulate(), np.random.Generator(np.random.PCG64(SEED))
    made = _joint_records(motion, random) + _load_records(motion, random)
    made += _oil_records(motion, random)
    return sorted(made, key=lambda record: (record.log_time, record.topic))


def _joint_records(motion: Motion, random: np.random.Generator) -> list[Record]:
    """Measure by encoder: angle in whole counts, speed from the counts of one drive cycle."""
    time = np.arange(PERIOD, motion.time[-1], PERIOD)
    count = 2 * math.pi / COUNTS
    # Cogging and the servo loop: a small share of the speed and a little at rest.
    wobble = random.normal(0.0, 0.002 + 0.0008 * np.abs(_at(motion, 'speed', time)))
    speed = _at(motion, 'speed', time) + wobble
    speed = np.round(speed * SPEED_WINDOW / count) * count / SPEED_WINDOW
    angle = np.round(_at(motion, 'angle', time) / count) * count
    return [
        _record(JOINT_STATES, at, random, joint_state, position, velocity)
        for at, position, velocity in zip(time.tolist(), angle.tolist(), speed.tolist())
    ]


def _load_records(motion: Motion, random: np.random.Generator) -> list[Record]:
    """Measure by strain gauges at the nut: 4 N of noise, steps of 0.5 N."""
    time = np.arange(PERIOD, motion.time[-1], PERIOD) - LOAD_PHASE
    load = _at(motion, 'load', time) + random.normal(0.0, 4.0, time.size)
    load = np.round(load / 0.5) * 0.5
    return [
        _record(AXIAL_LOAD, at, random, wrench, force)
        for at, force in zip(time.tolist(), load.tolist())
    ]


def _oil_records(motion: Motion, random: np.random.Generator) -> list[Record]:
    """Measure the oil in its return line: 0.05 degC of noise, steps of 0.1 degC."""
    time = np.arange(0.0, motion.time[-1], 1.0)
    oil = np.round(_at(motion, 'oil', time) + random.normal(0.0, 0.05, time.size), 1)
    return [
        _record(OIL_TEMPERATURE, at, random, temperature, degrees)
        for at, degrees in zip(time.tolist(), oil.tolist())
    ]


def _at(motion: Motion, name: str, time: Array) -> Array:
    return np.interp(time, motion.time, getattr(motion, name))


def _record(topic: Topic, time: float, random: np.random.Generator, encode, *values) -> Record:
    """Return a message stamped `time` [s] that arrives a fraction of a millisecond later."""
    stamp = BEGIN + round(time * 1e9)
    delay = round(random.uniform(2e-4, 6e-4) * 1e9)
    return Record(
        topic=topic.name, stamp=stamp, log_time=stamp + delay, data=encode(stamp, *values)
    )


def generate(directory: Path) -> None:
    """Write the bag to `directory`, which appears, or is replaced, only when it is complete."""
    write_bag(directory, records())


def main(arguments: list[str] | None = None) -> int:
    """Generate the bag from the command line."""
    parser = argparse.ArgumentParser(description='Generate the nominal machine cycle as a bag.')
    parser.add_argument(
        '--out',
        type=Path,
        default=Path(__file__).with_name('nominal_cycle'),
        help='directory of the bag (default: %(default)s)',
    )
    directory = parser.parse_args(arguments).out
    generate(directory)
    print(f'{directory}: {sum(phase.duration for phase in CYCLE):.1f} s')
    return 0


if __name__ == '__main__':
    sys.exit(main())
