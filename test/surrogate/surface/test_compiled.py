# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A compiled function is the function itself, and the cache knows it by all that it names."""

import dataclasses
import math
import struct

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import compiled as module
from surrogate.surface.compiled import called_by, compiled
from surrogate.surface.records import as_array, from_array, many

LIMIT = 3
WEIGHTS = (0.5, 0.25)


@dataclasses.dataclass(slots=True)
class Sums:
    total: float = 0.0
    count: int = 0
    last: list[int] = many(2, 0)


def weighted(value):
    return value * WEIGHTS[0] + WEIGHTS[1]


def take(sums, value):
    if sums.count < LIMIT or not math.isnan(value):
        sums.total += weighted(value)
        sums.last[sums.count % 2] = sums.count
    sums.count += 1


def take_many(sums, values):
    for value in values:
        take(sums[0], value)
    return len(values)


@pytest.fixture(scope='module')
def ready():
    return compiled(take_many)


def bits(number):
    return struct.pack('<d', number)


@given(st.lists(st.floats(), max_size=8))
def test_compiled_and_interpreted_give_the_same_bits(ready, values):
    array, record = as_array(Sums()), Sums()
    assert ready(array, tuple(values) if values else (0.0,)) == max(len(values), 1)
    take_many([record], values or [0.0])
    again = from_array(Sums, array[0])
    assert (again.count, again.last) == (record.count, record.last)
    assert bits(again.total) == bits(record.total) or math.isnan(again.total + record.total)


def test_all_that_is_called_is_found_once_and_changes_the_digest(monkeypatch):
    assert set(called_by(take_many)) == {take_many, take, weighted}
    assert len(called_by(take_many)) == 3
    before = module._digest(called_by(take_many))
    assert module._digest(called_by(take_many)) == before
    for name, value in (('LIMIT', 4), ('WEIGHTS', (0.5, 0.125)), ('weighted', bits)):
        with monkeypatch.context() as patch:
            patch.setitem(take.__globals__, name, value)
            assert module._digest(called_by(take_many)) != before
