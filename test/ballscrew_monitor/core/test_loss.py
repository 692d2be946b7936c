# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Losses by publication numbers, counted against messages that were really left out."""

from ballscrew_monitor.core.loss import LossCounter
from hypothesis import given
from hypothesis import strategies as st


def test_gaps_are_counted_and_the_first_message_has_none():
    counter = LossCounter()
    assert [counter.take(number) for number in (5, 6, 9, 10, 20)] == [0, 0, 2, 0, 9]


def test_a_publisher_that_begins_anew_has_lost_nothing():
    counter = LossCounter()
    assert [counter.take(number) for number in (7, 8, 1, 2, 4)] == [0, 0, 0, 0, 1]


def test_with_two_publishers_or_without_numbers_nothing_is_known():
    counter = LossCounter()
    assert counter.take(3) == 0
    counter.match(2)
    assert [counter.take(number) for number in (1, 4, 2)] == [None] * 3
    counter.match(1)
    assert [counter.take(number) for number in (9, 11)] == [0, 1]
    assert counter.take(0) is None
    assert counter.take(50) == 0


@given(st.lists(st.booleans(), min_size=1))
def test_every_message_left_out_between_two_that_arrive_is_counted(arrives):
    counter = LossCounter()
    numbers = [number for number, good in enumerate(arrives, start=1) if good]
    lost = sum(counter.take(number) for number in numbers)
    assert lost == (numbers[-1] - numbers[0] + 1 - len(numbers) if numbers else 0)
