# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Aims as README and guide state them."""

import pytest
from surrogate.surface import aims


def test_the_optimal_zone_is_the_stated_one():
    assert (aims.RCS_LIMIT, aims.EFFICIENCY_LIMIT, aims.LIGHT_LOAD) == (0.01, 0.85, 0.25)
    assert aims.EFFICIENCY_TOLERANCE == 0.003


@pytest.mark.parametrize(('rcs', 'error'), [(0.0, 0.005), (0.05, 0.005), (0.5, 0.05)])
def test_an_rcs_is_aimed_at_to_a_tenth_or_half_a_percent(rcs, error):
    assert aims.rcs_tolerance(rcs) == pytest.approx(error)
