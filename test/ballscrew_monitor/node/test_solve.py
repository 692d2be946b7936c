# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Full solves asked of the running node, over the real middleware, and what may go wrong."""

import contextlib
import functools
import math
import os
import signal
import time
import types

from action_msgs.msg import GoalStatus
from ballscrew_monitor.judge.full_point import request_of
from ballscrew_monitor.messages.state_messages import read_point
from ballscrew_monitor.node.solve_server import LONGEST_TIMEOUT, requested_point, SERVICE_QOS
from ballscrew_msgs.action import SolveOperatingPoint
from ballscrew_msgs.msg import OperatingPoint, PointResult
from ballscrew_msgs.srv import EvaluateOperatingPoint
import pytest
from rclpy.action import ActionClient
from std_srvs.srv import Trigger
from surrogate.builder.on_demand import solve_point
from surrogate.surface import FIELDS, shipped_surface, Surface

AHEAD = {'x__max_future': 3600.0}  # the stamps of a test run ahead of the clock
PLACE = OperatingPoint(speed=103.0, axial_load=-500.0, temperature=40.0)
SUCCEEDED, CANCELED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED
ABORTED = GoalStatus.STATUS_ABORTED
MOST = 9  # goals that the node takes: one at work and eight that wait
# Hot oil and hardly any speed: seconds, in which a test does something.
LONG = {'place': OperatingPoint(speed=0.06, axial_load=-2600.0, temperature=80.0)}
SOLVING = 'contact'  # a word of the stages of a solve


class Goal:
    """A goal that was sent, and what has come back."""

    def __init__(self, node, client, request):
        self._node = node
        self.feedback = []
        self._sent = client.send_goal_async(request, feedback_callback=self._on_feedback)
        self._answer = None

    def _on_feedback(self, message):
        self.feedback.append(message.feedback)

    @property
    def accepted(self):
        return self._node.until(self._sent.done, 'the word on a goal') and self._handle.accepted

    @property
    def _handle(self):
        return self._sent.result()

    def cancel(self):
        return self._handle.cancel_goal_async()

    def poll(self):
        if self._answer is None:
            self._answer = self._handle.get_result_async()
        return self._answer.done() and (self._answer.result().status, self._answer.result().result)

    def end(self):
        assert self.accepted
        return self._node.until(self.poll, 'the result of a goal')

    def at(self, stage):
        return any(stage in step.stage for step in self.feedback)


class Solves:
    """What asks the node for solves."""

    def __init__(self, node):
        self._node = node
        # Room for answers to as many goals as a test sends at once.
        kinds = ('goal', 'result', 'cancel')
        room = {f'{kind}_service_qos_profile': SERVICE_QOS for kind in kinds}
        self._client = ActionClient(node.node, SolveOperatingPoint, f'{node.name}/solve', **room)
        node.until(self._client.server_is_ready, 'the action')
        node.until(lambda: node.lifecycle() == 'active', 'the active node')

    def ask(self, place=PLACE, **request):
        # A busy machine takes long, which is no failure of a solve.
        request = {'axis': 'x', 'point': place, 'timeout': LONGEST_TIMEOUT} | request
        return Goal(self._node, self._client, SolveOperatingPoint.Goal(**request))


def test_a_solve_is_told_beside_the_surface(node):
    node.start(x__correct_surface=False)
    goal = Solves(node).ask()
    status, result = goal.end()
    assert (status, result.success) == (SUCCEEDED, True)
    surface = Surface.load(shipped_surface())
    answer = surface.lookup(103.0, 500.0, 313.15)
    alone = solve_point(request_of(surface, read_point(PLACE, default_temperature=math.nan)))
    for name in FIELDS:
        # The node solves on one thread; sums over several differ in their last digits.
        assert getattr(result.full, name) == pytest.approx(getattr(alone, name), rel=1e-5), name
        assert getattr(result.surface, name) == getattr(answer, name), name
    assert (result.full.tier, result.surface.tier) == (PointResult.TIER_FULL,) * 2
    assert result.surface.efficiency == answer.efficiency
    difference = result.full.efficiency - answer.efficiency
    assert result.efficiency_difference == pytest.approx(difference, rel=1e-9)
    assert result.rcs_difference == pytest.approx(result.full.rcs - answer.rcs, rel=1e-9)
    stated = [
        error + (0.0 if math.isnan(stderr) else stderr)
        for error, stderr in (
            (answer.efficiency_error, answer.efficiency_stderr),
            (answer.rcs_error, answer.rcs_stderr),
        )
    ]
    differences = result.efficiency_difference, result.rcs_difference
    own = 0.0, alone.rcs_deviation
    within = all(
        abs(one) <= most + known for one, most, known in zip(differences, stated, own, strict=True)
    )
    assert result.within_stated_error is within
    assert not result.corrected
    assert result.rcs_stderr == pytest.approx(own[1], rel=1e-4)
    assert math.isnan(result.efficiency_stderr)
    assert result.wall_time > 0.0


