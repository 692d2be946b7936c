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
from concurrent.futures import BrokenExecutor, CancelledError, Future
import contextlib
from dataclasses import dataclass
import queue
from typing import Any, Protocol, Self

from surrogate.surface.file import SurfaceError
from surrogate.tasks.store import task_key, TaskStore
from surrogate.tasks.worker import describe_failure, Task

MOST_TRIES = 3
"""How often a task is begun whose worker is lost each time [-]."""
ATTENTION = 0.2
"""Time after which a wait heeds Ctrl-C [s]: libraries let the system resume waits instead."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TaskOutcome:
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
    """Workers, wherever they are; made by `workers.open_pool`, closed by `with`."""

    def __enter__(self) -> Self:
        """Return the open pool."""

    def __exit__(self, *error: object) -> None:
        """Stop all workers, also those at work."""

    def submit(self, task: Task, name: str, inputs: Mapping[str, Any]) -> Future[dict[str, Any]]:
        """Hand a task over; its future fails with BrokenExecutor when its worker is lost."""

    def begun(self) -> list[tuple[str, str]]:
        """Return names of tasks and workers that have begun them, since the last call."""


def run_tasks(
    pool: Pool,
    task: Task,
    inputs: Mapping[str, Mapping[str, Any]],
    *,
    store: TaskStore | None = None,
    report: Callable[[TaskOutcome], None] = lambda outcome: None,
    waiting: Callable[[], None] = lambda: None,
) -> dict[str, TaskOutcome]:
    """
    Run `task` on every one of the named inputs and return the outcomes in the order of the names.

    With a `store`, results that it has are taken from there, and new ones are kept as they come;
    failures are not, they are tried again by the next run. `report` receives each outcome, in
    any order; `waiting` is called time and again meanwhile. Raises SurfaceError when a cluster is
    lost or the store cannot be written.

    """
    run = _Run(pool, task, inputs, store, waiting)
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
        waiting: Callable[[], None],
    ) -> None:
        self._pool, self._task, self._store, self._waiting = pool, task, store, waiting
        self._left = dict(inputs)
        self._begun: dict[str, list[str]] = {name: [] for name in inputs}
        self._names: dict[Future[dict[str, Any]], str] = {}
        self._done: queue.SimpleQueue[Future[dict[str, Any]]] = queue.SimpleQueue()

    def outcomes(self) -> Iterator[TaskOutcome]:
        """Yield outcomes as they come, those of the store first."""
        yield from self._kept()
        for name in self._left:
            self._submit(name)
        while self._left:
            future = self._next()
            name, error = self._names.pop(future), _error(future)
            for begun, worker in self._pool.begun():
                if begun in self._begun:  # not told late by an earlier run on this pool
                    self._begun[begun].append(worker)
            if isinstance(error, BrokenExecutor) and len(self._begun[name]) < MOST_TRIES:
                self._submit(name)
            else:
                yield self._finish(name, future, error)

    def _next(self) -> Future[dict[str, Any]]:
        """Return the next that is done; an endless wait may be one that Ctrl-C does not end."""
        while True:
            with contextlib.suppress(queue.Empty):
                return self._done.get(timeout=ATTENTION)
            self._waiting()

    def _kept(self) -> Iterator[TaskOutcome]:
        if self._store is None:
            return
        for name, inputs in tuple(self._left.items()):
            result = self._store.get(task_key(self._store.work, inputs))
            if result is not None:
                del self._left[name]
                yield TaskOutcome(name=name, result=result, stored=True)

    def _submit(self, name: str) -> None:
        future = self._pool.submit(self._task, name, self._left[name])
        self._names[future] = name
        future.add_done_callback(self._done.put)

    def _finish(
        self, name: str, future: Future[dict[str, Any]], error: BaseException | None
    ) -> TaskOutcome:
        inputs, lost = self._left.pop(name), list(dict.fromkeys(self._begun[name]))
        if error is not None:
            sentence = describe_failure(error)
            if isinstance(error, BrokenExecutor):
                sentence = f'its worker was lost {len(lost)} times'
            worker = lost[-1] if lost else ''
            return TaskOutcome(
                name=name, result=None, sentence=sentence, lost=tuple(lost), worker=worker
            )
        done = future.result()
        if self._store is not None and done['result'] is not None:
            self._store.put(task_key(self._store.work, inputs), done['result'])
        return TaskOutcome(
            name=name, lost=tuple(worker for worker in lost if worker != done['worker']), **done
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
