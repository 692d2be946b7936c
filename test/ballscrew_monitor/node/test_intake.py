# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""All that waits is taken at once, in the order of arrival, and what was lost is counted."""

import functools
import threading
import time
import types

from ballscrew_monitor.core.conversions import nanoseconds, Scaling, SECOND
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.node import intake as intake_module
from ballscrew_monitor.node.intake import Intake, LONGER, PAUSE, QUIET, STAY
from ballscrew_monitor.node.topic import Topic
from ballscrew_monitor.settings.qos import started_node
import pytest
import rclpy
from rclpy.clock import Clock, ClockType, ROSClock
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

DEADLINE = 600.0  # [s] which only ends a hang


def float_input(source, topic):
    scaling = Scaling(factor=1.0, shift=0.0)
    one = OpenInput(source=source, topic=topic, field='data', scaling=scaling)
    return one.close('std_msgs/msg/Float64')


class Watch:
    """A clock for the intake that goes on by its pauses, in those in which it may."""

    def __init__(self, monkeypatch, may_go_on=lambda: True):
        self.now, self.may_go_on = 0.0, may_go_on
        self.time_ns, self.monotonic_ns = time.time_ns, time.monotonic_ns
        self.end = time.monotonic() + DEADLINE
        monkeypatch.setattr(intake_module, 'time', self)

    def monotonic(self):
        return self.now

    def sleep(self, pause):
        assert time.monotonic() < self.end, 'the clock stands'
        if self.may_go_on():
            self.now += pause


class WaitSet:
    """Counts what it is to wait for."""

    def __init__(self):
        self.subscriptions = self.events = 0

    def add_subscription(self, handle):
        self.subscriptions += 1
        return self.subscriptions - 1

    def add_event(self, handle):
        self.events += 1
        return self.events - 1


def nothing(*_):
    """Do nothing between two looks at a condition."""


def turns(intake):
    with pytest.raises(StopIteration):
        intake.execute(None).send(None)


def rest(intake, monkeypatch):
    """
    Let a turn without messages pass on a watch: the next one may last as long as any.

    On a busy machine a turn before it may have lasted for all of `STAY`.

    """
    with monkeypatch.context() as patch:
        patch.setattr(intake, 'drain', lambda: False)
        turns(intake)


class Bench:
    """A node with an intake, publishers beside it, and what was taken."""

    def __init__(self, node, wait_for):
        self.node, self.executor, self.wait_for = node, node.executor, wait_for
        inputs = (float_input(Source.LOAD, 'load'), float_input(Source.SPEED, 'speed'))
        topics = {one.source: one.topic for one in inputs}
        self.axis = types.SimpleNamespace(
            name='x', inputs=inputs, open_inputs=(), topics=topics, max_future=0, one_source=True
        )
        self.taken = []
        self.intake = Intake(self.node, [self.axis], self.take)
        self.publishers = {
            name: self.node.create_publisher(Float64, name, 300) for name in ('load', 'speed')
        }
        self.until(lambda: self.matched() == {Source.LOAD: 1, Source.SPEED: 1})
        self.drain_events()

    def take(self, axis, event):
        self.taken.append(event)

    def begin_anew(self, take, **options):
        """Let another intake hand its events to `take`, with a publisher of the speed."""
        self.intake.close()
        self.intake = Intake(self.node, [self.axis], take, **options)
        self.until(lambda: self.matched()[Source.SPEED] == 1)
        self.drain_events()

    def matched(self):
        return {source: link.matched for source, link in self.intake.links(self.axis).items()}

    def until(self, condition, meanwhile=None):
        """Wait for a condition; meanwhile the executor spins, or else what is given."""
        spin = functools.partial(self.executor.spin_once, timeout_sec=0.02)
        return self.wait_for(condition, meanwhile=meanwhile or spin)

    def drain_events(self):
        """Let the executor hand over what the match of the publishers has left."""
        for _ in range(20):
            self.executor.spin_once(timeout_sec=0.0)

    def publish(self, name, value):
        self.publishers[name].publish(Float64(data=float(value)))


@pytest.fixture(name='bench')
def make_bench(wait_for):
    with free_domain() as domain, started_node('taker', domain) as node:
        yield Bench(node, wait_for)


