# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The recorder, over the real middleware, beside a player in another process."""

from pathlib import Path
import subprocess
import sys

from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.player import CLOCK, CLOCK_QOS
from ballscrew_monitor.recordings.recorder import recorded_topics, Recorder
from ballscrew_monitor.settings.parameters import defaults, output
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rosgraph_msgs.msg import Clock

ROOT = Path(__file__).resolve().parents[3]
DEADLINE = 600.0  # [s] which only ends a hang


@pytest.fixture
def spinner(domain):
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    node = rclpy.create_node('recorder', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    yield node, executor
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown(context=context)


def test_what_is_played_is_recorded(spinner, domain, short_bag, tmp_path, wait_for):
    node, executor = spinner
    bag, heard, ticks = Bag(short_bag), [], iter(range(10**9))
    # Reliable: a best-effort reader misses what is sent before it has found the writer, and here,
    # unlike in a run, nobody waits for that.
    topics = [
        Topic(name=name, type_name=info.type_name, offer=Offer.RELIABLE)
        for name, info in bag.topics.items()
    ]
    total = sum(info.count for info in bag.topics.values())
    options = ['--rate', '4', '--wait', str(DEADLINE)]
    command = [sys.executable, '-m', 'ballscrew_monitor', 'play', short_bag, *options]
    with BagWriter(tmp_path, 'copy') as writer:
        recorder = Recorder(
            node, writer, topics, lambda: next(ticks), {'/axial_load': heard.append}
        )
        node.create_subscription(Clock, CLOCK, lambda message: None, CLOCK_QOS)
        with subprocess.Popen(
            command, cwd=ROOT, env=child_environment(domain), stdout=subprocess.DEVNULL
        ) as player:
            wait_for(
                lambda: writer.total >= total,
                'all messages',
                meanwhile=lambda: executor.spin_once(timeout_sec=0.05),
            )
            assert player.wait(DEADLINE) == 0
        recorder.close()
    copy = Bag(tmp_path)
    expected = {name: info.count for name, info in bag.topics.items()}
    assert {name: info.count for name, info in copy.topics.items()} == expected
    for topic in bag.topics:
        wanted = [message.data for message in bag.messages([topic])]
        assert [message.data for message in copy.messages([topic])] == wanted
    assert [message.log_time for message in copy.messages()] == list(range(total))
    assert heard == [message.data for message in bag.messages(['/axial_load'])]


def test_the_latched_topics_come_last():
    topics = recorded_topics(defaults(['x', 'y']))
    names = [topic.name for topic in topics]
    assert names[:2] == ['/joint_states', '/axial_load']
    assert names[-1] == output('y', 'surface_info') == '/ballscrew_monitor/y/surface_info'
    latched = [topic.offer is Offer.LATCHED for topic in topics]
    assert latched == sorted(latched)
    assert len(names) == len(set(names)) == 2 + 2 + 1 + 6
