# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Error of a full-tier surface, measured at points that are no nodes, with the same draws."""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.full.columns import Columns, mean_over_draws
from surrogate.full.settings import FullSettings, NEAR_ONSET, Run
from surrogate.surface import FIELDS, Surface
from surrogate.surface_file import SurfaceData

Array = NDArray[np.float64]


def measure_errors(
    data: SurfaceData, columns: Columns, settings: FullSettings, run: Run
) -> dict[str, Array]:
    """
    Return, per field and cell, |lookup - solve| with the same draws at points that are no nodes.

    A cell without a point of its own has the largest error that was found on its side of the
    onset; NaN where none was.

    """
    surface = Surface(data)
    points = held_out_points(data, settings)
    chains = {
        f'{place} {draw}': columns.chain(
            abs(load), heat, draw, np.array([surface.onset_speed(load, heat) * math.exp(s)])
        )
        for place, (s, load, heat) in enumerate(points)
        for draw in range(settings.draws)
    }
    results = run('held-out points', chains)
    errors = {name: np.full([len(axis) - 1 for axis in _axes(data)], np.nan) for name in FIELDS}
    for place, (s, load, heat) in enumerate(points):
        found = surface.lookup(surface.onset_speed(load, heat) * math.exp(s), load, heat)
        sense = 'opposing' if load >= 0 else 'assisting'
        chained = [results[f'{place} {draw}'] for draw in range(settings.draws)]
        solved = [chain[sense][0] for chain in chained if chain and chain[sense][0]['converged']]
        cell = tuple(
            int(np.searchsorted(axis, value)) - 1
            for axis, value in zip(_axes(data), (s, load, heat))
        )
        for name in FIELDS:
            error = abs(getattr(found, name) - mean_over_draws(solved, name))
            errors[name][cell] = np.fmax(errors[name][cell], error)
    return {name: _spread_out(error, data.speed_coordinate) for name, error in errors.items()}


def held_out_points(data: SurfaceData, settings: FullSettings) -> list[tuple[float, float, float]]:
    """Return coordinate, load [N] and temperature [K] of points, half of them near the onset."""
    drawn = np.random.default_rng(settings.seed)
    low, high = (math.log(speed) for speed in settings.speed_range)
    inside = low - data.log_onset.min(), high - data.log_onset.max()
    near = max(NEAR_ONSET[0], inside[0]), min(NEAR_ONSET[1], inside[1])
    return [
        (
            float(drawn.uniform(*(near if place % 2 else inside))),
            float(drawn.uniform(data.load[0], data.load[-1])),
            float(drawn.uniform(data.temperature[0], data.temperature[-1])),
        )
        for place in range(settings.held_out)
    ]


def _spread_out(error: Array, s: Array) -> Array:
    """Return errors with unmeasured cells filled from those on their side of the onset."""
    middle = 0.5 * (s[1:] + s[:-1])
    filled = error.copy()
    for side in (middle < NEAR_ONSET[1], middle >= NEAR_ONSET[1]):
        known = error[side][np.isfinite(error[side])]
        if known.size:
            filled[side] = np.where(np.isfinite(error[side]), error[side], known.max())
    return filled


def _axes(data: SurfaceData) -> tuple[Array, Array, Array]:
    return data.speed_coordinate, data.load, data.temperature
