# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `contact`: solve one contact from a case file."""

import argparse
import logging
from pathlib import Path
from typing import Any

from surrogate.commands.output import add_json, draw_into, show
from surrogate.tasks.progress import Progress


def add_contact_command(subparsers: Any) -> None:
    """Add `contact`; its handler imports the solver, so that other commands start fast."""
    parser = subparsers.add_parser('contact', help='solve one contact from a case file')
    parser.add_argument('case', metavar='CASE', help='case file (YAML) or shipped case')
    add_json(parser)
    parser.add_argument('--plot', type=Path, metavar='DIR', help='directory for pictures (PNG)')
    parser.set_defaults(handler=_contact)


def _contact(args: argparse.Namespace) -> int:
    """Solve a case; exit code 1 when the solution is not converged."""
    from surrogate.contact.case import load_case
    from surrogate.contact.record import contact_page, contact_record

    # What was done to a surface belongs to the result, so it is said whatever the output.
    logging.basicConfig(level=logging.INFO, format='ballscrew: %(message)s')
    case = load_case(args.case)
    solution, surface = _solved(case)
    record = contact_record(case, solution, surface)
    show(record, lambda record: contact_page(record, case, solution, surface), json=args.json)
    if args.plot:
        from surrogate.contact.figures import draw_contact

        draw_into(args.plot, lambda folder: draw_contact(folder, solution, surface))
    return 0 if solution.converged else 1


def _solved(case: Any) -> tuple[Any, Any]:
    if case.kinematics == 'standing':
        from surrogate.contact.solve import solve_case

        return solve_case(case)
    from surrogate.contact.rolling import march_case
    from surrogate.ehl.watch import Iteration, watched

    progress = Progress(0, 'steps')

    def show_step(now: Iteration) -> None:
        if now.steps:
            progress.show(now.step, now.steps)

    try:
        with watched(show_step):
            return march_case(case)
    finally:
        progress.close()
