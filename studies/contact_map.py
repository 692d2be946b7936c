# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time a mixed map of both contacts: 16 loads by 16 speeds each, one warm chain per load.

Run `python studies/contact_map.py [--workers 2]`. Grid 129 x 257, one draw of the nominal
roughness with waves down to 20.6 um, loads 10 to 150 N, speeds 2 to 0.002 m/s, ISO VG 68 at 40
degC. Prints wall and processor time, how many of the 512 points converged, and the RCS of every
fourth row.

"""

import argparse
from concurrent.futures import ProcessPoolExecutor
import time

import numpy as np
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.formulas.geometry import hertz, screw_contact, SIDES
from surrogate.parameters import load_lubricant, load_screw
from surrogate.progress import Progress
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window

LOADS = np.geomspace(10.0, 150.0, 16)
SPEEDS = np.geomspace(2.0, 0.002, 16)
SETTINGS = Settings(nx=129, ny=257, error_estimate=False)


def nominal_patch(contact):
    """Return one draw, rescaled over the Hertz rectangle of the largest load."""
    roughness = PublishedRoughness(shortest_wavelength=16e-6)
    ellipse = hertz(contact, LOADS[-1])
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    return take_patch(fractal_surface(roughness, 0), 'rescaled', window, roughness.rms)


def chain(task):
    """Return RCS, convergence of every speed and the processor time [s] of one load."""
    side, load = task
    began, oil = time.process_time(), load_lubricant('iso_vg_68')
    contact = screw_contact(load_screw('nominal'), side)
    lubricant = ContactLubricant(
        viscosity=oil.viscosity, pressure_viscosity=oil.pressure_viscosity
    )
    patch, last, rows = nominal_patch(contact), None, []
    for speed in SPEEDS:
        found = solve_contact(
            contact,
            lubricant,
            Condition(load=load, entrainment_speed=float(speed)),
            roughness=lambda x, y: patch.heights(x[:, 0], y[0]),
            settings=SETTINGS,
            start=last,
        )
        last = found if found.converged else None
        rows.append((found.rcs, found.converged))
    return side, load, rows, time.process_time() - began


def main():
    """Run all chains and print the map."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workers', type=int, default=2)
    args = parser.parse_args()
    tasks = [(side, float(load)) for side in SIDES for load in LOADS]
    began, used, converged = time.perf_counter(), 0.0, 0
    progress = Progress(len(tasks), 'chains')
    with ProcessPoolExecutor(args.workers) as pool:
        for count, (side, load, rows, seconds) in enumerate(pool.map(chain, tasks), 1):
            used += seconds
            converged += sum(good for _, good in rows)
            progress.step()
            if count % 4 == 1:
                shares = ' '.join(f'{rcs:7.1e}' for rcs, _ in rows)
                print(f'\r{side:6s} {load:6.1f} N  {shares}', flush=True)
    wall = time.perf_counter() - began
    print(
        f'\n{converged} of {len(tasks) * len(SPEEDS)} points converged; wall {wall:.0f} s with '
        f'{args.workers} processes, processor {used:.0f} s, '
        f'{1e3 * used / len(tasks) / len(SPEEDS):.0f} ms a point'
    )


if __name__ == '__main__':
    main()
