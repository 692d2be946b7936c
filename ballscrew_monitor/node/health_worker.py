# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Health beside the judgement: rows gathered by the thread that judges, kept by one of its own.

The first does no more than add up; the second writes the store and assesses. Whatever fails here
ends in a sentence, and the judgement goes on.

"""

from collections import deque
from collections.abc import Callable
import contextlib
import dataclasses
import queue
import sqlite3
import threading
from typing import Any

from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.assess import HealthSettings
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.collect import Collected, Collector, ROW
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.keeper import HealthKeeper
from ballscrew_monitor.health.records import Health, SpectrumBin, Stretch
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.store import HealthStore
from ballscrew_monitor.messages.health_messages import health_message
from ballscrew_msgs.msg import AxisHealth
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.surface import Surface

MOST_STRETCHES = 10_000
"""Stretches that wait to be handed over; the oldest are dropped."""
MOST_ROWS = 500  # of arrays that wait to be added up
MOST_JOBS = 64
SURFACE_DIGITS = 16
"""Digits of the hash of a surface, without its corrections, that name it."""
PATIENCE = 2.0  # [s] that the end of the node waits for the disk
FAILED = 'the program failed at'


class Gatherer:
    """Rows of one axis, added up until they are handed over; of the thread that judges alone."""

    def __init__(self, surface: Surface, settings: GatherSettings | None = None) -> None:
        """Begin with nothing; `surface` is that of the judgement."""
        self.defect = ''
        self._collector = Collector(surface, settings)
        self._stretches: deque[Stretch] = deque(maxlen=MOST_STRETCHES)
        self._bins: list[SpectrumBin] = []
        self._rows = bytearray()  # of arrays, not added up yet

    def take(self, row: Any) -> None:
        """Take a row of the judgement, None for an event that gave none."""
        if row is not None and not self.defect:
            self._gather_many()
            self._add(self._guarded(self._collector.take, row))

    def take_many(self, rows: NDArray[Any]) -> None:
        """Take rows, an array of them, which are added up some hundreds at a time, compiled."""
        if len(rows) and not self.defect:
            self._rows += rows.tobytes()
            if len(self._rows) >= MOST_ROWS * ROW.itemsize:
                self._gather_many()

    def _gather_many(self) -> None:
        if self._rows and not self.defect:
            rows, self._rows = np.frombuffer(self._rows, ROW), bytearray()
            self._add(self._guarded(self._collector.take_many, rows))

    def hand_over(self, surface: Surface, *, rows_end: bool = False) -> Collected:
        """Return what has been added up, and go on with the `surface` of now."""
        self._gather_many()
        if not self.defect:
            self._add(self._guarded(self._collector.finish, rows_end=rows_end))
            self._collector.use_surface(surface)
        collected = Collected(list(self._stretches), self._bins)
        self._stretches.clear()
        self._bins = []
        return collected

    def give_back(self, collected: Collected) -> None:
        """Let what could not be handed over wait."""
        self._stretches.extendleft(reversed(collected.stretches))
        self._bins = merged_bins([*collected.bins, *self._bins])

    def _add(self, collected: Collected | None) -> None:
        if collected is not None:
            self._stretches += collected.stretches
            self._bins += collected.bins

    def _guarded(self, call: Callable[..., Collected | None], *args: Any, **named: Any) -> Any:
        """Return what a call returns; the judgement goes on if it fails, and no more is taken."""
        try:
            return call(*args, **named)
        except Exception as error:  # noqa: BLE001 whatever it is
            self.defect = f'{FAILED} its rows: {type(error).__name__}: {error}'
            return None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Job:
    """Rows gathered of one axis until `now` [ns], to be kept and, if asked for, assessed."""

    keeper: HealthKeeper
    axis: str
    now: int
    collected: Collected
    surface: Surface
    settings: HealthSettings
    policy: WarningPolicy
    assesses: bool


class HealthWorker:
    """A thread that keeps and assesses; it begins with the first job, and holds the store."""

    def __init__(self, store: HealthStore, is_held: Callable[[], bool]) -> None:
        """Use a `store` as long as the node `is_held` to be the one that owns its folder."""
        self.store = store
        self.problem = ''
        self.damage: deque[str] = deque()  # sentences on what was set aside
        self.done: deque[tuple[Health, AxisHealth]] = deque(maxlen=MOST_JOBS)  # and its message
        self._is_held = is_held
        self._jobs: queue.Queue[Job | None] = queue.Queue(MOST_JOBS)
        self._ending = False
        self._thread = threading.Thread(target=self._run, name='health', daemon=True)
        self._thread.start()

    def put(self, job: Job) -> bool:
        """Hand a job over; return False if too many wait."""
        with contextlib.suppress(queue.Full):
            self._jobs.put_nowait(job)
            return True
        return False

    def close(self) -> None:
        """Keep what waits, and close the store; an assessment that is under way is waited for."""
        self._ending = True
        with contextlib.suppress(queue.Full):
            self._jobs.put(None, timeout=PATIENCE)
        self._thread.join(PATIENCE)

    def take_store(self) -> None:
        """Open the store, if it is not; raises InputError, sqlite3.Error and OSError."""
        with self.store.lock:
            if self.store.is_open:
                return
            if not self._is_held():
                raise InputError(f'{self.store.file.parent} is not held by this node')
            self.damage += self.store.load()

    def _run(self) -> None:
        while not (self._ending and self._jobs.empty()):
            job = self._jobs.get()
            if job is None:
                break
            try:
                today = day_of(job.now)
                job.keeper.gather(job.collected, today)
                self.take_store()
                job.keeper.keep(today)
                if job.assesses and not self._ending:
                    health = job.keeper.assess(job.now, job.surface, job.settings)
                    surface_id = job.surface.base_sha256[:SURFACE_DIGITS]
                    message = health_message(health, surface_id=surface_id, policy=job.policy)
                    self.done.append((health, message))
                self.problem = ''
            except (InputError, sqlite3.Error, OSError) as error:
                self.problem = f'{self.store.file} cannot be used, {error}'
            except Exception as error:  # noqa: BLE001 the thread must live
                self.problem = (
                    f'{FAILED} the health of {job.axis}: {type(error).__name__}: {error}'
                )
        with self.store.lock:
            self.store.close()
