# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Offline subcommands: `point`, `contact`, `identify`, `figures`, `surface build|info|check`."""

import argparse
import json
import math
from pathlib import Path
import random
import sys
import time
from typing import Any

from surrogate.contact_command import add_contact_command
from surrogate.figures_command import add_figures_command
from surrogate.identify_command import add_identify_command, BagReader
from surrogate.parameters import (
    InputError,
    load_lubricant,
    load_screw,
    Lubricant,
    Screw,
    ZERO_CELSIUS,
)
from surrogate.plain_json import to_json
from surrogate.point_command import add_inputs, add_point_command
from surrogate.surface import shipped_surface, Surface
from surrogate.surface_file import read, SurfaceData, write

EFFICIENCY_TOLERANCE = 0.003
"""Largest accepted error of the efficiency in a check [-]."""
RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE, RCS_SMALL = 0.003, 0.05, 0.05
"""Accepted error of RCS [-]: absolute below `RCS_SMALL`, relative above."""

UNITS = {'friction_torque': 'N m', 'central_film': 'm', 'minimum_film': 'm', 'max_pressure': 'Pa'}
"""Units of the fields that have one."""


def add_commands(subparsers: Any, read_bag: BagReader | None = None) -> None:
    """
    Add the offline subcommands; each sets `handler`, which takes the arguments.

    `read_bag` is what `identify` reads a bag with.

    """
    add_point_command(subparsers)
    add_contact_command(subparsers)
    add_identify_command(subparsers, read_bag)
    add_figures_command(subparsers)
    surface = subparsers.add_parser('surface', help='build, describe or check a surface file')
    actions = surface.add_subparsers(required=True, metavar='build|info|check')
    _add_build(actions.add_parser('build', help='build a surface file'))
    _add_info(actions.add_parser('info', help='describe a surface file'))
    _add_check(actions.add_parser('check', help='compare a surface file with fresh solves'))


def _add_build(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser)
    parser.add_argument('--tier', choices=('closed_form',), default='closed_form')
    for name, unit in (('speed', 'rpm'), ('load', 'N'), ('temperature', 'degC')):
        parser.add_argument(
            f'--{name}-range',
            type=float,
            nargs=2,
            metavar=('LOW', 'HIGH'),
            help=f'{name} range [{unit}]',
        )
    parser.add_argument('--out', type=Path, help='file to write (default SCREW_OIL.npz)')
    parser.set_defaults(handler=_build)


