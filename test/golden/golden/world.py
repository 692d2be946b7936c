# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
ROS without a middleware and without a clock: a script moves time and messages.

What stands in for ROS does so at the border of rclpy and of the standard library: subscriptions,
timers, clocks, logs, threads that wait for work, and processes. So nothing depends on how busy the
machine is, and nothing here knows the node.

"""

import collections
import contextlib
import json
import os
import queue
import subprocess
import threading
import time
from types import SimpleNamespace
from unittest import mock

import rclpy
from rclpy import node as nodes
from rclpy.action import ActionServer
from rclpy.clock import Clock, ROSClock
from rclpy.event_handler import EventHandler
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.logging import LoggingSeverity
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.subscription import Subscription
from rclpy.time import Time
from rclpy.timer import Timer
from rclpy.waitable import Waitable
from surrogate.tasks.child import WORKER

SECOND = 10**9  # [ns]
DEADLINE = 600.0  # [s] which only ends a hang
QUIET = {'ROS_AUTOMATIC_DISCOVERY_RANGE': 'OFF', 'ROS_DOMAIN_ID': '77'}
BEST_EFFORT = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class World:
    """A time [ns] that only a script moves on, topics, and what was said."""

    current = None

    def __init__(self, begin):
        """Begin at a time [ns]."""
        self.begin, self.now = begin, begin
        self.step = 0  # by which the clock of the wall is ahead of the steady one [ns]
        self.subscriptions, self.timers, self.nodes, self.machines = [], [], [], []
        self.publishers = collections.defaultdict(list)
        self.said, self.logged, self.processes = [], [], []
        self.worker = None  # answers what a solver is asked
        self.others = []  # names of other nodes
        self.thread = threading.get_ident()

    @property
    def wall(self):
        """Return the time of the clock of the wall [ns]."""
        return self.now + self.step

    @contextlib.contextmanager
    def entered(self):
        """Let this world stand in for that outside until the block ends."""
        with contextlib.ExitStack() as stack:
            stack.enter_context(mock.patch.object(World, 'current', self))
            for owner, name, other in _stand_ins(self):
                stack.enter_context(mock.patch.object(owner, name, other))
            stack.enter_context(mock.patch.dict(os.environ, QUIET))
            try:
                yield self
            except BaseException:
                for process in self.processes:
                    process.kill()
                raise
            finally:
                for process in self.processes:
                    process.wait()

    @contextlib.contextmanager
    def node(self, make):
        """Give the node that `make` makes in a context of ROS, until the block ends."""
        context = rclpy.Context()
        rclpy.init(context=context)
        node = make(context)
        self.nodes.append(node)
        try:
            yield node
        finally:
            self.nodes.remove(node)
            node.destroy_node()
            rclpy.shutdown(context=context)

    def publisher(self, topic, kind, *, node='machine', is_numbered=True):
        """Return a publisher of a node that is not here."""
        made = ScriptedPublisher(self, topic, kind, node, is_numbered)
        self.publishers[topic].append(made)
        self._match(topic)
        return made

    def leave(self, publisher):
        """Let a publisher go."""
        self.publishers[publisher.topic].remove(publisher)
        self._match(publisher.topic)

    def _match(self, topic):
        for one in self.subscriptions:
            if one.topic_name == topic:
                one.match()

    def wait(self, duration):
        """Let a duration [s] pass, and whoever waits for messages or timers do its work."""
        end = self.now + round(duration * SECOND)
        self.spin()
        while (due := min((one.due for one in (*self.timers, *self.machines)), default=end)) < end:
            self.now = max(self.now, due)
            for one in [one for one in self.machines if one.due <= self.now]:
                one.call()
            self.spin()
        self.now = max(self.now, end)
        self.spin()

    def every(self, period, act):
        """Let a machine act each `period` [s] from now on."""
        self.machines.append(Machine(self, round(period * SECOND), act))

    def spin(self):
        """Do as an executor does, until nothing is left to be done at this time."""
        for _ in range(1000):
            if not (self._call_timers() or self._call_back() or self._execute()):
                return
        raise AssertionError('the executor never rests')

    def _call_timers(self):
        due = [one for one in self.timers if one.due <= self.now]
        for one in sorted(due, key=lambda one: one.due):
            if one in self.timers:
                one.call()
        return bool(due)

    def _call_back(self):
        called = False
        for one in list(self.subscriptions):
            if one.waiting and one.callback_group.can_execute(one):
                called = True
                while one.waiting:
                    message, _ = one.handle.take_message(one.msg_type, one.raw)
                    one.callback(message)
        return called

    def _execute(self):
        """
        Let what waits for subscriptions by itself do its work, if it is ready.

        However long it waits for more, which nobody sends meanwhile, takes no time of the world.

        """
        done, now = False, self.now
        for waitable in [one for node in self.nodes for one in node.waitables]:
            if isinstance(waitable, ActionServer | EventHandler | Matched):
                continue  # goals come by the middleware, and its events are not those of a world
            wait_set = WaitSet()
            with waitable:
                waitable.add_to_wait_set(wait_set)
                is_ready = waitable.is_ready(wait_set)
            if is_ready:
                done = True
                with contextlib.suppress(StopIteration):
                    waitable.execute(waitable.take_data()).send(None)
                self.now = now
        return done

    def call(self, node, service, kind, **request):
        """Return the answer of a service of a node."""
        name = node.resolve_service_name(service)
        found = [one for one in node.services if node.resolve_service_name(one.srv_name) == name]
        (one,) = found
        return one.callback(kind.Request(**request), kind.Response())


class Machine:
    """Somebody who does something at regular times."""

    def __init__(self, world, period, act):
        """Act first after a `period` [ns]."""
        self._act, self._period = act, period
        self.due = world.now + period

    def call(self):
        """Act."""
        self.due += self._period
        self._act()


class ScriptedPublisher:
    """A publisher elsewhere, which numbers what it sends where the middleware does."""

    def __init__(self, world, topic, kind, node, is_numbered):
        """Begin with nothing sent."""
        self.topic, self.kind, self.name = topic, kind, node
        self._world, self._step, self.number = world, int(is_numbered), 0
        package, _, _ = kind.__module__.partition('.')
        self.type_name = f'{package}/msg/{kind.__name__}'

    def publish(self, message, *, lost=False):
        """Send a message, or bytes in its place; what is `lost` has only its number."""
        self.number += self._step
        data = message if isinstance(message, bytes) else serialize_message(message)
        for one in () if lost else self._world.subscriptions:
            if one.topic_name == self.topic and one.msg_type is self.kind:
                one.waiting.append((data, self.number, self._world.wall))

    def info(self):
        """Return what the graph shows of it."""
        return SimpleNamespace(
            topic_type=self.type_name,
            qos_profile=BEST_EFFORT,
            node_namespace='/',
            node_name=self.name,
            topic_type_hash='',
        )


class Matched(Waitable):
    """Tells a subscription of publishers that have come or gone."""

    def __init__(self, callback_group, callback):
        """Begin with nobody."""
        super().__init__(callback_group)
        self.callback, self.total, self.current, self.is_news = callback, 0, 0, False

    def match(self, count):
        """Take how many publishers there are now."""
        self.total += max(count - self.current, 0)
        self.is_news |= count != self.current
        self.current = count

    def add_to_wait_set(self, wait_set):
        """Wait without a middleware."""

    def is_ready(self, wait_set):
        """Return True if there is news."""
        return self.is_news

    def take_data(self):
        """Return how many there are, and have been."""
        self.is_news = False
        return SimpleNamespace(total_count=self.total, current_count=self.current)

    def __enter__(self):
        """Do nothing: there is nothing to be kept."""

    def __exit__(self, *raised):
        """Do nothing: there is nothing to let go of."""

    def destroy(self):
        """Do nothing: there is nothing to be destroyed."""


class Handle:
    """The queue of a subscription, where the middleware has its own."""

    def __init__(self, subscription, real):
        """Stand in front of the `real` one."""
        self._subscription, self._real = subscription, real

    def __enter__(self):
        """Do nothing: the queue lives as long as its subscription."""
        return self

    def __exit__(self, *raised):
        """Do nothing: the queue lives as long as its subscription."""

    def take_message(self, kind, raw):
        """Return the oldest message and what is known of it, None without any."""
        if not self._subscription.waiting:
            return None
        data, number, received = self._subscription.waiting.popleft()
        known = {
            'publication_sequence_number': number,
            'received_timestamp': received,
            'source_timestamp': received,
        }
        return data if raw else deserialize_message(data, kind), known

    def destroy_when_not_in_use(self):
        """Destroy the real one."""
        self._real.destroy_when_not_in_use()


class ScriptedSubscription(Subscription):
    """A subscription that hears the publishers of a world."""

    def __init__(self, real, kind, topic, callback, group, qos, raw, event_callbacks):
        """Subscribe in the current world."""
        with real:
            self._name = real.get_topic_name()
        self._handle = Handle(self, real)
        self.msg_type, self.topic, self.callback = kind, topic, callback
        self.callback_group, self.qos_profile, self.raw = group, qos, raw
        self._executor_event = False
        self.waiting = collections.deque(maxlen=qos.depth or 1)
        matched = event_callbacks.matched
        self.event_handlers = [Matched(group, matched)] if matched else []
        World.current.subscriptions.append(self)
        self.match()

    @property
    def handle(self):
        """Return what messages are taken from."""
        return self._handle

    @property
    def topic_name(self):
        """Return the full name of its topic."""
        return self._name

    def get_publisher_count(self):
        """Return how many publishers of its type it has."""
        found = World.current.publishers[self._name]
        return sum(one.kind is self.msg_type for one in found)

    def match(self):
        """Count the publishers again."""
        for one in self.event_handlers:
            one.match(self.get_publisher_count())

    def destroy(self):
        """Hear nothing more."""
        World.current.subscriptions.remove(self)
        self._handle.destroy_when_not_in_use()


class ScriptedTimer(Timer):
    """A timer on the time of a world, or on simulated time."""

    def __init__(self, callback, group, period, clock, *, context=None, autostart=True):
        """Begin to run in the current world; `period` [ns]."""
        self._clock, self._world = clock, World.current
        self._period, self.callback, self.callback_group = period, callback, group
        self._executor_event = False
        self._last = self._now
        self._next = self._last + period
        self._world.timers.append(self)

    @property
    def _now(self):
        return self._clock.now().nanoseconds

    @property
    def timer_period_ns(self):
        """Return its period [ns]."""
        return self._period

    @property
    def clock(self):
        """Return the clock that it runs by."""
        return self._clock

    @property
    def due(self):
        """Return when it is due on the time of the world [ns]."""
        now = self._now
        if now < self._last:  # as rcl does: a clock that was set back begins another period
            self._next = now + self._period
        self._last = now
        is_ours = not (isinstance(self._clock, ROSClock) and self._clock.ros_time_is_active)
        if is_ours:
            return self._world.now + self._next - now
        return self._world.now if self._next <= now else float('inf')

    def call(self):
        """Call its callback; the next time is on the grid of its period."""
        late = self._now - self._next
        self._next += self._period * (1 + max(late, 0) // self._period)
        self.callback()

    def destroy(self):
        """Run no more."""
        if self in self._world.timers:
            self._world.timers.remove(self)


class WaitSet:
    """Tells which of the subscriptions that were added have messages."""

    def __init__(self):
        """Begin with none."""
        self._handles = []

    def add_subscription(self, handle):
        """Take a handle; return its place."""
        self._handles.append(handle)
        return len(self._handles) - 1

    def is_ready(self, kind, place):
        """Return True if a subscription has messages."""
        return kind == 'subscription' and bool(self._handles[place]._subscription.waiting)


class SteppedQueue(queue.Queue):
    """A queue of work: the thread of the script goes on when its work is done."""

    def __init__(self, maxsize=0):
        """Begin with nothing to do."""
        super().__init__(maxsize)
        self._rests = threading.Condition()
        self._given, self._asked = 0, 0  # pieces of work that were put and asked for

    def put(self, item, block=True, timeout=None):
        """Put a piece of work, and wait until the next one is asked for."""
        self._given += 1
        super().put(item, block, timeout)
        if item is not None and threading.get_ident() == World.current.thread:
            with self._rests:
                assert self._rests.wait_for(lambda: self._asked > self._given, DEADLINE)

    def get(self, block=True, timeout=None):
        """Return the next piece of work, when there is one."""
        with self._rests:
            self._asked += 1
            self._rests.notify_all()
        return super().get(block, timeout)


class ScriptedWorker:
    """Stands for the process that solves: what it is asked is answered at once."""

    def __init__(self, answer):
        """Let `answer` give the frames for what is asked."""
        self._answer, self._text = answer, ''
        self._lines, self._rests, self._reads = collections.deque(), threading.Condition(), False
        self._is_killed = False
        self.stdin = self.stdout = self
        self.pid = 0

    def write(self, text):
        """Take a part of a request."""
        self._text += text

    def flush(self):
        """Answer the requests; return when the answers are read."""
        asked, self._text = self._text.splitlines(), ''
        frames = [frame for line in asked for frame in self._answer(json.loads(line))]
        with self._rests:
            self._lines.extend(json.dumps(frame) + '\n' for frame in frames)
            self._rests.notify_all()
            rests = self._rests.wait_for(lambda: self._reads and not self._lines, DEADLINE)
            assert rests

    def readline(self, most):
        """Return the next line of an answer, when there is one; nothing after the end."""
        with self._rests:
            self._reads = True
            self._rests.notify_all()
            self._rests.wait_for(lambda: self._lines or self._is_killed)
            self._reads = False
            return self._lines.popleft() if self._lines else ''

    def kill(self):
        """End."""
        with self._rests:
            self._is_killed = True
            self._rests.notify_all()

    def wait(self, timeout=None):
        """Return how it ended."""
        return -9

    def close(self):
        """Do nothing: there is no pipe."""

    def __enter__(self):
        """Return what is read."""
        return self

    def __exit__(self, *error):
        """Do nothing."""


def _stand_ins(world):
    """Yield owner, name and what takes its place."""
    yield nodes, 'Subscription', ScriptedSubscription
    yield nodes, 'Timer', ScriptedTimer
    yield queue, 'Queue', SteppedQueue
    for name, now in {
        'time': lambda: world.wall / SECOND,
        'time_ns': lambda: world.wall,
        'monotonic': lambda: (world.now - world.begin) / SECOND,
        'monotonic_ns': lambda: world.now - world.begin,
        'process_time': lambda: 0.1 * (world.now - world.begin) / SECOND,
    }.items():
        yield time, name, now
    yield time, 'sleep', lambda pause: _pass(world, pause)
    yield Clock, 'now', _now(world, Clock.now)
    yield RcutilsLogger, 'log', _log(world)
    yield Publisher, 'publish', _publish(world)
    yield Publisher, 'wait_for_all_acked', lambda publisher, timeout: True
    yield threading.Event, 'wait', _patient(threading.Event.wait)
    yield threading.Thread, 'join', _patient(threading.Thread.join)
    yield subprocess, 'Popen', _process(world)
    yield SingleThreadedExecutor, 'spin_once', _spin_once(world)
    graph = {
        'get_publishers_info_by_topic': lambda node, topic: [
            one.info() for one in world.publishers[topic]
        ],
        'get_topic_names_and_types': lambda node: [
            (topic, sorted({one.type_name for one in found}))
            for topic, found in sorted(world.publishers.items())
            if found
        ],
        'count_publishers': lambda node, topic: len(world.publishers[topic]),
        'get_node_names': lambda node: [node.get_name(), *world.others],
    }
    for name, look in graph.items():
        yield nodes.Node, name, look


def _pass(world, pause):
    world.now += round(pause * SECOND)


def _now(world, real):
    def now(clock):
        if isinstance(clock, ROSClock) and clock.ros_time_is_active:
            return real(clock)
        is_steady = clock.clock_type.name == 'STEADY_TIME'
        nanoseconds = world.now if is_steady else world.wall
        return Time(nanoseconds=nanoseconds, clock_type=clock.clock_type)

    return now


def _log(world):
    def log(logger, message, severity, **options):
        world.logged.append((world.now, LoggingSeverity(severity).name, str(message)))
        return True

    return log


def _publish(world):
    def publish(publisher, message):
        data = serialize_message(message)
        world.said.append((world.now, publisher.topic_name, type(message), data))

    return publish


def _patient(wait):
    """Return a wait whose limit does not depend on how busy the machine is."""

    def patient(waiting, timeout=None):
        return wait(waiting, None if timeout is None else max(timeout, DEADLINE))

    return patient


class PatientProcess(subprocess.Popen):
    """A real process that is waited for until it has ended, however busy the machine is."""

    def wait(self, timeout=None):
        """Return how it ended."""
        return super().wait()


def _process(world):
    def process(command, *args, **options):
        if world.worker is not None and WORKER in command:
            return ScriptedWorker(world.worker)
        made = PatientProcess(command, *args, **options)
        world.processes.append(made)
        return made

    return process


def _spin_once(world):
    def spin_once(executor, timeout_sec=None):
        world.wait(timeout_sec or 0.0)

    return spin_once
