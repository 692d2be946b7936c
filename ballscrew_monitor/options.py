# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Options of the commands that need ROS, and their defaults."""

import argparse
from pathlib import Path
from typing import Any

from surrogate.commands.cli import add_workers

TREE = Path(__file__).resolve().parent.parent
"""The repository, when the package runs from it: the defaults hold in any working directory."""
BAG, PARAMS = TREE / 'bags' / 'nominal_cycle', TREE / 'config' / 'nominal_cycle.yaml'
BAG_TEXT, PARAMS_TEXT = (f'{path.relative_to(TREE)} of the repository' for path in (BAG, PARAMS))
MAP_TEXT = 'map of the columns of a table: CSV, Parquet or xlsx'
OUT = Path('out')
Parser = argparse.ArgumentParser
ENDINGS = {
    'run': 'Exit code 1: the node failed, or samples were lost.',
    'replay': 'Exit code 0: some motion was judged on at least one axis of each recording. 1: '
    'nothing was judged or nothing moved, or more samples of an axis stayed unjudged than '
    '--most-unjudged-percent allows; of several recordings, at least one could not be read.',
    'check': 'Exit code 1: as of replay.',
    'health': 'Exit code 1: no recording of several could be judged; with collect, at least one '
    'could not.',
    'solve': 'Exit code 1: not converged, rejected, timed out, or no node found. 130, 143: the '
    'solve is withdrawn.',
    'doctor': 'Exit code 1: findings. 2: a file that the node refuses.',
    'play': 'Exit code 1: nobody listens, or a monitor did not take all messages of an input.',
    'page': 'Exit code 2: an option is wrong, or the port is taken.',
}
"""Exit codes of a command beyond those of all commands."""


def _add_file(parser: Parser, name: str, metavar: str | None, text: str, **more: Any) -> None:
    parser.add_argument(name, type=Path, metavar=metavar, help=text, **more)


def _add_number(parser: Parser, name: str, metavar: str | None, text: str, **more: Any) -> None:
    parser.add_argument(name, type=float, metavar=metavar, help=text, **more)


def _add_switch(parser: Parser, name: str, text: str) -> None:
    parser.add_argument(name, action='store_true', help=text)


def _add_params(parser: Parser) -> None:
    text = f'parameters of the node (default {PARAMS_TEXT})'
    _add_file(parser, '--params', 'FILE', text, default=PARAMS)


def _add_most_unjudged(parser: Parser) -> None:
    text = 'share of the speed samples of an axis that may stay unjudged (default 5)'
    _add_number(parser, '--most-unjudged-percent', 'P', text, dest='most_unjudged', default=5.0)


def _add_rate(parser: Parser) -> None:
    _add_number(parser, '--rate', None, 'bag time over wall time (default 1)', default=1.0)


def _add_wait(parser: Parser, whom: str) -> None:
    _add_number(parser, '--wait', 'SECONDS', f'longest wait for {whom} (default 10)', default=10.0)


def add_run(parser: Parser) -> None:
    """Add what `ballscrew run` may be told."""
    _add_file(parser, '--bag', None, f'bag to play (default {BAG_TEXT})', default=BAG)
    _add_params(parser)
    text = 'directory for recording, report and log (default %(default)s)'
    _add_file(parser, '--out', 'DIR', text, default=OUT)
    _add_rate(parser)


def add_replay(parser: Parser) -> None:
    """Add what `ballscrew replay` may be told."""
    text = 'bag directory or file, a folder of them; a table with --map'
    _add_file(parser, 'logs', 'LOG', text, nargs='+')
    _add_file(parser, '--map', 'FILE', MAP_TEXT)
    text = f'parameters of the node (default those that the log carries, else {PARAMS_TEXT})'
    _add_file(parser, '--params', 'FILE', text)
    _add_file(parser, '--out', 'DIR', 'directory for the report, its tables and data')
    _add_most_unjudged(parser)
    _add_switch(parser, '--json', 'print JSON')
    add_workers(parser)


