# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `figures`: every result figure of the published study, from our model."""

import argparse
import csv
from pathlib import Path
import sys
from typing import Any

from surrogate.commands.sweep import add_workers
from surrogate.files import InputError, replace_file
from surrogate.studies.tasks import FIGURES, tasks
from surrogate.tasks.progress import Progress

DRAWS = 12
"""Draws of the contacts unless said otherwise [-]."""


def add_figures_command(subparsers: Any) -> None:
    """Add `figures`; its handler imports solver and plots, so that other commands start fast."""
    parser = subparsers.add_parser(
        'figures', help='make the figures of the published study from our model'
    )
    parser.add_argument(
        '--out', type=Path, required=True, metavar='DIR', help='folder of pictures and numbers'
    )
    parser.add_argument(
        '--draws',
        type=int,
        default=DRAWS,
        metavar='N',
        help='draws of the standing roughness of single contacts (default %(default)s)',
    )
    parser.add_argument(
        '--only', nargs='+', default=None, metavar='FIGURE', help=f'some of {", ".join(FIGURES)}'
    )
    parser.add_argument(
        '--measured',
        type=Path,
        metavar='CSV',
        help='measured torque for figure 6b: speed_rev_min, torque_Nm and, if known, deviation_Nm',
    )
    add_workers(parser)
    parser.set_defaults(handler=_figures)


def _figures(args: argparse.Namespace) -> int:
    """Solve what is missing, draw, print the numbers; exit code 1 when a solve failed."""
    figures = tuple(args.only or FIGURES)
    wanted = tasks(figures, args.draws)
    from surrogate.compiler import check
    from surrogate.parameters import load_screw
    from surrogate.screw.opened import Contacts
    from surrogate.studies.figures import draw_figures
    from surrogate.studies.report import report
    from surrogate.studies.solve import run_study
    from surrogate.tasks.workers import open_pool

    check()  # before a study takes each point for one that fails
    measured = read_measured(args.measured) if args.measured else None
    with open_pool(args.workers, args.dask) as pool:
        study = run_study(args.out, wanted, pool, Progress(len(wanted), 'solves').show)
    failed = [row for row in study.rows.values() if row.status != 'CONVERGED']
    for row in failed:
        print(f'ballscrew: {row.key} did not converge: {row.status}', file=sys.stderr)
    for path in draw_figures(study, figures, args.out, measured):
        print(path, file=sys.stderr)
    screw = load_screw('nominal')
    text = report(screw, Contacts.of(screw).law, study.rows)
    replace_file(args.out / 'paper.md', text.encode())
    print(args.out / 'paper.md', file=sys.stderr)
    print(text, end='')
    return 1 if failed else 0


def read_measured(path: Path) -> Any:
    """
    Return measured speeds [rev/min], torques and their standard deviations [N m] of a CSV.

    Columns speed_rev_min, torque_Nm and, if known, deviation_Nm. Raises InputError.

    """
    import numpy as np

    names = ('speed_rev_min', 'torque_Nm', 'deviation_Nm')
    try:
        with path.open(newline='', encoding='utf-8') as file:
            lines = list(csv.DictReader(file))
        columns = [[float(line.get(name) or 'nan') for line in lines] for name in names]
        rpm, torque, deviation = np.array(columns)
        if not lines or not (np.isfinite([rpm, torque]).all() and (rpm > 0).all()):
            raise ValueError('needs numbers in speed_rev_min, above 0, and torque_Nm')
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        raise InputError(f'--measured: {path} cannot be read, {error}') from None
    return rpm, torque, np.nan_to_num(deviation)