def test_one_wake_up_takes_all_topics_in_the_order_of_arrival(bench):
    for i in range(50):
        bench.publish('speed', 2 * i)
        bench.publish('load', 2 * i + 1)
    bench.until(lambda: bench.taken)
    before = len(bench.taken)
    bench.until(lambda: len(bench.taken) == 100)
    assert [event.value for event in bench.taken] == list(range(100))
    assert {event.lost for event in bench.taken} == {0}
    assert before > 1  # not a message for each wake-up
    arrivals = [event.arrival for event in bench.taken]
    assert arrivals == sorted(arrivals)


def test_what_comes_while_the_topics_are_looked_at_keeps_its_order(bench, monkeypatch):
    """A load and then a speed, just after the topic of the load has been looked at."""
    taken, sent = Topic.taken, []

    def late(topic):
        found = taken(topic)
        if topic.name != '/speed' or sent:
            return found
        for name in ('load', 'speed'):
            sent.append(name)
            bench.publish(name, len(sent))
        return bench.until(lambda: taken(topic), meanwhile=nothing)

    monkeypatch.setattr(Topic, 'taken', late)
    assert bench.intake.drain()
    assert [event.value for event in bench.taken] == [1.0, 2.0]


def test_what_waits_is_taken_without_a_wake_up(bench):
    bench.publish('speed', 1)
    bench.until(lambda: bench.taken, meanwhile=bench.intake.drain)
    assert [event.value for event in bench.taken] == [1.0]
    bench.executor.spin_once(timeout_sec=0.0)  # finds nothing left
    assert len(bench.taken) == 1


def test_a_number_is_read_without_an_object_of_its_message(bench, monkeypatch):
    decoded, decode = [], Topic.decoded
    monkeypatch.setattr(Topic, 'decoded', lambda *args: decoded.append(args) or decode(*args))
    for value in range(5):
        bench.publish('speed', value)
    bench.until(lambda: len(bench.taken) == 5, meanwhile=bench.intake.drain)
    assert [event.value for event in bench.taken] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert decoded == []


def test_what_a_full_queue_drops_is_counted(bench):
    bench.publish('speed', 0)
    bench.until(lambda: bench.taken)
    for i in range(1, 3000):
        bench.publish('speed', i)
    bench.until(lambda: bench.taken[-1].value == 2999.0)
    lost = sum(event.lost for event in bench.taken)
    assert len(bench.taken) + lost == 3000
    assert lost > 0


class AtOnce:
    """An intake whose turns are judged compiled, and the values and losses that they hold."""

    def __init__(self, bench):
        self.values, self.losses, self.counted, self.rests = [], [], 0, set()
        self.at_rest = threading.Event()
        bench.begin_anew(None, compiled=self, take_many=self._take)

    @property
    def are_due(self):
        return True

    def count(self, events, now):
        self.counted += events

    def _take(self, turn):
        self.rests.add(self.at_rest.is_set())
        self.values += turn.events['value'].tolist()
        self.losses += turn.events['lost'].tolist()


def test_turns_that_are_judged_compiled_hold_all_in_the_order_of_arrival(bench):
    intake = AtOnce(bench)
    for i in range(50):
        bench.publish('speed', 2 * i)
        bench.publish('load', 2 * i + 1)
    bench.until(lambda: len(intake.values) == 100)
    assert intake.values == list(range(100))
    assert set(intake.losses) == {0}
    assert intake.counted == 100
    assert intake.rests == {False}
    assert intake.at_rest.is_set()
    for i in range(100, 3100):
        bench.publish('speed', i)
    bench.until(lambda: intake.values[-1] == 3099.0)
    assert len(intake.values) + sum(intake.losses) == 3100
    assert sum(intake.losses) > 0


def test_a_turn_that_cannot_be_read_compiled_is_read_message_by_message(bench):
    intake, failures = AtOnce(bench), []
    intake.give_up = failures.append
    bench.intake._take = bench.take
    bench.intake._turns = types.SimpleNamespace(turn=lambda *_: failures.append(1 / 0))
    for number in range(20):
        bench.publish('speed', number)
    bench.until(lambda: len(bench.taken) == 20)
    assert [event.value for event in bench.taken] == list(range(20))
    assert {type(failure) for failure in failures} == {ZeroDivisionError}


