# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The child process that never outlives its parent."""

import functools
import os
from pathlib import Path
import signal
import subprocess
import sys

from ballscrew_monitor.cycle import node_process
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment, NodeProcess
from ballscrew_monitor.settings.middleware import loopback
from ballscrew_monitor.settings.qos import started_node
from diagnostic_msgs.msg import DiagnosticArray
import pytest
from surrogate.tasks.child import WHEEL_VARIABLES

ROOT = Path(__file__).resolve().parents[3]
PARAMS = ROOT / 'config' / 'nominal_cycle.yaml'
DEADLINE = 600.0  # [s] which only ends a hang


def listen_for_a_sign(domain, wait_for):
    """Wait until the node says something; by then its signal handlers are in place."""
    heard = []
    with started_node('listener', domain) as node:
        node.create_subscription(DiagnosticArray, '/diagnostics', heard.append, 10)
        spin = functools.partial(node.executor.spin_once, timeout_sec=0.1)
        wait_for(lambda: heard, 'a sign', meanwhile=spin)


@pytest.fixture
def node(tmp_path, monkeypatch, wait_for):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with free_domain() as domain:
        process = NodeProcess(PARAMS, tmp_path / 'node.log', domain=domain)
        try:
            listen_for_a_sign(domain, wait_for)
            yield process
        finally:
            process.stop()


def test_it_ends_when_it_is_asked(node, is_alive):
    assert node.returncode is None
    assert node.stop() == 0
    assert node.stop() == 0
    assert not is_alive(node.pid)


def test_it_is_killed_when_it_does_not_listen(node, monkeypatch, is_alive):
    patience = ((signal.SIGINT, 0.01), (signal.SIGTERM, 0.01), (signal.SIGKILL, DEADLINE))
    monkeypatch.setattr(node_process, 'PATIENCE', patience)
    os.kill(node.pid, signal.SIGSTOP)
    assert node.stop() == -signal.SIGKILL
    assert not is_alive(node.pid)


def test_it_dies_with_its_parent(tmp_path, monkeypatch, wait_for, is_alive):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    script = (
        'import sys, pathlib\n'
        'from ballscrew_monitor.cycle.node_process import NodeProcess\n'
        'node = NodeProcess(*map(pathlib.Path, sys.argv[1:3]), domain=int(sys.argv[3]))\n'
        'print(node.pid, flush=True)\n'
        'sys.stdin.read()\n'
    )
    with free_domain() as domain:
        command = [sys.executable, '-c', script, PARAMS, tmp_path / 'node.log', str(domain)]
        with subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=child_environment(domain),
            cwd=ROOT,
        ) as parent:
            pid = int(parent.stdout.readline())
            listen_for_a_sign(domain, wait_for)
            parent.kill()
            wait_for(lambda: not is_alive(pid), 'the end of the node')


def test_its_words_are_kept(tmp_path, wait_for, is_alive):
    with free_domain() as domain:
        bad = tmp_path / 'bad.yaml'
        bad.write_text('/**/ballscrew_monitor:\n  ros__parameters:\n    axes: 3\n')
        node = NodeProcess(bad, tmp_path / 'node.log', domain=domain)
        wait_for(lambda: not is_alive(node.pid), 'the end of the node')
        assert node.stop() == node.returncode == 2
        assert node.last_words().startswith('ballscrew_monitor: ')


def test_the_environment_is_of_this_machine_and_has_the_libraries_of_ros(monkeypatch):
    monkeypatch.setenv('_ROS_WHEELS_BOOTSTRAP_COMPLETE', '1')
    monkeypatch.setenv('LD_LIBRARY_PATH', '/somewhere')
    made = child_environment(7)
    assert made['ROS_DOMAIN_ID'] == '7'
    assert made.items() >= loopback().items()
    assert not set(made) & set(WHEEL_VARIABLES)
    monkeypatch.delenv('_ROS_WHEELS_BOOTSTRAP_COMPLETE', raising=False)
    monkeypatch.setenv('LD_LIBRARY_PATH', '/opt/ros/jazzy/lib')
    assert child_environment(7)['LD_LIBRARY_PATH'] == '/opt/ros/jazzy/lib'
