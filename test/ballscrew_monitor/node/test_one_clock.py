# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time in one process: ticks and messages go by the same clock, however fast it is."""

import contextlib
import time
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.state import shelve
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.messages.diagnostics import code_of
from ballscrew_monitor.node import axis_healths
from ballscrew_monitor.node.axis_healths import CLOCK_SET, CLOCK_UNSET, KEPT_FOR, LOOK
from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_monitor.settings.qos import started_node
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

BEGIN = 1_000_000 * SECOND
DISPLAY = 40.0  # [Hz] of /clock on the wall, as `ros2 bag play --clock` does
RATE = 100.0  # [Hz] of the samples in time of the bag


class Bench:
    """A node on simulated time that is not spun, and a machine that plays to it."""

    def __init__(self, node, machine, wait_for):
        self.node, self.wait_for = node, wait_for
        self._clock = machine.create_publisher(Clock, '/clock', 100)
        self._speeds = machine.create_publisher(JointState, 'joint_states', 1000)
        self._loads = machine.create_publisher(WrenchStamped, 'axial_load', 1000)
        self.sent = 0
        publishers = (self._clock, self._speeds, self._loads)
        wait_for(
            lambda: all(one.get_subscription_count() for one in publishers) and self._matched(),
            'the match',
            meanwhile=node._intake.discover,
        )

    def _matched(self):
        topics = self.node._intake._all
        return all(topic.subscription.get_publisher_count() == 1 for topic in topics)

    @property
    def monitor(self):
        return self.node._axis_publishers['x'].axis.monitor

    def status(self):
        return self.monitor.input_status(self.node._intake.now)[0]

    def show(self, now):
        shown = Clock()
        shown.clock.sec, shown.clock.nanosec = divmod(now, SECOND)
        self._clock.publish(shown)
        self._until(lambda: self.node._intake.now == now)

    def send(self, stamp, speed=100.0):
        load, joints = WrenchStamped(), JointState(name=['x_axis'], velocity=[speed])
        load.wrench.force.x = -1000.0
        for message, publisher in ((load, self._loads), (joints, self._speeds)):
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
            publisher.publish(message)
        self.sent += 1
        self._until(lambda: self.status().received == self.sent)

    def _until(self, condition):
        self.wait_for(condition, 'what was sent', meanwhile=self.node._intake.drain)


@pytest.fixture(name='bench')
def make_bench(wait_for, tmp_path):
    with free_domain() as domain, contextlib.ExitStack() as stack:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain)
        stack.callback(rclpy.shutdown, context=context)
        values = {'use_sim_time': True, 'state_dir': str(tmp_path)}
        values |= {'x.limits.raise_delay': 0.0, 'x.limits.clear_delay': 0.2}
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        node = BallscrewMonitor(context=context, parameter_overrides=overrides)
        stack.callback(node.destroy_node)
        node.start()
        stack.callback(node.finish)
        machine = stack.enter_context(started_node('machine', domain))
        yield Bench(node, machine, wait_for)


def play(bench, rate, begin, seconds, speed=100.0):
    """Play at a rate: stamps go on between two times of the clock."""
    step = round(rate / DISPLAY * SECOND)
    for number in range(round(seconds * SECOND / step)):
        now = begin + number * step
        bench.show(now)
        for stamp in range(now, now + step, round(SECOND / RATE)):
            bench.send(stamp, speed)
    return now + step


@pytest.mark.parametrize('rate', [1.0, 5.0, 10.0])
def test_stamps_between_two_times_of_a_fast_clock_are_taken(bench, rate):
    play(bench, rate, BEGIN, 5.0)
    status = bench.status()
    assert (status.dropped, status.refusing) == (0, ())
    assert status.received == bench.sent


