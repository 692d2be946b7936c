# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Clocks that are not alike, over the real middleware: what can be judged is, and the cure is told.

Lags and timeouts are long, so that a machine that is busy elsewhere changes nothing: what counts
is that the lag is longer than the timeout.

"""

import re
import time

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.messages import diagnostics
from ballscrew_msgs.msg import BallScrewState, InputHealth, PointResult
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

FAST, SLOW = 100.0, 0.8  # [rad/s] optimal and outside at 1 kN and 40 degC
SECOND = 10**9  # [ns]
PERIOD = 0.01  # [s]
TIMEOUTS = {'x__speed__timeout': 20.0, 'x__load__timeout': 20.0}
SOON = {'x__speed__timeout': 2.0, 'x__load__timeout': 2.0}  # a refusal is told after that
LAG = 30 * SECOND  # [ns] beyond the timeouts
QUICK = {'x__limits__raise_delay': 0.0, 'x__limits__clear_delay': 0.2}
OK, WARN = BallScrewState.LEVEL_OK, BallScrewState.LEVEL_WARN
GOOD = 'all inputs arrive'
BOTH = 'speed and load '
INPUTS = ('speed', 'load', 'speed and load')


class Source:
    """A machine whose stamps are those of its own clock [ns]."""

    def __init__(self, node, clock):
        self.clock = clock
        self.sent = 0
        self._node, self._publish, self._next = node, node.machine(), 0.0
        self._node.stamp = 0

    def go_on(self, speed=FAST):
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + PERIOD
        self._node.stamp = max(self.clock(), self._node.stamp + 1)
        self._publish(speed, step=0)
        self.sent += 1

    def until(self, condition, what, speed=FAST):
        return self._node.until(lambda: self.go_on(speed) or condition(), what)


class Listener:
    """What the node says."""

    def __init__(self, node):
        self.states = node.states()
        self._node = node

    @property
    def level(self):
        return self.states[-1].level if self.states else None

    def has_judged(self, count):
        return bool(self.states) and self.states[-1].judged >= count

    def sentences(self):
        """Return what was said of the inputs, without repetition."""
        return list(dict.fromkeys(text for _, text in self._node.levels()))

    def faults(self):
        """Return what was wrong with the inputs that had arrived; for a moment of one alone."""
        never = ('speed was never', 'load was never')
        begin = (*never, Fault.INACTIVE.text, Fault.NOTHING_YET.text, GOOD)
        found = [part for one in self.sentences() for part in re.split('; (?=load )', one)]
        return {one for one in found if not one.startswith(begin)}

    def faults_of_both(self, fault):
        """Tell whether both inputs had a fault, together at last, and there was no other one."""
        found = self.faults()
        return BOTH + fault in found and found <= {f'{one} {fault}' for one in INPUTS}


def in_order(states):
    """Return the states from the first judged one on, whose stamps follow each other."""
    first = next(i for i, state in enumerate(states) if state.judged)
    stamps = list(map(stamp_of, states[first:]))
    assert stamps == sorted(stamps)
    return states[first:]


def test_a_constant_lag_is_judged_and_told_and_a_warning_clears(node, says):
    node.start(**TIMEOUTS, **QUICK)
    heard, source = Listener(node), Source(node, lambda: node.now() - LAG)
    source.until(lambda: heard.level == WARN, 'the warning', SLOW)
    source.until(lambda: heard.level == OK, 'its end')
    # Many ticks later nothing has changed.
    source.until(lambda: heard.has_judged(source.sent // 2 + 100), 'more states')
    source.until(lambda: heard.faults_of_both(says('lags')), 'the lag of both')
    node.until(lambda: heard.has_judged(source.sent), 'the last state')
    found = in_order(heard.states)
    assert {state.result.validity for state in found} == {PointResult.VALIDITY_VALID}
    assert found[-1].judged == source.sent
    assert found[-1].level == OK
    assert found[-1].inputs[0].lag == pytest.approx(LAG / SECOND, abs=10.0)


def test_silence_of_a_lagging_source_stays_on_its_line_of_time(node):
    node.start(x__speed__timeout=0.2, **QUICK)
    heard, source = Listener(node), Source(node, lambda: node.now() - LAG)
    source.until(lambda: heard.level == WARN, 'the warning', SLOW)
    node.until(
        lambda: heard.states[-1].result.validity == PointResult.VALIDITY_NO_INPUT, 'the silence'
    )
    assert heard.level == WARN
    assert stamp_of(heard.states[-1]) < node.now() - LAG // 2
    in_order(heard.states)


def test_a_lead_beyond_what_is_allowed_is_refused_and_clears_nothing(node, says):
    node.start(**SOON, **QUICK, x__max_lag=3600.0)  # a machine that is busy lags, too
    heard, source = Listener(node), Source(node, node.now)
    source.until(lambda: heard.level == WARN, 'the warning', SLOW)
    assert heard.faults() == set()
    source.clock = lambda: node.now() + LAG
    refusals = {f'{one} {says("ahead")}' for one in INPUTS[:2]}
    source.until(lambda: heard.faults() >= refusals, 'the refusals')
    source.until(lambda: heard.states[-1].inputs[0].dropped > 100, 'more of it')
    assert heard.faults() == refusals
    assert heard.level == WARN
    for health in heard.states[-1].inputs[:2]:
        assert health.state == InputHealth.STATE_BAD
        assert health.refusal.endswith(says('set_clocks_both'))


def test_two_of_three_samples_stamped_ahead_are_never_hidden(node, says):
    """At times a good sample is the last one: the diagnostics tell of the others all the same."""
    node.start(**TIMEOUTS, **QUICK, x__max_lag=3600.0)
    heard, source = Listener(node), Source(node, node.now)
    source.until(lambda: heard.level == OK, 'the level')

    def clock():
        return node.now() + (LAG if source.sent % 3 else -SECOND // 1000)

    def go_on():
        node.stamp = 0  # each stamp is what the clock says
        source.go_on()
        return True

    source.clock = clock
    node.until(lambda: go_on() and source.sent > 300, 'samples')
    first = len(node.told) + 5
    node.until(lambda: go_on() and len(node.told) > first + 15, 'diagnostics')
    levels = {
        (status.level, status.message)
        for message in node.told[first:]
        for status in message.status
        if status.name == 'ballscrew_monitor: x: Inputs'
    }
    assert levels
    assert all(level != diagnostics.OK for level, _ in levels)
    assert (diagnostics.WARN, says('refused')) in levels


def test_a_drift_is_told_when_it_has_grown(node, says):
    """The clock of the source runs at a tenth of its rate."""
    node.start(**TIMEOUTS, **(QUICK | {'x__limits__clear_delay': 0.02}))
    heard, source = Listener(node), Source(node, node.now)
    begin = node.now()
    source.clock = lambda: begin + source.sent * SECOND // 1000
    lags = says('lags')
    source.until(lambda: heard.faults_of_both(lags) and heard.level == OK, 'lag and level')
    node.until(lambda: heard.has_judged(source.sent), 'the last state')
    found = in_order(heard.states)
    assert {state.result.validity for state in found} == {PointResult.VALIDITY_VALID}


def test_a_lagging_source_beside_one_without_stamps(node, says):
    node.start(
        *('-p', 'x.load.type:=std_msgs/msg/Float64', '-p', 'x.load.field:=data'),
        **TIMEOUTS,
        **QUICK,
    )
    heard = Listener(node)
    speeds = node.node.create_publisher(JointState, 'joint_states', 100)
    loads = node.node.create_publisher(Float64, 'axial_load', 100)
    node.until_matched(speeds, loads)

    def go_on():
        joints = JointState(name=['x_axis'], velocity=[FAST])
        loads.publish(Float64(data=-1000.0))
        speeds.publish(node.stamped(joints, node.now() - LAG))

    node.until(lambda: go_on() or heard.level == OK, 'the level')
    found = in_order(heard.states)
    speed, load = found[-1].inputs[:2]
    assert speed.stamp_source == InputHealth.STAMP_HEADER
    assert load.stamp_source == InputHealth.STAMP_RECEIVE
    assert load.lag != load.lag
    node.until(lambda: go_on() or heard.faults(), 'the lag')
    assert heard.faults() == {'speed ' + says('lags')}


@pytest.mark.parametrize('speed', [None, SLOW])
def test_simulated_time_without_a_clock(node, speed):
    node.start(use_sim_time='true', **QUICK)
    heard, source = Listener(node), Source(node, lambda: 50 * SECOND)
    if speed is not None:
        source.until(lambda: heard.level == WARN, 'the warning', speed)
    node.until(lambda: heard.sentences()[-1:] == [diagnostics.CLOCK_STANDS], 'the sentence')
    assert heard.faults() == {diagnostics.CLOCK_STANDS}
    assert heard.level == (None if speed is None else WARN)


class Simulated:
    """A simulated clock that runs from 60 s on by 10 ms at each sample."""

    def __init__(self, node):
        self._show = node.clock()
        self.now = 60 * SECOND

    def __call__(self):
        """Let the clock run on; return the time [ns]."""
        self.now += SECOND // 100
        self._show(self.now)
        return self.now


def test_stamps_of_the_wall_clock_on_simulated_time(node, says):
    node.start(use_sim_time='true', **SOON, **QUICK)
    heard, simulated = Listener(node), Simulated(node)
    source = Source(node, simulated)
    source.until(lambda: heard.level == WARN, 'the warning', SLOW)
    source.clock = lambda: simulated() and node.now()
    source.until(
        lambda: heard.states[-1].inputs[0].state == InputHealth.STATE_BAD, 'the refusal', FAST
    )
    refusals = {f'{one} {says("wall")}' for one in INPUTS[:2]}
    source.until(lambda: heard.faults() >= refusals, 'the sentences')
    assert heard.faults() - {diagnostics.CLOCK_STANDS} == refusals
    assert heard.states[-1].inputs[0].refusal == says('stamps_wall_clock')
    assert heard.level == WARN


def test_stamps_of_simulated_time_on_the_wall_clock(node, says):
    node.start(**TIMEOUTS, **QUICK)
    heard, source = Listener(node), Source(node, lambda: node.stamp + SECOND // 100)
    source.until(lambda: heard.level == WARN, 'the warning', SLOW)
    told = says('simulated')
    source.until(lambda: heard.level == OK and heard.faults_of_both(told), 'its end')
    found = in_order(heard.states)
    assert {state.result.validity for state in found} == {PointResult.VALIDITY_VALID}
