# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The full tier as a tier of surfaces: build with workers and a store, and solve a point again."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
import platform
import sys
import time
from typing import Any

import numba
import numpy as np
import scipy
from surrogate.builder.full.build import build_full
from surrogate.builder.full.chain import chain_inputs, solve_chain, solved_chain, WORK
from surrogate.builder.full.columns import covering
from surrogate.builder.full.draws import mean_of_draws, WeightedDraws
from surrogate.builder.full.run import ChainRun
from surrogate.builder.full.settings import FullSettings
from surrogate.builder.tiers import screw_and_oil
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.contacts import GRID_WAVELENGTH
from surrogate.surface import SolvedPoint
from surrogate.surface.file import SurfaceData
from surrogate.tasks.pool import Pool
from surrogate.tasks.store import TaskStore
from surrogate.units import RPM, ZERO_CELSIUS


def build_full_surface(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, *, pool: Pool, out: str | Path
) -> SurfaceData:
    """
    Build a surface on workers; results are kept beside `out`, an interrupted build goes on.

    Says on stderr where the accuracy asked for was not reached and nodes have no number.

    Raises InputError for ranges that make no sense, SurfaceError for a store that cannot be used.

    """
    began = time.perf_counter()
    with TaskStore(out, WORK) as store:
        run = ChainRun(pool=pool, store=store)
        data = build_full(screw, lubricant, settings, run)
    for sentence in shortfalls(data, settings):
        print(sentence, file=sys.stderr)
    return replace(data, provenance=_provenance(run, time.perf_counter() - began))


def shortfalls(data: SurfaceData, settings: FullSettings) -> Iterator[str]:
    """Yield a sentence on accuracy that was not reached and one on nodes that are missing."""
    reached = data.header['reached']
    if reached is None:
        yield 'accuracy is not known: no held-out point was solved'
    elif reached > 1:
        yield (
            f'accuracy is {settings.accuracy:g}, reached is '
            f'{reached * settings.accuracy:.2g} with {settings.speed_nodes} speed and '
            f'{settings.load_nodes} load nodes at most; the file says where'
        )
    yield from _missing(data, settings.speed_range)


def _missing(data: SurfaceData, speed_range: tuple[float, float]) -> Iterator[str]:
    """Yield a sentence if lookups read nodes that have no number."""
    needed = covering(data.speed_coordinate, data.log_onset, speed_range, (3, 3))
    place = np.nonzero(data.mask & needed)
    if place[0].size:
        speed = np.exp(data.speed_coordinate[place[0]] + data.log_onset[place[1:]])
        rpm, load = speed / RPM, data.load[place[1]]
        heat = data.temperature[place[2]] - ZERO_CELSIUS
        yield (
            f'{rpm.size} of {needed.sum()} nodes are missing, too few of their draws were solved: '
            f'{rpm.min():.3g} to {rpm.max():.3g} rev/min, {load.min():g} to {load.max():g} N, '
            f'{heat.min():.3g} to {heat.max():.3g} degC; lookups beside them are NaN'
        )


def solve_full(
    header: Mapping[str, Any], speed: float, load: float, temperature: float
) -> SolvedPoint:
    """
    Solve a point [rad/s, N, K] with the draws of a surface and return the means of its fields.

    Not converged where more than half of the draws are not, as for a node.

    """
    screw, lubricant = screw_and_oil(header['inputs'])
    draws = drawn(header)
    # Files of builders that had no such setting were solved with its default.
    wavelength = header['settings'].get('grid_wavelength', GRID_WAVELENGTH)
    chains = (
        chain_inputs(screw, lubricant, abs(load), temperature, draw, [speed], wavelength)
        for draw in range(draws.at(load))
    )
    points = [solved_chain(solve_chain(chain)).under(load)[0] for chain in chains]
    return mean_of_draws(points, draws, load)


def drawn(header: Mapping[str, Any]) -> WeightedDraws:
    """Return the draws of a surface; files of builders without weights say how many alone."""
    kept = header.get('weighted_draws')
    if kept is None:
        return WeightedDraws(int(header['settings']['draws']))
    return WeightedDraws(**{**kept, 'powers': tuple(kept['powers'])})


def _provenance(run: ChainRun, seconds: float) -> dict[str, Any]:
    return {
        'built': time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime()),
        'build_seconds': round(seconds, 3),
        'worker_seconds': round(run.seconds, 3),
        'chains': run.chains,
        'kept_chains': run.kept,
        'solved_points': run.points,
        'failed_chains': len(run.failures),
        'machine': platform.machine(),
        'python': platform.python_version(),
        'numpy': np.__version__,
        'scipy': scipy.__version__,
        'numba': numba.__version__,
    }
