# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The node in its own process, over the real middleware."""

import contextlib
import functools
import itertools
import math
import signal
from types import SimpleNamespace

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.core.inputs import Input, InputSample, Source
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node import event_recorder
from ballscrew_monitor.node.alarm import Alarm
from ballscrew_monitor.node.axis_publisher import AxisPublisher, NEWS_INTERVAL
from ballscrew_monitor.node.kept_axes import LOOK, PERIOD
from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_monitor.node.topic import Arrival, RECEIVED
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import DEPTH
from ballscrew_msgs.msg import BallScrewState, OperatingPoint, PointResult
from ballscrew_msgs.srv import AcknowledgeAlarm, EvaluateOperatingPoint, ShelveAlarm
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
import rclpy
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from surrogate.surface import shipped_surface, Surface
from surrogate.tasks import child

FAST, SLOW = 100.0, 0.8  # [rad/s] optimal and outside at 1 kN and 40 degC
# The stamps of a test run ahead of the clock, and a busy machine makes no sample stale.
AHEAD = {'x__max_future': 3600.0, 'x__speed__timeout': 60.0, 'x__load__timeout': 60.0}


def axes_told(message):
    return tuple(dict.fromkeys(status.name.split(': ')[1] for status in message.status))


def feed(node, publish, states, speed, count, **changes):
    done = states[-1].judged if states else 0
    for _ in range(count):
        publish(speed, **changes)
    node.until(lambda: states and states[-1].judged == done + count, 'the last state')


def test_each_sample_becomes_a_state_of_its_own_stamp(node):
    node.start(**AHEAD)
    states, publish = node.watched()
    first = node.stamp
    feed(node, publish, states, FAST, 20)
    judged = [state for state in states if state.judged]
    assert [state.judged for state in judged] == list(range(1, 21))
    assert list(map(stamp_of, judged)) == [first + (i + 1) * 10_000_000 for i in range(20)]
    expected = Surface.load(shipped_surface()).lookup(FAST, 1000.0, 313.15)
    last = judged[-1]
    assert last.result.validity == PointResult.VALIDITY_VALID
    assert last.result.efficiency == expected.efficiency
    assert last.result.rcs == expected.rcs
    assert last.point.axial_load == -1000.0
    assert last.zone == BallScrewState.ZONE_OPTIMAL
    assert last.inputs[0].received == 20


def test_a_stay_outside_is_warned_of_and_latched_for_late_joiners(node):
    node.start(x__advice__speed='true', **AHEAD)
    states, publish = node.watched()
    early = node.events()
    none_yet = node.until(lambda: early and early[0], 'the first event message')
    assert (none_yet.event_id, none_yet.active, none_yet.axis) == (0, False, 'x')
    feed(node, publish, states, SLOW, 51)
    assert states[-1].level == BallScrewState.LEVEL_WARN
    late = node.events()
    begun = node.until(lambda: late and late[0], 'the latched event')
    assert (begun.event_id, begun.active, begun.duration) == (1, True, 0.5)
    assert begun.cause.target_speed > SLOW
    assert begun.advice.startswith('at this load run at')
    assert math.isnan(begun.cause.target_load)
    node.set_parameters(x__advice__speed=False)
    feed(node, publish, states, FAST, 101)
    over = node.until(lambda: late[1:], 'the end of the event')[0]
    assert (over.event_id, over.active) == (1, False)
    assert over.worst_value == begun.worst_value
    assert over.advice == ''  # what the process allows may change at any time
    assert math.isnan(over.cause.target_speed)
    assert states[-1].level == BallScrewState.LEVEL_OK
    assert node.stop() == 0
    assert 'event 1: ' in node.output.read_text()


