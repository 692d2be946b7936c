# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Generate twelve monthly logs of a feed axis that loses its preload, or gets another oil.

The screw is iso3408_40x10 in ISO VG 68. A month has one log of 14 min at 20 Hz: speed, load, oil
and motor torque of the same programme, with the oil of the season; a short plan has twenty logs of
4 min at 10 Hz, one in two weeks. The preload falls in a straight line from that of the datasheet
to 40 % of it; or the axis runs in ISO VG 32 from the sixth log on. The torque is that of the
closed form at this preload and in this oil, never that of a surface, with a wiper that the model
does not know, ripple and noise. The bytes are the same every time.

"""

import argparse
from collections.abc import Iterator
import dataclasses
import functools
import math
from pathlib import Path
import sys

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.log_facts import PREFIX
from lubrication_scenarios import TORQUE_PARAMETERS
from nominal_cycle import Array, FINE_STEP, LEAD, Motion, Phase, simulate
import numpy as np
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
from scenario import nested
from scipy.interpolate import RegularGridInterpolator
from surrogate.formulas.torque import driving_torque
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.units import ZERO_CELSIUS
import yaml

SCREW, OIL, OTHER_OIL = 'iso3408_40x10', 'iso_vg_68', 'iso_vg_32'
DAY = 86_400 * SECOND
YEAR = 360 * DAY
"""Time of all seasons [ns]."""
LAST_PRELOAD = 0.4
"""Preload of the last month over that of the first [-]."""
CHANGED = 5
"""Number of the first log in the other oil, the first of all is 0."""
OIL_PERIOD = 1.0
"""Time between samples of the oil [s]."""
WIPER, SEAL, SEAL_SPEED = 0.04, 0.02, 5.0
"""Torque of the wipers [N m], what they add near standstill, and where it fades [rad/s]."""
INERTIA = 0.002
"""Moment of inertia of the screw [kg m2]."""
RIPPLE, NOISE = 0.02, 0.01
"""Ripple of the friction once a revolution [-], standard deviation of a torque sample [N m]."""
MEAN_OIL, SEASON, WARMING, WARM_TIME = 27.0, 6.0, 9.0, 300.0
"""Oil at the begin [degC], swing over the year and rise in a log [K], time of the rise [s]."""
SLOWEST = 0.05
SPEED_NODES = np.linspace(0.0, math.asinh(240.0 / SLOWEST), 181)
LOAD_NODES, OIL_NODES = np.linspace(0.0, 1800.0, 5), np.linspace(20.0, 44.0, 7)
"""Nodes of the friction of a month: arsinh of the speed over the slowest [-], [N], [degC]."""
SEED = 40


def _to_and_fro(speed: float, duration: float, cut: float = 0.0, back: float = 0.0):
    """Yield a pass at a speed [rev/min] for a duration [s] under a cut [N], and one back."""
    yield Phase(name='pass', duration=duration, speed=speed, cut=cut)
    yield Phase(name='turn', duration=0.4)
    yield Phase(name='pass', duration=duration, speed=-speed, cut=back)
    yield Phase(name='turn', duration=0.4)


def _parts(cuts: tuple[float, ...]) -> Iterator[Phase]:
    """Yield a workpiece for each of some cuts [N]."""
    for cut in cuts:
        yield from _part(cut)


def _part(cut: float) -> Iterator[Phase]:
    """Yield one workpiece under a cut [N], about two minutes."""
    yield from _to_and_fro(2000.0, 1.9)
    yield from _to_and_fro(50.0, 10.0, 0.8 * cut)  # rough cut at 0.5 m/min, idle back
    yield from _to_and_fro(100.0, 9.0, cut, 0.7 * cut)
    yield from _to_and_fro(1500.0, 2.2)
    yield from _to_and_fro(300.0, 6.0, 0.6 * cut)
    yield from _to_and_fro(20.0, 7.0)  # touch probe
    yield from _to_and_fro(180.0, 8.0, 0.3 * cut, 0.3 * cut)
    yield from _to_and_fro(2000.0, 1.9)
    yield from _to_and_fro(600.0, 3.5)
    yield Phase(name='change of the workpiece', duration=12.0)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """
    Number of `logs`, and the time `apart` [ns] from one to the next.

    Each has a workpiece for each of the `cuts` [N], and a sample of speed, load and torque each
    `period` [s].

    """

    logs: int = 12
    apart: int = 30 * DAY
    cuts: tuple[float, ...] = (600.0, 1500.0, 900.0, 1200.0, 600.0, 1500.0, 900.0)
    period: float = 0.05


MONTHLY = Plan()
SHORT = Plan(logs=20, apart=14 * DAY, cuts=(600.0, 1500.0), period=0.1)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Month:
    """A log by its number, the first is 0: preload over that of the datasheet [-], oil."""

    number: int
    preload: float = 1.0
    oil: str = OIL
    plan: Plan = MONTHLY

    @property
    def begin(self) -> int:
        """Stamp of the begin of its log [ns]."""
        return BEGIN + self.number * self.plan.apart


def months(cause: str, plan: Plan = MONTHLY) -> list[Month]:
    """Return the logs of a cause, `preload` or `oil`."""
    numbers = range(plan.logs)
    if cause == 'oil':
        oils = [OTHER_OIL if number >= CHANGED else OIL for number in numbers]
        return [Month(number=number, oil=oils[number], plan=plan) for number in numbers]
    loss = (1.0 - LAST_PRELOAD) / (plan.logs - 1)
    return [Month(number=number, preload=1.0 - number * loss, plan=plan) for number in numbers]


@functools.cache
def programme(plan: Plan) -> Motion:
    """Return the motion that is the same in all logs."""
    drives_on = Phase(name='drives on', duration=2.0)
    return simulate((drives_on, *_to_and_fro(300.0, 2.0), *_parts(plan.cuts)))


def motion_of(month: Month) -> Motion:
    """Return the programme with the oil of a month."""
    motion = programme(month.plan)
    season = -SEASON * math.cos(2 * math.pi * (month.begin - BEGIN) / YEAR)
    warmed = 1.0 - np.exp(-motion.time / WARM_TIME)
    return dataclasses.replace(motion, oil=MEAN_OIL + season + WARMING * warmed)


def friction(month: Month, speed: Array, load: Array, oil: Array) -> Array:
    """
    Return the friction torque [N m] of the screw in a month by the closed form.

    |w| [rad/s], |load| [N], oil [degC]; solved at nodes, cubic between them.

    """
    between = _frictions(month.preload, month.oil)
    return np.asarray(between(np.stack([np.arcsinh(speed / SLOWEST), load, oil], axis=-1)))


@functools.cache
def _frictions(preload: float, oil: str) -> RegularGridInterpolator:
    """Solve at the nodes, with raceways that have run in under the preload of the datasheet."""
    screw = load_screw(SCREW)
    loosened = dataclasses.replace(screw, preload=preload * screw.preload)
    solved = closed_form.solve(
        Contacts.of(loosened).with_law(Contacts.of(screw).law),
        load_lubricant(oil),
        np.maximum(SLOWEST * np.sinh(SPEED_NODES), SLOWEST)[:, None, None],
        LOAD_NODES[None, :, None],
        OIL_NODES[None, None, :] + ZERO_CELSIUS,
    )
    axes = SPEED_NODES, LOAD_NODES, OIL_NODES
    return RegularGridInterpolator(axes, solved.friction_torque, method='cubic')


def torque_of(month: Month, motion: Motion) -> Array:
    """Return the motor torque at the screw [N m, machine frame], without ripple and noise."""
    speed, along = np.abs(motion.speed), np.tanh(motion.speed / 0.1)
    drag = friction(month, speed, np.abs(motion.load), motion.oil)
    drag += WIPER + SEAL * np.exp(-speed / SEAL_SPEED)
    acceleration = np.gradient(motion.speed, motion.time)
    return driving_torque(along * drag, -motion.load, LEAD) + INERTIA * acceleration


def samples_of(motion: Motion, period: float = MONTHLY.period) -> Motion:
    """Return the motion at the times of its samples, each `period` [s]."""
    step = round(period / FINE_STEP)
    fields = dataclasses.asdict(motion).items()
    return Motion(**{name: values[step::step] for name, values in fields})


def records_of(month: Month, *, noise: bool = True) -> list[Record]:
    """Return every message of a month in the order of log time."""
    random, fine = np.random.Generator(np.random.PCG64([SEED, month.number])), motion_of(month)
    motion = samples_of(fine, month.plan.period)
    torque = torque_of(month, motion)
    oil = motion.oil
    load = motion.load
    if noise:
        drag = torque - driving_torque(0.0, -load, LEAD)
        torque = torque + RIPPLE * drag * np.sin(motion.angle)
        torque += random.normal(0.0, NOISE, torque.size)
        load = load + random.normal(0.0, 4.0, load.size)
        oil = np.round(oil + random.normal(0.0, 0.05, oil.size), 1)
    made = list(_messages(month, motion, torque, load, oil))
    return sorted(made, key=lambda record: (record.log_time, record.topic))


def _messages(
    month: Month, motion: Motion, torque: Array, load: Array, oil: Array
) -> Iterator[Record]:
    """Yield the messages of a month; the oil comes more slowly than the rest."""
    slower = round(OIL_PERIOD / month.plan.period)
    columns = motion.time, motion.angle, motion.speed, torque, load, oil
    for number, (time, angle, speed, effort, force, warm) in enumerate(
        zip(*(column.tolist() for column in columns), strict=True)
    ):
        stamp = month.begin + round(time * SECOND)
        yield _record(JOINT_STATES.name, stamp, 400_000, joint_state(stamp, angle, speed, effort))
        yield _record(AXIAL_LOAD.name, stamp, 200_000, wrench(stamp, force))
        if number % slower == 0:
            yield _record(OIL_TEMPERATURE.name, stamp, 100_000, temperature(stamp, warm))


def _record(topic: str, stamp: int, delay: int, data: bytes) -> Record:
    return Record(topic=topic, stamp=stamp, log_time=stamp + delay, data=data)


def parameters_text(surface: str = '') -> str:
    """Return the parameters of the node to judge the logs with, by the shipped surface if none."""
    values = {
        'axes': ['x'],
        'x.surface': surface,
        'x.screw': SCREW,
        'x.oil': OIL,
        'x.publish_period': 0.1,
        'x.temperature.topic': 'oil_temperature',
        **TORQUE_PARAMETERS,
    }
    content = {'/**/ballscrew_monitor': {'ros__parameters': nested(values)}}
    return yaml.safe_dump(content, sort_keys=False)


def generate(
    directory: Path, cause: str = 'preload', plan: Plan = MONTHLY, surface: str = ''
) -> Iterator[Path]:
    """Write a bag for each log, with the parameters in its metadata; yield their paths."""
    texts = {f'{PREFIX}parameters': parameters_text(surface)}
    for month in months(cause, plan):
        path = directory / f'month_{month.number + 1:02}'
        write_bag(path, records_of(month), texts)
        yield path


def main(arguments: list[str] | None = None) -> int:
    """Generate the logs from the command line."""
    parser = argparse.ArgumentParser(description='Generate twelve monthly logs of a feed axis.')
    parser.add_argument(
        '--out',
        type=Path,
        default=Path(__file__).with_name('monthly_logs'),
        help='directory in which each month gets its bag (default: %(default)s)',
    )
    parser.add_argument(
        '--cause',
        choices=['preload', 'oil'],
        default='preload',
        help='what changes: preload to 40 %%, or the oil to ISO VG 32 (default: %(default)s)',
    )
    parser.add_argument(
        '--short', action='store_true', help='twenty logs of 4 min at 10 Hz, one in two weeks'
    )
    parser.add_argument(
        '--surface', type=Path, help='file to judge with (default: the shipped one of the screw)'
    )
    args = parser.parse_args(arguments)
    plan = SHORT if args.short else MONTHLY
    surface = '' if args.surface is None else str(args.surface.resolve())
    for path in generate(args.out, args.cause, plan, surface):
        print(path)
    return 0


if __name__ == '__main__':
    sys.exit(main())
