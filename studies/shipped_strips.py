# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Strips of the raceways of the shipped sizes, as `surface build --march` marches them.

Usage: python studies/shipped_strips.py [SIZE ...] [--report].

Each strip that ends is added to results/shipped_strips.csv at once, and one that is there is not
marched again. Last it prints how they correct the law; shipped surfaces stand on the law alone.

"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
import math
from pathlib import Path
import time
from typing import Any, cast

from surrogate.builder.full.march import FINER, march_task, march_tasks, marched_film
from surrogate.parameters import load_lubricant, load_screw
from surrogate.tasks.table import read_table, write_table

RESULTS = Path('studies/results/shipped_strips.csv')
SIZES = '40x10', '16x5', '20x5', '25x5', '32x10', '50x10', '63x20'
OIL = 'iso_vg_68'


@dataclass(frozen=True, kw_only=True, slots=True)
class ShippedStrip:
    """A strip of a shipped size as `march_task` returns it, NaN for None; processor time [s]."""

    size: str
    strip: str
    marched_m_s: float
    film_factor: float
    told_m_s: float
    side: str
    shortest_wave_m: float
    steps: int
    status: str
    seconds: float


def tasks_of(size: str) -> dict[str, dict[str, Any]]:
    """Return the tasks of the strips of a size."""
    return march_tasks(load_screw(f'iso3408_{size}'), load_lubricant(OIL))


def march(size: str, strip: str, task: dict[str, Any]) -> ShippedStrip:
    """March a strip of a shipped size."""
    began = time.process_time()
    found = {name: math.nan if one is None else one for name, one in march_task(task).items()}
    seconds = time.process_time() - began
    return ShippedStrip(**cast('Any', found), size=size, strip=strip, seconds=seconds)


def wanted(sizes: list[str]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield the strips of sizes: coarse ones of each, then the finer ones."""
    for finer in (False, True):
        for size in sizes:
            for strip, task in tasks_of(size).items():
                if (strip == FINER) is finer:
                    yield size, strip, task


def report(rows: Sequence[ShippedStrip]) -> Iterator[str]:
    """Yield for each size its strips and how they correct the law."""
    for size in SIZES:
        own = {row.strip: row for row in rows if row.size == size}
        films = ', '.join(f'{strip} {row.film_factor:.2f}' for strip, row in own.items())
        factors = {
            strip: {'film_factor': None if math.isnan(row.film_factor) else row.film_factor}
            for strip, row in own.items()
        }
        known = marched_film(factors, load_screw(f'iso3408_{size}').roughness.lay)
        seconds = sum(row.seconds for row in own.values())
        yield f'{size}: {films}; {known}; {seconds:.0f} s'


def main() -> None:
    """March what is missing, and report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('sizes', nargs='*', metavar='SIZE', default=SIZES)
    parser.add_argument('--report', action='store_true', help='march nothing')
    args = parser.parse_args()
    for size, strip, task in () if args.report else wanted(args.sizes):
        rows = read_table(RESULTS, ShippedStrip)
        if (size, strip) not in {(row.size, row.strip) for row in rows}:
            found = march(size, strip, task)
            write_table(RESULTS, ShippedStrip, [*read_table(RESULTS, ShippedStrip), found])
            print(found, flush=True)
    print(*report(read_table(RESULTS, ShippedStrip)), sep='\n')


if __name__ == '__main__':
    main()
