# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cost of a full-tier surface against its error: what the shipped one would be with fewer nodes.

Run `python studies/surface_nodes.py [FILE] [--out DIR]`: leaves out every second or third node
along speed or load, compares with all of them at random points, and prints the points that a
builder would have solved with the 95th percentile and the largest of the errors, over 0.003 in
efficiency and 0.003 or 5 % in RCS. No contact is solved; it takes a minute.

"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
import math
from pathlib import Path
import random
import sys

import numpy as np
from surrogate.builder.full.columns import Columns
from surrogate.builder.full.finer import with_nodes
from surrogate.builder.full.settings import default_full_settings, error_target
from surrogate.builder.full.speed_nodes import NodeSample
from surrogate.builder.full.temperatures import solved_temperatures
from surrogate.builder.tiers import screw_and_oil
from surrogate.plotting.style import new_figure, save, styled
from surrogate.surface import find_surface, Surface
from surrogate.surface.file import read, SurfaceData
from surrogate.surface.point import Validity

STEPS = (1, 2, 3)
POINTS = 4000


@dataclass(frozen=True)
class Thinned:
    """A surface with fewer nodes: nodes along speed and load, solved points, errors [-]."""

    speeds: int
    loads: int
    points: int
    usual: float
    largest: float


def thin(data: SurfaceData, speed_step: int, load_step: int) -> SurfaceData:
    """Keep every n-th speed and load of either sign, the ends and the breaks."""
    s = kept(len(data.speed_coordinate), speed_step, ())
    fixed = np.flatnonzero(np.isin(data.load, data.header['load_breaks']))
    zero = int(np.argmin(np.abs(data.load)))
    side = kept(len(data.load) - zero, load_step, [j - zero for j in fixed if j >= zero])
    return with_nodes(data, s, np.union1d(zero + side, zero - side))


def kept(count: int, step: int, fixed: Sequence[int]) -> np.ndarray:
    """Return every n-th of `count` places, with the last one and those that are `fixed`."""
    return np.union1d(np.arange(0, count, step), [*fixed, count - 1]).astype(int)


def solved_points(data: SurfaceData) -> int:
    """Count the points in the chains of the nodes."""
    screw, oil = screw_and_oil(data.header['inputs'])
    settings = data.header['settings']
    solved = solved_temperatures(oil, tuple(settings['temperature_range']))
    columns = Columns(
        screw=screw,
        lubricant=oil,
        load=data.load,
        temperature=solved,
        speed_range=tuple(settings['speed_range']),
        draws=settings['draws'],
        shared_draws=settings['shared_draws'],
        log_onset=data.log_onset[:, np.isin(data.temperature, solved)],
    )
    return sum(len(chain['speeds']) for chain in columns.chains(data.speed_coordinate).values())


def compare(whole: Surface, data: SurfaceData) -> list[float]:
    """Return the errors of a thinned surface over the allowed ones at random points [-]."""
    fewer, drawn, found = Surface(data), random.Random(1), []
    screw, _ = screw_and_oil(data.header['inputs'])
    target = error_target(screw, default_full_settings(screw))
    slow, fast = whole.speed_range
    for _ in range(POINTS):
        point = (
            math.exp(drawn.uniform(math.log(slow), math.log(fast))),
            drawn.uniform(*whole.load_range),
            drawn.uniform(*whole.temperature_range),
        )
        here, there = fewer.lookup(*point), whole.lookup(*point)
        if here.validity is there.validity is Validity.VALID:
            ideal = max(target.ideal_torque, abs(point[1]) * screw.lead / (2 * math.pi))
            samples = (NodeSample(one.friction_torque, one.rcs) for one in (here, there))
            found.append(replace(target, ideal_torque=ideal).worst(*samples))
    return found


@styled
def draw(rows: list[Thinned], path: Path) -> None:
    """Draw the errors over the solved points."""
    figure = new_figure(7, 4)
    axes = figure.subplots()
    points = [row.points for row in rows]
    axes.semilogy(points, [row.largest for row in rows], 's', label='largest of 4000 points')
    axes.semilogy(points, [row.usual for row in rows], 'o', label='95 % of 4000 points')
    axes.axhline(1, color='0.4', ls=':', label='0.003 in efficiency, 0.003 or 5 % in RCS')
    for row in rows:
        label = f'{row.speeds} x {row.loads}'
        axes.annotate(label, (row.points, row.usual), (4, -10), textcoords='offset points', size=7)
    axes.set(
        xlabel='points solved for the nodes (16 draws around the onset)',
        ylabel='difference from all nodes, over the allowed [-]',
        title='Shipped surface with fewer nodes along speed x load (of either sign)',
    )
    axes.grid(visible=True, which='both')
    axes.set_ylim(0.3, None)
    axes.set_xlim(None, 1.08 * max(points))
    axes.legend(loc='lower left')
    save(figure, path)


def main() -> None:
    """Thin, compare, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('file', nargs='?', default='full')
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    data = read(find_surface(args.file))
    whole, rows = Surface(data), []
    print(f'all: {solved_points(data)} points')
    print('speeds  loads  points  95 %  largest')
    for speed_step, load_step in ((a, b) for a in STEPS for b in STEPS if a * b > 1):
        less = thin(data, speed_step, load_step)
        wrong = np.array(compare(whole, less))
        rows.append(
            Thinned(
                len(less.speed_coordinate),
                len(less.load),
                solved_points(less),
                float(np.quantile(wrong, 0.95)),
                float(wrong.max()),
            )
        )
        row = rows[-1]
        print(
            f'{row.speeds:6d} {row.loads:6d} {row.points:7d} {row.usual:5.2f} {row.largest:8.1f}',
            flush=True,
        )
    draw(rows, args.out / 'surface_nodes.png')


if __name__ == '__main__':
    sys.exit(main())
