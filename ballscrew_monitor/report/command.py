# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew replay`: recordings judged without DDS, in words, as JSON, or as reports."""

import argparse
from collections.abc import Mapping, Sequence
import contextlib
import json
from pathlib import Path
import sys
from typing import Any, TYPE_CHECKING

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.core.prerequisites import require
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.bulk.decode import silence
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.replay import axes_for
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import counted, percent, say, shown_progress
from ballscrew_monitor.report.judging import AxisCase, judge_log, LogCase
from ballscrew_monitor.report.ledger import unjudged_share
from ballscrew_monitor.report.logs import left_out, logs_of, map_for, PAGE, SUMMARY
from ballscrew_monitor.report.parameters import LogParameters, parameters_for
from ballscrew_monitor.report.printed import log_lines, printed_records, summary_record, without
from ballscrew_monitor.report.verdict import never_moved
from ballscrew_monitor.settings.parameters import read_file, with_types
from surrogate.files import InputError, json_text, printable
from surrogate.surface import SurfaceError

if TYPE_CHECKING:  # the rest asks for packages that printing does not need
    from ballscrew_monitor.report.log_report import LogResult
    from ballscrew_monitor.report.overview import LogEntry

Records = dict[str, Any]
"""What JSON holds of a recording: a record for each axis."""


def replay_command(args: argparse.Namespace, nominal: Path) -> int:
    """Do what the command line asks for; return the exit code."""
    logs = logs_of(args.logs, args.map, args.out)
    _check(logs, args)
    require('numba')  # before workers meet its absence, each for itself
    say(*left_out(args.logs, logs, args.out, tables=args.map is not None))
    # With --json, standard output is JSON alone.
    with contextlib.redirect_stdout(sys.stderr if args.json else sys.stdout):
        records, code = _replay(logs, args, nominal)
    if args.json:
        print(json_text(records))
    return code


def _check(logs: Sequence[Path], args: argparse.Namespace) -> None:
    """Raise InputError for what no recording can be judged with, and for no place of reports."""
    if args.map is not None:
        if len(logs) > 1 and all(is_bag(log) for log in logs):
            raise InputError(
                f'map {args.map} is for tables, none of the {len(logs)} recordings is one: leave '
                'out --map'
            )
        read_map(args.map)
    check_most_unjudged(args.most_unjudged)
    if args.params is not None:
        read_file(args.params)
    if args.out is not None and args.out.exists() and not args.out.is_dir():
        raise InputError(f'output {args.out} is a file, it must be a directory')


def check_most_unjudged(percentage: float) -> None:
    """Raise InputError for a share that no recording has."""
    if not 0.0 <= percentage <= 100.0:
        raise InputError(f'--most-unjudged-percent is {percentage:g}, allowed is 0 to 100 %')


def _replay(logs: Sequence[Path], args: argparse.Namespace, nominal: Path) -> tuple[Records, int]:
    """Judge recordings; return what JSON holds of them, and the exit code."""
    if logs != args.logs or len(logs) > 1:  # a folder may hold one
        many = _print_many if args.out is None else _report_many
        return many(logs, args, nominal)
    if args.out is not None:
        return _report_one(args, nominal, logs[0])
    return _print_one(args, nominal, logs[0], args.map)


def _print_many(
    logs: Sequence[Path], args: argparse.Namespace, nominal: Path
) -> tuple[Records, int]:
    """Print what each recording comes to; one that cannot be read does not stop the others."""
    codes, records = [], {}
    for log in logs:
        if not args.json:
            print(printable(str(log)))
        try:
            mapping = map_for(log, args.map, alone=False)
            records[str(log)], code = _print_one(args, nominal, log, mapping)
        except (InputError, SurfaceError) as error:
            say(f'{log}: {error}')
            records |= without(str(log), str(error))
            code = FAILED
        codes.append(code)
    return records, max(codes)


def _print_one(
    args: argparse.Namespace, nominal: Path, log: Path, mapping: Path | None
) -> tuple[Records, int]:
    """Judge a recording and print what it comes to, unless that is to be JSON."""
    bag = opened_log(log, mapping=mapping)
    parameters = parameters_for(bag, args.params, nominal)
    _say_origin(parameters)
    with shown_progress(bag.duration) as on_done:
        found = judge_log(bag, parameters, on_share=on_done)
    _say_notes(found.notes, parameters)
    say(*_silences(bag, parameters.values, found))
    if not args.json:
        print(printable('\n'.join(log_lines(found))))
    return printed_records(summary_record(found)), _code(log, found, unjudged_share(found), args)


