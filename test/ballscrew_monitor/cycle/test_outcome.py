# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The words for what was lost."""

from collections import Counter
from pathlib import Path

from ballscrew_monitor.cycle.outcome import loss, Outcome, plan
from ballscrew_msgs.msg import BallScrewState, InputHealth
import pytest
from surrogate.files import InputError


def make_outcome(**states):
    return Outcome(
        recording=Path('cycle.mcap'),
        sent=Counter(),
        recorded=1,
        states=states,
        lateness=0.0,
        cpu_time=1.0,
        failures=(),
    )


def words(*, received, judged, dropped=0, sent=10, rate=1.0):
    """Return the sentence on axis x, of which ten messages were expected, by its last state."""
    health = InputHealth(name='speed', received=received, dropped=dropped)
    state = BallScrewState(judged=judged, inputs=[health])
    return loss(make_outcome(x=state), 'x', sent, 10, rate)


def test_a_loss_is_said_and_nothing_else(says):
    assert words(received=10, judged=10) == ''
    assert words(received=12, judged=10, dropped=2, sent=12) == ''
    assert 'lower rate' not in words(received=10, judged=9, rate=20.0)
    sentence = loss(make_outcome(), 'y', 3, 3, 1.0)
    assert sentence == says('y_0_3')


@pytest.mark.parametrize(
    ('health', 'sentence'),
    [
        ({'received': 9, 'judged': 3, 'dropped': 1}, '3_10_speed'),
        (  # messages of other joints are not called refused
            {'received': 12, 'judged': 9, 'dropped': 2, 'sent': 12},
            '9_10_speed',
        ),
        ({'received': 9, 'judged': 9, 'rate': 20.0}, '9_10_speed_messages'),
    ],
)
def test_it_says_what_was_lost_refused_or_without_verdict(health, sentence, says):
    assert words(**health) == f'axis x: {says(sentence)}'


@pytest.mark.parametrize('rate', [-1.0, 0.0, 1001.0])
def test_a_rate_at_which_nothing_plays_is_refused(tmp_path, rate):
    with pytest.raises(InputError, match='allowed is above 0 to 1000'):
        plan(tmp_path, tmp_path, tmp_path / 'out', rate)
    assert not (tmp_path / 'out').exists()
