# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Run many tasks on the processes of this machine or on a Dask cluster.

A task is a pure function from plain JSON to plain JSON. Solves that warm-start each other are one
task, a fixed unit of work, so that a result depends neither on the number of workers nor on the
order in which they finish. A task that fails leaves a sentence; one whose worker is lost is done
by another.

"""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import as_completed, BrokenExecutor, CancelledError, Future
from dataclasses import dataclass
from typing import Any, Protocol, Self

from surrogate.surface_file import SurfaceError
from surrogate.task_store import task_key, TaskStore
from surrogate.task_worker import describe_failure, Task

MOST_TRIES = 3
"""How often a task is begun whose worker is lost each time; the last time it runs alone [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """
    What became of a task: its result, or None and a sentence.

    `worker` is the host and process that finished it, `lost` those that were lost at it, `seconds`
    [s] what the solve took; `stored` tells that it was kept from an earlier run.

    """

    name: str
    result: dict[str, Any] | None
    sentence: str = ''
    worker: str = ''
    seconds: float = 0.0
    lost: tuple[str, ...] = ()
    stored: bool = False


class Pool(Protocol):
    """Workers, wherever they are; made by `task_workers.open_pool`, closed by `with`."""

    def __enter__(self) -> Self:
        """Return the open pool."""

    def __exit__(self, *error: object) -> None:
        """Stop all workers, also those at work."""

    def submit(self, task: Task, name: str, inputs: Mapping[str, Any]) -> Future[dict[str, Any]]:
        """Hand a task over; raises BrokenExecutor when workers were lost."""

    def begun(self) -> list[tuple[str, str]]:
        """Return names of tasks and workers that have begun them, since the last call."""

    def renew(self) -> None:
        """Replace workers that were lost."""


def run_tasks(
    pool: Pool,
    task: Task,
    inputs: Mapping[str, Mapping[str, Any]],
    *,
    store: TaskStore | None = None,
    report: Callable[[Outcome], None] = lambda outcome: None,
) -> dict[str, Outcome]:
    """
    Run `task` on every one of the named inputs and return the outcomes in the order of the names.

    With a `store`, results that it has are taken from there, and new ones are kept as they come;
    failures are not, they are tried again by the next run. `report` is told of each outcome, in
    any order. Raises SurfaceError when no workers can be had or the store cannot be written.

    """
    run = _Run(pool, task, inputs, store)
    found = {}
    for outcome in run.outcomes():
        found[outcome.name] = outcome
        report(outcome)
    return {name: found[name] for name in inputs}


class _Run:
    """The tasks that are left, and which workers have begun each."""

    def __init__(
        self,
        pool: Pool,
        task: Task,
        inputs: Mapping[str, Mapping[str, Any]],
        store: TaskStore | None,
    ) -> None:
        self._pool, self._task, self._store = pool, task, store
        self._left = dict(inputs)
        self._begun: dict[str, list[str]] = {name: [] for name in inputs}

    def outcomes(self) -> Iterator[Outcome]:
        """Yield outcomes as they come, those of the store first."""
        yield from self._kept()
        idle = 0
        while self._left:
            before = len(self._left), sum(map(len, self._begun.values()))
            yield from self._round(self._batch())
            idle += before == (len(self._left), sum(map(len, self._begun.values())))
            if idle == MOST_TRIES:
                raise SurfaceError(
                    f'{len(self._left)} tasks are left and no worker begins one: the workers end '
                    'as soon as they start'
                )

    def _kept(self) -> Iterator[Outcome]:
        if self._store is None:
            return
        for name, inputs in tuple(self._left.items()):
            result = self._store.get(task_key(self._store.work, inputs))
            if result is not None:
                del self._left[name]
                yield Outcome(name=name, result=result, stored=True)

    def _batch(self) -> list[str]:
        """Return what to try: those that have lost too many workers last, and each alone."""
        fresh = [name for name in self._left if len(self._begun[name]) < MOST_TRIES - 1]
        return fresh or [next(iter(self._left))]

    def _round(self, names: list[str]) -> Iterator[Outcome]:
        """Try some tasks until all are done or workers are lost."""
        futures: dict[Future[dict[str, Any]], str] = {}
        broken = False
        try:
            for name in names:
                futures[self._pool.submit(self._task, name, self._left[name])] = name
        except BrokenExecutor:
            broken = True
        for future in as_completed(futures):
            self._take_notes()
            error = _error(future)
            if isinstance(error, BrokenExecutor):
                broken = True
                continue
            yield self._finish(futures[future], future, error)
        if broken:
            self._take_notes()
            self._pool.renew()
            yield from self._given_up(names)

    def _take_notes(self) -> None:
        for name, worker in self._pool.begun():
            self._begun[name].append(worker)

    def _finish(
        self, name: str, future: Future[dict[str, Any]], error: BaseException | None
    ) -> Outcome:
        inputs = self._left.pop(name)
        if error is not None:
            return self._failed(name, describe_failure(error))
        done = future.result()
        if self._store is not None and done['result'] is not None:
            self._store.put(task_key(self._store.work, inputs), done['result'])
        lost = [worker for worker in self._begun[name] if worker != done['worker']]
        return Outcome(name=name, lost=tuple(dict.fromkeys(lost)), **done)

    def _given_up(self, names: list[str]) -> Iterator[Outcome]:
        for name in names:
            if name in self._left and len(self._begun[name]) >= MOST_TRIES:
                del self._left[name]
                yield self._failed(
                    name, f'its worker was lost {len(self._begun[name])} times, at last alone'
                )

    def _failed(self, name: str, sentence: str) -> Outcome:
        lost = tuple(self._begun[name])
        return Outcome(
            name=name, result=None, sentence=sentence, lost=lost, worker=lost[-1] if lost else ''
        )


def _error(future: Future[dict[str, Any]]) -> BaseException | None:
    """Return what a future failed with; raises SurfaceError when the whole cluster is gone."""
    try:
        return future.exception()
    except CancelledError:
        raise SurfaceError(
            'the scheduler was lost; run the command again, results that were kept are not '
            'solved again'
        ) from None
