# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Words of a terminal about a recording, and its JSON with a reason for every missing number."""

import json
import math

from ballscrew_monitor.core.inputs import Source, Why
from ballscrew_monitor.core.judgement import Reason, Zone
from ballscrew_monitor.report.printed import axis_lines, log_lines, printed_records, summary_record
from ballscrew_msgs.msg import Totals
import numpy as np
from surrogate.files import json_text


def still_case(judged):
    """Return an axis that stood still, its speed in m/s read as mm/s."""
    block = judged.rows(
        speed=0.1 * np.sin(np.arange(100)), zone=Zone.UNKNOWN, reason=Reason.STANDSTILL
    )
    values = judged.values(**{'x.speed.unit': 'mm/s'})
    return judged.case([block], values=values, totals=Totals())


def lines_of(case, head):
    return [line[12:] for line in axis_lines(case) if line.startswith(f'{head} ')]


def test_an_axis_that_never_moves_does_not_read_like_all_is_well(judged, says):
    case = still_case(judged)
    first, *rest = log_lines(judged.log(case))
    assert first == says('100_speed_samples')
    assert rest[0].startswith('  verdict     Not known: axis x never moved')
    assert lines_of(case, 'events') == ['none, for no motion was judged']
    assert lines_of(case, 'not judged') == ['0.99 s: the screw stands still']
    assert any('x.speed: the axis never moves' in line for line in lines_of(case, 'check'))


def test_an_axis_of_which_only_standstill_was_judged_says_so(judged, says):
    zeros = {'zone': Zone.UNKNOWN, 'axial_load': np.nan, 'axial_load_source': 0}
    speeds, reasons = [9.0] * 20 + [0.0] * 80, [Reason.NO_LOAD] * 20 + [Reason.STANDSTILL] * 80
    block = judged.rows(speed=speeds, reason=reasons, **zeros)
    moved = Totals(running_time=0.2, unjudged_time=0.2)
    case = judged.case([block], totals=moved, judged=80)
    assert math.isnan(case.outside_time)  # 0 would read as well done
    first, verdict, *_ = log_lines(judged.log(case))
    assert first == says('80_speed_samples')
    assert verdict.endswith(says('0_2_s'))
    expected = ['0.79 s: the screw stands still', '0.2 s: no valid sample of the load']
    assert lines_of(case, 'not judged') == expected


def test_lines_of_an_axis_that_is_well_has_gaps_warns_or_has_no_rows(judged, says):
    case = judged.case([judged.rows()])
    assert not lines_of(case, 'check')
    assert not lines_of(case, 'not judged')
    assert lines_of(case, 'events') == ['none']
    assert lines_of(case, 'verdict') == [says('good_stayed_optimal')]
    case = judged.case([judged.rows(0, 51), judged.rows(250, 51)])
    assert lines_of(case, 'not judged') == ['2 s: no speed was recorded']
    case = judged.case([judged.rows()], [judged.event(1, 0.1, 0.2)])
    assert lines_of(case, 'why')[0].startswith('The oil film was too thin')
    assert 'at this load run at 573 rev/min' in lines_of(case, 'what to do')[0]
    assert any(' at 430 rev/min and -1200 N: at this' in line for line in axis_lines(case))
    silent = judged.event(1, 0.1, 0.2, advice='', target_speed=math.nan)
    case = judged.case([judged.rows()], [silent])
    assert not lines_of(case, 'what to do')
    assert any(line.endswith(' at 430 rev/min and -1200 N') for line in axis_lines(case))
    assert list(log_lines(judged.log(empty=['y']))) == ['axis y: no usable sample']


def test_warnings_speak_the_unit_of_the_log(judged):
    values = judged.values(**{'x.speed.unit': 'm/min'})
    case = judged.case([judged.rows()], [judged.event(1, 0.1, 0.2)], values=values)
    (line,) = (line for line in axis_lines(case) if ' at 4.3 m/min, 430 rev/min ' in line)
    assert 'run at 5.73 m/min, 573 rev/min' in line


def test_inputs_tell_source_span_rate_and_troubles(judged, says):
    inputs = tuple(
        judged.status(source, lag=0.5, dropped=9 if source is Source.LOAD else 0)
        for source in Source
    )
    held = np.where(np.arange(100) < 90, 1, 3)
    refused = {Source.LOAD: {Why.NOT_A_NUMBER: 2}}
    case = judged.case([judged.rows(axial_load_source=held)], inputs=inputs, refused=refused)
    speed, load, oil, torque = lines_of(case, 'input')
    assert speed.startswith('speed: measured, 100 to ')
    assert speed.endswith(' rad/s, 100 Hz, stamps 0.5 s behind arrival')
    assert load.endswith(says('gaps_1_all'))
    assert oil.startswith('oil temperature: measured, 40 to 40 °C')
    assert torque == 'motor torque: not recorded'


def test_json_has_totals_and_inputs_of_an_axis_side_by_side(judged, says):
    log = judged.log(judged.case([judged.rows()]), empty=['y'])
    records = printed_records(summary_record(log))
    assert records['x']['judged'] == 100
    assert records['x']['events'] == []
    assert records['x']['inputs']['speed']['rate_Hz'] == records['x']['inputs']['load']['rate_Hz']
    assert records['y'] is None
    assert records['y_reason'] == says('recording_holds_usable')


def test_the_summary_is_strict_json_with_reasons_for_null(judged):
    def refuse(name):
        raise ValueError(name)

    events = [judged.event(1, 0.1, 0.2), judged.event(2, 0.5, 0.1, active=True)]
    case = judged.case([judged.rows()], events)
    assumptions = {'x.lead': {'value': 0.01, 'reason': 'usual'}}
    log = judged.log(case, empty=['y'], assumptions=assumptions)
    record = json.loads(json_text(summary_record(log)), parse_constant=refuse)
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
