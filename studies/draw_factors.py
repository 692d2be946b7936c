# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What weighting the draws by the factor of their patch gains.

Run `python studies/draw_factors.py [--draws 128] [--out DIR]`: solves draws of the nominal screw
at preload and 40 degC at four speeds, prints the mean RCS of the first sixteen, plain and
weighted, with their standard errors, and that of all; then, over all groups of sixteen, how far
the means of a group are from that of all and what their standard errors say. Draws RCS over the
factor. Takes minutes.

"""

import argparse
from collections.abc import Mapping
import math
from pathlib import Path
import sys
from typing import Any

import numpy as np
from surrogate.builder.full.chain import chain_inputs, solve_chain
from surrogate.builder.full.draws import draws_of, POWER, weighted_mean, WeightedDraws
from surrogate.parameters import load_lubricant, load_screw
from surrogate.plotting.style import new_figure, save, styled
from surrogate.tasks.kept import run_kept
from surrogate.units import RPM

WORK = 'studies/draw_factors.py 1'
"""Solver and version of the kept results."""
FEW = 16
SPEEDS = (24.0, 17.0, 11.0, 7.0)
"""Speeds from the end of contact down [rev/min]."""


def rcs_of(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return RCS of a draw at all speeds [-], NaN where it does not converge."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    speeds = [rpm * RPM for rpm in SPEEDS]
    chain = solve_chain(
        chain_inputs(screw, oil, 0.0, oil.reference_temperature, inputs['draw'], speeds)
    )
    return {'rcs': [row['rcs'] if row['converged'] else math.nan for row in chain['opposing']]}


def summary(rcs: np.ndarray, draws: WeightedDraws) -> tuple[float, float]:
    """Return the mean over the first draws and its standard error [-]."""
    known = rcs[: draws.count]
    weights = draws.weights(known, 0.0)
    return float(weighted_mean(known, weights)), float(draws.standard_error(known, weights))


def group_errors(rcs: np.ndarray, every: WeightedDraws, kind: str) -> tuple[float, float]:
    """
    Return how far means of groups of draws are from that of all, and what they state [-].

    Root mean squares; a group is part of all, which brings it nearer to their mean.

    """
    starts = range(0, every.count - FEW + 1, FEW)
    whole, _ = summary(rcs, every)
    groups = np.split(np.resize(rcs, FEW * len(starts)), len(starts))
    told = [summary(one, group(every, start, kind)) for start, one in zip(starts, groups)]
    means, errors = np.array(told).T
    nearer = math.sqrt(1 - FEW / every.count)
    return float(np.sqrt(np.mean((means - whole) ** 2))) / nearer, float(
        np.sqrt(np.mean(errors**2))
    )


def group(every: WeightedDraws, start: int, kind: str) -> WeightedDraws:
    """Return sixteen of all draws, weighted or plain."""
    if kind == 'plain':
        return WeightedDraws(FEW)
    own = slice(start, start + FEW)
    return WeightedDraws(FEW, 0.0, every.powers[own], every.mean)


@styled
def draw_figure(rcs: np.ndarray, factors: np.ndarray, path: Path) -> None:
    """Draw RCS of every draw over the factor of its patch."""
    figure = new_figure(7, 4.5)
    axes = figure.subplots()
    for rpm, column, colour in zip(SPEEDS, rcs.T, ('C0', 'C1', 'C2', 'C3'), strict=True):
        axes.semilogy(factors[:FEW], column[:FEW], 'o', c=colour, ms=5, label=f'{rpm:g} rev/min')
        axes.semilogy(factors[FEW:], column[FEW:], 'o', c=colour, ms=3, mfc='none', alpha=0.6)
    axes.axhline(0.01, color='0.4', ls='--', label='limit of the optimal zone')
    marks = (
        (factors[:FEW].mean(), ':', f'mean of draws 0 to {FEW - 1}'),
        (factors.mean(), '-', f'mean of {len(factors)} draws'),
    )
    for place, style, label in marks:
        axes.axvline(place, color='0.6', ls=style, label=label)
    axes.set(
        xlabel='factor by which the patch of a draw is rescaled [-]',
        ylabel='RCS [-]',
        title='Nominal screw at preload, 40 degC: draws 0 to 15 full, others hollow',
        ylim=(1e-5, 1.0),
    )
    axes.grid(visible=True, which='both')
    axes.legend(loc='lower right')
    save(figure, path)


def main() -> None:
    """Solve, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--draws', type=int, default=128)
    parser.add_argument('--workers', type=int, default=2)
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    if args.draws < FEW:
        parser.error(f'--draws is {args.draws}, allowed is {FEW} or more')
    screw = load_screw('nominal')
    inputs = {f'draw {draw}': {'draw': draw} for draw in range(args.draws)}
    done = run_kept(
        args.out / 'draw_factors', WORK, rcs_of, inputs, workers=args.workers, unit='draws'
    )
    rcs = np.array([done[name]['rcs'] for name in inputs])
    few, every = draws_of(screw, FEW), draws_of(screw, args.draws)
    powers = np.array(every.powers[: args.draws])
    print('rev/min  correlation  plain 16         weighted 16      plain all        weighted all')
    for rpm, column in zip(SPEEDS, rcs.T, strict=True):
        known = np.isfinite(column)
        alike = float(np.corrcoef(powers[known], column[known])[0, 1])
        cases = (WeightedDraws(FEW), few, WeightedDraws(args.draws), every)
        told = (summary(column, draws) for draws in cases)
        texts = (f'{mean:.4f} +- {error:.4f}' for mean, error in told)
        print(f'{rpm:7g}  {alike:11.2f}  {"  ".join(texts)}', flush=True)
    if args.draws > FEW:
        print(f'rev/min  off the mean of all, and stated: groups of {FEW}, plain, weighted')
        for rpm, column in zip(SPEEDS, rcs.T, strict=True):
            told = (group_errors(column, every, kind) for kind in ('plain', 'weighted'))
            texts = (f'{off:.4f}, {error:.4f}' for off, error in told)
            print(f'{rpm:7g}  {"    ".join(texts)}', flush=True)
    draw_figure(rcs, powers ** (1 / POWER), args.out / 'draw_factors.png')


if __name__ == '__main__':
    sys.exit(main())
