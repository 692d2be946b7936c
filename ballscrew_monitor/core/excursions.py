# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Excursions of an axis out of its zone, one after the other, each with its number."""

import dataclasses

from ballscrew_monitor.core.advice import Advisor
from ballscrew_monitor.core.estimate import MachinePoint
from ballscrew_monitor.core.judgement import Hold, Level, Limits, Verdict, Zone
from ballscrew_monitor.core.state import Event
from surrogate.surface import Surface


class Excursions:
    """Follows the held level; `event` is that which is active, or the last one."""

    def __init__(self) -> None:
        """Begin without an event."""
        self.event = Event()
        self._pending: Event | None = None  # an event that is not raised yet

    def follow(self, held: Hold, verdict: Verdict, stamp: int) -> None:
        """Keep the worst value of the event that is active, or of the one that may follow."""
        if verdict.zone is Zone.OPTIMAL and held.level is not Level.WARN:
            self._pending = None
        if verdict.zone is not Zone.OUTSIDE:
            return
        if self.event.active:
            self.event = self.event.worsened(verdict.findings)
            return
        if self._pending is None or (held.raising is not None and held.raising.start == stamp):
            self._pending = Event(
                start=stamp, cause=verdict.findings[0], worst_value=verdict.findings[0].value
            )
        self._pending = self._pending.worsened(verdict.findings)

    def edge(
        self,
        before: Level,
        level: Level,
        stamp: int,
        *,
        point: MachinePoint,
        surface: Surface,
        limits: Limits,
    ) -> Event | None:
        """Return the event that the change of the level at `stamp` [ns] begins or ends, if any."""
        if level is Level.WARN and before is not Level.WARN and self._pending is not None:
            self.event = dataclasses.replace(
                self._pending,
                number=self.event.number + 1,
                active=True,
                stamp=stamp,
                advisor=Advisor(point=point, surface=surface, limits=limits),
            )
            self._pending = None
            return self.event
        return self.end(stamp) if level is not Level.WARN else None

    def end(self, stamp: int, ending: str = '') -> Event | None:
        """End the active event at `stamp` [ns]; return it, if there is one."""
        if not self.event.active:
            return None
        self.event = dataclasses.replace(self.event, active=False, stamp=stamp, ending=ending)
        return self.event

    def take_up(self, kept: Event) -> None:
        """Go on with the number of the last event that was `kept`."""
        if self.event.number:
            number = self.event.number + kept.number
            self.event = dataclasses.replace(self.event, number=number)
        else:
            self.event = kept

    def forget_pending(self) -> None:
        """Forget the samples outside that have not raised an event."""
        self._pending = None

    def move(self, shift: int) -> None:
        """Move the beginning of the active event by `shift` [ns] with the clock."""
        if self.event.active:
            self.event = dataclasses.replace(self.event, start=max(0, self.event.start + shift))
