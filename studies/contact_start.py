# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time a rough contact from its solution at a faster speed, over the time from cold.

Run `python studies/contact_start.py`. Screw side of the nominal screw at preload, draw 3, waves
down to 20.6 um on 129 x 257 nodes, ISO VG 68 at 40 degC. Prints a line per speed; a solver that
takes no far starts is made to. Takes three minutes.

"""

import math
import sys
import time

from surrogate.ehl import Condition, search, solve_contact
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.load_sharing import normal_force
from surrogate.paper.raceway import published_patch
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.short_waves import without_short_waves
from surrogate.screw.contacts import GRID_WAVELENGTH, oil_at, ScrewSettings

SLOWEST, STEP, COUNT, STEPS = 0.002, 0.5, 14, 4
"""Speed [m/s], step of its logarithm, speeds, most steps of a start [-]."""


def timed(screw, speed, start=None):
    """Return a solution and its processor time [s]."""
    contact, began = screw_contact(screw, 'screw'), time.process_time()
    patch = without_short_waves(published_patch(screw, 3), GRID_WAVELENGTH)
    found = solve_contact(
        contact,
        oil_at(load_lubricant('iso_vg_68'), 313.15),
        Condition(load=float(normal_force(screw, screw.preload)), entrainment_speed=speed),
        roughness=patch.heights,
        settings=ScrewSettings().rough,
        start=start,
    )
    return found, time.process_time() - began


def main():
    """Print the table."""
    screw, known = load_screw('nominal'), []
    search.SAME_SPEED = math.inf
    timed(screw, 1.0)
    print('speed [m/s]    RCS   cold [s]   from a speed higher by', end='')
    print(', '.join(f' e^{STEP * step:g}' for step in range(1, STEPS + 1)))
    for place in reversed(range(COUNT)):
        speed = SLOWEST * math.exp(STEP * place)
        cold, seconds = timed(screw, speed)
        ratios = [timed(screw, speed, start)[1] / seconds for start in reversed(known[-STEPS:])]
        known.append(cold)
        print(f'{speed:11.4f} {cold.rcs:6.3f} {seconds:10.2f}', end='   ')
        print('  '.join(f'{ratio:5.1f}' for ratio in ratios))
        sys.stdout.flush()


if __name__ == '__main__':
    main()
