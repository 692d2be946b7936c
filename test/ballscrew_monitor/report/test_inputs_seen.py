# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Findings on inputs, and hints where they contradict their stated unit."""

import dataclasses
import math

from ballscrew_monitor.core.inputs import InputState, Source, Why
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.report.balance import Balance
from ballscrew_monitor.report.inputs_seen import hints_on, inputs_seen, Trouble
import numpy as np
import pytest

TORQUE = {'x.torque.topic': 'torque', 'x.torque.field': 'data'}


def seen_of(case, source):
    return next(one for one in inputs_seen(case) if one.source is source)


def statuses(judged, source=None, **changes):
    """Return the statuses of all inputs, of which one, or every one, is changed."""
    chosen = Source if source is None else [source]
    return tuple(judged.status(one, **(changes if one in chosen else {})) for one in Source)


def test_an_input_is_shown_in_its_unit_and_if_always_late_as_a_whole(judged):
    values = judged.values(**{'x.speed.unit': 'rev/min'})
    speed = seen_of(judged.case([judged.rows()], values=values), Source.SPEED)
    assert speed.low == pytest.approx(100.0 * 30.0 / math.pi, rel=0.01)
    assert (speed.origin, speed.unit, speed.hints) == ('measured', 'rev/min', ())
    assert speed.rate == pytest.approx(100.0)
    blocks = [judged.rows(place, 1) for place in range(0, 1000, 100)]
    case = judged.case(blocks, inputs=statuses(judged, received=10))
    assert seen_of(case, Source.SPEED).rate == pytest.approx(1.0)


@pytest.mark.parametrize(
    ('source', 'received', 'rate'),
    [
        (Source.SPEED, 100, 100.0),
        (Source.LOAD, 100, 100.0),
        (Source.TEMPERATURE, 100, 100.0),
        (Source.TEMPERATURE, 8, 7 / 5.99),
    ],
)
def test_a_rate_leaves_gaps_out(judged, source, received, rate):
    blocks = [judged.rows(0, 50), judged.rows(550, 50)]
    inputs = statuses(judged, source, received=received)
    assert seen_of(judged.case(blocks, inputs=inputs), source).rate == pytest.approx(rate)


@pytest.mark.parametrize(
    ('refused', 'rate'), [({}, 49 / 0.69), ({Source.LOAD: {Why.NOT_A_NUMBER: 9}}, 50 / 0.99)]
)
def test_a_gap_of_an_input_of_its_own_rate_is_left_out_with_its_timeout(judged, refused, rate):
    sources = np.where((np.arange(100) >= 40) & (np.arange(100) < 60), PointSource.HELD, 1)
    inputs = statuses(judged, Source.LOAD, received=51)
    values = judged.values(**{'x.load.timeout': 0.1})
    block = judged.rows(axial_load_source=sources)
    case = judged.case([block], values=values, inputs=inputs, refused=refused)
    assert seen_of(case, Source.LOAD).rate == pytest.approx(rate)


@pytest.mark.parametrize(
    ('stated', 'origin', 'known'),
    [([], 'assumed, 40 °C', 'assumed'), (['temperature_degC'], 'stated, 40 °C', 'stated')],
)
def test_a_default_temperature_is_not_called_measured(judged, stated, origin, known):
    values = judged.values(**{'x.temperature.topic': ''})
    block = judged.rows(temperature_source=2)
    case = judged.case([block], values=values, known={'stated': frozenset(stated)})
    oil = seen_of(case, Source.TEMPERATURE)
    assert (oil.origin, oil.known, oil.measured) == (origin, known, False)
    assert seen_of(case, Source.TORQUE).origin == 'not recorded'


TORQUE = {'x.torque.topic': 'torque', 'x.torque.field': 'data'}


