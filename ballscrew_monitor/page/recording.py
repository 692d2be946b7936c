# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording on the page: its judged columns along a clock that plays, pauses and jumps."""

import asyncio
from collections.abc import Iterable, Mapping
import math
from typing import Any

from ballscrew_monitor.core.conversions import (
    celsius,
    direction_of,
    opposing_load,
    SECOND,
    seconds,
)
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import PointSource, Reason, Zone
from ballscrew_monitor.judge.records import LIGHT_LOAD, STANDSTILL
from ballscrew_monitor.page import maps
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.history import SPAN
from ballscrew_monitor.page.hub import Browser, Hub, PERIOD
from ballscrew_monitor.page.phrases import advised, phrase, unjudged
from ballscrew_monitor.page.questions import Answer, Handler, number_in
from ballscrew_monitor.page.records import LEVELS, range_record, totals_record, UNKNOWN, ZONES
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.summary import EventRecord
from ballscrew_monitor.report.judging import AxisCase, judge_log, OnShare
from ballscrew_monitor.report.parameters import LogParameters
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.units import RPM

Array = NDArray[np.float64]
Codes = NDArray[np.uint8]
RATES = (0.1, 100.0)
CLOCK_PERIOD = 0.5  # [s] between two frames of the clock
CODES = ('zone', 'reason')
QUANTITIES = {'RCS': 'rcs', 'efficiency': 'efficiency'}


def _fresh(judged: NDArray[Any], name: str) -> Array:
    """Return numbers without those that are only held since their input went quiet."""
    return np.where(judged[f'{name}_source'] == PointSource.HELD, np.nan, judged[name])


class RecordedAxis:
    """One axis of a recording and its view."""

    def __init__(self, log: str, case: AxisCase, rows: Array, codes: Codes) -> None:
        """Show the rows of an axis as those of a history, and their codes of zone and reason."""
        self.rows, self._codes, self._case = rows, codes, case
        self.view = AxisView(log, case.axis)
        self._at = 0
        surface, limits = case.surface, case.settings.limits
        low, high = map(celsius, surface.temperature_range)
        about = {
            'unit': 'm/min',
            'screw': surface.screw_name,
            'oil': surface.oil_name,
            **range_record(surface.speed_range, surface.load_range, (low, high)),
        }
        self.view.know(about, surface, '')
        self._totals = totals_record(case.outcome.totals)
        self._assumes = PointSource.DEFAULT in case.survey.sources[Source.TEMPERATURE]
        self._limits = {
            'efficiency_limit': limits.efficiency,
            'rcs_limit': limits.rcs,
            'light_load_N': limits.light_load,
            'standstill_rpm': limits.standstill_speed / RPM,
        }

    def _until(self, stamp: float) -> int:
        """Return how many rows are not after a stamp [s]."""
        return int(np.searchsorted(self.rows[:, 0], stamp, side='right'))

    def show(self, stamp: float, now: float) -> None:
        """Show what was until a stamp [s], at `now` [s] of a steady clock."""
        end = self._until(stamp)
        begin = self._at
        is_far = end > begin and stamp - self.rows[max(begin - 1, 0), 0] > SPAN
        if end < begin or is_far:
            begin = self._until(stamp - SPAN)
            self.view.begin_again()
        self._at = end
        last = max(begin, end - 1)
        for row in self.rows[begin:last]:
            self.view.history.take(row)
        if end > begin:
            record = self._state_record(self.rows[end - 1], self._codes[end - 1])
            self.view.hear(self.rows[end - 1].tolist(), record, self._limits, now)
        self.view.show_events(
            _event_record(event, stamp)
            for event in self._case.outcome.events
            if seconds(event.start) <= stamp
        )

    def _state_record(self, row: Array, codes: Codes) -> dict[str, Any]:
        zone, reason = codes.tolist()
        _, speed, load, warmth, efficiency, rcs, *_, level = row.tolist()
        if zone == Zone.OUTSIDE:
            _, headline = maps.judged(rcs, efficiency, load, self._case.settings.limits)
        elif zone == Zone.OPTIMAL:
            headline = phrase('optimal_light' if math.isnan(efficiency) else 'optimal')
        else:
            opposing = opposing_load(load, direction_of(speed))
            headline = unjudged(reason, abs(speed), opposing, warmth)
        return {
            'level': LEVELS.get(int(level), UNKNOWN),
            'zone': ZONES.get(zone, UNKNOWN),
            'at_rest': reason == Reason.STANDSTILL,
            'temperature_assumed': self._assumes,
            'headline': headline,
            'inputs': [],
            'shelved': None,
            'totals': self._totals,
        }


def _event_record(event: EventRecord, stamp: float) -> dict[str, Any]:
    """Return an event as it was at a stamp [s]."""
    begin = seconds(event.start)
    return {
        'id': event.event_id,
        'begin': begin,
        'duration_s': min(event.duration, stamp - begin),
        'quantity': QUANTITIES.get(event.quantity, UNKNOWN),
        'worst': event.worst_value,
        'limit': event.limit,
        'active': stamp < begin + event.duration,
        'shelved': False,
        'advice': advised(event.target_speed),
        'acknowledged': False,
        'acknowledged_by': '',
        'acknowledge_reason': '',
    }


