# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `identify`: parasitic torque from torque measured without load."""

import argparse
from collections.abc import Callable, Mapping
import math
from pathlib import Path
import sys
from typing import Any

from surrogate.commands.output import add_json, draw_into, show
from surrogate.commands.point import add_inputs, load_inputs
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw
from surrogate.tasks.progress import Progress
from surrogate.units import ZERO_CELSIUS

FITTED = {'viscosity': 'viscosity_factor', 'asperity_friction': 'asperity_friction'}
"""What `--fit` takes, and the parameter that it means."""
COLUMN_OPTIONS = ('speed_column', 'torque_column', 'torque_constant')
BAG_OPTIONS = (
    'speed_topic',
    'speed_field',
    'speed_unit',
    'torque_topic',
    'torque_field',
    'torque_scale',
    'temperature_topic',
    'temperature_field',
)

TABLES = ('.csv', '.tsv', '.txt', '.parquet', '.xlsx')
"""Endings of tables; any other log is a bag."""
LogReader = Callable[[argparse.Namespace, float], tuple[dict[str, Any], tuple[str, ...]]]
"""Return columns in SI units and notes, for the arguments and the lead [m]."""


def add_identify_command(subparsers: Any, readers: Mapping[str, LogReader]) -> None:
    """Add `identify`; `readers` read a `bag` and a `table`, which this half cannot."""
    parser = subparsers.add_parser(
        'identify',
        help='find the parasitic torque from torque measured without load',
        epilog='Exit code 1: the fit did not converge, or the onset was refused: no sheet is '
        'written.',
    )
    parser.add_argument('data', type=Path, metavar='DATA', help='table of points, or bag')
    add_inputs(parser)
    parser.add_argument(
        '--temperature-degC',
        type=float,
        metavar='T',
        dest='temperature',
        help='oil temperature [degC] where the data do not say, default that of the datasheet',
    )
    parser.add_argument(
        '--fit',
        action='append',
        choices=tuple(FITTED),
        default=[],
        help='identify this, too; may be repeated',
    )
    parser.add_argument(
        '--onset',
        action='store_true',
        help='identify where contact begins, too, from the torque that turns up at low speed',
    )
    parser.add_argument(
        '--tier',
        choices=('closed_form', 'full'),
        default='closed_form',
        help='model of the contacts, that of whoever uses the result (default %(default)s)',
    )
    parser.add_argument(
        '--loss',
        choices=('linear', 'soft_l1'),
        default='linear',
        help='least squares, or less weight for points far off (default %(default)s)',
    )
    parser.add_argument('--out', type=Path, metavar='FILE', help='datasheet to write (YAML)')
    parser.add_argument('--plot', type=Path, metavar='DIR', help='directory for the picture')
    add_json(parser)
    _add_sources(parser)
    parser.set_defaults(handler=_identify, readers=readers)


