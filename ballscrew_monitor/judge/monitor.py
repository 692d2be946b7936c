# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One axis, judged event by event: the step, its memory, and the words beside it.

Samples and refusals become records here. Names of joints, sentences and advice stay out of the
step; they are kept here.

"""

from collections import deque
from collections.abc import Callable, Iterable
import dataclasses
import math
import operator
from typing import Any

from ballscrew_monitor.core.advice import advised_speed, interpreted, Nearest
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, InputStatus, Refusal, Source
from ballscrew_monitor.core.judgement import Code, Level
from ballscrew_monitor.core.state import (
    CLEARED,
    Ending,
    MonitorSettings,
    NAMELESS,
    NOT_ENDED,
    NOT_SHELVED,
    Shelving,
)
from ballscrew_monitor.judge import views
from ballscrew_monitor.judge.kept import AxisRecord, EXCURSION, SUMS
from ballscrew_monitor.judge.point import set_answer, set_point
from ballscrew_monitor.judge.records import (
    Event,
    Memory,
    NOT_KNOWN,
    REFUSAL,
    Row,
    SAMPLE,
    Settings,
    STEP,
    TICK,
)
from ballscrew_monitor.judge.slopes import SlopeRing
from ballscrew_monitor.judge.step import NOTHING, STATE, step
from ballscrew_monitor.judge.zone import ACTIVE, end_excursion
from surrogate.surface import Surface

MOST_USUAL = 100  # events that are known to be usual
EARLIEST, LATEST = -(2**61), 2**61
"""Stamps that are judged [ns]; stamps beyond count as these."""
MOST_OTHERS = 16
"""Kinds of messages about other joints that are told apart."""


def settings_record(settings: MonitorSettings) -> Settings:
    """Return settings as numbers."""
    limits, numbers = settings.limits, Settings()
    for name in ('rcs', 'efficiency', 'light_load', 'standstill_speed', 'hysteresis'):
        setattr(numbers, name, float(getattr(limits, name)))
    numbers.raise_delay, numbers.clear_delay = limits.raise_delay, limits.clear_delay
    numbers.default_temperature = float(settings.default_temperature)
    for name in ('publish_period', 'max_future', 'max_lag', 'tick_period'):
        setattr(numbers, name, getattr(settings, name))
    for source, timeout in settings.timeouts.items():
        numbers.configured[source], numbers.timeout[source] = 1, timeout
    for source, most in settings.plausible.items():
        numbers.plausible[source] = float(most)
    if settings.derivation is not None:
        numbers.derives, numbers.acceleration_window = True, settings.derivation.window
        for name in ('inertia', 'torque_uncertainty', 'parts_uncertainty', 'largest_share'):
            setattr(numbers, name, float(getattr(settings.derivation, name)))
    if settings.position_window:
        numbers.positions, numbers.position_window = True, settings.position_window
        numbers.wrap = float(settings.wrap)
    return numbers


def within(stamp: int) -> int:
    """Return a stamp [ns] so that differences of stamps fit into 64 bits."""
    return min(max(stamp, EARLIEST), LATEST)


def fill(record: Event, event: InputSample | Refusal) -> None:
    """Fill a record with a sample or a refusal."""
    record.source, record.arrival = int(event.source), within(event.arrival)
    record.lost = NOT_KNOWN if event.lost is None else event.lost
    if isinstance(event, Refusal):
        record.kind, record.why = REFUSAL, int(event.why)
        record.first, record.second = event.first, event.second
        record.stamp = record.arrival
        return
    record.kind, record.value = SAMPLE, float(event.value)
    record.stamp, record.stamp_source = within(event.stamp), int(event.stamp_source)


class JointNames:
    """The joints that messages about others name, since the last good sample of each input."""

    def __init__(self) -> None:
        self.named: dict[Source, dict[OtherJoints, None]] = {source: {} for source in Source}

    def hear(self, refusal: Refusal, memory: Any) -> None:
        """Keep the joints of a refusal that the memory has not taken yet."""
        if refusal.joints is not None:
            heard = self.named[refusal.source]
            if not memory.others[refusal.source]:  # a good sample has come since
                heard.clear()
            if len(heard) < MOST_OTHERS:
                heard[refusal.joints] = None

    def hear_many(self, source: Source, joints: Iterable[OtherJoints], *, all_since: bool) -> None:
        """Keep the joints of several refusals; `all_since`: all since the last good sample."""
        heard = self.named[source]
        if all_since:
            heard.clear()
        for others in joints:
            if len(heard) < MOST_OTHERS:
                heard[others] = None

    def of(self, source: Source) -> OtherJoints | None:
        """Return the joints of all messages about others, of however many publishers."""
        heard = self.named[source]
        if not heard:
            return None
        names = sorted({name for others in heard for name in others.names})
        return dataclasses.replace(next(iter(heard)), names=tuple(names))


class Monitor:
    """Judges one axis; feed it events in order."""

    def __init__(self, surface: Surface, settings: MonitorSettings) -> None:
        self.settings = settings
        self.use_surface(surface)
        self._memory: Any = Memory()
        self._speeds, self._positions = SlopeRing(), SlopeRing()
        self._fetch: Callable[[], None] | None = None
        self.usual: deque[int] = deque(maxlen=MOST_USUAL)  # numbers of events: the health tells
        self.shelve_reason = ''
        self._ending = NOT_ENDED
        self.joints = JointNames()
        self.nearest: Nearest = interpreted
        self._event = Event()
        self._row = Row()
        self.row: Row | None = None  # of the last event, until the next; None if it gave none
        self._advised_at: tuple[Any, ...] = ()  # the point of the last advice
        self._advised_speed = math.nan
        self.moved = 0  # by how much the last step has moved the begin of an excursion [ns]

    @property
    def memory(self) -> Any:
        """Return what is remembered but for slopes."""
        self._have_back()
        return self._memory

    @memory.setter
    def memory(self, memory: Any) -> None:
        self._have_back()
        self._memory = memory

    @property
    def speeds(self) -> SlopeRing:
        """Return the speeds of which the slope is the acceleration."""
        self._have_back()
        return self._speeds

    @speeds.setter
    def speeds(self, speeds: SlopeRing) -> None:
        self._have_back()
        self._speeds = speeds

    @property
    def positions(self) -> SlopeRing:
        """Return the positions of which the slope is the speed."""
        self._have_back()
        return self._positions

    @positions.setter
    def positions(self, positions: SlopeRing) -> None:
        self._have_back()
        self._positions = positions

    def lend(self, fetch: Callable[[], None]) -> None:
        """Let others remember, until memory or slopes are asked for: `fetch` sets them then."""
        self._fetch = fetch

    def is_lent(self, fetch: Callable[[], None]) -> bool:
        """Return True if the one who would `fetch` is who remembers."""
        return self._fetch == fetch

    def show(self, memory: Memory) -> None:
        """Remember what was remembered after a row, until it is lent again."""
        self._fetch, self._memory = None, memory

    def _have_back(self) -> None:
        if self._fetch is not None:
            fetch, self._fetch = self._fetch, None
            fetch()

    @property
    def settings(self) -> MonitorSettings:
        """Return limits and parameters in force."""
        return self._settings

    @settings.setter
    def settings(self, settings: MonitorSettings) -> None:
        self._settings = settings
        self.numbers = settings_record(settings)

    def use_surface(self, surface: Surface) -> None:
        """Judge with `surface` from now on."""
        self.surface = surface
        self._tables = surface.tables

    def update(self, event: InputSample | Refusal) -> Row | None:
        """Take one sample or refusal; return its row if a state is due."""
        if isinstance(event, Refusal):
            self.joints.hear(event, self.memory)
        fill(self._event, event)
        return self._step()

    def tick(self, now: int) -> Row | None:
        """Return the row of a state at the grid stamp `now` [ns] if no speed is fresh."""
        self._event.kind, self._event.stamp = TICK, within(now)
        return self._step()

    def set_clock(self, due: int, now: int) -> None:
        """Take that the clock of the node was set: it shows `now` and was to show `due` [ns]."""
        self._event.kind, self._event.stamp, self._event.arrival = STEP, within(due), within(now)
        self._step()

    def _step(self) -> Row | None:
        memory, slopes = self.memory, (self._speeds, self._positions)
        number, start = memory.event_number, memory.event_start[ACTIVE]
        # Of a step of the node's clock its own event tells.
        leaps = memory.event_active and self._event.kind != STEP and not memory.clock_step
        outcome = step(self._tables, self.numbers, memory, *slopes, self._event, self._row)
        if memory.event_number != number:
            self.ending = NOT_ENDED
        self.moved = memory.event_start[ACTIVE] - start if leaps else 0
        self.row = None if outcome == NOTHING else self._row
        if outcome != STATE:
            return None
        row, self._row = self._row, Row()
        return row

    @property
    def level(self) -> Level:
        """Return the held level."""
        return Level(int(self.memory.level))

    @property
    def event_code(self) -> Code:
        """Return the criterion by which the last event was raised."""
        return Code(int(self.memory.event_code[ACTIVE]))

    @property
    def ending(self) -> Ending:
        """Return how the last event ended; by the axis unless the node has ended it."""
        memory = self.memory
        over = memory.event_number and not memory.event_active
        return CLEARED if over and not self._ending.kind else self._ending

    @ending.setter
    def ending(self, ending: Ending) -> None:
        self._ending = ending

    @property
    def target_speed(self) -> float:
        """
        Return the nearest speed [rad/s] that would clear the last event, NaN if none is advised.

        The first time takes milliseconds.

        """
        memory = self.memory
        speed, load = float(memory.event_speed[ACTIVE]), float(memory.event_load[ACTIVE])
        temperature = float(memory.event_temperature[ACTIVE])
        allowed, limits = self._settings.speed_allowed, self._settings.limits
        if not (allowed and math.isfinite(speed + load + temperature)):
            return math.nan
        direction = Direction(int(memory.event_direction[ACTIVE]))
        point = speed, load, temperature, direction, self.surface, limits
        if point != self._advised_at:
            self._advised_at = point
            self._advised_speed = advised_speed(
                self.surface,
                limits,
                speed=speed,
                axial_load=load,
                temperature=temperature,
                direction=direction,
                nearest=self.nearest,
            )
        return self._advised_speed

    @property
    def shelving(self) -> Shelving:
        """Return until when the warning is shelved, and why."""
        until = int(self.memory.shelved_until)
        return Shelving(until=until, reason=self.shelve_reason) if until else NOT_SHELVED

    @shelving.setter
    def shelving(self, shelving: Shelving) -> None:
        self.memory.shelved_until = shelving.until
        self.shelve_reason = shelving.reason

    def kept(self, now: int) -> AxisRecord:
        """Return what is to be kept over a restart at `now` [ns] of the clock of the node."""
        beside = self.ending, self.shelving, within(now), self.usual
        return AxisRecord.of(self._settings.axis, self.memory, *beside)

    def take_up(self, kept: AxisRecord, now: int) -> None:
        """
        Go on with what was kept, at `now` [ns] of the clock of the node.

        What has been added up meanwhile counts too. A shelving goes on with the time that was
        left of it, and waits for a clock that stands at zero.

        """
        memory, before = self.memory, kept.read_memory()
        for name in SUMS:
            since, past = getattr(memory, name), getattr(before, name)
            total = [*map(operator.add, since, past)] if isinstance(past, list) else since + past
            setattr(memory, name, total)
        memory.since = before.since or memory.since
        if not memory.event_number:
            memory.event_active, memory.event_stamp = before.event_active, before.event_stamp
            for name in EXCURSION:
                getattr(memory, name)[ACTIVE] = getattr(before, name)[ACTIVE]
            self.ending = kept.read_ending()
        numbers = [*kept.read_usual(), *(before.event_number + each for each in self.usual)]
        self.usual = deque(numbers, maxlen=MOST_USUAL)
        memory.event_number += before.event_number
        if not memory.shelved_until:
            left = Shelving(until=-kept.left_ns, reason=kept.reason)
            self.shelving = left.started(within(now))

    def acknowledge(self, now: int, ending: Ending = NAMELESS) -> bool:
        """
        Set the level back to UNKNOWN; return True if this ends an event.

        Stamps may run ahead of the clock, and events follow the stamps: it ends with the last one
        at the earliest. What is still outside is raised again as a new event.

        """
        memory = self.memory
        stamp = within(now)
        if memory.known[Source.SPEED]:
            stamp = max(stamp, memory.sample_stamp[Source.SPEED])
        memory.level, memory.level_since = int(Level.UNKNOWN), stamp
        memory.raising = memory.clearing = memory.pending = False
        over = end_excursion(memory, max(stamp, memory.event_start[ACTIVE]))
        if over:
            self.ending = ending
        return over

    def row_at(self, now: int) -> Row:
        """Return the operating point at `now` [ns] and what the surface says of it."""
        row = Row(now=within(now))
        memory = dataclasses.replace(self.memory)
        set_point(self._tables, self.numbers, memory, self.speeds, row)
        set_answer(self._tables, self.numbers, row)
        return row

    def reset_totals(self) -> None:
        """Set the totals to zero."""
        views.clear_totals(self.memory)

    def input_status(self, now: int) -> tuple[InputStatus, ...]:
        """Return how well the inputs do at `now` [ns]."""
        memory, numbers, fields = self.memory, self.numbers, self._settings.fields
        return tuple(
            views.input_status_of(
                memory, numbers, source, now, fields.get(source, ''), self.joints.of(source)
            )
            for source in views.SOURCES
        )
