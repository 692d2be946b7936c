# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Solve the nominal screw in the full tier over speed; time it, and draw its torque and RCS.

Run `python studies/screw.py [--load N] [--out DIR]`: ISO VG 68 at 40 degC, roughness that rolls by
the shipped law. Prints friction torque and its parts, the torque of smooth
raceways, film ratio, RCS, the energy error, the difference of normal forces between contacts and
balance, and processor time of each point: from cold, from the solution at a speed 10 % lower, and
that of the balance of one ball in it.

"""

import argparse
from dataclasses import replace
from pathlib import Path
import time

import numpy as np
from surrogate.formulas.load_sharing import nut_forces
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.plotting.style import BLUE, new_figure, PURPLE, save, styled, VERMILION
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.nut import balance_nut
from surrogate.screw.solve import solve_screw
from surrogate.units import RPM

SPEEDS = (0.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 600.0, 1000.0)
"""Screw speeds [rev/min]."""


def solve_all(load):
    """Return one row of numbers per speed at an axial load [N]."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    rows = []
    print(
        'rev/min  torque  sliding  rolling  smooth [N m]  Lambda     RCS   energy   dQ/Q   '
        'cold s  warm s  balance ms'
    )
    for rpm in SPEEDS:
        point = OperatingPoint(speed=rpm * RPM, load=load, temperature=313.15)
        smooth = solve_screw(screw, oil, point, settings=ScrewSettings(kinematics='smooth'))
        cold, found = timed(lambda point=point: solve_screw(screw, oil, point))
        near = solve_screw(screw, oil, replace(point, speed=0.9 * point.speed))
        warm, _ = timed(lambda point=point, near=near: solve_screw(screw, oil, point, start=near))
        balance, _ = timed(lambda point=point, found=found: balance_one(screw, point, found))
        rolling = parts(screw, found)
        rows.append((rpm, found.friction_torque, rolling, found.film_ratio, found.rcs))
        print(
            f'{rpm:7.0f} {found.friction_torque:8.4f} {found.friction_torque - rolling:8.4f} '
            f'{rolling:8.4f} {smooth.friction_torque:8.4f}      {found.film_ratio:7.3f} '
            f'{found.rcs:8.5f} {found.energy_error:7.0e} {found.load_change:7.4f} '
            f'{cold:7.2f} {warm:7.2f} {1e3 * balance:8.0f}',
            flush=True,
        )
    return np.array(rows)


def timed(work):
    """Return the processor time [s] and the result of some work."""
    began = time.process_time()
    result = work()
    return time.process_time() - began, result


def balance_one(screw, point, found):
    """Balance a ball of the loaded nut once more."""
    solved = [contact.solved for contact in found.contacts[:2]]
    force = float(nut_forces(point.opposing_load, screw.preload)[0])
    return balance_nut(screw, point, force, 1, solved)


def parts(screw, found):
    """Return the rolling part of the friction torque [N m]."""
    return screw.loaded_balls_per_nut * sum(
        contact.ball.rolling_power / contact.motion.screw_speed
        for contact in found.contacts
        if contact.motion is not None
    )


@styled
def draw(rows, load, path):
    """Draw torque and its parts, and RCS with its limit, over speed."""
    rpm, torque, rolling, _, rcs = rows[1:].T
    figure = new_figure(7, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(rpm, 1e3 * torque, 'o-', color='black', label='friction torque')
    upper.plot(rpm, 1e3 * (torque - rolling), 's--', color=VERMILION, label='sliding')
    upper.plot(rpm, 1e3 * rolling, '^--', color=BLUE, label='rolling')
    upper.axhline(1e3 * rows[0, 1], color='0.5', linestyle=':', label='at rest, dry')
    upper.set(ylabel='torque [mN m]', title=f'Nominal screw, {load:g} N, ISO VG 68 at 40 °C')
    lower.plot(rpm, np.maximum(rcs, 1e-5), 'o-', color='black')
    lower.axhline(0.01, color=PURPLE, linestyle='--', label='limit 0.01')
    lower.set(
        xscale='log',
        yscale='log',
        ylim=(1e-5, 1.2),
        xlabel='screw speed [rev/min]',
        ylabel='RCS of the worst contact [-]',
    )
    for axes in (upper, lower):
        axes.grid(visible=True)
        axes.legend()
    save(figure, path)


def main():
    """Solve, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--load', type=float, default=0.0, help='axial load [N]')
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    rows = solve_all(args.load)
    draw(rows, args.load, args.out / 'screw_torque.png')


if __name__ == '__main__':
    main()
