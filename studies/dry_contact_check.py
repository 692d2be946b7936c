# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Summits that yield in a dry contact, by our solver and by that of others on the same tile.

Usage: python studies/dry_contact_check.py. Presses the uncut tiles of two strips of
topography_onset.py on a flat, elastically and under five hardnesses, with our solver and with
ContactMechanics, and writes results/dry_contact.csv. Rows of other solvers stay in it.

"""

import csv
from dataclasses import dataclass
import math
from pathlib import Path

import ContactMechanics
from ContactMechanics.Optimization import constrained_conjugate_gradients
import numpy as np
from SurfaceTopography import Topography
from surrogate.raceway.dry_contact import press
from surrogate.raceway.tile import Tile
from surrogate.tasks.table import read_table, write_table
from surrogate.units import GIGA
from topography_onset import RESULTS as MARCHES
from topography_onset import strip_of

RESULTS = Path('studies/results/dry_contact.csv')
OURS, THEIRS = 'surrogate.raceway.dry_contact', 'ContactMechanics'
TILES = {'s3_new': (math.inf, 9e9, 7e9, 5e9, 3e9, 2e9), 's2_new': (7e9, 3e9)}
"""Hardnesses under which the tile of a strip is pressed [Pa]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Pressed:
    """
    A tile pressed on a flat by one solver.

    Shares of the nodes that touch and that yield [-]; mean pressure over the wanted one [-]; mean
    and deepest of what sinks and mean gap [nm]; difference from our pressures summed over the load
    [-] and greatest difference from our gaps [nm].

    """

    solver: str
    version: str
    tile: str
    nodes: str
    mean_pressure_GPa: float
    hardness_GPa: float
    contact_share: float
    yielded_share: float
    mean_pressure_ratio: float
    mean_sunk_nm: float
    deepest_nm: float
    mean_gap_nm: float
    pressure_difference: float
    gap_difference_nm: float


def press_theirs(
    tile: Tile, modulus: float, mean: float, hardness: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return pressures [Pa] and gaps [m] by ContactMechanics; arguments as those of `press`."""
    size, area = (tile.length, tile.width), tile.length * tile.width
    cell = area / tile.heights.size
    found = constrained_conjugate_gradients(
        ContactMechanics.PeriodicFFTElasticHalfSpace(tile.heights.shape, modulus, size),
        Topography(tile.heights, size, periodic=True),
        hardness=None if math.isinf(hardness) else hardness * cell,
        external_force=mean * area,
        pentol=1e-13,
    )
    assert found.success, found.message
    return np.abs(found.jac) / cell, found.x - tile.heights - found.offset


def rows_of(name: str) -> list[Pressed]:
    """Return the rows of a tile."""
    with MARCHES.open(encoding='utf-8', newline='') as file:
        one = strip_of(next(row for row in csv.DictReader(file) if row['march'] == name))
    tile, modulus, mean = one.tile, 0.5 * one.strip.reduced_modulus, one.strip.max_pressure
    rows = []
    for hardness in TILES[name]:
        ours = press(tile, modulus, mean, hardness=hardness)
        assert ours.converged
        usual = ours.pressure, ours.gap
        for solver, version, fields in (
            (OURS, '', usual),
            (THEIRS, ContactMechanics.__version__, press_theirs(tile, modulus, mean, hardness)),
        ):
            rows.append(
                Pressed(
                    solver=solver,
                    version=version,
                    tile=name,
                    nodes='{} x {}'.format(*tile.heights.shape),
                    mean_pressure_GPa=GIGA * mean,
                    hardness_GPa=GIGA * hardness,
                    **numbers(fields, usual, mean, hardness),
                )
            )
    return rows


def numbers(
    fields: tuple[np.ndarray, np.ndarray],
    usual: tuple[np.ndarray, np.ndarray],
    mean: float,
    hardness: float,
) -> dict[str, float]:
    """Return the numbers of pressures [Pa] and gaps [m], against the usual ones."""
    pressure, gap = fields
    sunk = 1e9 * np.where((pressure >= hardness * (1 - 1e-9)) & (gap < 0), -gap, 0.0)
    return {
        'contact_share': (pressure > 0).mean(),
        'yielded_share': (sunk > 0).mean(),
        'mean_pressure_ratio': pressure.mean() / mean,
        'mean_sunk_nm': sunk.mean(),
        'deepest_nm': sunk.max(),
        'mean_gap_nm': 1e9 * np.maximum(gap, 0.0).mean(),
        'pressure_difference': np.abs(pressure - usual[0]).sum() / usual[0].sum(),
        'gap_difference_nm': 1e9 * np.abs(gap - usual[1]).max(),
    }


def main() -> None:
    """Press all tiles and write the table."""
    found = [row for name in TILES for row in rows_of(name)]
    others = [row for row in read_table(RESULTS, Pressed) if row.solver not in (OURS, THEIRS)]
    write_table(RESULTS, Pressed, found + others, digits=6)


if __name__ == '__main__':
    main()
