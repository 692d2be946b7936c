# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A study in one call: its tasks on processes of this machine, results kept, a bar meanwhile."""

from collections.abc import Mapping
from pathlib import Path
import sys
from typing import Any

from surrogate.tasks.child import Task
from surrogate.tasks.pool import run_tasks, TaskOutcome
from surrogate.tasks.progress import Progress
from surrogate.tasks.store import TaskStore
from surrogate.tasks.workers import open_pool


def run_kept(
    out: Path,
    work: str,
    task: Task,
    inputs: Mapping[str, Mapping[str, Any]],
    *,
    workers: int | None = None,
    unit: str = 'tasks',
) -> dict[str, dict[str, Any]]:
    """
    Run `task` on what the store beside `out` does not keep; return the results by name.

    A task that failed has none; its sentence is printed. `work` names solver and version. Raises
    SurfaceError for a store of other work.

    """
    progress = Progress(len(inputs), unit)

    def report(outcome: TaskOutcome) -> None:
        progress.step(there=outcome.stored)
        if outcome.result is None:
            print(f'{outcome.name}: {outcome.sentence}', file=sys.stderr)

    with TaskStore(out, work) as store, open_pool(workers) as pool:
        outcomes = run_tasks(pool, task, inputs, store=store, report=report)
    return {name: done.result for name, done in outcomes.items() if done.result is not None}
