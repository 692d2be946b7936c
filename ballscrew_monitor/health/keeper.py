# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health of one axis out of a store: what is gathered goes in, and is assessed with all before."""

import dataclasses
from typing import Any

from ballscrew_monitor.health.assess import assess, HealthSettings
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import HOUR, in_force, motion_by_day, named
from ballscrew_monitor.health.collect import Collected
from ballscrew_monitor.health.companions import Companions
from ballscrew_monitor.health.points import add, clock_objection
from ballscrew_monitor.health.records import (
    Baseline,
    ComparablePoint,
    Health,
    KeptHealth,
    SpectrumBin,
)
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.store import HealthStore
from surrogate.files import InputError
from surrogate.surface import Surface

MOST_NOTES = 5
"""Different sentences on what did not count that are told, the last ones."""
LONGEST_RUNNING_IN = 1000.0 * HOUR


class HealthKeeper:
    """
    Keeps and assesses the health of one axis; a thread may name a baseline beside that.

    What cannot be written waits, day by day.

    """

    def __init__(self, axis: str, store: HealthStore) -> None:
        """Use a `store` that others open."""
        self._axis, self._store = axis, store
        self._points: dict[Any, ComparablePoint] = {}
        self._bins: list[SpectrumBin] = []
        self._notes: dict[str, None] = {}
        self._aged: int | None = None

    def gather(self, found: Collected, surface: Surface, today: int) -> None:
        """Take what has ended; what is not of `today`, in days since 1970, does not count."""
        for stretch in found.stretches:
            self._note(add(self._points, stretch, surface, today))
        for one in found.bins:
            why = clock_objection(one.first_day, today)
            self._note(why)
            self._bins += [] if why else [one]
        self._bins = merged_bins(self._bins)

    def keep(self, today: int) -> None:
        """Write what waits; raises InputError and sqlite3.Error, and it goes on waiting."""
        with self._store.lock:
            if self._points or self._bins:
                self._store.add(self._axis, self._points.values(), self._bins)
                self._points, self._bins = {}, []
            if self._aged != today:
                for said in self._store.age(self._axis, today):
                    self._note(said)
                self._aged = today

    def assess(
        self,
        now: int,
        surface: Surface,
        companions: Companions | str,
        settings: HealthSettings,
        *,
        over: float,
    ) -> Health:
        """
        Return the health at `now` [ns] by all that is kept.

        A baseline that is still to be learned, over a motion of `over` [s], is kept once it is.

        """
        with self._store.lock:
            kept = self._store.read(self._axis)
            baseline = in_force(kept, over=over, today=day_of(now), screw=surface.screw_name)
            if isinstance(baseline, Baseline) and baseline is not kept.baseline:
                self._store.keep_baseline(self._axis, baseline)
        notes = (*kept.notes, *self._notes)
        self._notes.clear()
        health = assess_kept(self._axis, now, kept, baseline, surface, companions, settings)
        return dataclasses.replace(health, notes=(*health.notes, *notes))

    def name_baseline(
        self, now: int, *, begin: int, end: int, running_in: float, reason: str, screw: str
    ) -> str:
        """
        Name a baseline at `now` [ns]; return what was done. Raises InputError.

        It is that of the days from `begin` to `end` [ns]; without both it is learned from now on,
        after a motion of `running_in` [s].

        """
        if not reason.strip():
            raise InputError('the reason of a baseline is empty, it must say what was changed')
        if not 0.0 <= running_in <= LONGEST_RUNNING_IN:
            raise InputError(
                f'running_in is {running_in:g} s, allowed is 0 to {LONGEST_RUNNING_IN:g} s'
            )
        made: dict[str, Any] = {'reason': reason, 'named_at': now, 'screw': screw}
        with self._store.lock:
            if begin or end:
                kept = self._store.read(self._axis)
                motion = motion_by_day(kept.spectrum)
                baseline = named(kept.points, begin, end, motion=motion, **made)
            else:
                baseline = Baseline(begin=now, end=0, left_out=running_in, **made)
            self._store.keep_baseline(self._axis, baseline)
        return 'named the baseline' if end else 'the baseline is learned from now on'

    def _note(self, said: str) -> None:
        if said:
            self._notes.pop(said, None)
            self._notes[said] = None
            if len(self._notes) > MOST_NOTES:
                del self._notes[next(iter(self._notes))]


def assess_kept(
    axis: str,
    now: int,
    kept: KeptHealth,
    baseline: Baseline | str,
    surface: Surface,
    companions: Companions | str,
    settings: HealthSettings,
) -> Health:
    """Return the health of an axis at `now` [ns] by what is kept of it until then."""
    today = day_of(now)
    points = [one for one in kept.points if one.first_day <= today]
    spectrum = [one for one in kept.spectrum if one.first_day <= today]
    return assess(axis, now, baseline, points, spectrum, surface, companions, settings)
