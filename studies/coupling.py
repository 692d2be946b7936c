# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Show what it changes to solve contacts again under the normal forces that friction leaves them.

Run `python studies/coupling.py`: nominal screw, ISO VG 68 at 40 degC, one draw. Each point is
solved once without and once with the iteration of contacts and balance to 1e-4. Prints the change
of the normal forces, what it does to friction torque, efficiency and RCS, and the rounds in time.

"""

from dataclasses import replace
import math
import time

from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.solve import solve_screw
from surrogate.units import RPM

SPEEDS = (-12.0, -8.0, -5.0, 5.0, 6.0, 8.0, 10.0, 12.0, 100.0, 600.0, 1000.0)
"""Screw speeds [rev/min]."""
LOADS = (0.0, 1000.0, 2600.0)
"""Axial loads [N]."""
ONCE, TIGHT = math.inf, 1e-4


def compare(screw, oil, rpm, load):
    """Solve a point both ways and print a row."""
    point = OperatingPoint(speed=rpm * RPM, load=load, temperature=313.15)
    began = time.process_time()
    once, tight = (
        solve_screw(
            screw, oil, point, settings=replace(ScrewSettings(), coupling_tolerance=tolerance)
        )
        for tolerance in (ONCE, TIGHT)
    )
    print(
        f'{rpm:7.0f} {load:6.0f} {once.rcs:8.4f} {100 * once.load_change:7.3f} '
        f'{100 * (tight.friction_torque / once.friction_torque - 1):9.3f} '
        f'{tight.efficiency - once.efficiency:10.1e} {tight.rcs - once.rcs:9.1e} '
        f'{100 * tight.load_change:8.4f} {time.process_time() - began:6.1f}',
        flush=True,
    )
    return once.load_change, abs(tight.friction_torque / once.friction_torque - 1)


def main():
    """Compare all points."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    print('rev/min  load N   RCS    dQ/Q %  torque %  efficiency    RCS    left %      s')
    rows = [compare(screw, oil, rpm, load) for load in LOADS for rpm in SPEEDS]
    quiet = [torque for change, torque in rows if change < 0.01]
    print(
        f'{len(rows)} points; where friction changes normal forces by less than 1 % '
        f'({len(quiet)}), the torque changes by {100 * max(quiet):.2g} % at most'
    )


if __name__ == '__main__':
    main()