def test_silence_is_told_on_the_tick_and_clears_nothing(node):
    node.start(x__speed__timeout=0.2, x__limits__raise_delay=0.0, x__max_lag=60.0)
    states, publish = node.watched()
    node.stamp = node.now() - 10_000_000
    feed(node, publish, states, SLOW, 1)
    assert states[-1].level == BallScrewState.LEVEL_WARN
    silent = node.until(
        lambda: states[-1].point.speed_source == OperatingPoint.SOURCE_HELD and states[-1],
        'a state on the tick',
    )
    assert silent.result.validity == PointResult.VALIDITY_NO_INPUT
    assert silent.level == BallScrewState.LEVEL_WARN
    assert silent.header.stamp.nanosec % 100_000_000 == 0
    node.until(lambda: any(message.startswith('speed is stale') for _, message in node.levels()))
    assert node.levels('x: Lubrication')[-1][0] == DiagnosticStatus.WARN


def test_limits_change_live_and_bad_ones_are_refused(node):
    node.start(**AHEAD)
    states, publish = node.watched()
    heard = node.infos()
    info = node.until(lambda: heard and heard[-1], 'the surface info')
    surface = Surface.load(shipped_surface())
    assert (info.sha256, info.screw, info.oil) == (surface.sha256, 'nominal', 'iso_vg_68')
    assert (info.speed_min, info.speed_max) == surface.speed_range
    assert 'rcs' in info.error_field
    feed(node, publish, states, FAST, 1)
    assert node.set_parameters(x__limits__efficiency=0.99, x__limits__rcs=0.02).successful
    node.until(lambda: heard[-1].rcs_limit == 0.02, 'the new limit')
    feed(node, publish, states, FAST, 1)
    assert (states[-1].efficiency_limit, states[-1].rcs_limit) == (0.99, 0.02)
    assert states[-1].zone == BallScrewState.ZONE_OUTSIDE
    for values, reason in (
        ({'x__limits__rcs': 0.03, 'x__limits__efficiency': 2.0}, 'out of range'),
        ({'x__limits__rcs': 1}, 'Wrong parameter type'),
        ({'axes': ['y']}, 'read-only'),
        ({'x__handedness': 'left'}, 'changes only while the node is unconfigured'),
    ):
        result = node.set_parameters(**values)
        assert not result.successful
        assert reason in result.reason
    feed(node, publish, states, FAST, 1)
    assert states[-1].rcs_limit == 0.02


def test_the_lifecycle_from_outside(node, says):
    arguments = ('-p', 'start_type_description_service:=false')  # of any node, and no slip
    node.start(*arguments, autostart='false', **AHEAD)
    names = node.call(ListParameters, 'list_parameters').result.names
    assert {'axes', 'x.limits.rcs', 'x.speed.topic'} <= set(names)
    (found,) = node.call(
        DescribeParameters, 'describe_parameters', names=['x.limits.standstill_speed']
    ).descriptors
    assert found.description.endswith('[rad/s]')
    assert found.floating_point_range[0].from_value == 1e-3
    assert node.lifecycle() == 'unconfigured'
    assert not node.call(EvaluateOperatingPoint, 'evaluate', axis='x').success
    node.until(lambda: node.levels()[-1:] == [(DiagnosticStatus.ERROR, 'not configured')])
    assert node.set_parameters(x__handedness='left').successful
    assert node.transition('configure')
    node.until(
        lambda: (
            node.levels()[-1]
            == (DiagnosticStatus.STALE, 'the node is inactive, nothing is judged')
        )
    )
    assert node.node.count_subscribers('joint_states') == 0
    surface = Surface.load(shipped_surface()).sha256[:16]
    assert node.output.read_text().count(says('start', surface=surface)) == 1
    assert node.transition('activate')
    states, publish = node.watched()
    feed(node, publish, states, FAST, 2)
    assert states[-1].point.speed == -FAST
    assert node.transition('deactivate')
    node.until(lambda: node.node.count_subscribers('joint_states') == 0)
    assert node.transition('activate')
    node.until_matched(*node.publishers)
    feed(node, publish, states, FAST, 1)
    assert states[-1].judged == 3
    assert node.transition('deactivate')
    assert node.transition('cleanup')
    assert node.set_parameters(x__handedness='right').successful
    assert node.transition('configure')
    assert node.transition('shutdown')
    assert node.lifecycle() == 'finalized'
    assert node.stop() == 0


