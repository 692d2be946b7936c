# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew replay`: recordings judged without DDS, in words, as JSON, or as reports."""

import argparse
from collections.abc import Sequence
import contextlib
import json
from pathlib import Path
import sys
from typing import Any, TYPE_CHECKING

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.core.prerequisites import require
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.bulk.decode import silence
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.replay import axes_for
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.words import counted, percent, say, shown_progress
from ballscrew_monitor.report.judging import judge_log, LogCase
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
    """
    Judge recordings; return what JSON holds of them, and the exit code.

    One of several that cannot be read does not stop the others.

    """
    alone = logs == args.logs and len(logs) == 1  # a folder may hold one
    if args.out is not None:
        report = _report_one if alone else _report_many
        return report(logs, args, nominal)
    if alone:
        return _print_one(args, nominal, logs[0], args.map)
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
        judged = judge_log(bag, parameters, on_share=on_done)
    _say_notes(judged.notes, parameters)
    if judged.unjudged:
        values = with_types(parameters.values, bag.types)
        axes = {axis.name: axis for axis in axes_for(bag, values)}
        cases = {case.axis: case for case in judged.axes}
        for name in judged.unjudged:
            case, fault = cases.get(name), silence(bag, axes[name])
            why = f'topics, fields and joints of its parameters must be those of {bag.path}'
            why += f'; {fault}' if fault else ''
            if case is not None and never_moved(case):
                why = 'it never moved'
            elif case is not None and case.outcome.reason and not fault:
                why = case.outcome.reason
            say(f'nothing was judged on axis {name}: {why}')
    if not args.json:
        print(printable('\n'.join(log_lines(judged))))
    code = _code(log, judged, unjudged_share(judged), args)
    return printed_records(summary_record(judged)), code


def _report_one(
    logs: Sequence[Path], args: argparse.Namespace, nominal: Path
) -> tuple[Records, int]:
    from ballscrew_monitor.report.log_report import report_log

    bag = opened_log(logs[0], mapping=args.map)
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
    return _reported(args.out, args), _code(logs[0], result, result.unjudged_share, args)


def _report_many(
    logs: Sequence[Path], args: argparse.Namespace, nominal: Path
) -> tuple[Records, int]:
    from ballscrew_monitor.report.many_logs import Given, INDEX, report_logs, Workers

    given, workers = Given(args.params, args.map, nominal), Workers(args.workers, args.dask)
    notes = left_out(args.logs, logs, args.out, tables=args.map is not None)
    results = report_logs(logs, args.out, given, workers, notes)
    records: Records = {}
    for log, result in zip(logs, results, strict=True):
        if result.failure:
            say(f'{result.name}: {result.failure}')
            records |= without(str(log), result.failure)
            continue
        for line in result.lines:
            print(printable(f'{result.name}: {line.verdict}'))
        hints = [f'check {hint}' for hint in result.hints]
        say(*(f'{result.name}: {note}' for note in (*result.notes, *hints)))
        if result.unjudged:
            say(f'{result.name}: nothing was judged on axis {", ".join(result.unjudged)}')
        records[str(log)] = _reported(args.out / result.folder, args)
    bad = sum(is_bad(result, log, args) for log, result in zip(logs, results, strict=True))
    print(f'{counted(len(results), "recording")}, {bad} bad, overview in {args.out / INDEX}')
    return records, FAILED if bad else DONE


def is_bad(result: 'LogResult', log: Path, args: argparse.Namespace) -> bool:
    """Return True if a recording was not read, or not judged as far as is asked for."""
    return not result.judged or _code(log, result, result.unjudged_share, args) == FAILED


def _code(log: Path, judged: 'LogCase | LogResult', share: float, args: argparse.Namespace) -> int:
    """Return the exit code of a recording that was judged; say what share was not, if too much."""
    most = args.most_unjudged / 100.0
    if judged.judged and share > most:
        missed = judged.missed_share >= share
        what = 'motion of an axis was' if missed else 'samples of the speed of an axis were'
        say(
            f'{log}: {percent(share)} of the {what} not judged, allowed are {percent(most)} '
            '(--most-unjudged-percent)'
        )
    return DONE if judged.judged and share <= most else FAILED


def _reported(folder: Path, args: argparse.Namespace) -> Records:
    """Return what JSON holds of a recording whose report is in a folder, if it is asked for."""
    if not args.json:
        return {}
    return printed_records(json.loads((folder / SUMMARY).read_text(encoding='utf-8')))


def _say_origin(parameters: LogParameters) -> None:
    say(f'parameters: {parameters.origin}', *parameters.sentences)


def _say_notes(notes: Sequence[str], parameters: LogParameters) -> None:
    """Say what has not been said of the parameters."""
    say(*(note for note in notes if note not in parameters.sentences))
