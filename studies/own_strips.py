# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Own screws, their raceways marched as `surface build` does, and a fourth strip held out.

Usage: python studies/own_strips.py [--report].

Each strip that ends is added to results/own_strips_confined.csv at once, and one that is there is
not marched again. Those of results/own_strips.csv were marched on tiles whose summits were cut at
their hardness alone. Last it prints how the corrected law tells the strips that were held out, and
how both cuts differ.

"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
import math
from pathlib import Path
import time
from typing import Any, cast

from surrogate.builder.full.march import FINER, march_task, march_tasks, marched_film
from surrogate.parameters import load_lubricant, load_screw, Screw
from surrogate.raceway.fractal import Lay
from surrogate.raceway.stated import NINE_OF_TEN, State
from surrogate.tasks.table import read_table, write_table

RESULTS = Path('studies/results/own_strips.csv')
"""Strips of tiles whose summits were cut at their hardness, without the mean pressure."""
CONFINED = Path('studies/results/own_strips_confined.csv')
"""Strips of the tiles that a build marches."""
HELD_OUT = 'strip 4'
"""Name of the strip that corrects nothing."""
WANTED = 1.15
"""Factor in film within which it is wanted [-]."""


@dataclass(frozen=True, slots=True)
class Own:
    """
    An own screw: a shipped size with other preload [-], ball [-], conformity and roughness.

    Rq [um], lay, fan of its ridges [deg], fractal dimension, long cut-off [mm], state; oil.

    """

    size: str
    rms_um: float
    lay: str
    state: str = 'run_in'
    fractal_dimension: float = 2.5
    fan_deg: float = 10.0
    cutoff_long_mm: float = 0.25
    preload: float = 1.0
    conformity: float = 0.54
    oil: str = 'iso_vg_68'


@dataclass(frozen=True, kw_only=True, slots=True)
class Strip:
    """
    A strip of an own screw, by its number among `OWN`: draw, side, onsets, marched and told [m/s].

    Film at the marched onset over that of the law [-], shortest wave [um], steps, processor time
    [s], status; NaN where no onset was found.

    """

    own: int
    strip: str
    lay: str
    draw: int
    side: str
    marched_m_s: float
    told_m_s: float
    film_factor: float
    shortest_um: float
    steps: int
    seconds: float
    status: str


ISO, LON, TRA = 'isotropic', 'longitudinal', 'transverse'
OWN = (
    Own('32x10', 0.15, LON, fractal_dimension=2.4, preload=1.2, conformity=0.53),
    Own('20x5', 0.12, ISO, fractal_dimension=2.6, oil='iso_vg_32', conformity=0.52),
    Own('50x10', 0.25, TRA, fan_deg=15.0, preload=0.8),
    Own('40x10', 0.3, LON, 'new', fractal_dimension=2.45, preload=0.7),
    Own('16x5', 0.2, ISO, 'new', preload=0.8, oil='iso_vg_100'),
    Own('63x20', 0.12, LON, fan_deg=5.0, preload=0.9),
    Own('25x5', 0.25, ISO, fractal_dimension=2.4, conformity=0.525),
    Own('nominal', 0.08, LON, 'new', fractal_dimension=2.6, conformity=0.53),
    Own('32x10', 0.2, TRA, 'new', fractal_dimension=2.4, fan_deg=5.0),
    Own('50x10', 0.16, LON, fractal_dimension=2.55, oil='iso_vg_32'),
    Own('40x10', 0.08, ISO, preload=1.3, fractal_dimension=2.55),
    Own('20x5', 0.35, LON, fan_deg=15.0, oil='iso_vg_100'),
    Own('16x5', 0.12, TRA, fractal_dimension=2.6, preload=0.7),
    Own('63x20', 0.25, ISO, 'new', oil='iso_vg_100', conformity=0.53),
    Own('25x5', 0.2, LON, preload=1.4, conformity=0.525),
    Own('nominal', 0.2, ISO, fractal_dimension=2.45, cutoff_long_mm=0.8),
    Own('32x10', 0.1, LON, 'new', preload=0.5, fractal_dimension=2.45),
    Own('50x10', 0.1, ISO, fractal_dimension=2.6, oil='iso_vg_100'),
    Own('40x10', 0.16, TRA, oil='iso_vg_100', conformity=0.525),
    Own('16x5', 0.3, LON, fan_deg=3.0, preload=1.2),
)
"""Own screws, in an order in which each part spans lays, states and sizes."""


