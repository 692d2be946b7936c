# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The one table of parameters and what is made from it."""

import math
import pathlib
import runpy

from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.parameter_row import Change
from ballscrew_monitor.settings.parameter_table import AXIS_ROWS
import pytest
from surrogate.files import InputError
import yaml

TREE = pathlib.Path(__file__).resolve().parents[3]
CONFIG = TREE / 'config'
PAGES = runpy.run_path(str(TREE / 'scripts' / 'reference.py'))
ROWS = parameters.table(['x'])


def written(tmp_path, text):
    path = tmp_path / 'parameters.yaml'
    path.write_text(text)
    return path


def test_every_default_is_allowed():
    """The check raises an error that names the parameter."""
    for name, row in ROWS.items():
        row.check(name, parameters.default_of(name, row))


def test_every_parameter_is_described():
    for name, row in ROWS.items():
        descriptor = row.descriptor()
        assert row.text in descriptor.description, name
        assert descriptor.read_only is (row.change is Change.NEVER), name
        if isinstance(row.default, float):
            assert math.isfinite(row.low), name
            assert math.isfinite(row.high), name
            assert descriptor.floating_point_range[0].to_value == row.high, name


@pytest.mark.parametrize(
    ('name', 'value', 'match'),
    [
        ('x.limits.rcs', 2.0, r'parameter x.limits.rcs is 2.0 -, allowed is 1e-06 to 0.999 -'),
        ('x.limits.rcs', math.nan, 'x.limits.rcs is nan'),
        ('x.limits.rcs', 1, 'is 1, it must be a number with a decimal point'),
        ('x.limits.rcs', '0.1', "is '0.1', it must be a number"),
        ('x.speed.timeout', 0.0, 'allowed is 0.001 to 3600 s'),
        ('x.speed.scale', 0.0, 'allowed is -1e.12 to 1e.12, not 0'),
        ('x.speed.unit', 'rpm', "is 'rpm', allowed is one of rad/s, rev/min"),
        ('x.speed.field', 'velocity[-1]', 'x.speed.field: field .velocity.-1..: the index -1'),
        ('x.handedness', 'Right', 'allowed is one of right, left'),
        ('autostart', 1, 'it must be true or false'),
        ('axes', 'x', 'it must be a list of texts'),
        ('axes', [1], 'it must be a list of texts$'),
        (
            'axes',
            [True],
            r"axes is \[True\], it must be a list of texts, .* quote it, such as 'y'",
        ),
        ('x.screw', False, "it must be a text, ROS reads a bare .* quote it, such as 'y'"),
        ('x.no_such', 1.0, 'parameter x.no_such is unknown'),
    ],
)
def test_bad_values_are_refused(name, value, match):
    with pytest.raises(InputError, match=match):
        parameters.check(ROWS, {name: value})


def test_ends_of_a_range_belong_to_it(refused):
    """What is next to an end is refused, in a sentence that names the parameter."""
    ranged = {name: row for name, row in ROWS.items() if isinstance(row.default, float)}
    assert len(ranged) > 40
    for name, row in ranged.items():
        for end, outward in ((row.low, -math.inf), (row.high, math.inf)):
            row.check(name, end)
            caught = refused('text_2', row.check, name, math.nextafter(end, outward))
            assert str(caught.value).startswith(f'parameter {name} is ')


@pytest.mark.parametrize(
    ('axes', 'match'),
    [
        ([], 'axes is empty'),
        (['X'], "holds 'X'"),
        (['x.y'], "holds 'x.y'"),
        ([''], "holds ''"),
        (['x', 'x'], 'names an axis twice: x, x'),
    ],
)
def test_bad_axes_are_refused(axes, match):
    with pytest.raises(InputError, match=match):
        parameters.table(axes)


def test_each_axis_has_parameters_of_its_own():
    values = parameters.defaults(['x', 'y2'])
    assert values['axes'] == ['x', 'y2']
    assert values['y2.speed.field'] == 'velocity[y2_axis]'
    assert sum(name.startswith('x.') for name in values) == len(AXIS_ROWS)


def test_the_example_holds_every_default():
    assert parameters.read_file(CONFIG / 'example.yaml') == parameters.defaults(['x'])
    assert len(parameters.flatten(yaml.safe_load(PAGES['example_yaml']()))) == len(ROWS)
    values = parameters.read_file(CONFIG / 'nominal_cycle.yaml')
    assert values['x.temperature.topic'] == 'oil_temperature'