def test_a_leap_of_simulated_time_ends_a_turn_that_is_judged_compiled(bench, monkeypatch):
    intake, steps, turns = AtOnce(bench), [], []
    bench.axis.monitor = types.SimpleNamespace(set_clock=lambda due, now: steps.append(now - due))
    monkeypatch.setattr(
        bench.intake, '_take_many', lambda turn: turns.append(turn.events['arrival'].tolist())
    )
    for _ in range(4):
        bench.publish('speed', 1.0)
    found = held(bench, 4)
    clock = types.SimpleNamespace(readers=[])

    def shown(second):
        time = types.SimpleNamespace(sec=second, nanosec=0)
        return types.SimpleNamespace(topic=clock, message=types.SimpleNamespace(clock=time))

    waiting = [shown(9), found[0], shown(10), found[1], shown(500), found[2], shown(20), found[3]]
    monkeypatch.setattr(bench.intake, '_clock', clock)
    monkeypatch.setattr(bench.intake, '_waiting', lambda: waiting)
    bench.intake.drain()
    assert turns == [[9 * SECOND, 10 * SECOND], [500 * SECOND], [20 * SECOND]]
    assert steps == [489 * SECOND, -481 * SECOND]
    assert intake.counted == 4
    assert len(bench.intake._turns._slots.slots) == 2  # those of the load too, which is silent


@pytest.mark.parametrize('hours', [1, -1])
def test_a_step_of_the_system_clock_is_one_event_between_two_turns(bench, monkeypatch, hours):
    """It is one of the steady clock the other way round."""
    happened, said, steady = [], [], intake_module.time.monotonic_ns
    bench.axis.monitor = types.SimpleNamespace(
        set_clock=lambda due, now: happened.append(round((now - due) / SECOND))
    )
    monkeypatch.setattr(bench.intake, '_take', lambda axis, event: happened.append(event.value))
    monkeypatch.setattr(bench.intake, '_stepped', lambda step, now: said.append(step))
    recorded = []
    recorder = types.SimpleNamespace(
        raw=False,
        hear=nothing,
        take=lambda turn, *_: recorded.extend(event.value for _, event in turn),
        set_clock=lambda due, now, _: recorded.append(round((now - due) / SECOND)),
        flush=nothing,
    )
    monkeypatch.setattr(bench.intake, '_recorder', recorder)
    bench.publish('speed', 1)
    bench.until(lambda: happened, meanwhile=bench.intake.drain)
    step = hours * 3600 * SECOND
    monkeypatch.setattr(intake_module.time, 'monotonic_ns', lambda: steady() - step)
    bench.intake.drain()
    bench.intake.drain()
    bench.publish('speed', 2)
    bench.until(lambda: len(happened) == 3, meanwhile=bench.intake.drain)
    assert happened == recorded == [1.0, hours * 3600, 2.0]
    assert [round(one / SECOND) for one in said] == [hours * 3600]


def held(bench, count):
    """Return what has arrived, and was not taken, when it is so many messages."""
    arrivals, waiting = [], bench.intake._waiting
    return bench.wait_for(
        lambda: arrivals.extend(waiting()) or (arrivals if len(arrivals) == count else None),
        meanwhile=nothing,
    )


def test_what_comes_with_a_time_of_the_clock_is_one_turn(bench, monkeypatch):
    """The speed is judged last, whichever came first."""
    bench.publish('speed', 1)
    bench.publish('load', 2)
    found = sorted(held(bench, 2), key=lambda one: one.topic.name, reverse=True)
    shown = types.SimpleNamespace(clock=types.SimpleNamespace(sec=9, nanosec=0))
    clock = types.SimpleNamespace(topic=object(), message=shown)
    monkeypatch.setattr(bench.intake, '_clock', clock.topic)
    monkeypatch.setattr(bench.intake, '_waiting', lambda: [clock, *found])
    turns = []
    monkeypatch.setattr(bench.intake._recorder, 'take', lambda turn, *_: turns.append(len(turn)))
    bench.intake.drain()
    assert turns == [2]
    assert [event.source for event in bench.taken] == [Source.LOAD, Source.SPEED]


