# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A recording judged in one pass, and each of its axes, with all that page and terminal say of it.

Printing asks for no more than the node: nothing here loads what pages and tables are made with.

"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
import math
from typing import Any, Protocol, TYPE_CHECKING

from ballscrew_monitor.core.conversions import LINEAR_UNITS, POSITION_UNITS, Scaling, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.recordings.axis_run import AxisRows, TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.positions import positions_of
from ballscrew_monitor.recordings.recorded_events import judged_by_events
from ballscrew_monitor.recordings.replay import ignore, replay_parts
from ballscrew_monitor.recordings.summary import AxisOutcome, EventRecord
from ballscrew_monitor.recordings.words import feed_first
from ballscrew_monitor.report.balance import Balance, balance_of
from ballscrew_monitor.report.health_history import AxisHistory, HistoryMaker
from ballscrew_monitor.report.machines import folder_of
from ballscrew_monitor.report.parameters import Assumed, AxisFacts, LogParameters
from ballscrew_monitor.report.survey import Survey, Surveyor
from ballscrew_monitor.settings.axis import (
    gathering_of,
    load_surface,
    scalings_of,
    settings_of,
    surface_file,
)
from ballscrew_monitor.settings.parameters import absolute, input_topics, is_configured
from numpy.typing import NDArray
from surrogate.surface import ContactOnset, onset_of_surface, Surface, ZoneLimits

if TYPE_CHECKING:  # they ask for packages that printing does not need
    from ballscrew_monitor.report.row_table import RowTable

RCS = 'RCS'


class RowKeeper(Protocol):
    """Keeps the rows of all axes."""

    def add(self, axis: str, rows: NDArray[Any]) -> None:
        """Take the next rows of an axis, an array of ROW with at least one."""

    def table(self, axis: str) -> 'RowTable | None':
        """Return the rows of an axis that has some, None if they are not for a report."""


