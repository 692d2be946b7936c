# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Public measurements, which are not in the repository: below the folder of `BALLSCREW_RECORDINGS`.

`python bench/health.py --public FOLDER` assesses them as the product assesses logs.

The XJTU data set of ball screws: torque of two screws over 1015 h of ageing. The milling runs of
the SMART testbed, University of Michigan, 2018: a real control at 10 Hz.

"""

from collections.abc import Iterator
from dataclasses import dataclass
import math
import os
from pathlib import Path

from ballscrew_monitor.health.bands import speed_band
from ballscrew_monitor.health.collect import Collector
from ballscrew_monitor.health.detection import Look, looks
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.history import history_of
from ballscrew_monitor.health.records import Cell, LoadSource
from ballscrew_monitor.health.summary import array_of
from health_parts.axis_year import DAY, Log, NEW_YEAR
from health_parts.machine import Array
from health_parts.summaries import rows_of
import numpy as np
from surrogate.surface import shipped_surface, Surface

SCREW_LEAD = 8e-3  # [m] of the aged screws
SPEED = 10.0  # [rad/s] assumed, as none is published; the friction is that of one speed
HOUR = DAY // 24
BASELINE = 7.0  # [d] of the ageing, which went on day and night
MILL_LEAD = 10e-3  # [m] assumed
TORQUE_CONSTANT = 0.1  # [N m/A] assumed


@dataclass(frozen=True, kw_only=True, slots=True)
class Ageing:
    """Friction torque of two screws of lead 8 mm and preload 1500 N, under 1000 N."""

    hours: Array  # [h]
    up: Array  # [N m]
    down: Array  # [N m]


@dataclass(frozen=True, kw_only=True, slots=True)
class Milling:
    """One axis of a milling run; neither lead nor torque constant is published."""

    time: Array  # [s]
    position: Array  # [m]
    speed: Array  # [m/s]
    current: Array  # [A] feedback


def recordings() -> Path | None:
    """Return the folder of the recordings, or None if the environment names none."""
    named = os.environ.get('BALLSCREW_RECORDINGS', '')
    return Path(named) if named and Path(named).is_dir() else None


def read_ageing(folder: Path) -> Ageing:
    """Return `xjtu_torque.csv` of a folder."""
    hours, up, down = np.loadtxt(folder / 'xjtu_torque.csv', delimiter=',', skiprows=1).T
    return Ageing(hours=hours, up=up, down=down)


def read_milling(folder: Path, axis: str = 'X') -> Milling:
    """Return an axis, X or Y, of `cnc_mill/experiment_01.csv` of a folder."""
    path = folder / 'cnc_mill' / 'experiment_01.csv'
    with path.open(encoding='utf-8') as file:
        names = file.readline().strip().split(',')
    wanted = ('ActualPosition', 'ActualVelocity', 'CurrentFeedback')
    columns = [names.index(f'{axis}1_{name}') for name in wanted]
    position, speed, current = np.loadtxt(path, delimiter=',', skiprows=1, usecols=columns).T
    return Milling(
        time=np.arange(len(position)) / 10.0,
        position=1e-3 * position,
        speed=1e-3 * speed,
        current=current,
    )


def ageing_looks(hours: Array, torque: Array) -> list[Look]:
    """Return a look after each row of the ageing of one screw: times [h], torques [N m]."""
    cells = [
        Cell(
            start=NEW_YEAR + round(hour * HOUR),
            first_day=(NEW_YEAR + round(hour * HOUR)) // DAY,
            speed_band=speed_band(SPEED),
            direction=1,
            load_source=int(LoadSource.FREE),
            temperature_measured=True,  # assumed constant, as in a laboratory
            stretches=1,
            duration=60.0,
            speed=SPEED,
            axial_load=0.0,
            temperature=293.0,
            motor_torque=value,
        )
        for hour, value in zip(hours.tolist(), torque.tolist(), strict=True)
    ]
    history = history_of(array_of(cells), SCREW_LEAD)
    assert history is not None
    return list(looks(history, baseline_days=BASELINE))


def steady_share(run: Milling) -> tuple[float, float, int]:
    """Return the time in motion of a milling run [s], that which counts as steady, and speeds."""
    turn = 2.0 * math.pi / MILL_LEAD
    log = Log(
        start=NEW_YEAR,
        time=run.time,
        speed=turn * run.speed,
        torque=TORQUE_CONSTANT * run.current,
        position=run.position,
        table=None,
        load=None,
        temperature=None,
    )
    collector = Collector(Surface.load(shipped_surface()), GatherSettings(always_free=True))
    stretches = [*collector.take_many(rows_of(log)).stretches, *collector.finish().stretches]
    moving = [each for each in stretches if each.speed != 0.0]
    ways = {(speed_band(abs(each.speed)), each.speed > 0.0) for each in moving}
    both = {band for band, way in ways if (band, not way) in ways}
    period = float(run.time[1] - run.time[0])
    motion = period * int((np.abs(log.speed) > 0.05).sum())
    return motion, sum(each.duration for each in moving), len(both)


def print_public(folder: Path) -> None:
    """Print what the product makes of the public measurements below a folder."""
    for line in public_lines(folder):
        print(line)


def public_lines(folder: Path) -> Iterator[str]:
    """Yield the lines of two tables, of Markdown."""
    yield '| screw of the ageing | torque in the end | said in the end | first alarm | then |'
    yield '|---|---|---|---|---|'
    ageing = read_ageing(folder)
    for name, torque in (('first', ageing.up), ('second', ageing.down)):
        seen = ageing_looks(ageing.hours, torque)
        last, alarms = seen[-1], [one.log for one in seen if one.raised]
        first = np.mean(torque[: last.baseline])
        now = np.mean(torque[::-1][: last.now]) / first - 1.0
        interval = (
            f'{100 * last.change:+.0f} % ({100 * last.low:+.0f} to {100 * last.high:+.0f} %)'
        )
        at = f'{ageing.hours[alarms[0]]:.0f} h' if alarms else 'none'
        then = f'{100 * (torque[alarms[0]] / first - 1.0):+.0f} %' if alarms else ''
        yield f'| {name} | {100 * now:+.0f} % | {interval} | {at} | {then} |'
    yield ''
    yield '| axis of the mill | in motion | steady | speeds with both directions |'
    yield '|---|---|---|---|'
    for axis in 'XY':
        motion, steady, speeds = steady_share(read_milling(folder, axis))
        yield f'| {axis} | {motion:.0f} s | {steady:.0f} s | {speeds} |'
