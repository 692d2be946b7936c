# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Figures and table of the onset study, from the rows that studies/onset.py kept.

Usage: python studies/onset_report.py [studies/results/onset.csv] [--out DIR]. The onset speed of
an ensemble is where its mean RCS reaches 1 %; its error is the standard deviation of 400 resamples
of the draws. The equivalent floor is that with which the base case begins at the same speed.

"""

import argparse
import csv
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas.film import central_film_hamrock_dowson_1977, groups
from surrogate.formulas.geometry import screw_contact
from surrogate.parameters import load_lubricant, load_screw
from surrogate.plotting.style import BLUE, new_figure, PURPLE, save, styled

Array = NDArray[np.float64]
LIMIT = 0.01
"""RCS at the onset [-]."""
FLOORS = {'floor 1 nm': 1.0, 'base': 3.0, 'floor 10 nm': 10.0}
"""Variations that change the floor alone, and their floors [nm]."""
RESAMPLES = 400


def read_rows(path: Path) -> dict[str, dict[int, dict[float, float]]]:
    """Return RCS by variation, draw and speed; NaN where a solve did not converge."""
    table: dict[str, dict[int, dict[float, float]]] = {}
    with path.open(newline='') as file:
        for row in csv.DictReader(file):
            rcs = float(row['rcs']) if row['status'] == 'CONVERGED' else math.nan
            draws = table.setdefault(row['variation'], {})
            draws.setdefault(int(row['draw']), {})[float(row['speed'])] = rcs
    return table


def as_arrays(draws: dict[int, dict[float, float]]) -> tuple[Array, Array]:
    """Return speeds [m/s], falling, and RCS [draw, speed] of the draws that have all speeds."""
    draws = whole_draws(draws)
    whole = list(draws.values())
    speeds = np.array(sorted(whole[0], reverse=True))
    return speeds, np.array([[row[speed] for speed in speeds] for row in whole])


def whole_draws(draws: dict[int, dict[float, float]]) -> dict[int, dict[float, float]]:
    """Return the draws that converged at every speed: a mean over fewer would jump."""
    most = max(len(row) for row in draws.values())
    return {
        draw: row
        for draw, row in draws.items()
        if len(row) == most and all(math.isfinite(rcs) for rcs in row.values())
    }


def onset(speeds: Array, mean: Array) -> float:
    """Return the fastest speed [m/s] at which `mean` reaches the limit, by log interpolation."""
    above = np.flatnonzero(mean >= LIMIT)
    if not above.size or above[0] == 0:
        return math.nan
    i = above[0]
    low, high = np.log(np.maximum(mean[[i - 1, i]], 1e-6))
    part = (math.log(LIMIT) - low) / (high - low)
    return float(speeds[i - 1] * (speeds[i] / speeds[i - 1]) ** part)


def onset_with_error(speeds: Array, rcs: Array) -> tuple[float, float]:
    """Return the onset of the ensemble mean [m/s] and its standard error as a factor [-]."""
    drawn = np.random.default_rng(0)
    samples = [
        onset(speeds, np.nanmean(rcs[drawn.integers(0, len(rcs), len(rcs))], axis=0))
        for _ in range(RESAMPLES)
    ]
    spread = np.nanstd(np.log([value for value in samples if value > 0]))
    return onset(speeds, np.nanmean(rcs, axis=0)), math.exp(spread)


def film_ratio(speed: Array, load: float) -> Array:
    """Return Lambda [-] of the nominal contact at the screw, by the film formula."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    contact = screw_contact(screw, 'screw')
    g = groups(contact, load, speed, oil.viscosity, oil.pressure_viscosity)
    return central_film_hamrock_dowson_1977(contact, g) / screw.roughness.rms


