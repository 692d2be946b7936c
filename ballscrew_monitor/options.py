# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the commands that need ROS may be told on the command line, and their defaults."""

import argparse
from pathlib import Path

from surrogate.cli import add_workers

TREE = Path(__file__).resolve().parent.parent
"""The repository, when the package runs from it: the defaults hold in any working directory."""
BAG, PARAMS = TREE / 'bags' / 'nominal_cycle', TREE / 'config' / 'nominal_cycle.yaml'
BAG_TEXT, PARAMS_TEXT = (f'{path.relative_to(TREE)} of the repository' for path in (BAG, PARAMS))
OUT = Path('out')
Parser = argparse.ArgumentParser


def _add_params(parser: Parser) -> None:
    parser.add_argument(
        '--params',
        type=Path,
        default=PARAMS,
        metavar='FILE',
        help=f'parameters of the node (default {PARAMS_TEXT})',
    )


def _add_rate(parser: Parser) -> None:
    parser.add_argument(
        '--rate', type=float, default=1.0, help='bag time over wall time (default 1)'
    )


def add_run(parser: Parser) -> None:
    """Add what `ballscrew run` may be told."""
    parser.add_argument('--bag', type=Path, default=BAG, help=f'bag to play (default {BAG_TEXT})')
    _add_params(parser)
    parser.add_argument(
        '--out',
        type=Path,
        default=OUT,
        metavar='DIR',
        help='directory for recording, report and log (default %(default)s)',
    )
    _add_rate(parser)


def add_replay(parser: Parser) -> None:
    """Add what `ballscrew replay` may be told."""
    parser.add_argument(
        'logs',
        type=Path,
        nargs='+',
        metavar='LOG',
        help='bag directory or file, a folder of them; CSV or Parquet with --map',
    )
    parser.add_argument(
        '--map', type=Path, metavar='FILE', help='map of the columns of a CSV or Parquet file'
    )
    parser.add_argument(
        '--params',
        type=Path,
        metavar='FILE',
        help=f'parameters of the node (default those that the log carries, else {PARAMS_TEXT})',
    )
    parser.add_argument(
        '--out', type=Path, metavar='DIR', help='directory for the report, its tables and data'
    )
    parser.add_argument('--json', action='store_true', help='print JSON')
    add_workers(parser)


def add_import(parser: Parser) -> None:
    """Add what `ballscrew import` may be told."""
    parser.add_argument('log', type=Path, metavar='LOG', help='CSV or Parquet file')
    parser.add_argument(
        '--guess', action='store_true', help='print a first map of the columns, and nothing else'
    )
    parser.add_argument('--config', type=Path, metavar='MAP', help='map of the columns')
    parser.add_argument('--out', type=Path, metavar='BAG', help='directory of the bag to be made')


def add_play(parser: Parser) -> None:
    """Add what `ballscrew play` may be told."""
    parser.add_argument('bag', type=Path, metavar='BAG', help='bag directory or MCAP file')
    _add_params(parser)
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument(
        '--topics',
        nargs='+',
        metavar='TOPIC',
        help='play these topics (default: the inputs in the parameter file)',
    )
    chosen.add_argument('--all', action='store_true', help='play every topic of the bag')
    parser.add_argument(
        '--loop',
        action='store_true',
        help='play again and again until Ctrl-C; the stamps go on from one pass to the next',
    )
    _add_rate(parser)
    parser.add_argument(
        '--wait',
        type=float,
        default=10.0,
        metavar='SECONDS',
        help='longest wait for a subscriber of every topic (default 10)',
    )


def add_recover(parser: Parser) -> None:
    """Add what `ballscrew recover` may be told."""
    parser.add_argument(
        'file', type=Path, metavar='FILE', help='MCAP file, or the folder of an unfinished one'
    )


def add_events(parser: Parser) -> None:
    """Add what `ballscrew events` may be told."""
    parser.add_argument(
        'folder',
        type=Path,
        nargs='?',
        metavar='STATE_DIR',
        help='state_dir of the node (default that of /ballscrew_monitor of this user)',
    )
    parser.add_argument('--json', action='store_true', help='print a line of JSON for each entry')


def add_doctor(parser: Parser) -> None:
    """Add what `ballscrew doctor` may be told."""
    _add_params(parser)
    parser.add_argument(
        '--seconds',
        type=float,
        default=3.0,
        metavar='T',
        help='how long to listen (default 3); longer for slow topics',
    )
    parser.add_argument('--json', action='store_true', help='print JSON')


def add_solve(parser: Parser) -> None:
    """Add what `ballscrew solve` may be told."""
    parser.add_argument('--axis', required=True, help='name of the axis, such as x')
    parser.add_argument(
        '--speed-rpm',
        type=float,
        metavar='N',
        help='screw speed [rev/min]; none: the current point',
    )
    parser.add_argument(
        '--load-N',
        type=float,
        dest='load',
        metavar='F',
        help='axial load [N]; it opposes the motion when it has the sign of the speed',
    )
    parser.add_argument(
        '--temperature-degC',
        type=float,
        dest='temperature',
        metavar='T',
        help='oil temperature [degC] (default that of the axis)',
    )
    parser.add_argument(
        '--timeout',
        type=float,
        default=0.0,
        metavar='SECONDS',
        help="longest solve (default the node's)",
    )
    parser.add_argument('--node', default='', help='full name of the node, if there are several')
    parser.add_argument(
        '--wait',
        type=float,
        default=10.0,
        metavar='SECONDS',
        help='longest wait for the node (default 10)',
    )
    parser.add_argument('--json', action='store_true', help='print JSON')
