# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Data into and out of a monitor: settings, the ending of an event, shelving.

A warning that is known can be shelved for a time, so that nobody is called for it again and again.
Shelving changes what is said of a warning, never the judgement. Time is an argument [ns], the
clock of the node.

"""

from collections.abc import Mapping
import dataclasses
import math

from ballscrew_monitor.core.conversions import nanoseconds, SECOND, seconds
from ballscrew_monitor.core.inputs import Source, YEAR
from ballscrew_monitor.core.judgement import EventEnd, Limits
from surrogate.files import InputError

NAN = math.nan
LONGEST_SHELVING = 86400 * SECOND
"""No warning is shelved longer than this [ns], however the clock is set."""
LONGEST_REASON, LONGEST_NAME = 500, 200
"""Characters of a reason, which a state carries, and of a name."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LoadDerivation:
    """
    How a load is derived from the torque.

    `inertia` [kg m2] of what turns, at the screw; `window` [ns] of the
    acceleration; `torque_uncertainty` [N m] at the screw, a half width; `parts_uncertainty` [-]
    that of inertia torque and drag over themselves; `largest_share` [-] of inertia torque and drag
    in the measured torque up to which a load is derived.

    """

    inertia: float
    window: int
    torque_uncertainty: float
    parts_uncertainty: float
    largest_share: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class MonitorSettings:
    """
    What a monitor is told.

    `timeouts` [ns] of the configured inputs only: an input without one has no topic; `fields` are
    the paths of their numbers. `default_temperature` [K] is used without a temperature topic,
    `publish_period` [ns] thins out the states, 0 keeps all; a stamp may be `max_future` [ns] ahead
    of the clock, and that is less than `tick_period` [ns] ahead of the tick. Stamps more than
    `max_lag` [ns] behind their arrival are warned of. Samples whose amount is above that in
    `plausible` [SI] are refused, and with `one_source` those of an input that several publishers
    send. With a `derivation` the load is derived from the motor torque. With a `position_window`
    [ns] the samples of the speed are positions, whose slope over the window is the speed; angles
    start over at `wrap` [rad], 0: they do not. Advice names another speed only if `speed_allowed`:
    the process leaves it free.

    """

    axis: str
    limits: Limits
    timeouts: Mapping[Source, int]
    default_temperature: float
    publish_period: int = 0
    max_future: int = 0
    max_lag: int = YEAR
    one_source: bool = True
    speed_allowed: bool = False
    tick_period: int = 0
    plausible: Mapping[Source, float] = dataclasses.field(default_factory=dict)
    fields: Mapping[Source, str] = dataclasses.field(default_factory=dict)
    derivation: LoadDerivation | None = None
    position_window: int = 0
    wrap: float = 0.0


@dataclasses.dataclass(frozen=True, slots=True)
class Ending:
    """How an event ended; the `name` of who acknowledged it, and the `reason`, where stated."""

    kind: EventEnd = EventEnd.UNKNOWN
    name: str = ''
    reason: str = ''

    @property
    def text(self) -> str:
        """Return why the event ended, empty if the axis came back."""
        match self.kind:
            case EventEnd.ACKNOWLEDGED:
                by = f' by {self.name}' if self.name else ''
                return f'acknowledged{by}{f": {self.reason}" if self.reason else ""}'
            case EventEnd.STOPPED:
                return (
                    'ended by the node, not by the axis, nothing is judged any more: '
                    f'{self.reason}'
                )
            case EventEnd.RESTARTED:
                return 'ended by a restart of the node'
            case EventEnd.RUN_ENDED:
                return 'the run ended'
        return ''


NOT_ENDED, CLEARED = Ending(), Ending(EventEnd.CLEARED)
RESTARTED, NAMELESS = Ending(EventEnd.RESTARTED), Ending(EventEnd.ACKNOWLEDGED)
RUN_ENDED = Ending(EventEnd.RUN_ENDED)


WINDOW = ('speed', 'axial_load', 'efficiency', 'rcs', 'film_ratio')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Shelving:
    """
    Until when [ns] a warning is shelved, and why; `until` 0: it is not.

    Below 0 it is the time that is left, with its sign changed, while the clock stands at zero.

    """

    until: int = 0
    reason: str = ''

    def at(self, now: int) -> 'Shelving':
        """Return what of it holds at `now` [ns]: nothing if it is over or ends too far ahead."""
        return self if 0 < self.until - now <= LONGEST_SHELVING else NOT_SHELVED

    def left(self, now: int) -> int:
        """Return for how long [ns] it still holds at `now` [ns]."""
        return max(self.until - now, 0) if self.until > 0 else -self.until

    def started(self, now: int) -> 'Shelving':
        """Return it with its end on a clock that shows `now` [ns], if that has not begun yet."""
        return dataclasses.replace(self, until=now - self.until) if self.until < 0 < now else self

    def is_over(self, now: int) -> bool:
        """Return True if it has ended at `now` [ns]; not by a clock that is behind or at zero."""
        return 0 < self.until <= now


NOT_SHELVED = Shelving()


def shelve(now: int, duration: float, reason: str) -> Shelving:
    """
    Return the shelving from `now` [ns] for a `duration` [s], none for a duration of 0.

    Raises InputError for a duration out of range and for a missing reason.

    """
    longest = seconds(LONGEST_SHELVING)
    if not (math.isfinite(duration) and 0.0 <= duration <= longest):
        raise InputError(f'duration is {duration:g} s, allowed is 0 to {longest:g} s')
    if duration == 0.0:
        return NOT_SHELVED
    reason = _line(reason, 'reason', 'why', 1, LONGEST_REASON)
    if now == 0:
        raise InputError('the clock of the node stands at zero, play /clock first')
    return Shelving(until=now + nanoseconds(duration), reason=reason)


def acknowledgement(name: str, reason: str) -> Ending:
    """Return that of a name; raises InputError for a missing name and for texts too long."""
    return Ending(
        kind=EventEnd.ACKNOWLEDGED,
        name=_line(name, 'name', 'who', 1, LONGEST_NAME),
        reason=_line(reason, 'reason', 'why', 0, LONGEST_REASON),
    )


def _line(text: str, name: str, what: str, least: int, most: int) -> str:
    """Return a text in one line; raises InputError unless it has `least` to `most` characters."""
    line = ' '.join(text.split())
    if not least <= len(line) <= most:
        raise InputError(
            f'{name} has {len(line)} characters, it must say {what} in {least} to {most}'
        )
    return line
