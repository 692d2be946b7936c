# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `surface sweep`: a surface of every combination of a catalogue."""

import argparse
from pathlib import Path
from typing import Any

from surrogate.commands.point import examine


def add_sweep_command(actions: Any) -> None:
    """Add the subcommand to those of `surface`."""
    parser = actions.add_parser(
        'sweep',
        help='build the surfaces of a catalogue',
        epilog='Exit code 1: one item or more failed; the others are built.',
    )
    text = 'screws, oils and roughness to be combined'
    parser.add_argument('catalogue', type=Path, metavar='CATALOGUE.yaml', help=text)
    parser.add_argument(
        '--out', type=Path, default=Path('surfaces'), metavar='DIR', help='default: surfaces'
    )
    add_workers(parser)
    parser.set_defaults(handler=_sweep)


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add where the solves of a command are done."""
    parser.add_argument(
        '--workers', type=int, metavar='N', help='processes on this machine (default: all cores)'
    )
    parser.add_argument(
        '--dask',
        metavar='ADDRESS',
        help='scheduler of a Dask cluster, such as tcp://host:8786, or local for one started here',
    )


def _sweep(args: argparse.Namespace) -> int:
    from surrogate.builder.sweep import Built, load_catalogue, sweep
    from surrogate.builder.sweep_report import JSON_NAME, PAGE_NAME, SweepReport
    from surrogate.compiler import check
    from surrogate.tasks.progress import Progress
    from surrogate.tasks.workers import open_pool

    items = load_catalogue(args.catalogue)
    if any(item.tier == 'full' for item in items):
        check()
    for screw in dict.fromkeys(item.screw for item in items):
        examine(screw)
    report = SweepReport(args.catalogue, items, args.out)
    report.write()
    progress = Progress(len(items), 'surfaces')

    def take(built: Built) -> None:
        report.add(built)
        progress.step()

    with open_pool(args.workers, args.dask) as pool:
        sweep(items, args.out, pool, take)
    counts = report.record()['counts']
    print(
        f'{args.out}: {counts["built"]} surfaces built, {counts["failed"]} failed, '
        f'report in {PAGE_NAME} and {JSON_NAME}'
    )
    return 1 if counts['failed'] else 0
