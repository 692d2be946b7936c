# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Own screws, their raceways marched as `surface build` does, and a fourth strip held out.

Usage: python studies/own_strips.py [--report].

Each strip that ends is added to results/own_strips.csv at once, and one that is there is not
marched again. Last it prints by how much strips of a raceway differ, and how the corrected law
tells those that were held out.

"""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
import math
from pathlib import Path
import time
from typing import Any, cast

import numpy as np
from surrogate.asperities.law import FILM_BANDS
from surrogate.builder.full.march import FINER, march_task, march_tasks, marched_film
from surrogate.parameters import load_lubricant, load_screw, Screw
from surrogate.raceway.fractal import Lay
from surrogate.raceway.stated import NINE_OF_TEN, State
from surrogate.tasks.table import read_table, write_table

RESULTS = Path('studies/results/own_strips.csv')
HELD_OUT = 'strip 4'
"""Name of the strip that corrects nothing."""
COARSE = 1, 2, 3, 4
"""Numbers of the coarse strips."""
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
    [s], status, share of the steps about the onset that failed [-]; NaN where no onset was found.
    After a change of the law it tells onset and film of the strip as that was marched.

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
    failed_share: float = math.nan


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
    Own('32x10', 0.1, ISO, 'new', fractal_dimension=2.55, preload=0.8),
    Own('nominal', 0.3, ISO, 'new'),
    Own('40x10', 0.3, ISO, fractal_dimension=2.4),
    Own('50x10', 0.06, ISO, 'new', fractal_dimension=2.6, oil='iso_vg_32'),
    Own('63x20', 0.15, ISO, oil='iso_vg_32'),
    Own('25x5', 0.15, ISO, 'new', fractal_dimension=2.45, preload=1.2, conformity=0.525),
    Own('16x5', 0.06, ISO, fractal_dimension=2.6, preload=0.7),
    Own('20x5', 0.35, ISO, 'new', oil='iso_vg_100', cutoff_long_mm=0.8),
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
    onset, factor, failed = (
        math.nan if found[key] is None else found[key]
        for key in ('marched_m_s', 'film_factor', 'failed_share')
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
        failed_share=failed,
    )


def raceways(rows: Sequence[Strip]) -> dict[int, dict[str, Strip]]:
    """Return the strips that touch by their names, of each raceway by its number."""
    touching = [row for row in rows if math.isfinite(row.film_factor)]
    return {
        number: {row.strip: row for row in touching if row.own == number}
        for number in sorted({row.own for row in touching})
    }


def within(rows: Sequence[Strip], lay: str, states: Sequence[str]) -> tuple[float, int]:
    """Return the pooled deviation of coarse strips of a raceway in logarithms [-], and strips."""
    logs = [
        np.log([row.film_factor for row in strips.values() if row.strip != FINER])
        for number, strips in raceways(rows).items()
        if OWN[number].lay == lay and OWN[number].state in states
    ]
    several = [values for values in logs if values.size > 1]
    squares = sum(values.size * values.var() for values in several)
    strips = sum(values.size for values in several)
    return math.sqrt(squares / max(strips - len(several), 1)), strips


def held_out(strips: Mapping[str, Strip], name: str) -> tuple[float, float] | None:
    """Return logarithms [-]: how far a strip is off from what the others tell, and its band."""
    others = {other: asdict(row) for other, row in strips.items() if other != name}
    own = OWN[next(iter(strips.values())).own]
    known = marched_film(others, cast('Lay', own.lay), cast('State', own.state))
    if name not in strips or not known:
        return None
    off = math.log(strips[name].film_factor / known['marched_film'])
    return off, NINE_OF_TEN * known['marched_error']


def report(rows: Sequence[Strip]) -> Iterator[str]:
    """Yield the strips of each raceway and how they tell the fourth; by lay and state how well."""
    screws = raceways(rows)
    for number, strips in screws.items():
        text = ', '.join(f'{name} {row.film_factor:.2f}' for name, row in strips.items())
        if found := held_out(strips, HELD_OUT):
            off, band = map(math.exp, found)
            text += f': {HELD_OUT} is {off:.2f} of what the others tell within {band:.2f}'
        seconds = sum(row.seconds for row in strips.values())
        yield f'{1 + number} {OWN[number].lay} {OWN[number].state}: {text}; {seconds:.0f} s'
    for lay in (ISO, LON, TRA):
        for states in (('new', 'run_in'), ('new',), ('run_in',)):
            part = [
                strips
                for number, strips in screws.items()
                if OWN[number].lay == lay and OWN[number].state in states
            ]
            scatter, count = within(rows, lay, states)
            yield (
                f'{lay}, {" and ".join(states)}: deviation within a raceway {scatter:.3f} of '
                f'{count} strips, {", ".join(coverage(part))}'
            )


def coverage(part: Sequence[Mapping[str, Strip]]) -> Iterator[str]:
    """Yield how many strips the law tells, and the others, or within the factor wanted."""
    rows = [row for strips in part for name, row in strips.items() if name != FINER]
    told = sum(abs(math.log(row.film_factor)) <= math.log(FILM_BANDS[row.lay]) for row in rows)
    yield f'by the law {told} of {len(rows)} inside'
    for which, names in (('fourth', [HELD_OUT]), ('each in turn', [f'strip {n}' for n in COARSE])):
        found = [held_out(strips, name) for strips in part for name in names]
        known = [pair for pair in found if pair]
        inside = sum(abs(off) <= band for off, band in known)
        near = sum(abs(off) <= max(band, math.log(WANTED)) for off, band in known)
        yield f'{which} {inside} of {len(known)} inside, {near} inside or within {WANTED}'


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
        there = {(row.own, row.strip) for row in read_table(RESULTS, Strip)}
        for number, name, task in wanted():
            if (number, name) not in there:
                strip = march(number, name, OWN[number].lay, task)
                write_table(RESULTS, Strip, [*read_table(RESULTS, Strip), strip], digits=5)
                print(strip, flush=True)
    print(*report(read_table(RESULTS, Strip)), sep='\n')


if __name__ == '__main__':
    main()
