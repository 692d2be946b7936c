# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parameters with which a recording is judged, and their assumptions of each axis."""

import math

from ballscrew_monitor.report.parameters import assumed_of, parameters_for
import pytest


def test_assumptions_are_those_of_the_axis_and_of_all():
    assumptions = {
        name: {'value': 1, 'reason': 'usual'} for name in ('x.lead_mm', 'xy.oil', 'time.rate_Hz')
    }
    axes = ['x', 'xy']
    assert list(assumed_of(assumptions, 'x', axes)) == ['lead_mm', 'time.rate_Hz']
    assert list(assumed_of(assumptions, 'xy', axes)) == ['oil', 'time.rate_Hz']


@pytest.fixture
def table(tmp_path):
    """Return a CSV without a time and a map that assumes what it does not say."""
    rows = '\n'.join(f'{1000 + 20 * math.sin(n / 9):.3f},{0.1 * (n % 5)}' for n in range(200))
    (tmp_path / 'log.csv').write_text(f'speed,current\n{rows}\n')
    (tmp_path / 'map.yaml').write_text(
        'log: log.csv\n'
        'axes: {x: {speed: {column: speed, unit: rev/min}, current: {column: current, unit: A},'
        ' screw: nominal, oil: iso_vg_68}}\n'
        'time: {rate_Hz: 10.0}\n'
        'assumed:\n'
        '  x.load.from: {value: current, reason: no force is in the log}\n'
        '  x.lead_mm: {value: 10.0, reason: usual}\n'
        '  x.efficiency: {value: 0.9, reason: usual}\n'
        '  x.torque_constant_Nm_per_A: {value: 0.1, reason: usual}\n'
        '  x.temperature_degC: {value: 40.0, reason: usual}\n'
        '  time.epoch: {value: 2000-01-01T00:00:00Z, reason: none}\n'
    )
    return tmp_path


def test_a_table_says_what_its_load_is_worked_out_from(table):
    from ballscrew_monitor.recordings.opener import opened_log

    bag = opened_log(table / 'log.csv', mapping=table / 'map.yaml')
    found = parameters_for(bag, None, table / 'none.yaml')
    assert found.axes['x'].load_from == 'current'
    assert found.axes['x'].stated >= {'speed.column', 'current.unit', 'screw', 'oil'}
    assert not found.axes['x'].stated & set(found.axes['x'].assumed)
    assert found.axes['x'].motion_unit == 'rev/min'
    assert not found.nominal
    assert found.axes['x'].assumed['lead_mm'] == {'value': 10.0, 'reason': 'usual'}
    assert found.origin == f'those of {table / "log.csv"}'
    assert found.short_origin == 'those of log.csv'


def test_the_unit_of_the_motion_is_that_of_the_position_where_no_speed_is_named(table):
    speed, position = (
        'speed: {column: speed, unit: rev/min}',
        'position: {column: speed, unit: mm}',
    )
    signed = ('column: current, unit: A', 'column: current, unit: A, magnitude: false')
    found = found_with(table, column=(speed, position), signed=signed)
    assert found.axes['x'].motion_unit == 'mm'


def test_only_parameters_that_nobody_gave_are_nominal_or_have_no_temperature(
    short_bag, request, tmp_path
):
    from ballscrew_monitor.recordings.bag import Bag

    nominal = request.config.rootpath / 'config' / 'nominal_cycle.yaml'
    assert parameters_for(Bag(short_bag), None, nominal).nominal
    assert not parameters_for(Bag(short_bag), nominal, nominal).nominal
    given = tmp_path / 'params.yaml'
    given.write_text(
        '/**/ballscrew_monitor:\n  ros__parameters: {x: {temperature: {default: 50.0}}}\n'
    )
    assert is_stated(parameters_for(Bag(short_bag), given, given))
    assert not is_stated(parameters_for(Bag(short_bag), None, given))


def found_with(table, params=None, **changes):
    """Return the parameters of the table, of whose map some lines are changed."""
    from ballscrew_monitor.recordings.opener import opened_log

    text = (table / 'map.yaml').read_text()
    for before, after in changes.values():
        text = text.replace(before, after)
    (table / 'map.yaml').write_text(text)
    bag = opened_log(table / 'log.csv', mapping=table / 'map.yaml')
    return parameters_for(bag, params, table / 'none.yaml')


def is_stated(found):
    return 'temperature_degC' in found.axes['x'].stated


def test_a_temperature_is_stated_by_the_map_or_by_its_parameters(table):
    assumed = '  x.temperature_degC: {value: 40.0, reason: usual}\n'
    assert not is_stated(found_with(table))
    parameters = 'parameters: {x: {temperature: {default: 35.0}}}\n'
    found = found_with(table, change=('assumed:', f'{parameters}assumed:'))
    assert is_stated(found)
    assert found.values['x.temperature.default'] == 35.0
    assert 'temperature_degC' not in found.axes['x'].assumed
    assert not any('temperature_degC' in sentence for sentence in found.sentences)
    axis = ('oil: iso_vg_68', 'oil: iso_vg_68, temperature_degC: 45.0')
    assert is_stated(found_with(table, none=(parameters, ''), map=(assumed, ''), axis=axis))


def test_a_map_that_names_no_limits_leaves_them_assumed(table, tmp_path):
    found = found_with(table)
    assert found.axes['x'].defaulted == {'limits'}  # the screw is stated, and its model with it
    assert found.axes['x'].lead == 0.01
    guessed = found_with(
        table,
        screw=('screw: nominal, oil', 'oil'),
        why=('assumed:', 'assumed:\n  x.screw: {value: nominal, reason: usual}'),
    )
    assert guessed.axes['x'].defaulted == {'surface', 'limits', 'parameters'}
    limits = ('assumed:', 'parameters: {x: {limits: {efficiency: 0.8}}}\nassumed:')
    assert found_with(table, limits=limits).axes['x'].defaulted == {'surface'}
    text = '/**/ballscrew_monitor:\n  ros__parameters: {x: {limits: {efficiency: 0.9}}}\n'
    (tmp_path / 'params.yaml').write_text(text)
    assert not found_with(table, tmp_path / 'params.yaml').axes['x'].defaulted


def test_parameters_that_are_given_state_what_they_name_and_no_more(table, tmp_path):
    text = '/**/ballscrew_monitor:\n  ros__parameters:\n    x:\n      load: {topic: load}\n'
    (tmp_path / 'params.yaml').write_text(text)
    found = found_with(table, tmp_path / 'params.yaml')
    assert not is_stated(found)
    assert 'temperature_degC' not in found.axes['x'].assumed  # what the map assumes is not used
    assert 'lead_mm' in found.axes['x'].assumed
    (tmp_path / 'params.yaml').write_text(text + '      temperature: {default: 40.0}\n')
    assert is_stated(found_with(table, tmp_path / 'params.yaml'))


def test_a_machine_is_that_of_the_map_or_else_of_the_parameters(table, tmp_path):
    stated = tmp_path / 'params.yaml'
    stated.write_text('/**:\n  ros__parameters:\n    axes: [x]\n    machine: mill 4\n')
    from ballscrew_monitor.recordings.opener import opened_log

    bag = opened_log(table / 'log.csv', mapping=table / 'map.yaml')
    assert parameters_for(bag, None, stated).machine == ''
    assert parameters_for(bag, stated, stated).machine == 'mill 4'
    with (table / 'map.yaml').open('a') as stream:
        stream.write('machine: mill 3\n')
    bag = opened_log(table / 'log.csv', mapping=table / 'map.yaml')
    assert parameters_for(bag, stated, stated).machine == 'mill 3'
