# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Play axis-years of known truth, and print how good the health is that is made of their logs.

Usage: python bench/health.py [--years N] [--clean N] [--seed S] [--figures] [--rivals]
[--public FOLDER]. The years come from catalogues and textbooks (`health_parts/axis_year.py`) and
share no formula with the product. A year is made into logs, these into summaries, and a look is
taken after each log. --figures plays clean years and steps of 10 % alone, --rivals puts two
libraries beside the product, --public takes public measurements instead.

"""

import argparse
from collections.abc import Iterator
from pathlib import Path

from ballscrew_monitor.health.detection import looks
from health_parts.axis_year import axis_year
from health_parts.faults import CLEAN, FAULTS, LOOSENED, STEP
from health_parts.public_data import print_public
from health_parts.rivals import INSTALL, missing, rivals
from health_parts.score import Kind, print_table, Score, score_of
import numpy as np
from surrogate.tasks.progress import Progress

SCHEDULES = {
    'weekly': {},
    'daily': {'schedule': 'daily', 'days': 240.0},
    'monthly runs of 90 s at 10 Hz': {'schedule': 'monthly'},
    'no load cell, axis free': {'load': False},
    'no thermometer': {'temperature': False},
    'with cutting': {'programme': 'cutting'},
    'vertical': {'axis': 'vertical'},
}
"""Ways to log an axis."""
OTHER = 'preload -20 %'
"""Fault of the years that are logged otherwise."""


def kinds(years: int, clean: int) -> Iterator[tuple[Kind, int]]:
    """Yield the kinds of years, and how many of each."""
    for name in FAULTS:
        yield Kind('weekly', name, {}), clean if name == 'clean' else years
    for way, options in SCHEDULES.items():
        if options:
            few = max(years // 2, 1)
            yield Kind(way, 'clean', options), few
            yield Kind(way, OTHER, options), few
    for name in LOOSENED:
        yield Kind('weekly, with a scale', name, {'scale': True}), max(years // 2, 1)


def figures(years: int, clean: int, seed: int) -> None:
    """Print lines of clean years by schedule, and of changes; steps come on quiet axes."""
    wanted = [
        ('weekly', CLEAN, clean),
        ('daily', CLEAN, clean),
        ('monthly runs of 90 s at 10 Hz', CLEAN, clean),
        ('weekly', FAULTS[OTHER], years),
        ('weekly', STEP, years),
    ]
    bar, table = Progress(sum(count for _, _, count in wanted), 'years'), []
    for way, fault, count in wanted:
        courses = []
        for number in range(seed, seed + count):
            rng = np.random.default_rng([number, 5])
            quiet = {'wander': rng.uniform(0.0, 0.015), 'scatter': rng.uniform(0.01, 0.02)}
            options = SCHEDULES[way] | (quiet if fault is STEP else {})
            courses.append(score_of(axis_year(number, fault, **options), causes=False))
            bar.step()
        line = Score.of(Kind(way, fault.name, {}), courses)
        alarms, soon = (round(line.years * share) for share in (line.early / 100.0, line.soon))
        print(f'{way}, {fault.name}: {alarms} alarms, {soon} found in 8 weeks', flush=True)
        table.append(line)
    bar.close()
    print_table(table)


def compare(years: int, clean: int, seed: int) -> None:
    """Print a line for the product and for each rival, on the same years."""
    if lacking := missing():
        raise SystemExit(f'{" and ".join(lacking)} not installed: {INSTALL}, and set PYTHONPATH')
    judges = {'the product': looks, **rivals()}
    bar, table = Progress((clean + 2 * years) * len(judges), 'years'), []
    for fault, count in (('clean', clean), ('preload -20 %', years), ('preload -40 %', years)):
        drawn = [axis_year(seed + number, FAULTS[fault]) for number in range(count)]
        for name, judge in judges.items():
            courses = []
            for year in drawn:
                courses.append(score_of(year, judge=judge, causes=judge is looks))
                bar.step()
            table.append(Score.of(Kind(name, fault, {}), courses))
    bar.close()
    print_table(table)


def main() -> None:
    """Draw, assess, and print a line for each kind of years."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--years', type=int, default=2, help='years of each fault')
    parser.add_argument('--clean', type=int, default=4, help='years without a fault')
    parser.add_argument('--seed', type=int, default=1000, help='of the first year')
    parser.add_argument('--rivals', action='store_true', help='beside statsmodels and ruptures')
    parser.add_argument('--figures', action='store_true', help='clean years and steps of 10 %%')
    parser.add_argument('--public', type=Path, help='folder of the public measurements')
    args = parser.parse_args()
    if args.rivals:
        compare(args.years, args.clean, args.seed)
        return
    if args.figures:
        figures(args.years, args.clean, args.seed)
        return
    if args.public is not None:
        print_public(args.public)
        return
    table: list[Score] = []
    wanted = list(kinds(args.years, args.clean))
    bar = Progress(sum(count for _, count in wanted), 'years')
    for kind, count in wanted:
        courses = []
        for number in range(count):
            fault = (FAULTS | LOOSENED)[kind.fault]
            year = axis_year(args.seed + number, fault, **kind.options)
            courses.append(score_of(year, always_free='load' in kind.options))
            bar.step()
        table.append(Score.of(kind, courses))
    bar.close()
    print_table(table)


if __name__ == '__main__':
    main()