def test_messages_before_and_after_a_step_are_two_turns(bench, monkeypatch):
    steady, steps = intake_module.time.monotonic_ns, []
    bench.axis.monitor = types.SimpleNamespace(set_clock=lambda due, now: steps.append(now - due))
    bench.intake.drain()
    bench.publish('speed', 1)
    bench.publish('speed', 2)
    found = held(bench, 2)
    step = 3600 * SECOND
    found[0].received -= step
    monkeypatch.setattr(bench.intake, '_waiting', lambda: found)
    monkeypatch.setattr(intake_module.time, 'monotonic_ns', lambda: steady() - step)
    turns = []
    monkeypatch.setattr(bench.intake._recorder, 'take', lambda turn, *_: turns.append(len(turn)))
    bench.intake.drain()
    assert [event.value for event in bench.taken] == [1.0, 2.0]
    assert turns == [1, 1]
    assert [round(one / SECOND) for one in steps] == [3600]


def test_with_a_second_publisher_loss_is_not_known(bench):
    bench.publish('speed', 1)
    bench.until(lambda: bench.taken)
    assert bench.taken[-1].lost == 0
    second = bench.node.create_publisher(Float64, 'speed', 10)
    bench.until(lambda: bench.matched()[Source.SPEED] == 2)
    bench.drain_events()
    bench.publish('speed', 2)
    second.publish(Float64(data=3.0))
    bench.until(lambda: len(bench.taken) == 3)
    assert [event.lost for event in bench.taken[1:]] == [None, None]


def test_a_second_publisher_is_noticed_before_the_executor_tells_of_it(bench):
    bench.publish('speed', 1)
    bench.until(lambda: bench.taken)
    second = bench.node.create_publisher(Float64, 'speed', 10)
    bench.until(lambda: bench.matched()[Source.SPEED] == 2, meanwhile=nothing)
    second.publish(Float64(data=2.0))
    bench.publish('speed', 3)
    bench.until(lambda: len(bench.taken) == 3, meanwhile=bench.intake.drain)
    assert [event.lost for event in bench.taken] == [0, None, None]


def test_what_waits_is_taken_before_the_publishers_are_counted_anew(bench, monkeypatch):
    done, loss = [], bench.intake.topics['/speed'].loss
    match, drain = loss.match, bench.intake.drain
    monkeypatch.setattr(bench.intake, 'drain', lambda: done.append('drain') or drain())
    monkeypatch.setattr(loss, 'match', lambda count: done.append(count) or match(count))
    second = bench.node.create_publisher(Float64, 'speed', 10)
    bench.until(lambda: loss.publishers == 2)
    assert second.topic_name == '/speed'
    assert done[:2] == ['drain', 2]


def test_a_look_tells_whether_anything_has_come(bench):
    assert not bench.intake.drain()
    bench.publish('speed', 1)
    bench.until(bench.intake.drain, meanwhile=nothing)
    assert [event.value for event in bench.taken] == [1.0]
    assert not bench.intake.drain()


def test_a_closed_intake_takes_nothing(bench):
    bench.intake.close()
    bench.publish('speed', 1)
    bench.intake.drain()
    bench.drain_events()
    assert bench.taken == []
    assert bench.intake.topics == {}


def test_what_is_waited_for_lives_until_the_wait_is_over(bench):
    """As the executor waits: an intake that is closed meanwhile is destroyed only then."""
    handles = [topic.subscription.handle for topic in bench.intake.topics.values()]
    with bench.intake:
        bench.intake.close()
        assert all(handle.pointer for handle in handles)
    assert not any(handle.pointer for handle in handles)


def test_closed_and_opened_again_while_another_thread_waits(bench):
    failures, over = [], threading.Event()

    def spin():
        try:
            while not over.is_set():
                bench.executor.spin_once(timeout_sec=0.05)
        except Exception as error:
            failures.append(error)

    def publish():
        bench.publish('speed', value)
        over.wait(0.001)

    taken = []
    thread = threading.Thread(target=spin)
    thread.start()
    try:
        for value in range(20):
            bench.intake.close()
            bench.intake = Intake(bench.node, [bench.axis], lambda _, one: taken.append(one.value))
            bench.until(lambda value=value: value in taken or failures, meanwhile=publish)
    finally:
        over.set()
        thread.join()
    assert failures == []
    assert set(taken) == set(range(20))


def test_without_messages_a_turn_is_short_and_with_them_as_long_as_allowed(bench, monkeypatch):
    watch, looks = Watch(monkeypatch), []
    rest(bench.intake, monkeypatch)
    for comes, length in ((False, QUIET), (True, STAY)):
        monkeypatch.setattr(bench.intake, 'drain', lambda comes=comes: looks.append(0) or comes)
        begin = watch.now
        turns(bench.intake)
        assert watch.now - begin == pytest.approx(length, abs=1.01 * PAUSE)
    assert len(looks) == pytest.approx((QUIET + STAY) / PAUSE, abs=4)


