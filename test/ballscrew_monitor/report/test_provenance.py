# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a report rests on, and how each is known."""

from ballscrew_monitor.report.provenance import assumptions_part, caution
import pytest


def known_of(part, name):
    """Return the row of a table that tells how something is known."""
    return part.partition(f'<td>{name}</td>')[2].partition('</tr>')[0]


def test_nominal_parameters_are_assumed(judged):
    case = judged.case([judged.columns()], known={'nominal': True})
    assert 'nor stated: the screw, the oil. The' in ''.join(caution([case]))
    rows = assumptions_part(case, 'the nominal ones')
    for name in ('Model', 'Screw', 'Oil', 'Limits'):
        assert '<span class="tag assumed">assumed</span>' in known_of(rows, name)
    stated = assumptions_part(judged.case([judged.columns()]), 'mine')
    assert 'tag assumed' not in stated


@pytest.mark.parametrize(('stated', 'count'), [(['temperature_degC'], 0), ([], 1)])
def test_an_oil_temperature_is_assumed_unless_it_is_stated(judged, stated, count):
    case = judged.case(
        [judged.columns(temperature_source=2)],
        values=judged.values(**{'x.temperature.topic': ''}),
        known={'stated': frozenset(stated)},
    )
    assert ''.join(caution([case])).count('oil temperature of 40 °C') == count
    rows = assumptions_part(case, 'mine')
    assert rows.count('tag assumed') == 2 * count  # the oil, and the oil in motion


def test_what_is_assumed_is_told_by_axis(judged):
    def assumed(axis, **values):
        said = {key: {'value': value, 'reason': 'usual'} for key, value in values.items()}
        said['time.rate_Hz'] = {'value': 10.0, 'reason': 'usual'}
        said['speed.unit'] = {'value': 'mm/s', 'reason': 'usual'}
        return judged.case([judged.columns(axis=axis)], known={'assumed': said})

    cases = [assumed('x', lead_mm=10.0), assumed('y', lead_mm=10.0), assumed('z', oil='iso')]
    text = ''.join(caution(cases))
    assert '<li>all axes: rate of the samples of 10 Hz, speed in mm/s</li>' in text
    assert '<li>axes x, y: lead of 10 mm</li><li>axis z: the oil</li>' in text
    assert 'nor stated: lead of 10 mm, rate of' in ''.join(caution(cases[:1]))


def test_a_lead_that_is_not_that_of_the_surface_is_a_contradiction(judged):
    part = assumptions_part(judged.case([judged.columns()], known={'lead': 0.005}), 'mine')
    assert '<td>5 mm</td><td><span class="tag">stated</span>' in known_of(part, 'Lead')
    row = known_of(part, 'Lead of the surface')
    assert '10 mm, not that of the axis' in row
    assert 'contradiction' in row
    same = assumptions_part(judged.case([judged.columns()], known={'lead': 0.01}), 'mine')
    assert 'Lead of the surface' not in same


def test_what_stands_at_its_default_in_a_map_is_assumed(judged):
    known = {'defaulted': frozenset({'surface', 'limits'})}
    part = assumptions_part(judged.case([judged.columns()], known=known), 'mine')
    for name, word in (('Model', 'assumed'), ('Limits', 'assumed'), ('Parameters', 'stated')):
        assert f'>{word}</span>' in known_of(part, name)
