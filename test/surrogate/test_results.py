# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of results follow from what these declare."""

from dataclasses import dataclass
import math

import numpy as np
import pytest
from surrogate.results import declared, Mean, number, required


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    film: float = required('m')
    share: float = number()
    rcs: Mean = number(default=Mean())
    height: Mean = number('m', default=Mean())
    steps: int = number(default=0)
    turned: bool = number(default=False)
    word: str = ''


def test_numbers_stand_under_name_and_unit_and_nothing_else_does():
    """An array of one number is a number; whole ones and truth stay what they are."""
    record = declared(Result(film=np.array(2e-7), steps=3, turned=True, word='not a number'))
    assert record['film_m'] == 2e-7
    assert type(record['film_m']) is float
    assert math.isnan(record['share'])
    assert record['steps'] == 3
    assert record['turned'] is True
    assert 'word' not in record


def test_an_average_has_its_standard_error_beside_it():
    """The unit ends both keys."""
    record = declared(Result(film=0.0, rcs=Mean(value=0.1), height=Mean(value=2.0, error=0.5)))
    assert (record['rcs'], record['height_m'], record['height_standard_error_m']) == (0.1, 2, 0.5)
    assert math.isnan(record['rcs_standard_error'])


def test_a_required_number_must_be_given():
    with pytest.raises(TypeError):
        Result()
