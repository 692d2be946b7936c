# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew import`: a table as a bag that says how it is to be judged, or a first map of it."""

import dataclasses
from pathlib import Path

from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.bag_writer import Offer, Topic, whole_bag
from ballscrew_monitor.recordings.log_facts import LogFacts
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import read_map, TableMap
from ballscrew_monitor.recordings.words import say, Shown, shown_progress
from surrogate.files import InputError, printable


def convert(
    path: Path, mapping: TableMap, out: Path, *, shown: Shown = shown_progress
) -> LogFacts:
    """
    Write the log at `path` as a bag to the directory `out`; return what the bag says of itself.

    Shows how far it is. Raises InputError when the log cannot be read by the map, before anything
    is written.

    """
    if out.is_file():
        raise InputError(f'output {out} is a file, it must be a directory')
    log = TableLog(path, mapping, shown)
    with whole_bag(out, out.resolve().name) as writer:
        writer.add_metadata(log.metadata)
        for name, type_name in log.types.items():
            writer.add_topic(Topic(name=name, type_name=type_name, offer=Offer.RELIABLE))
        with shown(log.count, 'rows written') as show:
            for batch in log.batches(log.topics):
                writer.write_batch(batch)
                show(batch.done)
        facts = dataclasses.replace(log.facts, notes=(*log.facts.notes, *log.remarks))
        if log.remarks:
            writer.add_metadata(facts.texts())
    return facts


def print_guess(log: Path) -> None:
    """Print a first map of a log, and to standard error what is to be said about it."""
    _check_log(log)
    draft = guess(log, shown=shown_progress)
    print(draft.text, end='')
    say(*draft.picture, *draft.notes, *draft.unstated)


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
        print(printable(f'  assumed {one.key} = {one.value}: {one.reason}'))


def _check_log(log: Path) -> None:
    if log.is_dir() or (log.exists() and is_bag(log)):
        raise InputError(
            f'log {log} is no table; a bag needs no import, ballscrew replay takes it'
        )
