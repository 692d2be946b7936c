# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers as a page carries them come back as they were, and no text ends its element."""

import base64
import json
import math

from ballscrew_monitor.report.encoding import floats, LARGEST, LEVELS, packed, script_json
from hypothesis import example, given
from hypothesis import strategies as st
import numpy as np
import pytest


def unpacked(record):
    """Return packed numbers as the page reads them."""
    steps = np.frombuffer(base64.b64decode(record['data']), dtype='<u2')
    if 'runs' in record:
        steps = np.repeat(steps, np.frombuffer(base64.b64decode(record['runs']), dtype='<u4'))
    step = (record['high'] - record['low']) / LEVELS
    return np.where(steps == 0, np.nan, record['low'] + (steps.astype(float) - 1.0) * step)


@given(st.lists(st.floats(-1e6, 1e6) | st.just(math.nan), min_size=1, max_size=200))
@example([0.0, 2.2e-309])
def test_packed_numbers_are_within_half_a_step(values):
    record, numbers = packed(values), np.array(values)
    step = (record['high'] - record['low']) / LEVELS
    np.testing.assert_allclose(unpacked(record), numbers, rtol=0.0, atol=0.51 * step + 1e-9)


@pytest.mark.parametrize('span', [5e-324, 2.2e-309, 1e-300, 1.0, 1e300, LARGEST])
def test_any_span_has_all_its_steps(span):
    record = packed([0.0, span, math.nan, 0.0])
    assert base64.b64decode(record['data']) == np.array([1, 65535, 0, 1], dtype='<u2').tobytes()


def test_number_whose_span_would_overflow_counts_as_nan():
    record = packed([-1.7e308, 1.0, 1.7e308, math.inf, 3.0])
    assert (record['low'], record['high']) == (1.0, 3.0)
    np.testing.assert_array_equal(unpacked(record), [math.nan, 1.0, math.nan, math.nan, 3.0])


@given(st.lists(st.floats(), max_size=20))
def test_any_numbers_can_be_packed(values):
    steps = unpacked(packed(values))
    assert steps.size == len(values)
    assert not np.isfinite(steps[~(np.abs(values) <= LARGEST)]).any()


def test_extremes_of_packed_numbers_are_exact():
    record = packed([3.0, -1.0, math.nan, 2.0])
    assert (record['low'], record['high']) == (-1.0, 3.0)


def test_numbers_that_differ_less_than_can_be_divided_by_are_one():
    record = packed([0.0, 2.2e-309, math.nan])
    np.testing.assert_allclose(unpacked(record), [0.0, 0.0, math.nan], atol=2.2e-309)


def test_numbers_that_seldom_change_take_no_room():
    record = packed(np.repeat([1.0, math.nan, 2.0], 1000))
    assert len(record['data']) < 20
    np.testing.assert_array_equal(unpacked(record), np.repeat([1.0, math.nan, 2.0], 1000))


def test_floats_are_four_bytes_each():
    assert base64.b64decode(floats([1.0])) == np.float32(1.0).tobytes()


def test_no_text_ends_the_element_that_holds_it():
    text = script_json({'name': '</script><script>alert(1)</script>&', 'none': math.nan})
    assert not set('<>&') & set(text)
    assert json.loads(text) == {'name': '</script><script>alert(1)</script>&', 'none': None}