def test_later_sections_win_and_texts_need_no_quotes(tmp_path):
    path = written(
        tmp_path,
        '/**: {ros__parameters: {use_sim_time: true, qos_overrides: {/parameter_events: '
        '{publisher: {depth: 9}}}, x: {oil: a}}}\n'
        'other: {ros__parameters: {x: {oil: b}}}\n'
        'ballscrew_monitor: {ros__parameters: {x.oil: c}}\n',
    )
    assert parameters.read_file(path)['x.oil'] == 'c'
    path = written(tmp_path, "/**: {ros__parameters: {axes: [x, 'y'], y: {oil: a}}}")
    assert parameters.read_file(path)['y.oil'] == 'a'
    alias = '{x: {load: {unit: N}, screw: &n "N", oil: *n}}'
    path = written(tmp_path, f'/**: {{ros__parameters: {alias}}}')
    values = parameters.read_file(path)
    assert (values['x.load.unit'], values['x.screw'], values['x.oil']) == ('N', 'N', 'N')


@pytest.mark.parametrize(
    ('text', 'match'),
    [
        ('- 1', 'ros_file'),
        ('a: 1', 'ros_file'),
        ('', 'ros_file'),
        ('a: [', 'cannot_read'),
        ('/**: {ros__parameters: {x: {oli: a}}}', 'oli_unknown'),
        ('/**: {ros__parameters: {y: {oil: a}}}', 'y_oil_unknown'),
        ('/**: {ros__parameters: {axes: x}}', 'list_texts'),
        ('/**: {ros__parameters: {x: {limits: {rcs: 1}}}}', 'number_with_decimal'),
        ('/**: {ros__parameters: }', 'holds_parameters_they'),
        ('/**: {ros__parameters: [1.0]}', 'holds_parameters_they'),
        ('ballscrew_monitor: {x: {oil: a}}', 'ballscrew_monitor_holds'),
        ('/**: {ros__parameters: {axes: [x, y, z]}}', 'true_z_list'),
        ('/**: {ros__parameters: {x: {screw: N}}}', 'screw_false_text'),
        ('/cell/ballscrew_monitor: {ros__parameters: {x: {oil: a}}}', 'says_nothing_node'),
        ('1: {ros__parameters: {x: {oil: a}}}', 'ros_file'),
    ],
)
def test_bad_files_are_refused_by_their_name(tmp_path, text, match, refused):
    path = written(tmp_path, text)
    with refused(match) as caught:
        parameters.read_file(path)
    assert str(caught.value).startswith(f'{path}: ')
    assert '\n' not in str(caught.value)


def test_a_missing_file_is_refused(tmp_path, refused):
    refused('cannot_read', parameters.read_file, tmp_path / 'none.yaml')


def test_the_error_of_ros_for_mixed_types_is_told_with_its_cure():
    mixed = RuntimeError("Sequence should be of same type.\n Value type 'bool' do not belong at 3")
    assert parameters.explain(mixed).endswith("quote it, such as 'y'")
    assert parameters.explain(RuntimeError('other\n thing')) == 'other thing'


def test_the_inputs_are_those_of_the_parameters():
    """A load of the motor torque has no topic."""
    speed = {'/joint_states': 'sensor_msgs/msg/JointState'}
    assert parameters.input_topics(
        parameters.read_file(CONFIG / 'nominal_cycle.yaml')
    ) == speed | {
        '/axial_load': 'geometry_msgs/msg/WrenchStamped',
        '/oil_temperature': 'sensor_msgs/msg/Temperature',
    }
    assert parameters.input_topics(parameters.read_file(CONFIG / 'motor_current.yaml')) == speed


def test_empty_types_are_filled_in_by_topic():
    values = {
        'axes': ['x'],
        'x.speed.topic': 'speed',
        'x.speed.type': '',
        'x.load.topic': '/load',
        'x.load.type': 'a/msg/B',
        'x.torque.topic': '',
        'x.torque.type': '',
    }
    filled = parameters.with_types(values, {'/speed': 'c/msg/D', '/load': 'e/msg/F'})
    assert filled == values | {'x.speed.type': 'c/msg/D'}
    assert parameters.with_types(values, {})['x.speed.type'] == ''


def test_names_are_full():
    assert (
        parameters.absolute('joint_states')
        == parameters.absolute('/joint_states')
        == '/joint_states'
    )
    assert parameters.output('x', 'state') == '/ballscrew_monitor/x/state'
