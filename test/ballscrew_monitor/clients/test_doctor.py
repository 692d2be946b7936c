# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files that are wrong, against a machine over the real middleware."""

import contextlib
import json
import threading
import time

from ballscrew_monitor import cli
from ballscrew_monitor.clients.doctor import doctor, domains_of
from ballscrew_monitor.cycle.domain import free_domain, LOCK_PARTICIPANT, port
from ballscrew_monitor.settings.qos import started_node
from geometry_msgs.msg import WrenchStamped
import pytest
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64
from surrogate.files import InputError

# How long to listen [s] until all has been heard, the slow topic twice.
LISTENING = (1.0, 6.0, 24.0)
AHEAD = 3600  # [s]
EVERY = 0.7  # [s] between two messages of the slow topic
BEST_EFFORT = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)
GOOD = {
    'surface': "'closed_form'",
    'speed': '{timeout: 30.0}',
    'load': '{timeout: 30.0}',
    'temperature': "{topic: 'oil_temperature'}",
    'max_lag': '30.0',
}
WRONG = {
    'topic': {'load': "{topic: 'axial_laod', timeout: 30.0}"},
    'type': {'speed': "{type: 'std_msgs/msg/Float64', field: 'data', timeout: 30.0}"},
    'field': {'load': "{field: 'wrench.force', timeout: 30.0}"},
    'joint': {'speed': "{field: 'velocity[xaxis]', timeout: 30.0}"},
    'speed_unit': {'speed': "{topic: 'spindle', type: '', field: 'data', timeout: 30.0}"},
    'load_unit': {'load': "{unit: 'kN', timeout: 30.0}"},
    'temperature_unit': {'temperature': "{topic: 'oil_temperature', unit: 'K'}"},
    'torque_unit': {'torque': "{topic: 'spindle', unit: 'A', uncertainty: 0.1}"}
    | {'load': "{source: 'motor_torque'}"},
    'torque_uncertainty': {'torque': "{topic: 'spindle'}", 'load': "{source: 'motor_torque'}"},
    'no_torque': {'load': "{source: 'motor_torque'}", 'torque': '{uncertainty: 0.1}'},
    'timeout': {'load': "{topic: 'slow_load', timeout: 0.1}"},
    'qos': {},
    'position_only': {'speed': "{topic: 'positions', timeout: 30.0}"},
    'still': {'speed': "{topic: 'idle', timeout: 30.0}"},
    'clock_ahead': {'load': "{topic: 'future_load', timeout: 30.0}"},
    'simulated': {},
    'override': {},
    'surface': {'surface': "'/no/such.npz'"},
}
EXTRA = {
    'qos': "    qos_overrides: {/joint_states: {subscription: {reliability: 'reliable'}}}\n",
    'simulated': '    use_sim_time: true\n',
    'override': '    qos_overrides: {/joint: {subscription: {depth: 5}}}\n',
}


class Machine:
    """Topics of a machine, some of them as they should not be, until it is stopped."""

    def __init__(self, node):
        self.node = node
        self.stopped = threading.Event()
        make = self.node.create_publisher
        self.joints = make(JointState, 'joint_states', BEST_EFFORT)
        self.positions = make(JointState, 'positions', 10)
        self.idle = make(JointState, 'idle', 10)
        self.spindle = make(Float64, 'spindle', 10)
        self.oil = make(Temperature, 'oil_temperature', 10)
        self.loads = {
            name: make(WrenchStamped, f'{name}_load', 10) for name in ('axial', 'slow', 'future')
        }
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        due, turned = time.monotonic(), 0.0
        while not self.stopped.wait(0.01):
            self.joints.publish(
                self.stamped(JointState(name=['arm', 'x_axis'], velocity=[0.0, 100.0]))
            )
            self.positions.publish(self.stamped(JointState(name=['x_axis'], position=[1.0])))
            turned += 0.05
            idle = JointState(name=['x_axis'], velocity=[0.0], position=[turned])
            self.idle.publish(self.stamped(idle))
            self.spindle.publish(Float64(data=1500.0))
            self.oil.publish(self.stamped(Temperature(temperature=40.0)))
            self.loads['axial'].publish(self.load())
            self.loads['future'].publish(self.load(AHEAD))
            if time.monotonic() >= due:
                due += EVERY
                self.loads['slow'].publish(self.load())

    def stamped(self, message, ahead=0):
        message.header.stamp = self.node.get_clock().now().to_msg()
        message.header.stamp.sec += ahead
        return message

    def load(self, ahead=0):
        message = self.stamped(WrenchStamped(), ahead)
        message.wrench.force.x = -1000.0
        return message

    def close(self):
        self.stopped.set()
        self.thread.join()


