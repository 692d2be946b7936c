# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Where a full-tier surface needs speed nodes: onset of contact, and a reference column."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.build import speed_at_film_ratio
from surrogate.full.columns import Columns, mean_over_draws, records_by_speed, Results
from surrogate.full.settings import error_target, FullSettings, Run
from surrogate.full.speed_nodes import refine_nodes, Sample

Array = NDArray[np.float64]

ONSET_FILM_RATIO = 0.08
"""Film ratio near which RCS passes 0.01 on the nominal screw [-]; docs/onset.md."""
ONSET_STEPS = (1.0, 0.6, 0.3, 0.0, -0.3, -0.6, -1.0)
"""Where the onset is looked for, as logarithms of speed over that of the film ratio [-]."""
ONSET_DRAWS, REFERENCE_DRAWS = 2, 4
OUTER_STEP = 1.4
"""Distance of speed nodes beyond those of the reference column [-]."""
NOTHING = 1e-6
"""RCS below which the logarithm of the onset search is cut off [-]."""
FIRST_NODES = (-1.2, -0.6, -0.2, 0.2, 0.6, 1.5)
"""Speed coordinates between the ends with which the refinement begins [-]."""


def find_onset(columns: Columns, settings: FullSettings, run: Run) -> Array:
    """
    Return the logarithm of the speed [rad/s] at which RCS of the first draws is about 0.01.

    By formula over load and temperature, moved by solves over the loads at the reference
    temperature and over the temperatures at the least load. It only decides where nodes lie.

    """
    guess = np.log(
        speed_at_film_ratio(
            columns.screw,
            columns.lubricant,
            columns.load[:, None],
            columns.temperature,
            ONSET_FILM_RATIO,
        )
    )
    reference = columns.reference
    by_load, by_heat = _shifts(columns, guess, reference, settings, run)
    places = np.searchsorted(columns.magnitudes, np.abs(columns.load))
    found = guess + by_load[places][:, None] + (by_heat - by_heat[reference])
    low, high = (math.log(speed) for speed in settings.speed_range)
    return np.asarray(np.clip(found, low, high))


def _shifts(
    columns: Columns, guess: Array, reference: int, settings: FullSettings, run: Run
) -> tuple[Array, Array]:
    """Return how far the onset lies from its guess over the loads and over the temperatures."""
    least = int(np.argmin(np.abs(columns.load)))
    pairs = [(columns.place_of(load), reference) for load in columns.magnitudes]
    pairs += [(least, k) for k in range(len(columns.temperature))]
    chains = {
        f'{j} {k} {draw}': columns.chain(
            abs(columns.load[j]),
            columns.temperature[k],
            draw,
            np.exp(guess[j, k] + np.array(ONSET_STEPS)),
        )
        for j, k in pairs
        for draw in range(min(ONSET_DRAWS, settings.draws))
    }
    results = run('onset', chains)
    shifts = [_shift(results, f'{j} {k} ', settings.onset_rcs) for j, k in pairs]
    count = len(columns.magnitudes)
    return _filled(np.array(shifts[:count])), _filled(np.array(shifts[count:]))


def _shift(results: Results, start: str, onset_rcs: float) -> float:
    """Return where the mean RCS of the chains of one column passes `onset_rcs`, or NaN."""
    chains = [result for name, result in results.items() if name.startswith(start)]
    shares = [
        mean_over_draws([record for record in records if record['converged']], 'rcs')
        for records in records_by_speed(chains, 'opposing', len(ONSET_STEPS))
    ]
    logs = np.log(np.maximum(shares, NOTHING))
    known = np.isfinite(logs)
    if known.sum() < 2 or not logs[known].min() < math.log(onset_rcs) < logs[known].max():
        return math.nan
    # RCS falls with speed; running minima mend what a draw or two leave of a rise.
    falling = np.minimum.accumulate(logs[known])
    return float(np.interp(-math.log(onset_rcs), -falling, np.array(ONSET_STEPS)[::-1][known]))


def _filled(shifts: Array) -> Array:
    """Return shifts with those that are not known taken from the mean of the others, or zero."""
    known = np.isfinite(shifts)
    return np.where(known, shifts, float(shifts[known].mean()) if known.any() else 0.0)


def find_speed_nodes(columns: Columns, settings: FullSettings, run: Run) -> Array:
    """
    Return nodes of the speed coordinate that cover the range at every load and temperature.

    Where the means of a few draws need them, at the least load that presses a ball and the
    reference temperature; oil that is colder or hotter has nodes of even distance beyond.

    """
    pressed = [load for load in columns.magnitudes if load or columns.screw.preload]
    j = columns.place_of(pressed[0])
    k = columns.reference
    low, high = (math.log(speed) for speed in settings.speed_range)
    ends = low - columns.log_onset[j, k], high - columns.log_onset[j, k]
    first = [ends[0], *(s for s in FIRST_NODES if ends[0] < s < ends[1]), ends[1]]

    def solve(places: Array) -> dict[float, Sample]:
        speeds = columns.speeds(places, j, k)
        chains = {
            str(draw): columns.chain(pressed[0], columns.temperature[k], draw, speeds)
            for draw in range(min(REFERENCE_DRAWS, settings.draws))
        }
        results = run('speed nodes', chains)
        records = records_by_speed(list(results.values()), 'opposing', len(places))
        return {float(place): _sample(solved) for place, solved in zip(np.sort(places), records)}

    target = error_target(columns.screw, settings)
    inner, _ = refine_nodes(np.array(first), solve, target, settings.speed_nodes)
    return _extended(inner, low - columns.log_onset.max(), high - columns.log_onset.min())


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


def _sample(records: list[dict[str, Any]]) -> Sample:
    solved = [record for record in records if record['converged']]
    return Sample(
        torque=mean_over_draws(solved, 'friction_torque'), rcs=mean_over_draws(solved, 'rcs')
    )