@pytest.mark.parametrize(
    ('name', 'value', 'reason'),
    [
        ('x__surface', '/no/such/file.npz', '/no/such/file.npz'),
        ('x__speed__field', 'velocity', 'not a number'),
        ('x__load__topic', 'joint_states', 'is configured as'),
    ],
)
def test_a_failed_configure_leaves_the_node_alive_with_the_reason(node, name, value, reason):
    arguments = ('-p', f'{name.replace("__", ".")}:={value}')
    node.start(*arguments)
    level, message = node.until(
        lambda: next((said for said in node.levels('x: Surface') if reason in said[1]), None),
        reason,
    )
    assert level == DiagnosticStatus.ERROR
    assert message.startswith('not configured: ')
    said = [status for array in node.told for status in array.status]
    assert Fault.NOT_BUILT in {
        diagnostics.code_of(one) for one in said if one.name.endswith('x: Surface')
    }
    assert node.lifecycle() == 'unconfigured'
    assert reason in node.output.read_text()
    assert node.stop(signal.SIGTERM) == 0


def test_a_bad_parameter_at_start_is_one_sentence_and_exit_code_2(node, says):
    node.start('-p', 'x.limits.rcs:=7.0')
    assert node.end() == 2
    said = node.output.read_text().splitlines()
    assert len(said) == 1
    assert said[0].startswith(f'ballscrew_monitor: {says("limits_rcs_7")}')


@pytest.mark.parametrize(('number', 'times'), [(signal.SIGINT, 2), (signal.SIGTERM, 1)])
def test_signals_end_the_node_cleanly(node, number, times):
    node.start(**AHEAD)
    publish = node.machine()
    for _ in range(20):
        publish(FAST)
    for _ in range(times - 1):
        node.process.send_signal(number)
    assert node.stop(number) == 0
    assert 'Traceback' not in node.output.read_text()


def test_evaluate_answers_for_many_points_at_once(node):
    node.start()
    node.until(lambda: node.lifecycle() == 'active')
    points = [
        OperatingPoint(speed=speed, axial_load=-1000.0, temperature=temperature)
        for speed in (FAST, -FAST, 1e4)
        for temperature in (math.nan, 60.0)
    ]
    answer = node.call(EvaluateOperatingPoint, 'evaluate', axis='x', points=points)
    assert (answer.success, answer.message) == (True, '')
    surface = Surface.load(shipped_surface())
    expected = [
        surface.lookup(FAST, load, temperature).efficiency
        for load in (1000.0, -1000.0)
        for temperature in (313.15, 333.15)
    ]
    assert [result.efficiency for result in answer.results[:4]] == expected
    assert answer.results[4].validity == PointResult.VALIDITY_SPEED_ABOVE_RANGE
    full = [OperatingPoint(speed=FAST, temperature=40.0)] * 10_000
    assert (
        len(node.call(EvaluateOperatingPoint, 'evaluate', axis='x', points=full).results) == 10_000
    )
    for axis, asked, message in (
        ('x', [*full, full[0]], '10001 points are too many'),
        ('q', [], "axis 'q' is unknown, known are: x"),
    ):
        answer = node.call(EvaluateOperatingPoint, 'evaluate', axis=axis, points=asked)
        assert not answer.success
        assert message in answer.message
        assert answer.results == []


