# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `point`: solve the screw at one operating point."""

import argparse
from dataclasses import replace
import functools
from pathlib import Path
from typing import Any

from surrogate.commands.output import add_json, draw_into, show, tell
from surrogate.files import InputError
from surrogate.parameters import (
    load_lubricant,
    load_screw,
    Lubricant,
    OperatingPoint,
    Screw,
    screw_and_oil,
)
from surrogate.surface.file import read, SurfaceError
from surrogate.surface.shipped import shipped_surface, SHIPPED_TIERS
from surrogate.tasks.progress import Progress
from surrogate.units import RPM, ZERO_CELSIUS

FULL_ONLY = ('kinematics', 'plot')
"""Options of the full tier alone."""


def add_point_command(subparsers: Any) -> None:
    """Add `point`; its handler imports the model that is asked for."""
    parser = subparsers.add_parser('point', help='solve one operating point')
    add_inputs(parser)
    add_operating_point(parser, required=True)
    parser.add_argument(
        '--tier',
        choices=('closed_form', 'full'),
        help='model: four solved contacts and balanced balls (default), or published formulas',
    )
    parser.add_argument(
        '--kinematics',
        choices=('rolling', 'smooth'),
        help='full tier: roughness that rolls with the raceway (default), or none',
    )
    parser.add_argument(
        '--isothermal', action='store_true', help='films that shear in the inlet does not thin'
    )
    parser.add_argument(
        '--sensitivity',
        action='store_true',
        help='closed form: onset, torque and zone over the likely range of each input (a minute)',
    )
    add_json(parser)
    parser.add_argument(
        '--plot',
        type=Path,
        metavar='DIR',
        help='full tier or sensitivity: directory for a picture (PNG)',
    )
    parser.set_defaults(handler=_point)


def add_inputs(parser: argparse.ArgumentParser) -> None:
    """Add the datasheets of screw and oil."""
    parser.add_argument(
        '--screw',
        default='nominal',
        metavar='NAME|FILE',
        help='screw datasheet (default nominal), one that is shipped with the marches of its '
        'surface; or a surface (.npz) with its marches',
    )
    parser.add_argument(
        '--oil',
        metavar='NAME|FILE',
        help='oil datasheet (default iso_vg_68, or that of the surface)',
    )
    add_verbose(parser)


def add_verbose(parser: argparse.ArgumentParser) -> None:
    """Add what tells more than asks for something to be done."""
    parser.add_argument(
        '--verbose',
        action='store_true',
        help='also tell what asks for nothing to be done: formulas beyond the range that they '
        'were fitted over, an unusual static rating',
    )


def load_inputs(args: argparse.Namespace) -> tuple[Screw, Lubricant]:
    """Return the sheets of screw and oil; raises InputError, also for what no screw has."""
    screw, lubricant = _sheets(args.screw)
    if args.oil:
        lubricant = load_lubricant(args.oil)
    examine(screw, verbose=args.verbose)
    return screw, lubricant


def _sheets(screw: str) -> tuple[Screw, Lubricant]:
    if screw.endswith('.npz'):
        return screw_and_oil(read(screw).header['inputs'])
    lubricant = load_lubricant('iso_vg_68')
    sheet = load_screw(screw)
    try:
        path = shipped_surface(sheet.name, lubricant.name, SHIPPED_TIERS[0])
    except SurfaceError:
        return sheet, lubricant
    # A shipped screw has the marches of its shipped surface.
    stated = read(path).header['inputs']['screw']
    raceway = stated['roughness']
    marches = {name: raceway[name] for name in sheet.roughness.MARCHED if name in raceway}
    marched = replace(sheet, roughness=replace(sheet.roughness, **marches))
    return marched if marched.stated() == stated else sheet, lubricant


def examine(screw: Screw, *, verbose: bool = False) -> None:
    """Tell what is unusual in a sheet; raises InputError for what no screw has."""
    from surrogate.formulas.plausibility import check_plausible, doubts

    check_plausible(screw)
    tell(doubts(screw, rating=verbose))


