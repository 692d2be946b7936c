# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The nominal screw in the full tier over speed: its torque and RCS, rough and smooth.

Usage: python studies/screw.py [--load N] [--out DIR]. ISO VG 68 at 40 degC. Prints the table of
docs/theory/screw.md with the processor time of each point, and draws its picture.

"""

import argparse
from dataclasses import dataclass
from pathlib import Path
import time

import numpy as np
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint, Screw
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, PURPLE
from surrogate.screw.contacts import Kinematics, ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import ScrewSolution, solve_screw
from surrogate.units import MILLI, RPM

SPEEDS = (0.0, 2.0, 10.0, 30.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 1000.0)
"""Screw speeds [rev/min]."""
LEAST = 1e-5
"""RCS at the foot of the picture [-]."""


@dataclass(frozen=True, slots=True)
class Row:
    """A speed [rev/min], both solutions there, and the time of the first [s]."""

    rpm: float
    rolling: ScrewSolution
    smooth: ScrewSolution
    seconds: float


def solve_all(screw: Screw, load: float) -> list[Row]:
    """Return all speeds at an axial load [N], after one that loads the solver."""
    oil = load_lubricant('iso_vg_68')

    def solved(rpm: float, kinematics: Kinematics) -> ScrewSolution:
        point = OperatingPoint(speed=rpm * RPM, load=load, temperature=313.15)
        return solve_screw(
            Contacts.of(screw), oil, point, settings=ScrewSettings(kinematics=kinematics)
        )

    solved(SPEEDS[-1], 'rolling')
    rows = []
    for rpm in SPEEDS:
        began = time.process_time()
        found = solved(rpm, 'rolling')
        seconds = time.process_time() - began
        rows.append(Row(rpm, found, solved(rpm, 'smooth'), seconds))
    return rows


def rolling_torque(screw: Screw, found: ScrewSolution) -> float:
    """Return the rolling part of the friction torque [N m]."""
    return screw.loaded_balls_per_nut * sum(
        contact.ball.rolling_power / contact.motion.screw_speed
        for contact in found.contacts
        if contact.motion is not None
    )


def table(screw: Screw, rows: list[Row]) -> str:
    """Return the table of the page."""
    lines = [
        '| rev/min | torque [N m] | sliding | rolling | Lambda | RCS | smooth: torque | s |',
        '|---|---|---|---|---|---|---|---|',
    ]
    for row in rows:
        found, part = row.rolling, rolling_torque(screw, row.rolling)
        lines.append(
            f'| {row.rpm:g} | {found.friction_torque:.3f} | {found.friction_torque - part:.3f} '
            f'| {part:.3f} | {found.film_ratio:.2f} | {found.rcs:.2g} '
            f'| {row.smooth.friction_torque:.3f} | {row.seconds:.1f} |'
        )
    return '\n'.join(lines)


def picture(screw: Screw, rows: list[Row], load: float) -> object:
    """Return torque and its parts above, RCS with its limit below."""
    moving = [row for row in rows if row.rpm]
    rpm = [row.rpm for row in moving]
    figure = new_figure(7, 5.8)
    upper, lower = figure.subplots(2, 1, sharex=True)
    parts = [rolling_torque(screw, row.rolling) for row in moving]
    for label, style, colour, torque in (
        ('friction torque', 'o-', 'black', [row.rolling.friction_torque for row in moving]),
        ('its rolling part', '^--', BLUE, parts),
        ('smooth raceways', ':', GREY, [row.smooth.friction_torque for row in moving]),
    ):
        upper.plot(rpm, MILLI * np.array(torque), style, color=colour, label=label)
    upper.set(ylabel='torque [mN m]', title=f'Nominal screw, {load:g} N, ISO VG 68 at 40 °C')
    rcs = [row.rolling.rcs for row in moving]
    lower.plot(rpm, np.maximum(rcs, LEAST), 'o-', color='black', label='RCS')
    lower.axhline(0.01, color=PURPLE, linestyle='--', label='limit 0.01')
    lower.set(
        xscale='log',
        yscale='log',
        ylim=(LEAST, 1.2),
        xlabel='screw speed [rev/min]',
        ylabel='RCS of the worst contact [-]',
    )
    lower.xaxis.set_major_formatter('{x:g}')
    for axes in (upper, lower):
        axes.grid(visible=True)
        axes.legend(fontsize=8)
    return figure


def main() -> None:
    """Solve, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--load', type=float, default=0.0, help='axial load [N]')
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    screw = load_screw('nominal')
    rows = solve_all(screw, args.load)
    print(table(screw, rows))
    draw_picture(args.out / 'screw_torque.png', lambda: picture(screw, rows, args.load))


if __name__ == '__main__':
    main()