@pytest.mark.parametrize(
    ('source', 'assumed', 'stated', 'origin'),
    [
        (Source.SPEED, ['speed'], ['position.column'], 'worked_out_from'),
        (Source.SPEED, ['speed.unit'], ['speed.column'], 'measured_unit_assumed'),
        (Source.SPEED, ['speed', 'position.unit'], ['position.column'], 'worked_out'),
        (Source.TEMPERATURE, ['temperature.column'], [], 'measured_column_assumed'),
        (Source.TEMPERATURE, [], ['temperature.column'], 'measured_2'),
        (Source.TORQUE, ['torque.column', 'torque.unit'], [], 'measured_column_unit'),
        (
            Source.TORQUE,
            ['torque_constant_Nm_per_A'],
            ['current.column'],
            'worked_out_from_current',
        ),
        (Source.TORQUE, ['torque_rated_Nm'], ['torque.column'], 'measured_rated'),
        (Source.TORQUE, [], ['current.column'], 'out_from_current'),
        (
            Source.TORQUE,
            ['torque_constant_Nm_per_A'],
            ['current.column', 'torque.column'],
            'measured_2',
        ),
    ],
)
def test_what_is_worked_out_is_not_called_measured(judged, source, assumed, stated, origin, says):
    known = {'assumed': dict.fromkeys(assumed, {}), 'stated': frozenset(stated)}
    case = judged.case([judged.rows()], values=judged.values(**TORQUE), known=known)
    seen = seen_of(case, source)
    assert (seen.origin, seen.measured) == (says(origin), says(origin) == 'measured')


def test_what_was_worked_out_or_assumed_is_marked(judged):
    case = judged.case([judged.rows()], known={'load_from': 'motor_torque'})
    assert seen_of(case, Source.LOAD).origin == 'worked out from the motor torque'
    known = {'assumed': {'time.rate_Hz': {'value': 100.0, 'reason': 'usual'}}}
    assert seen_of(judged.case([judged.rows()], known=known), Source.SPEED).rate_assumed
    assert not seen_of(judged.case([judged.rows()]), Source.SPEED).rate_assumed


def test_feeds_too_slow_or_too_fast_and_a_load_that_never_changes_are_doubted(judged):
    values = judged.values(**{'x.speed.unit': 'mm/s'})
    block = judged.rows(speed=0.1 * np.sin(np.arange(100)))
    hints = seen_of(judged.case([block], values=values), Source.SPEED).hints
    assert len(hints) == 1
    assert 'the axis never moves' in hints[0]
    assert 'm/s' in hints[0].partition('which may be')[2]
    values = judged.values(**{'x.speed.unit': 'm/s'})
    block = judged.rows(speed=2000.0)
    hints = seen_of(judged.case([block], values=values), Source.SPEED).hints
    assert any('it feeds with up to 3.18 m/s' in hint for hint in hints)
    two = 2.0 * 2 * math.pi / 0.01  # [rad/s] at which a lead of 10 mm feeds 2 m/s
    for speed, doubted in ((0.999 * two, False), (1.001 * two, True)):
        case = judged.case([judged.rows(speed=speed)], values=values)
        hints = seen_of(case, Source.SPEED).hints
        assert any('it feeds with up to 2 m/s' in hint for hint in hints) is doubted
    hints = seen_of(judged.case([judged.rows(axial_load=0.0)]), Source.LOAD).hints
    assert hints == ('x.load: it never changes, is it connected?',)


@pytest.mark.parametrize('place', ['stated', 'assumed'])
@pytest.mark.parametrize('speed', [2000.0, 0.1])
def test_of_a_table_the_map_is_to_be_checked(judged, speed, place, says):
    known = {'stated': {'stated': frozenset(['lead_mm'])}, 'assumed': {'assumed': {'lead_mm': {}}}}
    block = judged.rows(speed=speed)
    hints = seen_of(judged.case([block], known=known[place]), Source.SPEED).hints
    assert hints
    for hint in hints:
        assert hint.endswith(says('check_unit_scale'))
        assert 'x.speed.unit' not in hint


def test_refused_samples_are_counted_by_why_each_in_words(judged):
    refused = {Source.LOAD: {Why.IMPLAUSIBLE: 7, Why.NOT_A_NUMBER: 2}}
    load = seen_of(judged.case([judged.rows()], refused=refused), Source.LOAD)
    assert load.refused == '7 beyond what is plausible, 2 not a number'
    assert 'check x.load.unit and scale' in load.hints[0]


def load_with(judged, known=None, **changes):
    inputs = statuses(judged, Source.LOAD, **changes)
    return seen_of(judged.case([judged.rows()], inputs=inputs, known=known), Source.LOAD)


