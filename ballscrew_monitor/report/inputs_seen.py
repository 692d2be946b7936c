# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Findings on each input of an axis, and contradictions to its stated unit.

Where its sign or size contradicts the others, what to write is said too, and where.

"""

from collections.abc import Iterable, Sequence
import dataclasses
import enum
import math

from ballscrew_monitor.core.conversions import celsius, seconds
from ballscrew_monitor.core.inputs import InputStatus, Source, Why, YEAR
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.messages.doctor import Heard, InputFacts, known_range, unit_doubts
from ballscrew_monitor.messages.reasons import slow_reason
from ballscrew_monitor.recordings.declared import unwritten, written
from ballscrew_monitor.recordings.words import duration, number
from ballscrew_monitor.report.judging import AxisCase, InputSetting
from ballscrew_monitor.report.ledger import Ledger, ledger_of
from ballscrew_monitor.report.survey import Extremes, Gaps
from surrogate.units import MILLI, RPM, TURN

MEASURED = 'measured'
READ_AS_LOAD = 'the axial load is worked out from it'
LAG_TOLD = 0.01  # [s] between stamp and arrival from which on it is told
SAME_RATE = 0.01  # between numbers of messages [-] up to which two inputs came together
IN_THE_MAP = 'check its unit, its scale and the lead in the map'
FASTEST_FEED = 2.0  # [m/s] hardly any ball screw feeds faster
NAMES = {
    Source.SPEED: 'Speed',
    Source.LOAD: 'Axial load',
    Source.TEMPERATURE: 'Oil temperature',
    Source.TORQUE: 'Motor torque',
}
OF_MOTOR = {
    'torque': {'torque_rated_Nm': 'rated torque'},
    'current': {'torque_constant_Nm_per_A': 'torque constant', 'torque_rated_Nm': 'rated torque'},
}
"""Places of a map that make a torque of what a column holds, with their words."""

WORDS = {Source.LOAD: 'axial load', Source.TORQUE: 'motor torque'}
DRIVES = 'it drives the nut both ways'
TURNED = {
    Source.SPEED: 'load and motor torque drive it the other way',
    Source.LOAD: f'the motor torque falls where it asks for more, or {DRIVES}',
    Source.TORQUE: 'it brakes where friction must be overcome',
}
"""Reasons to think that the sign of an input is turned."""
TOLERANT = 30.0  # factor by which friction may miss that of the model
UNITS_APART = {
    (1e3, 1.0): (Source.LOAD, 'kN', 'unit: kN'),
    (1e-3, 1.0): (Source.LOAD, 'N', 'unit: N'),
    (1e3, 1e3): (Source.TORQUE, 'N mm', 'scale: 0.001'),
}
"""Torque over what the load needs, and friction over that of the model: the unit that is meant."""


class Trouble(enum.Enum):
    """What may be wrong with the messages of an input, as the head of a column."""

    GAPS = 'Gaps'
    SLOW = 'Too slow for its timeout'
    LAG = 'Stamps behind arrival'
    LOST = 'Lost on the way'
    LEFT_OUT = 'Left out'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputSeen:
    """
    One input as it was recorded.

    Lowest and highest number in its `unit`, NaN without any; `rate` [Hz] outside of gaps, and
    whether that is assumed; its `origin` in words, whether that is a measurement or at least
    stated; what was refused, by why; how many messages were `left_out` as out of order or of other
    joints, and how many were `lost` on the way, None if that is not known, as in all recordings
    that are not `numbered`. In the end its stamps lay `lag` [s] behind their arrival, NaN without
    stamps, and it came too seldom for its timeout if `slow`. `hints` say what looks wrong. Without
    a topic it has no `ledger`.

    """

    source: Source = unwritten()
    origin: str = written(key='source')
    measured: bool
    stated: bool = unwritten(default=False)
    place: str = written(key='read_from', default='')
    unit: str = ''
    rate_assumed: bool = False
    received: int = 0
    refused: str = ''
    left_out: int = 0
    gaps: Gaps = Gaps()
    slow: bool = False
    hints: tuple[str, ...] = ()
    ledger: Ledger | None = written(because='silence', default=None)
    lost: int | None = written(because='uncounted', default=None)
    numbered: bool = unwritten(default=False)
    lag: float = written('s', because='unstamped', default=math.nan)
    low: float = written(key='lowest', because='silence', default=math.nan)
    high: float = written(key='highest', because='silence', default=math.nan)
    rate: float = written('Hz', because='silence', default=math.nan)

    @property
    def silence(self) -> str:
        """Return why there is no number."""
        if self.place:
            return 'no valid sample was received'
        return READ_AS_LOAD if self.measured else 'the input is not recorded'

    @property
    def unstamped(self) -> str:
        """Return why there is no lag."""
        return 'its messages bear no stamp' if self.received else self.silence

    @property
    def uncounted(self) -> str:
        """Return why it is not known how many messages were lost."""
        if self.numbered:
            return 'its publishers do not number them'
        return 'the recording does not tell'

    @property
    def troubles(self) -> dict[Trouble, str]:
        """Return in words what is wrong with its messages; what went well has none."""
        lost = 'not known' if self.lost is None else str(self.lost)
        gaps = f'{self.gaps.count}, in all {duration(self.gaps.time)}'
        left_out = f'{self.left_out} out of order or of other joints'
        amounts = (
            (Trouble.GAPS, self.gaps.count > 0, gaps),
            (Trouble.SLOW, self.slow, 'yes'),
            (Trouble.LAG, abs(self.lag) >= LAG_TOLD, f'{number(self.lag)} s'),
            (Trouble.LOST, self.numbered and self.lost != 0, lost),
            (Trouble.LEFT_OUT, self.left_out > 0, left_out),
        )
        return {trouble: text for trouble, there, text in amounts if there}

    @property
    def known(self) -> str:
        """Return how it is known: measured, stated or assumed."""
        return MEASURED if self.measured else 'stated' if self.stated else 'assumed'


def inputs_seen(case: AxisCase) -> list[InputSeen]:
    """Return all inputs of an axis, also those that it does not have."""
    inputs = []
    for source in NAMES:
        setting, sources = case.inputs.get(source), case.survey.sources[source]
        if setting is None:
            inputs.append(_without_topic(case, source, sources))
            continue
        status = next(status for status in case.outcome.inputs if status.source is source)
        heard = _heard(setting, case.survey.inputs[source], status)
        refusals, origin = case.outcome.refused.get(source, {}), _origin(case, source)
        refused = sum(refusals.values())
        if status.received == refused:
            origin = 'never valid' if refused else 'never received'
        input_seen = InputSeen(
            source=source,
            origin=origin,
            measured=origin == MEASURED,
            place=f'{setting.topic}: {setting.field}',
            unit=setting.unit,
            low=heard.low,
            high=heard.high,
            rate=_rate(case, source),
            rate_assumed='time.rate_Hz' in case.facts.assumed,
            received=status.received,
            refused=', '.join(
                f'{count} {why.fault.counted}' for why, count in refusals.items() if count
            ),
            left_out=status.dropped - refused,
            lost=status.lost if case.numbered else None,
            numbered=case.numbered,
            lag=status.lag,
            slow=status.slow,
            gaps=case.survey.gaps[source],
            hints=tuple(_hints(case, source, setting, heard)),
            ledger=ledger_of(case, source),
        )
        inputs.append(input_seen)
    return inputs


def missing_inputs(case: AxisCase) -> list[str]:
    """Return the names of inputs of an axis that are worth recording, as the log has none."""
    return [
        NAMES[seen.source]
        for seen in inputs_seen(case)
        if not seen.measured and (seen.source is Source.TEMPERATURE or math.isnan(seen.low))
    ]


def hints_on(cases: Iterable[AxisCase]) -> list[str]:
    """Return what looks wrong with any input of axes, and what mends it."""
    return [hint for case in cases for seen in inputs_seen(case) for hint in seen.hints]


def _rate(case: AxisCase, source: Source) -> float:
    """Return how many messages came in a second [Hz] outside of gaps, NaN where none can tell."""
    received = {status.source: status.received for status in case.outcome.inputs}
    steps, span = received[source] - case.survey.runs, case.survey.span
    if steps < 1 or not span:
        return math.nan
    # What came as often as the speed came with it; a long timeout does not see all gaps.
    if math.isclose(received[source], received[Source.SPEED], rel_tol=SAME_RATE):
        source = Source.SPEED
    gaps, silent = case.survey.gaps[source], 0.0
    refused = sum(case.outcome.refused.get(source, {}).values())
    if source is Source.SPEED:
        silent = case.survey.no_speed
    else:
        silent = seconds(case.settings.timeouts[source]) * gaps.count
        if refused:
            return steps / span  # of these gaps some are no silence
    rest, valid = span - gaps.time - silent, steps - refused
    usual = 2 * gaps.count < valid and rest > 0.0
    rate = (valid - gaps.count) / rest if usual else steps / span
    # Messages that were refused came in gaps or between them: neither rate is too high.
    return max(rate, steps / span) if refused else rate


def _origin(case: AxisCase, source: Source) -> str:
    """Return where the numbers of an input come from; what is in part assumed says so."""
    facts, name, origin = case.facts, source.name.lower(), MEASURED
    if source is Source.LOAD and case.load_origin:
        name, origin = facts.load_from.removeprefix('motor_'), case.load_origin
    elif source is Source.SPEED and (
        case.inputs[source].from_position or 'speed' in facts.assumed
    ):
        name, origin = 'position', 'worked out from the position'
    elif source is Source.TORQUE and facts.torque_from_current:
        name, origin = 'current', 'worked out from the current'
    doubtful = [part for part in ('column', 'unit') if f'{name}.{part}' in facts.assumed]
    for key, words in OF_MOTOR.get(name, {}).items():
        doubtful += [words] if key in facts.assumed else []
    return f'{origin}, {" and ".join(doubtful)} assumed' if doubtful else origin


def _without_topic(case: AxisCase, source: Source, sources: frozenset[PointSource]) -> InputSeen:
    if PointSource.DERIVED in sources:
        span = case.survey.inputs[source]
        origin = case.load_origin
        return InputSeen(
            source=source, origin=origin, measured=False, unit='N', low=span.low, high=span.high
        )
    if PointSource.DEFAULT in sources:
        known = case.facts.default_temperature_known
        origin = f'{known}, {celsius(case.settings.default_temperature):.4g} °C'
        return InputSeen(source=source, origin=origin, measured=False, stated=known == 'stated')
    if source is Source.TORQUE and case.facts.torque_is_load:
        whose = 'its current is ' if case.facts.load_from == 'current' else ''
        return InputSeen(source=source, origin=f'{whose}recorded, {READ_AS_LOAD}', measured=True)
    return InputSeen(source=source, origin='not recorded', measured=False)


def _heard(setting: InputSetting, span: Extremes, status: InputStatus) -> Heard:
    """Return the span of an input [SI] in its unit."""
    scaling = setting.scalings[setting.unit]
    ends = [(value - scaling.shift) / scaling.factor for value in (span.low, span.high)]
    return Heard(status=status, low=min(ends), high=max(ends))


def _hints(case: AxisCase, source: Source, setting: InputSetting, heard: Heard) -> Sequence[str]:
    facts = InputFacts(
        axis=case.axis,
        source=source,
        link=Link(topic=setting.topic, type_name=''),
        timeout=case.settings.timeouts[source] * 1e-9,
        unit=setting.unit,
        scalings=setting.scalings,
        known=known_range(case.surface, source, setting.unit),
    )
    hints = unit_doubts(facts, heard)
    if hints and case.facts.is_mapped:  # the units that it names are those of the bag
        hints = [f'{facts.parameter}: its numbers are far outside the surface: {IN_THE_MAP}']
    cure = IN_THE_MAP if case.facts.is_mapped else f'check {facts.parameter}.unit and scale'
    if case.outcome.refused.get(source, {}).get(Why.IMPLAUSIBLE):
        hints.append(f'{facts.parameter}: samples beyond what is plausible were refused: {cure}')
    status = heard.status
    if status.slow:
        slow = slow_reason(status.longest_gap, facts.parameter)
        hints.append(f'{facts.parameter}: it {slow}')
    if abs(status.lag) > seconds(YEAR):
        hints.append(
            f'{facts.parameter}: its stamps are of another clock than those of its arrival'
        )
    elif status.lagging:
        hints.append(
            f'{facts.parameter}: its stamps lie {duration(status.lag)} behind their arrival: set '
            'the clocks alike'
        )
    hints += contradictions(case, source, facts.parameter)
    if source is Source.SPEED:
        hints += _of_speed(case, setting, heard, facts.parameter, cure)
    elif source is not Source.TEMPERATURE and heard.low == heard.high:
        hints.append(f'{facts.parameter}: it never changes, is it connected?')
    return hints


def _of_speed(
    case: AxisCase, setting: InputSetting, heard: Heard, parameter: str, cure: str
) -> Sequence[str]:
    if math.isnan(heard.high):
        return []
    fastest = _amount(setting.unit, setting, heard)
    limit, feed = case.settings.limits.standstill_speed, case.surface.lead / TURN
    if fastest * feed > FASTEST_FEED:
        return [
            f'{parameter}: it feeds with up to {fastest * feed:.3g} m/s, hardly any ball screw '
            f'does: {cure}'
        ]
    if fastest >= limit:
        return []
    doubt = (
        f'{parameter}: the axis never moves, up to {fastest / RPM:.2g} rev/min: '
        f'numbers go from {heard.low:.3g} to {heard.high:.3g} {setting.unit}'
    )
    top = case.surface.speed_range[1]
    others = [unit for unit in setting.scalings if limit <= _amount(unit, setting, heard) <= top]
    if not others:
        return [doubt]
    if case.facts.is_mapped:
        return [f'{doubt}: {cure}']
    return [f'{doubt}, which may be {" or ".join(others)}: then set {parameter}.unit']


def _amount(unit: str, setting: InputSetting, heard: Heard) -> float:
    """Return the largest amount of the screw speed [rad/s] if the numbers were in a unit."""
    return max(abs(setting.scalings[unit](value)) for value in (heard.low, heard.high))


def contradictions(case: AxisCase, source: Source, parameter: str) -> Sequence[str]:
    """Return that sign or size of an input contradicts the others, and what may mend it."""
    factor, friction = case.balance.factor, case.balance.friction
    if source is case.balance.turned:
        alone = source is Source.LOAD and Source.TORQUE not in case.inputs
        why = DRIVES if alone else TURNED[source]
        doubt = f'{parameter}: its sign looks turned ({why})'
        return [f'{doubt}: {_write(case, source, "scale: -1")}, or 1 if it is -1']
    if source is not Source.LOAD or math.isnan(factor):
        return []
    doubt = (
        f'{parameter}: the motor torque changes {number(factor)} times as much as this load '
        f'needs at a lead of {case.surface.lead * MILLI:g} mm'
    )
    fitting = [
        meant
        for (ratio, times), meant in UNITS_APART.items()
        if _is_near(factor, ratio)
        and (math.isnan(friction) or _is_near(friction, times, TOLERANT))
    ]
    if len(fitting) != 1:
        cure = 'check unit and scale of both, the lead, and a gear between motor and screw'
        return [f'{doubt}: {cure}']
    whose, unit, value = fitting[0]
    return [f'{doubt}: the {WORDS[whose]} looks like {unit}: {_write(case, whose, value)}']


def _is_near(value: float, other: float, within: float = 2.0) -> bool:
    return other / within < value < other * within


def _write(case: AxisCase, source: Source, value: str) -> str:
    """Return where a value is to be written, in the map or among the parameters."""
    name = source.name.lower()
    if case.facts.is_mapped:
        return f'write `{value}` for axes.{case.axis}.{case.facts.column_of(name)} in the map'
    key, _, amount = value.partition(': ')
    return f'set {case.axis}.{name}.{key} to {amount}'
