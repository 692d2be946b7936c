# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The table of the scenarios beside the nominal cycle.

    python bags/scenarios.py                      # what there is
    python bags/scenarios.py warm_up --out DIR    # writes DIR/warm_up

"""

import argparse
from collections.abc import Callable
from pathlib import Path
import sys

from input_scenarios import clock_ahead, clock_behind, clock_jump, outside_surface, sensor_dropout
from lubrication_scenarios import preload_loss, warm_up, wrong_oil
from motion_scenarios import flapping, vertical_axis
from scenario import generate, Scenario

SCENARIOS: dict[str, Callable[[], Scenario]] = {
    made.__name__: made
    for made in (
        warm_up,
        wrong_oil,
        preload_loss,
        sensor_dropout,
        clock_jump,
        clock_behind,
        clock_ahead,
        outside_surface,
        flapping,
        vertical_axis,
    )
}


def main(arguments: list[str] | None = None) -> int:
    """Name the scenarios, or generate those asked for, from the command line."""
    parser = argparse.ArgumentParser(description='Generate scenarios as bags.')
    parser.add_argument('names', nargs='*', choices=[[], *SCENARIOS], help='none: name them all')
    parser.add_argument(
        '--out',
        type=Path,
        default=Path(__file__).parent,
        help='directory in which each gets a directory of its name (default: %(default)s)',
    )
    args = parser.parse_args(arguments)
    for name in args.names:
        generate(SCENARIOS[name](), args.out / name)
        print(args.out / name)
    for name, made in SCENARIOS.items() if not args.names else ():
        print(f'{name:<16} {made().shows}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
