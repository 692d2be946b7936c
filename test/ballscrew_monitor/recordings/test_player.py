# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The player in its own process, over the real middleware."""

from pathlib import Path
import signal
import subprocess
import sys
import threading
import time

from ballscrew_monitor.core.inputs import message_class
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.player import Player
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from rosgraph_msgs.msg import Clock
from surrogate.files import InputError

ROOT = Path(__file__).resolve().parents[3]
DEADLINE = 60.0  # [s]
QOS = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.RELIABLE)
CLOCK_QOS = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class Listener:
    """A subscriber of everything that the player sends, in this process."""

    def __init__(self, domain, topics):
        self.received = {topic: [] for topic in topics}
        self.clock = []
        self.order = []  # what came, in the order of its coming
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node('listener', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.node.create_subscription(Clock, '/clock', self._on_clock, CLOCK_QOS)
        for topic, info in topics.items():
            self.node.create_subscription(
                message_class(info.type_name), topic, self.received[topic].append, QOS, raw=True
            )

    def _on_clock(self, message):
        self.clock.append(message.clock.sec * 10**9 + message.clock.nanosec)

    def until(self, condition, what):
        deadline = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < deadline, what
            self._executor.spin_once(timeout_sec=0.05)

    def close(self):
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)


@pytest.fixture
def domain(monkeypatch):
    """Return a free domain, set in the environment."""
    with free_domain() as number:
        for name, value in ros_environment(number).items():
            monkeypatch.setenv(name, value)
        yield number


@pytest.fixture
def listener(domain, short_bag):
    """Return a listener to the topics of the short bag."""
    made = Listener(domain, Bag(short_bag).topics)
    yield made
    made.close()


def play(domain, *arguments):
    """Start the player as a process."""
    return subprocess.Popen(
        [sys.executable, '-m', 'ballscrew_monitor.cli', 'play', *map(str, arguments)],
        cwd=ROOT,
        env=child_environment(domain),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_everything_arrives_as_it_was_recorded(domain, listener, short_bag):
    bag = Bag(short_bag)
    with play(domain, short_bag, '--rate', 4) as player:
        listener.until(
            lambda: all(
                len(found) == bag.topics[topic].count for topic, found in listener.received.items()
            ),
            'the last message',
        )
        out, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (0, '')
    for topic, found in listener.received.items():
        assert found == [message.data for message in bag.messages([topic])]
    assert f'{sum(info.count for info in bag.topics.values())} messages' in out
    assert listener.clock == sorted(listener.clock)
    # One before each message and the ticks between; best effort, so a few may be missing.
    assert listener.clock[0] >= bag.start_time
    assert listener.clock[-1] <= bag.end_time
    assert len(set(listener.clock)) > 0.5 * sum(info.count for info in bag.topics.values())


def test_without_a_listener_it_gives_up(domain, short_bag):
    with play(domain, short_bag, '--wait', 0.1) as player:
        out, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, out) == (1, '')
    assert err.startswith('ballscrew: nobody subscribed to /joint_states, /axial_load')


def test_it_stops_when_it_is_told_to(domain, listener, short_bag):
    with play(domain, short_bag, '--rate', 0.01) as player:
        listener.until(lambda: listener.received['/joint_states'], 'the first message')
        player.send_signal(signal.SIGINT)
        _, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (130, '')


@pytest.mark.parametrize('rate', ['0', '-1', 'inf', 'nan'])
def test_a_bad_rate_is_one_sentence(domain, short_bag, rate):
    with play(domain, short_bag, f'--rate={rate}') as player:
        _, err = player.communicate(timeout=DEADLINE)
    assert player.returncode == 2
    assert err.startswith('ballscrew: rate is ')
    assert err.count('\n') == 1


class Publishers:
    """A node whose publishers only keep what they are given."""

    def __init__(self):
        self.sent, self.awaited = {}, []

    def create_publisher(self, kind, topic, qos):
        sent = self.sent.setdefault(topic, [])
        acked = staticmethod(lambda timeout: self.awaited.append(topic))
        return type(
            'Publisher', (), {'publish': staticmethod(sent.append), 'wait_for_all_acked': acked}
        )


def test_the_clock_is_never_behind_a_message_and_runs_on_after_the_end(short_bag):
    bag, node = Bag(short_bag), Publishers()
    player = Player(node, bag, rate=1000.0)
    played = player.play(threading.Event())
    assert played.complete
    assert sorted(node.awaited) == sorted(bag.topics)  # until all have arrived
    assert player.now == bag.end_time
    assert player.elapsed == pytest.approx(bag.duration)
    stamps = [clock.clock.sec * 10**9 + clock.clock.nanosec for clock in node.sent['/clock']]
    assert stamps == sorted(stamps)
    assert {message.log_time for message in bag.messages()} <= set(stamps)
    answers = iter([False, False, True, True])
    assert player.run_on(lambda: next(answers), DEADLINE, threading.Event())
    assert player.now > bag.end_time


def test_a_stop_ends_it_at_once(short_bag):
    stop = threading.Event()
    stop.set()
    node = Publishers()
    played = Player(node, Bag(short_bag)).play(stop)
    assert not played.complete
    assert not node.awaited
    assert sum(played.sent.values()) == 0


def test_a_rate_that_is_no_number_is_refused(short_bag):
    with pytest.raises(InputError, match='rate is nan'):
        Player(Publishers(), Bag(short_bag), rate=float('nan'))
