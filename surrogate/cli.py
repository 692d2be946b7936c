# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The offline subcommands: `point` is here, the others in a module of their own each."""

import argparse
from collections.abc import Callable
import json
import math
from typing import Any

from surrogate.contact_command import add_contact_command
from surrogate.parameters import (
    load_lubricant,
    load_screw,
    Lubricant,
    OperatingPoint,
    Screw,
    ZERO_CELSIUS,
)
from surrogate.plain_json import to_json
from surrogate.surface_command import add_inputs, add_surface_command


def add_commands(subparsers: Any) -> None:
    """Add the offline subcommands; each sets `handler`, which takes the arguments."""
    point = subparsers.add_parser('point', help='solve one operating point')
    add_inputs(point)
    point.add_argument(
        '--speed-rpm',
        type=float,
        required=True,
        metavar='N',
        help='screw speed [rev/min], the sign is the direction of motion',
    )
    point.add_argument(
        '--load-N',
        type=float,
        required=True,
        metavar='F',
        dest='load',
        help='axial load [N]; it opposes the motion when it has the sign of the speed',
    )
    point.add_argument(
        '--temperature-degC',
        type=float,
        metavar='T',
        dest='temperature',
        help='oil temperature [degC], default that of the oil datasheet',
    )
    point.add_argument(
        '--tier',
        choices=('closed_form', 'full'),
        default='closed_form',
        help='model: published formulas, or four solved contacts and balanced balls (seconds)',
    )
    point.add_argument('--json', action='store_true', help='print JSON in SI units')
    point.set_defaults(handler=_point)
    add_contact_command(subparsers)
    add_surface_command(subparsers)


def _point(args: argparse.Namespace) -> int:
    from surrogate.point import page

    screw, lubricant = load_screw(args.screw), load_lubricant(args.oil)
    kelvin = (
        lubricant.reference_temperature
        if args.temperature is None
        else args.temperature + ZERO_CELSIUS
    )
    point = OperatingPoint(speed=args.speed_rpm * math.pi / 30, load=args.load, temperature=kelvin)
    record = _record_of(args.tier)(screw, lubricant, point)
    print(json.dumps(to_json(record), indent=2, allow_nan=False) if args.json else page(record))
    return 0 if record.get('converged', True) else 1


def _record_of(tier: str) -> Callable[[Screw, Lubricant, OperatingPoint], dict[str, Any]]:
    """Return what solves a point; the full model is loaded only when it is asked for."""
    if tier == 'full':
        from surrogate.screw_record import full_record

        return full_record
    from surrogate.point import closed_form_record

    return closed_form_record
