# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health of one axis out of a store: what is gathered goes in, and is assessed with all before."""

import dataclasses
from typing import Any

from ballscrew_monitor.health.assess import assess, HealthSettings
from ballscrew_monitor.health.baseline import named
from ballscrew_monitor.health.collect import Collected
from ballscrew_monitor.health.life import HOUR
from ballscrew_monitor.health.records import Baseline, Cell, Health, SpectrumBin
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.store import HealthStore
from ballscrew_monitor.health.summary import add, clock_objection
from surrogate.files import InputError
from surrogate.surface import Surface

MOST_NOTES = 5  # different sentences on what did not count that are given, the last ones
LONGEST_RUNNING_IN = 1000.0 * HOUR


class HealthKeeper:
    """
    Keeps and assesses the health of one axis; a thread may name a baseline beside that.

    The `store` is opened by others. What cannot be written waits, day by day.

    """

    def __init__(self, axis: str, store: HealthStore) -> None:
        self._axis, self._store = axis, store
        self._cells: dict[Any, Cell] = {}
        self._bins: list[SpectrumBin] = []
        self._notes: dict[str, None] = {}
        self._aged: int | None = None

    def gather(self, collected: Collected, today: int) -> None:
        """Take what has ended; motion of another day than `today`, since 1970, does not count."""
        for stretch in collected.stretches:
            self._note(add(self._cells, stretch, today=today))
        for part in collected.bins:
            objection = clock_objection(part.first_day, today)
            self._note(objection)
            self._bins += [] if objection else [part]
        self._bins = merged_bins(self._bins)

    def keep(self, today: int) -> None:
        """Write what waits; raises InputError and sqlite3.Error, and it goes on waiting."""
        with self._store.lock:
            if self._cells or self._bins:
                self._store.add(self._axis, self._cells.values(), self._bins)
                self._cells, self._bins = {}, []
            if self._aged != today:
                for note in self._store.age(self._axis, today):
                    self._note(note)
                self._aged = today

    def assess(self, now: int, surface: Surface, settings: HealthSettings) -> Health:
        """Return the health at `now` [ns] by all that is kept."""
        with self._store.lock:
            kept = self._store.read(self._axis)
        notes = (*kept.notes, *self._notes)
        self._notes.clear()
        health = assess(self._axis, kept, surface, settings, now=now)
        return dataclasses.replace(health, notes=(*health.notes, *notes))

    def name_baseline(
        self, now: int, *, begin: int, end: int, running_in: float, reason: str, screw: str
    ) -> str:
        """
        Name a baseline at `now` [ns]; return what was done. Raises InputError.

        It is that of the logs from `begin` to `end` [ns]; without both it is learned from now on,
        after a motion of `running_in` [s].

        """
        if not reason.strip():
            raise InputError('the reason of a baseline is empty, it must say what was changed')
        if not 0.0 <= running_in <= LONGEST_RUNNING_IN:
            raise InputError(
                f'running_in is {running_in:g} s, allowed is 0 to {LONGEST_RUNNING_IN:g} s'
            )
        named_at: dict[str, Any] = {'reason': reason, 'named_at': now, 'screw': screw}
        with self._store.lock:
            if begin or end:
                kept = self._store.read(self._axis)
                baseline = named(kept.cells, begin, end, **named_at)
            else:
                baseline = Baseline(begin=now, end=0, left_out=running_in, **named_at)
            self._store.keep_baseline(self._axis, baseline)
        return 'named the baseline' if end else 'the baseline is learned from now on'

    def _note(self, sentence: str) -> None:
        if sentence:
            self._notes.pop(sentence, None)
            self._notes[sentence] = None
            if len(self._notes) > MOST_NOTES:
                del self._notes[next(iter(self._notes))]
