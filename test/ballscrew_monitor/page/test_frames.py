# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Frames are read as the contract with the browser has them."""

from ballscrew_monitor.page.frames import frame
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from surrogate.files import to_json

NAMES = st.text(max_size=8)
TEXTS = st.dictionaries(NAMES.filter(lambda name: name not in ('kind', 'arrays')), st.text())
NUMBERS = st.lists(st.floats(), max_size=5)


@given(record=TEXTS, arrays=st.dictionaries(NAMES, NUMBERS, max_size=3))
def test_what_is_read_is_what_was_written(page_parts, record, arrays):
    """To the bit, NaN and infinity included; texts of any script, markup included."""
    told, read = page_parts.read(frame('state', record, arrays))
    assert told == {'kind': 'state', **record}
    assert list(read) == list(arrays)
    for name, values in arrays.items():
        assert read[name].tobytes() == np.array(values, dtype='<f8').tobytes()


@given(st.floats())
def test_numbers_of_json_that_are_not_finite_are_null(page_parts, number):
    told, _ = page_parts.read(frame('x', {'deep': [{'number': number}]}))
    assert told['deep'] == [{'number': to_json(number)}]
