# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings: one report each, in parallel, and one page over all of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import os.path
from pathlib import Path
import threading
from typing import Any, NamedTuple

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.log import PASSES
from ballscrew_monitor.report.log_report import LogResult, remove_left, report_log
from ballscrew_monitor.report.logs import folder_names, map_for
from ballscrew_monitor.report.overview import overview_page
from ballscrew_monitor.report.parameters import LogParameters, parameters_for
from surrogate.files import InputError, replace_file, to_json
from surrogate.surface import SurfaceError
from surrogate.tasks.pool import run_tasks, TaskOutcome
from surrogate.tasks.progress import Progress
from surrogate.tasks.worker import tell_share
from surrogate.tasks.workers import ignore, open_pool

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


class Given(NamedTuple):
    """Files that a log is judged with: parameters and map, None for none, and the usual ones."""

    params: Path | None
    mapping: Path | None
    nominal: Path


class Workers(NamedTuple):
    """Number of processes, None for all cores, and the address of a Dask scheduler, if any."""

    number: int | None = None
    dask: str | None = None


def task_inputs(log: Path, given: Given) -> dict[str, str | None]:
    """Return the inputs of a task; a link to a recording belongs to the machine where it lies."""
    named = {'params': given.params, 'map': given.mapping}
    paths = {key: None if path is None else str(path.resolve()) for key, path in named.items()}
    return {'log': os.path.abspath(log), 'nominal': str(given.nominal), **paths}


def opened_by_task(inputs: Mapping[str, Any], reading: ReadingShare) -> tuple[Bag, LogParameters]:
    """Return the recording of a task, which tells how far it is read, and its parameters."""
    params, mapping = (
        None if inputs[key] is None else Path(inputs[key]) for key in ('params', 'map')
    )
    bag = opened_log(Path(inputs['log']), mapping=mapping, shown=reading)
    return bag, parameters_for(bag, params, Path(inputs['nominal']))


def run_mapped(
    task: Callable[[Mapping[str, Any]], dict[str, Any]],
    inputs: Mapping[str, Mapping[str, Any]],
    workers: Workers,
    report: Callable[[TaskOutcome], None],
    on_share: Callable[[str, float], None] = ignore,
    *,
    few: int = 0,
) -> None:
    """Run a task on named inputs: on workers, or here where they are `few` and none is named."""
    if workers != Workers() or len(inputs) > few:
        with open_pool(workers.number, workers.dask, on_share=on_share) as pool:
            run_tasks(pool, task, inputs, report=report)
        return
    for name, given in inputs.items():
        try:
            outcome = TaskOutcome(name=name, result=task(given))
        except (InputError, SurfaceError) as error:
            outcome = TaskOutcome(name=name, result=None, sentence=str(error))
        report(outcome)


def run_on_logs(
    task: Callable[[Mapping[str, Any]], dict[str, Any]],
    inputs: Mapping[str, Mapping[str, Any]],
    workers: Workers,
    report: Callable[[TaskOutcome], None],
    *,
    few: int = 0,
) -> None:
    """Run a task on recordings as `run_mapped` does, and show how far they are by their sizes."""
    bar = Progress(len(inputs), 'recordings')
    sizes = {name: size_of(Path(known['log'])) for name, known in inputs.items()}
    progress = LogsProgress(sizes, bar)

    def done(outcome: TaskOutcome) -> None:
        report(outcome)
        progress.done(outcome.name)

    try:
        run_mapped(task, inputs, workers, done, progress.tell, few=few)
    finally:
        bar.close()


def report_logs(
    logs: Sequence[Path], out: Path, given: Given, workers: Workers, notes: Sequence[str]
) -> list[LogResult]:
    """
    Write a report of each of several recordings and the page over all; return what became of each.

    The map is for tables alone; `notes` are sentences for the page.

    """
    # A map is for tables; one recording has it for certain, and is refused if it is a bag.
    alone = len(logs) == 1
    mapped = {
        name: (log, given._replace(mapping=map_for(log, given.mapping, alone=alone)))
        for log, name in zip(logs, folder_names(logs), strict=True)
    }
    results = report_each(mapped, out, workers)
    replace_file(out / INDEX, overview_page(results, notes).encode())
    return results


def report_each(
    logs: Mapping[str, tuple[Path, Given]], out: Path, workers: Workers
) -> list[LogResult]:
    """Write a report of each recording into its folder; return what became of them."""
    inputs = {
        folder: task_inputs(log, given) | {'out': str((out / folder).resolve())}
        for folder, (log, given) in logs.items()
    }
    outcomes: dict[str, TaskOutcome] = {}
    try:
        run_on_logs(
            report_task, inputs, workers, lambda outcome: outcomes.update({outcome.name: outcome})
        )
    finally:
        for folder in inputs:  # a worker that was killed has left it
            remove_left(out / folder)
    results = []
    for folder, (log, _) in logs.items():
        known: Mapping[str, Any] = {'failure': outcomes[folder].sentence}
        if (record := outcomes[folder].result) is not None:
            known = record
        results.append(record_of(LogResult, {**known, 'name': log.name, 'folder': folder}))
    return results


def report_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Report one recording in a worker; plain data in, the `LogResult` as plain data out."""
    reading = ReadingShare()
    bag, parameters = opened_by_task(inputs, reading)
    result = report_log(bag, Path(inputs['out']), parameters, on_share=reading.tell_judged)
    record: dict[str, Any] = to_json(dataclasses.asdict(result))
    return record