def sheet_of(own: Own) -> Screw:
    """Return the sheet of an own screw."""
    screw = load_screw(own.size if own.size == 'nominal' else f'iso3408_{own.size}')
    roughness = replace(
        screw.roughness,
        rms=1e-6 * own.rms_um,
        rms_low=None,
        rms_high=None,
        lay=cast('Lay', own.lay),
        fan_angle=None if own.lay == ISO else math.radians(own.fan_deg),
        fractal_dimension=own.fractal_dimension,
        cutoff_long=1e-3 * own.cutoff_long_mm,
        state=cast('State', own.state),
        traced='new',
    )
    return replace(
        screw,
        roughness=roughness,
        preload=own.preload * screw.preload,
        conformity_screw=own.conformity,
        conformity_nut=own.conformity,
        working_load=None,
    )


def tasks_of(number: int, own: Own) -> dict[str, dict[str, Any]]:
    """Return the tasks of a build and that of a fourth strip; draws that no other screw has."""
    tasks = march_tasks(sheet_of(own), load_lubricant(own.oil), draws=4)
    return {
        name: {**task, 'draw': 100 + 10 * number + task['draw']} for name, task in tasks.items()
    }


def march(number: int, name: str, lay: str, task: dict[str, Any]) -> Strip:
    """March a strip of an own screw."""
    began = time.process_time()
    found = march_task(task)
    onset, factor = (
        math.nan if found[key] is None else found[key] for key in ('marched_m_s', 'film_factor')
    )
    return Strip(
        own=number,
        strip=name,
        lay=lay,
        draw=task['draw'],
        side=found['side'],
        marched_m_s=onset,
        told_m_s=found['told_m_s'],
        film_factor=factor,
        shortest_um=1e6 * found['shortest_wave_m'],
        steps=found['steps'],
        seconds=time.process_time() - began,
        status=found['status'],
    )


def report(rows: Sequence[Strip]) -> Iterator[str]:
    """Yield for each screw what its strips correct, and how that tells the one held out."""
    good = {lay: [] for lay in (ISO, LON, TRA)}  # type: dict[str, list[bool]]
    for number in sorted({row.own for row in rows}):
        strips = {row.strip: row for row in rows if row.own == number}
        factors = {
            name: {'film_factor': None if math.isnan(row.film_factor) else row.film_factor}
            for name, row in strips.items()
        }
        held = factors.pop(HELD_OUT, {'film_factor': None})['film_factor']
        lay, seconds = next(iter(strips.values())).lay, sum(row.seconds for row in strips.values())
        text = ', '.join(f'{name} {row.film_factor:.2f}' for name, row in strips.items())
        known = marched_film(factors)
        if known and held is not None:
            off = math.log(held / known['marched_film'])
            band = math.exp(NINE_OF_TEN * known['marched_error'])
            inside = abs(off) <= math.log(max(band, WANTED))
            good[lay].append(inside)
            text += (
                f': {known["marched_film"]:.2f} within {band:.2f}, held out '
                f'{math.exp(off):.2f} of that, {"inside" if inside else "outside"}'
            )
        yield f'{1 + number} {lay}: {text}; {seconds:.0f} s'
    for lay, every in good.items():
        yield f'{lay}: {sum(every)} of {len(every)} inside'


def confined_over_alone(alone: Sequence[Strip], confined: Sequence[Strip]) -> Iterator[str]:
    """Yield films over that of the law of tiles as built, and over that with the other cut [-]."""
    known = {(row.own, row.strip, row.side): row.film_factor for row in alone}
    for row in confined:
        text = f'{1 + row.own} {row.lay}, {row.strip}, as built: {row.film_factor:.2f}'
        cut_alone = known.get((row.own, row.strip, row.side))
        yield f'{text}, {row.film_factor / cut_alone:.2f} of the other cut' if cut_alone else text


def wanted() -> Iterator[tuple[int, str, dict[str, Any]]]:
    """Yield all strips: of every screw the coarse ones, then the finer ones."""
    for finer in (False, True):
        for number, own in enumerate(OWN):
            for name, task in tasks_of(number, own).items():
                if (name == FINER) is finer:
                    yield number, name, task


def main() -> None:
    """March what is missing, and report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--report', action='store_true', help='march nothing')
    if not parser.parse_args().report:
        there = {(row.own, row.strip) for row in read_table(CONFINED, Strip)}
        for number, name, task in wanted():
            if (number, name) not in there:
                strip = march(number, name, OWN[number].lay, task)
                write_table(CONFINED, Strip, [*read_table(CONFINED, Strip), strip], digits=5)
                print(strip, flush=True)
    alone, confined = (read_table(path, Strip) for path in (RESULTS, CONFINED))
    print(*report(alone), *confined_over_alone(alone, confined), sep='\n')


if __name__ == '__main__':
    main()
