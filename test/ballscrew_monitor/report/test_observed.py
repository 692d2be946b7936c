# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What was recorded: the torque beside the model, seconds per reason, and gaps."""

import dataclasses

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.columns import Reason
from ballscrew_monitor.report.observed import gaps_part, torque_part
import numpy as np
import pytest


def with_torque(judged, forward, backward):
    """Return a case whose torque differs from the model by two means [N m]."""
    ahead = np.arange(100) < 50
    block = dataclasses.replace(
        judged.columns(motor_torque_source=1),
        direction=np.where(ahead, 1, 2).astype(np.uint8),
        machine_torque=np.where(ahead, 1.5, -1.5),
        motor_torque=np.where(ahead, 1.5 + forward, -1.5 + backward),
    )
    return judged.case([block])


@pytest.mark.parametrize(
    ('forward', 'backward', 'sentences'),
    [
        (0.2, -0.2, ['0.2 N m, is friction that the model does not know', 'not, 0 N m']),
        (0.3, 0.3, ['direction, 0 N m', 'not, 0.3 N m, is weight of the axis']),
        (-0.2, 0.2, ['friction that the model has too much of']),
    ],
)
def test_a_difference_of_torque_is_split_by_direction(judged, forward, backward, sentences):
    part = torque_part(with_torque(judged, forward, backward)).replace('-0 N m', '0 N m')
    for sentence in sentences:
        assert sentence in part


def test_one_direction_tells_no_friction(judged):
    part = torque_part(judged.case([judged.columns(motor_torque=1.7, motor_torque_source=1)]))
    assert 'Only one direction was recorded' in part


def test_without_a_measured_torque_there_is_no_comparison(judged):
    assert torque_part(judged.case([judged.columns()])) == ''


def test_seconds_are_told_for_each_reason(judged):
    block = judged.columns(
        reason=[Reason.NO_LOAD] * 30 + [Reason.JUDGED] * 70,
        zone=[Zone.UNKNOWN] * 30 + [Zone.OPTIMAL] * 70,
    )
    part = gaps_part(judged.case([block]))
    assert 'not judged: no valid sample of the load</td><td class="number" data-value="0.3' in part
    assert 'The speed has no gap longer than its timeout of 0.5 s.' in part


def test_gaps_lead_to_their_moment(judged):
    part = gaps_part(judged.case([judged.columns(0, 10), judged.columns(310, 10)]))
    assert 'The speed has 1 gap longer than its timeout of 0.5 s, in all 3.01 s.' in part
    assert 'data-begin="-0.9100" data-end="4.1000"' in part


def test_what_could_be_judged_adds_up_to_the_recording(judged):
    blocks = [judged.columns(0, 51), judged.columns(250, 51)]
    rows = gaps_part(judged.case(blocks)).partition('</table>')[0].split('<tr')[2:]
    rest, known = rows
    assert 'not judged: gaps in the speed, up to its timeout</td>' in rest
    assert 'data-value="2.0"' in rest
    assert ('judged</td>' in known, '>1</td>' in known) == (True, True)
