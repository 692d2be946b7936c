# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Error of a full-tier surface, measured at points that are no nodes."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
import itertools
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.full.settings import FullSettings
from surrogate.formulas.load_sharing import idle_load, working_preload
from surrogate.parameters import Screw
from surrogate.surface import FIELDS, SolvedPoint, Surface, SurfacePoint, Validity
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, LIGHT_LOAD, rcs_tolerance
from surrogate.surface.file import SurfaceData

Array = NDArray[np.float64]
Ends = tuple[float, float]
HeldOutPlace = tuple[float, float, float]
"""Speed [rad/s], load [N], temperature [K]."""

MUCH, NEAR_ONSET = (-1.25, -0.4), (-0.4, 0.75)
"""Speed coordinates between which contact is much, and between which it sets in [-]."""
NEAR_IDLE = 0.8
"""Part of the idle load from which on the relieved nut is near unloading [-]."""
SPEEDS = (NEAR_ONSET, (NEAR_ONSET[1], math.inf), MUCH, (-math.inf, MUCH[0]))
"""Ends of the speed coordinates within which errors are alike [-]."""
TRIES = 20
"""Loads and temperatures that are tried for a point of a stratum."""


@dataclass(frozen=True, slots=True)
class HeldOut:
    """
    A solved point: where, its cell, what the lookup and what the solve says.

    `miss` is the larger error of efficiency and RCS over the allowed one [-].

    """

    point: HeldOutPlace
    speed_coordinate: float
    cell: tuple[int, int, int]
    answer: SurfacePoint
    solved: SolvedPoint
    miss: float


def judged(
    data: SurfaceData, surface: Surface, screw: Screw, point: HeldOutPlace, solved: SolvedPoint
) -> HeldOut | None:
    """Return a solved point beside its lookup; None where either has no answer."""
    answer = surface.lookup(*point)
    if not (solved.converged and answer.validity is Validity.VALID):
        return None
    s = math.log(point[0] / surface.onset_speed(*point[1:]))
    return HeldOut(
        point, s, _cell(data, (s, *point[1:])), answer, solved, _miss(screw, point, answer, solved)
    )


def _miss(screw: Screw, point: HeldOutPlace, answer: SurfacePoint, solved: SolvedPoint) -> float:
    """Return the larger error of efficiency and RCS over the allowed one [-]."""
    least = LIGHT_LOAD * working_preload(screw)
    ideal = max(abs(point[1]), least) * screw.lead / (2 * math.pi)
    torque, exact = ideal + answer.friction_torque, ideal + solved.friction_torque
    return max(
        ideal * abs(1 / torque - 1 / exact) / EFFICIENCY_TOLERANCE,
        abs(answer.rcs - solved.rcs) / rcs_tolerance(solved.rcs),
    )


def cell_errors(
    data: SurfaceData, solved: Sequence[HeldOut], screw: Screw, settings: FullSettings
) -> dict[str, Array]:
    """
    Return the errors per field and cell: |lookup - solve|.

    A cell without a point of its own has the largest of its stratum; NaN where none was.

    """
    axes, errors = (data.speed_coordinate, data.load, data.temperature), {}
    s, load, _ = (0.5 * (axis[1:] + axis[:-1]) for axis in axes)
    for name in FIELDS:
        error = np.full([len(axis) - 1 for axis in axes], np.nan)
        for held_out in solved:
            error[held_out.cell] = np.fmax(error[held_out.cell], _wrong(held_out, name))
        errors[name] = filled = error.copy()
        for speeds, loads in itertools.product(SPEEDS, load_bands(screw, settings)):
            part = np.ix_(_within(s, speeds), _within(np.abs(load), loads))
            alike = [
                _wrong(held_out, name)
                for held_out in solved
                if _within(np.array(held_out.speed_coordinate), speeds)
                and _within(np.array(abs(held_out.point[1])), loads)
            ]
            if alike:
                filled[part] = np.where(np.isfinite(error[part]), error[part], max(alike))
    return errors


def load_bands(screw: Screw, settings: FullSettings) -> list[Ends]:
    """
    Return the ends of |load| [N] within which errors are alike, as far as the range has them.

    Both nuts loaded, the relieved one near unloading, and idle.

    """
    (least, most), idle = settings.load_sizes, idle_load(screw)
    marks = [least, *(mark for mark in (NEAR_IDLE * idle, idle) if least < mark < most), most]
    return list(zip(marks, marks[1:]))


def held_out_points(surface: Surface, screw: Screw, settings: FullSettings) -> list[HeldOutPlace]:
    """Return points of the range, from all strata in turn; fewer where a stratum is empty."""
    drawn = np.random.default_rng(settings.seed)
    strata = [(speeds, loads) for speeds in SPEEDS for loads in load_bands(screw, settings)]
    points = (
        _point(surface, drawn, *strata[place % len(strata)], settings)
        for place in range(settings.held_out)
    )
    return [point for point in points if point is not None]


def _point(
    surface: Surface, drawn: np.random.Generator, speeds: Ends, loads: Ends, settings: FullSettings
) -> HeldOutPlace | None:
    """Return a point of a stratum; cold or hot oil may have none, then another is tried."""
    for _ in range(TRIES):
        # A load of either sign, within a band of its size and the range.
        pieces = [
            (max(low, settings.load_range[0]), min(high, settings.load_range[1]))
            for low, high in (loads, (-loads[1], -loads[0]))
        ]
        inside = [piece for piece in pieces if piece[0] < piece[1]]
        load = float(drawn.uniform(*inside[int(drawn.integers(len(inside)))]))
        heat = float(drawn.uniform(*settings.temperature_range))
        onset = math.log(surface.onset_speed(load, heat))
        low, high = (math.log(speed) - onset for speed in settings.speed_range)
        low, high = max(low, speeds[0]), min(high, speeds[1])
        if low < high:
            return math.exp(float(drawn.uniform(low, high)) + onset), load, heat
    return None


def _cell(data: SurfaceData, place: Sequence[float]) -> tuple[int, int, int]:
    axes = (data.speed_coordinate, data.load, data.temperature)
    i, j, k = (
        bisect_right(axis.tolist(), value, 1, len(axis) - 1) - 1
        for axis, value in zip(axes, place)
    )
    return i, j, k


def _wrong(held_out: HeldOut, name: str) -> float:
    return abs(float(getattr(held_out.answer, name)) - float(getattr(held_out.solved, name)))


def _within(places: Array, ends: Ends) -> NDArray[np.bool_]:
    return np.asarray((places >= ends[0]) & (places < ends[1]))