def test_on_a_slow_clock_again_a_lead_is_refused_again(bench):
    now = play(bench, 10.0, BEGIN, 5.0)
    now = play(bench, 0.4, now, 1.0)
    assert bench.status().dropped == 0
    bench.send(now + SECOND // 4)
    assert bench.status().dropped == 1


@pytest.mark.parametrize('leap', [3600.0, -900.0])
def test_a_leap_of_the_clock_in_a_warning_is_logged_and_left_out_of_it(bench, tmp_path, leap):
    """Slow motion is outside, for 1 s before the leap and for 1 s after it."""
    now = play(bench, 1.0, BEGIN, 1.0, speed=0.8)
    assert bench.monitor.memory.event_active
    now = play(bench, 1.0, now + round(leap * SECOND), 1.0, speed=0.8)
    play(bench, 1.0, now, 1.0)
    assert not bench.monitor.memory.event_active
    assert not bench.node._kept.state.flush()
    entries = [entry.record() for entry in read_entries(tmp_path)]
    (end,) = [one for one in entries if one['kind'] == 'event_end']
    assert end['duration_s'] == pytest.approx(2.2, abs=0.1)
    steps = [one for one in entries if one['kind'] == 'clock_step' and one['axis'] is None]
    (step,) = steps
    assert step['by_s'] == pytest.approx(leap, abs=0.1)
    assert not [one for one in entries if one['kind'] == 'clock_step' and one['axis'] is not None]
    word = 'forward' if leap > 0 else 'back'
    (status,) = bench.node._heartbeat.statuses()
    assert (status.level, code_of(status)) == (DiagnosticStatus.WARN, Fault.CLOCK_SET)
    assert step['text'].startswith(f'the clock was set {word} by ')
    assert abs(step['stamp_ns'] - now) < 2 * SECOND


@pytest.mark.parametrize('days', [3, -3, 0.5])
def test_health_gathers_nothing_until_the_clock_has_kept_a_new_day(bench, days):
    """What was gathered before it is kept under its own day; a step within a day is as before."""
    healths, now = bench.node._healths, play(bench, 1.0, BEGIN, 1.0)
    rows, jobs = [], []
    gatherer = healths._gatherers['x']
    healths._gatherers['x'] = types.SimpleNamespace(
        take=rows.append, hand_over=gatherer.hand_over, defect='', give_back=gatherer.give_back
    )
    healths._worker.put = lambda job: not jobs.append(job)
    now = play(bench, 1.0, now + round(days * DAY), 1.0)
    assert bool(rows) == (days < 1 and days > -1)
    status = next(iter(healths.statuses(['x'])))
    assert (CLOCK_SET in status.message) == (not rows)
    if not rows:
        assert [job.now // DAY for job in jobs] == [BEGIN // DAY]
        for _ in range(round(KEPT_FOR / LOOK)):
            healths._look()
        play(bench, 1.0, now, 1.0)
        assert rows


def test_health_gathers_nothing_while_the_clock_is_not_set(bench, monkeypatch):
    healths, rows = bench.node._healths, []
    monkeypatch.setattr(healths._gatherers['x'], 'take', rows.append)
    monkeypatch.setattr(axis_healths, 'clock_is_set', lambda node: False)
    healths._look()
    now = play(bench, 1.0, BEGIN, 1.0)
    (status,) = healths.statuses(['x'])
    assert rows == []
    assert CLOCK_UNSET in status.message
    monkeypatch.undo()
    monkeypatch.setattr(healths._gatherers['x'], 'take', rows.append)
    for _ in range(round(KEPT_FOR / LOOK)):
        healths._look()
    play(bench, 1.0, now, 1.0)
    assert rows


class LateClock:
    """A clock that runs ahead [s] of another one."""

    def __init__(self, clock):
        self._clock, self.ahead = clock, 0.0

    def now(self):
        return self._clock.now() + Duration(seconds=self.ahead)

    def __getattr__(self, name):
        return getattr(self._clock, name)


@pytest.mark.parametrize('step', [3600.0, -3600.0])
def test_a_shelving_outlives_a_step_of_the_clock_of_an_inactive_node(step, tmp_path, monkeypatch):
    with free_domain() as domain, contextlib.ExitStack() as stack:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain)
        stack.callback(rclpy.shutdown, context=context)
        overrides = [Parameter('state_dir', value=str(tmp_path))]
        node = BallscrewMonitor(context=context, parameter_overrides=overrides)
        stack.callback(node.destroy_node)
        node.trigger_configure()
        stack.callback(node.finish)
        monitor, clock = node._axis_publishers['x'].axis.monitor, LateClock(node.get_clock())
        monkeypatch.setattr(node, 'get_clock', lambda: clock)
        now = clock.now().nanoseconds
        node._kept._look()
        node._axis_publishers['x'].shelve(shelve(now, 1800.0, 'the spindle is changed'))
        clock.ahead = step
        read = time.time_ns
        monkeypatch.setattr(time, 'time_ns', lambda: read() + round(step * SECOND))
        node._kept._look()
        until = monitor.shelving.until - now - round(step * SECOND)
        assert until / SECOND == pytest.approx(1800.0, abs=1.0)
        assert monitor.shelving.reason == 'the spindle is changed'


def test_a_tick_is_by_the_clock_by_which_messages_arrive(bench, monkeypatch):
    """The executor has not yet shown the time to rclpy, whose clock stands at zero."""
    ticks = []
    monkeypatch.setattr(Monitor, 'tick', lambda self, now: ticks.append(now))
    bench.show(BEGIN)
    bench.send(BEGIN)
    bench.node._on_tick()
    bench.show(BEGIN + SECOND)
    bench.node._on_tick()
    bench.node._on_tick()
    assert ticks == [BEGIN, BEGIN + SECOND]
    assert bench.monitor.memory.arrival[Source.SPEED] == BEGIN
