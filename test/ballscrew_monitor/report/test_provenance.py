# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Basis of a report, how each part is known, and what was recorded."""

import dataclasses

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason, Zone
from ballscrew_monitor.report.balance import Balance
from ballscrew_monitor.report.provenance import (
    assumptions_part,
    caution,
    checks,
    gaps_part,
    torque_part,
)
import numpy as np
import pytest


def known_of(part, name):
    """Return the row of a table that tells how something is known."""
    return part.partition(f'<td>{name}</td>')[2].partition('</tr>')[0]


def test_nominal_parameters_and_defaults_of_a_map_are_assumed(judged):
    case = judged.case([judged.rows()], known={'nominal': True})
    assert 'nor stated: the screw, the oil. The' in ''.join(caution([case]))
    rows = assumptions_part(case, 'the nominal ones')
    for name in ('Model', 'Screw', 'Oil', 'Limits'):
        assert '<span class="tag assumed">assumed</span>' in known_of(rows, name)
    stated = assumptions_part(judged.case([judged.rows()]), 'mine')
    assert 'tag assumed' not in stated
    known = {'defaulted': frozenset({'surface', 'limits'})}
    part = assumptions_part(judged.case([judged.rows()], known=known), 'mine')
    for name, word in (('Model', 'assumed'), ('Limits', 'assumed'), ('Parameters', 'stated')):
        assert f'>{word}</span>' in known_of(part, name)


@pytest.mark.parametrize(('stated', 'count'), [(['temperature_degC'], 0), ([], 1)])
def test_an_oil_temperature_is_assumed_unless_it_is_stated(judged, stated, count):
    case = judged.case(
        [judged.rows(temperature_source=2)],
        values=judged.values(**{'x.temperature.topic': ''}),
        known={'stated': frozenset(stated)},
    )
    assert ''.join(caution([case])).count('oil temperature of 40 °C') == count
    rows = assumptions_part(case, 'mine')
    assert rows.count('tag assumed') == 2 * count  # the oil, and the oil in motion


def test_what_is_assumed_is_told_by_axis(judged, says):
    def assumed(axis, **values):
        said = {key: {'value': value, 'reason': 'usual'} for key, value in values.items()}
        said['time.rate_Hz'] = {'value': 10.0, 'reason': 'usual'}
        said['speed.unit'] = {'value': 'mm/s', 'reason': 'usual'}
        return judged.case([judged.rows(axis=axis)], known={'assumed': said})

    cases = [assumed('x', lead_mm=10.0), assumed('y', lead_mm=10.0), assumed('z', oil='iso')]
    text = ''.join(caution(cases))
    assert says('li_all_axes') in text
    assert says('li_axes_y') in text
    assert 'nor stated: lead of 10 mm, rate of' in ''.join(caution(cases[:1]))


def test_a_lead_that_is_not_that_of_the_surface_is_a_contradiction(judged):
    part = assumptions_part(judged.case([judged.rows()], known={'lead': 0.005}), 'mine')
    assert '<td>5 mm</td><td><span class="tag">stated</span>' in known_of(part, 'Lead')
    row = known_of(part, 'Lead of the surface')
    assert '10 mm, not that of the axis' in row
    assert 'contradiction' in row
    same = assumptions_part(judged.case([judged.rows()], known={'lead': 0.01}), 'mine')
    assert 'Lead of the surface' not in same


def with_torque(judged, forward, backward):
    """Return a case whose torque differs from the model by two means [N m]."""
    ahead = np.arange(100) < 50
    block = judged.changed(
        judged.rows(motor_torque_source=1),
        direction=np.where(ahead, 1, 2),
        machine_torque=np.where(ahead, 1.5, -1.5),
        motor_torque=np.where(ahead, 1.5 + forward, -1.5 + backward),
    )
    return judged.case([block])


@pytest.mark.parametrize(
    ('forward', 'backward', 'sentences'),
    [
        (0.2, -0.2, ['0.2 N m, is friction that the model does not know', 'not, 0 N m']),
        (0.3, 0.3, ['direction, 0 N m', 'not, 0.3 N m, is weight of the axis']),
        (-0.2, 0.2, ['friction that the model has too much of']),
    ],
)
def test_a_difference_of_torque_is_split_by_direction(judged, forward, backward, sentences):
    part = torque_part(with_torque(judged, forward, backward)).replace('-0 N m', '0 N m')
    for sentence in sentences:
        assert sentence in part


def test_one_direction_tells_no_friction_and_without_torque_there_is_no_comparison(judged):
    part = torque_part(judged.case([judged.rows(motor_torque=1.7, motor_torque_source=1)]))
    assert 'Only one direction was recorded' in part
    assert torque_part(judged.case([judged.rows()])) == ''


def test_seconds_are_told_for_each_reason_and_gaps_lead_to_their_moment(judged, says):
    block = judged.rows(
        reason=[Reason.NO_LOAD] * 30 + [Reason.JUDGED] * 70,
        zone=[Zone.UNKNOWN] * 30 + [Zone.OPTIMAL] * 70,
    )
    part = gaps_part(judged.case([block]))
    assert says('judged_valid_sample') in part
    assert says('speed_has_gap') in part
    part = gaps_part(judged.case([judged.rows(0, 10), judged.rows(310, 10)]))
    assert says('speed_has_1') in part
    assert 'data-begin="-0.9100" data-end="4.1000"' in part
    blocks = [judged.rows(0, 51), judged.rows(250, 51)]
    rows = gaps_part(judged.case(blocks)).partition('</table>')[0].split('<tr')[2:]
    rest, known = rows
    assert says('judged_gaps_speed') in rest
    assert 'data-value="2.0"' in rest
    assert ('judged</td>' in known, '>1</td>' in known) == (True, True)


def test_what_contradicts_itself_is_told_with_its_mend(judged, says):
    case = judged.case([judged.rows()])
    assert not list(checks([case]))
    turned = dataclasses.replace(case, balance=Balance(turned=Source.LOAD))
    assert says('check_turned') == ''.join(checks([case, turned]))