def _add_sources(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group('table')
    for name, usual in (('speed', 'speed_rpm'), ('torque', 'torque_Nm')):
        help_text = f'column with its unit in the name, such as {usual}; default the only one'
        group.add_argument(f'--{name}-column', metavar='NAME', help=help_text)
    group.add_argument(
        '--torque-constant',
        type=float,
        metavar='K',
        help='torque on the screw over the current, which takes its place [N m/A]',
    )
    group = parser.add_argument_group('bag')
    group.add_argument('--speed-topic', metavar='TOPIC', help='topic of the speed')
    group.add_argument('--speed-field', metavar='PATH', help='such as velocity[x_axis]')
    group.add_argument(
        '--speed-unit', metavar='UNIT', help='rad/s (default), rev/min, m/s, mm/s, mm/min, m/min'
    )
    group.add_argument('--torque-topic', metavar='TOPIC', help='default the topic of the speed')
    group.add_argument('--torque-field', metavar='PATH', help='such as effort[x_axis]')
    group.add_argument(
        '--torque-scale', type=float, metavar='K', help='torque on the screw [N m] over the field'
    )
    text = 'topic of the oil temperature'
    group.add_argument('--temperature-topic', metavar='TOPIC', help=text)
    group.add_argument('--temperature-field', metavar='PATH', help='in degC, default temperature')


def _identify(args: argparse.Namespace) -> int:
    """Identify, write and draw; exit code 1 when nothing was found that a sheet may have."""
    from surrogate.identify.fit import identify
    from surrogate.identify.record import identification_record, page

    _check(args)
    if args.tier == 'full':
        from surrogate.compiler import check

        check()
    screw, lubricant = load_inputs(args)
    run = _run(args, screw, lubricant)
    fitted = tuple(FITTED[name] for name in dict.fromkeys(args.fit))
    if args.onset:
        from surrogate.identify.onset import FITTED as fitted
    contacts: Any
    if args.tier == 'full':  # which alone loads the solver
        from surrogate.identify.table import solved_model

        report = Progress(0, 'speeds solved').show
        contacts = solved_model(screw, lubricant, run, fitted, progress=report)
    elif args.onset:
        from surrogate.identify.table import formula_model

        contacts = formula_model(screw, lubricant, run, fitted)
    else:
        from surrogate.identify.model import closed_form_model

        contacts = closed_form_model(screw, lubricant, run)
    result = identify(screw, run, contacts, fitted, loss=args.loss)
    record = identification_record(screw, run, contacts, result)
    show(record, page, json=args.json)
    usable = result.converged and not result.onset_refused
    if args.out and usable:
        _write(args.out, screw, lubricant, run, contacts, result)
    if args.plot:
        from surrogate.identify.figures import draw_identification

        title, onset = f'{screw.name}, {lubricant.name}, tier {contacts.tier}', record['onset']
        draw_into(
            args.plot, lambda folder: [draw_identification(folder, run, result, title, onset)]
        )
    return 0 if usable else 1


def _check(args: argparse.Namespace) -> None:
    """
    Raise InputError for options that contradict.

    Those are other fits beside the onset, a constant of 0, a temperature that no oil has, and an
    output that is an input.

    """
    if args.onset and (args.fit or args.loss != 'linear'):
        raise InputError(
            '--onset fits the asperity friction with it by least squares, allowed is neither '
            '--fit nor --loss beside it'
        )
    constant = args.torque_constant
    if constant is not None and not (math.isfinite(constant) and constant):
        raise InputError(
            f'--torque-constant is {constant:g} N m/A, allowed is a finite number other than 0'
        )
    kelvin = ZERO_CELSIUS if args.temperature is None else args.temperature + ZERO_CELSIUS
    if not 0 < kelvin < math.inf:
        raise InputError(
            f'--temperature-degC is {args.temperature:g} degC, allowed is a number above absolute '
            'zero'
        )
    if args.out is None:
        return
    for written in (args.out, _oil_sheet(args.out)):
        for name in ('screw', 'oil'):
            if written.resolve() == Path(getattr(args, name) or '').resolve():
                raise InputError(
                    f'--out: {written} is the datasheet given as --{name}, allowed is another file'
                )


def _oil_sheet(out: Path) -> Path:
    return out.with_name(f'{out.stem}_oil{out.suffix}')


def _run(args: argparse.Namespace, screw: Screw, lubricant: Lubricant) -> Any:
    from surrogate.identify.data import no_load_run

    kind = 'table' if args.data.suffix.lower() in TABLES else 'bag'
    _refuse(args, BAG_OPTIONS if kind == 'table' else COLUMN_OPTIONS, kind)
    if kind not in args.readers:
        raise InputError(f'{args.data}: is a {kind}, which only the command ballscrew reads')
    columns, notes = args.readers[kind](args, screw.lead)
    if args.temperature is not None and 'temperature' in columns:
        raise InputError(
            f'--temperature-degC is {args.temperature:g} degC, and {args.data} holds the '
            'temperature too: allowed is one of both'
        )
    kelvin = (
        lubricant.reference_temperature
        if args.temperature is None
        else args.temperature + ZERO_CELSIUS
    )
    return no_load_run(columns, source=args.data.name, temperature=kelvin, notes=notes)


def _refuse(args: argparse.Namespace, names: tuple[str, ...], kind: str) -> None:
    given = [name for name in names if getattr(args, name) is not None]
    if given:
        raise InputError(
            f'--{given[0].replace("_", "-")} has no meaning here: {args.data} is a {kind}'
        )


def _write(
    out: Path, screw: Screw, lubricant: Lubricant, run: Any, contacts: Any, result: Any
) -> None:
    """Write the screw, and beside it the oil where its viscosity was identified."""
    from datetime import date

    from surrogate.datasheet_writer import write_sheet
    from surrogate.identify.record import identified_oil, identified_screw

    day = date.today().isoformat()
    write_sheet(out, identified_screw(screw, run, contacts, result, day))
    print(out, file=sys.stderr)
    if 'viscosity_factor' in [estimate.name for estimate in result.estimates]:
        oil = _oil_sheet(out)
        write_sheet(oil, identified_oil(lubricant, run, contacts, result))
        print(oil, file=sys.stderr)
