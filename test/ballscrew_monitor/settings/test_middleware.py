# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the middleware in the environment: refused in a sentence, or kept to 127.0.0.1."""

from pathlib import Path
import subprocess
import sys

from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_monitor.settings import middleware
from ballscrew_monitor.settings.middleware import check_middleware, loopback, stay_local
from diagnostic_msgs.msg import DiagnosticArray
import pytest
from surrogate.files import InputError

ROOT = Path(__file__).resolve().parents[3]
DEADLINE = 600.0  # [s] which only ends a hang
CYCLONE = {'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'}
NOT_INSTALLED = (
    'RMW_IMPLEMENTATION is rmw_cyclonedds_cpp, which is not installed, allowed is '
    'rmw_fastrtps_cpp: unset it, or install the package of that name\n'
)
COMMANDS = {
    'node': ['ballscrew_monitor.node'],
    'run': ['ballscrew_monitor', 'run'],
    'replay': ['ballscrew_monitor', 'replay', 'bag'],
    'play': ['ballscrew_monitor', 'play', 'bag'],
    'solve': ['ballscrew_monitor', 'solve', '--axis', 'x'],
    'doctor': ['ballscrew_monitor', 'doctor'],
    'page': ['ballscrew_monitor', 'page', '--port', '0'],
}


@pytest.mark.parametrize('command', COMMANDS)
def test_a_middleware_that_is_not_there_is_a_sentence_and_exit_code_2(command, says):
    done = subprocess.run(
        [sys.executable, '-m', *COMMANDS[command]],
        env=child_environment(0) | CYCLONE | {'PYTHONPATH': str(ROOT)},
        check=False,
        capture_output=True,
        text=True,
        timeout=DEADLINE,
    )
    name = 'ballscrew_monitor' if command == 'node' else 'ballscrew'
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == says('rmw_cyclonedds_cpp_installed', name=name)


def test_a_middleware_that_is_there_is_taken(tmp_path, refused):
    index = tmp_path / middleware.INDEX
    index.mkdir(parents=True)
    for name in ('rmw_cyclonedds_cpp', 'rmw_fastrtps_cpp', 'rmw_implementation'):
        (index / name).touch()
    environment = CYCLONE | {'AMENT_PREFIX_PATH': f'/nowhere:{tmp_path}'}
    check_middleware(environment)
    with refused('rmw_zenoh_cpp_installed'):
        check_middleware(environment | {'RMW_IMPLEMENTATION': 'rmw_zenoh_cpp'})
    with refused('rmw_fastrtps_cpp_2'):  # the wheels have one
        check_middleware(environment | {middleware.WHEELS: '1'})


def test_where_nothing_tells_what_is_installed_ros_is_left_to_say_it(monkeypatch):
    monkeypatch.setattr(sys, 'prefix', '/nowhere')
    check_middleware(CYCLONE)


@pytest.mark.parametrize(
    'servers', ['127.0.0.1', '127.0.0.1:11811', ';;localhost:11811', 'TCPv4:[127.0.0.1]:42100']
)
def test_discovery_servers_are_taken(servers):
    check_middleware({'ROS_DISCOVERY_SERVER': servers})


@pytest.mark.parametrize(
    ('servers', 'match'),
    [
        ('127.0.0.1:99999', r"names '127\.0\.0\.1:99999', a server must be HOST:PORT"),
        ('127.0.0.1:0', "names '127.0.0.1:0', a server must be HOST:PORT"),
        (';[::1', r"names '\[::1', a server must be"),
        ('a b', "names 'a b', a server must be"),
    ],
)
def test_discovery_servers_that_cannot_be_are_refused(servers, match):
    with pytest.raises(InputError, match=f'^ROS_DISCOVERY_SERVER {match}'):
        check_middleware({'ROS_DISCOVERY_SERVER': servers})
    check_middleware({'ROS_DISCOVERY_SERVER': servers}, discovers=False)


def test_localhost_needs_fastdds_and_the_profile_to_itself():
    environment = {}
    stay_local(environment)
    assert environment == loopback({})
    stay_local(environment)  # such as the node of `ballscrew run`
    for name, value in CYCLONE.items() | {
        ('ROS_DISCOVERY_SERVER', '127.0.0.1:11811'),
        ('FASTRTPS_DEFAULT_PROFILES_FILE', '/mine.xml'),
    }:
        with pytest.raises(InputError, match=f'parameter localhost is true.* {name} is {value}'):
            stay_local({name: value})
    assert loopback(CYCLONE) == {'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}


def without_profile(domain):
    left_out = {*loopback({}), *ros_environment(domain)}
    made = {
        name: value for name, value in child_environment(domain).items() if name not in left_out
    }
    return made | {'ROS_DOMAIN_ID': str(domain)}


def test_every_port_of_a_local_node_is_on_this_machine(node, tmp_path, bound_addresses):
    file = tmp_path / 'local.yaml'
    file.write_text('/**:\n  ros__parameters:\n    localhost: true\n')
    node.environment = without_profile(node.domain)
    node.start('--params-file', str(file))
    heard = node.listen(DiagnosticArray, '/diagnostics')  # by a node of discovery range LOCALHOST
    node.until(lambda: heard, 'the diagnostics')
    found = bound_addresses(node.process.pid)
    assert {address for address, _ in found} == {'127.0.0.1'}
    assert len(found) >= 3
    script = (
        'import rclpy\n'
        'from diagnostic_msgs.msg import DiagnosticArray\n'
        'rclpy.init()\n'
        'node, heard = rclpy.create_node("other"), []\n'
        'node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)\n'
        'while not heard:\n'
        '    rclpy.spin_once(node, timeout_sec=0.1)\n'
    )
    subprocess.run(  # by one that anybody may reach, too
        [sys.executable, '-c', script],
        env=without_profile(node.domain),
        check=True,
        timeout=DEADLINE,
    )


def test_without_localhost_any_machine_reaches_the_node(node, bound_addresses):
    node.environment = without_profile(node.domain)
    node.start()
    heard = node.listen(DiagnosticArray, '/diagnostics')
    node.until(lambda: heard, 'the diagnostics')
    assert '0.0.0.0' in {address for address, _ in bound_addresses(node.process.pid)}


def test_localhost_and_a_profile_of_ones_own_exclude_each_other(node, says):
    node.environment |= {'FASTRTPS_DEFAULT_PROFILES_FILE': '/mine.xml'}
    node.start(localhost=True)
    assert node.process.wait(DEADLINE) == 2
    assert node.output.read_text() == says('localhost_true')
