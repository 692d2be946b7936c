# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings: one report each, in parallel, and one page over all of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import os.path
from pathlib import Path
import threading
from typing import Any

from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.log import PASSES
from ballscrew_monitor.report.log_report import AxisLine, LogResult, remove_left, report_log
from ballscrew_monitor.report.logs import folder_names, map_for
from ballscrew_monitor.report.overview import LogEntry, overview_page
from ballscrew_monitor.report.parameters import parameters_for
from surrogate.files import replace_file, to_json
from surrogate.progress import Progress
from surrogate.tasks.pool import run_tasks, TaskOutcome
from surrogate.tasks.workers import open_pool
from surrogate.worker import tell_share

INDEX = 'index.html'
READING = 0.5  # of the work on a table, before it is judged


class LogsProgress:
    """Shows how far recordings are in all, each by its size, so that a long one is seen to go."""

    def __init__(self, sizes: Mapping[str, int], progress: Progress) -> None:
        """Begin; `sizes` [bytes] by name."""
        self._sizes, self._progress = sizes, progress
        self._shares = dict.fromkeys(sizes, 0.0)
        self._done = 0
        self._lock = threading.Lock()

    def tell(self, name: str, share: float) -> None:
        """Take which share of a recording is done [-], from any thread."""
        if name not in self._shares:  # told late by an earlier run on the same pool
            return
        with self._lock:
            self._shares[name] = max(self._shares[name], share)
            self._show()

    def done(self, name: str) -> None:
        """Take that a recording is done."""
        with self._lock:
            self._shares[name] = 1.0
            self._done += 1
            self._show()

    def _show(self) -> None:
        whole = sum(self._sizes.values())
        share = sum(size * self._shares[name] for name, size in self._sizes.items()) / whole
        self._progress.show(self._done, len(self._sizes), share=share)


class ReadingShare:
    """Tells from a worker how far a recording is, of which a table is first read in passes."""

    def __init__(self) -> None:
        self._passes = 0

    @contextlib.contextmanager
    def __call__(self, total: float, unit: str) -> Iterator[Callable[[float], None]]:
        """Give what is told how far a pass is [-]."""
        before = self._passes
        self._passes += 1
        yield lambda share: tell_share(READING * (before + share) / PASSES)

    def tell_judged(self, share: float) -> None:
        """Tell which share is judged [-]."""
        first = READING if self._passes else 0.0
        tell_share(first + (1.0 - first) * share)


def size_of(log: Path) -> int:
    """Return the size of a recording [bytes], at least 1 where it is empty or not there."""
    files = log.iterdir() if log.is_dir() else [log]
    return max(1, sum(file.stat().st_size for file in files if file.is_file()))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogToReport:
    """A recording with its parameters, its map and a folder of its own."""

    log: Path
    folder: str
    params: Path | None
    mapping: Path | None


def report_logs(
    logs: Sequence[Path],
    out: Path,
    *,
    params: Path | None,
    mapping: Path | None,
    nominal: Path,
    notes: Sequence[str],
    workers: int | None,
    dask: str | None,
) -> list[LogEntry]:
    """
    Write a report of each of several recordings and the page over all; return their entries.

    The map is for tables alone; `notes` are sentences for the page.

    """
    # A map is for tables; one recording has it for certain, and is refused if it is a bag.
    alone = len(logs) == 1
    whole = [
        LogToReport(
            log=log, folder=name, params=params, mapping=map_for(log, mapping, alone=alone)
        )
        for log, name in zip(logs, folder_names(logs), strict=True)
    ]
    entries = report_each(whole, out, nominal=nominal, workers=workers, dask=dask)
    replace_file(out / INDEX, overview_page(entries, notes).encode())
    return entries


def report_each(
    logs: Sequence[LogToReport], out: Path, *, nominal: Path, workers: int | None, dask: str | None
) -> list[LogEntry]:
    """Write a report of each of several recordings; return their entries."""
    inputs = {
        log.folder: {
            'log': os.path.abspath(log.log),  # a link belongs to the machine where it lies
            'out': str((out / log.folder).resolve()),
            'params': _text(log.params),
            'map': _text(log.mapping),
            'nominal': str(nominal),
        }
        for log in logs
    }
    outcomes = _outcomes(inputs, workers, dask)
    return [entry_of(log.log.name, log.folder, outcomes[log.folder]) for log in logs]


def _outcomes(
    inputs: Mapping[str, Mapping[str, Any]], workers: int | None, dask: str | None
) -> dict[str, TaskOutcome]:
    sizes = {name: size_of(Path(one['log'])) for name, one in inputs.items()}
    bar = Progress(len(inputs), 'recordings')
    progress = LogsProgress(sizes, bar)
    try:
        with open_pool(workers, dask, on_share=progress.tell) as pool:
            return run_tasks(
                pool, report_task, inputs, report=lambda outcome: progress.done(outcome.name)
            )
    finally:
        bar.close()
        for one in inputs.values():  # a worker that was killed has left it
            remove_left(Path(one['out']))


def report_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Report one recording in a worker; plain data in, the `LogResult` as plain data out."""
    reading = ReadingShare()
    bag = opened_log(Path(inputs['log']), mapping=_path(inputs['map']), shown=reading)
    parameters = parameters_for(bag, _path(inputs['params']), Path(inputs['nominal']))
    result = report_log(bag, Path(inputs['out']), parameters, on_share=reading.tell_judged)
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
    # For what is not known the defaults stand.
    known = [
        {key: one for key, one in line.items() if one is not None} for line in record.pop('lines')
    ]
    lines = [AxisLine(**line) for line in known]
    return LogEntry(name=name, folder=folder, result=LogResult(lines=lines, **record))
