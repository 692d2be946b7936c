# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `surface`: build, clean, describe; what inspects a file is in its own module."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
import functools
import math
from pathlib import Path
import sys
from typing import Any

from surrogate.builder.tiers import build_surface, default_settings, spreads
from surrogate.commands.output import add_json, show, tell
from surrogate.commands.point import add_inputs, add_verbose, load_inputs
from surrogate.commands.surface_inspect import add_file, add_inspect_commands
from surrogate.commands.sweep import add_sweep_command, add_workers
from surrogate.files import InputError
from surrogate.parameters import is_shipped, Lubricant, screw_and_oil
from surrogate.surface import find_surface, onset_of_surface, Surface
from surrogate.surface.file import read, TIERS, write
from surrogate.surface.shipped import SHIPPED_TIERS
from surrogate.tasks.progress import Progress
from surrogate.units import RPM, ZERO_CELSIUS

HALF_KELVIN, HELD_OUT = 0.5, 20
"""Half of the range of a surface at one temperature [K], its held-out points."""


def add_surface_command(subparsers: Any) -> None:
    """Add `surface` with all that it does; each sets `handler`, which takes the arguments."""
    surface = subparsers.add_parser(
        'surface', help='build, sweep, describe or check surface files'
    )
    actions = surface.add_subparsers(
        required=True, metavar='build|sweep|clean|info|check|query|plot|diff|export'
    )
    _add_build(actions.add_parser('build', help='build a surface file'))
    add_sweep_command(actions)
    clean = actions.add_parser('clean', help='remove kept results of an unfinished build')
    clean.add_argument('out', type=Path, metavar='OUT', help='surface that was being built')
    clean.set_defaults(handler=_clean)
    info = actions.add_parser('info', help='describe a surface file')
    add_file(info)
    add_verbose(info)
    add_json(info)
    info.set_defaults(handler=_info)
    add_inspect_commands(actions)


def _add_build(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser)
    parser.add_argument(
        '--tier',
        choices=TIERS,
        default=SHIPPED_TIERS[0],
        help='solved contacts in a minute (default), or published formulas alone in seconds',
    )
    for name, unit in (('speed', 'rpm'), ('load', 'N'), ('temperature', 'degC')):
        parser.add_argument(
            f'--{name}-range',
            type=float,
            nargs=2,
            metavar=('LOW', 'HIGH'),
            help=f'{name} range [{unit}]',
        )
    parser.add_argument(
        '--temperature-degC',
        type=float,
        metavar='T',
        dest='temperature',
        help='one temperature instead of a range: it answers within half a kelvin, a third of the '
        'work',
    )
    parser.add_argument('--out', type=Path, help='file to write (default SCREW_OIL.npz)')
    parser.add_argument(
        '--with-preloads',
        action='store_true',
        help='also write companions at 100, 80, 60 and 40 %% of the preload, by formulas alone, '
        'from which health tells the preload',
    )
    marches = parser.add_mutually_exclusive_group()
    marches.add_argument(
        '--law-only',
        action='store_true',
        help='full tier: leave out the marches of strips of this raceway, minutes, which correct '
        'where contact begins; a shipped, calibrated or marched screw has none anyway',
    )
    marches.add_argument('--march', action='store_true', help='march such a screw as well')
    add_workers(parser)
    parser.set_defaults(handler=_build)


def _build(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.describe import march_lines, surface_warnings

    screw, lubricant = load_inputs(args)
    ranges = _one_temperature(args, lubricant) if args.temperature is not None else {}
    if args.speed_range:
        low, high = _range('--speed-range', 'rpm', args.speed_range, lowest=0.0)
        ranges['speed_range'] = (low * RPM, high * RPM)
    if args.load_range:
        ranges['load_range'] = _range('--load-range', 'N', args.load_range)
    if args.temperature_range:
        low, high = _range('--temperature-range', 'degC', args.temperature_range)
        ranges['temperature_range'] = (low + ZERO_CELSIUS, high + ZERO_CELSIUS)
    out = args.out or Path(f'{screw.name}_{lubricant.name}.npz')
    settings = default_settings(args.tier, screw, ranges)
    measured = is_shipped(screw) or screw.roughness.measured
    progress = Progress(0, 'slices').show if sys.stderr.isatty() else lambda done, total: None
    with _workers(args) as pool:
        data = build_surface(
            args.tier,
            screw,
            lubricant,
            settings,
            progress=progress,
            pool=pool,
            out=out,
            march=args.march or not (args.law_only or measured),
        )
    write(out, data)
    print(f'{out}: tier {args.tier}, {data.mask.size} nodes, sha256 {data.sha256}')
    print(f'{onset_of_surface(Surface(data)).sentence()}.')
    for line in march_lines(data.header.get('march', {})):
        print(line)
    tell(surface_warnings(data) if args.verbose else [])
    if args.with_preloads:
        from surrogate.builder.companions import build_companions

        marched = replace(screw, roughness=screw_and_oil(data.header['inputs'])[0].roughness)
        for file in build_companions(marched, lubricant, ranges, out):
            print(f'{file}: companion at another preload')
    return 0


def _one_temperature(args: argparse.Namespace, lubricant: Lubricant) -> dict[str, Any]:
    """Return the settings of a surface at one temperature, within what the oil allows."""
    if args.temperature_range:
        raise InputError('--temperature-degC and --temperature-range are given, allowed is one')
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    kelvin = args.temperature + ZERO_CELSIUS
    if not low <= kelvin <= high:
        raise InputError(
            f'--temperature-degC is {args.temperature:g} degC, allowed is '
            f'{low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC (the range of the oil sheet)'
        )
    settings: dict[str, Any] = {
        'temperature_range': (max(kelvin - HALF_KELVIN, low), min(kelvin + HALF_KELVIN, high)),
        'temperature_nodes': 2,
    }
    return settings | ({'held_out': HELD_OUT} if spreads(args.tier) else {})


@contextmanager
def _workers(args: argparse.Namespace) -> Iterator[Any]:
    """Give workers to a builder that spreads its solves, and none to any other."""
    if not spreads(args.tier):
        if args.workers is not None or args.dask is not None:
            raise InputError(f'--workers and --dask have no meaning for tier {args.tier}')
        for word in ('march', 'law_only'):
            if getattr(args, word):
                option = f'--{word.replace("_", "-")}'
                raise InputError(f'{option} has no meaning for tier {args.tier}')
        yield None
        return
    from surrogate.tasks.workers import open_pool

    with open_pool(args.workers, args.dask) as pool:
        yield pool


def _range(
    name: str, unit: str, ends: list[float], lowest: float = -math.inf
) -> tuple[float, float]:
    low, high = ends
    if not (math.isfinite(low) and math.isfinite(high) and lowest < low < high):
        above = f'above {lowest:g}, ' if math.isfinite(lowest) else ''
        raise InputError(
            f'{name} is {low:g} to {high:g} {unit}, allowed is {above}the low end first'
        )
    return low, high


def _clean(args: argparse.Namespace) -> int:
    from surrogate.tasks.store import clear, store_path

    removed = clear(args.out)
    print(f'{store_path(args.out)}: {"removed" if removed else "nothing to remove"}')
    return 0


def _info(args: argparse.Namespace) -> int:
    from surrogate.surface_tools.describe import info_page, info_record

    path = find_surface(args.file)
    record = info_record(path, read(path))
    show(record, functools.partial(info_page, verbose=args.verbose), json=args.json)
    return 0
