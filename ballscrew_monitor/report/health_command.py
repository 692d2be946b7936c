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
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import FILE, read_health
from ballscrew_monitor.health.words import health_record
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.health_axes import (
    assess_axes,
    joined_axes,
    kept_healths,
    logged_axes,
    stored_axis,
)
from ballscrew_monitor.report.health_collect import collect, Failures, map_logs
from ballscrew_monitor.report.health_folder import is_health_folder
from ballscrew_monitor.report.health_history import AxisHistory, peers_among
from ballscrew_monitor.report.logs import logs_of
from ballscrew_monitor.report.machines import axis_titles, folders_note, machine_names, MachineAxis
from ballscrew_monitor.report.many_logs import Given, Workers
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
            axes = joined_axes(axes, folder)
        of_nodes = [stored_axis(folder, axis) for folder in stores for axis in stores[folder]]
        titles = axis_titles([*axes, *of_nodes])
        options = {
            'baseline_days': args.baseline_days,
            'days': None if args.baseline is None else days_of(*args.baseline),
            'speed_allowed': args.speed_advice,
        }
        courses = assess_axes(axes, titles, options, workers)
        for folder, stored in stores.items():
            values = read_file(args.params or nominal)
            courses |= kept_healths(folder, stored, titles, values, options)
        courses, fleet = controlled(courses)
        for course in courses.values():
            print(printable('\n'.join(lines_of(course[-1]))))
        for peer in peers_among(histories, titles):
            print(printable(peer.text))
        say(*filter(None, [folders_note(axes)]))
        if fleet:
            print(f'{fleet}.')
        records = _records(courses, titles)
        if args.out is not None and courses:
            _write(args.out, records, {titles[key]: course for key, course in courses.items()})
    if args.json:
        print(json_text(records))
    return DONE if courses else FAILED


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

    def take(log: Path, of_log: list[AxisHistory], failure: str) -> None:
        if failure and len(logs) == 1:
            raise InputError(failure)
        if failure:
            failures.add(log, failure)
        histories.extend(of_log)

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
    lines = [health.verdict, *([f'To do: {health.advice}.'] if health.advice else [])]
    for quantity in health.quantities:
        if quantity.is_known:
            unit = '' if quantity.unit == '-' else f' {quantity.unit}'
            low, high = quantity.low, quantity.high
            interval = '' if low == high else f' ({low:.4g} to {high:.4g})'
            number = f'{quantity.value:.4g}{unit}{interval}'
            lines.append(f'  {quantity.name:<34} {number}; {quantity.evidence}')
    lines += [f'  {", ".join(names)}: {reason}' for reason, names in health.unknown.items()]
    lines += ['causes:'] if health.causes else []
    for cause in health.causes:
        weight = 'excluded' if cause.excluded else f'{100 * cause.weight:.0f} %'
        lines.append(f'  {weight:>8}  {cause.text}')
    return [*lines, *(f'note: {note}' for note in health.notes)]


def _records(
    courses: Mapping[MachineAxis, Sequence[Health]], titles: Mapping[MachineAxis, str]
) -> dict[str, Any]:
    """Return the last health of each axis, and its course, for JSON."""
    names, records = machine_names(courses), {}
    for key, course in courses.items():
        whose = {'axis': key.axis, 'machine': names[key.machine]}
        of_logs = [health_record(health) | whose for health in course]
        records[titles[key]] = of_logs[-1] | {'course': of_logs}
    return records


def _write(out: Path, records: Mapping[str, Any], courses: Mapping[str, Sequence[Health]]) -> None:
    from ballscrew_monitor.report.health_picture import draw_health, MOST_DRAWN  # slow to load

    replace_file(out / RECORD, json_text(records).encode())
    draw_health(dict(list(courses.items())[:MOST_DRAWN]), out / PICTURE)
    print(f'{out / RECORD} and {out / PICTURE}')
    if len(courses) > MOST_DRAWN:
        say(f'{out / PICTURE} shows the first {MOST_DRAWN} of {len(courses)} axes')
