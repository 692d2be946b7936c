# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of one marched strip over start of the tile, range and fall of the speed, and reading.

Usage: python studies/marched_again.py STRIP [--starts N] [--speeds FIRST LAST] [--transits N], or
python studies/marched_again.py STRIP --standing SPEED ...; speeds in m/s.

Marches a strip of asperity_marches.csv again, from N places of its tile, and adds what it found to
results/marched_again.csv. A standing speed is marched over two turns of the tile.

"""

import argparse
import csv
from dataclasses import dataclass
import math
from pathlib import Path

import numpy as np
from surrogate.asperities.law import ONSET_RCS
from surrogate.ehl.moving import march_strip, MarchSettings, ramp_strip, SpeedRamp
from surrogate.tasks.table import read_table, write_table
from topography_onset import ALONG, Strip, strip_of, TRANSITS, TURN
from topography_onset import RESULTS as MARCHES

RESULTS = Path('studies/results/marched_again.csv')


@dataclass(frozen=True, kw_only=True, slots=True)
class Again:
    """
    A march of a strip: place of the tile at the start over its length [-], speeds [m/s], transits.

    Onset in the table [m/s], by means over a turn one after the other as `SpeedRamp.onset` reads
    it, and by running means over a turn, NaN where there is none; mean RCS of a standing speed
    [-]; status, steps, those that did not converge and wall time [s].

    """

    march: str
    start: float
    first: float
    last: float
    transits: float
    table: float
    onset: float = math.nan
    onset_running: float = math.nan
    rcs: float = math.nan
    status: str
    steps: int
    failed: int
    seconds: float


def settings_of(one: Strip) -> MarchSettings:
    """Return the settings of the marches of the table."""
    nx = 2 * math.ceil(0.5 * ALONG * 5.2 * one.strip.semi_axis / one.shortest) + 1
    return MarchSettings(nx=nx, places=1, film_floor=one.film_floor)


def fall(one: Strip, start: float, speeds: tuple[float, float], transits: float) -> Again:
    """March a strip from a share of its tile on [-] while its speed falls [m/s]."""
    way = start * one.tile.length

    def raceway(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return one.tile.height_at(x + way, y)

    ramp = ramp_strip(
        one.strip, one.oil, speeds, raceway, transits=transits, settings=settings_of(one)
    )
    return Again(
        march=one.name,
        start=start,
        first=speeds[0],
        last=speeds[1],
        transits=transits,
        table=one.onset,
        onset=ramp.onset(transits=TURN),
        onset_running=running_onset(ramp),
        status=ramp.status.name,
        steps=ramp.steps,
        failed=ramp.steps_failed,
        seconds=ramp.wall_time,
    )


def running_onset(ramp: SpeedRamp) -> float:
    """Return the middle of the speeds at which running means first and last pass 0.01 [m/s]."""
    count = round(TURN * ramp.transit)
    weights = np.full(count, 1 / count)
    logs, rcs = (np.convolve(v, weights, 'valid') for v in (np.log(ramp.speeds), ramp.rcs))
    over = rcs >= ONSET_RCS
    if over[0] or not over[-1]:
        return math.nan
    first, last = int(np.argmax(over)), len(over) - int(np.argmax(~over[::-1]))
    return math.exp(0.5 * (logs[first] + logs[last]))


def stand(one: Strip, speed: float) -> Again:
    """March a strip over two turns at one speed [m/s]."""
    found = march_strip(
        one.strip, one.oil, speed, one.tile.height_at, transits=2 * TURN, settings=settings_of(one)
    )
    return Again(
        march=one.name,
        start=0.0,
        first=speed,
        last=speed,
        transits=2 * TURN,
        table=one.onset,
        rcs=found.rcs.value,
        status=found.status.name,
        steps=found.steps,
        failed=found.steps_failed,
        seconds=found.wall_time,
    )


def summary(rows: list[Again]) -> str:
    """Return mean and range of the onsets of one strip."""
    lines = []
    for name in ('onset', 'onset_running'):
        found = 1e3 * np.array([getattr(row, name) for row in rows])
        mean = math.exp(np.log(found).mean())
        lines.append(f'{name} {mean:.0f} mm/s, {found.min():.0f} to {found.max():.0f}')
    return f'{rows[0].march}, table {1e3 * rows[0].table:.0f} mm/s: ' + '; '.join(lines)


def main() -> None:
    """March a strip, keep the marches and print what they found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('strip')
    parser.add_argument('--starts', type=int, default=1, metavar='N')
    parser.add_argument('--speeds', type=float, nargs=2, metavar=('FIRST', 'LAST'))
    parser.add_argument('--transits', type=float, default=TRANSITS, metavar='N')
    parser.add_argument('--standing', type=float, nargs='+', metavar='SPEED')
    args = parser.parse_args()
    with MARCHES.open(encoding='utf-8', newline='') as file:
        one = strip_of(next(row for row in csv.DictReader(file) if row['march'] == args.strip))
    if args.standing:
        found = [stand(one, speed) for speed in args.standing]
        print(*(f'{row.march}, {row.first:g} m/s: RCS {row.rcs:.4f}' for row in found), sep='\n')
    else:
        speeds = tuple(args.speeds or (2.2 * one.onset, 0.2 * one.onset))
        starts = (k / args.starts for k in range(args.starts))
        found = [fall(one, start, speeds, args.transits) for start in starts]
        print(summary(found))
    write_table(RESULTS, Again, [*read_table(RESULTS, Again), *found], digits=5)


if __name__ == '__main__':
    main()
