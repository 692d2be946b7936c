# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages of health."""

from ballscrew_monitor.health.records import Cause, Health, Quantity
from ballscrew_monitor.messages.state_messages import fill_time
from ballscrew_msgs import msg


def health_message(health: Health, *, surface_id: str) -> msg.AxisHealth:
    """Return what is said of an axis as a message; `surface_id` begins the hash of its surface."""
    message = msg.AxisHealth(
        axis=health.axis,
        condition=int(health.condition),
        verdict=health.verdict,
        advice=health.advice,
        quantities=[_quantity(one) for one in health.quantities],
        causes=[_cause(one) for one in health.causes],
        notes=list(health.notes),
        surface_id=surface_id,
    )
    message.header.frame_id = health.axis
    fill_time(message.header.stamp, health.stamp)
    if health.baseline is not None:
        fill_time(message.baseline_begin, health.baseline.begin)
        fill_time(message.baseline_end, health.baseline.end)
        message.baseline_reason = health.baseline.reason
    return message


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
        excluded=cause.excluded,
        text=cause.text,
    )
