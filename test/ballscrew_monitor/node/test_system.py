# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The examples for other parts of a system: they fit the node as it is in a process of its own."""

import math
from pathlib import Path
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axes
from ballscrew_msgs.msg import BallScrewState, OperatingPoint
from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
import pytest
from sensor_msgs.msg import JointState
import yaml

SYSTEM = Path(__file__).resolve().parents[3] / 'config' / 'system'
CONTROL = SYSTEM / 'ros2_control.yaml'
OF_AXES = 'Lubrication', 'Inputs', 'Surface', 'Health'
OF_NODE = 'Node', 'State directory', 'Recording'


def parameters_of(name, node):
    """Return the parameters of a node in a file."""
    return yaml.safe_load((SYSTEM / name).read_text())[node]['ros__parameters']


def analyzers():
    """Return the patterns of each group."""
    groups = parameters_of('diagnostic_aggregator.yaml', 'analyzers').values()
    return {one['path']: one['regex'] for one in groups if isinstance(one, dict)}


def groups_of(name):
    """Return the groups that take a status, as GenericAnalyzer does: all of its name."""
    patterns = analyzers().items()
    return [path for path, found in patterns if any(re.fullmatch(one, name) for one in found)]


@pytest.mark.parametrize('namespace', ['/', '/mill'])
def test_each_status_belongs_to_one_group(node, tmp_path, namespace):
    node.start('-r', f'__ns:={namespace}', axes="['x','y_2']", state_dir=tmp_path, record='always')
    name = f'{namespace}/{parameters.NODE_NAME}'.lstrip('/')
    wanted = {f'{name}: {axis}: {part}' for axis in ('x', 'y_2') for part in OF_AXES}
    wanted |= {f'{name}: {part}' for part in OF_NODE}
    names = set()
    node.until(
        lambda: (
            names.update(status.name for message in node.told for status in message.status)
            or wanted <= names
        ),
        'a status of every kind',
    )
    assert names == wanted
    assert {name: len(groups_of(name)) for name in names} == dict.fromkeys(wanted, 1)
    assert {path for name in names for path in groups_of(name)} == set(analyzers())


def test_no_group_takes_what_is_of_others():
    assert not groups_of('ballscrew_monitor: Lubrication')
    assert not groups_of('my_ballscrew_monitor: x: Inputs')
    assert not groups_of('ballscrew_monitor: x: Inputs of the press')


def test_a_lifecycle_manager_takes_the_node_up_and_down(node):
    values = parameters_of('lifecycle_manager.yaml', 'lifecycle_manager')
    assert values['node_names'] == [parameters.NODE_NAME] == [node.name.lstrip('/')]
    assert (values['autostart'], values['bond_timeout']) == (True, 0.0)
    node.start(autostart='false')
    for number, state in (
        (Transition.TRANSITION_CONFIGURE, 'inactive'),
        (Transition.TRANSITION_ACTIVATE, 'active'),
        (Transition.TRANSITION_DEACTIVATE, 'inactive'),
        (Transition.TRANSITION_CLEANUP, 'unconfigured'),
        (Transition.TRANSITION_UNCONFIGURED_SHUTDOWN, 'finalized'),
    ):
        node.lifecycle()  # makes us known: a transition is not to be asked for twice
        request = Transition(id=number)
        assert node.call(ChangeState, 'change_state', transition=request).success
        assert node.lifecycle() == state


def test_the_file_of_ros2_control_makes_an_axis_of_what_its_broadcasters_publish():
    text = yaml.safe_load(CONTROL.read_text())
    kinds = text['controller_manager']['ros__parameters']
    broadcasters = {name for name in kinds if name.endswith('broadcaster')}
    assert broadcasters == {'joint_state_broadcaster', 'force_torque_sensor_broadcaster'}
    ((axis,), reasons) = build_axes(parameters.read_file(CONTROL), lambda topic: topic)
    assert not reasons
    assert axis.topics == {
        Source.SPEED: '/joint_states',
        Source.TORQUE: '/joint_states',
        Source.LOAD: '/force_torque_sensor_broadcaster/wrench',
    }


def broadcasts(node):
    """Return a function that publishes as the two broadcasters do, speed and load of axis x."""
    joints = node.node.create_publisher(JointState, '/joint_states', 10)
    wrenches = node.node.create_publisher(
        WrenchStamped, '/force_torque_sensor_broadcaster/wrench', 10
    )
    node.until_matched(joints, wrenches, inputs=('Speed', 'Load', 'Torque'))
    node.stamp = node.now() + 100 * SECOND

    def publish(speed, force, effort):
        node.stamp += SECOND // 100
        wrench, joint = WrenchStamped(), JointState(name=['gripper', 'x_axis'])
        wrench.header.frame_id = 'x_force'
        wrench.wrench.force.x = force
        for part, name in ((wrench.wrench.force, 'yz'), (wrench.wrench.torque, 'xyz')):
            for letter in name:
                setattr(part, letter, math.nan)  # without an interface
        joint.position = [0.25, 100.0]
        joint.velocity, joint.effort = [math.nan, speed], [math.nan, effort]
        wrenches.publish(node.stamped(wrench, node.stamp))
        joints.publish(node.stamped(joint, node.stamp))

    return publish


def test_the_node_judges_what_the_broadcasters_publish(node):
    patient = {f'x__{name}__timeout': 60.0 for name in ('speed', 'load', 'torque')}
    node.start('--params-file', str(CONTROL), x__max_future=3600.0, **patient)
    states, publish = node.states(), broadcasts(node)
    for _ in range(3):
        publish(100.0, -1000.0, 1.5)
    state = node.until(lambda: states and states[-1].judged == 3 and states[-1], 'three states')
    point = state.point
    assert (point.speed, point.axial_load, state.measured_torque) == (100.0, -1000.0, 1.5)
    sources = point.speed_source, point.axial_load_source, point.motor_torque_source
    assert sources == (OperatingPoint.SOURCE_MEASURED,) * 3
    assert state.zone == BallScrewState.ZONE_OPTIMAL
    assert all(one.dropped == 0 for one in state.inputs)
