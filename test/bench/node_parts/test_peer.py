# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Missing messages are counted for each topic, between moments at which nothing waits."""

from ballscrew_msgs.msg import BallScrewState, InputHealth
from node_parts import peer
from node_parts.peer import Counts, Peer
import pytest


def state_of(come, lost=(0, 0), *, tick=True):
    names = reversed(('speed', 'load'))
    counts = zip(names, reversed(come), reversed(lost))
    inputs = [InputHealth(name=name, received=seen, lost=gone) for name, seen, gone in counts]
    state = BallScrewState(inputs=inputs)
    result = state.result
    result.validity = result.VALIDITY_NO_INPUT if tick else result.VALIDITY_VALID
    return state


class Heard(Peer):
    """A peer whose states come from a list for each axis, one with each look."""

    def __init__(self, *axes):
        self.kind, self.axes, self.period, self.times = 'node', len(axes), 0.1, []
        self.sent, self.counts, self._level = [0] * self.axes, [Counts()] * self.axes, 0
        self._states = [iter(states) for states in axes]

    def look(self, axis):
        for state in self._states[axis]:
            self._take(axis, state, {'received_timestamp': 0})
            break


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    monkeypatch.setattr(peer.time, 'sleep', lambda pause: None)


def test_settled_is_a_node_whose_ticks_tell_the_same_of_every_axis():
    backlog = [state_of((count, 7)) for count in range(30)]
    between = [state_of((29, 9)), state_of((29, 9), tick=False), state_of((29, 9))]
    heard = Heard([state_of((5, 5))] * 40, [*backlog, *between, state_of((99, 99))])
    heard.settle()
    assert heard.counts == [Counts((5, 5)), Counts((29, 9))]


def test_a_node_that_never_settles_ends_the_bench(monkeypatch):
    monkeypatch.setattr(peer, 'PATIENCE', 0.0)
    with pytest.raises(SystemExit, match='still counts messages'):
        Heard([state_of((5, 5))]).settle()


def test_what_is_missing_is_told_of_each_topic():
    heard = Heard([], [])
    heard.sent, heard.counts = [110, 110], [Counts((107, 100), (3, 0)), Counts((110, 110))]
    assert heard.missing([10, 10], [Counts((10, 10)), Counts((10, 12))]) == [3, 10, 0, 2]


def test_more_messages_than_were_sent_end_the_bench():
    heard = Heard([])
    heard.sent, heard.counts = [110], [Counts((111, 90))]
    with pytest.raises(SystemExit, match='more messages than were sent'):
        heard.missing([10], [Counts((10, 10))])
