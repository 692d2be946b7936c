# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a report leaves beside its page: events as a table, and all that it says as JSON."""

import csv
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.declared import keys, plain
from ballscrew_monitor.recordings.summary import EventRecord
from ballscrew_monitor.report.case import AxisCase, LogCase
from ballscrew_monitor.report.inputs_seen import inputs_seen
from ballscrew_monitor.report.logs import EVENTS, JUDGED, PAGE, PICTURE, STATES, SUMMARY
from ballscrew_monitor.report.verdict import AxisVerdict, verdicts_of
from surrogate.files import json_text, new_file, replace_file


def replace_report(made: Path, out: Path) -> None:
    """
    Let the page and the products in `made` take the place of those in `out`.

    Products without a page look like recordings: the old ones go before the page is replaced, the
    new ones come after it. So whatever stops it, none is beside a page that is not its own.

    """
    products = {path.relative_to(made) for path in made.rglob('*') if path.is_file()} - {
        Path(PAGE)
    }
    stale = {Path(PICTURE)} if (out / PICTURE).exists() else set()
    for name in products | stale:
        (out / name).unlink(missing_ok=True)
    (made / PAGE).replace(out / PAGE)
    for name in products:
        (out / name).parent.mkdir(exist_ok=True)
        (made / name).replace(out / name)


def remove_report(out: Path) -> None:
    """Remove a report from `out`, its page last."""
    judged = (f'{JUDGED}/{JUDGED}.mcap', f'{JUDGED}/metadata.yaml')
    for name in (*judged, STATES, EVENTS, SUMMARY, PICTURE, PAGE):
        (out / name).unlink(missing_ok=True)


def write_events(path: Path, log: LogCase) -> None:
    """Write the events of all axes, those of an axis in order."""
    with new_file(path) as partial, partial.open('w', newline='', encoding='utf-8') as file:
        heads = dict.fromkeys(('axis', 'event_id', 'start_stamp_ns', 'start_s'))
        writer = csv.DictWriter(file, list(heads | keys(EventRecord)), lineterminator='\n')
        writer.writeheader()
        for case in log.axes:
            for event in case.outcome.events:
                more = {'axis': case.axis, 'start_s': case.since_first(event.start)}
                writer.writerow(plain(event) | more)


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
    records: dict[str, Any] = {}
    cases = {case.axis: case for case in log.axes}
    for axis, verdict in zip([*cases, *log.empty], verdicts_of(log), strict=True):
        known = cases.get(axis)
        records |= (
            {axis: axis_record(known, verdict)} if known else without(axis, verdict.sentence)
        )
    return records


def axis_record(case: AxisCase, verdict: AxisVerdict) -> dict[str, Any]:
    """Return what is known of an axis; `<name>_reason` says why a number is missing."""
    summary, survey, surface = case.outcome.summary(), case.survey, case.surface
    return {
        'verdict': verdict.whole,
        'standing': verdict.standing.value,
        'why': verdict.why,
        'what_to_do': verdict.remedy,
        'model': {'tier': surface.tier, 'screw': surface.screw_name, 'oil': surface.oil_name},
        'recorded_s': survey.span,
        **(
            without('totals', 'no state was reached')
            if summary is None
            # Without the axis, which is named around them.
            else {'totals': {key: one for key, one in summary.record().items() if key != 'axis'}}
        ),
        'energy_lost_by_zone_J': plain(survey.energy),
        'time_by_reason_s': plain(survey.reasons),
        'time_without_rows_s': survey.rest,
        'torque_residual': plain(survey.torque),
        'inputs': plain({one.source: one for one in inputs_seen(case)}),
    }


def without(name: str, reason: str) -> dict[str, Any]:
    """Return nothing by a name, and the reason of that."""
    return {name: None, f'{name}_reason': reason}
