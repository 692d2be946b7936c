# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
RCS at loads a per cent apart: with nodes that move with the load, and with nodes that do not.

Run `python bench/close_loads.py [--draws 16] [--out DIR]`: solves the nominal screw at 40 degC and
one speed over loads around half the idle one, on the grid of surfaces, on that of a point, and on
the former with nodes that move. Prints what scatters about a straight line over the load: the
mean, and in the root mean square of all a single draw. Half an hour of processor time.

"""

import argparse
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product
import math
from multiprocessing import get_context
from pathlib import Path
import time

import matplotlib.pyplot as plt
import numpy as np
from surrogate.full.chain import chain_settings
from surrogate.full.draws import draws_of, weighted_mean
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import solve_screw
from surrogate.screw_contacts import GRID_WAVELENGTH, ScrewSettings

LOADS = (1360.0, 1370.0, 1380.0, 1390.0, 1400.0, 1410.0)
RPM, WARM = 22.0, 313.15
GRIDS = ('surfaces', 'nodes that move', 'point')


def settings_of(grid: str, draw: int) -> ScrewSettings:
    """Return how a draw is solved on one of the grids."""
    chain = chain_settings(draw, GRID_WAVELENGTH)
    if grid == 'point':
        return ScrewSettings(draw=draw)
    return replace(chain, same_places=grid == 'surfaces')


def solve(task: tuple[str, float, int]) -> tuple[float, float]:
    """Return the RCS of a grid, load and draw, and the processor time [s]."""
    grid, load, draw = task
    point = OperatingPoint(speed=RPM * math.pi / 30, load=load, temperature=WARM)
    began = time.process_time()
    found = solve_screw(
        load_screw('nominal'), load_lubricant('iso_vg_68'), point, settings=settings_of(grid, draw)
    )
    return found.rcs, time.process_time() - began


def about_line(values: np.ndarray) -> np.ndarray:
    """Return what is left of values [load, ...] about straight lines over the load."""
    lines = np.polyfit(LOADS, values, 1)
    return values - (np.outer(LOADS, lines[0]) + lines[1])


def solved(draws: int) -> Iterator[tuple[str, np.ndarray, float]]:
    """Yield the name of a grid, RCS [load, draw], seconds per point."""
    with ProcessPoolExecutor(2, mp_context=get_context('spawn')) as pool:
        for grid in GRIDS:
            tasks = list(product([grid], LOADS, range(draws)))
            rcs, seconds = np.array(list(pool.map(solve, tasks))).T
            yield grid, rcs.reshape(len(LOADS), draws), float(seconds.mean())


def main() -> None:
    """Print a row per grid, and draw them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--draws', type=int, default=16)
    parser.add_argument('--out', type=Path, default=Path('docs'))
    asked = parser.parse_args()
    ensemble = draws_of(load_screw('nominal'), asked.draws)
    figure, axes = plt.subplots(1, len(GRIDS), figsize=(10, 3.4), sharey=True, layout='tight')
    first = None
    print('grid             mean RCS  scatter  of a draw  time over the first')
    for axis, (grid, rcs, seconds) in zip(axes, solved(asked.draws)):
        mean = weighted_mean(rcs, ensemble.weights(rcs, np.array(LOADS)))
        degrees = len(LOADS) / (len(LOADS) - 2)
        of_mean = math.sqrt(degrees * np.mean(about_line(mean[:, None]) ** 2))
        of_draw = math.sqrt(degrees * np.mean(about_line(rcs) ** 2))
        first = first or seconds
        print(
            f'{grid:16} {mean.mean():.5f}  {of_mean:.5f}  {of_draw:.5f}    {seconds / first:.2f}'
        )
        axis.plot(LOADS, 100 * rcs, color='0.75', linewidth=0.8)
        axis.plot(LOADS, 100 * mean, color='black', marker='o', label='mean')
        axis.set(title=grid, xlabel='axial load [N]')
        axis.legend(loc='upper right')
    axes[0].set(ylabel='RCS [%]', ylim=(0, None))
    figure.savefig(asked.out / 'close_loads.png', dpi=150)


if __name__ == '__main__':
    main()