def add_check(parser: Parser) -> None:
    """Add what `ballscrew check` may be told."""
    _add_file(parser, 'folder', 'FOLDER', 'folder of logs, and of the sheets of screw and oil')
    text = 'screw datasheet (default the one in the folder, else the shipped nominal one)'
    parser.add_argument('--screw', metavar='NAME|FILE', help=text)
    text = 'oil datasheet (default the one in the folder, else iso_vg_68)'
    parser.add_argument('--oil', metavar='NAME|FILE', help=text)
    text = 'recordings in the folder that ran without process force, for an identification'
    parser.add_argument('--free-run', nargs='+', metavar='NAME', default=[], help=text)
    text = 'tier of a surface that is missing: solved contacts in a minute (default), or seconds'
    parser.add_argument('--tier', choices=('full', 'closed_form'), default='full', help=text)
    _add_file(parser, '--map', 'FILE', 'map of all tables (default: guessed for each, and kept)')
    text = f'parameters of bags (default those that a bag carries, else {PARAMS_TEXT})'
    _add_file(parser, '--params', 'FILE', text)
    text = 'directory for the page, reports, maps and surfaces (default %(default)s)'
    _add_file(parser, '--out', 'DIR', text, default=Path('check'))
    _add_most_unjudged(parser)
    _add_switch(parser, '--json', 'print JSON')
    add_workers(parser)


def add_health(parser: Parser) -> None:
    """Add what `ballscrew health` may be told."""
    text = (
        'bag directory or file, a folder of them; a table with --map; state_dir of a node; a '
        'folder of collected logs. As first word, collect: keep what the logs hold in --out'
    )
    _add_file(parser, 'logs', 'LOG', text, nargs='+')
    _add_file(parser, '--map', 'FILE', MAP_TEXT)
    text = f'parameters of the node (default those that a log carries, else {PARAMS_TEXT})'
    _add_file(parser, '--params', 'FILE', text)
    text = 'days of the first logs that are normal (default 91), three logs at least'
    _add_number(parser, '--baseline-days', 'D', text, default=91.0)
    text = 'days that are normal, both included, UTC (default: the first ones in motion)'
    parser.add_argument('--baseline', nargs=2, metavar=('FROM', 'TO'), help=text)
    text = 'let the advice name other speeds, as advice.speed does: the process is free'
    _add_switch(parser, '--speed-advice', text)
    text = 'directory for health.json and health.png; with collect, for what is kept'
    _add_file(parser, '--out', 'DIR', text)
    _add_switch(parser, '--json', 'print JSON')
    add_workers(parser)


def add_fingerprint(parser: Parser) -> None:
    """Add what `ballscrew fingerprint` may be told."""
    _add_file(parser, '--surface', 'FILE', 'surface of the screw (default: the nominal one)')
    _add_number(parser, '--travel-mm', 'X', 'free travel of the axis [mm]', required=True)
    text = 'letter of the axis in the program (default %(default)s)'
    parser.add_argument('--axis', default='X', metavar='LETTER', help=text)
    text = 'position at which the runs begin, in the coordinates of the program (default: here)'
    _add_number(parser, '--start-mm', 'X', text)
    dialects = 'iso', 'sinumerik', 'heidenhain', 'linuxcnc'
    text = 'dialect of the control (default %(default)s)'
    parser.add_argument('--dialect', choices=dialects, default='iso', help=text)
    text = 'runs, with a dwell between them (default %(default)s)'
    parser.add_argument('--runs', type=int, default=1, metavar='N', help=text)


def add_import(parser: Parser) -> None:
    """Add what `ballscrew import` may be told."""
    _add_file(parser, 'log', 'LOG', 'table: CSV, Parquet or xlsx')
    _add_switch(parser, '--guess', 'print a first map of the columns, and nothing else')
    _add_file(parser, '--config', 'MAP', 'map of the columns')
    _add_file(parser, '--out', 'BAG', 'directory of the bag to be made')


def add_play(parser: Parser) -> None:
    """Add what `ballscrew play` may be told."""
    _add_file(parser, 'bag', 'BAG', 'bag directory or MCAP file')
    _add_params(parser)
    chosen = parser.add_mutually_exclusive_group()
    text = 'play these topics (default: the inputs in the parameter file)'
    chosen.add_argument('--topics', nargs='+', metavar='TOPIC', help=text)
    chosen.add_argument('--all', action='store_true', help='play every topic of the bag')
    text = 'play again and again until Ctrl-C; the stamps go on from one pass to the next'
    _add_switch(parser, '--loop', text)
    _add_rate(parser)
    _add_wait(parser, 'a subscriber of every topic')


