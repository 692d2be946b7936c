# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The onset of contact over the shortest wave, where summits yield and where they do not.

Usage: python studies/wave_convergence.py [--only NAME ...] [--report].

Marches the 20x5 strip of topography_onset.py with ever shorter waves under a falling speed, on
three draws. Each march that ends is added to results/wave_convergence.csv at once, and one that
is there is not marched again. Last it prints the table that docs/theory/raceway.md sums up.

"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
import math
from pathlib import Path

import numpy as np
from surrogate.asperities.law import ONSET_RCS
from surrogate.ehl.moving import MarchSettings, ramp_strip, SpeedRamp
from surrogate.tasks.table import read_table, write_table
from topography_onset import ALONG, Strip, strip_of

RESULTS = Path('studies/results/wave_convergence.csv')
WAVES = 2.89, 1.93, 1.285
"""Shortest waves [um], each two thirds of the one before."""
RATE = 0.2
"""Fall of the logarithm of the speed in a transit [-], as in the marches of the law."""
PART, TURN = 0.25, 2.0
"""Transits of a mean that is kept, and those in which the tile comes round once [-]."""
STRIP = {
    'role': '',
    'screw': '20x5',
    'oil': 'iso_vg_32',
    'temperature_degC': '45.0',
    'pressure_share': '1.0',
    'fractal_dimension': '2.68',
    'lay': 'isotropic',
    'cutoff_long_mm': '0.25',
    'cut_load': '1.0',
    'floor_nm': '3.0',
    'onset_mm_s': 'nan',
}
"""The row of the 20x5 strip in the table of topography_onset.py, less what is varied here."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """A march: draw, cutting pressure [GPa] or '', shortest wave [um], speeds [m/s]."""

    draw: int
    cut_GPa: str
    shortest_um: float
    first: float
    last: float

    @property
    def name(self) -> str:
        """Name of the march in the table."""
        state = f'cut {self.cut_GPa} GPa' if self.cut_GPa else 'elastic'
        speeds = f'{self.first:g} to {self.last:g} m/s'
        return f'draw {self.draw}, {state}, {self.shortest_um:g} um, {speeds}'

    @property
    def strip(self) -> Strip:
        """Return the strip with its tile."""
        varied = {
            'march': self.name,
            'draw': f'{self.draw}',
            'cut_GPa': self.cut_GPa,
            'shortest_um': f'{self.shortest_um}',
        }
        return strip_of(STRIP | varied)


def series(draw: int, cut: str, first: float, last: float, waves: int = 3) -> list[Case]:
    """Return the marches of one tile with ever shorter waves, at the same speeds [m/s]."""
    return [
        Case(draw=draw, cut_GPa=cut, shortest_um=wave, first=first, last=last)
        for wave in WAVES[:waves]
    ]


CASES = (
    *series(1, '7', 2.0, 0.55, waves=2),
    *series(2, '7', 2.0, 0.55),
    *series(3, '7', 2.0, 0.55),
    *series(1, '7', 1.7, 0.65),
    *series(1, '', 2.8, 1.15),
    *series(1, '3', 0.8, 0.2, waves=2),
)
"""All marches. At other speeds another part of the tile meets the onset, so that only marches at
the same speeds tell what the waves do."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """
    Means over a quarter of a transit of a march.

    Speed [m/s], smooth central film [nm], RCS, asperity share and rolling loss over that of the
    smooth contact [-]; nodes, status, steps and wall time [s] of the march.

    """

    march: str
    speed: float
    film_nm: float
    rcs: float
    asperity_share: float
    loss_factor: float
    nodes_along: int
    nodes_across: int
    status: str
    steps: int
    failed: int
    seconds: float


def march(case: Case) -> list[Part]:
    """March a case; return its means."""
    one = case.strip
    nx = 2 * math.ceil(0.5 * ALONG * 5.2 * one.strip.semi_axis / one.shortest) + 1
    settings = MarchSettings(nx=nx, places=1, film_floor=one.film_floor)
    transits = math.log(case.first / case.last) / RATE
    speeds = case.first, case.last
    ramp = ramp_strip(
        one.strip, one.oil, speeds, one.tile.height_at, transits=transits, settings=settings
    )
    return parts(case, ramp, (nx, one.strip.columns))


def parts(case: Case, ramp: SpeedRamp, nodes: tuple[int, int]) -> list[Part]:
    """Return the means of a march."""
    names = 'rcs', 'asperity_share', 'loss_factor'
    means = [ramp.means(PART, name) for name in names]
    return [
        Part(
            march=case.name,
            speed=float(speed),
            film_nm=1e9 * ramp.film_at(speed),
            **dict(zip(names, map(float, row), strict=True)),
            nodes_along=nodes[0],
            nodes_across=nodes[1],
            status=ramp.status.name,
            steps=ramp.steps,
            failed=ramp.steps_failed,
            seconds=ramp.wall_time,
        )
        for speed, *row in zip(means[0][0], *(mean for _, mean in means), strict=True)
    ]


def means_of_a_turn(rows: Sequence[Part]) -> tuple[np.ndarray, np.ndarray]:
    """Return logarithms of the speed [m/s] and RCS [-], each the mean over a turn of the tile."""
    weights = np.full(round(TURN / PART), PART / TURN)
    logs, rcs = np.log([row.speed for row in rows]), [row.rcs for row in rows]
    return np.convolve(logs, weights, 'valid'), np.convolve(rcs, weights, 'valid')


def onset(rows: Sequence[Part]) -> float:
    """Return the speed at which the mean over a turn last rises past 0.01 [m/s], or NaN."""
    logs, rcs = means_of_a_turn(rows)
    passed = np.flatnonzero((rcs[:-1] < ONSET_RCS) & (rcs[1:] >= ONSET_RCS))
    if not passed.size:
        return math.nan
    low, high = passed[-1], passed[-1] + 1
    ends = np.log(np.maximum(rcs[[low, high]], 1e-9))
    return math.exp(np.interp(math.log(ONSET_RCS), ends, logs[[low, high]]))


def longer_than(wave: float) -> float:
    """Return the next longer wave [um], itself for the longest."""
    return WAVES[max(WAVES.index(wave) - 1, 0)]


def report(rows: Sequence[Part]) -> list[str]:
    """Return the table of the onsets, each over that with the next longer waves."""
    lines = [
        '| march | nodes | onset [mm/s] | over the wave before | failed |',
        '|---|---|---|---|---|',
    ]
    onsets: dict[Case, float] = {}
    for case in CASES:
        parts_of = [row for row in rows if row.march == case.name]
        if not parts_of:
            continue
        found, one = onset(parts_of), parts_of[0]
        before = onsets.get(replace(case, shortest_um=longer_than(case.shortest_um)), math.nan)
        ratio = '' if math.isnan(before) else f'{found / before:.2f}'
        lines.append(
            f'| {case.name} | {one.nodes_along} x {one.nodes_across} | {1e3 * found:.0f} '
            f'| {ratio} | {one.failed} of {one.steps} |'
        )
        onsets[case] = found
    return lines


def main() -> None:
    """March what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--only', nargs='*', metavar='NAME', help='marches by their names')
    parser.add_argument('--report', action='store_true', help='march nothing')
    args = parser.parse_args()
    for case in CASES:
        rows = read_table(RESULTS, Part)
        missing = case.name not in {row.march for row in rows}
        if missing and not args.report and (not args.only or case.name in args.only):
            write_table(RESULTS, Part, [*rows, *march(case)], digits=6)
    print('\n'.join(report(read_table(RESULTS, Part))))


if __name__ == '__main__':
    main()
