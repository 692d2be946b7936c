# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommands that look into a surface file: check, query, plot, diff, export."""

import argparse
import math
from pathlib import Path
import sys
import time
from typing import Any

from surrogate.builder.tiers import spreads
from surrogate.commands.output import add_json, show
from surrogate.commands.point import add_operating_point
from surrogate.files import InputError, replace_file
from surrogate.files.limits import read_text, TABLE
from surrogate.parameters import OperatingPoint
from surrogate.surface import find_surface, Surface
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, RCS_TOLERANCE
from surrogate.surface.file import read
from surrogate.tasks.progress import Progress
from surrogate.units import digits, RPM, ZERO_CELSIUS


def add_inspect_commands(actions: Any) -> None:
    """Add the subcommands to those of `surface`."""
    text = 'Exit code 1: a point or the other surface differs by more than the tolerance.'
    check = 'compare a surface file with fresh solves'
    _add_check(actions.add_parser('check', help=check, epilog=text))
    parser = actions.add_parser('query', help='look up one point, or those of a table')
    add_file(parser)
    add_operating_point(parser, required=False)
    parser.add_argument(
        '--csv',
        type=Path,
        metavar='IN.csv',
        help='table of points instead: speed_rpm, load_N, temperature_degC (may be missing)',
    )
    parser.add_argument(
        '--out', type=Path, metavar='OUT.csv', help='table to write (default: print)'
    )
    add_json(parser)
    parser.set_defaults(handler=_query)
    plot = actions.add_parser('plot', help='draw a surface, a picture per temperature')
    add_file(plot)
    plot.add_argument('--out', type=Path, required=True, metavar='DIR', help='where pictures go')
    plot.add_argument(
        '--temperature-degC',
        type=float,
        nargs='+',
        metavar='T',
        dest='temperatures',
        help='temperatures [degC] (default: both ends and that of the oil datasheet)',
    )
    plot.set_defaults(handler=_plot)
    _add_diff(actions.add_parser('diff', help='compare two surface files', epilog=text))
    export = actions.add_parser('export', help='write a surface as a table')
    add_file(export)
    text = 'table to write, a line per node'
    export.add_argument('--csv', type=Path, required=True, metavar='OUT.csv', help=text)
    export.set_defaults(handler=_export)


def add_file(parser: argparse.ArgumentParser) -> None:
    """Add the surface that a subcommand reads."""
    parser.add_argument(
        'file', nargs='?', type=Path, help='a path, or a tier of those shipped (default full)'
    )


def _add_check(parser: argparse.ArgumentParser) -> None:
    add_file(parser)
    parser.add_argument('--points', type=int, default=20, help='random points (default 20)')
    parser.add_argument('--seed', type=int, default=1, help='seed of the points (default 1)')
    parser.add_argument(
        '--max-seconds',
        type=float,
        default=60.0,
        help='begin no other point after this time [s] and judge what was done (default 60); one '
        'of the full tier takes about a minute',
    )
    parser.add_argument(
        '--limit-points',
        type=int,
        default=0,
        metavar='K',
        help='also solve points at RCS 0.01 and say how far off it is in speed (default 0)',
    )
    parser.set_defaults(handler=_check)


def _add_diff(parser: argparse.ArgumentParser) -> None:
    for name, letter in (('first', 'A'), ('second', 'B')):
        parser.add_argument(
            name, type=Path, metavar=letter, help='a path, or a tier of those shipped'
        )
    for name, default, words in (
        ('efficiency', EFFICIENCY_TOLERANCE, 'largest accepted difference of the efficiency [-]'),
        ('rcs', RCS_TOLERANCE, 'largest accepted difference of RCS [-]'),
        ('zone', 0.05, 'largest accepted shift of a limit of the zone, over its speed [-]'),
    ):
        parser.add_argument(
            f'--{name}-tolerance',
            type=float,
            default=default,
            metavar='X',
            help=f'{words}, default {default}',
        )
    add_json(parser)
    parser.set_defaults(handler=_diff)


