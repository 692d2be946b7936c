# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Memory for judging and reporting does not grow with the length of a recording."""

import tracemalloc

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings import bag_writer
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk import batches
from ballscrew_monitor.recordings.replay import replay_parts
from ballscrew_monitor.report import row_table
from ballscrew_monitor.report.log_report import report_log, STORED_SHARE
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.settings.parameters import defaults
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

VALUES = defaults(['x']) | {'x.load.topic': 'load', 'x.publish_period': 1.0}
TOPICS = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/load': 'geometry_msgs/msg/WrenchStamped',
}
BEGIN, STEP = 1_700_000_000 * SECOND, SECOND // 100
SHORT, LONG = 3000, 12000
"""Samples of the speed in a recording, and of one four times as long."""
MORE = 700_000
"""What the long one may hold more [bytes]: 9000 rows are 1.3 MB, their messages 2.2 MB."""


@pytest.fixture(scope='module')
def bags(tmp_path_factory):
    folder = tmp_path_factory.mktemp('bags')
    return [write(folder / str(count), count) for count in (SHORT, LONG)]


@pytest.fixture
def small_batches(monkeypatch):
    monkeypatch.setattr(batches, 'BATCH', 150_000)
    monkeypatch.setattr(bag_writer, 'WHOLE_CHUNK_SIZE', 20_000)
    monkeypatch.setattr(row_table, 'PART', 1000)


def write(folder, count):
    joint, wrench = JointState(name=['x_axis'], velocity=[0.0]), WrenchStamped()
    with BagWriter(folder, 'bag', chunk_size=20_000) as writer:
        for name, kind in TOPICS.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for number in range(count):
            stamp, sine = BEGIN + number * STEP, float(np.sin(0.01 * number))
            joint.velocity, wrench.wrench.force.x = [150.0 * sine], -1000.0 * sine
            for topic, message in (('/load', wrench), ('/joint_states', joint)):
                clock = message.header.stamp
                clock.sec, clock.nanosec = divmod(stamp, SECOND)
                data = serialize_message(message)
                writer.write(topic, data, log_time=stamp, publish_time=stamp)
    return Bag(folder)


def peaks_of(work):
    """Return the largest memory [bytes] before each share of the work that it tells of."""
    peaks = []

    def on_share(share):
        peaks.append((share, tracemalloc.get_traced_memory()[1]))
        tracemalloc.reset_peak()

    tracemalloc.start()
    try:
        work(on_share)
    finally:
        tracemalloc.stop()
    return peaks


def test_judging_holds_no_more_of_a_longer_recording(bags, small_batches):
    def judge(bag):
        def work(on_share):
            for _ in replay_parts(bag, VALUES, on_done=on_share, states=False):
                pass

        return max(peak for _, peak in peaks_of(work))

    list(replay_parts(bags[0], VALUES, states=False))  # what is made once
    short, long = map(judge, bags)
    assert long - short < MORE


def test_a_report_holds_no_more_of_a_longer_recording(bags, small_batches, tmp_path):
    parameters = LogParameters(values=VALUES, origin='mine')

    def report(bag):
        def work(on_share):
            def until_stored(share):
                on_share(share)
                if share == STORED_SHARE:
                    raise KeyboardInterrupt

            with pytest.raises(KeyboardInterrupt):
                report_log(bag, tmp_path, parameters, on_share=until_stored)

        *judged, stored = (peak for _, peak in peaks_of(work))
        return max(judged), stored

    report_log(bags[0], tmp_path, parameters)  # what is made once
    short, long = map(report, bags)
    more = [after - before for before, after in zip(short, long, strict=True)]
    assert all(one < MORE for one in more), more