FIRST_DATE = 978_307_200.0
"""Stamps before this [s since 1970] are no calendar: logs without one begin in the year 2000."""
OnShare = Callable[[float], None]
"""Told which share of a recording is judged [-]."""
OnState = Callable[[TimedState], None]
"""Handed a state that would be published."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputSetting:
    """
    How an input was read: topic, field, unit, and the line to SI of every unit.

    A speed `from_position` is worked out; its unit is that of the speed. `as_feed`: it is of the
    nut, not of the screw. The recording promises so many messages of the topic, None if it states
    no number, and its files hold `present`, None if it holds events instead; `absent` says what
    the others are.

    """

    topic: str
    field: str
    unit: str
    scalings: Mapping[str, Scaling]
    from_position: bool = False
    as_feed: bool = False
    promised: int | None = None
    present: int | None = None
    absent: str = Bag.absent


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisCase:
    """
    An axis that has rows; `inputs` holds those that have a topic; `rows` are kept for a report.

    `nominal`: the parameters are those taken where nobody gave any; `numbered`: the recording
    tells how many messages were lost on their way to it; `onset`: where contact begins with the
    oil as warm as it was in motion on average; `surely_outside` [s], NaN where nothing tells;
    `health` is that by this recording alone, where it was asked for.

    """

    axis: str
    surface: Surface
    settings: MonitorSettings
    inputs: Mapping[Source, InputSetting]
    outcome: AxisOutcome
    survey: Survey
    rows: 'RowTable | None' = None
    facts: AxisFacts = AxisFacts()
    nominal: bool = False
    numbered: bool = False
    history: AxisHistory | None = None
    health: Health | None = None
    onset: ContactOnset | None = None
    balance: Balance = Balance()
    surely_outside: float = math.nan

    @property
    def row_table(self) -> 'RowTable':
        """Return its rows; they must have been kept."""
        if self.rows is None:
            raise ValueError(f'the rows of axis {self.axis} were not kept')
        return self.rows

    @property
    def contact(self) -> str:
        """Return where contact begins, in the unit in which the log speaks."""
        if self.onset is None:
            return ''
        sentence = self.onset.sentence(as_feed=self.speaks_feed)
        return f'{sentence.replace(" degC", " °C")}.'

    @property
    def speaks_feed(self) -> bool:
        """Return True if the log gives the motion of the nut, not that of the screw."""
        if self.facts.motion_unit:
            return self.facts.motion_unit in LINEAR_UNITS
        return Source.SPEED in self.inputs and self.inputs[Source.SPEED].as_feed

    def in_its_unit(self, text: str) -> str:
        """Return words in which speeds of the screw stand as feeds, if the log speaks of them."""
        return feed_first(text, self.surface.lead) if self.speaks_feed else text

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

    def span(self, event: EventRecord) -> tuple[float, float]:
        """Return begin and end of an event on the time line of the page [s]."""
        return self.since_first(event.start), self.since_first(event.end)

    def shown(self, event: EventRecord) -> tuple[float, float]:
        """Return the time about an event that its mark or its row leads to [s]."""
        begin, end = self.span(event)
        margin = max(1.0, 0.2 * (end - begin))
        return begin - margin, end + margin

    @property
    def begins(self) -> float:
        """Return the date of its first row [s] since 1970, NaN where the log has no calendar."""
        begins = self.survey.first / SECOND
        return begins if begins >= FIRST_DATE else math.nan

    @property
    def is_silent(self) -> bool:
        """Return True if nothing was judged, or nothing of what moved."""
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
    recording itself; the machine that it is of. `unread` has the number of messages of each topic
    that no input is read from, `unread_parts` why other parts of its file are not read.

    """

    name: str
    parameters: str
    axes: Sequence[AxisCase]
    empty: Sequence[str] = ()
    assumptions: Assumed = dataclasses.field(default_factory=dict)
    notes: Sequence[str] = ()
    machine: str = ''
    unread: Mapping[str, int] = dataclasses.field(default_factory=dict)
    unread_parts: Mapping[str, str] = dataclasses.field(default_factory=dict)

    @property
    def unjudged(self) -> list[str]:
        """Return the axes on which nothing was judged."""
        return [*self.empty, *(case.axis for case in self.axes if case.is_silent)]

    @property
    def missed_share(self) -> float:
        """Return the largest share of the motion of an axis between samples [-]."""
        return max((case.survey.missed_share for case in self.axes), default=0.0)

    @property
    def judged(self) -> bool:
        """Return True if something was judged on at least one axis."""
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


class CaseMaker:
    """Takes the rows of one axis in order, and makes its case of them."""

    def __init__(
        self,
        axis: str,
        values: Mapping[str, Any],
        machine: str = '',
        *,
        health: bool = False,
        **along: Any,
    ) -> None:
        """
        Begin an axis of a machine with the parameters `values`; InputError without its surface.

        What its `health` rests on is gathered if wanted; `along` is told to `HistoryMaker`.

        """
        self._axis, self._values, self._machine = axis, values, machine
        self._surface = load_surface(axis, values)
        self._settings = settings_of(axis, values, self._surface)
        self._surveyor = Surveyor(
            axis,
            self._surface,
            self._settings.limits,
            max_gap=self._settings.timeouts[Source.SPEED],
        )
        self._history: HistoryMaker | None = None
        if health:
            self._history = HistoryMaker(self._surface, gathering_of(axis, values), **along)

    def add(self, rows: NDArray[Any], run: int = 0) -> None:
        """Take the next rows, an array of ROW, of the run of a number."""
        self._surveyor.add(rows, run)
        if self._history is not None:
            self._history.add(rows)

    def case(
        self, outcome: AxisOutcome, bag: Bag | None = None, *, facts: AxisFacts, **known: Any
    ) -> AxisCase:
        """
        Return the axis as it is after at least one row; `facts` and `known` are more of it.

        `bag` holds the messages of its inputs, None if they were recorded as events.

        """
        inputs = {}
        for source in Source:
            if not is_configured(self._axis, self._values, source):
                continue
            prefix, values = f'{self._axis}.{source.name.lower()}', self._values
            unit = values[f'{prefix}.unit']
            scalings = scalings_of(self._axis, values, source, self._surface.lead)
            counts, topic = {}, absolute(values[f'{prefix}.topic'])
            if bag is not None and topic in bag.topics:
                counts = {'promised': bag.promised.get(topic), 'present': bag.topics[topic].count}
            inputs[source] = InputSetting(
                topic=values[f'{prefix}.topic'],
                field=values[f'{prefix}.field'],
                unit=unit if unit in scalings else next(iter(scalings)),
                scalings=scalings,
                from_position=unit in POSITION_UNITS,
                as_feed=unit in LINEAR_UNITS,
                absent=Bag.absent if bag is None else bag.absent,
                **counts,
            )
        survey, history = self._surveyor.result(), None
        if self._history is not None:
            history = self._history.history(
                self._axis,
                surface_file(self._axis, self._values),
                self._settings,
                machine=self._machine,
                torque_is_load=facts.torque_is_load,
            )
        return AxisCase(
            axis=self._axis,
            surface=self._surface,
            settings=self._settings,
            inputs=inputs,
            outcome=outcome,
            survey=survey,
            history=history,
            onset=self._onset(survey.oil.mean),
            balance=balance_of(self._surveyor.sums),
            surely_outside=self._surveyor.sure_time,
            facts=facts,
            **known,
        )

    def _onset(self, oil: float) -> ContactOnset:
        """Return where contact begins at an oil temperature [K], NaN for that of the sheet."""
        limits = self._settings.limits
        zone = ZoneLimits(
            rcs=limits.rcs, efficiency=limits.efficiency, light_load=limits.light_load
        )
        return onset_of_surface(self._surface, None if math.isnan(oil) else oil, zone)


