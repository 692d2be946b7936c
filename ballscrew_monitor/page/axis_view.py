# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The newest of all that is known of one axis, and its last minutes, as frames."""

from collections.abc import Iterable, Mapping, Sequence
import math
from typing import Any

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.judge.certainty import Outside
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.page import maps
from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.history import columns_of, History
from ballscrew_monitor.page.phrases import phrase, Said
from ballscrew_monitor.page.records import UNKNOWN, ZONES
from surrogate.files import to_json
from surrogate.surface import Surface
from surrogate.units import MILLI

MOST_EVENTS = 100  # the newest are kept
NOTHING = {'level': UNKNOWN, 'zone': UNKNOWN, 'headline': phrase('nothing_heard')}
NO_LIMITS = dict.fromkeys(('efficiency_limit', 'rcs_limit', 'light_load_N', 'standstill_rpm'))
OUTSIDE = ZONES[Zone.OUTSIDE]
ZONE_CODES = {name: code for code, name in ZONES.items()} | {UNKNOWN: int(Zone.UNKNOWN)}
INACTIVE, GONE, ACTIVE = 'inactive', 'gone', 'active'
"""States of a node."""
LUBRICATION = diagnostics.PARTS[0]
SEEN_FAULTS = {Fault.NONE, Fault.INACTIVE, Fault.NOTHING_YET, Fault.WORSE, Fault.NOT_KNOWN}
TOLD_FAULTS = {int(fault) for fault in Fault if fault.status != LUBRICATION} - SEEN_FAULTS
"""Codes that are told beside level, reason and condition, which say the others."""


