# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a turn by columns are those that are heard one by one."""

import operator
import random
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.node.burst import Burst
from ballscrew_monitor.node.sources import LossCounter
from ballscrew_monitor.node.topic import NUMBER, RECEIVED, Topic
import pytest

NOW, WALL = 50 * SECOND, 1_700_000_000 * SECOND


def make_topics(publishers):
    topics = []
    for name, count in zip('abc', publishers):
        loss = LossCounter()
        loss.match(count)
        subscription = types.SimpleNamespace(raw=True)
        topics.append(Topic(name=name, readers=[], loss=loss, subscription=subscription))
    return topics


def random_looks(seed):
    """Return what the topics have at some looks: some were lost, are late, or have no time."""
    draw, numbers = random.Random(seed), [3, 70, 1]
    for look in range(20):
        taken = []
        for topic in range(3):
            received, messages = WALL + look * 1_000_000, []
            for _ in range(draw.randrange(5)):
                numbers[topic] += draw.choice([1, 1, 1, 3])
                received += draw.randrange(400_000)
                info = {
                    RECEIVED: draw.choice([received] * 9 + [0, received + SECOND]),
                    NUMBER: draw.choice([numbers[topic]] * 20 + [0]),
                }
                messages.append((f'{topic} {numbers[topic]}'.encode(), info))
            taken.append(sorted(messages, key=lambda message: message[1][RECEIVED]))
        yield taken


def heard_of(burst):
    return [
        (arrival.topic.name, arrival.received, arrival.number, arrival.data, now, lost)
        for arrival, now, lost in map(burst.heard, range(len(burst.now)))
    ]


@pytest.mark.parametrize('publishers', [(1, 1, 1), (1, 2, 0)])
@pytest.mark.parametrize('seed', range(3))
def test_what_was_taken_is_in_the_order_of_arrival_with_times_and_losses(seed, publishers):
    once, each = make_topics(publishers), make_topics(publishers)
    losses = set()
    for taken in random_looks(seed):
        arrivals = [
            topic.arrival(*message) for topic, messages in zip(each, taken) for message in messages
        ]
        heard = []
        for arrival in sorted(arrivals, key=operator.attrgetter('received')):
            waited = max(WALL + SECOND - arrival.received, 0) if arrival.received else 0
            lost = arrival.topic.loss.take(arrival.number)
            heard.append((arrival, max(NOW - waited, 0), lost))
            losses.add(lost)
        burst = Burst.taken(list(zip(once, taken)), NOW, WALL + SECOND)
        assert heard_of(burst) == heard_of(Burst.of(heard))
        assert [now for *_, now, _ in heard_of(burst)] == [now for _, now, _ in heard]
    assert losses >= {0, 2, None}
