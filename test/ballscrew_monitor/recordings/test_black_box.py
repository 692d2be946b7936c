# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The node records itself, and its recording gives its states again, bit for bit."""

import os
import signal

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.recorded_events import recorded_values
from ballscrew_monitor.recordings.recover import recover
from ballscrew_monitor.recordings.replay import replay
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from diagnostic_msgs.msg import DiagnosticArray
import pytest
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from std_srvs.srv import Trigger

FAST, SLOW = 100.0, 0.8  # [rad/s] optimal and outside at 1 kN and 40 degC
TICK = 'a state of a tick, after which the recording begins'
SOME = 30_000  # [bytes] of at least one chunk of a recording
QUICK = {'x__limits__raise_delay': 0.0, 'x__limits__clear_delay': 0.2, 'x__max_future': 1000.0}


@pytest.fixture
def start(node, tmp_path):
    """Return what starts a node that records, and gives what publishes samples."""

    def started(mode='always', **more):
        folder = tmp_path / 'recordings'
        node.start(record=f"'{mode}'", record_dir=str(folder), **QUICK, **more)
        return folder, node.machine()

    return started


def replayed(path):
    """Return the states of a replay with every digit, of a recording of which nothing is said."""
    bag = Bag(path)
    states = [str(state) for state, _ in replay(bag, recorded_values(bag))]
    assert bag.remarks == []
    return states


def recorded(path, topic='/ballscrew_monitor/x/state'):
    return [
        str(deserialize_message(one.data, BallScrewState)) for one in Bag(path).messages([topic])
    ]


def finished(node, folder, count=1):
    def found():
        whole = [path for path in sorted(folder.glob('*')) if (path / 'metadata.yaml').exists()]
        return whole if len(whole) >= count else None

    return node.until(found, 'a recording')


def test_a_recording_gives_the_states_again_bit_for_bit(node, start):
    folder, machine = start()
    states = node.states()
    node.until(lambda: states, TICK)
    node.until(lambda: machine(FAST) or len(states) > 50, 'states')
    node.until(lambda: machine(SLOW) or states[-1].level == BallScrewState.LEVEL_WARN, 'a warning')
    node.set_parameters(x__limits__rcs=0.02)
    node.until(lambda: machine(SLOW) or states[-1].rcs_limit == 0.02, 'the new limit')
    assert node.call(Trigger, 'acknowledge').success
    node.until(lambda: machine(FAST) or states[-1].level == BallScrewState.LEVEL_OK, 'the end')
    number = states[-1].judged
    node.stop()
    (path,) = finished(node, folder)
    again = replayed(path)
    assert again == recorded(path)
    assert len(again) >= number > 50
    with AnyReader([path]) as reader:  # strict about the length of a message
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
    assert set(Bag(path).topics) >= {
        '/axial_load',
        '/ballscrew_monitor/x/out_of_zone',
        '/ballscrew_monitor/x/surface_info',
        '/diagnostics',
        '/joint_states',
    }


def test_around_events_alone_is_recorded_with_what_was_before(node, start):
    folder, machine = start('around_events', record_after=600.0)  # it ends with the node
    states = node.states()
    node.until(lambda: states, TICK)
    node.until(lambda: machine(FAST) or len(states) > 30, 'states')
    assert not folder.exists()
    node.until(lambda: machine(SLOW) or states[-1].level == BallScrewState.LEVEL_WARN, 'a warning')
    node.until(lambda: machine(FAST) or (folder.exists() and any(folder.iterdir())), 'a file')
    node.stop()
    (path,) = finished(node, folder)
    again = replayed(path)
    assert again == recorded(path)
    assert len(again) > 30


def test_the_end_of_an_event_by_the_node_is_recorded(node, start):
    folder, machine = start()
    states = node.states()
    node.until(
        lambda: machine(SLOW) or (states and states[-1].level == BallScrewState.LEVEL_WARN),
        'a warning',
    )
    node.stop()
    (path,) = finished(node, folder)
    *_, last = Bag(path).messages(['/ballscrew_monitor/x/out_of_zone'])
    said = deserialize_message(last.data, OutOfZone)
    assert (said.event_id, said.active) == (1, False)
    assert said.advice.endswith('nothing is judged any more: shut down')


def test_after_a_kill_of_the_node_the_recording_is_complete(node, start):
    folder, machine = start()
    states = node.states()
    node.until(lambda: states, TICK)
    node.until(lambda: machine(FAST) or len(states) > 30, 'states')
    node.process.kill()
    node.process.wait()
    (path,) = finished(node, folder)
    again = replayed(path)
    said = recorded(path)
    assert again[: len(said)] == said  # the last burst was heard and not answered
    assert len(said) > 1


def test_a_writer_that_is_killed_is_told_started_again_and_recovered(node, start):
    folder, machine = start()
    states = node.states()
    told = node.listen(DiagnosticArray, '/diagnostics')
    # The process may begin long after the node does.
    node.until(lambda: machine(FAST) or written(folder) > SOME, 'chunks on the disk')
    writer = int(
        next(
            pid
            for pid in os.listdir('/proc')
            if pid.isdigit()
            and b'recordings.retention' in command_of(pid)
            and str(folder).encode() in command_of(pid)
        )
    )
    os.kill(writer, signal.SIGKILL)
    sentence = 'nothing is recorded: the process that records has ended, it is started again'
    node.until(lambda: machine(FAST) or sentence in sentences(told), 'the sentence')
    judged = states[-1].judged
    node.until(lambda: machine(FAST) or sentences(told)[-1] != sentence, 'the end of it')
    assert states[-1].judged > judged
    active = min(folder.glob('*/*.active'))
    _, count, *_ = recover(active)
    assert count > 100


def written(folder):
    return sum(file.stat().st_size for file in folder.glob('*/*.active'))


def command_of(pid):
    try:
        with open(f'/proc/{pid}/cmdline', 'rb') as file:
            return file.read()
    except OSError:
        return b''


def sentences(told):
    return [
        status.message
        for message in told
        for status in message.status
        if status.name == 'ballscrew_monitor: Recording'
    ] or ['']