class AxisView:
    """One axis of one node."""

    def __init__(self, node: str, axis: str) -> None:
        self.node, self.axis = node, axis
        self.standing = ACTIVE
        self.history = History()
        self.state: Mapping[str, Any] = NOTHING
        self.limits: Mapping[str, Any] = NO_LIMITS
        self.about: Mapping[str, Any] = {}
        self.no_map: Said = phrase('no_map_yet')
        self.health: Mapping[str, Any] | None = None
        self.events: dict[int, Mapping[str, Any]] = {}
        self.warmth = math.nan  # of the oil as it was last known [degC]
        self.surface: Surface | None = None
        self.without = 0  # corrections of the node that the surface lacks
        self.map_frame: bytes | None = None
        self.grades: list[str] = []  # oils of which there are surfaces
        self.usual: frozenset[int] = frozenset()  # warnings that the baseline already had
        self.parameters: Mapping[str, Any] = {}  # of the node, those of this axis and of all
        self.codes: dict[str, int] = {}  # of the diagnostics by their parts
        self.is_changed = False  # what `hello` says
        self._heard = math.nan  # [s]
        self._sent = 0  # rows
        self._sent_at = -math.inf  # [s]
        self._health_is_news = self._events_are_news = False

    @property
    def name(self) -> str:
        """Return what tells this axis from all others."""
        return f'{self.node}/{self.axis}'

    def hear(
        self,
        row: Sequence[float],
        record: Mapping[str, Any],
        limits: Mapping[str, Any],
        now: float,
    ) -> None:
        """Take a state and its limits, heard at `now` [s] of a steady clock."""
        self.history.take(row)
        self.state, self._heard = record, now
        self.is_changed |= limits != self.limits
        self.limits = limits

    def know(
        self, about: Mapping[str, Any], surface: Surface | None, no_map: Said, without: int = 0
    ) -> None:
        """Take what it is, and its surface `without` some corrections, or why that is missing."""
        self.about, self.surface, self.no_map, self.without = about, surface, no_map, without
        self.map_frame, self.is_changed = None, True

    def hear_code(self, part: str, code: int) -> None:
        """Take the code of the diagnostics of a part of the axis."""
        self.codes[part] = code
        if part == LUBRICATION and self.standing != GONE:
            self.stand(INACTIVE if code == Fault.INACTIVE else ACTIVE)

    def hear_usual(self, numbers: frozenset[int]) -> None:
        """Take the numbers of the warnings that the baseline of the axis already had."""
        self._events_are_news |= numbers != self.usual
        self.usual = numbers

    def hear_parameters(self, values: Mapping[str, Any]) -> None:
        """Take parameters of the node by their names."""
        self.parameters = values

    def stand(self, standing: str) -> None:
        """Take the state of the node."""
        self.is_changed |= standing != self.standing
        self.standing = standing

    def hear_health(self, record: Mapping[str, Any]) -> None:
        """Take an assessment."""
        self.health, self._health_is_news = record, True

    def hear_event(self, record: Mapping[str, Any]) -> None:
        """Take an event as it is now; number 0 says that there has been none."""
        if record['id']:
            self.events[record['id']] = record
            for old in sorted(self.events)[:-MOST_EVENTS]:
                del self.events[old]
            self._events_are_news = True

    def show_events(self, records: Iterable[Mapping[str, Any]]) -> None:
        """Take all events as they are now in their order, in place of those before."""
        events = {record['id']: record for record in list(records)[-MOST_EVENTS:]}
        # Numbers that are not known are not equal to themselves.
        self._events_are_news |= to_json(events) != to_json(self.events)
        self.events = events

    def begin_again(self) -> None:
        """Forget the rows, as time has jumped."""
        self.history, self._sent, self.is_changed = History(), 0, True

    def age(self, now: float) -> float:
        """Return the time since the last state [s], NaN before the first."""
        return now - self._heard

    @property
    def lead(self) -> float:
        """Return the lead of the screw [m], NaN without its surface."""
        return math.nan if self.surface is None else self.surface.lead

    @property
    def limit(self) -> dict[str, float] | None:
        """Return the limit of RCS for the newest row, None where that is not known."""
        rows = self.history.since(self.history.count - 1)
        if self.surface is None or self.limits['rcs_limit'] is None or not len(rows):
            return None
        return maps.limit_record(self.surface, maps.limits_of(self.limits), rows[-1], self.warmth)

    @property
    def outside(self) -> Outside:
        """Return how surely the newest row is outside the zone."""
        rows = self.history.since(self.history.count - 1)
        if self.surface is None or self.limits['rcs_limit'] is None or not len(rows):
            return Outside.UNKNOWN
        zone = ZONE_CODES[self.state.get('zone', UNKNOWN)]
        return maps.outside_at(self.surface, self.limits, rows[-1], self.warmth, zone=zone)

    def hello(self) -> dict[str, Any]:
        """Return what the axis is."""
        return {
            'id': self.name,
            'node': self.node,
            'axis': self.axis,
            'lead_mm': MILLI * self.lead,
            'no_map': self.no_map,
            'grades': self.grades,
            **self.about,
            **self.limits,
        }

    def news(self, now: float, period: float) -> list[bytes]:
        """Return frames with what was not sent yet; a state comes after `period` [s] anyway."""
        frames = []
        if self._events_are_news:
            frames.append(self.events_frame())
            self._events_are_news = False
        due = self.history.count > self._sent or self._health_is_news or frames
        if due or now - self._sent_at >= period:
            frames.append(self._state_frame(now, self._sent, health=self._health_is_news))
            self._sent, self._sent_at, self._health_is_news = self.history.count, now, False
        return frames

    def greeting(self, now: float) -> list[bytes]:
        """Return frames with all that was sent so far."""
        rows = columns_of(self.history.since(0))
        return [
            frame('history', {'axis': self.name}, rows),
            *([] if self.map_frame is None else [self.map_frame]),
            self.events_frame(),
            self._state_frame(now, self.history.count, health=True),
        ]

    def _advice(self, event: Mapping[str, Any] | None) -> Said:
        """Return what helps at this moment: nothing while it is not outside the zone."""
        if event is None or not event['active'] or self.state['zone'] != OUTSIDE:
            return ''
        workshop: Said = self.health['advice'] if self.health else ''
        if workshop and 'key' in event['advice']:
            return phrase('either_or', first=workshop, second=event['advice'])
        return workshop or event['advice']

    def events_frame(self) -> bytes:
        """Return the events, the newest first."""
        events = [
            {**self.events[number], 'usual': number in self.usual}
            for number in sorted(self.events, reverse=True)
        ]
        return frame('events', {'axis': self.name, 'events': events})

    def _state_frame(self, now: float, since: int, *, health: bool) -> bytes:
        event = self.events[max(self.events)] if self.events else None
        record = {
            'axis': self.name,
            **self.state,
            'age_s': self.age(now),
            'advice': self._advice(event),
            'event': event,
            'outside': self.outside.value,
            'usual': event is not None and event['active'] and event['id'] in self.usual,
            'limit': self.limit,
            'standing': self.standing,
            'faults': sorted(TOLD_FAULTS.intersection(self.codes.values())),
        }
        if health:
            record['health'] = self.health
        return frame('state', record, columns_of(self.history.since(since)))