def _add_info(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('file', nargs='?', type=Path, help='default: the shipped surface')
    parser.add_argument('--json', action='store_true', help='print JSON in SI units')
    parser.set_defaults(handler=_info)


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('file', nargs='?', type=Path, help='default: the shipped surface')
    parser.add_argument('--points', type=int, default=20, help='random points (default 20)')
    parser.add_argument('--seed', type=int, default=1, help='seed of the points (default 1)')
    parser.add_argument(
        '--max-seconds',
        type=float,
        default=60.0,
        help='stop after this time [s] and judge what was done (default 60)',
    )
    parser.set_defaults(handler=_check)


def _build(args: argparse.Namespace) -> int:
    from dataclasses import replace

    from surrogate.build import build_closed_form, default_settings

    screw, lubricant = load_screw(args.screw), load_lubricant(args.oil)
    settings = default_settings(screw)
    if args.speed_range:
        low, high = _range('--speed-range', 'rpm', args.speed_range, lowest=0.0)
        settings = replace(settings, speed_range=(low * math.pi / 30, high * math.pi / 30))
    if args.load_range:
        settings = replace(settings, load_range=_range('--load-range', 'N', args.load_range))
    if args.temperature_range:
        low, high = _range('--temperature-range', 'degC', args.temperature_range)
        settings = replace(settings, temperature_range=(low + ZERO_CELSIUS, high + ZERO_CELSIUS))
    out = args.out or Path(f'{screw.name}_{lubricant.name}.npz')
    data = build_closed_form(screw, lubricant, settings, progress=_show_progress)
    write(out, data)
    print(f'{out}: {data.mask.size} nodes, sha256 {data.sha256}')
    return 0


def _range(
    name: str, unit: str, ends: list[float], lowest: float = -math.inf
) -> tuple[float, float]:
    """Return a checked range in the unit in which it was typed."""
    low, high = ends
    if not (math.isfinite(low) and math.isfinite(high) and lowest < low < high):
        above = f'above {lowest:g}, ' if math.isfinite(lowest) else ''
        raise InputError(
            f'{name} is {low:g} to {high:g} {unit}, allowed is {above}the low end first'
        )
    return low, high


def _show_progress(done: int, total: int) -> None:
    if sys.stderr.isatty():
        bar = '#' * (40 * done // total)
        print(
            f'\r[{bar:40}] {done}/{total} slices',
            end='\n' if done == total else '',
            file=sys.stderr,
            flush=True,
        )


def _info(args: argparse.Namespace) -> int:
    path = args.file or shipped_surface()
    surface = Surface.load(path)
    low, high = surface.speed_range
    record = {
        'file': str(path),
        'sha256': surface.sha256,
        'tier': surface.tier,
        'screw': surface.screw_name,
        'oil': surface.oil_name,
        'speed_range_rad_s': [low, high],
        'load_range_N': list(surface.load_range),
        'temperature_range_K': list(surface.temperature_range),
        'cells': list(surface.cells),
        'masked_cells': surface.masked_cells,
        'errors': {
            name: {'max': worst, 'p95': usual}
            for name, (worst, usual) in sorted(surface.errors.items())
        },
    }
    print(
        json.dumps(to_json(record), indent=2, allow_nan=False) if args.json else _info_page(record)
    )
    return 0


def _info_page(record: dict[str, Any]) -> str:
    low, high = record['speed_range_rad_s']
    cold, warm = record['temperature_range_K']
    return '\n'.join(
        [
            f'{record["file"]}',
            f'  tier         {record["tier"]}',
            f'  screw, oil   {record["screw"]}, {record["oil"]}',
            f'  sha256       {record["sha256"]}',
            f'  speed        {low * 30 / math.pi:.3g} to {high * 30 / math.pi:.4g} rev/min',
            '  load         {:g} to {:g} N, positive opposes the motion'.format(
                *record['load_range_N']
            ),
            f'  temperature  {cold - ZERO_CELSIUS:g} to {warm - ZERO_CELSIUS:g} degC',
            '  cells        {} x {} x {}'.format(*record['cells'])
            + f', {record["masked_cells"]} masked',
            '  measured interpolation error                  max         p95',
            *(
                f'    {name + " [" + UNITS.get(name, "-") + "]":42} {error["max"]:<10.3g}  '
                f'{error["p95"]:.3g}'
                for name, error in record['errors'].items()
            ),
        ]
    )


def _check(args: argparse.Namespace) -> int:
    path = args.file or shipped_surface()
    if args.points < 1:
        raise InputError(f'--points is {args.points}, allowed is 1 or more')
    if not 0.0 < args.max_seconds < math.inf:
        raise InputError(f'--max-seconds is {args.max_seconds:g} s, allowed is above 0')
    data = read(path)
    surface = Surface(data)
    screw, lubricant = _inputs(data)
    deadline, drawn = time.monotonic() + args.max_seconds, random.Random(args.seed)
    errors: list[tuple[float, float]] = []
    done = 0
    while done < args.points and time.monotonic() < deadline:
        errors += _compare(surface, screw, lubricant, drawn)
        done += 1
    worst = [max(column) for column in zip(*errors)] or [math.nan, math.nan]
    silent = done - len(errors)
    # Written so that a NaN fails.
    passed = worst[0] <= EFFICIENCY_TOLERANCE and worst[1] <= 1.0 and not silent
    print(
        f'{path}: {"passed" if passed else "FAILED"}, hash verified, {done} of {args.points} '
        f'points solved, {silent} without an answer, largest error: efficiency '
        f'{worst[0]:.2g} (allowed {EFFICIENCY_TOLERANCE}), RCS '
        f'{100 * worst[1]:.0f} % of the allowed'
    )
    return 0 if passed else 1


def _inputs(data: SurfaceData) -> tuple[Screw, Lubricant]:
    """Rebuild the datasheets from the header, so that a check needs the file alone."""
    from surrogate.parameters import Material, Roughness

    screw, lubricant = (dict(data.header['inputs'][kind]) for kind in ('screw', 'lubricant'))
    for name, cls in (('raceway', Material), ('ball', Material), ('roughness', Roughness)):
        screw[name] = cls(**screw[name])
    return Screw(**screw), Lubricant(**lubricant)


def _compare(
    surface: Surface, screw: Screw, lubricant: Lubricant, drawn: random.Random
) -> list[tuple[float, float]]:
    """
    Compare at a random point; nothing where the surface has no number.

    Error of the efficiency [-], and error of RCS over the allowed one [-].

    """
    from surrogate import closed_form, torque

    slow, fast = surface.speed_range
    speed = math.exp(drawn.uniform(math.log(slow), math.log(fast)))
    load = drawn.uniform(*surface.load_range)
    kelvin = drawn.uniform(*surface.temperature_range)
    solved = closed_form.solve(screw, lubricant, speed, load, kelvin)
    found = surface.lookup(speed, load, kelvin)
    rcs = float(solved.rcs)
    allowed = RCS_TOLERANCE if rcs < RCS_SMALL else RCS_RELATIVE_TOLERANCE * rcs
    efficiency = torque.efficiency(float(solved.friction_torque), load, screw.lead)
    errors = abs(found.efficiency - efficiency), abs(found.rcs - rcs) / allowed
    return [errors] if all(math.isfinite(error) for error in errors) else []