def _check(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.check import check_surface
    from surrogate.surface_tools.limit import limit_errors

    path = find_surface(args.file)
    if args.points < 1:
        raise InputError(f'--points is {args.points}, allowed is 1 or more')
    if args.limit_points < 0:
        raise InputError(f'--limit-points is {args.limit_points}, allowed is 0 or more')
    if not 0.0 < args.max_seconds < math.inf:
        raise InputError(f'--max-seconds is {args.max_seconds:g} s, allowed is above 0')
    data = read(path)
    deadline = time.monotonic() + args.max_seconds
    slow = spreads(data.header['tier'])
    result = check_surface(
        data,
        args.points,
        args.seed,
        lambda: time.monotonic() < deadline,
        Progress(args.points, 'points').step if slow else lambda: None,
    )
    print(f'{path}: {result.sentence()}')
    for (speed, load, temperature), error in limit_errors(
        data, args.limit_points, args.seed, lambda: time.monotonic() < deadline
    ):
        off = f'is off by {100 * error:+.2g} % of the speed'
        print(
            f'RCS is 0.01 at {digits(speed / RPM)} rev/min, {load:.0f} N, '
            f'{temperature - ZERO_CELSIUS:.0f} degC; that '
            + (off if math.isfinite(error) else 'has no solution')
        )
    return 0 if result.passed else 1


def _query(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.query import query_page, query_record

    surface = Surface.load(find_surface(args.file))
    if args.csv is not None:
        from surrogate.surface_tools.query import query_table

        if args.json or not (args.speed_rpm is args.load is args.temperature is None):
            raise InputError('--csv takes its points from the table and writes a table')
        try:
            lines = read_text(args.csv, most=TABLE).splitlines()
        except (OSError, UnicodeDecodeError, InputError) as error:
            raise InputError(f'{args.csv}: cannot be read, {error}') from None
        table, points, answers = query_table(surface, lines, str(args.csv))
        if args.out is None:
            print(table, end='')
        else:
            _write(args.out, table.encode())
        print(f'{answers} of {points} points lie on the surface', file=sys.stderr)
        return 0
    if args.speed_rpm is None or args.load is None:
        raise InputError('a point needs --speed-rpm and --load-N, a table of points --csv')
    if args.out is not None:
        raise InputError('--out belongs to --csv: one point is printed')
    kelvin = (
        surface.reference_temperature
        if args.temperature is None
        else args.temperature + ZERO_CELSIUS
    )
    point = OperatingPoint(speed=args.speed_rpm * RPM, load=args.load, temperature=kelvin)
    record = query_record(surface, point)
    show(record, query_page, json=args.json)
    return 1 if record['reason'] else 0


def _plot(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.figures import draw_surface

    surface = Surface.load(find_surface(args.file))
    try:
        for path in draw_surface(args.out, surface, _temperatures(args.temperatures, surface)):
            print(path)
    except OSError as error:
        raise InputError(f'--out: {args.out} cannot be written, {error.strerror}') from None
    return 0


def _temperatures(given: list[float] | None, surface: Surface) -> list[float]:
    """Return the temperatures to draw [K]; those that were asked for must be covered."""
    low, high = surface.temperature_range
    if given is None:
        return sorted({low, min(max(surface.reference_temperature, low), high), high})
    for celsius in given:
        if not low <= celsius + ZERO_CELSIUS <= high:
            raise InputError(
                f'--temperature-degC is {celsius:g} degC, the surface covers '
                f'{low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC'
            )
    return [celsius + ZERO_CELSIUS for celsius in given]


def _diff(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.diff import diff_page, diff_record, exceeded

    tolerances = {
        name: getattr(args, f'{name}_tolerance') for name in ('efficiency', 'rcs', 'zone')
    }
    for name, value in tolerances.items():
        if not 0.0 <= value < math.inf:
            raise InputError(f'--{name}-tolerance is {value:g}, allowed is 0 or more')
    record = diff_record(read(find_surface(args.first)), read(find_surface(args.second)))
    sentences = exceeded(record, tolerances)
    whole = {**record, 'tolerances': tolerances, 'exceeded': sentences}
    show(whole, lambda whole: diff_page(whole, sentences), json=args.json)
    return 1 if sentences else 0


def _export(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.export import to_table

    data = read(find_surface(args.file))
    _write(args.csv, to_table(data).encode())
    print(f'{args.csv}: {data.mask.size} nodes of surface {data.sha256}')
    return 0


def _write(path: Path, content: bytes) -> None:
    try:
        replace_file(path, content)
    except OSError as error:
        raise InputError(f'{path}: cannot be written, {error.strerror}') from None
