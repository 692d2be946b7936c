# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A film that is not fully flooded."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.formulas.starvation import starved_speed
from surrogate.screw.closed_form import solve


@pytest.mark.parametrize('factor', [0.05, 0.5, 1.0])
def test_the_central_film_is_the_stated_share(screw, oil, factor):
    starved = solve(screw, replace(oil, film_factor=factor), [1.0, 50.0], 500.0, 313.15)
    flooded = solve(screw, oil, [1.0, 50.0], 500.0, 313.15)
    np.testing.assert_allclose(starved.central_film, factor * flooded.central_film, rtol=1e-12)
    np.testing.assert_allclose(starved.film_ratio, factor * flooded.film_ratio, rtol=1e-12)
    np.testing.assert_array_equal(starved.entrainment_speed, flooded.entrainment_speed)
    assert np.all(starved.rcs >= flooded.rcs)


def test_a_flooded_contact_keeps_its_speed_to_the_bit(oil):
    assert starved_speed(oil, 0.123456789) == 0.123456789
