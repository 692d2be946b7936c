# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The rows of one axis, gathered into stretches and added up: interpreted or compiled."""

import dataclasses
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
    sliding_of,
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
ROOM = 256  # stretches that are handed over at a time


class Collected(NamedTuple):
    """Stretches that have ended, and bins of days that are over or were taken."""

    stretches: list[Stretch]
    bins: list[SpectrumBin]


class Collector:
    """Collects what the health of one axis rests on."""

    def __init__(self, surface: Surface, settings: GatherSettings | None = None) -> None:
        self._settings = settings or GatherSettings()
        self._memory, self._sums = GatherMemory(), SpectrumMemory()
        self._point, self._stretch = Found(), Stretch()
        self._run = Recogniser(self._settings.free_load)
        self.use_surface(surface)

    def use_surface(self, surface: Surface) -> None:
        """Look up severity in `surface` from now on."""
        self._surface = surface
        self._tables = surface.tables
        self._settings = dataclasses.replace(self._settings, sliding=sliding_of(surface))

    def take(self, row: Any) -> Collected | None:
        """Take one row of the judgement; return what has ended with it, None for nothing."""
        ended = step(self._settings, self._memory, row, self._stretch)
        counted = count(self._tables, self._settings, self._sums, row, self._point)
        if counted and not ended:
            return None
        bins = [] if counted else take_bins(self._sums)
        if not counted:
            count(self._tables, self._settings, self._sums, row, self._point)
        return Collected(self._run.take(self._taken(ended)), bins)

    def _taken(self, ended: bool) -> list[Stretch]:
        """Return the stretch if it has ended, and begin another one."""
        if not ended:
            return []
        stretch, self._stretch = self._stretch, Stretch()
        return [stretch]

    def take_many(self, rows: NDArray[Any]) -> Collected:
        """Take rows, an array of ROW, compiled; raises ImportError without numba."""
        settings, memory = as_array(self._settings), as_array(self._memory)
        room, stretches, at = np.empty(ROOM, dtype=STRETCH), list[Stretch](), 0
        while at < len(rows):
            at, number = _compiled(step_many)(settings, memory, rows, room, at, ROOM)
            stretches += [from_array(Stretch, stretch) for stretch in room[:number]]
        self._memory = from_array(GatherMemory, memory[0])
        tables = self._surface.array_tables
        point, bins, at = as_array(self._point), list[SpectrumBin](), 0
        while True:
            sums = as_array(self._sums)
            at = _compiled(count_many)(tables, settings, sums, rows, point, at)
            self._sums = from_array(SpectrumMemory, sums[0])
            if at == len(rows):
                return Collected(self._run.take(stretches), bins)
            bins += take_bins(self._sums)

    def finish(self, *, rows_end: bool = True) -> Collected:
        """
        Return what has been added up so far, to be merged with the rest of its day.

        `rows_end` ends the stretch as well.

        """
        stretches: list[Stretch] = []
        if rows_end:
            ended = finish(self._settings, self._memory, self._stretch)
            stretches = self._run.take(self._taken(ended)) + self._run.finish()
            stretches += self._taken(finish_rest(self._memory, self._stretch))
        return Collected(stretches, take_bins(self._sums))


def prepare() -> None:
    """Compile what takes many rows."""
    Collector(Surface.load(shipped_surface())).take_many(np.zeros(1, ROW))


_compiled = functools.cache(compiled)
