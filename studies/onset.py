# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The onset study: RCS and asperity share of the nominal contact against every choice of the model.

Usage: python studies/onset.py [--only NAME ...] [--out studies/results/onset.csv]. Each variation
changes one thing of the base case. One chain per draw runs from the fastest speed down; finished
chains are kept in onset.csv.store, so an interrupted study goes on where it stopped.

"""

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window
from surrogate.tasks.kept import run_kept
from surrogate.tasks.table import read_table, write_table

WORK = 'studies/onset.py 1'
"""Solver and version of the kept results."""
LARGEST_LOAD = 100.0
"""Load whose Hertz rectangle is the window of a rescaled patch [N]."""
SPEEDS = tuple(2.0 * 10 ** (-n / 5) for n in range(16))
"""Entrainment speeds from 2 to 0.002 m/s, five per decade [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """
    One setting of the study.

    Load [N], floor [nm], wavelength [um], grid, nodes per shortest wave that stay where they are,
    None for nodes that move with the contact, logarithm of viscosity over which the wedge fades,
    patch, window [-], draws.

    """

    name: str
    load: float = 27.6
    floor_nm: float = 3.0
    shortest_um: float = 16.0
    nx: int = 129
    ny: int = 257
    per_wave: float | None = None
    fading: float = 2.5
    patch: str = 'rescaled'
    window: float = 1.0
    side: str = 'screw'
    draws: int = 16
    fastest: float = 0.081
    slowest: float = 0.002


BASE = Variation(name='base')
# Finer grids are dearer: fewer draws, and speeds about the onset only.
FINE = replace(BASE, draws=4, fastest=0.032, slowest=0.0049)
SURFACE = replace(BASE, name='surface grid', nx=97, ny=129, per_wave=5.0, fading=4.0)
STUDY = (
    replace(BASE, fastest=2.0),
    replace(BASE, name='floor 1 nm', floor_nm=1.0),
    replace(BASE, name='floor 10 nm', floor_nm=10.0),
    replace(BASE, name='wave 31 um', shortest_um=30.0),
    replace(BASE, name='wave 14 um', shortest_um=13.0, ny=385),
    replace(FINE, name='wave 9.1 um', shortest_um=9.0, nx=193, ny=513),
    replace(BASE, name='cut patch', patch='cut'),
    replace(FINE, name='grid 193 x 385', nx=193, ny=385),
    replace(FINE, name='load 100 N', load=100.0, ny=385, draws=16),
    replace(BASE, name='nut side', side='nut', draws=8, slowest=0.0049),
    replace(BASE, name='window x 2', window=2.0, draws=8, slowest=0.0049),
    replace(FINE, name='load 400 N', load=400.0, ny=513),
    replace(FINE, name='grid 257 x 513', nx=257, ny=513, draws=2),
    SURFACE,
    replace(SURFACE, name='the same, wedge as base', fading=BASE.fading),
    replace(SURFACE, name='100 N, surface grid', load=100.0, fastest=0.032, slowest=0.0049),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class OnsetRow:
    """One solve."""

    variation: str
    draw: int
    speed: float
    scale: float
    rcs: float
    asperity_share: float
    minimum_film: float
    converged: bool
    status: str
    newton: int
    krylov: int
    seconds: float


def solve_chain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Solve one draw in plain JSON; return its rows, from the fastest speed down."""
    variation = Variation(**inputs['variation'])
    return {'rows': [asdict(row) for row in chain(variation, inputs['draw'])]}


def chain(variation: Variation, draw: int) -> Iterator[OnsetRow]:
    """Yield the rows of one draw, from the fastest speed down."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    contact = screw_contact(screw, variation.side)
    lubricant = ContactLubricant(
        viscosity=oil.viscosity, pressure_viscosity=oil.pressure_viscosity
    )
    ellipse = hertz(contact, LARGEST_LOAD)
    window = Window(
        length_x=2 * variation.window * float(ellipse.semi_axis_x),
        length_y=2 * variation.window * float(ellipse.semi_axis_y),
    )
    roughness = PublishedRoughness(shortest_wavelength=variation.shortest_um * 1e-6)
    draft = fractal_surface(roughness, draw)
    surface = take_patch(draft, variation.patch, window, roughness.rms)
    settings = Settings(
        nx=variation.nx,
        ny=variation.ny,
        spacing=variation.per_wave and surface.shortest_wavelength / variation.per_wave,
        film_floor=variation.floor_nm * 1e-9,
        wedge_fading=variation.fading,
        error_estimate=False,
        time_cap=120.0,
    )
    start: ContactSolution | None = None
    for speed in SPEEDS:
        if not variation.slowest * 0.999 < speed < variation.fastest * 1.001:
            continue
        condition = Condition(load=variation.load, entrainment_speed=speed)
        found = solve_contact(
            contact,
            lubricant,
            condition,
            settings=settings,
            start=start,
            roughness=lambda x, y: surface.heights(x[:, 0], y[0]),
        )
        start = found if found.converged else None
        yield OnsetRow(
            variation=variation.name,
            draw=draw,
            speed=speed,
            scale=surface.scale,
            rcs=found.rcs,
            asperity_share=found.asperity_share,
            minimum_film=found.minimum_film,
            converged=found.converged,
            status=found.status.name,
            newton=found.newton_iterations,
            krylov=found.krylov_iterations,
            seconds=found.wall_time,
        )


def run(tasks: Mapping[str, Mapping[str, Any]], path: Path, workers: int) -> list[OnsetRow]:
    """Solve the chains that the store beside the table does not keep; return the rows of all."""
    found = run_kept(path, WORK, solve_chain, tasks, workers=workers, unit='chains')
    return [OnsetRow(**row) for result in found.values() for row in result['rows']]


def main() -> None:
    """Run what is missing and write the table; rows of other variations stay in it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--only', nargs='*', default=None, help='names of variations')
    parser.add_argument('--out', type=Path, default=Path('studies/results/onset.csv'))
    parser.add_argument('--draws', type=int, nargs=2, default=(0, 64), metavar=('FIRST', 'END'))
    parser.add_argument('--workers', type=int, default=1, help='processes')
    args = parser.parse_args()
    tasks = {
        f'{variation.name}, draw {draw}': {'variation': asdict(variation), 'draw': draw}
        for variation in STUDY
        if not args.only or variation.name in args.only
        for draw in range(max(args.draws[0], 0), min(args.draws[1], variation.draws))
    }
    rows = read_table(args.out, OnsetRow) + run(tasks, args.out, args.workers)
    by_place = {(row.variation, row.draw, round(row.speed, 9)): row for row in rows}
    write_table(args.out, OnsetRow, by_place.values())


if __name__ == '__main__':
    main()
