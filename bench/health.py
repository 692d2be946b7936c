# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Play axis-years of known truth and print how good the health is that is made of them.

Usage: python bench/health.py [--runs N] [--clean N] [--seed S] [--told]. A year is a draw of
programmes, seasons and of what the model does not know, with one change or none. It is given as
comparable points, day by day, and assessed every four weeks. Two years of each kind are drawn
unless more are asked for: they take minutes. `--told` prints instead how well the onset of contact
is told, and the notes on an axis that is always free of process force. `--logs` writes twenty
short logs of two kinds instead, and checks the first sentence of `ballscrew health` on them.

"""

import argparse
import sys

from ballscrew_monitor.health.assess import compare
from ballscrew_monitor.health.companions import Companions
from health_parts.logs import verdicts
from health_parts.machine import Ground, solve_ground
from health_parts.score import Compare, Score, score
from health_parts.told import note_row, onset_row
from health_parts.years import draw_year, Kind, Truth
import numpy as np
from surrogate.progress import Progress

AIMED_LOSS = 0.10


def compare_with(ground: Ground) -> Compare:
    """Return the comparison with the surfaces of the screw."""
    surface, companions = ground.surfaces[1.0], Companions(ground.surfaces)
    return lambda last, baseline, points: compare(baseline, points, last, surface, companions)


def scores_of(ground: Ground, kind: Kind, seeds: range, progress: Progress) -> list[Score]:
    """Return the scores of years of a kind."""
    found = []
    for seed in seeds:
        found.append(score(draw_year(ground, kind, seed), compare_with(ground)))
        progress.step()
    return found


def row_of(name: str, scores: list[Score]) -> str:
    """Return a row of the table."""
    known = [one for one in scores if not one.problem]
    sizes, drags = (np.array([getattr(one, of) for one in known]) for of in ('size', 'drag'))
    found = np.isfinite(sizes)
    days = sum(one.clean_days for one in known)
    early = sum(one.early_alarms for one in known)
    held = {
        quantity: [one.held[quantity] for one in known if quantity in one.held]
        for quantity in ('drag change', 'preload')
    }
    cells = [
        name,
        f'{len(known)}',
        percent(int(found.sum()), len(known)),
        spread_of(sizes[found]),
        spread_of(drags[np.isfinite(drags)]),
        percent(int((drags[found] <= AIMED_LOSS).sum()), len(known)),
        f'{early} ({1000 * early / days:.2f})' if days else '',
        *(percent(sum(one), len(one)) for one in held.values()),
        percent(sum(one.is_right for one in known), len(known)),
        percent(sum(one.is_named for one in known), len(known)),
        f'{np.mean([len(one.causes) for one in known]):.1f}',
    ]
    return '| ' + ' | '.join(cells) + ' |'


def spread_of(values: np.ndarray) -> str:
    """Return median and ninth decile in percent, nothing of nothing."""
    if not values.size:
        return ''
    return f'{100 * np.median(values):.0f}, {100 * np.quantile(values, 0.9):.0f}'


def percent(part: int, total: int) -> str:
    """Return a share in percent, nothing of nothing."""
    return f'{100 * part / total:.0f} %' if total else ''


HEAD = (
    '| change | years | found | its size when found, median and ninth decile [%] | drag then '
    '[%] | found while the drag is at most 10 % off | alarms before (per 1000 days) | drag '
    'held | preload held | likeliest cause right | named | number named |\n' + '|---' * 12 + '|'
)


ONSET_HEAD = (
    '| change | onset known | holds the truth | lower end above 1 | noted | true, median | '
    'upper over lower end, median |\n' + '|---' * 7 + '|'
)
NOTE_HEAD = (
    '| change | years with a note | before the change | its size then, median |\n'
    + '|---' * 4
    + '|'
)


def print_told(ground: Ground, kinds: list[tuple[Kind, int]], first: int) -> None:
    """Print the tables of the onset and of the notes."""
    for head, row_of_kind in ((ONSET_HEAD, onset_row), (NOTE_HEAD, note_row)):
        print(head)
        for kind, number in kinds:
            print(row_of_kind(ground, kind.truth, _seeds(first, number)), flush=True)


def check_logs() -> int:
    """Print what is said of short logs; return the exit code."""
    found = list(verdicts())
    for one in found:
        print(f'{one.cause}: {"right" if one.is_right else "wrong"}: {one.sentence}')
    return 0 if all(one.is_right for one in found) else 1


def main() -> int:
    """Draw, assess and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0].strip())
    parser.add_argument('--runs', type=int, default=2, help='years of each change')
    parser.add_argument('--clean', type=int, default=2, help='years without a change')
    parser.add_argument('--seed', type=int, default=1000, help='the first one')
    parser.add_argument('--told', action='store_true', help='tables of the onset and of notes')
    parser.add_argument('--logs', action='store_true', help='check the sentences on short logs')
    asked = parser.parse_args()
    if asked.logs:
        return check_logs()
    ground = solve_ground()
    kinds = [(Kind(truth=truth), asked.runs) for truth in Truth if truth.value]
    kinds = [(Kind(truth=Truth.NOTHING), asked.clean), *kinds]
    if asked.told:
        print_told(ground, kinds, asked.seed)
        return 0
    progress = Progress(sum(number for _, number in kinds), 'years')
    print(HEAD)
    for kind, number in kinds:
        scores = scores_of(ground, kind, _seeds(asked.seed, number), progress)
        print(row_of(kind.truth.name, scores), flush=True)
    return 0


def _seeds(first: int, number: int) -> range:
    return range(first, first + number)


if __name__ == '__main__':
    sys.exit(main())
