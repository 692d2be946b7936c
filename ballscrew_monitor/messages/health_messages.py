# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Health as a message and as a diagnostic, where `warning.policy` decides whether it warns.

What is not known is no warning: its status is OK with a sentence.

"""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.records import Cause, Condition, Health, Quantity
from ballscrew_monitor.health.words import NOT_ASSESSED
from ballscrew_monitor.messages.diagnostics import hardware_id, key_values, OK, WARN
from ballscrew_monitor.messages.state_messages import fill_time
from ballscrew_msgs import msg
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus

_CODES = {
    Condition.UNKNOWN: Fault.NOT_KNOWN,
    Condition.NORMAL: Fault.NONE,
    Condition.WORSE: Fault.WORSE,
    Condition.SLIGHTLY_CHANGED: Fault.NONE,
}


def warns(health: Health, policy: WarningPolicy) -> bool:
    """Return True if a change of an axis is to be warned of."""
    return health.condition is Condition.WORSE and policy.of_change


def stamp_of(time: Time) -> int:
    """Return the stamp [ns] of a time."""
    return int(time.sec) * SECOND + int(time.nanosec)


def health_message(health: Health, *, surface_id: str, policy: WarningPolicy) -> msg.AxisHealth:
    """Return what is said of an axis as a message; `surface_id` begins the hash of its surface."""
    message = msg.AxisHealth(
        axis=health.axis,
        condition=int(health.condition),
        warning=warns(health, policy),
        verdict=health.verdict,
        advice=health.advice,
        quantities=[_quantity(quantity) for quantity in health.quantities],
        causes=[_cause(cause) for cause in health.causes],
        notes=list(health.notes),
        surface_id=surface_id,
    )
    message.header.frame_id = health.axis
    fill_time(message.header.stamp, health.stamp)
    fill_time(message.since, health.since)
    if health.baseline is not None:
        fill_time(message.baseline_begin, health.baseline.begin)
        fill_time(message.baseline_end, health.baseline.end)
        message.baseline_reason = health.baseline.reason
    return message


def health_status(
    node: str,
    axis: str,
    screw: str,
    health: Health | None,
    policy: WarningPolicy,
    *,
    problem: str = '',
) -> DiagnosticStatus:
    """
    Return the status of health of an axis of the `node`, by full name, with a `screw`.

    None: nothing has been assessed yet; `problem` is why it cannot be followed now.

    """
    status = DiagnosticStatus(name=f'{node.lstrip("/")}: {axis}: Health', level=OK)
    status.hardware_id = hardware_id(node, axis, screw)
    if health is None:
        status.message = f'not known: {problem or NOT_ASSESSED}'
        code = Fault.NOT_FOLLOWED if problem else Fault.NOT_KNOWN
        status.values = key_values([('Code', int(code))])
        return status
    status.level = WARN if warns(health, policy) else OK
    status.message = f'{health.verdict} Not followed now: {problem}' if problem else health.verdict
    code = Fault.NOT_FOLLOWED if problem else _CODES[health.condition]
    status.values = key_values([('Code', int(code)), *_values(health)])
    return status


def _values(health: Health) -> list[tuple[str, object]]:
    values: list[tuple[str, object]] = [
        ('Condition', health.condition.name),
        ('Advice', health.advice),
        ('Baseline', health.baseline.reason if health.baseline else ''),
    ]
    for quantity in health.quantities:
        for end, value in (('', quantity.value), (' low', quantity.low), (' high', quantity.high)):
            values.append((f'{quantity.name.capitalize()}{end} [{quantity.unit}]', value))
    return values + [(f'Note {at}', note) for at, note in enumerate(health.notes, start=1)]


def _quantity(quantity: Quantity) -> msg.HealthQuantity:
    return msg.HealthQuantity(
        name=quantity.name,
        unit=quantity.unit,
        value=float(quantity.value),
        low=float(quantity.low),
        high=float(quantity.high),
        confidence=float(quantity.confidence),
        evidence=quantity.evidence,
        reason=quantity.reason,
    )


def _cause(cause: Cause) -> msg.HealthCause:
    return msg.HealthCause(
        code=int(cause.code),
        size=_quantity(cause.size),
        weight=float(cause.weight),
        excluded=bool(cause.excluded),
        text=cause.text,
    )
