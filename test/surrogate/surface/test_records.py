# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records are the same numbers as objects and as elements of arrays."""

import dataclasses
import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface.records import as_array, dtype_of, from_array, many


@dataclasses.dataclass(slots=True)
class Base:
    number: int = 7
    share: float = math.nan


@dataclasses.dataclass(slots=True)
class Whole(Base):
    flag: bool = True
    counts: list[int] = many(3, -1)
    shares: list[float] = many(2, math.inf)


def test_the_array_has_the_fields_of_the_object_and_64_bits():
    kind = dtype_of(Whole)
    assert kind.names == ('number', 'share', 'flag', 'counts', 'shares')
    assert [kind[name].base.str[1:] for name in kind.names] == ['i8', 'f8', 'b1', 'i8', 'f8']
    assert (kind['counts'].shape, kind['shares'].shape) == ((3,), (2,))
    one, other = Whole(), Whole()
    one.counts[0] = 5
    assert other.counts == [-1, -1, -1]
    with pytest.raises(OverflowError):
        as_array(Whole(number=2**63))


whole = st.integers(-(2**63), 2**63 - 1)


@given(whole, st.floats(), st.booleans(), st.lists(whole, min_size=3, max_size=3))
def test_a_record_comes_back_bit_for_bit(number, share, flag, counts):
    record = Whole(number=number, share=share, flag=flag, counts=counts, shares=[share, -share])
    again = from_array(Whole, as_array(record)[0])
    assert repr(again) == repr(record)
    assert as_array(again).tobytes() == as_array(record).tobytes()
    expected = [int, float, bool, list, list]
    assert [type(getattr(again, field.name)) for field in dataclasses.fields(again)] == expected
    assert [type(each) for each in (*again.counts, *again.shares)] == [int] * 3 + [float] * 2
