# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Results of the onset study of rolling roughness: a table, and a picture.

Usage: python studies/rolling_onset_report.py [--table studies/results/rolling_onset.csv] [--out
studies/results]. The table goes to standard output.

"""

import argparse
from collections.abc import Sequence
import math
from pathlib import Path
import sys
from typing import TYPE_CHECKING

from rolling_onset import RampRow, STUDY
from surrogate.plotting.style import (
    BLUE,
    draw_picture,
    GREEN,
    GREY,
    new_figure,
    ORANGE,
    PURPLE,
    VERMILION,
)
from surrogate.tasks.table import read_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BASE, RMS, LIMIT = 'base', 0.12e-6, 0.01
WAVES = (
    ('wave 22 um', '22 um', GREY),
    ('wave 15 um', '15 um', ORANGE),
    ('base', '9.8 um', BLUE),
    ('wave 6.5 um', '6.5 um', VERMILION),
    ('wave 4.3 um', '4.3 um', GREEN),
    ('wave 2.9 um, half the nodes', '2.9 um', PURPLE),
)


def main() -> None:
    """Print the table and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        '--table', type=Path, default=Path('studies/results/rolling_onset.csv'), help='its rows'
    )
    parser.add_argument('--out', type=Path, default=Path('studies/results'), help='folder')
    args = parser.parse_args()
    rows = read_table(args.table, RampRow)
    if not any(row.variation == BASE for row in rows):
        sys.exit(f'{args.table}: no rows of the base case; run studies/rolling_onset.py first')
    print(table(rows))
    draw_picture(args.out / 'rolling_onset.png', lambda: picture(rows))


def firsts(rows: Sequence[RampRow]) -> dict[str, RampRow]:
    """Return one row of each variation, in the order of the study."""
    found = {row.variation: row for row in reversed(rows)}
    names = [one.name for one in STUDY]
    return {name: found[name] for name in names if name in found}


def table(rows: Sequence[RampRow]) -> str:
    """Return the onset of each variation as a table of a page."""
    found = firsts(rows)
    base = found[BASE].onset
    lines = [
        '| variation | nodes | onset [mm/s] | over the base | film there [nm] | Lambda | failed |',
        '|---|---|---|---|---|---|---|',
    ]
    for name, row in found.items():
        lines.append(
            f'| {name} | {row.nodes_along} x {row.nodes_across} | {1e3 * row.onset:.0f} '
            f'| {row.onset / base:.2f} | {1e9 * row.onset_film:.0f} '
            f'| {row.onset_film / RMS:.2f} | {row.failed} of {row.steps} |'
        )
    return '\n'.join(lines)


def picture(rows: Sequence[RampRow]) -> 'Figure':
    """Return RCS over the smooth film by shortest wave, and onsets over that of the base."""
    figure = new_figure(11.0, 4.2)
    films, onsets = figure.subplots(1, 2, width_ratios=[3, 2])
    for name, label, colour in WAVES:
        mine = [row for row in rows if row.variation == name]
        if mine:
            films.plot(
                [row.film / RMS for row in mine],
                [max(row.rcs, 1e-5) for row in mine],
                '.-',
                color=colour,
                label=f'waves to {label}',
            )
    films.axhline(LIMIT, color='black', linestyle='--', linewidth=0.8)
    films.text(0.02, 1.15 * LIMIT, 'limit of the zone', transform=films.get_yaxis_transform())
    films.axvspan(0.6, 1.2, color=GREY, alpha=0.2, label='published onsets')
    films.set(
        xscale='log',
        yscale='log',
        xlabel='smooth central film over Rq [-]',
        ylabel='RCS, 1e-5 and less at the foot [-]',
    )
    films.xaxis.set_major_formatter('{x:g}')
    films.xaxis.set_minor_formatter('{x:g}')
    films.legend()
    _draw_onsets(onsets, firsts(rows))
    return figure


def _draw_onsets(axes: 'object', found: dict[str, RampRow]) -> None:
    base = found[BASE].onset
    names = [name for name, row in found.items() if name != BASE and math.isfinite(row.onset)]
    places = range(len(names), 0, -1)
    axes.axvline(1.0, color='black', linewidth=0.8)
    axes.plot([found[name].onset / base for name in names], places, 'o', color=BLUE)
    axes.set_yticks(places, names)
    axes.set(xscale='log', xlabel='onset speed over that of the base [-]')
    axes.xaxis.set_major_formatter('{x:g}')
    axes.set_xticks([0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0], minor=False)
    axes.xaxis.set_minor_formatter('')
    axes.grid(axis='x', alpha=0.4)


if __name__ == '__main__':
    main()
