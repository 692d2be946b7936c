# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Output of `ros2 param dump` of a running node is a parameter file like any other."""

from ballscrew_monitor.settings import parameters
import pytest
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.parameter import parameter_dict_from_yaml_file, parameter_value_to_python
import yaml

GIVEN = {
    'axes': "['x','z']",
    'x__oil': 'iso_vg_68',
    'x__limits__rcs': 1e-6,
    'z__speed__scale': -1e12,
    'use_sim_time': 'true',
    'qos_overrides./joint_states.subscription.depth': 500,
}


def nested(flat):
    """Return names with dots as groups in groups; a topic keeps what is in it."""
    tree = {}
    for name, value in flat.items():
        *groups, leaf = name.split('.')
        place = tree
        for group in groups:
            place = place.setdefault(group, {})
        place[leaf] = value
    return tree


@pytest.fixture
def dumped(node, tmp_path):
    """Return the file of a node that has ended."""
    node.start(**GIVEN)
    path = dump(node, tmp_path)
    node.stop()
    return path


def dump(node, folder):
    """Return the file that the command writes, which is not in the wheels."""
    node.until(lambda: node.lifecycle() == 'active')
    names = node.call(ListParameters, 'list_parameters').result.names
    values = node.call(GetParameters, 'get_parameters', names=names).values
    flat = {
        name: parameter_value_to_python(value) for name, value in zip(names, values, strict=True)
    }
    path = folder / 'dump.yaml'
    path.write_text(yaml.dump({node.name: {'ros__parameters': nested(flat)}}))
    return path


def test_a_dump_is_read_again_by_commands_and_node(node, dumped):
    values = parameters.read_file(dumped)
    assert values.keys() == parameters.table(['x', 'z']).keys()
    assert (values['x.limits.rcs'], values['z.speed.scale']) == (1e-6, -1e12)
    given = parameters.read_ros_parameters(dumped)
    assert given['use_sim_time'] is True
    assert given['qos_overrides./joint_states.subscription.depth'] == 500
    node.start('--params-file', str(dumped))
    node.until(lambda: node.lifecycle() == 'active')
    depth = 'qos_overrides./joint_states.subscription.depth'
    (found,) = node.call(GetParameters, 'get_parameters', names=[depth]).values
    assert parameter_value_to_python(found) == 500


def test_a_node_takes_its_own_dump_while_it_runs(node, tmp_path):
    """As `ros2 param load` reads it, which takes each text for what YAML takes it for."""
    node.start()
    loaded = parameter_dict_from_yaml_file(str(dump(node, tmp_path)))
    assert {'record', 'x.load.unit', 'use_sim_time'} <= loaded.keys()
    answer = node.call(SetParameters, 'set_parameters', parameters=list(loaded.values()))
    reasons = {name: one.reason for name, one in zip(loaded, answer.results, strict=True)}
    assert not {name: why for name, why in reasons.items() if why}
    assert all(one.successful for one in answer.results)
