# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The only state of the online half: one axis, from an ordered list of events to its states.

Events are samples, refusals and ticks. A speed sample is judged when it arrives, with the last
sample of every other input: no delay is added. Ticks lie on a fixed grid of stamps and give a
state only while the speed is missing or stale. There is no clock in here, so the same list of
events gives the same list of states, bit for bit.

"""

from collections.abc import Callable
import dataclasses
import math

from ballscrew_monitor.core.conversions import nanoseconds, SECOND
from ballscrew_monitor.core.differentiation import SpeedFromPosition
from ballscrew_monitor.core.estimate import (
    estimate,
    MachinePoint,
    PointEstimate,
    PointSource,
    PointValidity,
)
from ballscrew_monitor.core.excursions import Excursions
from ballscrew_monitor.core.input_status import InputStatus, Tracker
from ballscrew_monitor.core.inputs import implausible, InputSample, Refusal, Source, Why
from ballscrew_monitor.core.judgement import Hold, hold, is_judged, judge, Level, Verdict
from ballscrew_monitor.core.memory import Memory, NOTHING
from ballscrew_monitor.core.point_reader import PointReader
from ballscrew_monitor.core.shelving import NOT_SHELVED
from ballscrew_monitor.core.state import Event, Instant, MonitorSettings, State
from ballscrew_monitor.core.tally import Account, moment, Totals, WindowTally
from surrogate.surface import Surface

NAN = math.nan
SHOWN = (Source.SPEED, Source.LOAD, Source.TEMPERATURE, Source.TORQUE)  # in a state
_NO_POINT = (PointValidity.NO_INPUT, PointValidity.UNKNOWN)
BACKWARD_JUMP = SECOND  # [ns] a longer step back of one input is a clock that was set back


class Monitor:
    """Judges one axis; feed it events in order."""

    def __init__(
        self, surface: Surface, settings: MonitorSettings, memory: Memory = NOTHING
    ) -> None:
        """Begin with nothing received, the level UNKNOWN, and what `memory` holds from before."""
        self.settings = settings
        self.observer: Callable[[Instant], None] | None = None  # told of every judgement
        self.use_surface(surface)
        self.shelving = NOT_SHELVED
        self._judged = 0
        self._hold = Hold()
        self._stays = Excursions()
        self._stamp = 0  # of the last verdict
        self._last_tick = 0
        self._last_published: int | None = None
        self._window = WindowTally()
        self._account = Account()
        self._inputs = {
            source: Tracker(
                source,
                configured=source in settings.timeouts,
                timeout=settings.timeouts.get(source, 0),
                max_lag=settings.max_lag,
                derived=source is Source.LOAD and settings.derivation is not None,
            )
            for source in SHOWN
        }
        self._reader = PointReader(settings)
        self._positions: SpeedFromPosition | None = None
        if settings.positions is not None:
            timeout = settings.timeouts[Source.SPEED]
            self._positions = SpeedFromPosition(settings.positions, max_gap=timeout)
        self.take_up(memory)

    @property
    def level(self) -> Level:
        """Return the held level."""
        return self._hold.level

    @property
    def event(self) -> Event:
        """Return the event that is active, or the last one."""
        return self._stays.event

    @property
    def memory(self) -> Memory:
        """Return what is to be kept over a restart."""
        event = self.event
        if event.active:
            event = dataclasses.replace(event, stamp=self._stamp)
        return Memory(totals=self._account.totals(), event=event, shelving=self.shelving)

    def take_up(self, memory: Memory) -> None:
        """Go on with what was kept; what has been added up meanwhile counts too."""
        self._account.take_up(memory.totals)
        self._stays.take_up(memory.event)
        if not self.shelving.until:
            self.shelving = memory.shelving

    def update(self, event: InputSample | Refusal) -> State | None:
        """Take one sample or refusal; return the state when one is due."""
        tracker = self._inputs[event.source]
        tracker.lose(event.lost, event.arrival)
        if isinstance(event, Refusal):
            if event.why is Why.OTHER_JOINTS:
                tracker.drop(event.joints)
            else:
                tracker.refuse(event)
            return None
        objection = self._objection(event)
        if objection is not None:
            tracker.refuse(objection)
            return None
        if tracker.last is not None and event.stamp < tracker.last.stamp:
            if tracker.last.stamp - event.stamp <= BACKWARD_JUMP:
                tracker.drop()  # out of order
                return None
            if event.source is Source.SPEED:
                self._jump_back(event.stamp)
            tracker.forget()
        sample = self._speed_of(event) if event.source is Source.SPEED else event
        if not isinstance(sample, InputSample):
            tracker.drop() if sample is None else tracker.refuse(sample)
            return None
        tracker.accept(sample)
        return self._judge_speed(sample) if sample.source is Source.SPEED else None

    def tick(self, now: int) -> State | None:
        """Return a state at the grid stamp `now` [ns] if the speed is missing or stale."""
        tracker = self._inputs[Source.SPEED]
        # Both the clock and the speed: stamps may run ahead of the clock, as far as is allowed.
        if self._last_tick - now > BACKWARD_JUMP and tracker.is_ahead(now + BACKWARD_JUMP):
            self._jump_back(now)
        if self._last_tick - now > BACKWARD_JUMP:
            for each in self._inputs.values():
                each.rebase(now)
        self._last_tick = now
        self._forget_the_future(now)
        if tracker.last is not None and now - tracker.last.arrival <= tracker.timeout:
            return None
        point = self._point(now)
        result = self._estimate(point)
        verdict = judge(point, result, self.settings.limits)
        # On the time line of the stamps, which a tick must not leave.
        stamp = now - nanoseconds(tracker.lag) if tracker.lagging else now
        return self._advance(stamp, now, point, result, verdict, tick=True)

    def use_surface(self, surface: Surface) -> None:
        """Judge with `surface` from now on."""
        self.surface = surface
        self._surface_id = surface.sha256[:16]

    def acknowledge(self, now: int, ending: str = '') -> Event | None:
        """
        Set the level back to UNKNOWN; return the event that this ends, if any.

        Stamps may run ahead of the clock, and events follow the stamps: it ends with the last one
        at the earliest. What is still outside is raised again as a new event.

        """
        last = self._inputs[Source.SPEED].last
        stamp = now if last is None else max(now, last.stamp)
        self._hold = Hold(since=stamp)
        self._stays.forget_pending()
        return self._stays.end(max(stamp, self.event.start), ending)

    def current_point(self, now: int) -> MachinePoint | str:
        """Return the operating point at `now` [ns], or in a sentence why it is not known."""
        point = self._point(now)
        result = self._estimate(point)
        if math.isnan(point.axial_load) or result.validity in _NO_POINT:
            return result.reason
        if abs(point.speed) < self.settings.limits.standstill_speed:
            return 'the screw stands still'
        return point

    @property
    def judged(self) -> int:
        """Return the number of speed samples that could be judged."""
        return self._judged

    @property
    def totals(self) -> Totals:
        """Return the totals."""
        return self._account.totals()

    def input_status(self, now: int) -> tuple[InputStatus, ...]:
        """Return the status of the inputs at `now` [ns]."""
        return tuple(tracker.status(now) for tracker in self._inputs.values())

    @property
    def refused(self) -> dict[Source, dict[Why, int]]:
        """Return how many messages of each input were refused, by why."""
        return {source: dict(tracker.refused) for source, tracker in self._inputs.items()}

    def state(
        self,
        stamp: int,
        now: int,
        point: MachinePoint,
        result: PointEstimate,
        verdict: Verdict,
        *,
        edge: Event | None = None,
    ) -> State:
        """
        Return the state at `stamp` [ns], `now` [ns] being the clock of the arrivals.

        The window begins anew.

        """
        torque = point.motor_torque
        if point.motor_torque_source is not PointSource.MEASURED:
            torque = NAN
        return State(
            axis=self.settings.axis,
            stamp=stamp,
            point=point,
            estimate=result,
            verdict=verdict,
            level=self._hold.level,
            level_since=self._hold.since,
            event_id=self.event.number,
            event=edge,
            limits=self.settings.limits,
            window=self._window.take(),
            inputs=self.input_status(now),
            totals=self._account.totals(),
            judged=self._judged,
            measured_torque=torque,
            # Of a load derived from it, the torque of the model says nothing new.
            torque_residual=NAN if point.derived is not None else torque - result.machine_torque,
            surface_id=self._surface_id,
            shelving=self.shelving.at(now),
        )

    def reset_totals(self) -> None:
        """Set the totals to zero."""
        self._account.reset()

    def _objection(self, sample: InputSample) -> Refusal | None:
        """Return why the value of a sample cannot be used, if it cannot."""
        if not math.isfinite(sample.value):
            return Refusal(source=sample.source, why=Why.NOT_A_NUMBER)
        if sample.source is Source.SPEED and self._positions is not None:
            return None  # of a position; what is plausible is the speed that follows from it
        return self._implausible(sample)

    def _implausible(self, sample: InputSample) -> Refusal | None:
        most = self.settings.plausible.get(sample.source, math.inf)
        return implausible(sample, most) if abs(sample.value) > most else None

    def _speed_of(self, sample: InputSample) -> InputSample | Refusal | None:
        """Return the speed in a sample, made of positions where those are the samples."""
        if self._positions is None:
            return sample
        most = self.settings.plausible.get(Source.SPEED, math.inf)
        made = self._positions.take(sample, most=most)
        return (self._implausible(made) or made) if isinstance(made, InputSample) else made

    def _judge_speed(self, sample: InputSample) -> State | None:
        self._reader.take_speed(sample)
        stamp, point = sample.stamp, self._point(sample.arrival)
        result = self._estimate(point)
        verdict = judge(point, result, self.settings.limits)
        self._judged += is_judged(verdict)
        self._account.add(moment(stamp, point, result, verdict), max_gap=self._max_gap)
        self._window.add(point, result, verdict)
        return self._advance(stamp, sample.arrival, point, result, verdict)

    @property
    def _max_gap(self) -> int:
        return self._inputs[Source.SPEED].timeout

    def _estimate(self, point: MachinePoint) -> PointEstimate:
        return estimate(point, self.surface, rcs_limit=self.settings.limits.rcs)

    def _point(self, now: int) -> MachinePoint:
        return self._reader.point(self._inputs, now, self.settings, self.surface)

    def _advance(
        self,
        stamp: int,
        now: int,
        point: MachinePoint,
        result: PointEstimate,
        verdict: Verdict,
        *,
        tick: bool = False,
    ) -> State | None:
        """
        Hold the level, follow the event, and return the state when it is due.

        Levels and events follow the stamps [ns], the status of the inputs the clock `now` [ns].

        """
        before = self._hold
        gaps = {'max_gap': self._max_gap, 'period': self._inputs[Source.SPEED].slow_period}
        self._hold = hold(before, verdict, stamp, self.settings.limits, **gaps)
        self._stamp = stamp
        self._stays.follow(self._hold, verdict, stamp)
        edge = self._stays.edge(
            before.level,
            self._hold.level,
            stamp,
            point=point,
            surface=self.surface,
            limits=self.settings.limits,
        )
        due = self._due(stamp) or edge is not None or self._hold.level is not before.level
        if self.observer is not None:
            self.observer(
                Instant(
                    stamp=stamp,
                    now=now,
                    point=point,
                    estimate=result,
                    verdict=verdict,
                    level=self._hold.level,
                    event=self.event,
                    edge=edge,
                    tick=tick,
                    published=due,
                )
            )
        if not due:
            return None
        self._last_published = stamp
        return self.state(stamp, now, point, result, verdict, edge=edge)

    def _due(self, stamp: int) -> bool:
        """Tell whether `stamp` is the first one in its period."""
        period = self.settings.publish_period
        if period == 0 or self._last_published is None:
            return True
        return stamp // period != self._last_published // period

    def _forget_the_future(self, now: int) -> None:
        """
        Forget samples that lie further ahead of `now` [ns] than is allowed.

        They were taken while the clock stood at zero, and would not go stale for as long.

        """
        settings = self.settings
        limit = now + settings.tick_period + settings.max_future + BACKWARD_JUMP
        for tracker in self._inputs.values():
            if now and tracker.is_ahead(limit):
                if tracker.source is Source.SPEED:
                    self._jump_back(now)
                tracker.forget()

    def _jump_back(self, stamp: int) -> None:
        """
        Begin a new time line at `stamp` [ns], which is that of a speed sample or of a tick.

        Samples in its future are forgotten and the filters start anew; level, event and totals
        stand, with their times moved so that they have lasted as long as before.

        """
        speed = self._inputs[Source.SPEED].last
        if speed is not None:
            self._move_times(stamp - speed.stamp)
        self._stamp = stamp
        self._account.forget()
        self._stays.forget_pending()
        self._last_published = None
        self._reader.forget_direction()
        for tracker in self._inputs.values():
            if tracker.is_ahead(stamp + BACKWARD_JUMP):
                tracker.forget()

    def _move_times(self, shift: int) -> None:
        self._hold = Hold(level=self._hold.level, since=max(0, self._hold.since + shift))
        self._stays.move(shift)
        self._account.move(shift)
