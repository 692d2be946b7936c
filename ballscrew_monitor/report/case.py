# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording and each of its axes, with all that is said of them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import Scaling, SECOND
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.recordings.columns import AxisOutcome, JudgedColumns
from ballscrew_monitor.recordings.summary import EventRecord
from ballscrew_monitor.report.survey import Survey
from surrogate.surface import Surface

Blocks = Callable[[], Iterable[JudgedColumns]]
"""Gives the blocks of rows of an axis in order, as often as it is called."""
Assumed = Mapping[str, Mapping[str, Any]]
"""What is assumed by what it is about, each with value and reason."""
RCS = 'RCS'
FIRST_DATE = 978_307_200.0
"""Stamps before this [s since 1970] are no calendar: logs without one begin in the year 2000."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputSetting:
    """
    How an input was read: topic, field, unit, and the line to SI of every unit.

    A speed `from_position` is worked out; its unit is that of the speed.

    """

    topic: str
    field: str
    unit: str
    scalings: Mapping[str, Scaling]
    from_position: bool = False


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisFacts:
    """
    What is known of an axis but for its rows.

    `load_from` is the input that its load is worked out from, empty where the load is measured;
    `assumed` says by name what else is not known, each with value and reason; `stated` names what
    somebody states, by its place in a map, `defaulted` what stands at its default there; `lead`
    [m] is that of the map, NaN without one.

    """

    load_from: str = ''
    assumed: Assumed = dataclasses.field(default_factory=dict)
    stated: frozenset[str] = frozenset()
    defaulted: frozenset[str] = frozenset()
    lead: float = math.nan

    @property
    def is_mapped(self) -> bool:
        """Tell whether its inputs are columns of a table, as a map says."""
        return 'lead_mm' in self.stated or 'lead_mm' in self.assumed  # no map is without it

    @property
    def torque_from_current(self) -> bool:
        """Tell whether its motor torque is a current times the torque constant of the map."""
        named = self.stated | set(self.assumed)
        return 'current.column' in named and 'torque.column' not in named

    @property
    def default_temperature_known(self) -> str:
        """Return how its default oil temperature is known, stated or assumed."""
        return 'stated' if 'temperature_degC' in self.stated else 'assumed'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisCase:
    """
    An axis that has rows; `inputs` holds those that have a topic; `blocks` gives the rows again.

    `nominal`: the parameters are those taken where nobody gave any; `numbered`: the recording
    tells how many messages were lost on their way to it.

    """

    axis: str
    surface: Surface
    settings: MonitorSettings
    inputs: Mapping[Source, InputSetting]
    outcome: AxisOutcome
    survey: Survey
    blocks: Blocks = tuple  # none are kept
    facts: AxisFacts = AxisFacts()
    nominal: bool = False
    numbered: bool = False

    @property
    def load_origin(self) -> str:
        """Return in words what its load is worked out from, empty where it is measured."""
        if self.facts.load_from:
            return f'worked out from the motor {self.facts.load_from.removeprefix("motor_")}'
        derived = PointSource.DERIVED in self.survey.sources[Source.LOAD]
        return 'worked out from the motor torque' if derived else ''

    def since_first(self, stamp: int) -> float:
        """Return a stamp [ns] as time on the time line of the page [s]."""
        return (stamp + self.survey.shift - self.survey.first) / SECOND

    @property
    def begins(self) -> float:
        """Return the date of its first row [s] since 1970, NaN where the log has no calendar."""
        begins = self.survey.first / SECOND
        return begins if begins >= FIRST_DATE else math.nan

    @property
    def is_silent(self) -> bool:
        """Tell whether nothing was judged, or nothing of what moved."""
        summary = self.outcome.summary()
        return summary is None or summary.says_nothing

    @property
    def outside_time(self) -> float:
        """Return the time outside the zone [s], NaN where nothing of what moved was judged."""
        summary = self.outcome.summary()
        return math.nan if summary is None or summary.says_nothing else summary.outside_time

    @property
    def worst_first(self) -> list[EventRecord]:
        """Return the events, the worst first."""
        return sorted(self.outcome.events, key=badness, reverse=True)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogCase:
    """
    A recording that was judged.

    `name` as its reader knows it, `parameters` where they came from; axes with rows, and the names
    of those without any; assumptions by what they are about, with value and reason; notes on the
    recording itself.

    """

    name: str
    parameters: str
    axes: Sequence[AxisCase]
    empty: Sequence[str] = ()
    assumptions: Assumed = dataclasses.field(default_factory=dict)
    notes: Sequence[str] = ()

    @property
    def unjudged(self) -> list[str]:
        """Return the axes on which nothing was judged."""
        return [*self.empty, *(one.axis for one in self.axes if one.is_silent)]

    @property
    def judged(self) -> bool:
        """Tell whether something was judged on at least one axis."""
        return len(self.unjudged) < len(self.axes) + len(self.empty)


def badness(event: EventRecord) -> tuple[float, float]:
    """
    Return how bad an event is: depth [-], then duration [s].

    The depth is the RCS itself, or what of the efficiency that is asked for was missing.

    """
    if event.quantity == RCS:
        depth = event.worst_value
    else:
        depth = (event.limit - event.worst_value) / event.limit
    return (depth if math.isfinite(depth) else 0.0), event.duration
