# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew health`: normal or worse, by recordings over months or what a node gathered."""

import argparse
from collections.abc import Mapping, Sequence
import contextlib
import datetime
from pathlib import Path
import re
import sys
from typing import Any

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.health.fleet import controlled
from ballscrew_monitor.health.records import Health, Quantity
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import FILE, read_health
from ballscrew_monitor.health.words import health_record
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.health_axes import (
    assess_axes,
    collected_axes,
    joined_axes,
    logged_axes,
)
from ballscrew_monitor.report.health_collect import (
    collect,
    Collected,
    Failures,
    Given,
    map_logs,
    Workers,
)
from ballscrew_monitor.report.health_folder import is_health_folder
from ballscrew_monitor.report.health_history import AxisHistory, peers_among
from ballscrew_monitor.report.health_kept import kept_healths, stored_axis
from ballscrew_monitor.report.logs import logs_of
from ballscrew_monitor.report.machines import axis_titles, folders_note, machine_names, MachineAxis
from ballscrew_monitor.settings.parameters import read_file
from surrogate.files import InputError, json_text, printable, replace_file

COLLECT = 'collect'
RECORD, PICTURE = 'health.json', 'health.png'
_OURS = re.compile(
    rb'\{(\}|\s*"([^"\\]|\\.)*": \{\s*"axis": )'
)  # how a record of this command begins
MOST_BEGIN = 1000  # [bytes] of that


def health_command(args: argparse.Namespace, nominal: Path) -> int:
    """Do what the command line asks for; return the exit code."""
    if args.map is not None:
        read_map(args.map)
    given, workers = Given(args.params, args.map, nominal), Workers(args.workers, args.dask)
    if str(args.logs[0]) == COLLECT:
        return _collect(args, given, workers)
    if args.out is not None:
        check_output(args.out)
    stores = {path: read_health(path) for path in args.logs if (path / FILE).is_file()}
    collected = [path for path in args.logs if is_health_folder(path)]
    named = [path for path in args.logs if path not in stores and path not in collected]
    logs = logs_of(named, args.map, args.out)
    with contextlib.redirect_stdout(sys.stderr if args.json else sys.stdout):
        histories = _histories(logs, given, workers)
        axes = logged_axes(histories)
        for folder in collected:
            axes = joined_axes(axes, collected_axes(folder), folder)
        of_nodes = [stored_axis(folder, axis) for folder in stores for axis in stores[folder]]
        titles = axis_titles([*axes, *of_nodes])
        found = assess_axes(axes, titles, _options(args), workers)
        for folder, stored in stores.items():
            values = read_file(args.params or nominal)
            found |= kept_healths(folder, stored, titles, values, _options(args))
        found, fleet = controlled(found)
        for last in (courses[-1] for courses in found.values()):
            print(printable('\n'.join(lines_of(last))))
        for peer in peers_among(histories, titles):
            print(printable(peer.text))
        say(*filter(None, [folders_note(axes)]))
        if fleet:
            print(f'{fleet}.')
        records = _records(found, titles)
        if args.out is not None and found:
            _write(args.out, records, {titles[axis]: one for axis, one in found.items()})
    if args.json:
        print(json_text(records))
    return DONE if found else FAILED


def _collect(args: argparse.Namespace, given: Given, workers: Workers) -> int:
    """Keep what each log holds in a folder; return the exit code."""
    if args.out is None or not args.logs[1:]:
        raise InputError(
            'health collect needs logs, and --out FOLDER in which it keeps what they hold'
        )
    if args.out.exists() and not args.out.is_dir():
        raise InputError(f'output {args.out} is a file, it must be a directory')
    logs = logs_of(args.logs[1:], args.map, args.out)
    return FAILED if collect(logs, args.out, given, workers) else DONE


def _histories(logs: Sequence[Path], given: Given, workers: Workers) -> list[AxisHistory]:
    """
    Return what each recording holds of each axis; one that cannot be read stops no other.

    Raises InputError when the only one cannot be read.

    """
    histories, failures = list[AxisHistory](), Failures()

    def take(log: Path, collected: Collected) -> None:
        if collected.failure and len(logs) == 1:
            raise InputError(collected.failure)
        say(*(f'{log}: {note}' for note in collected.notes))
        if collected.failure:
            failures.add(log, collected.failure)
        histories.extend(collected.histories)

    map_logs(logs, given, workers, take, alone=len(logs) == 1)
    failures.count()
    return histories


def check_output(out: Path) -> None:
    """Raise InputError for a folder with files that would be replaced and are of somebody else."""
    held = [name for name in (RECORD, PICTURE) if (out / name).exists()]
    if not held:
        return
    if (out / RECORD).is_file():
        with (out / RECORD).open('rb') as stream:
            if _OURS.match(stream.read(MOST_BEGIN)):
                return
    raise InputError(
        f'output {out} holds {held[0]}, which is not of ballscrew health and would be '
        'overwritten, another directory must be given'
    )


def _options(args: argparse.Namespace) -> dict[str, Any]:
    return {
        'baseline_days': args.baseline_days,
        'days': None if args.baseline is None else days_of(*args.baseline),
        'speed_allowed': args.speed_advice,
    }


def days_of(first: str, last: str) -> tuple[int, int]:
    """Return begin and end [ns] of the days from `first` to `last`, UTC; raises InputError."""
    try:
        begin, end = (datetime.date.fromisoformat(text) for text in (first, last))
    except ValueError:
        raise InputError(
            f'--baseline is {first} {last}, it must be two dates such as 2026-01-05 2026-01-16'
        ) from None
    start = datetime.date(1970, 1, 1)
    return (begin - start).days * DAY, ((end - start).days + 1) * DAY


def lines_of(health: Health) -> list[str]:
    """Return what is said of an axis, line by line."""
    known = [f'  {one.name:<34} {_shown(one)}' for one in health.quantities if one.is_known]
    silent = [f'  {", ".join(names)}: {reason}' for reason, names in health.unknown.items()]
    causes = [
        f'  {"excluded" if one.excluded else f"{100 * one.weight:.0f} %":>8}  {one.text}'
        for one in health.causes
    ]
    return [
        health.verdict,
        *([f'To do: {health.advice}.'] if health.advice else []),
        *known,
        *silent,
        *(['causes:', *causes] if causes else []),
        *(f'note: {note}' for note in health.notes),
    ]


def _shown(one: Quantity) -> str:
    unit = '' if one.unit == '-' else f' {one.unit}'
    interval = '' if one.low == one.high else f' ({one.low:.4g} to {one.high:.4g})'
    return f'{one.value:.4g}{unit}{interval}; {one.evidence}'


def _records(
    found: Mapping[MachineAxis, Sequence[Health]], titles: Mapping[MachineAxis, str]
) -> dict[str, Any]:
    """Return the last health of each axis, and its course, for JSON."""
    names, records = machine_names(found), {}
    for key, courses in found.items():
        whose = {'axis': key.axis, 'machine': names[key.machine]}
        course = [health_record(one) | whose for one in courses]
        records[titles[key]] = course[-1] | {'course': course}
    return records


def _write(out: Path, records: Mapping[str, Any], courses: Mapping[str, Sequence[Health]]) -> None:
    from ballscrew_monitor.report.health_picture import draw_health, MOST_DRAWN  # slow to load

    replace_file(out / RECORD, json_text(records).encode())
    draw_health(dict(list(courses.items())[:MOST_DRAWN]), out / PICTURE)
    print(f'{out / RECORD} and {out / PICTURE}')
    if len(courses) > MOST_DRAWN:
        say(f'{out / PICTURE} shows the first {MOST_DRAWN} of {len(courses)} axes')
