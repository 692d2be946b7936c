# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
States as diagnostic_msgs: three statuses for each axis.

A status begins as an ERROR that says that nothing was set, and every case that is not known to be
good stays above OK. Messages hold no measured numbers, so that a new message is a change worth
publishing; numbers are values, with the unit in brackets.

"""

from collections.abc import Mapping

from ballscrew_monitor.core.conversions import celsius, clock_text, seconds
from ballscrew_monitor.core.estimate import PointValidity
from ballscrew_monitor.core.inputs import InputSample, InputStatus, Refusal, Source
from ballscrew_monitor.core.judgement import Code, Gate, Level, WarningPolicy
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.core.state import Event, State
from ballscrew_monitor.core.vitals import VitalSigns
from ballscrew_monitor.messages import reasons
from ballscrew_monitor.messages.reasons import Standing
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from surrogate.surface import Surface

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE
NOT_SET = 'no message was set'
NOTHING_YET = 'nothing has been judged yet'
CLOCK_STANDS = (
    'the clock stands still, nothing is seen to go stale: play /clock, or unset use_sim_time'
)
NOT_DERIVED = 'not judged: the motor torque does not tell the load here'
INACTIVE = 'the node is inactive, nothing is judged'
KEPT = 'sums, events and corrections are kept'
NO_WARNING = '; no warning, by warning.policy'
RECORDED = 'what the node hears and says is recorded'
IN_TIME = 'the node keeps up'
BUSY = (
    'the node uses up one processor, messages may be lost: lower their rate, raise '
    'publish_period, or give some axes a node of their own'
)
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
# Nothing is wrong with these at standstill.
_OF_STANDSTILL = (PointValidity.UNKNOWN, PointValidity.SPEED_BELOW_RANGE)
_CAUSES = {
    Code.RCS_HIGH: 'asperities carry too much',
    Code.EFFICIENCY_LOW: 'too much power is lost',
}
_LEVELS = {Standing.GOOD: OK, Standing.DEGRADED: WARN, Standing.LOST: STALE}


def failed(node: str, axis: str, reason: str) -> list[DiagnosticStatus]:
    """Return the statuses of an axis that cannot work for `reason`; `node` is its full name."""
    return [
        DiagnosticStatus(name=f'{node.lstrip("/")}: {axis}: {part}', level=ERROR, message=reason)
        for part in PARTS
    ]


def of_folder(node: str, problem: str) -> DiagnosticStatus:
    """Return the status of what the `node`, by full name, keeps on the disk."""
    return _of_node(node, 'State directory', problem, KEPT)


def defect_text(error: Exception, event: InputSample | Refusal | int | str) -> str:
    """Return that the program failed at a sample, a refusal, a tick or else, and at which."""
    if isinstance(event, str):
        place = event
    elif isinstance(event, int):
        place = f'a tick at {event} ns'
    else:
        value = f'{event.value!r} (SI)' if isinstance(event, InputSample) else 'refused'
        place = f'the {event.source.name.lower()} {value} that arrived at {event.arrival} ns'
    return (
        f'the program failed at {place}: {type(error).__name__}: {error}; report this line, and '
        'configure the node again to clear it'
    )


def recording(node: str, problem: str) -> DiagnosticStatus:
    """Return the status of the recording of the `node`; `problem` is why there is none."""
    return _of_node(node, 'Recording', problem, RECORDED)


def of_node(node: str, signs: VitalSigns) -> DiagnosticStatus:
    """Return the status of the `node` itself, by full name."""
    status = _of_node(node, 'Node', BUSY if signs.is_busy else '', IN_TIME)
    status.values = key_values(
        [
            ('Loop time [s]', signs.loop_time),
            ('Queue depth [-]', signs.queue_depth),
            ('Processor share [-]', signs.processor_share),
        ]
    )
    return status


def _of_node(node: str, part: str, problem: str, fine: str) -> DiagnosticStatus:
    name, level = f'{node.lstrip("/")}: {part}', WARN if problem else OK
    return DiagnosticStatus(name=name, level=level, message=problem or fine)


def hardware_id(node: str, axis: str, screw: str) -> str:
    """Return what tells the screws of all axes in all namespaces apart."""
    namespace = node.lstrip('/').rpartition('/')[0]
    return f'{namespace}/{axis}: {screw}'.lstrip('/')


def statuses(
    node: str,
    axis: str,
    state: State | None,
    event: Event,
    surface: Surface,
    *,
    links: Mapping[Source, Link] | None,
    clock_stands: bool = False,
    refused: str = '',
    defect: str = '',
    policy: WarningPolicy = WarningPolicy.ZONE,
) -> list[DiagnosticStatus]:
    """
    Return the three statuses of a configured axis of the `node`, by full name.

    `state` is its last one, if there is one; `links` says how each input is connected, None: the
    node is inactive; `refused` why the surface was not reloaded; `defect` is a sentence about one
    of the program; `policy` what is warned of.
    While the clock stands no state tells that an input is dead, so nothing but a warning is held.

    """
    made = failed(node, axis, NOT_SET)
    for status in made:
        status.hardware_id = hardware_id(node, axis, surface.screw_name)
    changed = ' and corrected' if surface.corrections else ''
    made[2].level, made[2].message = OK, f'{surface.tier} surface loaded{changed}'
    if refused:
        made[2].level = WARN
        made[2].message = f'kept the old surface, the reload is refused: {refused}'
    made[2].values = key_values(_surface_values(surface))
    matched = {source.name.capitalize(): link.matched for source, link in (links or {}).items()}
    made[1].values = key_values(
        [(f'{name} publishers [-]', count) for name, count in matched.items()]
    )
    if state is None or links is None:
        why = CLOCK_STANDS if clock_stands else NOTHING_YET
        for status in made[:2]:
            status.level, status.message = STALE, INACTIVE if links is None else why
    else:
        for status, (level, message) in zip(made, summaries(state, event, links, policy)):
            status.level, status.message = level, message
        if clock_stands:
            warns = state.level is Level.WARN and policy.of_zone
            for status in made[1:2] if warns else made[:2]:
                status.level, status.message = STALE, CLOCK_STANDS
        made[0].values = key_values(_lubrication_values(state))
        made[1].values = [*made[1].values, *key_values(_input_values(state.inputs))]
    if defect:
        made[0].level, made[0].message = ERROR, defect
    return made


def summaries(
    state: State,
    event: Event,
    links: Mapping[Source, Link],
    policy: WarningPolicy = WarningPolicy.ZONE,
) -> tuple[StatusSummary, StatusSummary]:
    """Return level and message of Lubrication and Inputs; only a change of them is news."""
    standing, text = reasons.summary(state.axis, state.inputs, links)
    return _lubrication(state, event, policy), (_LEVELS[standing], text)


def _lubrication(state: State, event: Event, policy: WarningPolicy) -> StatusSummary:
    shelved = state.shelving.until != 0
    if state.level is Level.WARN and not shelved:
        cause = _CAUSES.get(event.cause.code, 'cause unknown')
        text = f'outside the optimal zone: {cause}'
        return (WARN, text) if policy.of_zone else (OK, f'{text}{NO_WARNING}')
    validity = state.estimate.validity
    if validity is PointValidity.NO_INPUT:
        return STALE, _NOT_JUDGED[validity]
    still = Gate.STANDSTILL in state.verdict.gates
    if validity is PointValidity.UNKNOWN and state.point.derived is not None and not still:
        return WARN, NOT_DERIVED
    if validity is not PointValidity.VALID and not (still and validity in _OF_STANDSTILL):
        return WARN, _NOT_JUDGED[validity]
    if state.level is Level.WARN:
        return OK, f'shelved until {clock_text(state.shelving.until)}: {state.shelving.reason}'
    if state.level is Level.OK:
        return OK, 'standstill' if still else 'optimal'
    if still:  # nothing is amiss with an axis that has been parked since it was switched on
        return OK, 'standstill, not judged for long enough yet'
    return WARN, 'not judged for long enough yet'


def _lubrication_values(state: State) -> list[tuple[str, object]]:
    point, result, totals = state.point, state.estimate, state.totals
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
        ('Axial load from', point.axial_load_source.name),
        ('Axial load uncertainty [N]', point.axial_load_uncertainty),
        ('Oil temperature [degC]', celsius(point.temperature)),
        ('Efficiency [-]', result.efficiency),
        ('Efficiency limit [-]', state.limits.efficiency),
        ('RCS [-]', result.rcs),
        ('RCS limit [-]', state.limits.rcs),
        ('Film ratio [-]', result.film_ratio),
        ('Judged [-]', state.judged),
        ('Running time [s]', seconds(totals.running_time)),
        ('Time outside [s]', seconds(totals.outside_time)),
        ('Energy lost [J]', totals.energy_lost),
    ]


def _input_values(inputs: tuple[InputStatus, ...]) -> list[tuple[str, object]]:
    values: list[tuple[str, object]] = []
    for status in inputs:
        name = status.source.name.capitalize()
        values += [
            (f'{name} state', status.state.name),
            (f'{name} age [s]', status.age),
            (f'{name} rate [Hz]', status.rate),
            (f'{name} received [-]', status.received),
            (f'{name} dropped [-]', status.dropped),
            (f'{name} lost [-]', 'unknown' if status.lost is None else status.lost),
            (f'{name} implausible [-]', status.implausible),
            (f'{name} refused share [-]', status.refused_share),
            (f'{name} stamps', status.stamp_source.name),
            (f'{name} lag [s]', status.lag),
            (f'{name} refused', status.refusal),
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


def key_values(pairs: list[tuple[str, object]]) -> list[KeyValue]:
    """Return values by their names as texts."""
    return [
        KeyValue(key=key, value=f'{value:.6g}' if isinstance(value, float) else str(value))
        for key, value in pairs
    ]