def print_table(table: dict[str, dict[int, dict[float, float]]]) -> list[tuple[str, float, float]]:
    """
    Print the onsets as a table in Markdown.

    Return names, ratios to the base and their errors.

    """
    found = []
    base = table['base']
    print(
        '| variation | draws | onset [mm/s] | over the base, same draws | standard error, factor '
        '| equivalent floor [nm] |'
    )
    print('|---|---|---|---|---|---|')
    for name, draws in table.items():
        ratio, error = paired_ratio(draws, base)
        speeds, rcs = as_arrays(draws)
        value = onset(speeds, np.nanmean(rcs, axis=0))
        found.append((name, ratio, error))
        print(
            f'| {name} | {len(rcs)} | '
            f'{_shown(1e3 * value, 1)} | {_shown(ratio, 2)} | {_shown(error, 2)} | '
            f'{_shown(equivalent_floor(table, ratio), 1)} |'
        )
    return found


def equivalent_floor(table: dict[str, dict[int, dict[float, float]]], ratio: float) -> float:
    """Return the floor [nm] that moves the onset of the base by `ratio` [-], by log-log lines."""
    known = [(paired_ratio(table[name], table['base'])[0], nm) for name, nm in FLOORS.items()]
    ratios, floors = np.log(np.array(sorted(known))).T
    return float(np.exp(np.interp(math.log(ratio), ratios, floors))) if ratio > 0 else math.nan


def _shown(value: float, digits: int) -> str:
    """Return a number, or a dash where the mean does not reach the limit in the range."""
    return f'{value:.{digits}f}' if math.isfinite(value) else '-'


def paired_ratio(
    draws: dict[int, dict[float, float]], base: dict[int, dict[float, float]]
) -> tuple[float, float]:
    """Return the onset over that of the same draws of the base [-], and its error as a factor."""
    common = [draw for draw in whole_draws(draws) if draw in base]
    speeds = np.array(sorted(set(draws[common[0]]) & set(base[common[0]]), reverse=True))
    pair = [
        np.array([[rows[draw][speed] for speed in speeds] for draw in common])
        for rows in (draws, base)
    ]
    drawn = np.random.default_rng(0)

    def ratio(chosen: NDArray[np.int64]) -> float:
        ours, theirs = (onset(speeds, np.nanmean(rcs[chosen], axis=0)) for rcs in pair)
        return ours / theirs

    everyone = np.arange(len(common))
    samples = [ratio(drawn.choice(everyone, len(common))) for _ in range(RESAMPLES)]
    spread = np.nanstd(np.log([value for value in samples if value > 0]))
    return ratio(everyone), math.exp(spread)


@styled
def draw_base(draws: dict[int, dict[float, float]], path: Path) -> None:
    """Draw every draw of the base case, their mean, the limit and the film ratio."""
    speeds, rcs = as_arrays(draws)
    figure = new_figure(7, 4.6)
    axes = figure.subplots()
    for row in rcs:
        axes.plot(speeds, np.maximum(row, 1e-5), color='0.7', linewidth=0.8)
    axes.plot([], [], color='0.7', label='one draw of the roughness')
    axes.plot(
        speeds,
        np.maximum(np.nanmean(rcs, axis=0), 1e-5),
        'o-',
        color=BLUE,
        label=f'mean of {len(rcs)} draws',
    )
    axes.axhline(LIMIT, color=PURPLE, linestyle='--', label='limit 0.01')
    value, error = onset_with_error(speeds, rcs)
    axes.axvspan(
        value / error,
        value * error,
        color=BLUE,
        alpha=0.15,
        label=f'onset {value:.3f} m/s, standard error {error:.2f} times',
    )
    axes.set(
        xscale='log',
        yscale='log',
        xlabel='entrainment speed [m/s]',
        ylabel='RCS [-]',
        ylim=(1e-5, 1.2),
        title='Nominal contact, 27.6 N, ISO VG 68 at 40 °C',
    )
    ratio = axes.secondary_xaxis(
        'top',
        functions=(
            lambda u: film_ratio(np.maximum(u, 1e-9), 27.6),
            lambda r: (np.maximum(r, 1e-9) / film_ratio(np.array(1.0), 27.6)) ** (1 / 0.67),
        ),
    )
    ratio.set_xlabel('film ratio Λ [-] (formula)')
    axes.grid(visible=True)
    axes.legend()
    save(figure, path)


