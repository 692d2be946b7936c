# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What the half grid says of the fine one: RCS of the same draws on both, over speed.

Run `python bench/half_grid.py [--load-N F] [--draws K] [--workers N]`: nominal screw, ISO VG 68,
40 degC. Prints mean, deviation and correlation over draws on both grids, how much faster the half
grid is, and the error, over the one aimed at, with which the mean on the fine grid is found from
the neighbouring speeds: by a monotone cubic, and by what the fine grid changes there.

"""

import argparse
import math

import numpy as np
from scipy.interpolate import PchipInterpolator
from surrogate.full.chain import chain_inputs, FINE, HALF
from surrogate.full.run import ChainRun
from surrogate.parameters import load_lubricant, load_screw
from surrogate.surface_check import RCS_RELATIVE_TOLERANCE, RCS_TOLERANCE
from surrogate.tasks.workers import open_pool, usable_cores

RPM = (40.0, 25.0, 18.0, 14.0, 11.0, 8.0, 6.0, 4.5)
TEMPERATURE = 313.15


def solve(load, draws, workers):
    """Return RCS [grid, speed, draw] from the slowest speed on, and seconds by grid."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    speeds = [rpm * math.pi / 30 for rpm in RPM]
    found, seconds = [], []
    with open_pool(workers) as pool:
        for grid in (FINE, HALF):
            run = ChainRun(pool=pool)
            chains = {
                str(draw): chain_inputs(screw, oil, load, TEMPERATURE, draw, speeds, grid=grid)
                for draw in range(draws)
            }
            results = run(f'{grid} grid', chains)
            found.append(
                [[record['rcs'] for record in results[name]['opposing']] for name in chains]
            )
            seconds.append(run.seconds)
    return np.array(found).transpose(0, 2, 1)[:, ::-1], seconds


def left_out(s, fine, half, i):
    """Return the mean at a speed from those beside it: by a cubic, and with the half grid."""
    rest = np.delete(np.arange(len(s)), i)
    cubic = float(PchipInterpolator(s[rest], fine[rest])(s[i]))
    change = np.divide(fine, half, out=np.ones_like(fine), where=half > 0)
    return cubic, half[i] * np.interp(s[i], s[[i - 1, i + 1]], change[[i - 1, i + 1]])


def main():
    """Solve and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--load-N', type=float, default=0.0)
    parser.add_argument('--draws', type=int, default=16)
    parser.add_argument('--workers', type=int, default=usable_cores())
    args = parser.parse_args()
    both, seconds = solve(args.load_N, args.draws, args.workers)
    rpm = np.array(RPM[::-1])
    fine, half = both.mean(axis=-1)
    print(f'{args.draws} draws, {args.load_N:g} N; fine over half grid: ', end='')
    print(f'{seconds[0] / seconds[1]:.1f} times the seconds')
    print('rev/min  RCS fine  deviation  RCS half  deviation  correlation  cubic  half grid')
    for i, speed in enumerate(rpm):
        spread = both[:, i].std(axis=-1, ddof=1)
        alike = np.corrcoef(both[:, i])[0, 1] if spread.all() else math.nan
        errors = (math.nan, math.nan)
        if 0 < i < len(rpm) - 1:
            allowed = max(RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE * fine[i])
            errors = [(one - fine[i]) / allowed for one in left_out(np.log(rpm), fine, half, i)]
        print(
            f'{speed:7.1f} {fine[i]:9.4f} {spread[0]:10.4f} {half[i]:9.4f} {spread[1]:10.4f} '
            f'{alike:12.3f} {errors[0]:6.2f} {errors[1]:10.2f}'
        )


if __name__ == '__main__':
    main()
