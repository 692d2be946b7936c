# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Speed nodes of a full-tier surface: where a column of a few draws needs them."""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.full.columns import (
    Columns,
    mean_over_draws,
    points_by_speed,
    presses,
    ROUNDING,
)
from surrogate.builder.full.settings import error_target, FullSettings, SolveChains
from surrogate.builder.full.speed_nodes import NodeSample, refine_nodes
from surrogate.surface import SolvedPoint

Array = NDArray[np.float64]

REFERENCE_DRAWS = 4
OUTER_STEP = 2.0
"""Distance of speed nodes beyond those of the reference column [-]."""
FIRST_NODES = (-1.2, -0.6, -0.2, 0.0, 0.2, 0.4, 0.8, 1.5)
"""Speed coordinates between the ends with which the refinement begins [-]."""


def find_speed_nodes(
    columns: Columns, log_onset: Array, settings: FullSettings, run: SolveChains
) -> Array:
    """
    Return nodes of the speed coordinate that cover the range wherever the onset lies.

    `log_onset` is the logarithm of onset speeds [rad/s]. Nodes lie where the means of a few draws
    need them, at the least load that presses a ball and the middle temperature; oil that is
    colder or hotter has nodes of even distance beyond.

    """
    pressed = [load for load in columns.magnitudes if presses(columns.screw, load)]
    j = columns.place_of(pressed[0])
    k = columns.reference
    low, high = (math.log(speed) for speed in settings.speed_range)
    ends = low - columns.log_onset[j, k], high - columns.log_onset[j, k]
    first = [ends[0], *(s for s in FIRST_NODES if ends[0] < s < ends[1]), ends[1]]

    def solve(places: Array) -> dict[float, NodeSample]:
        speeds = columns.speeds(places, j, k)
        chains = {
            str(draw): columns.chain(pressed[0], columns.temperature[k], draw, speeds)
            for draw in range(min(REFERENCE_DRAWS, settings.draws))
        }
        results = run('speed nodes', chains)
        found = points_by_speed(list(results.values()), len(places))
        return {float(place): _sample(points) for place, points in zip(np.sort(places), found)}

    target = error_target(columns.screw, settings)
    inner = refine_nodes(np.array(first), solve, target, settings.speed_nodes)
    return _extended(inner, low - log_onset.max(), high - log_onset.min())


def speed_room(columns: Columns, s: Array, settings: FullSettings) -> int:
    """Return how many more nodes `speed_nodes` allows within the range of the reference column."""
    pressed = min(load for load in columns.magnitudes if presses(columns.screw, load))
    onset = columns.log_onset[columns.place_of(pressed), columns.reference]
    low, high = (math.log(speed) - onset for speed in settings.speed_range)
    inside = (s > low - ROUNDING) & (s < high + ROUNDING)
    return max(0, settings.speed_nodes - int(inside.sum()))


def _extended(inner: Array, low: float, high: float) -> Array:
    """Return nodes with more of them, at most `OUTER_STEP` apart, out to `low` and `high`."""
    below = math.ceil((inner[0] - low) / OUTER_STEP)
    above = math.ceil((high - inner[-1]) / OUTER_STEP)
    return np.concatenate(
        [
            np.linspace(min(low, inner[0]), inner[0], max(below, 0) + 1)[:-1],
            inner,
            np.linspace(inner[-1], max(high, inner[-1]), max(above, 0) + 1)[1:],
        ]
    )


def _sample(points: list[SolvedPoint]) -> NodeSample:
    return NodeSample(
        torque=mean_over_draws(points, 'friction_torque'), rcs=mean_over_draws(points, 'rcs')
    )
