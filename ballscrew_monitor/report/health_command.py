# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew health`: normal or worse, by recordings over months or what a node gathered."""

import argparse
from collections.abc import Iterator, Mapping, Sequence
import contextlib
import datetime
import functools
from pathlib import Path
import re
import sys
from typing import Any

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.health.records import Health, Quantity
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import FILE, read_health
from ballscrew_monitor.health.words import health_record
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.health_history import (
    AxisHistory,
    by_axis,
    healths,
    HistoryMaker,
    peers_among,
)
from ballscrew_monitor.report.health_kept import kept_healths, stored_axis
from ballscrew_monitor.report.inputs_seen import hints_on
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.logs import find_logs, map_for
from ballscrew_monitor.report.machines import axis_titles, folders_note, machine_names, MachineAxis
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.settings.parameters import read_file
from surrogate.files import InputError, json_text, printable, replace_file
from surrogate.progress import Progress
from surrogate.surface import SurfaceError

RECORD, PICTURE = 'health.json', 'health.png'
_OURS = re.compile(
    rb'\{(\}|\s*"([^"\\]|\\.)*": \{\s*"axis": )'
)  # how a record of this command begins
MOST_BEGIN = 1000  # [bytes] of that


def health_command(args: argparse.Namespace, nominal: Path) -> int:
    """Do what the command line asks for; return the exit code."""
    if args.out is not None:
        check_output(args.out)
    if args.map is not None:
        read_map(args.map)
    folders = [path for path in args.logs if (path / FILE).is_file()]
    named = [path for path in args.logs if path not in folders]
    logs = find_logs(named, tables=args.map is not None, out=args.out)
    with contextlib.redirect_stdout(sys.stderr if args.json else sys.stdout):
        histories = list(_histories(logs, args, nominal)) if logs else []
        stores = {folder: read_health(folder) for folder in folders}
        of_logs = list(by_axis(histories))
        of_nodes = [stored_axis(folder, axis) for folder in stores for axis in stores[folder]]
        titles = axis_titles([*of_logs, *of_nodes])
        found = _healths(histories, titles, args)
        for folder, stored in stores.items():
            values = read_file(args.params or nominal)
            found |= kept_healths(folder, stored, titles, values, _options(args))
        for last in (courses[-1] for courses in found.values()):
            print(printable('\n'.join(lines_of(last))))
        for peer in peers_among(histories, titles):
            print(printable(peer.text))
        say(*filter(None, [folders_note(of_logs)]))
        records = _records(found, titles)
        if args.out is not None and found:
            _write(args.out, records, {titles[axis]: one for axis, one in found.items()})
    if args.json:
        print(json_text(records))
    return DONE if found else FAILED


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


def _histories(
    logs: Sequence[Path], args: argparse.Namespace, nominal: Path
) -> Iterator[AxisHistory]:
    """
    Yield what each recording holds of each axis; one that cannot be read stops no other.

    Raises InputError when the only one cannot be read.

    """
    bar = Progress(len(logs), 'recordings')
    try:
        for number, log in enumerate(logs):
            bar.show(number, len(logs))
            try:
                mapping = map_for(log, args.map, alone=len(logs) == 1)
                bag = opened_log(log, mapping=mapping)
                case = judge_log(
                    bag,
                    parameters_for(bag, args.params, nominal),
                    on_share=functools.partial(_show, bar, number, len(logs)),
                    health=HistoryMaker,
                )
                say(*(f'{log}: {note}' for note in case.notes))
                say(*(f'{log}: check {hint}' for hint in hints_on(case.axes)))
                yield from (axis.history for axis in case.axes if axis.history is not None)
            except (InputError, SurfaceError) as error:
                if len(logs) == 1:
                    raise
                say(f'{log}: {error}')
        bar.show(len(logs), len(logs))
    finally:
        bar.close()


def _show(bar: Progress, number: int, count: int, share: float) -> None:
    """Show the share [-] of one recording of several that is judged."""
    bar.show(number, count, share=(number + share) / count)


def _healths(
    histories: Sequence[AxisHistory], titles: Mapping[MachineAxis, str], args: argparse.Namespace
) -> dict[MachineAxis, list[Health]]:
    """Return the course of each axis."""
    options = _options(args)
    return {
        axis: healths(own, title=titles[axis], **options)
        for axis, own in by_axis(histories).items()
    }


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
    silent = [f'  {one.name:<34} {one.reason}' for one in health.quantities if not one.is_known]
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
    return f'{one.value:.4g}{unit} ({one.low:.4g} to {one.high:.4g}); {one.evidence}'


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

    out.mkdir(parents=True, exist_ok=True)
    replace_file(out / RECORD, json_text(records).encode())
    draw_health(dict(list(courses.items())[:MOST_DRAWN]), out / PICTURE)
    print(f'{out / RECORD} and {out / PICTURE}')
    if len(courses) > MOST_DRAWN:
        say(f'{out / PICTURE} shows the first {MOST_DRAWN} of {len(courses)} axes')