@pytest.mark.parametrize(
    ('key', 'place'),
    [
        ('point_cold', {'temperature': -274.0}),
        ('point_hot', {'temperature': 1e300}),
        ('point_fast', {'speed': -1e9}),
        ('point_slow', {'speed': 5e-324}),
        ('point_loaded', {'axial_load': -1e300}),
    ],
)
def test_a_point_that_no_screw_has_is_no_goal(says, key, place):
    point = OperatingPoint(**({'speed': 60.0, 'axial_load': 500.0, 'temperature': 40.0} | place))
    axis = types.SimpleNamespace(settings=types.SimpleNamespace(default_temperature=313.15))
    assert requested_point(SolveOperatingPoint.Goal(point=point), axis) == says(key)


@pytest.mark.parametrize('place', [(1e-3, 1e7, -60.0), (-10471.9, -1e7, 250.0)])
def test_a_point_at_its_limits_is_a_goal(place):
    speed, load, temperature = place
    point = OperatingPoint(speed=speed, axial_load=load, temperature=temperature)
    axis = types.SimpleNamespace(settings=types.SimpleNamespace(default_temperature=313.15))
    row = requested_point(SolveOperatingPoint.Goal(point=point), axis)
    assert (row.speed, row.axial_load) == (speed, load)


def test_what_cannot_be_solved_is_one_sentence_and_a_slow_solve_tells_how_far_it_is(node):
    node.start()
    solves = Solves(node)
    for request, sentence in (
        ({'use_current': True}, 'no valid sample of speed and load'),
        ({'axis': 'q'}, "axis 'q' is unknown, known are: x"),
        ({'place': OperatingPoint(speed=math.nan)}, 'speed, axial load and temperature of the'),
        (
            {'place': OperatingPoint(speed=0.0, temperature=40.0)},
            'the speed of the point is 0 rad',
        ),
        (
            {'place': OperatingPoint(speed=60.0, temperature=-274.0)},
            'the temperature of the point',
        ),
        ({'timeout': -1.0}, 'timeout is -1 s, allowed is 0 to 3600 s'),
        ({'timeout': math.nan}, 'timeout is nan s, allowed is 0 to 3600 s'),
    ):
        node.until(
            lambda request=request, sentence=sentence: (
                not solves.ask(**request).accepted and f'rejected: {sentence}' in said(node)
            ),
            sentence,
        )
    assert not node.solvers()
    goal = solves.ask(**LONG)
    assert goal.end()[0] == SUCCEEDED
    fractions = [step.fraction for step in goal.feedback]
    assert fractions == sorted(fractions)
    assert fractions[0] < fractions[-1]
    assert 0.0 < fractions[-1] <= 1.0
    assert goal.at(SOLVING)
    assert node.transition('deactivate')
    inactive = 'rejected: the node is inactive, activate it first'
    node.until(lambda: not solves.ask().accepted and inactive in said(node), inactive)


def test_a_solve_corrects_the_surface_and_outlives_the_node(node, quick_surface, tmp_path):
    kept = {'x__surface': quick_surface, 'state_dir': tmp_path / 'state'}
    node.start(**kept)
    states = node.states()
    infos = node.infos()
    solves = Solves(node)
    base = node.until(lambda: infos and infos[-1].sha256, 'the surface')
    status, result = solves.ask().end()
    assert (status, result.corrected) == (SUCCEEDED, True)
    assert result.correction == 'corrected the surface about this point, kept'
    assert node.solvers()

    def lists_it():
        return list(infos[-1].corrected_speed) == [103.0] and infos[-1].sha256 != base

    node.until(lists_it, 'the correction in the surface info')
    assert list(infos[-1].corrected_load) == [500.0]
    assert list(infos[-1].corrected_temperature) == [pytest.approx(40.0)]
    evaluated = node.call(EvaluateOperatingPoint, 'evaluate', axis='x', points=[PLACE])
    assert evaluated.results[0].corrected
    assert evaluated.results[0].efficiency == pytest.approx(result.full.efficiency, rel=1e-9)
    publish = node.machine()
    node.stamp = node.now() - 10_000_000
    publish(103.0, -500.0)
    node.until(lambda: states and states[-1].result.corrected, 'a corrected state')

    reloaded = node.call(Trigger, 'reload_surface')
    assert reloaded.success
    assert '1 corrections stay' in reloaded.message
    node.until(lists_it, 'the correction after the reload')

    node.stop(signal.SIGKILL)
    infos.clear()
    node.start(**kept)
    node.until(lambda: infos and lists_it(), 'the correction after the restart')
    assert 'axis x: 1 kept corrections are in use' in node.output.read_text()