def add_operating_point(parser: argparse.ArgumentParser, *, required: bool) -> None:
    """Add speed, load and temperature, the first two `required` or not."""
    parser.add_argument(
        '--speed-rpm',
        type=float,
        required=required,
        metavar='N',
        help='screw speed [rev/min], the sign is the direction of motion',
    )
    parser.add_argument(
        '--load-N',
        type=float,
        required=required,
        metavar='F',
        dest='load',
        help='axial load [N]; it opposes the motion when it has the sign of the speed',
    )
    add_temperature(parser)


def add_temperature(parser: argparse.ArgumentParser) -> None:
    """Add the temperature of the oil, which `oil_temperature` reads."""
    parser.add_argument(
        '--temperature-degC',
        type=float,
        metavar='T',
        dest='temperature',
        help='oil temperature [degC], default that of the oil datasheet',
    )


def _point(args: argparse.Namespace) -> int:
    from surrogate.builder.sheets_onset import onset_of_sheets
    from surrogate.formulas.shaft import shaft_doubts
    from surrogate.screw.closed_form_record import closed_form_record, page

    _check(args)
    screw, lubricant = load_inputs(args)
    tell(shaft_doubts(screw, abs(args.speed_rpm) * RPM, abs(args.load)))
    kelvin = oil_temperature(args, lubricant)
    point = OperatingPoint(speed=args.speed_rpm * RPM, load=args.load, temperature=kelvin)
    if args.plot:
        prepare(args.plot)
    if args.sensitivity:
        from surrogate.screw.sensitivity import sensitivity_page, sensitivity_record

        progress = Progress(0, 'inputs')  # seconds for each that changes the topography
        try:
            record = sensitivity_record(screw, lubricant, point, progress=progress.show)
        finally:
            progress.close()
        show(record, sensitivity_page, json=args.json)
        if args.plot:
            from surrogate.screw.figures import draw_sensitivity

            draw_into(args.plot, lambda folder: [draw_sensitivity(folder, record)])
        return 0
    solution: Any = None
    if args.tier == 'full':
        solution, record = _full(args, screw, lubricant, point)
    else:
        record = closed_form_record(screw, lubricant, point, inlet_heating=not args.isothermal)
    onset = onset_of_sheets(screw, lubricant, kelvin)
    told = functools.partial(page, verbose=args.verbose)
    show(record | {'contact_onset': onset.record()}, told, json=args.json)
    if args.plot:
        from surrogate.screw.figures import draw_point

        draw_into(args.plot, lambda folder: [draw_point(folder, screw, solution, record)])
    return 0 if record.get('converged', True) else 1


def _check(args: argparse.Namespace) -> None:
    if args.sensitivity and args.tier == 'full':
        raise InputError('--sensitivity is given with --tier full, allowed is the closed form')
    if args.sensitivity and args.isothermal:
        raise InputError('--sensitivity is given with --isothermal, allowed is a heated inlet')
    args.tier = args.tier or ('closed_form' if args.sensitivity else SHIPPED_TIERS[0])
    for name in FULL_ONLY:
        given = getattr(args, name)
        drawn = name == 'plot' and args.sensitivity
        if given is not None and given is not False and args.tier != 'full' and not drawn:
            other = ' or --sensitivity' * (name == 'plot')
            raise InputError(f'--{name.replace("_", "-")} needs --tier full{other}')


def _full(
    args: argparse.Namespace, screw: Screw, lubricant: Lubricant, point: OperatingPoint
) -> tuple[Any, dict[str, Any]]:
    """Return a point of the full tier and its record; only this loads the contact solver."""
    from surrogate.compiler import check
    from surrogate.screw.contacts import ScrewSettings
    from surrogate.screw.full_record import full_record

    check()
    settings = ScrewSettings(
        kinematics=args.kinematics or 'rolling', inlet_heating=not args.isothermal
    )
    return full_record(screw, lubricant, point, settings)


def oil_temperature(args: argparse.Namespace, lubricant: Lubricant) -> float:
    """Return the oil temperature that was asked for [K], by default that of the datasheet."""
    if args.temperature is None:
        return lubricant.reference_temperature
    return float(args.temperature) + ZERO_CELSIUS


def prepare(folder: Path) -> None:
    """Make the directory of the picture before the long work."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f'--plot: {folder} cannot be made, {error.strerror}') from None
