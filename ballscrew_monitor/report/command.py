# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew replay`: recordings judged without DDS, in words, as JSON, or as reports."""

import argparse
from collections.abc import Callable, Mapping, Sequence
import contextlib
import functools
from pathlib import Path
import sys
from typing import Any, TYPE_CHECKING

from ballscrew_monitor.node.interrupts import DONE, FAILED
from ballscrew_monitor.node.topics import with_types
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.decoding import silence
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.progress import shown_progress
from ballscrew_monitor.recordings.replay import axes_for, replay_outcomes
from ballscrew_monitor.recordings.summary import Summary
from ballscrew_monitor.report.logs import find_logs
from ballscrew_monitor.report.parameters import LogParameters, parameters_for
from ballscrew_monitor.report.words import counted
from surrogate.files import InputError, json_text
from surrogate.surface import SurfaceError

if TYPE_CHECKING:  # the rest asks for packages that printing does not need
    from ballscrew_monitor.report.overview import LogEntry

Results = dict[str, Summary | None]


def replay_command(args: argparse.Namespace, nominal: Path) -> int:
    """Do what the command line asks for; return the exit code."""
    logs = find_logs(args.logs, tables=args.map is not None, out=args.out)
    if args.out is not None and (len(logs) > 1 or logs != args.logs):
        return _report_many(logs, args, nominal)
    work = functools.partial(_print_one if args.out is None else _report_one, args, nominal)
    if len(logs) == 1:
        results, code = work(logs[0])
        _show(results, args)
        return code
    return _print_many(logs, work, args)


def _print_many(
    logs: Sequence[Path], work: Callable[[Path], tuple[Results, int]], args: argparse.Namespace
) -> int:
    """Print what each recording comes to; one that cannot be read does not stop the others."""
    codes, records = [], {}
    for log in logs:
        if not args.json:
            print(log)
        try:
            results, code = work(log)
        except (InputError, SurfaceError) as error:
            _say(f'{log}: {error}')
            results, code = {}, FAILED
        codes.append(code)
        records[str(log)] = _records(results)
        if not args.json:
            _show(results, args)
    if args.json:
        print(json_text(records))
    return max(codes)


def _print_one(args: argparse.Namespace, nominal: Path, log: Path) -> tuple[Results, int]:
    """Judge a recording; return what it comes to, and the exit code of that."""
    with opened_log(log, mapping=args.map) as bag:
        parameters = parameters_for(bag, args.params, nominal)
        _say_origin(parameters)
        with shown_progress(bag.duration) as on_done:
            outcomes = replay_outcomes(bag, parameters.values, on_done=on_done)
        results: Results = {outcome.axis: outcome.summary() for outcome in outcomes}
        last = {outcome.axis: outcome.reason for outcome in outcomes}
        silent = [axis for axis, made in results.items() if made is None or made.says_nothing]
        _say(*bag.notes, *_silences(bag, parameters.values, silent, last))
    return results, FAILED if len(silent) == len(results) else DONE


def _report_one(args: argparse.Namespace, nominal: Path, log: Path) -> tuple[Results, int]:
    """Write the report of a recording; return no results, which are in it, and the exit code."""
    from ballscrew_monitor.report.log_report import PAGE, report_log

    with opened_log(log, mapping=args.map) as bag:
        parameters = parameters_for(bag, args.params, nominal)
        _say_origin(parameters)
        with shown_progress(bag.duration) as on_done:
            result = report_log(bag, args.out, parameters, on_share=on_done)
    _say(*(note for note in result.notes if note not in parameters.sentences))
    if result.unjudged:
        _say(f'nothing was judged on axis {", ".join(result.unjudged)}')
    # With --json, standard output is JSON alone.
    with contextlib.redirect_stdout(sys.stderr if args.json else sys.stdout):
        for line in result.lines:
            print(line.verdict)
        print(f'report in {args.out / PAGE}')
    return dict(result.summaries), DONE if result.judged else FAILED


def _silences(
    bag: Bag, values: Mapping[str, Any], silent: Sequence[str], last: Mapping[str, str]
) -> list[str]:
    """Return a sentence for each axis on which nothing was judged."""
    if not silent:
        return []
    axes = {axis.name: axis for axis in axes_for(bag, with_types(values, bag.types))}
    reasons = {name: _reason(bag, silence(bag, axes[name]), last[name]) for name in silent}
    return [f'nothing was judged on axis {name}: {why}' for name, why in reasons.items()]


def _reason(bag: Bag, fault: str, last: str) -> str:
    if last and not fault:
        return last
    more = f'; {fault}' if fault else ''
    return f'topics, fields and joints of its parameters must be those of {bag.path}{more}'


def _report_many(logs: Sequence[Path], args: argparse.Namespace, nominal: Path) -> int:
    from ballscrew_monitor.report.many_logs import INDEX, report_logs

    entries = report_logs(
        logs,
        args.out,
        params=args.params,
        mapping=args.map,
        nominal=nominal,
        workers=args.workers,
        dask=args.dask,
    )
    for entry in entries:
        _print_entry(entry)
    bad = sum(entry.is_bad for entry in entries)
    print(f'{counted(len(entries), "recording")}, {bad} bad, overview in {args.out / INDEX}')
    return FAILED if bad else DONE


def _print_entry(entry: 'LogEntry') -> None:
    if entry.result is None:
        _say(f'{entry.name}: {entry.failure}')
        return
    for line in entry.result.lines:
        print(f'{entry.name}: {line.verdict}')
    _say(*(f'{entry.name}: {note}' for note in entry.result.notes))
    if entry.result.unjudged:
        _say(f'{entry.name}: nothing was judged on axis {", ".join(entry.result.unjudged)}')


def _show(results: Results, args: argparse.Namespace) -> None:
    if args.json:
        print(json_text(_records(results)))
        return
    for axis, result in results.items() if args.out is None else ():
        _print_summary(axis, result)


def _records(results: Results) -> dict[str, Any]:
    return {axis: made and made.record() for axis, made in results.items()}


def _print_summary(axis: str, result: Summary | None) -> None:
    if result is None:
        print(f'axis {axis}: no state')
        return
    print(f'axis {axis}: {result.judged} speed samples judged')
    print('\n'.join(f'  {line}' for line in result.lines()))


def _say_origin(parameters: LogParameters) -> None:
    _say(f'parameters: {parameters.origin}', *parameters.sentences)


def _say(*sentences: str) -> None:
    for sentence in sentences:
        print(f'ballscrew: {sentence}', file=sys.stderr)
