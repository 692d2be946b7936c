# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `onset`: where contact begins, new and run in, by the topography alone."""

import argparse
from pathlib import Path
import sys
from typing import Any

from surrogate.commands.output import add_json, show
from surrogate.commands.point import add_inputs, add_temperature, oil_temperature, prepare
from surrogate.parameters import load_lubricant, load_screw
from surrogate.units import GIGA


def add_onset_command(subparsers: Any) -> None:
    """Add `onset`; its handler imports what presses the topography."""
    parser = subparsers.add_parser('onset', help='speed at which contact begins, new and run in')
    add_inputs(parser)
    parser.add_argument(
        '--load-N',
        type=float,
        default=0.0,
        metavar='F',
        dest='load',
        help='axial load [N] (default 0: the preload alone)',
    )
    add_temperature(parser)
    _add_cut(parser)
    add_json(parser)
    parser.add_argument('--plot', type=Path, metavar='DIR', help='directory for a picture (PNG)')
    parser.set_defaults(handler=_onset)


def _add_cut(parser: argparse.ArgumentParser) -> None:
    for name, default, text in (
        ('hardness', 7.0, 'pressure that no summit exceeds'),
        ('run-in-pressure', 3.0, 'pressure that stands for yield and mild wear of running in'),
    ):
        words = f'{text} [GPa] (default {default:g})'
        parser.add_argument(f'--{name}-GPa', type=float, default=default, metavar='P', help=words)
    parser.add_argument(
        '--run-in-range-GPa',
        type=float,
        nargs=2,
        default=(2.0, 5.0),
        metavar=('LOW', 'HIGH'),
        help='range of that pressure [GPa] (default 2 5)',
    )
    parser.add_argument(
        '--working-load-N',
        type=float,
        metavar='F',
        help='largest axial load in operation [N] (default: that which unloads the relieved nut)',
    )
    parser.add_argument(
        '--traced-run-in',
        action='store_true',
        help='the profile was traced after running in: it is cut at the hardness alone',
    )


def _onset(args: argparse.Namespace) -> int:
    from surrogate.asperities.running_in import Cut
    from surrogate.screw.onset import onset_page, onset_record

    screw, lubricant = load_screw(args.screw), load_lubricant(args.oil)
    cut = Cut(
        hardness=args.hardness_GPa / GIGA,
        run_in_pressure=args.run_in_pressure_GPa / GIGA,
        run_in_range=(args.run_in_range_GPa[0] / GIGA, args.run_in_range_GPa[1] / GIGA),
        working_load=args.working_load_N,
        traced_run_in=args.traced_run_in,
    )
    if args.plot:
        prepare(args.plot)
    record = onset_record(screw, lubricant, args.load, oil_temperature(args, lubricant), cut)
    show(record, onset_page, json=args.json)
    if args.plot:
        from surrogate.screw.onset_figure import draw_onset

        print(draw_onset(args.plot, screw, lubricant, cut, record), file=sys.stderr)
    return 0