def _report_one(args: argparse.Namespace, nominal: Path, log: Path) -> tuple[Records, int]:
    from ballscrew_monitor.report.log_report import report_log

    bag = opened_log(log, mapping=args.map)
    parameters = parameters_for(bag, args.params, nominal)
    _say_origin(parameters)
    with shown_progress(bag.duration) as on_done:
        result = report_log(bag, args.out, parameters, on_share=on_done)
    _say_notes(result.notes, parameters)
    if result.unjudged:
        say(f'nothing was judged on axis {", ".join(result.unjudged)}')
    for line in result.lines:
        print(printable(line.verdict))
    say(*(f'check {hint}' for hint in result.hints))
    print(f'report in {args.out / PAGE}')
    return _reported(args.out, args), _code(log, result, result.unjudged_share, args)


def _report_many(
    logs: Sequence[Path], args: argparse.Namespace, nominal: Path
) -> tuple[Records, int]:
    from ballscrew_monitor.report.many_logs import INDEX, report_logs

    entries = report_logs(
        logs,
        args.out,
        params=args.params,
        mapping=args.map,
        nominal=nominal,
        notes=left_out(args.logs, logs, args.out, tables=args.map is not None),
        workers=args.workers,
        dask=args.dask,
    )
    records: Records = {}
    for log, entry in zip(logs, entries, strict=True):
        _print_entry(entry)
        if entry.result is None:
            records |= without(str(log), entry.failure)
        else:
            records[str(log)] = _reported(args.out / entry.folder, args)
    bad = sum(is_bad(entry, log, args) for log, entry in zip(logs, entries, strict=True))
    print(f'{counted(len(entries), "recording")}, {bad} bad, overview in {args.out / INDEX}')
    return records, FAILED if bad else DONE


def is_bad(entry: 'LogEntry', log: Path, args: argparse.Namespace) -> bool:
    """Return True if a recording was not read, or not judged as far as is asked for."""
    result = entry.result
    if result is None or entry.is_bad:
        return True
    return _code(log, result, result.unjudged_share, args) == FAILED


def _code(log: Path, judged: 'LogCase | LogResult', share: float, args: argparse.Namespace) -> int:
    """Return the exit code of a recording that was judged; say what share was not, if too much."""
    most = args.most_unjudged / 100.0
    if judged.judged and share > most:
        say(
            f'{log}: {percent(share)} of the samples of the speed of an axis were not judged, '
            f'allowed are {percent(most)} (--most-unjudged-percent)'
        )
    return DONE if judged.judged and share <= most else FAILED


def _reported(folder: Path, args: argparse.Namespace) -> Records:
    """Return what JSON holds of a recording whose report is in a folder, if it is asked for."""
    if not args.json:
        return {}
    return printed_records(json.loads((folder / SUMMARY).read_text(encoding='utf-8')))


def _silences(bag: Bag, values: Mapping[str, Any], log: LogCase) -> list[str]:
    if not log.unjudged:
        return []
    axes = {axis.name: axis for axis in axes_for(bag, with_types(values, bag.types))}
    cases = {case.axis: case for case in log.axes}
    reasons = {
        name: _reason(bag, silence(bag, axes[name]), cases.get(name)) for name in log.unjudged
    }
    return [f'nothing was judged on axis {name}: {why}' for name, why in reasons.items()]


def _reason(bag: Bag, fault: str, case: AxisCase | None) -> str:
    if case is not None and never_moved(case):
        return 'it never moved'
    if case is not None and case.outcome.reason and not fault:
        return case.outcome.reason
    more = f'; {fault}' if fault else ''
    return f'topics, fields and joints of its parameters must be those of {bag.path}{more}'


def _print_entry(entry: 'LogEntry') -> None:
    if entry.result is None:
        say(f'{entry.name}: {entry.failure}')
        return
    for line in entry.result.lines:
        print(printable(f'{entry.name}: {line.verdict}'))
    hints = [f'check {hint}' for hint in entry.result.hints]
    say(*(f'{entry.name}: {note}' for note in (*entry.result.notes, *hints)))
    if entry.result.unjudged:
        say(f'{entry.name}: nothing was judged on axis {", ".join(entry.result.unjudged)}')


def _say_origin(parameters: LogParameters) -> None:
    say(f'parameters: {parameters.origin}', *parameters.sentences)


def _say_notes(notes: Sequence[str], parameters: LogParameters) -> None:
    """Say what has not been said of the parameters."""
    say(*(note for note in notes if note not in parameters.sentences))