def test_what_arrives_while_many_points_are_evaluated_is_taken(monkeypatch, wait_for):
    """With each point a sample comes; the queue of an input holds far fewer than there are."""
    with started(state_dir='') as node:
        machine = rclpy.create_node('machine', context=node.context)
        speeds = machine.create_publisher(JointState, 'joint_states', 1000)
        monitor = node._axis_publishers['x'].axis.monitor
        wait_for(speeds.get_subscription_count, 'the match')
        reader = node._intake.topics['/joint_states'].subscription
        wait_for(reader.get_publisher_count, 'the match')

        def evaluated(self, point):
            speeds.publish(JointState(name=['x_axis'], velocity=[FAST]))
            return PointResult()

        monkeypatch.setattr(AxisPublisher, '_evaluate', evaluated)
        request = EvaluateOperatingPoint.Request(axis='x', points=[OperatingPoint()] * 2 * DEPTH)
        response = node._on_evaluate(request, EvaluateOperatingPoint.Response())
        assert len(response.results) == 2 * DEPTH

        def last():
            status = monitor.input_status(node.get_clock().now().nanoseconds)[0]
            assert status.lost in (0, None)
            return status.received == 2 * DEPTH

        wait_for(last, 'the last sample', meanwhile=node._intake.drain)
        machine.destroy_node()


def test_the_clock_is_not_changed_while_the_node_is_configured(node, says):
    node.start()
    node.until(lambda: node.lifecycle() == 'active')
    answer = node.set_parameters(use_sim_time=True)
    assert (answer.successful, answer.reason) == (False, says('use_sim_time'))
    node.until(lambda: node.levels(), 'diagnostics that still come')
    assert node.transition('deactivate')
    assert node.transition('cleanup')
    assert node.set_parameters(use_sim_time=True).successful


def test_a_node_takes_its_own_dump(node):
    """As `ros2 param load` does: each parameter alone, those that never change among them."""
    node.start(axes="['x','y']")
    node.until(lambda: node.lifecycle() == 'active')
    names = node.call(ListParameters, 'list_parameters').result.names
    values = node.call(GetParameters, 'get_parameters', names=names).values
    assert {'use_sim_time', 'axes', 'x.surface', 'y.limits.rcs'} <= set(names)
    dump = [
        ParameterMessage(name=name, value=value) for name, value in zip(names, values, strict=True)
    ]
    results = node.call(SetParameters, 'set_parameters', parameters=dump).results
    assert [one.reason for one in results] == [''] * len(names)
    assert all(one.successful for one in results)
    dump[names.index('axes')].value.string_array_value = ['x']
    (result,) = node.call(
        SetParameters, 'set_parameters', parameters=[dump[names.index('axes')]]
    ).results
    assert not result.successful


def test_several_axes_share_one_topic(node):
    node.start(axes="['x','y']", y__max_future=3600.0, **AHEAD)
    x, y = node.states('x'), node.states('y')
    publish = node.machine()
    feed(node, publish, x, FAST, 3)
    feed(node, publish, y, SLOW, 2, joint='y_axis')
    assert (x[-1].axis, y[-1].axis) == ('x', 'y')
    # Each saw the messages about the other one, and took no harm.
    assert y[-1].inputs[0].received == 5
    assert y[-1].inputs[0].dropped == 3
    # A tick between two samples has a state of its own, without a speed.
    assert FAST in [state.point.speed for state in x]
    assert y[-1].point.speed == SLOW
    # A change is told for its own axis, the rest once a second. One that comes together with the
    # rest has no message of its own, the next one has.
    speeds = itertools.cycle([FAST, 0.0])
    node.until(
        lambda: (
            publish(next(speeds))
            or {('x',), ('x', 'y', 'Node')} <= {axes_told(message) for message in node.told}
        ),
        'the news of x alone',
    )


def test_totals_and_warning_begin_anew_when_they_are_asked_to(node):
    node.start(x__limits__raise_delay=0.0, **AHEAD)
    states, publish = node.watched()
    feed(node, publish, states, SLOW, 3)
    assert states[-1].level == BallScrewState.LEVEL_WARN
    assert states[-1].totals.running_time == pytest.approx(0.02)
    assert node.call(Trigger, 'reset_totals').success
    assert node.call(Trigger, 'acknowledge').success
    feed(node, publish, states, FAST, 1)
    assert states[-1].level == BallScrewState.LEVEL_UNKNOWN
    assert states[-1].totals.running_time == pytest.approx(0.01)