def test_no_pause_lasts_until_after_a_timer_is_due(bench, monkeypatch):
    """The pauses of a turn that is judged compiled are longer."""
    watch, due = Watch(monkeypatch), 0.75 * LONGER * PAUSE
    rest(bench.intake, monkeypatch)
    monkeypatch.setattr(bench.intake, '_compiled', types.SimpleNamespace(are_due=True))
    monkeypatch.setattr(bench.intake, '_time_to_timer', lambda: due)
    monkeypatch.setattr(bench.intake, 'drain', lambda: True)
    begin = watch.now
    turns(bench.intake)
    assert watch.now - begin == pytest.approx(due)


def test_after_a_turn_of_full_length_the_next_one_is_a_single_look(bench, monkeypatch):
    Watch(monkeypatch)
    rest(bench.intake, monkeypatch)
    looks, counts = [], []
    monkeypatch.setattr(bench.intake, 'drain', lambda: looks.append(0) or True)
    for _ in range(4):
        before = len(looks)
        turns(bench.intake)
        counts.append(len(looks) - before)
    assert counts[0] > STAY / PAUSE / 2
    assert counts == [counts[0], 1, counts[0], 1]


@pytest.mark.parametrize(('due', 'count'), [(False, 0), (True, 1)])
def test_while_messages_flow_a_turn_judged_compiled_begins_with_a_pause_if_no_timer_is_due(
    bench, monkeypatch, due, count
):
    watch, looks, left = Watch(monkeypatch), [], [STAY]
    rest(bench.intake, monkeypatch)
    monkeypatch.setattr(bench.intake, '_compiled', types.SimpleNamespace(are_due=True))
    monkeypatch.setattr(bench.intake, '_time_to_timer', lambda: left[0])
    monkeypatch.setattr(bench.intake, 'drain', lambda: looks.append(watch.now) or True)
    begin = watch.now
    turns(bench.intake)
    assert looks[0] == begin  # nothing flowed before
    left[0] = 0.0 if due else STAY
    for _ in range(2):  # the first one leaves the others their turn
        before, begin = len(looks), watch.now
        turns(bench.intake)
        assert looks[before:].count(begin) == count


def test_a_message_that_comes_within_a_turn_is_taken_within_it(bench, monkeypatch):
    taken = []

    def take(axis, event):
        taken.append(event.value)
        if len(taken) == 1:
            bench.publish('speed', 2)

    bench.begin_anew(take)
    Watch(monkeypatch, may_go_on=lambda: len(taken) != 1)
    rest(bench.intake, monkeypatch)
    bench.publish('speed', 1)
    bench.until(lambda: taken)
    assert taken == [1.0, 2.0]


def test_messages_without_end_leave_the_others_their_turn(bench, monkeypatch):
    """Each message taken brings forth the next one; the clock goes on only when one was taken."""
    taken, seen, ticks = [], [], []

    def take(axis, event):
        taken.append(event.value)
        bench.publish('speed', len(taken))

    def has_come():
        come = len(taken) > len(seen)
        seen[:] = taken
        return come

    bench.begin_anew(take)
    watch = Watch(monkeypatch)
    rest(bench.intake, monkeypatch)
    watch.now, watch.may_go_on = 0.0, has_come
    bench.publish('speed', 0)
    bench.until(lambda: taken)
    assert watch.now >= STAY
    steady = Clock(clock_type=ClockType.STEADY_TIME)
    bench.node.create_timer(1e-3, lambda: ticks.append(len(taken)), clock=steady)
    bench.until(lambda: len(ticks) == 3)
    assert watch.now < 7 * (STAY + 2 * PAUSE)  # two turns before each tick at most


