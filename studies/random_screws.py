# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The onset of contact of random screws, in the closed-form and in the full tier.

Usage: python studies/random_screws.py [--screws 100] [--closed].

Draws plausible screws as a catalogue has them, with oil, load and temperature, and finds the
speed at which RCS passes 0.01 in both tiers. Writes results/random_screws.csv, in which a screw
that is refused has the sentence. Anything but an InputError ends the study; --closed leaves out
the full tier.

"""

import argparse
from dataclasses import dataclass
import math
from pathlib import Path
import time

import numpy as np
from surrogate.asperities.law import ONSET_RCS, SLOPE
from surrogate.catalogue.screw import screw_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.ehl import Settings
from surrogate.files import InputError
from surrogate.parameters import load_lubricant, Lubricant, OperatingPoint, Screw
from surrogate.screw.closed_form import solve
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point
from surrogate.screw.solve import solve_screw
from surrogate.tasks.table import read_table, write_table
from surrogate.units import RPM, ZERO_CELSIUS

RESULTS = Path('studies/results/random_screws.csv')
OILS = 'iso_vg_32', 'iso_vg_68', 'iso_vg_100'
SETTINGS = ScrewSettings(smooth=Settings(nx=65, ny=65, error_estimate=False))
BETWEEN = 30.0
"""Factor on the onset of the middle of the contact within which that of all of it lies [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Drawn:
    """
    A random screw: seed, size [mm], process, oil, load [N], temperature [degC].

    Onsets of the closed-form and the full tier [rev/min], NaN where there is none; status of the
    full tier, or why the screw is refused; wall time [s].

    """

    seed: int
    size: str
    process: str
    oil: str
    load_N: float
    temperature_degC: float
    closed_form: float = math.nan
    full: float = math.nan
    status: str = ''
    seconds: float = 0.0


def draw(seed: int) -> tuple[CatalogueScrew, str, float, float]:
    """Return catalogue values, oil, load over the preload [-] and temperature [K] of a seed."""
    random = np.random.default_rng(seed)
    diameter = float(random.choice([12, 16, 20, 25, 32, 40, 50, 63, 80]))
    lead = max(2.0, round(diameter * random.uniform(0.12, 0.6)))
    ball, turns = min(0.635 * lead, 0.2 * diameter), float(random.uniform(2.0, 6.0))
    # Dynamic ratings rise about as ball^1.6 turns^0.86, and a little with the diameter.
    rating = 900 * ball**1.6 * turns**0.86 * (diameter / 20) ** 0.3 * random.uniform(0.7, 1.3)
    given = CatalogueScrew(
        nominal_diameter=1e-3 * diameter,
        lead=1e-3 * lead,
        nut='double',
        turns=turns,
        dynamic_rating=float(rating),
        preload_share=float(random.uniform(0.02, 0.1)),
        process=str(random.choice(['ground', 'rolled', 'whirled'])),
        ra=float(1e-6 * random.uniform(0.05, 0.4)),
    )
    oil = str(random.choice(OILS))
    return given, oil, float(random.uniform(0, 2)), float(random.uniform(20, 60)) + ZERO_CELSIUS


def closed_form_onset(screw: Screw, oil: Lubricant, load: float, temperature: float) -> float:
    """Return the fastest screw speed at which RCS is 0.01 [rad/s], closed-form tier."""
    middle = onset_point(Contacts.of(screw), oil, load, temperature)['speed_rad_s']
    speeds = middle * np.geomspace(BETWEEN, 1 / BETWEEN, 241)
    rcs = solve(Contacts.of(screw), oil, speeds, load, temperature).rcs
    last = int(np.argmax(rcs >= ONSET_RCS))
    ends = np.log(np.maximum(rcs[[last - 1, last]], 1e-9))
    logs = np.log(speeds[[last - 1, last]])
    return math.exp(np.interp(math.log(ONSET_RCS), ends, logs)) if last else math.nan


def full_onset(
    screw: Screw, oil: Lubricant, load: float, temperature: float, near: float
) -> tuple[float, str]:
    """Return the same of the full tier [rad/s] by solves `near` it, and the status of the last."""
    speed, known = near, None
    for _ in range(3):
        point = OperatingPoint(speed=speed, load=load, temperature=temperature)
        known = solve_screw(Contacts.of(screw), oil, point, settings=SETTINGS, start=known)
        if not (known.converged and known.rcs > 0):
            return math.nan, known.status
        found = speed * (known.rcs / ONSET_RCS) ** (-1 / SLOPE)
        if abs(math.log(found / speed)) < 0.01:
            break
        speed = found
    return found, known.status


def run(seed: int, *, closed: bool) -> Drawn:
    """Return what the screw of a seed does."""
    given, oil_name, share, temperature = draw(seed)
    began = time.perf_counter()
    row = {
        'seed': seed,
        'size': f'{1e3 * given.nominal_diameter:g}x{1e3 * given.lead:g}',
        'process': given.process,
        'oil': oil_name,
        'load_N': math.nan,
        'temperature_degC': temperature - ZERO_CELSIUS,
    }
    try:
        screw, oil = screw_of(given)[0], load_lubricant(oil_name)
        row['load_N'] = load = share * screw.preload
        near = closed_form_onset(screw, oil, load, temperature)
        row['closed_form'] = near / RPM
        if not closed:
            full, row['status'] = full_onset(screw, oil, load, temperature, near)
            row['full'] = full / RPM
    except InputError as error:
        row['status'] = f'refused: {error}'
    return Drawn(**row, seconds=time.perf_counter() - began)


def main() -> None:
    """Run what is missing in the table and print how far the tiers are apart."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--screws', type=int, default=100, metavar='N')
    parser.add_argument('--closed', action='store_true', help='leave out the full tier')
    args = parser.parse_args()
    rows = read_table(RESULTS, Drawn)
    for seed in sorted(set(range(args.screws)) - {row.seed for row in rows}):
        rows.append(run(seed, closed=args.closed))
        write_table(RESULTS, Drawn, rows, digits=5)
    ratios = np.array([row.full / row.closed_form for row in rows])
    told, refused = ratios[np.isfinite(ratios)], [row.status.startswith('refused') for row in rows]
    print(f'{len(rows)} screws, {sum(refused)} refused, {told.size} with an onset in both tiers')
    print(f'full over closed form: {told.min():.3f} to {told.max():.3f}, mean {told.mean():.3f}')


if __name__ == '__main__':
    main()