@styled
def draw_curves(table: dict[str, dict[int, dict[float, float]]], path: Path) -> None:
    """Draw the mean RCS against speed of what changes the grid, the waves, the floor, the load."""
    panels = {
        'grid': ('base', 'grid 193 x 385', 'grid 257 x 513', 'surface grid'),
        'shortest wave': ('wave 31 um', 'base', 'wave 14 um', 'wave 9.1 um'),
        'film floor': tuple(FLOORS),
        'load': ('base', 'load 100 N', 'load 400 N'),
    }
    figure = new_figure(8, 6.4)
    grid = figure.subplots(2, 2, sharey=True)
    for axes, (title, names) in zip(grid.flat, panels.items(), strict=True):
        for name in names:
            if name in table:
                draw_mean(axes, name, table[name])
        axes.axhline(LIMIT, color=PURPLE, linestyle='--', linewidth=1)
        axes.set(xscale='log', yscale='log', xlim=(1.5, 150), ylim=(1e-4, 1.2), title=title)
        axes.grid(visible=True)
        axes.legend(fontsize=7)
    for axes in grid[1]:
        axes.set_xlabel('entrainment speed [mm/s]')
    for axes in grid[:, 0]:
        axes.set_ylabel('mean RCS [-]')
    save(figure, path)


def draw_mean(axes, name: str, draws: dict[int, dict[float, float]]) -> None:
    """Draw one mean curve; the base by what it is."""
    base = '129 x 257, 20.6 µm, 3 nm, 27.6 N'
    speeds, rcs = as_arrays(draws)
    mean = np.nanmean(rcs, axis=0)
    label = f'{base if name == "base" else name.replace("um", "µm")}, {len(rcs)} draws'
    style = {'color': 'black', 'linewidth': 2} if name == 'base' else {'linewidth': 1.2}
    axes.plot(1e3 * speeds, np.maximum(mean, 1e-5), '.-', label=label, **style)


@styled
def draw_onsets(found: list[tuple[str, float, float]], path: Path) -> None:
    """Draw the onset of every variation over that of the base case."""
    known = [row for row in found if row[1] > 0]
    figure = new_figure(7, 0.42 * len(known) + 1.4)
    axes = figure.subplots()
    places = np.arange(len(known))[::-1]
    ratios = np.array([ratio for _, ratio, _ in known])
    errors = np.array(
        [
            [ratio - ratio / error, ratio * error - ratio]
            for ratio, (_, _, error) in zip(ratios, known, strict=True)
        ]
    ).T
    axes.errorbar(ratios, places, xerr=errors, fmt='o', color=BLUE, capsize=3)
    axes.axvspan(1 / 1.5, 1.5, color='0.9', label='factor 1.5 about the base')
    axes.axvline(1, color='0.4', linewidth=0.8)
    axes.set_yticks(places, [name for name, _, _ in known])
    axes.set(
        xscale='log',
        xlabel='onset speed (RCS 0.01) over that of the base case [-]',
        title='nominal contact, paired draws, bars: standard error',
    )
    ticks = (0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5)
    axes.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
    axes.minorticks_off()
    axes.grid(visible=True, axis='x')
    axes.legend()
    save(figure, path)


def main() -> None:
    """Print the table and write the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('table', nargs='?', type=Path, default=Path('studies/results/onset.csv'))
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    table = read_rows(args.table)
    found = print_table(table)
    draw_base(table['base'], args.out / 'onset_draws.png')
    draw_curves(table, args.out / 'onset_curves.png')
    draw_onsets(found, args.out / 'onset_variations.png')


if __name__ == '__main__':
    main()
