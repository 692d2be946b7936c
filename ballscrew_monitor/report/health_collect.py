# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Logs to what their health rests on, one task a log, on processes here or on a Dask cluster.

`ballscrew health collect` keeps that in a folder; logs that are there in this version are skipped,
so that a run which was stopped goes on with the next one.

"""

from collections.abc import Callable, Mapping, Sequence
import dataclasses
import os.path
from pathlib import Path
from typing import Any, NamedTuple

from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.words import counted, say
from ballscrew_monitor.report.health_folder import (
    held_logs,
    identity_of,
    is_complete,
    keep,
    LogIdentity,
)
from ballscrew_monitor.report.health_history import AxisHistory, HistoryMaker, read_history
from ballscrew_monitor.report.inputs_seen import hints_on
from ballscrew_monitor.report.judging import judge_log, OnShare
from ballscrew_monitor.report.logs import map_for
from ballscrew_monitor.report.many_logs import LogsProgress, ReadingShare, size_of
from ballscrew_monitor.report.parameters import parameters_for
from surrogate.files import InputError, to_json
from surrogate.progress import Progress
from surrogate.surface import SurfaceError
from surrogate.tasks.pool import run_tasks, TaskOutcome
from surrogate.tasks.workers import ignore, open_pool


class Given(NamedTuple):
    """Files that logs are judged with: parameters and map, None for none, and the usual ones."""

    params: Path | None
    mapping: Path | None
    nominal: Path


class Workers(NamedTuple):
    """Number of processes, None for all cores, and the address of a Dask scheduler, if any."""

    number: int | None = None
    dask: str | None = None


class Collected(NamedTuple):
    """What a log holds of its axes, and notes on it; or the reason why it cannot be read."""

    histories: list[AxisHistory]
    notes: list[str]
    failure: str = ''


class Failures:
    """Logs that cannot be read: a reason is said with the first of them, then their number."""

    def __init__(self) -> None:
        self._logs: dict[str, int] = {}

    def add(self, log: Path, sentence: str) -> None:
        """Take the sentence about a log."""
        reason = sentence.removeprefix(f'log {log}: ')
        if reason not in self._logs:
            say(f'{log}: {reason}')
        self._logs[reason] = self._logs.get(reason, 0) + 1

    def count(self) -> int:
        """Say how many logs share a reason; return how many cannot be read."""
        for reason, logs in self._logs.items():
            say(*([f'{logs} logs in all cannot be read: {reason}'] if logs > 1 else []))
        return sum(self._logs.values())


FEW = 8
"""Tasks up to which it takes longer to start processes than they save."""
OnLog = Callable[[Path, Collected], None]


def collect(logs: Sequence[Path], folder: Path, given: Given, workers: Workers) -> int:
    """
    Keep in a folder what each new log holds; return how many logs could not be read.

    A log that cannot be read is named and stops no other one. Raises SurfaceError if a scheduler
    is lost or the folder cannot be written.

    """
    held = held_logs(folder)
    files = given.params, given.mapping
    identities = {log: identity_of(log, files) for log in logs if log.exists()}
    missing = [log for log in logs if log not in identities]
    new = [
        log for log, known in identities.items() if not is_complete(held.get(known.log, ()), known)
    ]
    failures = Failures()
    for log in missing:
        failures.add(log, 'it does not exist')

    def keep_log(log: Path, collected: Collected) -> None:
        identity: LogIdentity = identities[log]
        say(*(f'{log}: {note}' for note in collected.notes))
        if not collected.histories:
            failures.add(log, collected.failure or 'nothing was judged in it')
            return
        try:
            keep(folder, identity, collected.histories, held.get(identity.log, ()))
        except OSError as error:
            raise SurfaceError(f'{folder} cannot be written: {error.strerror or error}') from None

    map_logs(new, given, workers, keep_log, alone=len(logs) == 1)
    known, failed = len(identities) - len(new), failures.count()
    kept = len(new) - failed + len(missing)
    print(f'{counted(kept, "log")} collected in {folder}, {known} known already')
    return failed


def map_logs(
    logs: Sequence[Path], given: Given, workers: Workers, on_log: OnLog, *, alone: bool
) -> None:
    """
    Judge each log in a task, and hand over what it holds; `alone`: no other one is named.

    A note that an earlier log has, too, is left out.

    """
    names = {os.path.abspath(log): log for log in logs}
    inputs = {name: _inputs(name, log, given, alone=alone) for name, log in names.items()}
    bar = Progress(len(names), 'recordings')
    progress = LogsProgress({name: size_of(log) for name, log in names.items()}, bar)
    told: set[str] = set()

    def report(outcome: TaskOutcome) -> None:
        collected = _collected(outcome, names[outcome.name])
        notes = [note for note in collected.notes if note not in told]
        told.update(notes)
        on_log(names[outcome.name], collected._replace(notes=notes))
        progress.done(outcome.name)

    try:
        run_mapped(collect_task, inputs, workers, report, progress.tell)
    finally:
        bar.close()


def run_mapped(
    task: Callable[[Mapping[str, Any]], dict[str, Any]],
    inputs: Mapping[str, Mapping[str, Any]],
    workers: Workers,
    report: Callable[[TaskOutcome], None],
    on_share: Callable[[str, float], None] = ignore,
) -> None:
    """Run a task on named inputs: on workers, or here where they are few and none is asked for."""
    if workers != Workers() or len(inputs) > FEW:
        with open_pool(workers.number, workers.dask, on_share=on_share) as pool:
            run_tasks(pool, task, inputs, report=report)
        return
    for name, given in inputs.items():
        try:
            outcome = TaskOutcome(name=name, result=task(given))
        except (InputError, SurfaceError) as error:
            outcome = TaskOutcome(name=name, result=None, sentence=str(error))
        report(outcome)


def _inputs(name: str, log: Path, given: Given, *, alone: bool) -> dict[str, str | None]:
    mapping = map_for(log, given.mapping, alone=alone)
    return {
        'log': name,
        'params': _text(given.params),
        'map': _text(mapping),
        'nominal': str(given.nominal),
    }


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path.resolve())


def _path(text: str | None) -> Path | None:
    return None if text is None else Path(text)


def _collected(outcome: TaskOutcome, log: Path) -> Collected:
    if outcome.result is None:
        return Collected([], [], outcome.sentence.replace(outcome.name, str(log)))
    histories = [read_history(plain) for plain in outcome.result['histories']]
    return Collected(histories, outcome.result['notes'])


def collect_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return as plain data what one log holds of its axes: a task of a worker."""
    reading = ReadingShare()
    given = Given(_path(inputs['params']), _path(inputs['map']), Path(inputs['nominal']))
    collected = judged(Path(inputs['log']), given, reading.tell_judged, shown=reading)
    plain: dict[str, Any] = to_json(
        {
            'histories': [dataclasses.asdict(history) for history in collected.histories],
            'notes': collected.notes,
        }
    )
    return plain


def judged(log: Path, given: Given, on_share: OnShare, **shown: Any) -> Collected:
    """Return what a log holds of its axes; raises InputError if it cannot be read."""
    bag = opened_log(log, mapping=given.mapping, **shown)
    case = judge_log(
        bag,
        parameters_for(bag, given.params, given.nominal),
        on_share=on_share,
        health=HistoryMaker,
        along_stroke=True,
    )
    histories = [axis.history for axis in case.axes if axis.history is not None]
    return Collected(histories, [*case.notes, *(f'check {hint}' for hint in hints_on(case.axes))])
