# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The full tier as a tier of surfaces: build with workers and a store, and solve a point again."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
import sys
import time
from typing import Any

import numba
import numpy as np
from surrogate.builder.closed_form import provenance
from surrogate.builder.full.build import build_full
from surrogate.builder.full.chain import point_inputs, solve_chain, solved_chain, WORK
from surrogate.builder.full.march import doubtful_strips, march_task, march_tasks, marched_film
from surrogate.builder.full.ratios import Results
from surrogate.builder.full.settings import FullSettings
from surrogate.parameters import Lubricant, Screw, screw_and_oil
from surrogate.raceway.stated import Roughness
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import SolvedPoint
from surrogate.surface.file import SurfaceData
from surrogate.tasks.child import Task
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.progress import Progress
from surrogate.tasks.store import TaskStore
from surrogate.units import digits, RPM, ZERO_CELSIUS


@dataclass(slots=True)
class TaskRun:
    """
    Solves chains on a pool and keeps their results; call it as a builder's `run`.

    Counts tasks, how many of them a store had kept, seconds of the workers [s] without those
    kept, and failures with their sentences.

    """

    pool: Pool
    store: TaskStore | None = None
    tasks: int = 0
    kept: int = 0
    seconds: float = 0.0
    failures: list[str] = field(default_factory=list)

    def __call__(self, tasks: Mapping[str, Mapping[str, Any]]) -> Results:
        """Solve named chains; None for one that failed."""
        return self.solve(solve_chain, tasks, 'chain')

    def solve(self, task: Task, tasks: Mapping[str, Mapping[str, Any]], unit: str) -> Results:
        """Solve named tasks of one kind, whose `unit` is its name; None for one that failed."""
        progress = Progress(len(tasks), f'{unit}s')

        def count(outcome: TaskOutcome) -> None:
            progress.step(there=outcome.stored)
            self.tasks += 1
            self.kept += outcome.stored
            self.seconds += 0.0 if outcome.stored else outcome.seconds
            if outcome.result is None:
                self.failures.append(f'{unit}, {outcome.name}: {outcome.sentence}')
                print(self.failures[-1], file=sys.stderr)

        done = run_tasks(
            self.pool, task, tasks, store=self.store, report=count, waiting=progress.beat
        )
        return {name: outcome.result for name, outcome in done.items()}


def build_full_surface(
    screw: Screw,
    lubricant: Lubricant,
    settings: FullSettings,
    *,
    pool: Pool,
    out: str | Path,
    march: bool = False,
) -> SurfaceData:
    """
    Build a surface on workers; results are kept beside `out`, an interrupted build goes on.

    With `march`, strips of the raceway are marched first, stand in the header and correct the law,
    whatever marches the sheet states.
    Says on stderr where the accuracy aimed at was not reached and nodes have no number.

    Raises InputError for ranges that make no sense, SurfaceError for a store that cannot be used.

    """
    began = time.perf_counter()
    if march:
        screw = with_raceway(screw, **dict.fromkeys(Roughness.MARCHED))
    with TaskStore(out, WORK) as store:
        run = TaskRun(pool=pool, store=store)
        tasks = march_tasks(screw, lubricant) if march else {}
        results = run.solve(march_task, tasks, 'strip') if tasks else {}
        strips = {name: result for name, result in results.items() if result}
        sheet = screw.roughness
        marched = with_raceway(screw, **marched_film(strips, sheet.lay, sheet.state))
        data = build_full(marched, lubricant, settings, run)
    if tasks:
        data = replace(data, header={**data.header, 'march': strips})
    for sentence in shortfalls(data):
        print(sentence, file=sys.stderr)
    work = {
        'worker_seconds': round(run.seconds, 3),
        'tasks': run.tasks,
        'kept_tasks': run.kept,
        'failed_tasks': len(run.failures),
        'numba': numba.__version__,
    }
    return replace(data, provenance=provenance(time.perf_counter() - began) | work)


def shortfalls(data: SurfaceData) -> Iterator[str]:
    """Yield a sentence on marches, accuracy that was not reached and nodes that are missing."""
    raceway, strips = data.header['inputs']['screw']['roughness'], data.header.get('march', {})
    if 'march' in data.header and raceway.get('marched_film') is None:
        yield 'too few strips show where contact begins: the law alone tells it'
    yield from doubtful_strips(strips, raceway)
    reached = data.header['reached']
    if reached is None:
        yield 'accuracy is not known: no held-out point was solved'
    elif reached > 1:
        yield (
            f'the largest error at held-out points is {reached:.2g} times the allowed one; the '
            'file says where'
        )
    yield from _missing(data)


def _missing(data: SurfaceData) -> Iterator[str]:
    place = np.nonzero(data.mask)
    if place[0].size:
        speed = np.exp(data.speed_coordinate[place[0]] + data.log_onset[place[1:]])
        rpm, load = speed / RPM, data.load[place[1]]
        heat = data.temperature[place[2]] - ZERO_CELSIUS
        yield (
            f'{rpm.size} of {data.mask.size} nodes are missing, points beside them were not '
            f'solved: {digits(rpm.min())} to {digits(rpm.max())} rev/min, {load.min():g} to '
            f'{load.max():g} N, {heat.min():.3g} to {heat.max():.3g} degC; lookups there are NaN'
        )


def solve_full(
    header: Mapping[str, Any], speed: float, load: float, temperature: float
) -> SolvedPoint:
    """Solve a point [rad/s, N, K] of the screw and oil of a surface."""
    screw, lubricant = screw_and_oil(header['inputs'])
    given = point_inputs(screw, lubricant, load, temperature, speed)
    return solved_chain(solve_chain(given))[0][0]
