# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The viscosity index against the examples of its standard and a published table."""

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.viscosity_index import (
    FITS,
    viscosity_at_100_astm_d2270,
    viscosity_index_astm_d2270,
)

EXAMPLES = [
    # The examples of ASTM D2270-93, sections 5.1.4 and 6.1.4.
    (73.30, 8.86, 92),
    (22.83, 5.05, 156),
    (53.47, 7.80, 111),
    # The table of the library libvisc (Zodr), whole numbers towards zero.
    (30.0, 4.24, -26),
    (30.0, 5.23, 105),
    (120.0, 8.0, -50),
    (120.0, 20.9, 201),
    (120.0, 50.0, 424),
    (70.0, 11.1, 150),
    (30.0, 5.81, 140),
    (68.0, 8.6, 97),
]


@pytest.mark.parametrize(('warm', 'hot', 'index'), EXAMPLES)
def test_published_indices(warm, hot, index):
    """To the whole number in which an index is stated."""
    assert round(viscosity_index_astm_d2270(1e-6 * warm, 1e-6 * hot)) == index


def test_printed_table():
    """L 119.94 and H 69.48 at 8.86 mm2/s, H 28.97 at 5.05 mm2/s, as the examples print them."""
    for index, warm, hot in ((0, 119.94, 8.86), (100, 69.48, 8.86), (100, 28.97, 5.05)):
        assert viscosity_index_astm_d2270(1e-6 * warm, 1e-6 * hot) == pytest.approx(index, abs=0.2)


def test_rows_of_the_table_join():
    """A wrong digit would leave a step between a row and the next."""
    for (top, *row), (_, *other) in zip(FITS, FITS[1:], strict=False):
        for (a, b, c), (d, e, f) in zip(row, other, strict=True):
            here, there = a * top * top + b * top + c, d * top * top + e * top + f
            assert here == pytest.approx(there, rel=2e-3)


@given(st.floats(10, 1000), st.floats(0, 300))
def test_viscosity_at_100_is_the_inverse(warm, index):
    """Within the step at the ends of a row."""
    hot = viscosity_at_100_astm_d2270(1e-6 * warm, index)
    assert viscosity_index_astm_d2270(1e-6 * warm, hot) == pytest.approx(index, abs=1.0)
    assert 2e-6 <= hot < 1e-6 * warm


def test_usual_grades():
    """The shipped sheets hold what the index 95 to 100 gives."""
    for grade, index, hot in ((32, 100, 5.4), (68, 100, 8.7), (100, 100, 11.4), (220, 95, 18.7)):
        found = 1e6 * viscosity_at_100_astm_d2270(1e-6 * grade, index)
        assert found == pytest.approx(hot, abs=0.05)


def test_an_index_that_no_oil_has_is_refused(refused):
    refused('index_minus_50', viscosity_at_100_astm_d2270, 5e-6, -50.0)