def judge_log(
    bag: Bag,
    parameters: LogParameters,
    *,
    on_share: OnShare = ignore,
    rows: RowKeeper | None = None,
    on_state: OnState | None = None,
    health: bool = False,
    along_stroke: bool = False,
) -> LogCase:
    """
    Judge a recording and return what is said of it; its rows are kept in `rows`, if anywhere.

    `on_state` is handed each state that would be published; what the `health` of each axis
    rests on is gathered if wanted, `along_stroke` by its positions, too. Raises InputError when it
    cannot be read with the parameters.

    """
    machine = parameters.machine or str(folder_of(bag.path))
    makers: dict[str, CaseMaker] = {}
    outcomes = []
    for part in _parts(bag, parameters.values, on_share, on_state):
        if isinstance(part, AxisOutcome):
            outcomes.append(part)
        else:
            if part.axis not in makers:
                along: dict[str, Any] = {}
                if along_stroke:
                    positions = positions_of(bag, part.axis, parameters.values)
                    along = {'log': str(bag.path), 'positions': positions}
                makers[part.axis] = CaseMaker(
                    part.axis, parameters.values, machine, health=health, **along
                )
            makers[part.axis].add(part.rows, part.run)
            if rows is not None:
                rows.add(part.axis, part.rows)
    numbered = judged_by_events(bag, parameters.values)
    return LogCase(
        name=bag.path.name,
        parameters=parameters.short_origin,
        axes=[
            makers[outcome.axis].case(
                outcome,
                None if numbered else bag,
                rows=None if rows is None else rows.table(outcome.axis),
                facts=parameters.axes.get(outcome.axis, AxisFacts()),
                nominal=parameters.nominal,
                numbered=numbered,
            )
            for outcome in outcomes
            if outcome.axis in makers
        ],
        empty=[outcome.axis for outcome in outcomes if outcome.axis not in makers],
        assumptions=parameters.assumptions,
        notes=[*parameters.notes, *bag.notes],
        machine=machine,
        unread={
            topic: info.count
            for topic, info in bag.topics.items()
            if not numbered and topic not in {*input_topics(parameters.values), *bag.worked_out}
        },
        unread_parts=bag.unread,
    )


def _parts(
    bag: Bag, values: Mapping[str, Any], on_share: OnShare, on_state: OnState | None
) -> Iterator[AxisRows | AxisOutcome]:
    """Yield rows and outcomes; states, which cost more than these, are made only if wanted."""
    for part in replay_parts(bag, values, states=on_state is not None, on_done=on_share):
        if not isinstance(part, TimedState):
            yield part
        elif on_state is not None:
            on_state(part)
