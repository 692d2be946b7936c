# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags in which time begins again: runs are judged apart, or the bag is refused."""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk.chunks import Messages
from ballscrew_monitor.recordings.bulk.written import WrittenTimes
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.settings import parameters
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

BEGIN, STEP = 1_767_600_000 * SECOND, SECOND // 100
COUNT = 300
RUN = COUNT * STEP
TURNS = 10.0 * (COUNT - 1) / 100.0 / 6.283185307179586  # of a run at 10 rad/s


TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/axial_load': 'geometry_msgs/msg/WrenchStamped',
}


def write(folder, runs):
    """Write runs of speed and load, of which each has its first stamp and log time [ns]."""
    with BagWriter(folder, folder.name) as writer:
        for name, kind in TYPES.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for stamp, log_time in runs:
            for at in range(0, RUN, STEP):
                times = {'log_time': log_time + at, 'publish_time': log_time + at}
                speed, load = JointState(name=['x_axis'], velocity=[10.0]), WrenchStamped()
                load.wrench.force.x = -900.0
                for topic, message in zip(TYPES, (speed, load), strict=True):
                    message.header.stamp.sec, message.header.stamp.nanosec = divmod(
                        stamp + at, SECOND
                    )
                    writer.write(topic, serialize_message(message), **times)
    return Bag(folder)


def judge(bag):
    values = parameters.defaults(['x'])
    return judge_log(bag, LogParameters(values=values, origin='test')).axes[0]


@pytest.mark.parametrize('second', [BEGIN, BEGIN - 2 * RUN, BEGIN + RUN // 2])
def test_runs_whose_stamps_begin_again_are_listed_and_none_is_summed_over(second, tmp_path):
    bag = write(tmp_path / 'bag', [(BEGIN, BEGIN), (second, BEGIN + RUN)])
    case = judge(bag)
    assert case.survey.span == pytest.approx(2 * RUN / SECOND, abs=0.02)
    summary = case.outcome.summary()
    assert [run.number for run in summary.runs] == [1, 2]
    assert summary.revolutions == pytest.approx(2 * TURNS, rel=0.01)
    assert case.survey.runs == 2


@pytest.mark.parametrize('second', [BEGIN, BEGIN + RUN // 2, BEGIN - 9 * RUN])
def test_runs_that_log_times_put_into_each_other_are_refused(second, tmp_path, refused):
    refused('runs', judge, write(tmp_path / 'bag', [(BEGIN, BEGIN), (second, second)]))


def test_a_little_disorder_and_a_pause_are_one_run(tmp_path):
    runs = [(BEGIN, BEGIN), (BEGIN + RUN - SECOND // 2, BEGIN + RUN - SECOND // 2)]
    assert not judge(write(tmp_path / 'late', runs)).outcome.summary().runs
    runs = [(BEGIN, BEGIN), (BEGIN + 9 * RUN, BEGIN + 9 * RUN)]
    assert not judge(write(tmp_path / 'pause', runs)).outcome.summary().runs


def messages(times, places):
    zeros = np.zeros(len(times), np.int64)
    rest = dict.fromkeys(('channel', 'begin', 'size', 'sequence'), zeros)
    return Messages(data=b'', log_time=np.array(times), place=np.array(places), **rest)


def falls(*chunks):
    """Return the falls of a topic whose chunks have log times [s], given in another order."""
    written = WrittenTimes()
    for number, times in sorted(enumerate(chunks), key=lambda chunk: min(chunk[1])):
        places = [(number << 32) + place for place in range(len(times))]
        written.add('/a', messages([time * SECOND for time in times], places))
    return [(first // SECOND, latest // SECOND) for _, first, latest in written.falls()]


def test_chunks_in_whatever_order_are_compared_as_they_were_written():
    assert falls([5, 6], [7, 8], [2, 3]) == [(2, 8)]
    assert falls([5, 6], [7, 8], [2], [3]) == [(2, 8)]
    assert falls([5, 6], [7, 8, 2, 3, 4], [1, 2]) == [(2, 8), (1, 4)]


def test_a_single_message_of_an_earlier_time_is_no_run():
    assert falls([5, 6], [2], [7, 8]) == falls([5, 6, 2, 7, 8]) == falls([5, 6], [7, 8, 1]) == []
