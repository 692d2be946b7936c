# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings: one report each, in parallel, and one page over all of them."""

from collections.abc import Mapping, Sequence
import dataclasses
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.progress import silent
from ballscrew_monitor.report.log_report import AxisLine, LogResult, report_log
from ballscrew_monitor.report.logs import folder_names
from ballscrew_monitor.report.overview import LogEntry, overview_page
from ballscrew_monitor.report.parameters import parameters_for
from surrogate.files import replace_file, to_json
from surrogate.progress import Progress
from surrogate.tasks.pool import run_tasks, TaskOutcome
from surrogate.tasks.workers import open_pool

INDEX = 'index.html'


def report_logs(
    logs: Sequence[Path],
    out: Path,
    *,
    params: Path | None,
    mapping: Path | None,
    nominal: Path,
    workers: int | None,
    dask: str | None,
) -> list[LogEntry]:
    """Write a report of each of several recordings and the page over all; return their entries."""
    inputs = {
        name: {
            'log': str(log.resolve()),
            'out': str((out / name).resolve()),
            'params': _text(params),
            'map': _text(mapping),
            'nominal': str(nominal),
        }
        for log, name in zip(logs, folder_names(logs), strict=True)
    }
    progress = Progress(len(logs), 'recordings')
    with open_pool(workers, dask) as pool:
        outcomes = run_tasks(pool, report_task, inputs, report=lambda outcome: progress.step())
    entries = [
        entry_of(log.name, folder, outcomes[folder])
        for log, folder in zip(logs, inputs, strict=True)
    ]
    replace_file(out / INDEX, overview_page(entries).encode())
    return entries


def report_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Report one recording in a worker; plain data in, the `LogResult` as plain data out."""
    with opened_log(Path(inputs['log']), mapping=_path(inputs['map']), shown=silent) as bag:
        parameters = parameters_for(bag, _path(inputs['params']), Path(inputs['nominal']))
        result = report_log(bag, Path(inputs['out']), parameters)
    record: dict[str, Any] = to_json(dataclasses.asdict(result))
    return record


def _path(text: str | None) -> Path | None:
    return None if text is None else Path(text)


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path.resolve())


def entry_of(name: str, folder: str, outcome: TaskOutcome) -> LogEntry:
    """Return what became of a recording, of which a worker told."""
    if outcome.result is None:
        return LogEntry(name=name, folder=folder, failure=outcome.sentence)
    record = dict(outcome.result)
    lines = [AxisLine(**_without_none(line)) for line in record.pop('lines')]
    return LogEntry(name=name, folder=folder, result=LogResult(lines=lines, **record))


def _without_none(line: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that are known; for the others the defaults stand."""
    return {key: value for key, value in line.items() if value is not None}
