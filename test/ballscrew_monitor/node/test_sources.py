# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Publication numbers tell what was lost, and whether several publishers send one input."""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.records import SHOWN
from ballscrew_monitor.node.sources import LossCounter, SourceCounter
from hypothesis import given
from hypothesis import strategies as st
import pytest


@pytest.mark.parametrize(
    ('numbers', 'losses'),
    [((5, 6, 9, 10, 20), [0, 0, 2, 0, 9]), ((7, 8, 1, 2, 4), [0, 0, 0, 0, 1])],
)
def test_gaps_are_counted_but_none_before_the_first_message_of_a_publisher(numbers, losses):
    assert list(map(LossCounter().take, numbers)) == losses


def test_the_first_message_of_each_of_several_publishers_tells_nothing():
    counter = LossCounter()
    assert counter.take(3) == 0
    counter.match(2)
    assert [counter.take(number) for number in (1, 40, 2, 41, 5, 44)] == [None, None, 0, 0, 2, 2]
    assert [counter.take(number) for number in (1, 45, 2)] == [None, None, 0]  # one starts again
    counter.match(1)
    assert [counter.take(number) for number in (9, 11)] == [0, 1]
    assert counter.take(0) is None
    assert counter.take(50) == 0


@given(st.lists(st.lists(st.integers(0, 12), max_size=6), max_size=6), st.sampled_from([0, 1, 2]))
def test_of_many_messages_at_once_the_same_is_lost_as_of_one_after_the_other(looks, publishers):
    once, each = LossCounter(), LossCounter()
    for counter in (once, each):
        counter.match(publishers)
    for numbers in looks:
        assert once.take_many(numbers) == list(map(each.take, numbers))


def test_a_gap_between_two_looks_is_counted():
    counter = LossCounter()
    assert counter.take_many([4, 5]) == [0, 0]
    assert counter.take_many([8, 9, 11]) == [2, 0, 1]


@given(st.lists(st.booleans(), min_size=1))
def test_every_message_left_out_between_two_that_arrive_is_counted(arrives):
    counter = LossCounter()
    numbers = [number for number, good in enumerate(arrives, start=1) if good]
    lost = sum(counter.take(number) for number in numbers)
    assert lost == (numbers[-1] - numbers[0] + 1 - len(numbers) if numbers else 0)


@given(st.integers(2, 4), st.data())
def test_losses_of_several_publishers_add_up_whoever_they_are_put_down_to(publishers, data):
    """Each begins far from the others and sends two messages that arrive before any is lost."""
    counter, last = LossCounter(), [1000 * (one + 1) for one in range(publishers)]
    counter.match(publishers)
    for number in last:
        counter.take(number)
        counter.take(number + 1)
    last, lost, counted = [number + 1 for number in last], 0, 0
    senders = st.tuples(st.integers(0, publishers - 1), st.integers(0, 3))
    for who, left_out in data.draw(st.lists(senders, max_size=60)):
        last[who] += 1 + left_out
        lost += left_out
        counted += counter.take(last[who])
    assert counted == lost


def sources(numbers, publishers=2, step=SECOND // 100):
    counter = SourceCounter()
    for at, number in enumerate(numbers):
        counter.take(number, publishers, at * step)
    return counter


@pytest.mark.parametrize(
    ('numbers', 'publishers', 'several'),
    [
        (range(1, 9), 2, False),  # the other one sends other joints
        ((1, 3, 7, 8, 20), 2, False),
        ((100, 1, 2, 3, 4), 2, False),  # one publisher that has started again
        ((100, 1, 101, 2, 102), 2, True),
        ((7, 7, 8, 8), 2, True),
        ((100, 1, 101, 2, 102), 1, False),
        ((0, 0, 0), 2, None),
        ((0, 0, 0), 1, False),
    ],
)
def test_numbers_that_fall_back_again_and_again_are_of_several_publishers(
    numbers, publishers, several
):
    assert sources(numbers, publishers).several is several


def test_a_second_publisher_is_told_of_until_ten_seconds_after_its_last_sample():
    counter = sources((100, 1, 101, 2))
    last = 3 * SECOND // 100
    for now, several in ((SECOND, True), (SHOWN + last // 3, True), (SHOWN + last, False)):
        counter.take(200 + now, 2, now)
        assert counter.several is several
    counter = sources((100, 1, 101, 2))
    counter.take(103, 1, last)
    assert counter.several is False
