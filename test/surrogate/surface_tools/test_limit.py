# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The limit of RCS of the optimal zone: where it is, and how far off in speed."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.surface import Surface
from surrogate.surface.aims import RCS_LIMIT
from surrogate.surface_tools.limit import limit_error, limit_errors, limit_speed


@pytest.fixture(name='surface')
def load_surface(surface_data):
    return Surface(surface_data)


@pytest.mark.parametrize('load', [-900.0, 0.0, 3300.0])
def test_speed_at_the_limit_is_found(surface, load):
    speed = limit_speed(surface, load, 313.15)
    assert surface.lookup(speed, load, 313.15).rcs == pytest.approx(RCS_LIMIT, rel=1e-6)


def test_no_limit_where_rcs_stays_on_one_side_or_an_answer_is_missing(surface_data, surface):
    rcs = np.zeros_like(surface_data.fields['rcs'])
    calm = replace(surface_data, fields={**surface_data.fields, 'rcs': rcs})
    assert limit_speed(Surface(calm), 0.0, 313.15) is None
    assert not list(limit_errors(calm, 3, 1, lambda: True))
    s = math.log(limit_speed(surface, 0.0, 313.15) / surface.onset_speed(0.0, 313.15))
    mask = surface_data.mask.copy()
    mask[np.searchsorted(surface_data.speed_coordinate, s) - 1] = True
    assert limit_speed(Surface(replace(surface_data, mask=mask)), 0.0, 313.15) is None


@pytest.mark.parametrize('shift', [-0.03, 0.02])
def test_a_curve_that_is_moved_along_the_speed_is_off_by_as_much(surface, shift):
    """A surface that has the limit at too slow a speed has a negative error."""
    speed = limit_speed(surface, 500.0, 313.15)
    solved = surface.lookup(speed * math.exp(shift), 500.0, 313.15).rcs
    found = limit_error(surface, (speed, 500.0, 313.15), solved)
    assert found == pytest.approx(shift, rel=0.1)


def test_formulas_have_their_limit_within_a_hundredth_while_there_is_time(surface_data):
    """The largest is near 2100 N, where another contact becomes the worst; a moved one is seen."""
    found = list(limit_errors(surface_data, 8, 1, lambda: True))
    assert len(found) == 8
    assert max(abs(error) for _, error in found) < 1e-2
    apart = [error for (_, load, _), error in found if not 1900 < abs(load) < 2756]
    assert max(map(abs, apart)) < 1e-3
    assert list(limit_errors(surface_data, 8, 1, lambda: True)) == found
    moved = replace(surface_data, log_onset=surface_data.log_onset + 0.05)
    errors = [error for _, error in limit_errors(moved, 8, 1, lambda: True)]
    assert errors == pytest.approx([0.05] * 8, rel=0.15)
    left = iter([True, True, False])
    assert len(list(limit_errors(surface_data, 5, 1, lambda: next(left)))) == 2
