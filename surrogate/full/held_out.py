# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Error of a full-tier surface, measured at points that are no nodes, with the same draws."""

from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.full.columns import Columns, mean_over_draws, NEAR_ONSET
from surrogate.full.loads import idle_load
from surrogate.full.settings import error_target, FullSettings, Run
from surrogate.full.speed_nodes import Sample
from surrogate.parameters import Screw
from surrogate.surface import FIELDS, Surface, Validity
from surrogate.surface_file import SurfaceData

Array = NDArray[np.float64]
Ends = tuple[float, float]

NEAR_IDLE = 0.8
"""Part of the idle load from which on the relieved nut is near unloading [-]."""


def measure_errors(
    data: SurfaceData, columns: Columns, settings: FullSettings, run: Run
) -> tuple[dict[str, Array], float | None]:
    """
    Return the errors per field and cell, and the largest of torque or RCS over the allowed one.

    The latter is None where no point was solved. Errors are |lookup - solve| with the same draws
    at points that are no nodes. A cell without a point of its own has the largest of its stratum;
    NaN where none was.

    """
    surface = Surface(data)
    points = held_out_points(data, columns.screw, settings)
    chains = {
        f'{place} {draw}': columns.chain(
            abs(load), heat, draw, np.array([surface.onset_speed(load, heat) * math.exp(s)])
        )
        for place, (s, load, heat) in enumerate(points)
        for draw in range(settings.draws)
    }
    results = run('held-out points', chains)
    target = error_target(columns.screw, settings)
    errors = {name: np.full([len(axis) - 1 for axis in _axes(data)], np.nan) for name in FIELDS}
    reached: list[float] = []
    for place, (s, load, heat) in enumerate(points):
        found = surface.lookup(surface.onset_speed(load, heat) * math.exp(s), load, heat)
        sense = 'opposing' if load >= 0 else 'assisting'
        chained = [results.get(f'{place} {draw}') for draw in range(settings.draws)]
        solved = [chain[sense][0] for chain in chained if chain and chain[sense][0]['converged']]
        if found.validity is not Validity.VALID or 2 * len(solved) < settings.draws:
            continue
        mean = {name: mean_over_draws(solved, name) for name in FIELDS}
        cell = tuple(
            int(np.searchsorted(axis, value)) - 1
            for axis, value in zip(_axes(data), (s, load, heat))
        )
        for name in FIELDS:
            error = abs(getattr(found, name) - mean[name])
            errors[name][cell] = np.fmax(errors[name][cell], error)
        ideal = abs(load) * columns.screw.lead / (2 * math.pi)
        allowed = replace(target, ideal_torque=max(target.ideal_torque, ideal))
        samples = (Sample(found.friction_torque, found.rcs), _sample(mean))
        reached.append(allowed.worst(*samples))
    boxes = strata(data, columns.screw, settings)
    filled = {name: _spread_out(error, data, boxes) for name, error in errors.items()}
    return filled, max(reached, default=None)


def strata(data: SurfaceData, screw: Screw, settings: FullSettings) -> list[tuple[Ends, Ends]]:
    """
    Return the ends of speed coordinates and of |load| [N] within which errors are alike.

    Around the onset of contact, faster and slower; each with both nuts loaded, with the relieved
    one near unloading, and with that idle.

    """
    low, high = (math.log(speed) for speed in settings.speed_range)
    inside = low - float(data.log_onset.min()), high - float(data.log_onset.max())
    slow, fast = np.clip(NEAR_ONSET, *inside).tolist()
    idle, most = idle_load(screw), float(np.abs(data.load).max())
    marks = [0.0, *(mark for mark in (NEAR_IDLE * idle, idle) if 0 < mark < most), most]
    return [
        (speeds, loads)
        for speeds in ((slow, fast), (fast, inside[1]), (inside[0], slow))
        for loads in zip(marks, marks[1:])
        if speeds[0] < speeds[1]
    ]


def held_out_points(
    data: SurfaceData, screw: Screw, settings: FullSettings
) -> list[tuple[float, float, float]]:
    """Return coordinate, load [N] and temperature [K] of points, from all strata in turn."""
    drawn = np.random.default_rng(settings.seed)
    boxes = strata(data, screw, settings)
    points = []
    for place in range(settings.held_out):
        speeds, loads = boxes[place % len(boxes)]
        sides = [side for side in (-1, 1) if data.load[0] <= side * loads[0] <= data.load[-1]]
        load = float(drawn.choice(sides)) * float(drawn.uniform(*loads))
        heat = float(drawn.uniform(data.temperature[0], data.temperature[-1]))
        inside = float(np.clip(load, data.load[0], data.load[-1]))
        points.append((float(drawn.uniform(*speeds)), inside, heat))
    return points


def _sample(mean: dict[str, float]) -> Sample:
    return Sample(mean['friction_torque'], mean['rcs'])


def _spread_out(error: Array, data: SurfaceData, boxes: list[tuple[Ends, Ends]]) -> Array:
    """Return errors with unmeasured cells filled with the largest of their stratum."""
    s, load, _ = (0.5 * (axis[1:] + axis[:-1]) for axis in _axes(data))
    filled = error.copy()
    for speeds, loads in boxes:
        part = np.ix_(_within(s, speeds, NEAR_ONSET), _within(np.abs(load), loads))
        known = error[part][np.isfinite(error[part])]
        if known.size:
            filled[part] = np.where(np.isfinite(error[part]), error[part], known.max())
    return filled


def _within(places: Array, ends: Ends, inner: Ends = (-math.inf, math.inf)) -> NDArray[np.bool_]:
    """Tell which places lie between ends; those outside the `inner` marks reach to infinity."""
    low = -math.inf if ends[0] < inner[0] else ends[0]
    high = math.inf if ends[1] > inner[1] else ends[1]
    return np.asarray((places >= low) & (places < high))


def _axes(data: SurfaceData) -> tuple[Array, Array, Array]:
    return data.speed_coordinate, data.load, data.temperature