def test_an_input_that_is_well_has_no_trouble_and_a_slow_or_foreign_one_is_doubted(judged, says):
    assert load_with(judged, lag=0.001).troubles == {}
    assert load_with(judged, known={'numbered': True}).troubles == {}
    load = load_with(judged, lost=0)
    assert (load.lost, load.troubles) == (None, {})
    assert load_with(judged, known={'numbered': True}, lost=0).lost == 0
    hints = load_with(judged, slow=True, longest_gap=2.0).hints
    assert hints == (says('load_comes_less'),)
    assert 'lie 3 s behind' in load_with(judged, lag=3.0, lagging=True).hints[0]
    far = load_with(judged, lag=1.7e9, lagging=True).hints
    assert far == (says('load_stamps_another'),)


@pytest.mark.parametrize(
    ('changes', 'trouble', 'text'),
    [
        ({'lag': 0.25}, Trouble.LAG, '0.25 s'),
        ({'lag': -0.25}, Trouble.LAG, '-0.25 s'),
        ({'dropped': 3}, Trouble.LEFT_OUT, '3 out of order or of other joints'),
        ({'slow': True, 'longest_gap': 2.0}, Trouble.SLOW, 'yes'),
        ({'lost': 4}, Trouble.LOST, '4'),
        ({'lost': None}, Trouble.LOST, 'not known'),
    ],
)
def test_troubles_of_the_messages_are_told(judged, changes, trouble, text):
    assert load_with(judged, known={'numbered': True}, **changes).troubles == {trouble: text}


@pytest.mark.parametrize(
    ('origin', 'refused', 'changes'),
    [
        ('never valid', {Source.LOAD: {Why.NOT_A_NUMBER: 100}}, {}),
        ('never received', {}, {'received': 0, 'state': InputState.MISSING}),
    ],
)
def test_an_input_without_a_sample_is_not_called_measured(judged, origin, refused, changes):
    block = judged.rows(axial_load=math.nan, axial_load_source=0)
    case = judged.case([block], inputs=statuses(judged, **changes), refused=refused)
    load = seen_of(case, Source.LOAD)
    assert (load.origin, load.measured) == (origin, False)
    assert math.isnan(load.low)


@pytest.mark.parametrize(
    ('source', 'known', 'key'),
    [
        (Source.LOAD, {}, 'turned_load'),
        (Source.SPEED, {}, 'turned_speed'),
        (Source.TORQUE, {}, 'turned_torque'),
        (Source.LOAD, {'stated': frozenset({'lead_mm'})}, 'turned_load_of_map'),
        (
            Source.LOAD,
            {'stated': frozenset({'lead_mm', 'current.column'}), 'load_from': 'current'},
            'turned_current',
        ),
        (
            Source.SPEED,
            {'stated': frozenset({'lead_mm'}), 'assumed': {'speed': {}}},
            'turned_position',
        ),
        (
            Source.TORQUE,
            {'stated': frozenset({'lead_mm', 'current.column'})},
            'turned_torque_of_current',
        ),
    ],
)
def test_a_turned_sign_is_told_with_what_mends_it(judged, source, known, key, says):
    case = judged.case([judged.rows()], values=judged.values(**TORQUE), known=known)
    case = dataclasses.replace(case, balance=Balance(turned=source))
    assert says(key) in hints_on([case])
    others = [one for one in inputs_seen(case) if one.source is not source]
    assert not any('turned' in hint for one in others for hint in one.hints)


@pytest.mark.parametrize(
    ('factor', 'friction', 'key'),
    [
        (1100.0, 0.9, 'looks_like_kn'),
        (0.0009, 1.2, 'looks_like_n'),
        (0.0009, math.nan, 'looks_like_n'),  # a load beyond the surface: no friction of the model
        (1100.0, math.nan, 'size_of_either'),
        (980.0, 1500.0, 'looks_like_n_mm'),
        (5.0, 1.0, 'check_both'),
    ],
)
def test_a_wrong_size_is_told_with_the_unit_that_fits(judged, factor, friction, key, says):
    known = {'stated': frozenset({'lead_mm'})}
    case = judged.case([judged.rows()], values=judged.values(**TORQUE), known=known)
    case = dataclasses.replace(case, balance=Balance(factor=factor, friction=friction))
    assert says(key) in hints_on([case])