def add_recover(parser: Parser) -> None:
    """Add what `ballscrew recover` may be told."""
    _add_file(parser, 'file', 'FILE', 'MCAP file, or the folder of an unfinished one')


def add_report_fault(parser: Parser) -> None:
    """Add what `ballscrew report-fault` may be told."""
    text = (
        'bag, folder of recordings, table of text, or state_dir (default that of '
        '/ballscrew_monitor of this user)'
    )
    _add_file(parser, 'paths', 'LOG|STATE_DIR', text, nargs='*')
    _add_file(parser, '--params', 'FILE', 'parameters of the node, if no recording holds them')
    text = 'text of a failure (default: the last failures of commands of this user)'
    _add_file(parser, '--failure', 'FILE', text, nargs='+')
    text = 'time before the end of a bag that is put in (default 2)'
    _add_number(parser, '--minutes', 'T', text, default=2.0)
    text = (
        'what is not hidden: names of machines, of users and their homes, of persons with their '
        'reasons; tables that are no text'
    )
    things = 'hosts', 'users', 'names', 'tables'
    parser.add_argument('--include', nargs='+', choices=things, default=[], help=text)
    text = 'the file (default %(default)s)'
    _add_file(parser, '--out', 'ZIP', text, default=Path('ballscrew_fault.zip'))


def add_events(parser: Parser) -> None:
    """Add what `ballscrew events` may be told."""
    text = 'state_dir of the node (default that of /ballscrew_monitor of this user)'
    _add_file(parser, 'folder', 'STATE_DIR', text, nargs='?')
    _add_switch(parser, '--json', 'print a line of JSON for each entry')


def add_doctor(parser: Parser) -> None:
    """Add what `ballscrew doctor` may be told."""
    _add_params(parser)
    text = 'how long to listen (default 3); longer for slow topics'
    _add_number(parser, '--seconds', 'T', text, default=3.0)
    _add_switch(parser, '--json', 'print JSON')


def add_solve(parser: Parser) -> None:
    """Add what `ballscrew solve` may be told."""
    parser.add_argument('--axis', required=True, help='name of the axis, such as x')
    _add_number(parser, '--speed-rpm', 'N', 'screw speed [rev/min]; none: the current point')
    text = 'axial load [N]; it opposes the motion when it has the sign of the speed'
    _add_number(parser, '--load-N', 'F', text, dest='load')
    text = 'oil temperature [degC] (default that of the axis)'
    _add_number(parser, '--temperature-degC', 'T', text, dest='temperature')
    text = "longest solve (default the node's)"
    _add_number(parser, '--timeout', 'SECONDS', text, default=0.0)
    parser.add_argument('--node', default='', help='full name of the node, if there are several')
    _add_wait(parser, 'the node')
    _add_switch(parser, '--json', 'print JSON')


def add_page(parser: Parser) -> None:
    """Add what `ballscrew page` may be told."""
    text = 'recording to play (default: the running nodes), a bag, or a table with --map'
    _add_file(parser, 'log', 'LOG', text, nargs='?')
    _add_file(parser, '--map', 'FILE', MAP_TEXT)
    text = f'parameters of a recording (default those that it carries, else {PARAMS_TEXT})'
    _add_file(parser, '--params', 'FILE', text)
    text = 'full name of the node (default all of them, as they come and go)'
    parser.add_argument('--node', default='', help=text)
    text = 'address to serve at (default %(default)s); any other needs --token-file'
    parser.add_argument('--host', default='127.0.0.1', help=text)
    text = 'port to serve at (default %(default)s)'
    parser.add_argument('--port', type=int, default=8090, help=text)
    _add_file(parser, '--token-file', 'FILE', 'file whose first line opens the page to a reader')
    _add_file(parser, '--cert', 'FILE', 'certificate of the server in PEM, for https')
    _add_file(parser, '--key', 'FILE', 'its key')
    text = 'let readers acknowledge, shelve and ask for full solves'
    _add_switch(parser, '--allow-acting', text)
    text = 'language of the page, such as en (default that of the browser)'
    parser.add_argument('--language', default='', help=text)
    text = 'surfaces of the same screw with other oils, for what-if maps'
    _add_file(parser, '--oils', 'SURFACE', text, nargs='+', default=[])