class Recording:
    """A clock over the axes of a recording; it begins to play at once."""

    def __init__(self, hub: Hub, axes: Iterable[RecordedAxis]) -> None:
        self._hub, self._axes = hub, list(axes)
        stamps = [axis.rows[[0, -1], 0] for axis in self._axes]
        firsts, lasts = zip(*stamps, strict=True)
        self._first, self._last = float(min(firsts)), float(max(lasts))
        self._at, self._factor, self._plays = 0.0, 1.0, True
        for axis in self._axes:
            hub.add(axis.view)
        hub.clock = self.clock

    @property
    def handlers(self) -> dict[str, Handler]:
        """Return what answers the buttons."""
        names = ('play', 'pause', 'rate', 'seek')
        return {name: getattr(self, f'_{name}') for name in names}

    def clock(self) -> dict[str, Any]:
        """Return how the clock stands, since the first row [s]."""
        return {
            'at_s': self._at,
            'span_s': self._last - self._first,
            'rate': self._factor,
            'playing': self._plays,
        }

    def advance(self, seconds: float, now: float) -> None:
        """Play for some `seconds` [s], at `now` [s] of a steady clock; stop at the end."""
        span = self._last - self._first
        if self._plays:
            self._at = min(self._at + self._factor * seconds, span)
            self._plays = self._at < span
        for axis in self._axes:
            axis.show(self._first + self._at, now)

    async def follow(self) -> None:
        """Play until cancelled."""
        loop = asyncio.get_running_loop()
        before = sent = loop.time()
        while True:
            now = loop.time()
            self.advance(now - before, now)
            if now - sent >= CLOCK_PERIOD:
                self._tell()
                sent = now
            before = now
            await asyncio.sleep(PERIOD)

    def _tell(self) -> None:
        self._hub.tell(frame('clock', self.clock()))

    async def _play(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        if self._at >= self._last - self._first:
            self._at = 0.0
        self._plays = True
        return self._done()

    async def _pause(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        self._plays = False
        return self._done()

    async def _rate(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        rate = number_in(request, 'x')
        if not RATES[0] <= rate <= RATES[1]:
            raise InputError(f'x is {rate:g}, allowed is {RATES[0]:g} to {RATES[1]:g}')
        self._factor = rate
        return self._done()

    async def _seek(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        self._at = min(max(number_in(request, 's'), 0.0), self._last - self._first)
        return self._done()

    def _done(self) -> Answer:
        self._tell()
        return {}, {}


class CourseKeeper:
    """Keeps of the rows of a recording what its courses are made of."""

    def __init__(self) -> None:
        self._parts: dict[str, list[tuple[Array, Codes]]] = {}

    def add(self, axis: str, rows: NDArray[Any]) -> None:
        """Take rows: those of which the node publishes a state are kept."""
        published = rows[rows['published']]
        still = published['gates'] & STANDSTILL != 0
        light = still | (published['gates'] & LIGHT_LOAD != 0)
        measured = published['motor_torque_source'] == PointSource.MEASURED
        columns = (
            published['stamp'] / SECOND,
            _fresh(published, 'speed') / RPM,
            _fresh(published, 'axial_load'),
            _fresh(published, 'temperature') + celsius(0.0),
            np.where(light, np.nan, published['efficiency']),
            *(np.where(still, np.nan, published[name]) for name in ('rcs', 'film_ratio')),
            np.where(still, np.nan, published['machine_torque']),
            np.where(measured, published['motor_torque'], np.nan),
            published['level'],
        )
        codes = np.column_stack([published[name] for name in CODES]).astype(np.uint8)
        self._parts.setdefault(axis, []).append((np.column_stack(columns), codes))

    def table(self, axis: str) -> None:
        """Return none: no report is made."""

    def course(self, axis: str) -> tuple[Array, Codes]:
        """Return rows and codes of an axis in the order of their stamps."""
        rows, codes = (np.concatenate(each) for each in zip(*self._parts[axis], strict=True))
        order = np.argsort(rows[:, 0], kind='stable')
        return rows[order], codes[order]


def recorded_axes(bag: Bag, parameters: LogParameters, on_share: OnShare) -> list[RecordedAxis]:
    """Judge a recording and return its axes; raises InputError where none has a row."""
    keeper = CourseKeeper()
    log = judge_log(bag, parameters, on_share=on_share, rows=keeper)
    courses = [(case, *keeper.course(case.axis)) for case in log.axes]
    axes = [
        RecordedAxis(log.name, case, rows, codes) for case, rows, codes in courses if len(rows)
    ]
    if not axes:
        raise InputError(f'{bag.path}: nothing was judged on any axis, there is nothing to show')
    return axes