@pytest.fixture(scope='module', name='domain')
def make_domain():
    with free_domain() as domain, started_node('machine', domain) as node:
        with contextlib.closing(Machine(node)):
            yield domain


def write(folder, changes, extra=''):
    lines = [f'      {name}: {value}\n' for name, value in (GOOD | changes).items()]
    path = folder / 'params.yaml'
    text = '/**/ballscrew_monitor:\n  ros__parameters:\n' + extra + '    x:\n' + ''.join(lines)
    path.write_text(text, encoding='utf-8')
    return path


def patient(examine, as_expected):
    """
    Return what is found when all has been heard: listen again for longer until it is as expected.

    How long a busy machine takes until all have found each other is not what is tested.

    """
    for seconds in LISTENING:
        found = examine(seconds)
        if as_expected(found):
            break
    return found


@pytest.fixture
def examined(domain, monkeypatch, capsys):
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))

    def examine(path):
        def once(seconds):
            return doctor(path, seconds=seconds), capsys.readouterr().out

        code, out = patient(once, lambda found: found[0] == 0)
        assert code == 0, out
        return out

    return examine


def test_a_good_file_has_no_finding(domain, tmp_path, examined, says):
    out = examined(write(tmp_path, {}))
    assert out.startswith(says('ros_domain_discovery', domain=domain))
    assert 'x.load: /axial_load (geometry_msgs/msg/WrenchStamped): ' in out
    assert out.endswith(', 40 to 40 degC\nfindings: none\n')


def test_positions_and_a_torque_instead_of_a_load_have_no_finding(tmp_path, examined):
    field = "{topic: 'positions', field: 'position[0]', unit: 'deg', timeout: 30.0}"
    torque = "{topic: 'spindle', uncertainty: 0.1, timeout: 30.0}"
    changes = {'speed': field, 'load': "{source: 'motor_torque'}", 'torque': torque}
    out = examined(write(tmp_path, changes))
    assert 'x.load' not in out
    assert 'x.torque: /spindle (std_msgs/msg/Float64): ' in out


@pytest.mark.parametrize('name', WRONG)
def test_a_wrong_file_has_its_sentence(name, domain, tmp_path, monkeypatch, capsys, says):
    sentence = says(name)
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    path = write(tmp_path, WRONG[name], EXTRA.get(name, ''))
    command = ['doctor', '--params', str(path), '--json', '--seconds']

    def findings(seconds):
        code = cli.main([*command, str(seconds)])
        return code, json.loads(capsys.readouterr().out)['findings']

    code, found = patient(
        findings, lambda result: len(result[1]) == 1 and sentence in result[1][0]
    )
    assert (code, len(found)) == (1, 1)
    assert sentence in found[0]


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('/**: {%s: {x: {speed: {field: "velocity[-1]"}}}}', 'index_1_has'),
        ('/**: {%s: {x: {speed: {timeout: 1}}}}', '1_number_with'),
        ('/**: {%s: {x: {sped: {timeout: 1.0}}}}', 'sped_timeout_unknown'),
        ('/**: {%s: {x: {speed: {topic: "a b"}}}}', 'speed_topic_b'),
        ('monitor: {%s: {axes: [x]}}', 'says_nothing_node'),
    ],
)
def test_a_refused_file_is_bad_input(text, sentence, domain, tmp_path, monkeypatch, says):
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    path = tmp_path / 'params.yaml'
    path.write_text(text % 'ros__parameters', encoding='utf-8')
    with pytest.raises(InputError, match='.*') as caught:
        doctor(path, seconds=0.1)
    assert says(sentence) in str(caught.value)


def test_bad_times_and_domains_are_bad_input(tmp_path, refused, monkeypatch):
    refused('seconds_0_s', doctor, write(tmp_path, {}), seconds=0.0)
    monkeypatch.setenv('ROS_DOMAIN_ID', 'here')
    refused('ros_cannot_start', doctor, write(tmp_path, {}), seconds=1.0)


HEAD = '  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt\n'


def table(*ports):
    return HEAD + ''.join(
        f'  {i}: 00000000:{number:04X} 00000000:0000 07\n' for i, number in enumerate(ports)
    )


def test_ports_tell_domains_and_the_lock_of_a_test_run_is_no_participant():
    ports = [port(0, 0), port(7, 3), port(7, 4), port(101, 0), 53, 40_000]
    assert domains_of(table(*ports)) == [0, 7, 101]
    assert domains_of(table(port(7, LOCK_PARTICIPANT))) == []
    assert domains_of('') == []