def test_a_timer_of_a_composed_node_keeps_its_calls(bench, monkeypatch):
    """The clock of its timer goes on by the pauses of turns that messages never end."""
    period, length = 0.01, 1.0
    clock, calls, taken = ROSClock(), [], []
    clock._set_ros_time_is_active(True)

    def take(axis, event):
        taken.append(event.value)
        bench.publish('speed', len(taken))

    def shown():
        watch.now += PAUSE
        clock.set_ros_time_override(
            Time(nanoseconds=nanoseconds(watch.now), clock_type=ClockType.ROS_TIME)
        )
        return False

    bench.begin_anew(take)
    watch = Watch(monkeypatch, may_go_on=shown)
    shown()
    rest(bench.intake, monkeypatch)
    composed = rclpy.create_node('composed', context=bench.node.context)
    composed.create_timer(period, lambda: calls.append(watch.now), clock=clock)
    bench.executor.add_node(composed)
    begin = watch.now
    bench.publish('speed', 0)
    bench.until(lambda: watch.now - begin >= length)
    composed.destroy_node()
    assert len(calls) >= 0.99 * length / period
    assert len(taken) > len(calls)


@pytest.mark.parametrize('comes', ['by a discovered topic', 'by a closed intake'])
def test_topics_that_change_while_the_executor_makes_ready_to_wait_count_not_yet(bench, comes):
    """As in an executor with several threads: another one works while this one gets ready."""
    with bench.intake:
        before = bench.intake.get_num_entities()
        if comes == 'by a discovered topic':
            source = float_input(Source.TORQUE, 'torque')
            bench.intake._read(bench.axis, source)
        else:
            bench.intake.close()
        wait_set = WaitSet()
        bench.intake.add_to_wait_set(wait_set)
        assert wait_set.subscriptions == before.num_subscriptions == 2
        assert wait_set.events <= before.num_events == 2


def open_bench(bench, *fields):
    """Let another intake begin with open inputs on the topic `late`, of these fields."""
    sources = (Source.SPEED, Source.TORQUE)
    scaling = Scaling(factor=1.0, shift=0.0)
    opened = tuple(
        OpenInput(source=source, topic='late', field=field, scaling=scaling)
        for source, field in zip(sources, fields, strict=False)
    )
    bench.intake.close()
    bench.axis.inputs, bench.axis.open_inputs = (), opened
    bench.axis.topics = {one.source: one.topic for one in opened}
    bench.intake = Intake(bench.node, [bench.axis], bench.take)


def discovered(bench, condition):
    bench.until(lambda: bench.intake.discover() or condition())


def test_an_open_input_takes_the_type_of_its_publisher(bench):
    open_bench(bench, 'data', 'data')
    link = bench.intake.links(bench.axis)[Source.SPEED]
    assert (link.topic, link.type_name, link.publishers) == ('/late', '', ())
    bench.intake.discover()
    assert bench.intake.topics == {}
    late = bench.node.create_publisher(Float64, 'late', 10)
    discovered(bench, lambda: bench.intake.topics and set(bench.matched().values()) == {1})
    assert list(bench.intake.topics) == ['/late']
    late.publish(Float64(data=5.0))
    bench.until(lambda: len(bench.taken) == 2)
    expected = {(Source.SPEED, 5.0), (Source.TORQUE, 5.0)}
    assert {(event.source, event.value) for event in bench.taken} == expected


def test_an_open_input_whose_field_is_not_in_the_type_says_so_and_waits_on(bench):
    open_bench(bench, 'velocity[x]')
    late = bench.node.create_publisher(Float64, 'late', 10)
    problem = "field 'velocity[x]': Float64 has no field 'velocity', it has data"
    discovered(bench, lambda: bench.intake.links(bench.axis)[Source.SPEED].problem == problem)
    bench.node.destroy_publisher(late)
    joints = bench.node.create_publisher(JointState, 'late', 10)
    discovered(bench, lambda: bench.matched() == {Source.SPEED: 1})
    joints.publish(JointState(name=['x'], velocity=[3.0]))
    bench.until(lambda: bench.taken)
    assert bench.taken[0].value == 3.0


def test_of_two_types_on_a_topic_an_open_input_takes_none(bench):
    open_bench(bench, 'data')
    bench.node.create_publisher(Float64, 'late', 10)

    def types():
        link = bench.intake.links(bench.axis)[Source.SPEED]
        return {publisher.type_name for publisher in link.publishers}

    # One participant may not give a topic two types.
    with started_node('other', bench.node.context.get_domain_id()) as other:
        other.create_publisher(JointState, 'late', 10)
        bench.until(lambda: len(types()) == 2)
        bench.intake.discover()
        assert bench.intake.topics == {}
    discovered(bench, lambda: bench.matched() == {Source.SPEED: 1})
