# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The tables beside the page: every event, and a reason for every number that is missing."""

import contextlib
import csv
import json
from pathlib import Path

from ballscrew_monitor.report.case import LogCase
from ballscrew_monitor.report.products import replace_report, write_events, write_summary
import pytest


def make_log(judged, **changes):
    events = [judged.event(1, 0.1, 0.2), judged.event(2, 0.5, 0.1, active=True)]
    case = judged.case([judged.columns()], events)
    return LogCase(name='log', parameters='my.yaml', axes=[case], **changes)


def test_events_are_a_line_each(judged, tmp_path):
    write_events(tmp_path / 'events.csv', make_log(judged))
    with (tmp_path / 'events.csv').open(newline='', encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    assert [(row['axis'], row['event_id'], row['active']) for row in rows] == [
        ('x', '1', 'False'),
        ('x', '2', 'True'),
    ]
    assert float(rows[1]['start_s']) == 0.5
    assert [float(rows[0][name]) for name in ('speed_rad_s', 'axial_load_N')] == [45.0, -1200.0]
    assert (rows[0]['target_speed_rad_s'], rows[0]['target_load_N']) == ('60.0', 'nan')
    assert int(rows[0]['start_stamp_ns']) == judged.begin + 100_000_000


def test_no_event_is_a_table_without_lines(judged, tmp_path):
    log = LogCase(name='log', parameters='', axes=[judged.case([judged.columns()])])
    write_events(tmp_path / 'events.csv', log)
    assert (tmp_path / 'events.csv').read_text().startswith('axis,event_id,')


def test_the_summary_is_strict_json_with_reasons_for_null(judged, tmp_path):
    def refuse(name):
        raise ValueError(name)

    log = make_log(judged, empty=['y'], assumptions={'x.lead': {'value': 0.01, 'reason': 'usual'}})
    write_summary(tmp_path / 'summary.json', log)
    record = json.loads((tmp_path / 'summary.json').read_text(), parse_constant=refuse)
    assert record['unjudged_axes'] == ['y']
    assert record['assumptions']['x.lead'] == {'value': 0.01, 'reason': 'usual'}
    axis = record['axes']['x']
    assert axis['standing'] == 'bad'
    assert axis['torque_residual']['rms_Nm'] is None
    assert axis['torque_residual']['rms_Nm_reason'] == 'no torque was measured in motion'
    assert record['axes']['y'] is None
    assert axis['inputs']['load']['lost_reason'] == 'the recording does not tell'
    assert axis['inputs']['load']['lag_s_reason'] == 'its messages bear no stamp'
    assert axis['inputs']['load']['gaps'] == {'count': 0, 'time_s': 0.0}
    assert axis['inputs']['torque']['lowest_reason'] == 'the input is not recorded'
    assert len(axis['totals']['events']) == 2
    assert not unexplained(record)


def unexplained(record, path=''):
    """Return where a null has no reason beside it."""
    found = []
    for key, value in record.items():
        if value is None and f'{key}_reason' not in record:
            found.append(f'{path}/{key}')
        elif isinstance(value, dict):
            found += unexplained(value, f'{path}/{key}')
    return found


NAMES = ('report.html', 'summary.json', 'states.parquet', 'judged/judged.mcap')


@pytest.mark.parametrize('there', [False, True])
@pytest.mark.parametrize('steps', range(2 * len(NAMES)))
def test_products_are_never_beside_a_page_that_is_not_their_own(
    tmp_path, monkeypatch, there, steps
):
    made, out = tmp_path / 'made', tmp_path / 'out'
    for folder in (made, out):
        (folder / 'judged').mkdir(parents=True)
        for name in NAMES if there or folder == made else ():
            (folder / name).write_text(folder.name)
    (out / 'judged' / 'notes.txt').write_text('of a user')
    left = iter(range(steps))
    for name in ('replace', 'unlink'):
        monkeypatch.setattr(Path, name, interrupted(getattr(Path, name), left))
    with contextlib.suppress(KeyboardInterrupt):
        replace_report(made, out)
    found = {name: (out / name).read_text() for name in NAMES if (out / name).exists()}
    assert len(set(found.values())) <= 1
    assert not found or 'report.html' in found
    assert (len(found) == len(NAMES) and 'made' in found.values()) == (steps == 2 * len(NAMES) - 1)
    assert (out / 'judged' / 'notes.txt').exists()


def interrupted(change, left):
    """Return a change of a file that is interrupted when no more are left."""

    def changed(*arguments, **options):
        if next(left, None) is None:
            raise KeyboardInterrupt
        return change(*arguments, **options)

    return changed
