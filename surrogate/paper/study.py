# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The solves of the comparison with the published study: what is missing is solved, and kept.

Every finished task is kept at once in a store beside the table, so that an interrupted study goes
on where it stopped. Table and fields are written from the results at the end.

"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from surrogate.asperities.law import VERSION
from surrogate.paper.cases import StudyTask
from surrogate.paper.rows import (
    ContactFields,
    empty_row,
    fields_path,
    inputs_hash,
    read_fields,
    read_rows,
    StudyRow,
    TABLE,
    write_fields,
    write_rows,
)
from surrogate.paper.solve import solve_task
from surrogate.parameters import load_lubricant, load_screw
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.store import TaskStore

SCREW, OIL = 'nominal', 'iso_vg_68'
"""Datasheets of the published screw."""
WORK = 'surrogate.paper.study 2'
"""Solver and version of the kept results."""
Report = Callable[[int, int, float, StudyTask], None]
"""Told after each solve: tasks done, tasks in all, share of the work done [-], the task."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """
    Rows of the asked tasks by key, in their order, and the folder that keeps the fields.

    `inputs` is that of the contacts, which have fields.

    """

    rows: dict[str, StudyRow]
    folder: Path
    inputs: str

    def fields(self, key: str) -> ContactFields:
        """Return the kept fields of a task."""
        return read_fields(fields_path(self.folder, self.inputs, key))


def run_study(
    folder: Path, wanted: list[StudyTask], pool: Pool, report: Report | None = None
) -> Study:
    """Solve the tasks whose results `folder` does not keep yet; return all that were wanted."""
    table, known = folder / TABLE, known_inputs()
    before = read_rows(table, known.values())
    tasks = {task.key: asdict(task) | {'inputs': known[task.rolls]} for task in wanted}
    with TaskStore(table, WORK) as store:
        told = _Told(wanted, report)
        found = run_tasks(pool, solve_plain, tasks, store=store, report=told)
    rows = {task.key: _take(folder, known[task.rolls], task, found[task.key]) for task in wanted}
    write_rows(table, (before | rows).values())
    # As they stand in the table, so that a report is the same from either.
    written = read_rows(table, known.values())
    return Study(rows={key: written[key] for key in rows}, folder=folder, inputs=known[False])


def known_inputs() -> dict[bool, str]:
    """Return `inputs` of the rows that the asperity law decides, and of those it does not."""
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    return {True: inputs_hash(screw, oil, VERSION), False: inputs_hash(screw, oil)}


def solve_plain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Solve a task in plain JSON; return its row and, where they are kept, its fields."""
    words = dict(inputs)
    known = words.pop('inputs')
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    row, found = solve_task(screw, oil, StudyTask(**words), known)
    arrays = asdict(found) if found else {}
    return {
        'row': asdict(row),
        'fields': {name: np.asarray(value).tolist() for name, value in arrays.items()},
    }


class _Told:
    """Tells how far the new solves are."""

    def __init__(self, wanted: list[StudyTask], report: Report | None) -> None:
        self._left = {task.key: task for task in wanted}
        self._report, self._done, self._spent = report, 0, 0.0

    def __call__(self, outcome: TaskOutcome) -> None:
        """Count an outcome; those that were kept come first."""
        task = self._left.pop(outcome.name)
        if outcome.stored or self._report is None:
            return
        self._done += 1
        self._spent += task.cost
        total = self._spent + sum(one.cost for one in self._left.values())
        self._report(self._done, self._done + len(self._left), self._spent / total, task)


def _take(folder: Path, inputs: str, task: StudyTask, outcome: TaskOutcome) -> StudyRow:
    """Return the row of an outcome; write its fields."""
    if outcome.result is None:
        return replace(empty_row(task, inputs), status=outcome.sentence)
    path, found = fields_path(folder, inputs, task.key), outcome.result['fields']
    if found:
        arrays: Any = {name: np.array(value) for name, value in found.items()}
        write_fields(path, ContactFields(**arrays))
    return StudyRow(**outcome.result['row'])
