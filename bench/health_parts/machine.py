# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The friction of one screw off its nominal state, solved once on a grid, and the product's surfaces.

Every state is solved by the closed form itself; between its nodes the logarithm of the friction is
interpolated by cubics. The product sees the surfaces of the states of its preload alone.

"""

import dataclasses
import enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator
from surrogate.builder.closed_form import build_closed_form, SurfaceSettings
from surrogate.parameters import load_lubricant, load_screw
from surrogate.progress import Progress
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.surface import Surface
from surrogate.units import ZERO_CELSIUS

Array = NDArray[np.float64]
SCREW, OIL = 'iso3408_40x10', 'iso_vg_68'
COMPANIONS = (1.0, 0.8, 0.6, 0.4)
"""Shares of the preload of which the product has a surface [-]."""
SLOWEST = 0.3
SPEEDS = np.geomspace(SLOWEST, 228.0, 61)
LOADS = np.linspace(0.0, 2000.0, 5)
HEATS = np.linspace(8.0, 56.0, 9) + ZERO_CELSIUS
"""Nodes: |w| [rad/s], |load| [N], temperature at the contact [K]."""
STATED = SurfaceSettings(
    speed_range=(SLOWEST, 228.0),
    load_range=(-2100.0, 2100.0),
    temperature_range=(HEATS[0], HEATS[-1]),
    temperature_nodes=6,
)


class Course(enum.Enum):
    """What of a screw may change, with the states that are solved and their oil."""

    PRELOAD = (1.0, 0.9, 0.8, 0.7, 0.6)
    FILM = (1.0, 0.85, 0.7, 0.5)
    THINNER = ('iso_vg_68', 'iso_vg_32')
    THICKER = ('iso_vg_68', 'iso_vg_100')


class Ground(NamedTuple):
    """What is solved once: logarithms of friction by course and state, and the surfaces."""

    friction: dict[Course, list[Array]]
    surfaces: dict[float, Surface]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Conditions:
    """Where the screw runs: |w| [rad/s], |load| [N], temperature at the contact [K]."""

    speed: Array
    load: Array
    temperature: Array

    def at(self, log_friction: Array) -> Array:
        """Return the logarithm of the friction torque [N m]."""
        axes = np.log(SPEEDS), LOADS, HEATS
        between = RegularGridInterpolator(axes, log_friction, method='cubic')
        return np.asarray(
            between(np.stack([np.log(self.speed), self.load, self.temperature], axis=-1))
        )


def friction(ground: Ground, course: Course, state: Array, where: Conditions) -> Array:
    """
    Return the friction torque [N m] with a state of a course at each of many conditions.

    The state of a course of numbers is one of them or between them, that of an oil 0 or 1.

    """
    solved = ground.friction[course]
    places = np.arange(len(solved), dtype=float)
    if course in (Course.PRELOAD, Course.FILM):
        place = np.interp(-state, -np.array(course.value), places)
    else:
        place = np.asarray(state, dtype=float)
    logs = [where.at(one) if _near(place, i).any() else place for i, one in enumerate(solved)]
    weights = [np.clip(1.0 - np.abs(place - i), 0.0, 1.0) for i in range(len(solved))]
    return np.exp(sum(weight * log for weight, log in zip(weights, logs, strict=True)))


def _near(place: Array, number: int) -> NDArray[np.bool_]:
    return np.abs(place - number) < 1.0


def solve_ground() -> Ground:
    """Return what is solved once."""
    solved, data = _solve()
    return Ground(solved, {share: Surface(one) for share, one in data.items()})


def _solve():
    wanted = [(course, state) for course in Course for state in course.value]
    progress = Progress(len(wanted) + len(COMPANIONS), 'states of the screw')
    solved = {course: [] for course in Course}
    nominal = _log_friction(Course.PRELOAD, 1.0)
    for course, state in wanted:
        known = nominal if state == course.value[0] else _log_friction(course, state)
        solved[course].append(known)
        progress.step()
    data = {}
    for share in COMPANIONS:
        data[share] = build_closed_form(_screw(share), load_lubricant(OIL), STATED)
        progress.step()
    return solved, data


def _screw(share: float):
    screw = load_screw(SCREW)
    return dataclasses.replace(screw, preload=share * screw.preload)


def _log_friction(course: Course, state: float | str) -> Array:
    oil = load_lubricant(state if isinstance(state, str) else OIL)
    if course is Course.FILM:
        oil = dataclasses.replace(oil, film_factor=state)
    screw = _screw(state if course is Course.PRELOAD else 1.0)
    grid = SPEEDS[:, None, None], LOADS[None, :, None], HEATS[None, None, :]
    return np.log(closed_form.solve(Contacts.of(screw), oil, *grid).friction_torque)
