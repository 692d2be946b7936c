# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Faults of an input with their cures, case by case."""

import math

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source, Why
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.messages import reasons
from ballscrew_monitor.messages.reasons import Standing, summary
import pytest

MATCHED = Link(topic='/t', type_name='a/msg/B', matched=1)
ALONE = Link(topic='/t', type_name='a/msg/B')
JOINTS = OtherJoints('velocity', 'x_axis', ('gripper', 'x_joint'))


def status(state, **changes):
    return InputStatus(**({'source': Source.SPEED, 'state': state} | changes))


@pytest.mark.parametrize(
    ('state', 'changes', 'link', 'text'),
    [
        (InputState.MISSING, {}, None, 'speed_was_never'),
        (InputState.MISSING, {}, ALONE, 'speed_was'),
        (InputState.MISSING, {}, MATCHED, 'speed_was_never_received'),
        (InputState.MISSING, {'joints': JOINTS}, MATCHED, 'speed_has_sample'),
        (InputState.STALE, {}, None, 'speed_stale'),
        (InputState.STALE, {}, MATCHED, 'speed_stale'),
        (InputState.STALE, {}, ALONE, 'speed_stale_publisher'),
        (InputState.STALE, {'slow': True, 'longest_gap': 0.8}, MATCHED, 'speed_stale_comes'),
        (
            InputState.BAD,
            {'why': Why.NOT_A_NUMBER, 'refusal': 'the field holds nan'},
            MATCHED,
            'speed_usable_finite',
        ),
        (
            InputState.BAD,
            {'why': Why.TOO_SHORT, 'refusal': 'velocity is empty'},
            MATCHED,
            'speed_usable_velocity',
        ),
        (InputState.BAD, {}, None, 'speed_usable'),
        (InputState.UNKNOWN, {}, None, 'speed_unknown'),
    ],
)
def test_each_fault_has_its_sentence(state, changes, link, text, says):
    assert reasons.fault(status(state, **changes), link, 'x.speed') == says(text)


@pytest.mark.parametrize('why', [why for why in Why if why is not Why.OTHER_JOINTS])
def test_each_reason_of_a_refusal_has_a_code_of_its_own_name(why):
    found = reasons.fault_code(status(InputState.BAD, why=why))
    assert (found.name, found.status) == (f'INPUT_{why.name}', 'Inputs')


@pytest.mark.parametrize(
    ('state', 'changes', 'code'),
    [
        (InputState.BAD, {}, Fault.INPUT_UNUSABLE),
        (InputState.STALE, {}, Fault.INPUT_STALE),
        (InputState.MISSING, {}, Fault.INPUT_MISSING),
        (InputState.MISSING, {'joints': JOINTS}, Fault.INPUT_OTHER_JOINTS),
        (InputState.UNKNOWN, {}, Fault.INPUT_UNKNOWN),
    ],
)
def test_other_faults_have_a_code_by_their_state(state, changes, code):
    assert reasons.fault_code(status(state, **changes)) is code


def test_messages_without_joints_are_read_by_index_and_of_many_joints_some_are_listed(says):
    said = reasons.joint_reason(OtherJoints('velocity', 'x', ()), 'x.speed')
    assert said == says('messages_name_joints')
    names = tuple(f'joint_{letter}' for letter in 'abcdefghijkl')
    said = reasons.joint_reason(OtherJoints('velocity', 'joint_l', names), 'x.speed')
    assert f'{names[reasons.SHOWN_JOINTS - 1]}, ... and no joint' in said
    assert 'velocity[joint_l]' in said


@pytest.mark.parametrize(
    ('gap', 'timeout'),
    [(1.0, 2.0), (1.01, 5.0), (0.25, 0.5), (0.3, 1.0), (4.0, 10.0), (1e-3, 2e-3), (1e6, 3600.0)],
)
def test_a_timeout_that_would_do_is_round_and_at_least_twice_the_gap(gap, timeout):
    assert reasons.enough_timeout(gap) == timeout
    assert timeout >= min(2.0 * gap, reasons.MOST_TIMEOUT)


def test_the_worst_kind_of_fault_is_told_alone(says):
    good, slow = status(InputState.OK), status(InputState.OK, slow=True, longest_gap=1.0)
    lost = status(InputState.OK, source=Source.LOAD, losing=True, lag=math.nan)
    assert summary('x', (good,), {}) == (Standing.GOOD, 'all inputs arrive', Fault.NONE)
    told = Standing.DEGRADED, says('speed_comes_less'), Fault.SLOW
    assert summary('x', (slow, good), {}) == told
    assert summary('x', (slow, lost), {})[1].startswith('load messages are lost on the way')
    found = summary('x', (lost, status(InputState.MISSING)), {Source.SPEED: MATCHED})
    standing, text, code = found
    assert (standing, code) == (Standing.LOST, Fault.INPUT_MISSING)
    assert text == says('speed_was_never_received')
