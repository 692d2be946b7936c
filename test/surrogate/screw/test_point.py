# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The point that a surface keeps, whatever its tier."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.screw.point import kept_point, ScrewPoint
from surrogate.surface import FIELDS

NUMBERS = {name: np.array(0.5 + place) for place, name in enumerate(FIELDS)}
POINT = ScrewPoint(
    converged=True,
    status='solved',
    contacts=(),
    normal_forces=(np.array(1.0), np.array(1.0)),
    worst_contact=np.array(2),
    **NUMBERS,
)


def test_numbers_are_kept_as_they_are():
    kept = kept_point(POINT)
    assert [getattr(kept, name) for name in FIELDS] == [0.5 + k for k in range(len(FIELDS))]
    assert all(type(getattr(kept, name)) is float for name in FIELDS)
    assert (kept.converged, kept.status, kept.worst_contact) == (True, 'solved', 2)
    assert math.isnan(kept.rcs_deviation)


@pytest.mark.parametrize('name', FIELDS)
@pytest.mark.parametrize('number', [math.nan, math.inf])
def test_a_point_without_a_number_does_not_hold(name, number):
    """Without a load there is no film, and a surface has no answer there."""
    assert not kept_point(replace(POINT, **{name: np.array(number)})).converged


def test_what_did_not_converge_does_not_hold():
    assert not kept_point(replace(POINT, converged=False)).converged
