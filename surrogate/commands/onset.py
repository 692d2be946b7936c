# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `onset`: where contact begins, new and run in, by the topography alone."""

import argparse
from pathlib import Path
from typing import Any

from surrogate.commands.output import add_json, draw_into, show
from surrogate.commands.point import (
    add_inputs,
    add_temperature,
    load_inputs,
    oil_temperature,
    prepare,
)


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
    add_json(parser)
    parser.add_argument('--plot', type=Path, metavar='DIR', help='directory for a picture (PNG)')
    parser.set_defaults(handler=_onset)


def _onset(args: argparse.Namespace) -> int:
    from surrogate.screw.onset_record import onset_page, onset_record

    screw, lubricant = load_inputs(args)
    if args.plot:
        prepare(args.plot)
    record = onset_record(screw, lubricant, args.load, oil_temperature(args, lubricant))
    show(record, onset_page, json=args.json)
    if args.plot:
        from surrogate.screw.figures import draw_onset

        draw_into(args.plot, lambda folder: [draw_onset(folder, screw, lubricant, record)])
    return 0
