# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Public measurements, which are not in the repository: below the folder of `BALLSCREW_RECORDINGS`.

The XJTU data set of ball screws: torque of two screws over 1015 h of ageing. The milling runs of
the SMART testbed, University of Michigan, 2018: a real control at 10 Hz.

"""

from dataclasses import dataclass
import os
from pathlib import Path

from health_parts.machine import Array
import numpy as np


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
