# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
From states to diagnostic_msgs: three statuses for each axis.

A status begins as an ERROR that says that nothing was set, and every case that is not known to be
good stays above OK. Messages hold no numbers, so that a new message is a change worth publishing;
numbers are values, with the unit in brackets.

"""

from collections.abc import Callable, Mapping
import math

from ballscrew_monitor.core.conversions import celsius, seconds
from ballscrew_monitor.core.estimate import PointValidity
from ballscrew_monitor.core.inputs import Health, InputState, Source, Why, YEAR
from ballscrew_monitor.core.judgement import Code, Gate, Level
from ballscrew_monitor.core.state import Event, State
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from surrogate.surface import Surface

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE
NOT_SET = 'no message was set'
NOTHING_YET = 'nothing has been judged yet'
CLOCK_STANDS = (
    'the clock stands still, nothing is seen to go stale: play /clock, or unset use_sim_time'
)
INACTIVE = 'the node is inactive, nothing is judged'
PARTS = ('Lubrication', 'Inputs', 'Surface')
StatusSummary = tuple[bytes, str]  # level and message of a status

_NOT_JUDGED = {
    PointValidity.UNKNOWN: 'not judged: the screw has not moved yet',
    PointValidity.SPEED_BELOW_RANGE: 'not judged: speed below the surface',
    PointValidity.SPEED_ABOVE_RANGE: 'not judged: speed above the surface',
    PointValidity.LOAD_OUT_OF_RANGE: 'not judged: load outside the surface',
    PointValidity.TEMPERATURE_OUT_OF_RANGE: 'not judged: temperature outside the surface',
    PointValidity.MASKED: 'not judged: the model did not converge here',
    PointValidity.NO_INPUT: 'not judged: an input is missing',
    PointValidity.NO_SURFACE: 'not judged: no surface',
}
_OF_STANDSTILL = (
    PointValidity.UNKNOWN,
    PointValidity.SPEED_BELOW_RANGE,
)  # nothing wrong with these there
_CAUSES = {
    Code.RCS_HIGH: 'asperities carry too much',
    Code.EFFICIENCY_LOW: 'too much power is lost',
}
_INPUT_WORDS = {
    InputState.STALE: 'is stale',
    InputState.MISSING: 'was never received',
    InputState.BAD: 'is not usable',
    InputState.UNKNOWN: 'is unknown',
}
# Numbers are among the values: the text changes with the fault alone.
_REFUSED = {
    Why.NOT_A_NUMBER: 'it is not a finite number',
    Why.FUTURE: 'its stamps lie ahead of the clock, set the clocks alike or raise max_future',
    Why.OTHER_CLOCK: 'its stamps are of the wall clock and the node runs on simulated time, '
    'stamp with /clock or unset use_sim_time',
}
_TROUBLES: tuple[tuple[Callable[[Health], bool], str], ...] = (
    (
        lambda health: health.losing,
        'messages are lost on the way: lower their rate, raise publish_period, or give the node '
        'fewer axes or more of the processor',
    ),
    (
        lambda health: health.lag > seconds(YEAR),
        'stamps are of simulated time and the node runs on the wall clock: set use_sim_time',
    ),
    (
        lambda health: health.lagging,
        'stamps lag behind their arrival: set the clocks alike, or raise max_lag',
    ),
    (lambda health: health.slow, 'slower than the timeout'),
    (
        lambda health: health.lost is None,
        'loss is unknown: let the topic have one publisher that numbers its messages',
    ),
)


def blank(node: str, axis: str) -> list[DiagnosticStatus]:
    """Return the statuses of an axis of which nothing is known."""
    return [
        DiagnosticStatus(name=f'{node}: {axis}: {part}', level=ERROR, message=NOT_SET)
        for part in PARTS
    ]


def failed(node: str, axis: str, reason: str) -> list[DiagnosticStatus]:
    """Return the statuses of an axis that cannot work for `reason`."""
    return [
        DiagnosticStatus(name=f'{node}: {axis}: {part}', level=ERROR, message=reason)
        for part in PARTS
    ]


def statuses(
    node: str,
    axis: str,
    state: State | None,
    event: Event,
    surface: Surface,
    *,
    publishers: Mapping[Source, int] | None,
    clock_stands: bool = False,
) -> list[DiagnosticStatus]:
    """
    Return the three statuses of a configured axis, `state` its last one if there is one.

    `publishers` says how many publishers each input is matched with; None: the node is inactive.
    While the clock stands no state tells that an input is dead, so nothing but a warning is held.

    """
    made = blank(node, axis)
    for status in made:
        status.hardware_id = surface.screw_name
    changed = ' and corrected' if surface.corrections else ''
    made[2].level, made[2].message = OK, f'{surface.tier} surface loaded{changed}'
    made[2].values = _values(_surface_values(surface))
    made[1].values = _values(
        [
            (f'{source.name.capitalize()} publishers [-]', count)
            for source, count in (publishers or {}).items()
        ]
    )
    if state is None or publishers is None:
        for status in made[:2]:
            status.level, status.message = STALE, CLOCK_STANDS if clock_stands else NOTHING_YET
            if publishers is None:
                status.message = INACTIVE
        return made
    for status, (level, message) in zip(made, summaries(state, event)):
        status.level, status.message = level, message
    if clock_stands:
        for status in made[1:2] if state.level is Level.WARN else made[:2]:
            status.level, status.message = STALE, CLOCK_STANDS
    made[0].values = _values(_lubrication_values(state))
    made[1].values = [*made[1].values, *_values(_input_values(state.inputs))]
    return made


def summaries(state: State, event: Event) -> tuple[StatusSummary, StatusSummary]:
    """Return level and message of Lubrication and Inputs; only a change of them is news."""
    return _lubrication(state, event), _inputs(state.inputs)


def _lubrication(state: State, event: Event) -> StatusSummary:
    if state.level is Level.WARN:
        cause = _CAUSES.get(event.cause.code, 'cause unknown')
        return WARN, f'outside the optimal zone: {cause}'
    validity = state.estimate.validity
    if validity is PointValidity.NO_INPUT:
        return STALE, _NOT_JUDGED[validity]
    still = Gate.STANDSTILL in state.verdict.gates
    if validity is not PointValidity.VALID and not (still and validity in _OF_STANDSTILL):
        return WARN, _NOT_JUDGED[validity]
    if state.level is Level.OK:
        return OK, 'standstill' if still else 'optimal'
    return WARN, f'{"standstill, " if still else ""}not judged for long enough yet'


def _inputs(inputs: tuple[Health, ...]) -> StatusSummary:
    """Return one sentence for each fault, with what mends it; the worst kind of fault alone."""
    faults = [_fault(health) for health in inputs if health.state in _INPUT_WORDS]
    if faults:
        return STALE, ', '.join(faults)
    for happens, text in _TROUBLES:
        names = [health.source.name.lower() for health in inputs if happens(health)]
        if names:
            return WARN, f'{" and ".join(names)} {text}'
    return OK, 'all inputs arrive'


def _fault(health: Health) -> str:
    words = _INPUT_WORDS[health.state]
    if health.state is InputState.BAD and health.why in _REFUSED:
        words += f': {_REFUSED[health.why]}'
    return f'{health.source.name.lower()} {words}'


def _lubrication_values(state: State) -> list[tuple[str, object]]:
    point, result, totals = state.point, state.estimate, state.totals
    film_ratio = math.nan if result.numbers is None else result.numbers.film_ratio
    return [
        ('Level', state.level.name),
        ('Zone', state.verdict.zone.name),
        ('Validity', result.validity.name),
        ('Reason', result.reason),
        ('Regime', result.regime.name),
        ('Contact', result.contact_state.name),
        ('Event', state.event_id),
        ('Speed [rad/s]', point.speed),
        ('Axial load [N]', point.axial_load),
        ('Oil temperature [degC]', celsius(point.temperature)),
        ('Efficiency [-]', result.efficiency),
        ('Efficiency limit [-]', state.limits.efficiency),
        ('RCS [-]', result.rcs),
        ('RCS limit [-]', state.limits.rcs),
        ('Film ratio [-]', film_ratio),
        ('Judged [-]', state.judged),
        ('Running time [s]', seconds(totals.running_time)),
        ('Time outside [s]', seconds(totals.outside_time)),
        ('Energy lost [J]', totals.energy_lost),
    ]


def _input_values(inputs: tuple[Health, ...]) -> list[tuple[str, object]]:
    values: list[tuple[str, object]] = []
    for health in inputs:
        name = health.source.name.capitalize()
        values += [
            (f'{name} state', health.state.name),
            (f'{name} age [s]', health.age),
            (f'{name} rate [Hz]', health.rate),
            (f'{name} received [-]', health.received),
            (f'{name} dropped [-]', health.dropped),
            (f'{name} lost [-]', 'unknown' if health.lost is None else health.lost),
            (f'{name} stamps', health.stamp_source.name),
            (f'{name} lag [s]', health.lag),
            (f'{name} refused', health.refusal),
        ]
    return values


def _surface_values(surface: Surface) -> list[tuple[str, object]]:
    ranges = (
        ('Speed', 'rad/s', surface.speed_range),
        ('Opposing load', 'N', surface.load_range),
        ('Oil temperature', 'degC', tuple(celsius(limit) for limit in surface.temperature_range)),
    )
    return [
        ('Screw', surface.screw_name),
        ('Oil', surface.oil_name),
        ('Tier', surface.tier),
        ('SHA-256', surface.sha256),
        ('Corrections [-]', len(surface.corrections)),
    ] + [
        (f'{name} {end} [{unit}]', value)
        for name, unit, pair in ranges
        for end, value in zip(('min', 'max'), pair)
    ]


def _values(pairs: list[tuple[str, object]]) -> list[KeyValue]:
    return [
        KeyValue(key=key, value=f'{value:.6g}' if isinstance(value, float) else str(value))
        for key, value in pairs
    ]
