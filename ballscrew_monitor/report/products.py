# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a report leaves beside its page: events as a table, and all that it says as JSON."""

from collections.abc import Iterable, Mapping
import dataclasses
import math
from pathlib import Path
import shutil
from typing import Any

from ballscrew_monitor.report.case import AxisCase, LogCase
from ballscrew_monitor.report.inputs_seen import inputs_seen, InputSeen
from ballscrew_monitor.report.logs import EVENTS, JUDGED, PAGE, PICTURE, STATES, SUMMARY
from ballscrew_monitor.report.verdict import AxisVerdict, verdicts_of
from surrogate.files import json_text, replace_file
from surrogate.tasks.table import write_table


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class EventRow:
    """
    An event as a line of a table: start [ns] and [s], duration [s], values [-].

    Speed [rad/s] and axial load [N] that raised it, and those that the advice names, nan for none.

    """

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
    speed_rad_s: float
    axial_load_N: float
    target_speed_rad_s: float
    target_load_N: float
    advice: str


def replace_report(made: Path, out: Path) -> None:
    """
    Let the page and the products in `made` take the place of those in `out`.

    Products without a page look like recordings: the old ones go before the page is replaced, the
    new ones come after it. So whatever stops it, none is beside a page that is not its own.

    """
    products = {path.relative_to(made) for path in made.rglob('*') if path.is_file()} - {
        Path(PAGE)
    }
    for name in {*products, Path(PICTURE)}:
        (out / name).unlink(missing_ok=True)
    (made / PAGE).replace(out / PAGE)
    for name in products:
        (out / name).parent.mkdir(exist_ok=True)
        (made / name).replace(out / name)


def remove_report(out: Path) -> None:
    """Remove a report from `out`, its page last."""
    shutil.rmtree(out / JUDGED, ignore_errors=True)
    for name in (STATES, EVENTS, SUMMARY, PICTURE, PAGE):
        (out / name).unlink(missing_ok=True)


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
                speed_rad_s=event.speed,
                axial_load_N=event.axial_load,
                target_speed_rad_s=event.target_speed,
                target_load_N=event.target_load,
                advice=event.advice,
            )


def write_summary(path: Path, log: LogCase) -> None:
    """Write what the report says, as strict JSON."""
    replace_file(path, json_text(summary_record(log)).encode())


def summary_record(log: LogCase) -> dict[str, Any]:
    """Return what the report says as plain data; a number that is not known has a reason."""
    return {
        'log': log.name,
        'parameters': log.parameters,
        'unjudged_axes': log.unjudged,
        'axes': _axis_records(log),
        'assumptions': {key: dict(one) for key, one in log.assumptions.items()},
        'notes': list(log.notes),
    }


def _axis_records(log: LogCase) -> dict[str, Any]:
    """Return the records of all axes; an axis without rows is None, with its reason."""
    verdicts = verdicts_of(log)
    count = len(log.axes)
    records: dict[str, Any] = {
        case.axis: axis_record(case, verdict)
        for case, verdict in zip(log.axes, verdicts[:count], strict=True)
    }
    for axis, verdict in zip(log.empty, verdicts[count:], strict=True):
        records |= without(axis, verdict.sentence)
    return records


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
        **(
            without('totals', 'no state was reached')
            if summary is None
            else {'totals': _totals(summary.record())}
        ),
        'energy_lost_by_zone_J': {
            zone.name.lower(): energy for zone, energy in survey.energy.items()
        },
        'time_by_reason_s': {reason.name.lower(): time for reason, time in survey.reasons.items()},
        'time_without_rows_s': survey.rest,
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
    why = 'no valid sample was received' if seen.place else 'the input is not recorded'
    return {
        'source': seen.origin,
        'measured': seen.measured,
        'read_from': seen.place,
        'unit': seen.unit,
        'rate_assumed': seen.rate_assumed,
        'received': seen.received,
        'refused': seen.refused,
        'left_out': seen.left_out,
        'gaps': {'count': seen.gaps.count, 'time_s': seen.gaps.time},
        'slow': seen.slow,
        'hints': list(seen.hints),
        **_loss(seen),
        **known({'lag_s': seen.lag}, 'its messages bear no stamp' if seen.received else why),
        **known({'lowest': seen.low, 'highest': seen.high, 'rate_Hz': seen.rate}, why),
    }


def _loss(seen: InputSeen) -> dict[str, Any]:
    """Return how many messages were lost, or why that is not known."""
    if seen.lost is not None:
        return {'lost': seen.lost}
    why = 'its publishers do not number them' if seen.numbered else 'the recording does not tell'
    return without('lost', why)


def without(name: str, reason: str) -> dict[str, Any]:
    """Return nothing by a name, and the reason of that."""
    return {name: None, f'{name}_reason': reason}


def known(numbers: Mapping[str, float], reason: str) -> dict[str, Any]:
    """Return numbers, and for each that is not finite its reason."""
    return dict(numbers) | {
        f'{name}_reason': reason for name, value in numbers.items() if not math.isfinite(value)
    }