def test_a_glitch_and_a_stamp_from_the_future_are_refused_and_counted(node):
    node.start(**AHEAD)
    states, publish = node.watched()
    feed(node, publish, states, FAST, 2)
    publish(1e12)
    feed(node, publish, states, FAST, 2)
    judged = [state for state in states if state.judged == 4][0]
    assert judged.inputs[0].dropped == 1
    assert judged.totals.running_time == pytest.approx(0.04)
    assert judged.totals.revolutions == pytest.approx(0.04 * FAST / (2.0 * math.pi))
    publish(FAST, step=3600 * 10**9)
    node.stamp -= 3600 * 10**9
    feed(node, publish, states, FAST, 1)
    refused = next(state for state in states if state.judged == 5).inputs[0]
    assert (refused.received, refused.dropped) == (7, 2)


@contextlib.contextmanager
def started(**parameters):
    with free_domain() as domain:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain)
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        node = BallscrewMonitor(context=context, parameter_overrides=overrides)
        node.start()
        yield node
        node.finish()
        node.destroy_node()
        rclpy.shutdown(context=context)


@pytest.mark.parametrize(
    ('sim_time', 'kind'), [(False, ClockType.STEADY_TIME), (True, ClockType.ROS_TIME)]
)
def test_ticks_do_not_depend_on_the_system_clock(sim_time, kind):
    """A timer on that stands still when it is set back, and nothing would go stale."""
    with started(use_sim_time=sim_time) as node:
        assert node._tick_timer.clock.clock_type is kind


def test_axes_that_change_together_are_all_told_at_once(monkeypatch):
    """The flood of one axis must not keep back what another one has to tell."""
    told, steady = [], SimpleNamespace(nanoseconds=0)
    with started(axes=['x', 'y'], diagnostics_period=60.0) as node, monkeypatch.context() as patch:
        patch.setattr(node, '_publish_diagnostics', lambda axes=None: told.append(axes))
        patch.setattr(node, '_steady', SimpleNamespace(now=lambda: steady))
        stamp, inputs = node.get_clock().now().nanoseconds, [Source.SPEED]
        for steady.nanoseconds in (0, NEWS_INTERVAL - 1, NEWS_INTERVAL):
            for name, source in itertools.product(('x', 'y'), inputs):
                sample = InputSample(source=source, value=FAST, stamp=stamp)
                node._on_event(node._axis_publishers[name].axis, sample)
            stamp, inputs = stamp + nanoseconds(0.2), [Source.LOAD, Source.SPEED]
        assert told == [['x'], ['y']] * 2


def speeds(node):
    """Let both axes have two samples of their speeds."""
    stamp = node.get_clock().now().nanoseconds
    for value, name in itertools.product((FAST, SLOW), 'xy'):
        sample = InputSample(source=Source.SPEED, value=value, stamp=stamp)
        node._on_event(node._axis_publishers[name].axis, sample)


def hears(node):
    """Let the intake find two messages about x, which y reads too."""
    topic = node._intake.topics['/joint_states']
    message = JointState(name=['x_axis'], velocity=[FAST])
    taken = [(Arrival(1, message, number, topic), {RECEIVED: 1}) for number in (1, 2)]
    names = ('loss', 'sources', 'subscription', 'type_name')
    parts = {name: getattr(topic, name) for name in names}
    node._intake.topics['/joint_states'] = SimpleNamespace(
        taken=lambda: taken, arrival=lambda arrival, info: arrival, **parts
    )
    node._intake.drain()


def looks(node):
    for _ in range(round(PERIOD / LOOK)):
        node._kept._look()


def serves(node, path, kind, **request):
    service = next(one for one in node.services if one.srv_name == path)
    answer = service.callback(kind.Request(**request), kind.Response())
    assert (answer.success, 'ZeroDivisionError' in answer.message) == (False, True)


def solves(node):
    assert 'ZeroDivisionError' in node._axis_publishers['x'].current_point()


