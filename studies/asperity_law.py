# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The marches of the nominal screw and the asperity law that follows: table, picture, shipped law.

Usage: python studies/asperity_law.py [--workers N]. Marches are kept in
studies/results/asperity_law.csv.store, so that an interrupted study goes on where it stopped. The
law goes to surrogate/data/asperity_law.json.

"""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import json
from pathlib import Path
from typing import Any, TYPE_CHECKING

import numpy as np
from surrogate.asperities.build import build_law, Marched
from surrogate.asperities.law import AsperityLaw, ONSET_RCS, SHIPPED
from surrogate.asperities.marches import inputs_from_json, solve_march, WORK
from surrogate.files import replace_file
from surrogate.parameters import load_lubricant, load_screw
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, VERMILION
from surrogate.tasks.kept import run_kept
from surrogate.tasks.table import write_table
from surrogate.units import GIGA, MICRO, MILLI

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OUT = Path('studies/results/asperity_law.csv')
PICTURE = Path('docs/pictures/asperity_law.png')
LEAST = 1e-5
"""RCS at the foot of the picture [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MarchRow:
    """A mean over a transit of one march [SI], and the onset of the march."""

    march: str
    pressure: float
    viscosity: float
    shortest_wave: float
    rising: int
    onset: float
    ratio: float
    speed: float
    rcs: float
    asperity_share: float
    loss_factor: float
    status: str


def rows_of(name: str, march: Marched) -> list[MarchRow]:
    """Return the rows of a march."""
    given, found = march.given, march.found
    columns = ('speed', 'rcs', 'asperity_share', 'loss_factor')
    return [
        MarchRow(
            march=name,
            pressure=given.strip.max_pressure,
            viscosity=given.oil.viscosity,
            shortest_wave=given.shortest,
            rising=int(given.speeds[0] < given.speeds[1]),
            onset=march.onset,
            ratio=march.ratio,
            status=found['status'],
            **dict(zip(columns, values, strict=True)),
        )
        for values in zip(*(found[column] for column in columns), strict=True)
    ]


def table(marches: Mapping[str, Marched]) -> str:
    """Return the onsets as a table of a page."""
    lines = [
        '| march | pressure [GPa] | viscosity [mPa s] | waves down to [um] | speed | onset [mm/s] '
        '| film over acting rms [-] |',
        '|---|---|---|---|---|---|---|',
    ]
    for name, one in marches.items():
        given = one.given
        lines.append(
            f'| {name} | {GIGA * given.strip.max_pressure:.2f} '
            f'| {MILLI * given.oil.viscosity:.3g} | {MICRO * given.shortest:.3g} '
            f'| {"rises" if given.speeds[0] < given.speeds[1] else "falls"} '
            f'| {MILLI * one.onset:.0f} | {one.ratio:.2f} |'
        )
    return '\n'.join(lines)


def picture(marches: Mapping[str, Marched], law: AsperityLaw) -> 'Figure':
    """Return RCS and rolling loss of all marches over the speed by that of the onset."""
    figure = new_figure(10.0, 4.2)
    contact, loss = figure.subplots(1, 2)
    for name, one in marches.items():
        colour = VERMILION if name.startswith('all') else GREY
        x = np.array(one.found['speed']) / one.onset
        contact.plot(x, np.maximum(one.found['rcs'], LEAST), '.', color=colour)
        loss.plot(x, one.found['loss_factor'], '.', color=colour)
    fine = np.linspace(law.log_speed[0] - 0.4, law.log_speed[-1] + 0.2, 200)
    curves = law.at(fine)
    contact.plot(np.exp(fine), np.maximum(curves['rcs'], LEAST), color=BLUE, label='law')
    loss.plot(np.exp(fine), curves['loss_factor'], color=BLUE, label='law')
    contact.plot([], [], '.', color=GREY, label='marches, longer waves')
    contact.plot([], [], '.', color=VERMILION, label='marches, all waves')
    contact.axhline(ONSET_RCS, color='black', linestyle='--', linewidth=0.8)
    contact.set(yscale='log', ylabel='RCS, 1e-5 and less at the foot [-]')
    loss.set(ylabel='rolling loss over that of the smooth contact [-]', ylim=(0.0, 2.0))
    loss.axhline(1.0, color='black', linewidth=0.8)
    for axes in (contact, loss):
        axes.set(xscale='log', xlabel='speed over that of the onset [-]')
        axes.xaxis.set_major_formatter('{x:g}')
        axes.set_xticks([0.3, 0.5, 1.0, 2.0])
        axes.xaxis.set_minor_formatter('')
    contact.legend()
    return figure


def main() -> None:
    """March what is missing, then write table, picture and law."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workers', type=int, help='processes (default all cores)')
    args = parser.parse_args()
    marches: dict[str, Marched] = {}

    def solve(tasks: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        found = run_kept(OUT, WORK, solve_march, tasks, workers=args.workers, unit='marches')
        for name, one in found.items():
            marches[name] = Marched(given=inputs_from_json(tasks[name]), found=one)
        return {name: found.get(name) for name in tasks}

    law = build_law(load_screw('nominal'), load_lubricant('iso_vg_68'), solve)
    rows: Sequence[MarchRow] = [row for name, one in marches.items() for row in rows_of(name, one)]
    write_table(OUT, MarchRow, rows, digits=6)
    replace_file(SHIPPED, (json.dumps(law.to_json(), indent=1) + '\n').encode())
    print(table(marches))
    draw_picture(PICTURE, lambda: picture(marches, law))


if __name__ == '__main__':
    main()
