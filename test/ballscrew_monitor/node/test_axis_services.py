# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The services of one axis leave the other one alone; the node-wide ones act on all."""

from ballscrew_msgs.msg import BallScrewState, PointResult
from ballscrew_msgs.srv import EvaluateOperatingPoint
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from std_srvs.srv import Trigger
from surrogate.surface import shipped_surface

SLOW = 0.8  # [rad/s] outside the zone at 1 kN and 40 degC
SAMPLES = 3


def warned(states):
    judged = [(state.judged, state.level) for state in states]
    return judged[-1:] == [(SAMPLES, BallScrewState.LEVEL_WARN)]


@pytest.fixture
def two(node, tmp_path):
    """Start the node with two axes whose warnings stand; return it, and the file of x."""
    surface = tmp_path / 'surface.npz'
    surface.write_bytes(shipped_surface().read_bytes())
    limits = {f'{axis}__limits__raise_delay': 0.0 for axis in 'xy'}
    ahead = {f'{axis}__max_future': 3600.0 for axis in 'xy'}
    # A busy machine makes no sample stale.
    ahead |= {f'{axis}__{name}__timeout': 60.0 for axis in 'xy' for name in ('speed', 'load')}
    node.start(
        axes="['x','y']", y__speed__field='velocity[x_axis]', x__surface=surface, **limits, **ahead
    )
    node.heard = {axis: node.states(axis) for axis in 'xy'}
    publish = node.machine()
    for _ in range(SAMPLES):
        publish(SLOW)
    node.until(lambda: all(map(warned, node.heard.values())), 'both warnings')
    return node, publish, surface


def last_after(node, publish):
    """Return the last state of each axis after one more sample."""
    done = {axis: heard[-1].judged for axis, heard in node.heard.items()}
    publish(SLOW)
    node.until(lambda: all(node.heard[axis][-1].judged > done[axis] for axis in done), 'states')
    return {axis: heard[-1] for axis, heard in node.heard.items()}


def test_an_axis_is_served_by_itself(two):
    node, publish, surface = two
    answers = [node.call(Trigger, f'x/{name}') for name in ('acknowledge', 'reset_totals')]
    assert [answer.success for answer in answers] == [True, True]
    expected = ['acknowledged of x', 'set the totals to zero of x']
    assert [answer.message for answer in answers] == expected
    state = last_after(node, publish)
    assert (state['x'].event_id, state['y'].event_id) == (2, 1)
    assert state['x'].totals.running_time < state['y'].totals.running_time
    surface.write_bytes(b'no surface')
    assert node.call(Trigger, 'y/reload_surface').message == 'reloaded the surface of y'
    kept = node.call(Trigger, 'x/reload_surface')
    assert not kept.success
    assert kept.message.startswith('kept the old surface: axis x: ')
    assert last_after(node, publish)['x'].result.validity == PointResult.VALIDITY_VALID
    assert node.call(Trigger, 'acknowledge').message == 'acknowledged of x, y'


def test_an_axis_that_cannot_be_built_leaves_the_other_at_work(node, says):
    node.start(
        axes="['x','y']", y__oil='olive', y__speed__field='velocity[x_axis]', x__max_future=3600.0
    )
    states, publish = node.watched()
    node.until(lambda: publish(100.0) or (states and states[-1].judged), 'a judged sample')

    def said_of_y():
        """Return what all diagnostics say of y; those of a change are of its own axis alone."""
        found = [status for message in node.told for status in message.status]
        return {one.message for one in found if ': y: ' in one.name and one.level}

    said = node.until(said_of_y, 'diagnostics of y')
    assert len(said) == 1
    (reason,) = said
    assert reason.startswith(says('configured_y_surface'))
    assert reason in node.output.read_text()
    cure = f'axis y is {reason}; mend it and configure the node again'
    for name in ('acknowledge', 'reset_totals', 'reload_surface'):
        own, all_axes = node.call(Trigger, f'y/{name}'), node.call(Trigger, name)
        assert (own.success, own.message) == (False, cure)
        assert all_axes.success
        assert all_axes.message.endswith(f' x; {cure}')
    answer = node.call(EvaluateOperatingPoint, 'evaluate', axis='y')
    assert (answer.success, answer.message) == (False, cure)
    assert node.lifecycle() == 'active'


def test_an_axis_parked_since_it_was_switched_on_is_well(node):
    node.start(x__max_future=3600.0)
    publish = node.machine()

    def parked():
        publish(0.0)
        return node.told and [
            status
            for status in node.told[-1].status
            if status.message == 'standstill, not judged for long enough yet'
        ]

    status = node.until(parked, 'the standstill')[0]
    assert (status.level, status.hardware_id) == (DiagnosticStatus.OK, 'x: nominal')
