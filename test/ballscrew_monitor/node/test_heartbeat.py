# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The heartbeat over the middleware, from a node that works and from one that hangs."""

import contextlib
import signal
import socket

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.messages.diagnostics import HOST
from ballscrew_monitor.node import heartbeat
from ballscrew_monitor.node.heartbeat import BEAT_QOS, PROMISE
from ballscrew_monitor.settings.qos import started_node
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.parameter import Parameter
from std_msgs.msg import UInt64


def listen(node):
    """Return the beats that are heard, the number of live nodes, and the missed deadlines."""
    beats, alive, missed = [], [], []
    node.node.create_subscription(
        UInt64,
        f'{node.name}/heartbeat',
        lambda beat: beats.append(beat.data),
        BEAT_QOS,
        event_callbacks=SubscriptionEventCallbacks(
            liveliness=lambda event: alive.append(event.alive_count),
            deadline=lambda event: missed.append(event.total_count),
        ),
    )
    return beats, alive, missed


def vitals(node):
    """Return what was last said of the node itself, with its values."""
    found = [
        (status, {pair.key: float(pair.value) for pair in status.values if pair.key != HOST})
        for message in node.told
        for status in message.status
        if status.name == 'ballscrew_monitor: Node'
    ]
    return found[-1] if found else None


def test_beats_are_counted_in_every_state_and_a_hanging_node_is_noticed(node):
    """A middleware that asserted for the process would not notice."""
    node.start(autostart='false')
    beats, alive, missed = listen(node)
    node.until(lambda: len(beats) > 1 and alive, 'two beats of an unconfigured node')
    assert beats == list(range(beats[0], beats[-1] + 1))
    assert alive[-1] == 1
    node.process.send_signal(signal.SIGSTOP)
    node.until(lambda: missed and alive[-1] == 0, 'the silence')
    node.process.send_signal(signal.SIGCONT)
    node.until(lambda: alive[-1] == 1, 'the next beat')
    (publisher,) = node.node.get_publishers_info_by_topic(f'{node.name}/heartbeat')
    assert publisher.qos_profile.deadline == publisher.qos_profile.liveliness_lease_duration
    assert publisher.qos_profile.deadline == PROMISE


def test_the_status_of_the_node_says_what_it_works(node, says):
    node.start()
    _, publish = node.watched()

    def worked():
        publish(100.0)
        found = vitals(node)
        return found if found and found[1]['Queue depth [-]'] > 0.0 else None

    status, values = node.until(worked, 'the work of the node')
    assert values.pop('Code') == (701 if status.level == DiagnosticStatus.WARN else 0)
    assert values.keys() == {'Loop time [s]', 'Queue depth [-]', 'Processor share [-]'}
    assert values['Loop time [s]'] > 0.0
    said = {says('keeps_up'): DiagnosticStatus.OK, says('busy'): DiagnosticStatus.WARN}
    assert said[status.message] == status.level
    assert (values['Processor share [-]'] >= 0.9) == (status.level == DiagnosticStatus.WARN)


@pytest.mark.parametrize(('second', 'is_told'), [(946_684_800, True), (1_800_000_000, False)])
def test_a_clock_of_the_year_2000_is_told(monkeypatch, says, second, is_told):
    """But not by a node on simulated time, which begins when it likes."""
    monkeypatch.setattr(heartbeat.time, 'time_ns', lambda: second * SECOND)
    with free_domain() as domain, started_node('n', domain) as node:
        beats = heartbeat.Heartbeat(node, clock=node.get_clock())
        for simulated in (False, True):
            node.set_parameters([Parameter('use_sim_time', value=simulated)])
            (status,) = beats.statuses()
            assert (status.message == says('clock_not_set')) == (is_told and not simulated)


def test_two_nodes_of_one_name_hear_of_each_other(node, tmp_path, says):
    """Each says that of the other, and what is left says that it is alone again."""
    node.start()
    node.until(lambda: vitals(node), 'the status of the node')
    folder = tmp_path / 'other'
    folder.mkdir()
    second = type(node)(node.domain, node.node, folder, node.wait_for)
    with contextlib.closing(second):
        second.start()
        hosts = [f'{socket.gethostname()} (process {one.process.pid})' for one in (node, second)]
        texts = {says('two_nodes', host=host) for host in hosts}

        def told():
            return {
                status.message
                for message in node.told
                for status in message.status
                if status.level == DiagnosticStatus.ERROR and status.name.endswith(': Node')
            }

        node.until(lambda: told() == texts, 'the word of both')
        assert says('two_nodes', host=hosts[1]) in node.output.read_text()
        assert says('two_nodes', host=hosts[0]) in second.output.read_text()
    node.until(lambda: vitals(node)[0].level != DiagnosticStatus.ERROR, 'the node alone')
    assert node.output.read_text().count('another node of this name runs') == 1