class Paced:
    """Samples at a moderate rate while something else is waited for."""

    def __init__(self, node):
        self._publish = node.machine()
        self._next = 0.0
        self.sent = 0

    def go_on(self):
        now = time.monotonic()
        if now >= self._next:
            self._next = now + 0.01
            self._publish(100.0)
            self.sent += 1


def test_a_killed_worker_ends_its_goal_alone_and_no_message_is_missed(node, says):
    node.start(**AHEAD)
    states, samples, solves = node.states(), Paced(node), Solves(node)

    def until(condition):
        return node.until(lambda: samples.go_on() or condition())

    for at_work in (True, False):
        goal = solves.ask(**LONG)
        assert goal.accepted
        # At its first steps, or as soon as it is there.
        until(functools.partial(goal.at, SOLVING) if at_work else node.solvers)
        (worker,) = node.solvers()
        os.kill(worker, signal.SIGKILL)
        status, result = until(goal.poll)
        assert status == ABORTED
        assert result.status == says('process_solve_was')
    last = solves.ask()
    assert last.accepted
    assert until(last.poll)[0] == SUCCEEDED
    node.until(lambda: states and states[-1].judged == samples.sent, 'the last state')
    # A state of a tick that found nothing new repeats the number.
    assert {state.judged for state in states} - {0} == set(range(1, samples.sent + 1))


def test_a_goal_is_taken_back_at_any_time_and_of_fifty_at_once_nine_are_taken(node, says):
    node.start()
    solves = Solves(node)
    begun = solves.ask(**LONG)
    waiting = solves.ask(**LONG)
    assert begun.accepted
    assert waiting.accepted
    # The worker is at its imports still, and the other goal waits for it.
    for goal in (waiting, begun):
        take_back(node, goal)
    assert not waiting.at(SOLVING)
    solving = solves.ask(**LONG)
    assert solving.accepted
    node.until(lambda: solving.at(SOLVING), 'the solve')
    take_back(node, solving)
    assert solves.ask().end()[0] == SUCCEEDED
    goals = [solves.ask(**LONG) for _ in range(50)]
    taken = [goal for goal in goals if goal.accepted]
    assert taken == goals[:MOST]
    for goal in taken:
        goal.cancel()
    assert {goal.end()[0] for goal in taken} == {CANCELED}
    assert says('solve_rejected_8') in said(node)
    assert 'Traceback' not in said(node)
    assert not solves.ask(axis='q').accepted


def said(node):
    return node.output.read_text()


def take_back(node, goal):
    goal.cancel()
    status, result = node.until(goal.poll, 'the end of a goal')
    assert (status, result.success, result.status) == (CANCELED, False, 'cancelled')


def test_an_overdue_solve_says_how_far_it_came_and_a_killed_node_leaves_no_worker(node, is_alive):
    node.start()
    status, result = Solves(node).ask(**LONG, timeout=0.5).end()
    assert status == ABORTED
    assert result.status.startswith('stopped after its timeout of 0.5 s, ')
    assert not node.solvers()
    _, worker = solving(node)
    node.stop(signal.SIGKILL)
    node.until(lambda: not is_alive(worker), 'the end of the worker')


def test_a_signal_during_a_solve_ends_goal_worker_and_node(node, is_alive):
    node.start()
    goal, worker = solving(node)
    assert node.stop() == 0
    assert not is_alive(worker)
    status, result = goal.end()
    assert (status, result.status) == (ABORTED, 'stopped, the node is no longer active')
    assert 'Traceback' not in node.output.read_text()


def solving(node):
    goal = Solves(node).ask(**LONG)
    assert goal.accepted
    goal.poll()  # asks for the result
    node.until(lambda: goal.at(SOLVING), 'the solve')
    (worker,) = node.solvers()
    return goal, worker


def test_of_two_nodes_of_one_name_the_second_keeps_nothing_and_says_so(node, tmp_path):
    kept, folder = {'state_dir': tmp_path / 'state'}, tmp_path / 'other'
    folder.mkdir()
    in_use = f'state_dir: {tmp_path / "state"} is in use by another node of this name'
    node.start(**kept)
    node.until(lambda: node.lifecycle() == 'active')
    second = type(node)(node.domain, node.node, folder, node.wait_for)
    with contextlib.closing(second):
        second.start(**kept)
        second.until(lambda: in_use in second.output.read_text(), 'the warning')
    assert in_use not in node.output.read_text()
