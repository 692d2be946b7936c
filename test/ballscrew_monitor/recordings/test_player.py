# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The player in its own process, over the real middleware."""

import math
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import message_class, stamp_of
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.player import _play, chosen, Following, PAUSE, playable, Player
from ballscrew_monitor.settings.parameters import input_topics, read_file
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from mcap.writer import Writer
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String
from surrogate.files import InputError

ROOT = Path(__file__).resolve().parents[3]
PARAMS = ROOT / 'config' / 'nominal_cycle.yaml'
DEADLINE = 600.0  # [s] which only ends a hang
QOS = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.RELIABLE)
CLOCK_QOS = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class Listener:
    """A subscriber of everything that the player sends, in this process."""

    def __init__(self, domain, topics, wait_for):
        self._wait_for = wait_for
        self.received = {topic: [] for topic in topics}
        self.clock = []
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
        self._wait_for(condition, what, meanwhile=self.spin)

    def until_all_of(self, bag):
        self.until(
            lambda: all(
                len(found) == bag.topics[topic].count for topic, found in self.received.items()
            ),
            'the last message',
        )

    def spin(self):
        self._executor.spin_once(timeout_sec=0.05)

    def close(self):
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)


@pytest.fixture
def listener(domain, short_bag, wait_for):
    made = Listener(domain, Bag(short_bag).topics, wait_for)
    yield made
    made.close()


# A player that waits for the words of a node as long as a busy one takes, and after some messages
# for a word of the test.
GATED = f"""
import sys
from ballscrew_monitor.cli import main
from ballscrew_monitor.recordings import player
from ballscrew_monitor.recordings.player import Player

player.DISCOVERY = player.FIRST_WORD = player.LAST_WORD = {DEADLINE}
messages_of = Player._messages

def gated(*args):
    for number, message in enumerate(messages_of(*args)):
        if number == 300:
            print('300 are sent', flush=True)
            sys.stdin.readline()
        yield message

Player._messages = gated
sys.exit(main(sys.argv[1:]))
"""


