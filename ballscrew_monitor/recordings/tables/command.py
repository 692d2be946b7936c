# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew import`: a first map of a table on standard output, or a bag made by a map."""

from pathlib import Path

from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.progress import shown_progress
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import say
from surrogate.files import InputError


def print_guess(log: Path) -> None:
    """Print a first map of a log, and to standard error what is to be said about it."""
    _check_log(log)
    made = guess(log, shown=shown_progress)
    print(made.text, end='')
    say(*made.notes)


def make_bag(log: Path, config: Path | None, out: Path | None) -> None:
    """Write a log as a bag to `out` by the map in `config`; raises InputError without them."""
    _check_log(log)
    if config is None or out is None:
        missing = '--config' if config is None else '--out'
        raise InputError(f'{missing} is missing; --guess prints a first map for --config')
    facts = convert(log, read_map(config), out, shown=shown_progress)
    say(*facts.notes)
    print(f'{out}: judge it by ballscrew replay {out}')
    for one in facts.assumptions:
        print(f'  assumed {one.key} = {one.value}: {one.reason}')


def _check_log(log: Path) -> None:
    if log.is_dir() or (log.exists() and is_bag(log)):
        raise InputError(
            f'log {log} is no table; a bag needs no import, ballscrew replay takes it'
        )
