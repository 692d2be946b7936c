# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `figures`: trends and figures of the published study, from our model."""

import argparse
from pathlib import Path
import sys
from typing import Any

from surrogate.commands.sweep import add_workers
from surrogate.files import replace_file
from surrogate.studies.tasks import FIGURES, tasks
from surrogate.tasks.progress import Progress

DRAWS = 12
"""Draws of the contacts unless said otherwise [-]."""


def add_figures_command(subparsers: Any) -> None:
    """Add `figures`; its handler imports solver and plots, so that other commands start fast."""
    parser = subparsers.add_parser(
        'figures', help='make trends and figures of the published study from our model'
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
    with open_pool(args.workers, args.dask) as pool:
        rows = run_study(args.out, wanted, pool, Progress(len(wanted), 'solves').show)
    failed = [row for row in rows.values() if row.status != 'CONVERGED']
    for row in failed:
        print(f'ballscrew: {row.key} did not converge: {row.status}', file=sys.stderr)
    screw = load_screw('nominal')
    law = Contacts.of(screw).law
    for path in draw_figures(screw, law, list(rows.values()), figures, args.out):
        print(path, file=sys.stderr)
    text = report(screw, law, rows)
    replace_file(args.out / 'paper.md', text.encode())
    print(args.out / 'paper.md', file=sys.stderr)
    print(text, end='')
    return 1 if failed else 0
