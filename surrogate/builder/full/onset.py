# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Where contact sets in over load and temperature, and the loads that an interpolation needs.

Both from profiles: chains of few draws over speeds around the onset that a formula gives. The
onset only decides where nodes lie. It shall be smooth over the load, so that what is left of few
draws is not carried into fields at one mapped speed: the formula moved by straight lines.

"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.closed_form import speed_at_film_ratio
from surrogate.builder.full.chain import chain_inputs, SolvedChain
from surrogate.builder.full.columns import mean_over_draws, points_by_speed, presses
from surrogate.builder.full.loads import first_loads, LoadPieces, refine_loads
from surrogate.builder.full.settings import error_target, FullSettings, SolveChains
from surrogate.builder.full.speed_nodes import NodeSample
from surrogate.builder.full.temperatures import between, log_viscosity
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]

ONSET_FILM_RATIO = 0.08
"""Film ratio near which RCS passes 0.01 on the nominal screw [-]; docs/theory/roughness.md."""
ONSET_STEPS = (1.0, 0.6, 0.3, 0.0, -0.3, -0.6, -1.0)
"""Where the onset is looked for, as logarithms of speed over that of the film ratio [-]."""
ONSET_DRAWS = 2
NOTHING = 1e-6
"""RCS below which the logarithm of the onset search is cut off [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Profiles:
    """Solves profiles of one screw and oil on `run`."""

    screw: Screw
    lubricant: Lubricant
    settings: FullSettings
    run: SolveChains

    def guess(self, load: Array, temperature: Array) -> Array:
        """Return the logarithm of the onset speed [rad/s] by formula, over [load, temperature]."""
        return np.asarray(
            np.log(
                speed_at_film_ratio(
                    self.screw, self.lubricant, load[:, None], temperature, ONSET_FILM_RATIO
                )
            )
        )

    def solve(self, loads: Sequence[float] | Array, temperature: float) -> dict[float, NodeSample]:
        """Return torque [N m] and RCS over `ONSET_STEPS` for magnitudes [N] at a temperature."""
        chains = {
            f'{load!r} N, {temperature:g} K, draw {draw}': self._chain(load, temperature, draw)
            for load in map(float, loads)
            if presses(self.screw, load)
            for draw in range(min(ONSET_DRAWS, self.settings.draws))
        }
        results = self.run('onset', chains)
        return {
            load: _profile(
                [result for name, result in results.items() if name.startswith(f'{load!r} N, ')]
            )
            for load in map(float, loads)
        }

    def _chain(self, load: float, temperature: float, draw: int) -> dict[str, Any]:
        guess = self.guess(np.array([load]), np.array([temperature]))[0, 0]
        speeds = [float(speed) for speed in np.exp(guess + np.array(ONSET_STEPS))]
        wavelength = self.settings.grid_wavelength
        return chain_inputs(
            self.screw, self.lubricant, load, temperature, draw, speeds, wavelength
        )


def _profile(chains: Sequence[SolvedChain | None]) -> NodeSample:
    """Return the means of chains in the order of `ONSET_STEPS`."""
    solved = list(points_by_speed(chains, len(ONSET_STEPS)))[::-1]
    torque, rcs = (
        np.array([mean_over_draws(points, name) for points in solved])
        for name in ('friction_torque', 'rcs')
    )
    return NodeSample(torque, rcs)


def find_loads(
    profiles: Profiles, temperature: float
) -> tuple[LoadPieces, dict[float, NodeSample]]:
    """Return the magnitudes [N] that the profiles at a temperature [K] need, and these."""
    settings, known = profiles.settings, {}

    def solve(loads: Array) -> dict[float, NodeSample]:
        found = profiles.solve(loads, temperature)
        known.update(found)
        return found

    target = error_target(profiles.screw, settings)
    first = first_loads(profiles.screw, settings)
    return refine_loads(first, solve, target, settings.load_nodes), known


def find_onset(
    profiles: Profiles,
    pieces: LoadPieces,
    known: Mapping[float, NodeSample],
    loads: Array,
    solved: Array,
    temperature: Array,
) -> Array:
    """
    Return the logarithm of the onset speed [rad/s] over load [N] and temperature [K] nodes.

    By formula, moved along the load by profiles at the middle one of the `solved` temperatures, of
    which some may be `known`, and along the temperature by those at the least load that presses a
    ball.

    """
    onset_rcs = profiles.settings.onset_rcs
    # Loads crowd where profiles bend; the line is that of even ones, every other is enough.
    even = first_loads(profiles.screw, replace(profiles.settings, idle_halvings=0))
    fitted = LoadPieces(even.shared, even.alone[::2] if len(even.alone) > 2 else even.alone)
    lacking = [load for load in fitted.magnitudes.tolist() if load not in known]
    known = {**known, **profiles.solve(lacking, middle(solved))}
    at_load = smooth_shifts(
        pieces,
        fitted,
        {load: _shift(known[load], onset_rcs) for load in fitted.magnitudes.tolist()},
    )
    by_load = [at_load[load] for load in np.abs(loads).tolist()]
    least = min(load for load in known if presses(profiles.screw, load))
    at_heat = [
        known[least] if heat == middle(solved) else profiles.solve([least], heat)[least]
        for heat in solved.tolist()
    ]
    shifts = np.array([_shift(profile, onset_rcs) for profile in at_heat])
    centred = np.nan_to_num(shifts - shifts[len(shifts) // 2])
    x, wanted = (log_viscosity(profiles.lubricant, heat) for heat in (solved, temperature))
    moved = np.array(by_load)[:, None] + between(x, centred, wanted, smooth=True)
    return np.asarray(profiles.guess(loads, temperature) + moved)


def middle(temperatures: Array) -> float:
    """Return the temperature [K] in the middle of those solved."""
    return float(temperatures[len(temperatures) // 2])


def smooth_shifts(
    pieces: LoadPieces, fitted: LoadPieces, shifts: Mapping[float, float]
) -> dict[float, float]:
    """
    Return shifts by magnitude, on a straight line below the idle load and one level above.

    Both go through the `shifts` of the `fitted` magnitudes.

    """
    smooth: dict[float, float] = {}
    for piece, through, degree in (
        (pieces.shared, fitted.shared, 1),
        (pieces.alone, fitted.alone, 0),
    ):
        found = np.array([shifts[load] for load in through.tolist()])
        known = np.isfinite(found)
        line = [0.0]
        if known.any():
            degree = degree if known.sum() > 2 else 0
            line = np.polyfit(through[known], found[known], degree).tolist()
        smooth |= dict(zip(piece.tolist(), np.polyval(line, piece).tolist()))
    return smooth


def _shift(profile: NodeSample, onset_rcs: float) -> float:
    """Return the step at which the RCS of a profile passes `onset_rcs`, or NaN."""
    logs = np.log(np.maximum(profile.rcs, NOTHING))
    known = np.isfinite(logs)
    onset = math.log(onset_rcs)
    if known.sum() < 2 or not logs[known].min() < onset < logs[known].max():
        return math.nan
    # RCS rises as the speed falls; running maxima mend what a draw or two leave of a fall.
    rising = np.maximum.accumulate(logs[known])
    return float(np.interp(onset, rising, np.array(ONSET_STEPS)[known]))
