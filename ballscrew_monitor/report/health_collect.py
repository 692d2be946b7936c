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
from typing import Any

from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.recordings.words import counted, say
from ballscrew_monitor.report.health_folder import (
    held_logs,
    identity_of,
    is_complete,
    keep,
    place_of,
)
from ballscrew_monitor.report.health_history import AxisHistory
from ballscrew_monitor.report.inputs_seen import hints_on
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.logs import map_for
from ballscrew_monitor.report.many_logs import (
    Given,
    opened_by_task,
    ReadingShare,
    run_on_logs,
    task_inputs,
    Workers,
)
from surrogate.files import to_json
from surrogate.surface import SurfaceError
from surrogate.tasks.pool import TaskOutcome


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
OnLog = Callable[[Path, list[AxisHistory], str], None]
"""Handed what a log holds of its axes, or the sentence why it cannot be read."""


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
    former = {log: held.get(place_of(identity), []) for log, identity in identities.items()}
    new = [log for log, identity in identities.items() if not is_complete(former[log], identity)]
    failures = Failures()
    for log in missing:
        failures.add(log, 'it does not exist')

    def keep_log(log: Path, histories: list[AxisHistory], failure: str) -> None:
        if not histories:
            failures.add(log, failure or 'nothing was judged in it')
            return
        try:
            keep(folder, identities[log], histories, former[log])
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

    The notes on a log are said, but for those that an earlier log has, too.

    """
    names = {os.path.abspath(log): log for log in logs}
    inputs = {
        name: task_inputs(log, given._replace(mapping=map_for(log, given.mapping, alone=alone)))
        for name, log in names.items()
    }
    noted: set[str] = set()

    def report(outcome: TaskOutcome) -> None:
        log = names[outcome.name]
        if outcome.result is None:
            on_log(log, [], outcome.sentence.replace(outcome.name, str(log)))
            return
        new = [note for note in outcome.result['notes'] if note not in noted]
        noted.update(new)
        say(*(f'{log}: {note}' for note in new))
        on_log(log, [record_of(AxisHistory, plain) for plain in outcome.result['histories']], '')

    run_on_logs(collect_task, inputs, workers, report, few=FEW)


def collect_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return as plain data what one log holds of its axes: a task of a worker."""
    reading = ReadingShare()
    bag, parameters = opened_by_task(inputs, reading)
    case = judge_log(bag, parameters, on_share=reading.tell_judged, health=True, along_stroke=True)
    histories = [dataclasses.asdict(axis.history) for axis in case.axes if axis.history]
    notes = [*case.notes, *(f'check {hint}' for hint in hints_on(case.axes))]
    plain: dict[str, Any] = to_json({'histories': histories, 'notes': notes})
    return plain
