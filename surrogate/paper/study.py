# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The solves of the comparison with the published study: what is missing is solved, and kept.

Every finished task is written at once, so that an interrupted study goes on where it stopped.

"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from surrogate.paper.cases import Task
from surrogate.paper.rows import (
    ContactFields,
    fields_path,
    inputs_hash,
    read_fields,
    read_rows,
    Row,
    TABLE,
    write_fields,
    write_rows,
)
from surrogate.paper.solve import solve_task
from surrogate.parameters import load_lubricant, load_screw, Lubricant, Screw

SCREW, OIL = 'nominal', 'iso_vg_68'
"""Datasheets of the published screw."""
Progress = Callable[[int, int, float, Task], None]
"""Told after each solve: tasks done, tasks in all, share of the work done [-], the task."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """Rows of the asked tasks by key, in their order, and the folder that keeps the fields."""

    rows: dict[str, Row]
    folder: Path
    inputs: str

    def fields(self, key: str) -> ContactFields:
        """Return the kept fields of a task."""
        return read_fields(fields_path(self.folder, self.inputs, key))


def run_study(folder: Path, wanted: list[Task], progress: Progress | None = None) -> Study:
    """Solve the tasks that `folder` does not hold yet; return all that were wanted."""
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    inputs = inputs_hash(screw, oil)
    folder.mkdir(parents=True, exist_ok=True)
    rows = read_rows(folder / TABLE, inputs)
    left = [task for task in wanted if not _done(folder, inputs, rows, task)]
    total, spent = sum(task.cost for task in left), 0.0
    for count, task in enumerate(left, 1):
        rows[task.key] = _solve(folder, screw, oil, task, inputs)
        write_rows(folder / TABLE, rows.values())
        spent += task.cost
        if progress:
            progress(count, len(left), spent / total, task)
    keys = [task.key for task in wanted]
    return Study(rows={key: rows[key] for key in keys}, folder=folder, inputs=inputs)


def _done(folder: Path, inputs: str, rows: dict[str, Row], task: Task) -> bool:
    """Tell whether a row is there, and the fields that a picture needs of it."""
    if task.key not in rows:
        return False
    if not task.fields or rows[task.key].status != 'CONVERGED':
        return True
    path = fields_path(folder, inputs, task.key)
    return path.exists() and (task.fields == 'line' or read_fields(path).y.size > 1)


def _solve(folder: Path, screw: Screw, oil: Lubricant, task: Task, inputs: str) -> Row:
    row, found = solve_task(screw, oil, task, inputs)
    if found is not None:
        write_fields(fields_path(folder, inputs, task.key), found)
    return row
