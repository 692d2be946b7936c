# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Run many tasks on the processes of this machine or on a Dask cluster.

A task is a pure function from plain JSON to plain JSON. Solves that warm-start each other are one
task, a fixed unit of work, so that a result depends neither on the number of workers nor on the
order in which they finish. A task that fails leaves a sentence; one whose worker is lost is done
by another.

"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, Self

from surrogate.tasks.child import Frame, Task
from surrogate.tasks.store import task_key, TaskStore
from surrogate.tasks.worker import task_name

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

    def submit(self, name: str, task: str, inputs: Mapping[str, Any]) -> None:
        """Hand a task over, `module:function`."""

    def wait(self, seconds: float) -> list[tuple[str, Frame]]:
        """Return what is heard of tasks within a time [s], as `Workers.wait` does."""


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
    outcomes: dict[str, TaskOutcome] = {}

    def end(outcome: TaskOutcome) -> None:
        outcomes[outcome.name] = outcome
        report(outcome)

    for name, given in inputs.items():
        if store is not None and (kept := store.get(task_key(store.work, given))) is not None:
            end(TaskOutcome(name=name, result=kept, stored=True))
    begun: dict[str, list[str]] = {name: [] for name in inputs if name not in outcomes}
    function = task_name(task)
    for name in begun:
        pool.submit(name, function, inputs[name])
    while len(outcomes) < len(inputs):
        heard = pool.wait(ATTENTION)
        if not heard:
            waiting()
        for name, frame in heard:
            if name not in begun or name in outcomes:  # of an earlier run on this pool
                continue
            if 'begun' in frame:
                begun[name].append(frame['begun'])
            elif 'lost' in frame and len(begun[name]) < MOST_TRIES:
                pool.submit(name, function, inputs[name])
            elif 'lost' in frame or 'result' in frame:
                outcome = _outcome(name, frame, begun[name])
                if store is not None and outcome.result is not None:
                    store.put(task_key(store.work, inputs[name]), outcome.result)
                end(outcome)
    return {name: outcomes[name] for name in inputs}


def _outcome(name: str, frame: Frame, begun: list[str]) -> TaskOutcome:
    """Return what became of a task that workers have `begun`, by the frame of its end."""
    workers = tuple(dict.fromkeys(begun))
    if 'lost' in frame:
        sentence = f'its worker was lost {len(workers)} times'
        worker = workers[-1] if workers else ''
        return TaskOutcome(name=name, result=None, sentence=sentence, lost=workers, worker=worker)
    worker = frame['worker'] or (workers[-1] if workers else '')
    lost = tuple(begun_by for begun_by in workers if begun_by != frame['worker'])
    return TaskOutcome(**{'name': name, **frame, 'worker': worker, 'lost': lost})