REQUESTS = {
    'acknowledge': (Trigger, {}, 'an acknowledgement'),
    'acknowledge_as': (AcknowledgeAlarm, {'name': 'Ada'}, 'an acknowledgement'),
    'reset_totals': (Trigger, {}, 'a reset of its totals'),
    'shelve': (ShelveAlarm, {'duration': 60.0, 'reason': 'why'}, 'its shelving'),
}
DEFECTS = {
    'a sample': (Monitor, 'update', speeds, f'the speed {FAST} (SI) that arrived at '),
    'a tick': (Monitor, 'tick', BallscrewMonitor._on_tick, 'a tick at '),
    'a message': (Input, 'sample', hears, 'the speed that arrived at '),
    'its news': (AxisPublisher, '_summaries', speeds, f'the speed {FAST} (SI) that arrived at '),
    'all statuses': (
        AxisPublisher,
        '_statuses',
        BallscrewMonitor._publish_diagnostics,
        'its diagnostics',
    ),
    'sums': (AxisRecord, 'of', looks, 'what is kept of it'),
    'shelving': (Alarm, 'end_shelving', looks, 'its shelving'),
    'late': (Monitor, 'take_up', lambda node: node._kept.restore(['x', 'y']), 'what was kept of '),
    'a snapshot': (
        event_recorder,
        'axis_snapshot',
        lambda node: node._recording.snapshot('xy', ''),
        'its snapshot',
    ),
    'parameters': (Axis, 'adapt', lambda node: node._on_parameters({'x', 'y'}), 'new parameters'),
    'the end': (Monitor, 'acknowledge', lambda node: node._stop('why'), 'the end of its event'),
    'activation': (
        Alarm,
        'publish',
        lambda node: node.trigger_deactivate() and node.trigger_activate(),
        'its activation',
    ),
    'a point': (Monitor, 'row_at', solves, 'a solve'),
    'evaluation': (
        AxisPublisher,
        '_evaluate',
        functools.partial(
            serves,
            path='~/evaluate',
            kind=EvaluateOperatingPoint,
            axis='x',
            points=[OperatingPoint()],
        ),
        'an evaluation',
    ),
} | {
    name: (
        AxisRecord,
        'of',
        functools.partial(serves, path=f'~/{name}', kind=kind, **request),
        place,
    )
    for name, (kind, request, place) in REQUESTS.items()
}


@pytest.mark.parametrize(('owner', 'name', 'use', 'place'), DEFECTS.values(), ids=DEFECTS)
def test_a_defect_is_of_its_axis(monkeypatch, tmp_path, capfd, owner, name, use, place):
    """Each part of the judgement of x fails wherever it is used, and y goes on."""
    monkeypatch.setattr(child.sys, 'executable', '/no/python')
    part, told = getattr(owner, name), []
    with started(axes=['x', 'y'], record='always', state_dir=str(tmp_path)) as node:
        broken, sound = (node._axis_publishers[name] for name in 'xy')
        monitor = broken.axis.monitor
        of_x = broken, broken.axis, broken.alarm, monitor, monitor.memory, *broken.axis.inputs

        def fail(*args, **named):
            if any(one is mine for one in args for mine in of_x):
                raise ZeroDivisionError
            return part(*args, **named)

        monkeypatch.setattr(owner, name, fail)
        monkeypatch.setattr(node, '_diagnostics', SimpleNamespace(publish=told.append))
        use(node)
        speeds(node)
        node._publish_diagnostics()
        statuses = {one.name.split(': ', 1)[1]: one for one in told[-1].status}
        assert statuses['x: Lubrication'].level == DiagnosticStatus.ERROR
        said = statuses['x: Lubrication'].message
        assert said.startswith(f'the program failed at {place}')
        assert 'ZeroDivisionError' in said
        assert statuses['y: Lubrication'].level != DiagnosticStatus.ERROR
        assert sound.axis.monitor.memory.received[Source.SPEED] >= 2
        monkeypatch.setattr(owner, name, part)
    assert capfd.readouterr().err.count('the program failed at') == 1


