# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Scatter of RCS between neighbouring loads, with nodes across the track that move and that stay.

Run `python studies/close_loads.py [--workers N] [--out DIR]`: solves draws of the nominal screw at
40 degC and one speed near the onset, at loads one per cent apart, on the grid of surfaces with its
nodes at the same places of the raceway, on the same with nodes that move with the contact, and on
that of points. Prints and draws RCS, and how far a draw lies from a straight line over the load.
Takes minutes.

"""

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
import sys
from typing import Any

import numpy as np
from surrogate.builder.full.chain import chain_settings
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.plotting.style import new_figure, save, styled
from surrogate.screw.contacts import GRID_WAVELENGTH, ScrewSettings
from surrogate.screw.solve import solve_screw
from surrogate.tasks.kept import run_kept
from surrogate.units import RPM

WORK = 'studies/close_loads.py 1'
"""Solver and version of the kept results."""
DRAWS = (3, 7, 11, 14)
SPEED = 23.0
"""Speed near the onset [rev/min]."""
LOADS = 1380.0 * 1.01 ** np.arange(-6, 7)
"""Opposing loads [N]."""


def grids(draw: int) -> dict[str, ScrewSettings]:
    """Return what is compared, by name."""
    stay = chain_settings(draw, GRID_WAVELENGTH)
    return {
        'surface, nodes stay': stay,
        'surface, nodes move': replace(stay, same_places=False),
        'point, nodes move': ScrewSettings(draw=draw),
    }


def rcs_of(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return RCS [-] of a grid and draw at all loads, NaN where it does not converge."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    settings = grids(inputs['draw'])[inputs['grid']]
    points = [
        OperatingPoint(speed=SPEED * RPM, load=float(load), temperature=oil.reference_temperature)
        for load in LOADS
    ]
    return {'rcs': [solve_screw(screw, oil, point, settings=settings).rcs for point in points]}


def scatter(rcs: np.ndarray) -> float:
    """Return the root mean square distance of the draws [draw, load] from straight lines [-]."""
    step = LOADS - LOADS.mean()
    lines = [np.polyval(np.polyfit(step, one, 1), step) for one in rcs]
    return float(np.sqrt(np.mean((rcs - lines) ** 2)))


@styled
def draw_figure(found: dict[str, np.ndarray], path: Path) -> None:
    """Draw RCS over the load, a panel per grid."""
    figure = new_figure(9, 3.2)
    panels = figure.subplots(1, len(found), sharey=True)
    for axes, (name, rcs) in zip(panels, found.items(), strict=True):
        for draw, one, style in zip(DRAWS, rcs, ('o-', 's--', '^-.', 'd:'), strict=True):
            axes.plot(LOADS, one, style, ms=3, lw=1, label=f'draw {draw}')
        axes.axhline(0.01, color='0.4', ls='--', lw=0.8)
        axes.set(xlabel='opposing load [N]', title=f'{name}\nscatter {scatter(rcs):.4f}')
        axes.title.set_fontsize(9)
        axes.grid(visible=True)
    panels[0].set_ylabel('RCS [-], dashed: limit of the zone')
    panels[-1].legend(loc='upper right')
    save(figure, path)


def main() -> None:
    """Solve, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workers', type=int, default=2)
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    cases = {
        f'{name}, draw {draw}': {'grid': name, 'draw': draw} for name in grids(0) for draw in DRAWS
    }
    done = run_kept(
        args.out / 'close_loads', WORK, rcs_of, cases, workers=args.workers, unit='chains'
    )
    rows = np.array([done[name]['rcs'] for name in cases])
    found = dict(zip(grids(0), rows.reshape(-1, len(DRAWS), len(LOADS)), strict=True))
    print('grid                   mean RCS  scatter')
    for name, rcs in found.items():
        print(f'{name:21}  {rcs.mean():8.4f}  {scatter(rcs):7.4f}')
    draw_figure(found, args.out / 'close_loads.png')


if __name__ == '__main__':
    sys.exit(main())
