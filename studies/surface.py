# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cost of a full-tier surface against the accuracy asked for, and the error that was reached.

Run `python studies/surface.py [--workers N] [--draws K] [--out DIR] [--accuracy A ...]`: nominal
screw, ISO VG 68, 39 to 41 degC, which is one solved temperature, full range of speed and load.
Prints nodes, solved points, processor time of the workers, wall time, how busy the workers were,
and the errors at held-out points, the largest also over what an accuracy of 1 allows. Each
accuracy takes minutes, so its row is kept in DIR/surface_cost.csv as soon as it is known, in place
of the one of the same accuracy and draws; the picture of cost against error shows all rows.

"""

import argparse
from dataclasses import astuple, dataclass, replace
from pathlib import Path
import time

import numpy as np
from surrogate.builder.full.build import build_full
from surrogate.builder.full.run import ChainRun
from surrogate.builder.full.settings import default_full_settings
from surrogate.parameters import load_lubricant, load_screw
from surrogate.plotting.style import new_figure, save, styled
from surrogate.surface import Surface
from surrogate.tasks.table import read_table, write_table
from surrogate.tasks.workers import open_pool, usable_cores

ACCURACIES = (8.0, 2.0)
TEMPERATURES = (312.15, 314.15)
"""Temperature range [K] that is narrow enough for one solved temperature."""


@dataclass(frozen=True)
class Cost:
    """One surface: what was asked for, what it took, what it reached."""

    accuracy: float
    draws: int
    nodes: int
    points: int
    seconds: float
    wall: float
    torque_error: float
    rcs_error: float
    reached: float


def measure(accuracy, workers, draws):
    """Build one surface and return its cost."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    settings = replace(
        default_full_settings(screw),
        temperature_range=TEMPERATURES,
        draws=draws,
        accuracy=accuracy,
    )
    with open_pool(workers) as pool:
        run, began = ChainRun(pool=pool), time.perf_counter()
        data = build_full(screw, oil, settings, run)
        wall = time.perf_counter() - began
    errors = Surface(data).errors
    return Cost(
        accuracy=accuracy,
        draws=draws,
        nodes=int((~data.mask).sum()),
        points=run.points,
        seconds=run.seconds,
        wall=wall,
        torque_error=errors['friction_torque'][0],
        rcs_error=errors['rcs'][0],
        reached=(data.header['reached'] or np.nan) * accuracy,
    )


def keep(cost, path):
    """Write the rows of a file with `cost` in place of that of its accuracy and draws."""
    same = (cost.accuracy, cost.draws)
    costs = [one for one in kept(path) if (one.accuracy, one.draws) != same] + [cost]
    write_table(path, Cost, sorted(costs, key=astuple, reverse=True))


def kept(path):
    """Return the rows of a file, none where there is none."""
    return read_table(path, Cost)


@styled
def draw(costs, path):
    """Draw the error over the worker time."""
    figure = new_figure(7, 3.6)
    axes = figure.subplots()
    minutes = np.array([cost.seconds for cost in costs]) / 60
    axes.semilogy(minutes, [cost.reached for cost in costs], 'o', label='reached')
    axes.semilogy(minutes, [cost.accuracy for cost in costs], 'k_', ms=14, label='asked for')
    axes.axhline(1, color='0.4', linestyle=':', label='0.003 in efficiency, 0.003 or 5 % in RCS')
    for place, which in enumerate(np.argsort(minutes)):
        axes.annotate(
            f'{costs[which].draws} draws, {costs[which].points} points, '
            f'{costs[which].wall / 60:.0f} min',
            (minutes[which], costs[which].reached),
            (6, -14 if place % 2 else 6),
            textcoords='offset points',
            fontsize=8,
        )
    axes.set(
        xlabel='processor time of the workers [min]',
        ylabel='largest error over the allowed one [-]',
        title='Full tier, nominal screw, one temperature: cost and error',
    )
    axes.margins(y=0.25)
    axes.set_xlim(0, 1.5 * minutes.max())
    axes.grid(visible=True, which='both')
    axes.legend()
    save(figure, path)


def main():
    """Build, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workers', type=int, default=usable_cores())
    parser.add_argument('--draws', type=int, default=2)
    parser.add_argument('--accuracy', type=float, nargs='+', default=ACCURACIES)
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    print(
        'accuracy  nodes  points  worker s  wall s  busy  torque error [N m]  RCS error  reached'
    )
    table = args.out / 'surface_cost.csv'
    for accuracy in args.accuracy:
        cost = measure(accuracy, args.workers, args.draws)
        keep(cost, table)
        print(
            f'{accuracy:8.1f} {cost.nodes:6d} {cost.points:7d} {cost.seconds:9.0f} '
            f'{cost.wall:7.0f} {cost.seconds / cost.wall / args.workers:5.2f} '
            f'{cost.torque_error:19.2g} {cost.rcs_error:10.2g} {cost.reached:8.2g}',
            flush=True,
        )
    draw(kept(table), args.out / 'surface_cost.png')


if __name__ == '__main__':
    main()
