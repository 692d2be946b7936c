# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers as people write them."""

import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.units import digits


@pytest.mark.parametrize(
    ('value', 'count', 'text'),
    [
        (1030.4, 3, '1030'),
        (12346.0, 4, '12350'),
        (99.36, 3, '99.4'),
        (0.00012, 3, '0.00012'),
        (0.0, 3, '0'),
        (-2.5, 3, '-2.5'),
        (math.nan, 3, 'nan'),
    ],
)
def test_a_number_has_its_digits_and_no_power_of_ten(value, count, text):
    assert digits(value, count) == text


@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 9))
def test_it_is_the_rounded_number(value, count):
    assert 'e' not in digits(value, count).lower()
    assert float(digits(value, count)) == float(f'{value:.{count}g}')
