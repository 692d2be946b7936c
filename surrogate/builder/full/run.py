# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Chains of a full-tier surface on workers, with a store, progress and a count of the work."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
import sys
from typing import Any

from surrogate.builder.full.chain import solve_chain, solved_chain, SolvedChain
from surrogate.builder.full.columns import Results
from surrogate.builder.full.settings import SolveChains
from surrogate.progress import Progress
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.store import task_key, TaskStore
from surrogate.tasks.worker import Task


@dataclass(slots=True)
class ChainRun:
    """
    Solves chains on a pool and keeps their results; call it as a builder's `run`.

    Counts chains, how many of them a store had kept, points, seconds of the workers [s] without
    those kept, and failures with their sentences.

    """

    pool: Pool
    store: TaskStore | None = None
    task: Task = solve_chain
    report: Callable[[str, TaskOutcome], None] = lambda purpose, outcome: None
    chains: int = 0
    kept: int = 0
    points: int = 0
    seconds: float = 0.0
    failures: list[str] = field(default_factory=list)

    def __call__(self, purpose: str, chains: Mapping[str, Mapping[str, Any]]) -> Results:
        """Solve named chains; None for one that failed."""
        progress = Progress(len(chains), f'chains, {purpose}')

        def count(outcome: TaskOutcome) -> None:
            progress.step(there=outcome.stored)
            self.report(purpose, outcome)
            self.chains += 1
            self.kept += outcome.stored
            self.points += len(chains[outcome.name]['speeds'])
            self.seconds += 0.0 if outcome.stored else outcome.seconds
            if outcome.result is None:
                self.failures.append(f'{purpose}, {outcome.name}: {outcome.sentence}')
                print(self.failures[-1], file=sys.stderr)

        done = run_tasks(self.pool, self.task, chains, store=self.store, report=count)
        return {
            name: None if outcome.result is None else solved_chain(outcome.result)
            for name, outcome in done.items()
        }


@dataclass(slots=True)
class Once:
    """Asks a builder's `run` for no chain twice, by whatever name; call it as that `run`."""

    run: SolveChains
    known: dict[str, SolvedChain | None] = field(default_factory=dict)

    def __call__(self, purpose: str, chains: Mapping[str, Mapping[str, Any]]) -> Results:
        """Return the results of named chains, solved now or before."""
        keys = {name: task_key('', chain) for name, chain in chains.items()}
        names = {key: name for name, key in keys.items() if key not in self.known}
        if names:
            found = self.run(purpose, {name: chains[name] for name in names.values()})
            self.known |= {key: found[name] for key, name in names.items()}
        return {name: self.known[key] for name, key in keys.items()}
