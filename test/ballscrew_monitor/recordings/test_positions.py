# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Positions of motor and table out of tables and bags, against the numbers that were written."""

import math
from pathlib import Path

from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.positions import positions_of
from ballscrew_monitor.recordings.tables.convert import make_bag
from ballscrew_monitor.report.parameters import parameters_for
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

NOMINAL = Path(__file__).parents[3] / 'config' / 'nominal_cycle.yaml'
ROWS = [(0.1 * n, 3.0 * n, 3.0 * n + 0.004) for n in range(40)]  # s, mm, mm
MAP = """
time: {column: t, unit: s, epoch: 2026-01-05T06:00:00Z}
axes:
  x:
    speed: {column: v, unit: rad/s}
    position: {column: motor, unit: mm}
    table_position: {column: scale, unit: mm}
    load: {unknown: none}
    lead_mm: 10.0
"""


@pytest.fixture
def log(tmp_path):
    """Return a CSV of positions, and its map."""
    lines = [f'{time:.1f},18.85,{motor},{scale}' for time, motor, scale in ROWS]
    (tmp_path / 'log.csv').write_text('\n'.join(['t,v,motor,scale', *lines]) + '\n')
    (tmp_path / 'map.yaml').write_text(MAP)
    return tmp_path / 'log.csv', tmp_path / 'map.yaml'


def positions(bag, params):
    return positions_of(bag, 'x', parameters_for(bag, None, params).values)


def test_a_table_gives_both_positions(log):
    path, mapping = log
    found = positions(opened_log(path, mapping=mapping), mapping)
    assert found.motor == pytest.approx([1e-3 * motor for _, motor, _ in ROWS])
    assert found.table == pytest.approx([1e-3 * scale for _, _, scale in ROWS])
    assert (found.stamps - found.stamps[0]) / 1e9 == pytest.approx([time for time, _, _ in ROWS])


def test_a_map_without_a_position_gives_none(log):
    path, mapping = log
    text = mapping.read_text().replace('    position: {column: motor, unit: mm}\n', '')
    mapping.write_text(text)
    assert positions(opened_log(path, mapping=mapping), mapping) is None


def test_a_bag_gives_the_position_beside_the_speed(log, tmp_path):
    path, mapping = log
    make_bag(path, mapping, tmp_path / 'bag')
    found = positions(opened_log(tmp_path / 'bag'), mapping)
    assert found.motor == pytest.approx([1e-3 * motor for _, motor, _ in ROWS])
    assert found.table is None


def test_a_bag_without_a_position_gives_none(log, tmp_path):
    path, mapping = log
    text = mapping.read_text().replace('    position: {column: motor, unit: mm}\n', '')
    mapping.write_text(text)
    make_bag(path, mapping, tmp_path / 'bag')
    assert positions(opened_log(tmp_path / 'bag'), mapping) is None


def bag_of_joints(folder, *, velocity, place):
    """Write a bag of joint states of a velocity, None for no number, at places [rad] by row."""
    with BagWriter(folder, 'bag') as writer:
        kind = 'sensor_msgs/msg/JointState'
        writer.add_topic(Topic(name='/joint_states', type_name=kind, offer=Offer.RELIABLE))
        for row in range(100):
            stamp = 1_700_000_000_000_000_000 + row * 10_000_000
            state = JointState(name=['x_axis'], position=[place(row)])
            state.velocity = [] if velocity is None else [velocity]
            state.header.stamp.sec, state.header.stamp.nanosec = divmod(stamp, 10**9)
            data = serialize_message(state)
            writer.write('/joint_states', data, log_time=stamp, publish_time=stamp)
    return folder


@pytest.mark.parametrize('velocity', [0.0, None])
def test_a_bag_with_velocities_of_0_is_judged_by_its_positions(velocity, tmp_path, says):
    bag = opened_log(
        bag_of_joints(tmp_path / 'bag', velocity=velocity, place=lambda row: 0.3 * row)
    )
    found = parameters_for(bag, None, NOMINAL)
    assert found.values['x.speed.field'] == 'position[x_axis]'
    assert found.values['x.speed.unit'] == 'rad'
    assert says('still') in found.sentences


@pytest.mark.parametrize(
    ('velocity', 'place'),
    [
        (0.0, lambda row: 1e-3 * (row % 2)),
        (1.0, lambda row: 0.3 * row),
        (0.0, lambda row: math.nan),
    ],
    ids=['at rest', 'in motion', 'without a position'],
)
def test_other_bags_are_judged_by_their_velocities(velocity, place, tmp_path):
    bag = opened_log(bag_of_joints(tmp_path / 'bag', velocity=velocity, place=place))
    found = parameters_for(bag, None, NOMINAL)
    assert found.values['x.speed.field'] == 'velocity[x_axis]'
    assert not found.sentences
