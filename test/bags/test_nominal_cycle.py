# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The generated cycle: its bytes, its physics, and what the monitor says of it."""

import hashlib
from pathlib import Path
import subprocess
import sys

from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.settings.axis import load_surface
from ballscrew_monitor.settings.parameters import read_file
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState, Temperature
import yaml

ROOT = Path(__file__).resolve().parents[2]
EXPECTED = yaml.safe_load((ROOT / 'bags' / 'nominal_cycle.expected.yaml').read_text())
TYPES = {
    '/joint_states': JointState,
    '/axial_load': WrenchStamped,
    '/oil_temperature': Temperature,
}


@pytest.fixture(scope='module')
def messages(nominal_bag):
    found = {topic: [] for topic in TYPES}
    for message in Bag(nominal_bag).messages():
        found[message.topic].append(deserialize_message(message.data, TYPES[message.topic]))
    return found


@pytest.fixture(scope='module')
def judged(nominal_bag, judge):
    return judge(nominal_bag, ROOT / 'config/nominal_cycle.yaml')


def digest(directory):
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in directory.iterdir()
    }


def test_the_same_source_gives_the_same_bytes(nominal_bag, tmp_path):
    command = [
        sys.executable,
        ROOT / 'bags' / 'nominal_cycle.py',
        '--out',
        tmp_path / 'nominal_cycle',
    ]
    subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
    assert digest(tmp_path / 'nominal_cycle') == digest(nominal_bag)


def test_every_message_is_what_ros_reads(messages):
    assert {topic: len(found) for topic, found in messages.items()} == EXPECTED['counts']
    first = messages['/joint_states'][0]
    assert (list(first.name), first.header.frame_id) == (['x_axis'], 'x_axis')
    assert len(first.position) == len(first.velocity) == 1
    assert len(first.effort) == 0
    stamps = np.array([stamp_of(message) for message in messages['/joint_states']])
    assert set(np.diff(stamps)) == {10_000_000}


def test_it_stays_inside_the_surface_and_the_machine(messages):
    speed = np.array([message.velocity[0] for message in messages['/joint_states']])
    angle = np.array([message.position[0] for message in messages['/joint_states']])
    load = np.array([message.wrench.force.x for message in messages['/axial_load']])
    oil = np.array([message.temperature for message in messages['/oil_temperature']])
    assert 210.0 < np.abs(speed).max() < 229.0
    assert 3000.0 < np.abs(load).max() < 3900.0
    assert 24.0 < oil.min() < 26.0 < 44.0 < oil.max() < 46.0
    travel = angle / (2 * np.pi) * 0.010
    assert np.ptp(travel) < 1.0
    # The angle is the integral of the speed.
    assert np.allclose(np.cumsum(speed) * 0.01, angle, atol=3.0)


def test_acceleration_and_jerk_are_those_of_a_drive(nominal_cycle):
    motion = nominal_cycle.simulate()
    velocity = motion.speed * nominal_cycle.LEAD / (2 * np.pi)
    acceleration = np.diff(velocity) / nominal_cycle.FINE_STEP
    jerk = np.diff(acceleration) / nominal_cycle.FINE_STEP
    assert np.abs(acceleration).max() <= nominal_cycle.ACCELERATION * (1 + 1e-6)
    most = 2 * nominal_cycle.ACCELERATION / nominal_cycle.JERK_TIME
    assert np.abs(jerk).max() <= most * (1 + 1e-6)


def test_the_surface_is_of_the_expected_tier():
    values = read_file(ROOT / 'config/nominal_cycle.yaml')
    assert load_surface('x', values).tier == EXPECTED['tier']


def test_the_warnings_are_the_expected_ones(judged):
    summary = judged.summary
    events = summary.events
    assert len(events) == len(EXPECTED['events'])
    for event, expected in zip(events, EXPECTED['events'], strict=True):
        assert judged.causes[event.event_id] == expected['cause'], expected['name']
        assert not event.active
        found = {
            'start': summary.since_first(event.start),
            'end': summary.since_first(event.end),
            'worst_value': event.worst_value,
        }
        for name, value in found.items():
            low, high = expected[name]
            assert low <= value <= high, (expected['name'], name, value)


@pytest.mark.parametrize('phase', EXPECTED['phases'], ids=lambda phase: phase['name'])
def test_the_phases_are_judged_as_expected(judged, phase):
    rows, summary = judged.rows, judged.summary
    low, high = phase['time']
    inside = [row for row in rows if low <= summary.since_first(row['stamp']) <= high]
    assert len(inside) > 15
    for quantity in ('zone', 'regime', 'gates', 'level'):
        if quantity in phase:
            wrong = [row for row in inside if row[quantity] != phase[quantity]]
            assert not wrong, (quantity, wrong[0])


def test_the_totals_are_the_expected_ones(judged):
    summary = judged.summary
    assert summary.judged == EXPECTED['counts']['/joint_states']
    for name, (low, high) in EXPECTED['totals'].items():
        assert low <= getattr(summary, name) <= high, (name, getattr(summary, name))