def test_a_clock_that_stops_is_told(node):
    node.start(use_sim_time='true', x__limits__clear_delay=0.0)
    clock = node.clock()
    states, publish = node.watched()
    node.stamp = 50 * 10**9
    ticks = itertools.count()

    def run():
        clock(50 * 10**9 + next(ticks) % 5 * 10_000_000 + 60_000_000)
        publish(FAST, step=0)
        return node.levels()[-1:] == [(DiagnosticStatus.OK, 'all inputs arrive')]

    node.until(run, 'all inputs')
    stands = (DiagnosticStatus.STALE, diagnostics.CLOCK_STANDS)
    node.until(lambda: node.levels()[-1] == stands, 'the end of the clock')
    assert node.levels('x: Lubrication')[-1] == stands
    node.until(run, 'all inputs again')
    node.until(lambda: states[-1].zone == BallScrewState.ZONE_OPTIMAL, 'the zone')


def test_a_long_answer_makes_no_input_missing(node):
    """
    What has come in meanwhile is taken before anything is called stale.

    The clock is simulated, so nothing goes stale by waiting, whatever the machine is busy with. It
    jumps past the timeout while the node is at one of several answers, after samples that bring
    the speed up to the same time: only a node that leaves them waiting can call the speed stale.

    """
    quick = {'x__speed__timeout': 0.05, 'tick_period': 0.01}
    node.start(use_sim_time='true', **AHEAD | quick)
    clock = node.clock()
    states, publish = node.watched()
    node.stamp = 50 * 10**9

    def misses(stamp):
        """Set the clock; tell whether the last state says that an input is missing."""
        clock(stamp)
        return states and states[-1].result.validity == PointResult.VALIDITY_NO_INPUT

    node.until(lambda: misses(node.stamp), 'a tick on simulated time')
    feed(node, publish, states, FAST, 1)
    states.clear()
    points = [OperatingPoint(speed=FAST, temperature=40.0)] * 4_000
    client = node.node.create_client(EvaluateOperatingPoint, f'{node.name}/evaluate')
    node.until(client.service_is_ready)
    request = EvaluateOperatingPoint.Request(axis='x', points=points)
    answers = [client.call_async(request) for _ in range(3)]
    node.until(lambda: any(answer.done() for answer in answers), 'an answer')
    begin = node.stamp
    for _ in range(20):
        publish(FAST)
    clock(node.stamp)
    node.until(lambda: states and states[-1].judged == 21, 'the last sample')
    assert list(map(stamp_of, states)) == [begin + (i + 1) * 10_000_000 for i in range(20)]
    assert {state.result.validity for state in states} == {PointResult.VALIDITY_VALID}
    node.until(answers[-1].done, 'the last answer')
    # From here on nothing waits: what is missing is called so.
    later = itertools.count(node.stamp + 10**9, 10_000_000)
    node.until(lambda: misses(next(later)), 'a tick after the answers')
    stamps = list(map(stamp_of, states))
    assert stamps == sorted(stamps)


def test_sim_time_is_the_clock_of_everything(node):
    node.start(use_sim_time='true')
    clock = node.clock()
    states, publish = node.watched()
    node.stamp = 50 * 10**9
    feed(node, publish, states, FAST, 1)  # before the clock starts
    assert states[-1].header.stamp.sec == 50

    ticks = itertools.count()

    def runs(seconds):
        """Let the clock run on from `seconds`; tell whether a state has such a stamp."""
        clock(seconds * 10**9 + next(ticks) % 100 * 10_000_000)
        return states[-1].header.stamp.sec == seconds

    node.until(lambda: runs(60), 'a tick on simulated time')
    assert states[-1].result.validity == PointResult.VALIDITY_NO_INPUT
    publish(FAST, step=20 * 10**9)  # at 70 s
    node.until(lambda: runs(61) and states[-1].inputs[0].dropped == 1, 'the refusal')
    node.stamp = 10 * 10**9  # the recording begins again
    node.until(lambda: runs(10), 'a tick after the jump')
    feed(node, publish, states, FAST, 1)
    assert states[-1].header.stamp.sec == 10
    assert states[-1].result.validity == PointResult.VALIDITY_VALID