def play(domain, *arguments, command=('-m', 'ballscrew_monitor')):
    """Start the player as a process, which waits for its listener unless told otherwise."""
    words = [*command, 'play', '--wait', DEADLINE, *arguments]
    return subprocess.Popen(
        [sys.executable, *map(str, words)],
        cwd=ROOT,
        env=child_environment(domain),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_everything_arrives_as_it_was_recorded(domain, listener, short_bag):
    bag = Bag(short_bag)
    with play(domain, short_bag, '--rate', 1) as player:
        listener.until_all_of(bag)
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


def test_of_a_damaged_bag_it_plays_what_is_whole(domain, listener, short_bag, tmp_path):
    data = (short_bag / 'short.mcap').read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(data[: 3 * len(data) // 4])
    bag = Bag(tmp_path / 'cut.mcap', salvage=True)
    with play(domain, tmp_path / 'cut.mcap', '--rate', 20) as player:
        listener.until_all_of(bag)
        _, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (0, f'ballscrew: {bag.notes[0]}\n')
    assert 'is truncated or damaged: used are the ' in err


def test_without_a_listener_it_gives_up(domain, short_bag, says):
    with play(domain, short_bag, '--wait', 0.1) as player:
        out, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, out) == (1, '')
    assert err.startswith(says('nobody_subscribed'))


def test_it_stops_when_it_is_told_to(domain, listener, short_bag):
    with play(domain, short_bag, '--rate', 0.01) as player:
        listener.until(lambda: listener.received['/joint_states'], 'the first message')
        player.send_signal(signal.SIGINT)
        _, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (130, '')


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


@pytest.mark.parametrize('rate', [0.0, -1.0, math.inf, math.nan])
def test_a_bad_rate_is_refused(short_bag, rate):
    with pytest.raises(InputError, match=r'^rate is \S+, it must be above 0$'):
        Player(Publishers(), Bag(short_bag), rate=rate)


def test_the_clock_is_never_behind_a_message_and_runs_on_after_the_end(short_bag):
    bag, node = Bag(short_bag), Publishers()
    player = Player(node, bag, rate=1000.0)
    played = player.play(threading.Event())
    assert played
    assert sorted(node.awaited) == sorted(bag.topics)  # until all have arrived
    assert player.now == bag.end_time
    assert player.elapsed == pytest.approx(bag.duration)
    stamps = [clock.clock.sec * 10**9 + clock.clock.nanosec for clock in node.sent['/clock']]
    assert stamps == sorted(stamps)
    assert {message.log_time for message in bag.messages()} <= set(stamps)
    answers = iter([False, False, True, True])
    assert player.run_on(lambda: next(answers), DEADLINE, threading.Event())
    assert player.now > bag.end_time


def test_in_a_loop_time_goes_on(short_bag):
    bag, node, stop = Bag(short_bag), Publishers(), threading.Event()
    count = sum(info.count for info in bag.topics.values())
    player = Player(node, bag, rate=1000.0)

    def stop_in_the_third_pass(data):
        joints.append(deserialize_message(data, JointState))
        if sum(player.sent.values()) > 2.5 * count:
            stop.set()

    joints = []
    player._publishers['/joint_states'].publish = stop_in_the_third_pass
    assert not player.play(stop, loop=True)
    stamps = [stamp_of(message) for message in joints]
    one = bag.topics['/joint_states'].count
    length = bag.end_time - bag.start_time + PAUSE
    twice = 2 * one
    assert len(joints) > twice
    assert [stamp - length for stamp in stamps[one:twice]] == stamps[:one]
    assert stamps == sorted(set(stamps))
    expected = [message.velocity for message in joints[:one]]
    assert [message.velocity for message in joints[one:twice]] == expected
    clock = [shown.clock.sec * SECOND + shown.clock.nanosec for shown in node.sent['/clock']]
    assert clock == sorted(clock)
    assert clock[-1] > bag.start_time + 2 * length


@pytest.fixture
def foreign_bag(short_bag, tmp_path):
    """Return an MCAP file with what any machine records: other topics, and types of its own."""
    path, bag = tmp_path / 'foreign.mcap', Bag(short_bag)
    kinds = {**bag.types, '/drive': 'acme_msgs/msg/Drive', '/note': 'std_msgs/msg/String'}
    kinds |= dict.fromkeys(('/achse-1', 'relative'), 'std_msgs/msg/Float64')
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        channels = {
            topic: writer.register_channel(
                topic, 'cdr', writer.register_schema(kind, 'ros2msg', b'')
            )
            for topic, kind in kinds.items()
        }
        for message in bag.messages():
            times = {'log_time': message.log_time, 'publish_time': message.publish_time}
            writer.add_message(channels[message.topic], data=message.data, **times)
        for topic in ('/drive', '/note', '/achse-1', 'relative'):
            writer.add_message(channels[topic], data=b'\0\1\0\0' + bytes(8), **times)
        writer.finish()
    return path


def test_inputs_are_played_unless_told_otherwise(foreign_bag, capsys, refused, says):
    bag = Bag(foreign_bag)
    params = ROOT / 'config' / 'nominal_cycle.yaml'
    inputs = set(input_topics(read_file(params)))
    assert set(chosen(bag, params)) == inputs < set(bag.topics)
    assert chosen(bag, params, ['note', '/note']) == ['/note']
    every = chosen(bag, params, every=True)
    assert set(every) == set(bag.topics)
    assert set(playable(bag, every)) == set(bag.topics) - {'/drive', '/achse-1'}
    assert capsys.readouterr().out == says('played_drive_message')
    refused('topic_can_played', playable, bag, ['/drive'])


def test_topics_that_the_bag_does_not_hold_are_named(foreign_bag, tmp_path, capsys, refused):
    bag, params = Bag(foreign_bag), tmp_path / 'params.yaml'
    form = '/**:\n  ros__parameters:\n    x: {{speed: {{topic: {}}}, load: {{topic: {}}}}}\n'
    params.write_text(form.format('joint_states', 'force'))
    assert chosen(bag, params) == ['/joint_states']
    assert capsys.readouterr().out == 'the bag holds no /force\n'
    params.write_text(form.format('motion', 'force'))
    for topics in (None, ['/note', '/motion']):
        refused('holds_motion_holds', chosen, bag, params, topics)


def test_a_bag_of_any_machine_is_played(domain, listener, foreign_bag):
    with play(domain, foreign_bag, '--rate', 4, '--topics', 'joint_states', 'drive') as player:
        listener.until(lambda: listener.received['/joint_states'], 'the first message')
        out, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (0, '')
    assert out.startswith('not played: /drive, ')


@pytest.mark.parametrize('missing', [['/clock'], ['/axial_load', '/clock'], ['/axial_load'], []])
def test_who_does_not_take_the_time_from_it_is_told_so_once(
    short_bag, missing, monkeypatch, capsys, says
):
    player = Player(Publishers(), Bag(short_bag), rate=1000.0)
    monkeypatch.setattr(player, 'unmatched', lambda: missing)
    code = _play(player, list(Bag(short_bag).topics), 0.0, threading.Event(), False, None)
    out = capsys.readouterr().out
    assert code == 0
    assert out.count(says('untimed')) == out.count('/clock') == missing.count('/clock')
    assert out.count('nobody listens to /axial_load\n') == missing.count('/axial_load')


@pytest.mark.parametrize(
    'durability', [QoSDurabilityPolicy.VOLATILE, QoSDurabilityPolicy.TRANSIENT_LOCAL]
)
def test_all_that_can_be_sent_of_it_reaches_whoever_listens(
    domain, listener, foreign_bag, durability
):
    heard, asked = {'note': [], 'relative': []}, QoSProfile(depth=10, durability=durability)
    for topic, found in heard.items():
        kind = String if topic == 'note' else Float64
        listener.node.create_subscription(kind, topic, found.append, asked, raw=True)
    bag, sent = Bag(foreign_bag), set(listener.received)
    with play(domain, foreign_bag, '--rate', 20, '--all') as player:
        listener.until(
            lambda: (
                all(heard.values())
                and all(len(listener.received[one]) == bag.topics[one].count for one in sent)
            ),
            'every message',
        )
        out, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (0, '')
    assert out.count('not played: ') == 2


def test_a_rate_that_the_node_cannot_follow_is_a_failure_with_the_count(node, nominal_bag, says):
    """A node that gets no processor time loses what does not fit into its queues."""
    states = node.states()
    topics = ('joint_states', 'axial_load')
    queues = [f'qos_overrides./{name}.subscription.depth:=200' for name in topics]
    given = [part for queue in queues for part in ('-p', queue)]
    node.start('--params-file', PARAMS, *given, use_sim_time='true')
    node.until(node.knows_listeners, 'the node')
    options = ('--rate', 10, '--params', PARAMS)
    with play(node.domain, nominal_bag, *options, command=('-c', GATED)) as player:
        node.until(lambda: states and states[-1].inputs[0].received, 'a sample')
        assert player.stdout.readline() == '300 are sent\n'
        node.process.send_signal(signal.SIGSTOP)
        player.stdin.write('play\n')
        player.stdin.flush()
        assert ' messages in ' in player.stdout.readline()  # all are sent
        node.process.send_signal(signal.SIGCONT)
        _, err = player.communicate(timeout=DEADLINE)
    assert player.returncode == 1, err
    ((taken, count, source),) = re.findall(r'took (\d+) of (\d+) messages of its (\w+)', err)
    assert err == says('did_not_follow', taken=taken, count=count, source=source)
    assert source in ('speed', 'load')
    assert 0 < int(taken) < int(count)


class LateMonitor:
    """A graph in which the subscribers of a monitor are known before what it publishes."""

    def __init__(self):
        self.executor, self.looks, self.taken = self, 0, 0

    def create_subscription(self, kind, topic, heard, depth):
        self.heard = heard

    def count_publishers(self, topic):
        return self.looks > 3

    def spin_once(self, timeout_sec):
        self.looks += 1
        if self.looks > 3:
            counts = [KeyValue(key='Speed received [-]', value=str(self.taken))]
            status = DiagnosticStatus(name='ballscrew: x: Inputs', values=counts)
            self.heard(DiagnosticArray(status=[status]))


def test_a_monitor_whose_publisher_is_found_late_is_awaited():
    graph = LateMonitor()
    following = Following(graph, {('x', 'speed'): '/joint_states'})
    following.begin()
    graph.taken = 7
    following.settle(-1, lambda rest, most: rest())
    complaint = following.complaint(10.0, {'/joint_states': 10})
    assert 'x did not follow at 10x: it took 7 of 10 messages of its speed' in complaint


def test_a_rate_that_the_node_follows_is_none(node, short_bag, wait_for):
    node.start('--params-file', PARAMS, use_sim_time='true')
    options = ('--rate', 1, '--params', PARAMS)
    with play(node.domain, short_bag, *options, command=('-c', GATED)) as player:
        out, err = player.communicate('play\n', timeout=DEADLINE)
    assert (player.returncode, err) == (0, '')
    assert 'use_sim_time' not in out


def test_a_loop_goes_on_until_it_is_interrupted(domain, listener, short_bag):
    once = Bag(short_bag).topics['/joint_states'].count
    with play(domain, short_bag, '--rate', 20, '--loop', '--topics', 'joint_states') as player:
        listener.until(lambda: len(listener.received['/joint_states']) > once, 'a second pass')
        player.send_signal(signal.SIGINT)
        _, err = player.communicate(timeout=DEADLINE)
    assert (player.returncode, err) == (130, '')


def test_a_stop_ends_it_at_once(short_bag):
    stop = threading.Event()
    stop.set()
    node = Publishers()
    player = Player(node, Bag(short_bag))
    played = player.play(stop)
    assert not played
    assert not node.awaited
    assert not player.sent
