# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One axis through a recording: stretch by stretch, and by its monitor where a stretch stops.

The monitor is handed what it would remember at the end of each stretch, so that both ways may take
turns at any entry.

"""

from collections.abc import Iterator
import dataclasses
import functools

from ballscrew_monitor.core.advice import Advisor
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Finding, Hold, Level, Zone
from ballscrew_monitor.core.monitor import Monitor
from ballscrew_monitor.core.remembered import recall, Remembered, remind
from ballscrew_monitor.core.state import MonitorSettings, State
from ballscrew_monitor.recordings.bulk.entries import Entries, Kind
from ballscrew_monitor.recordings.bulk.estimates import Estimator, Judgements, Points
from ballscrew_monitor.recordings.bulk.events import Events, follow
from ballscrew_monitor.recordings.bulk.levels import held_levels, Levels
from ballscrew_monitor.recordings.bulk.stretch import make_stretch, points_of, Stretch
from ballscrew_monitor.recordings.bulk.sums import add_moments, add_to_window, Moments, moments
from ballscrew_monitor.recordings.columns import JudgedColumns, STANDSTILL
from ballscrew_monitor.recordings.rows import RowCollector
from ballscrew_monitor.settings.axis import Axis
import numpy as np
from numpy.typing import NDArray

AT_ONCE = 32768  # entries of a stretch at most
TURN = 256  # entries that the monitor judges when it has its turn


class AxisJudge:
    """Judges the ordered entries of one axis."""

    def __init__(self, axis: Axis, *, at_once: bool = True, turn: int = TURN) -> None:
        """
        Begin with what the monitor of `axis` remembers.

        It judges `turn` entries where a stretch stops, or all of them unless `at_once`.

        """
        settings = axis.monitor.settings
        self._monitor, self._turn = axis.monitor, turn
        # What derives a load or a speed looks back over samples, and stays with the monitor.
        derives = settings.derivation is not None or settings.positions is not None
        self._at_once = at_once and not derives
        self._estimator = Estimator(axis.surface, settings.limits)

    def states(self, entries: Entries) -> Iterator[tuple[int, State]]:
        """Judge entries; yield each state that is due and the place of the entry it is due at."""
        for begin, part in self._parts(entries):
            if isinstance(part, Judging):
                yield from ((begin + at, state) for at, state in part.states(self._monitor))
            else:
                yield from self._taken(begin, part)

    def columns(self, entries: Entries, collector: RowCollector) -> Iterator[JudgedColumns]:
        """Judge entries; yield the rows in blocks; the collector observes the monitor."""
        for begin, part in self._parts(entries):
            if isinstance(part, Judging):
                rows = part.columns()
                remind(self._monitor, part.finish())
                if len(rows):
                    collector.add(rows, part.events.edges.values(), part.last_reason)
                    yield rows
                continue
            for _ in self._taken(begin, part):
                pass
            if len(collector):
                yield collector.block()

    def both(
        self, entries: Entries, collector: RowCollector
    ) -> Iterator[JudgedColumns | tuple[int, State]]:
        """Judge entries; yield what `columns` yields and what `states` does."""
        for begin, part in self._parts(entries):
            if isinstance(part, Judging):
                rows = part.columns()
                yield from ((begin + at, state) for at, state in part.states(self._monitor))
                if len(rows):
                    collector.add(rows, part.events.edges.values(), part.last_reason)
                    yield rows
                continue
            yield from self._taken(begin, part)
            if len(collector):
                yield collector.block()

    def _parts(self, entries: Entries) -> Iterator['tuple[int, Judging | Entries]']:
        """Yield stretches, and entries for the monitor, each after the one before is judged."""
        at = 0
        while at < len(entries):
            part = entries.take(slice(at, at + AT_ONCE))
            stop = 0
            if self._at_once:
                settings, memory = self._monitor.settings, recall(self._monitor)
                stretch = make_stretch(settings, memory, part)
                stop = stretch.stop
                yield at, Judging(settings, memory, stretch, self._estimator)
            if stop < len(part):
                begin, stop = stop, stop + self._turn if self._at_once else len(part)
                yield at + begin, part.take(slice(begin, stop))
            at += min(stop, len(part))

    def _taken(self, begin: int, part: Entries) -> Iterator[tuple[int, State]]:
        """Let the monitor judge entries; yield the states that are due, and their places."""
        for at in range(len(part)):
            due = self._take(part, at)
            if due is not None:
                yield begin + at, due

    def _take(self, entries: Entries, at: int) -> State | None:
        """Let the monitor judge an entry."""
        if entries.kind[at] == Kind.TICK:
            return self._monitor.tick(int(entries.stamp[at]))
        return self._monitor.update(entries.event(at))


class Judging:
    """All that is made of one stretch."""

    def __init__(
        self, settings: MonitorSettings, memory: Remembered, stretch: Stretch, estimator: Estimator
    ) -> None:
        """Judge the rows of the stretch; the memory is not changed yet."""
        self._settings, self._memory = settings, memory
        self._stretch, self._estimator = stretch, estimator
        self._rows = stretch.rows
        self._row = self._place = 0  # up to which inputs and sums have been told

    @functools.cached_property
    def _max_gap(self) -> int:
        return self._memory.inputs[Source.SPEED].timeout

    @functools.cached_property
    def points(self) -> Points:
        """Return the operating points."""
        return points_of(self._settings, self._memory, self._stretch)

    @functools.cached_property
    def judged(self) -> Judgements:
        """Return what the model says of the points."""
        return self._estimator(self.points)

    @functools.cached_property
    def levels(self) -> Levels:
        """Return the held levels."""
        rows = self._rows
        return held_levels(
            rows.stamp,
            self.judged.sign,
            rows.period,
            self._memory.hold,
            self._settings.limits,
            max_gap=self._max_gap,
        )

    @functools.cached_property
    def events(self) -> Events:
        """Return the events."""
        return follow(
            self._memory,
            self._rows.stamp,
            self.judged,
            self.levels,
            advisor_at=self._advisor_at,
            finding_at=self._finding_at,
        )

    @property
    def last_reason(self) -> str:
        """Return why there is no answer at the last row, empty if there is one."""
        return self._estimator.single(self.points.point(-1))[0].reason

    @functools.cached_property
    def published(self) -> NDArray[np.bool_]:
        """Tell of which rows a state is due: the first in a period, and changes of the level."""
        stamp, period = self._rows.stamp, self._settings.publish_period
        due = np.ones(len(stamp), dtype=bool)
        if period:
            part = stamp // period
            due[1:] = part[1:] != part[:-1]
            if len(due) and self._memory.last_published is not None:
                due[0] = part[0] != self._memory.last_published // period
        due[[row for row, _ in self.levels.changes]] = True
        return due

    def columns(self) -> JudgedColumns:
        """Return the rows."""
        rows, names = self._rows, {field.name for field in dataclasses.fields(JudgedColumns)}
        parts = {
            name: getattr(source, name)
            for source in (self.points, self.judged)
            for name in source.__slots__
            if name in names
        }
        return JudgedColumns(
            axis=self._settings.axis,
            stamp=rows.stamp,
            log_time=rows.now,
            level=self.levels.level,
            event_id=self.events.number,
            tick=rows.tick,
            published=self.published,
            axial_load_uncertainty=np.full(len(rows.at), np.nan),
            **parts,
        )

    def finish(self) -> Remembered:
        """Return the memory after the stretch; its inputs and sums change themselves."""
        published = np.flatnonzero(self.published)
        if len(published):
            last = int(published[-1])
            self._pass(last + 1, window=last)  # it begins anew there, whatever came before
            self._memory.window.take()
        return self._end()

    def states(self, monitor: Monitor) -> Iterator[tuple[int, State]]:
        """Yield the states and the places of their entries; the monitor remembers in the end."""
        since, level = self._memory.hold.since, self._memory.hold.level
        for row in np.flatnonzero(self.published).tolist():
            self._pass(row + 1)
            if self.levels.level[row] != level:
                level, since = Level(int(self.levels.level[row])), int(self._rows.stamp[row])
            remind(monitor, self._memory_at(row, Hold(level=level, since=since)))
            point = self.points.point(row)
            yield (
                int(self._rows.at[row]),
                monitor.state(
                    int(self._rows.stamp[row]),
                    int(self._rows.now[row]),
                    point,
                    *self._estimator.single(point),
                    edge=self.events.edges.get(row),
                ),
            )
        remind(monitor, self._end())

    def _memory_at(self, row: int, held: Hold) -> Remembered:
        """Return of the memory at a row what a state tells."""
        event = dataclasses.replace(self._memory.event, number=int(self.events.number[row]))
        judged = self._memory.judged + int(self._counts[row])
        return dataclasses.replace(self._memory, event=event, judged=judged, hold=held)

    def _end(self) -> Remembered:
        """Return the memory after all rows."""
        events, rows, memory = self.events, self._rows, self._memory
        ticks = self._stretch.entries.stamp[self._stretch.ticks]
        published = rows.stamp[self.published]
        self._pass(len(rows.at), self._stretch.stop)
        return dataclasses.replace(
            memory,
            event=events.event,
            pending=events.pending,
            judged=memory.judged + int(self._counts[-1] if len(rows.at) else 0),
            hold=self.levels.memory,
            direction=self._last_direction(),
            last_tick=int(ticks[-1]) if len(ticks) else memory.last_tick,
            stamp=int(rows.stamp[-1]) if len(rows.at) else memory.stamp,
            last_published=int(published[-1]) if len(published) else memory.last_published,
        )

    def _pass(self, row: int, place: int | None = None, *, window: int = 0) -> None:
        """
        Let inputs and sums take what comes before a row, and before a place of the entries.

        The window takes rows from `window` on.

        """
        rows, memory = slice(self._row, row), self._memory
        end = int(self._rows.at[row - 1]) + 1 if place is None else place
        add_moments(memory.account, self._moments.part(rows), self._max_gap)
        rest = slice(max(self._row, window), row)
        add_to_window(memory.window, self.points, self.judged, rest)
        for lane in self._stretch.lanes.values():
            lane.part(self._place, end).tell()
        self._row, self._place = row, end

    @functools.cached_property
    def _moments(self) -> Moments:
        return moments(self._rows, self.points, self.judged)

    @functools.cached_property
    def _counts(self) -> NDArray[np.int64]:
        """Return how many samples count as judged up to each row."""
        gated = self.judged.gates & STANDSTILL != 0
        judged = ((self.judged.zone != Zone.UNKNOWN) | gated) & ~self._rows.tick
        return np.cumsum(judged)

    def _last_direction(self) -> Direction:
        direction = self.points.direction
        return Direction(int(direction[-1])) if len(direction) else self._memory.direction

    def _advisor_at(self, row: int) -> Advisor:
        return Advisor(
            point=self.points.point(row),
            surface=self._estimator.surface,
            limits=self._settings.limits,
        )

    def _finding_at(self, row: int) -> Finding:
        _, verdict = self._estimator.single(self.points.point(row))
        return verdict.findings[0]
