# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
States as diagnostic_msgs: three statuses for each axis.

A status begins as an ERROR that says that nothing was set, and every case that is not known to be
good stays above OK. Messages hold no measured numbers, so that a new message is a change worth
publishing; numbers are values, with the unit in brackets.

"""

from collections.abc import Mapping, Sequence
import math
from typing import NamedTuple

from ballscrew_monitor.core.conversions import (
    celsius,
    clock_text,
    Direction,
    kelvin,
    opposing_load,
    SECOND,
    seconds,
)
from ballscrew_monitor.core.fault_codes import cause_code, Fault
from ballscrew_monitor.core.inputs import InputSample, InputState, InputStatus, Refusal, Source
from ballscrew_monitor.core.judgement import (
    Code,
    ContactState,
    Gate,
    Level,
    PointSource,
    PointValidity,
    WarningPolicy,
    Zone,
)
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.core.vitals import VitalSigns
from ballscrew_monitor.health.assess import CHANGED
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.health.words import normal_answer
from ballscrew_monitor.judge.certainty import Outside, outside_of
from ballscrew_monitor.messages import reasons
from ballscrew_monitor.messages.reasons import Standing
from ballscrew_msgs.msg import BallScrewState
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from surrogate.surface import Regime, Surface

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE
CLOCK_STANDS = (
    'the clock stands still, nothing is seen to go stale: play /clock, or unset use_sim_time'
)
KEPT = 'sums, events and corrections are kept'
USUAL_EVENTS = 'Usual events'
"""Key of the numbers of warnings that the baseline of the axis already had."""
NO_NEWS = '; usual for this axis'
NO_WARNING = '; no warning, by warning.policy'
RECORDED = 'what the node hears and says is recorded'
IN_TIME = 'the node keeps up'
BUSY = (
    'the node uses up one processor, messages may be lost: lower their rate, raise '
    'publish_period, or give some axes a node of their own'
)
CLOCK_SET = 'the clock of the node was set {}; no duration holds the step'
CLOCK_NOT_SET = f'{Fault.CLOCK_NOT_SET.text}: {Fault.CLOCK_NOT_SET.cure}'
TWO_NODES = (
    'another node of this name runs on {} and publishes on the same topics: give one of both '
    'another name or namespace'
)
HOST, NODE_PART = 'Host', 'Node'
PARTS = ('Lubrication', 'Inputs', 'Surface')
LONGEST_CODE = 10  # characters of a code; more are none
Inputs = tuple[InputStatus, ...]


class StatusSummary(NamedTuple):
    """Level, message and code of a status."""

    level: bytes
    message: str
    code: Fault = Fault.NONE


_NOT_JUDGED = {
    PointValidity.UNKNOWN: Fault.NOT_MOVED,
    PointValidity.SPEED_BELOW_RANGE: Fault.SPEED_BELOW,
    PointValidity.SPEED_ABOVE_RANGE: Fault.SPEED_ABOVE,
    PointValidity.LOAD_OUT_OF_RANGE: Fault.LOAD_OUTSIDE,
    PointValidity.TEMPERATURE_OUT_OF_RANGE: Fault.TEMPERATURE_OUTSIDE,
    PointValidity.MASKED: Fault.MASKED,
    PointValidity.NO_INPUT: Fault.NO_INPUT,
    PointValidity.NO_SURFACE: Fault.NO_SURFACE,
}
# Nothing is wrong with these at standstill.
_OF_STANDSTILL = (PointValidity.UNKNOWN, PointValidity.SPEED_BELOW_RANGE)
_LEVELS = {Standing.GOOD: OK, Standing.DEGRADED: WARN, Standing.LOST: STALE}


def failed(
    node: str, axis: str, reason: str, code: Fault = Fault.NOT_CONFIGURED
) -> list[DiagnosticStatus]:
    """Return the statuses of an axis that cannot work for a `reason`; `node` is its full name."""
    parts = [DiagnosticStatus(name=f'{node.lstrip("/")}: {axis}: {part}') for part in PARTS]
    for status in parts:
        _say(status, StatusSummary(ERROR, reason, code))
    return parts


def code_of(status: DiagnosticStatus) -> int:
    """Return the code of the fault that a diagnostic status states, 0 for none."""
    texts = [pair.value for pair in status.values if pair.key == 'Code']
    codes = [int(text) for text in texts if len(text) < LONGEST_CODE and text.isdecimal()]
    return codes[0] if codes else 0


def usual_of(status: DiagnosticStatus) -> frozenset[int]:
    """Return the numbers of the warnings that the baseline of an axis already had."""
    texts = ' '.join(pair.value for pair in status.values if pair.key == USUAL_EVENTS).split()
    return frozenset(int(text) for text in texts if len(text) < LONGEST_CODE and text.isdecimal())


def _say(status: DiagnosticStatus, summary: StatusSummary) -> None:
    """Let a status say something; its code is its first value."""
    status.level, status.message = summary.level, summary.message
    status.values = [*key_values([('Code', int(summary.code))]), *status.values[1:]]


def of_folder(node: str, problem: str) -> DiagnosticStatus:
    """Return the status of what the `node`, by full name, keeps on the disk."""
    return _of_node(node, 'State directory', problem, KEPT, Fault.NOT_KEPT)


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
    return _of_node(node, 'Recording', problem, RECORDED, Fault.NOT_RECORDED)


def of_node(
    node: str,
    signs: VitalSigns,
    step: int = 0,
    hosts: Sequence[str] = (),
    *,
    is_clock_set: bool = True,
) -> DiagnosticStatus:
    """
    Return the status of the `node` itself, by full name.

    `step` [ns] is by how much its clock was set not long ago, 0: it was not; `is_clock_set`
    whether it ever was; `hosts` are those of the nodes of this name, its own first.

    """
    problem, code = BUSY if signs.is_busy else '', Fault.BUSY
    clock = CLOCK_SET.format('forward' if step > 0 else 'back') if step else ''
    if clock or not is_clock_set:
        code = Fault.CLOCK_SET if step else Fault.CLOCK_NOT_SET
        problem = '; '.join(filter(None, [clock or CLOCK_NOT_SET, problem]))
    status = _of_node(node, NODE_PART, problem, IN_TIME, code)
    if others := ', '.join(hosts[1:]):
        _say(status, StatusSummary(ERROR, TWO_NODES.format(others), Fault.TWO_NODES))
    status.values += key_values(
        [
            *((HOST, host) for host in hosts if others),
            ('Loop time [s]', signs.loop_time),
            ('Queue depth [-]', signs.queue_depth),
            ('Processor share [-]', signs.processor_share),
            *([('Clock step [s]', seconds(step))] if step else []),
        ]
    )
    return status


def _of_node(node: str, part: str, problem: str, fine: str, code: Fault) -> DiagnosticStatus:
    status = DiagnosticStatus(name=f'{node.lstrip("/")}: {part}')
    _say(status, StatusSummary(WARN, problem, code) if problem else StatusSummary(OK, fine))
    return status


def hardware_id(node: str, axis: str, screw: str) -> str:
    """Return what tells the screws of all axes in all namespaces apart."""
    namespace = node.lstrip('/').rpartition('/')[0]
    return f'{namespace}/{axis}: {screw}'.lstrip('/')


def statuses(
    node: str,
    axis: str,
    state: BallScrewState | None,
    inputs: Inputs,
    cause: Code,
    surface: Surface,
    *,
    links: Mapping[Source, Link] | None,
    clock_stands: bool = False,
    refused: str = '',
    defect: str = '',
    policy: WarningPolicy = WarningPolicy.ZONE,
    usual: Sequence[int] = (),
    health: Health | None = None,
    advice: str = '',
) -> list[DiagnosticStatus]:
    """
    Return the three statuses of a configured axis of the `node`, by full name.

    `state` is its last one, if there is one, with its `inputs`; `cause` is that of its event;
    `links` says how each input is connected, None: the node is inactive; `refused` why the
    surface was not reloaded; `defect` is a sentence about one of the program; `policy` what is
    warned of; `usual` has the numbers of the warnings that the baseline already had; `health` is
    the last assessment, and `advice` what to do about the last warning.
    While the clock stands no state tells that an input is dead, so nothing but a warning is held.

    """
    parts = failed(node, axis, Fault.NOT_SET.text, Fault.NOT_SET)
    for status in parts:
        status.hardware_id = hardware_id(node, axis, surface.screw_name)
    changed = ' and corrected' if surface.corrections else ''
    _say(parts[2], StatusSummary(OK, f'{surface.tier} surface loaded{changed}'))
    if refused:
        code = Fault.RELOAD_REFUSED
        _say(parts[2], StatusSummary(WARN, f'{code.text}: {refused}', code))
    parts[2].values += key_values(_surface_values(surface))
    matched = {source.name.capitalize(): link.matched for source, link in (links or {}).items()}
    parts[1].values += key_values(
        [(f'{name} publishers [-]', count) for name, count in matched.items()]
    )
    if state is None or links is None:
        why = Fault.CLOCK_STANDS if clock_stands else Fault.NOTHING_YET
        for status in parts[:2]:
            _say(status, _stale(Fault.INACTIVE if links is None else why))
    else:
        known = state.event_id in usual
        both = summaries(state, inputs, cause, links, policy, usual=known)
        for status, verdict in zip(parts, both):
            _say(status, verdict)
        if clock_stands:
            warns = state.level == Level.WARN and _warns(policy, usual=known)
            for status in parts[1:2] if warns else parts[:2]:
                _say(status, _stale(Fault.CLOCK_STANDS))
        values = _lubrication_values(state, surface, usual, health, advice)
        parts[0].values += key_values([*values, *_with_drag(state, surface)])
        parts[1].values += key_values(_input_values(inputs))
    if defect:
        _say(parts[0], StatusSummary(ERROR, defect, Fault.PROGRAM_FAILED))
    return parts


def _stale(code: Fault) -> StatusSummary:
    """Return that nothing is known because of a fault; the sentence of the clock has its cure."""
    return StatusSummary(STALE, CLOCK_STANDS if code is Fault.CLOCK_STANDS else code.text, code)


def summaries(
    state: BallScrewState,
    inputs: Inputs,
    cause: Code,
    links: Mapping[Source, Link],
    policy: WarningPolicy = WarningPolicy.ZONE,
    *,
    usual: bool = False,
) -> tuple[StatusSummary, StatusSummary]:
    """
    Return what Lubrication and Inputs say; only a change of it is news.

    `usual`: the baseline of the axis already had the warning.

    """
    standing, text, code = reasons.summary(state.axis, inputs, links)
    derived = any(status.state is InputState.DERIVED for status in inputs)
    fault = cause_code(cause)
    lubrication = _lubrication(state, fault, policy, derived=derived, usual=usual)
    return lubrication, StatusSummary(_LEVELS[standing], text, code)


def _lubrication(
    state: BallScrewState, cause: Fault, policy: WarningPolicy, *, derived: bool, usual: bool
) -> StatusSummary:
    """Return what is said of the lubrication; a warning that is not to call keeps its code."""
    if state.level == Level.WARN and not state.shelved:
        if _warns(policy, usual=usual):
            return StatusSummary(WARN, cause.text, cause)
        why = NO_NEWS if usual else NO_WARNING
        return StatusSummary(OK, f'{cause.text}{why}', cause)
    validity = PointValidity(state.result.validity)
    still = Gate.STANDSTILL in state.active_gates
    code = _NOT_JUDGED.get(validity, Fault.NONE)
    if code is Fault.NO_INPUT:
        return StatusSummary(STALE, code.text, code)
    if code is Fault.NOT_MOVED and derived and not still:
        return StatusSummary(WARN, Fault.NOT_DERIVED.text, Fault.NOT_DERIVED)
    if code and not (still and validity in _OF_STANDSTILL):
        return StatusSummary(WARN, code.text, code)
    if state.level == Level.WARN:
        until = clock_text(state.shelved_until.sec * SECOND + state.shelved_until.nanosec)
        return StatusSummary(OK, f'shelved until {until}: {state.shelve_reason}', cause)
    if state.level == Level.OK:
        return StatusSummary(OK, 'standstill' if still else 'optimal')
    if still:  # nothing is amiss with an axis that has been parked since it was switched on
        return StatusSummary(OK, 'standstill, not judged for long enough yet')
    return StatusSummary(WARN, Fault.TOO_SHORT.text, Fault.TOO_SHORT)


def _warns(policy: WarningPolicy, *, usual: bool) -> bool:
    """Return True if a point outside the zone is warned of: who asks for changes, of new ones."""
    return policy.of_zone and not (usual and policy.of_change)


def outside_now(state: BallScrewState, surface: Surface) -> Outside:
    """Return how surely the point of a state is outside the zone."""
    point, result = state.point, state.result
    light = Gate.LIGHT_LOAD in state.active_gates
    return outside_of(
        state.zone,
        surface,
        rcs_limit=state.rcs_limit,
        efficiency_limit=state.efficiency_limit,
        speed=abs(point.speed),
        load=opposing_load(point.axial_load, Direction(point.direction)),
        temperature=kelvin(point.temperature),
        efficiency=math.nan if light else result.efficiency,
    )


def _with_drag(state: BallScrewState, surface: Surface) -> list[tuple[str, object]]:
    """Return what the efficiency is with the drag of typical nuts, until it is identified."""
    point = state.point
    load = opposing_load(point.axial_load, Direction(point.direction))
    drag = surface.with_typical_drag(state.result.friction_torque, load)
    if not drag:
        return []
    low, middle, high = sorted(drag['efficiency'].values())
    return [('Efficiency with typical drag [-]', f'{middle:.3g} ({low:.3g} to {high:.3g})')]


def _lubrication_values(
    state: BallScrewState,
    surface: Surface,
    usual: Sequence[int],
    health: Health | None,
    advice: str,
) -> list[tuple[str, object]]:
    """Return whether the axis is normal, is outside the zone, and what to do; then numbers."""
    point, result, totals = state.point, state.result, state.totals
    outside = outside_now(state, surface)
    remedy = '' if outside is Outside.NOT else advice
    if not remedy and health is not None and health.condition in CHANGED:
        remedy = health.advice
    return [
        ('Normal', normal_answer(health)),
        ('Outside the zone', outside.value),
        ('What to do', remedy),
        (USUAL_EVENTS, ' '.join(map(str, usual))),
        ('Level', Level(state.level).name),
        ('Zone', Zone(state.zone).name),
        ('Validity', PointValidity(result.validity).name),
        ('Reason', result.reason),
        ('Regime', Regime(result.regime).name),
        ('Contact', ContactState(result.contact_state).name),
        ('Event', state.event_id),
        ('Speed [rad/s]', point.speed),
        ('Axial load [N]', point.axial_load),
        ('Axial load from', PointSource(point.axial_load_source).name),
        ('Axial load uncertainty [N]', point.axial_load_uncertainty),
        ('Oil temperature [degC]', point.temperature),
        ('Efficiency [-]', result.efficiency),
        ('Efficiency limit [-]', state.efficiency_limit),
        ('RCS [-]', result.rcs),
        ('RCS limit [-]', state.rcs_limit),
        ('Film ratio [-]', result.film_ratio),
        ('Judged [-]', state.judged),
        ('Running time [s]', totals.running_time),
        ('Time outside [s]', totals.outside_time),
        ('Energy lost [J]', totals.energy_lost),
    ]


def _input_values(inputs: Inputs) -> list[tuple[str, object]]:
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
