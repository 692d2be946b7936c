# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a report leaves beside its page: events as a table, and all that it says as JSON."""

from collections.abc import Iterable, Mapping
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.report.case import AxisCase
from ballscrew_monitor.report.inputs_seen import inputs_seen, InputSeen
from ballscrew_monitor.report.log_page import LogCase, verdicts_of
from ballscrew_monitor.report.verdict import AxisVerdict
from surrogate.files import json_text, replace_file
from surrogate.tasks.table import write_table


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class EventRow:
    """An event as a line of a table: start [ns] and [s], duration [s], values [-]."""

    axis: str
    event_id: int
    start_stamp_ns: int
    start_s: float
    duration_s: float
    active: bool
    quantity: str
    relation: str
    limit: float
    worst_value: float
    advice: str


def write_events(path: Path, log: LogCase) -> None:
    """Write the events of all axes, those of an axis in order."""
    write_table(path, EventRow, event_rows(log))


def event_rows(log: LogCase) -> Iterable[EventRow]:
    """Yield the events of all axes, those of an axis in order."""
    for case in log.axes:
        for event in case.outcome.events:
            yield EventRow(
                axis=case.axis,
                event_id=event.event_id,
                start_stamp_ns=event.start,
                start_s=case.since_first(event.start),
                duration_s=event.duration,
                active=event.active,
                quantity=event.quantity,
                relation=event.relation,
                limit=event.limit,
                worst_value=event.worst_value,
                advice=event.advice,
            )


def write_summary(path: Path, log: LogCase) -> None:
    """Write what the report says, as strict JSON."""
    replace_file(path, json_text(summary_record(log)).encode())


def summary_record(log: LogCase) -> dict[str, Any]:
    """Return what the report says as plain data; a number that is not known has a reason."""
    verdicts = verdicts_of(log)
    return {
        'log': log.name,
        'parameters': log.parameters,
        'unjudged_axes': log.unjudged,
        'axes': {
            case.axis: axis_record(case, verdict)
            for case, verdict in zip(log.axes, verdicts, strict=False)
        },
        'assumptions': {key: dict(one) for key, one in log.assumptions.items()},
        'notes': list(log.notes),
    }


def axis_record(case: AxisCase, verdict: AxisVerdict) -> dict[str, Any]:
    """Return what is known of an axis; `<name>_reason` says why a number is missing."""
    summary, survey, surface = case.outcome.summary(), case.survey, case.surface
    torque = 'no torque was measured in motion' if not survey.torque.count else 'not in one way'
    one_way = {'forward': survey.torque.forward, 'backward': survey.torque.backward}
    return {
        'verdict': f'{verdict.word}: {verdict.sentence}',
        'standing': verdict.standing.value,
        'why': verdict.why,
        'what_to_do': verdict.remedy,
        'model': {'tier': surface.tier, 'screw': surface.screw_name, 'oil': surface.oil_name},
        'recorded_s': survey.span,
        'totals': None if summary is None else _totals(summary.record()),
        'energy_lost_by_zone_J': {
            zone.name.lower(): energy for zone, energy in survey.energy.items()
        },
        'time_by_reason_s': {reason.name.lower(): time for reason, time in survey.reasons.items()},
        'gaps': {'count': survey.gap_count, 'time_s': survey.gap_time},
        'torque_residual': known(
            {f'mean_{name}_Nm': value for name, value in one_way.items()}
            | {'rms_Nm': survey.torque.spread},
            torque,
        ),
        'inputs': {one.source.name.lower(): _input_record(one) for one in inputs_seen(case)},
    }


def _totals(record: dict[str, Any]) -> dict[str, Any]:
    """Return totals without the axis, which is named around them."""
    return {key: value for key, value in record.items() if key != 'axis'}


def _input_record(seen: InputSeen) -> dict[str, Any]:
    why = 'no sample was received' if seen.place else 'the input is not recorded'
    return {
        'source': seen.origin,
        'measured': seen.measured,
        'read_from': seen.place,
        'unit': seen.unit,
        'rate_assumed': seen.rate_assumed,
        'received': seen.received,
        'refused': seen.refused,
        'hints': list(seen.hints),
    } | known({'lowest': seen.low, 'highest': seen.high, 'rate_Hz': seen.rate}, why)


def known(numbers: Mapping[str, float], reason: str) -> dict[str, Any]:
    """Return numbers, and for each that is not finite its reason."""
    return dict(numbers) | {
        f'{name}_reason': reason for name, value in numbers.items() if not math.isfinite(value)
    }
