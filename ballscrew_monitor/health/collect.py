# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The rows of one axis, gathered into stretches and added up: interpreted or compiled."""

import functools
from typing import Any, NamedTuple

from ballscrew_monitor.health.fingerprint import Recogniser
from ballscrew_monitor.health.gather import (
    finish,
    finish_rest,
    GatherMemory,
    GatherSettings,
    step,
    step_many,
)
from ballscrew_monitor.health.records import SpectrumBin, Stretch
from ballscrew_monitor.health.spectrum import (
    count,
    count_many,
    spectrum_settings,
    SpectrumMemory,
    take_bins,
)
from ballscrew_monitor.judge.records import Row
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Found, shipped_surface, Surface
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array, dtype_of, from_array

ROW, STRETCH = dtype_of(Row), dtype_of(Stretch)
ROOM = 256
"""Stretches that are handed over at a time."""


class Collected(NamedTuple):
    """Stretches that have ended, and bins of days that are over or were taken."""

    stretches: list[Stretch]
    bins: list[SpectrumBin]


class Collector:
    """Collects what the health of one axis rests on."""

    def __init__(self, surface: Surface, settings: GatherSettings | None = None) -> None:
        """Begin with nothing collected."""
        self._settings = settings or GatherSettings()
        self._memory, self._sums = GatherMemory(), SpectrumMemory()
        self._found, self._stretch = Found(), Stretch()
        self._run = Recogniser(self._settings.free_load)
        self.use_surface(surface)

    def use_surface(self, surface: Surface) -> None:
        """Look up severity in `surface` from now on."""
        self._surface = surface
        self._tables = surface.tables
        self._spectrum = spectrum_settings(surface, self._settings.max_gap)

    def take(self, row: Any) -> Collected | None:
        """Take one row of the judgement; return what has ended with it, None for nothing."""
        ended = step(self._settings, self._memory, row, self._stretch)
        counted = count(self._tables, self._spectrum, self._sums, row, self._found)
        if counted and not ended:
            return None
        bins = [] if counted else take_bins(self._sums)
        if not counted:
            count(self._tables, self._spectrum, self._sums, row, self._found)
        return Collected(self._run.take(self._taken(ended)), bins)

    def _taken(self, ended: bool) -> list[Stretch]:
        """Return the stretch if it has ended, and begin another one."""
        if not ended:
            return []
        stretch, self._stretch = self._stretch, Stretch()
        return [stretch]

    def take_many(self, rows: NDArray[Any]) -> Collected:
        """Take rows, an array of ROW, compiled."""
        return Collected(self._run.take(self._gather_many(rows)), self._count_many(rows))

    def _gather_many(self, rows: Any) -> list[Stretch]:
        settings, memory = as_array(self._settings), as_array(self._memory)
        made = np.empty(ROOM, dtype=STRETCH)
        found: list[Stretch] = []
        at = 0
        while at < len(rows):
            at, number = compiled_step()(settings, memory, rows, made, at, ROOM)
            found += [from_array(Stretch, one) for one in made[:number]]
        self._memory = from_array(GatherMemory, memory[0])
        return found

    def _count_many(self, rows: Any) -> list[SpectrumBin]:
        tables, settings = self._surface.array_tables, as_array(self._spectrum)
        found, at = as_array(self._found), 0
        bins: list[SpectrumBin] = []
        while True:
            sums = as_array(self._sums)
            at = compiled_count()(tables, settings, sums, rows, found, at)
            self._sums = from_array(SpectrumMemory, sums[0])
            if at == len(rows):
                return bins
            bins += take_bins(self._sums)

    def finish(self, *, rows_end: bool = True) -> Collected:
        """
        Return what has been added up so far, to be merged with the rest of its day.

        `rows_end` ends the stretch as well.

        """
        found: list[Stretch] = []
        if rows_end:
            ended = finish(self._settings, self._memory, self._stretch)
            found = self._run.take(self._taken(ended)) + self._run.finish()
            found += self._taken(finish_rest(self._memory, self._stretch))
        return Collected(found, take_bins(self._sums))


def prepare() -> None:
    """Compile what takes many rows."""
    Collector(Surface.load(shipped_surface())).take_many(np.empty(0, ROW))


@functools.cache
def compiled_step() -> Any:
    """Return `gather.step_many` compiled; raises ImportError without numba."""
    return compiled(step_many)


@functools.cache
def compiled_count() -> Any:
    """Return `spectrum.count_many` compiled; raises ImportError without numba."""
    return compiled(count_many)
