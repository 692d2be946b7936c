# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A solved point in the form of a lookup."""

from dataclasses import fields
import math

import pytest
from surrogate.formulas.torque import efficiency
from surrogate.surface import FIELDS, shipped_surface, solved_point, Surface, Validity
from surrogate.surface.point import SurfacePoint, VALIDITIES

LEAD = 0.01


def solved(load, **changes):
    """Return the means of a lookup, and the point that they are solved as."""
    found = Surface.load(shipped_surface(tier='closed_form')).lookup(62.8, load, 313.15)
    means = {name: getattr(found, name) for name in FIELDS} | changes
    spreads = (
        dict.fromkeys(FIELDS, math.nan) | {'friction_torque': torque, 'rcs': rcs}
        for torque, rcs in ((0.01, 0.02), (0.003, 0.004))
    )
    worst = found.worst_contact
    point = solved_point(means, *spreads, worst_contact=worst, opposing_load=load, lead=LEAD)
    return found, point


@pytest.mark.parametrize('load', [1000.0, -1000.0])
def test_a_solved_point_says_what_a_lookup_says_and_what_strips_differ_by(load):
    found, point = solved(load)
    for name in (*FIELDS, 'efficiency', 'driving_torque', 'back_driving', 'worst_contact'):
        assert getattr(point, name) == getattr(found, name), name
    assert point.validity is Validity.VALID
    assert (point.friction_torque_std, point.rcs_std) == (0.01, 0.02)
    assert (point.friction_torque_stderr, point.rcs_stderr) == (0.003, 0.004)
    step = 1e-6
    more = efficiency(point.friction_torque + step, load, LEAD)
    slope = abs(more - point.efficiency) / step
    assert point.efficiency_std == pytest.approx(0.01 * slope, rel=1e-4)
    assert point.efficiency_stderr == pytest.approx(0.003 * slope, rel=1e-4)
    for name in ('friction_torque_error', 'rcs_error', 'efficiency_error'):
        assert math.isnan(getattr(point, name))


def test_a_share_stays_one():
    _, point = solved(1000.0, rcs=1.0 + 1e-9, asperity_share=-1e-9, film_ratio=2.0)
    assert (point.rcs, point.asperity_share, point.film_ratio) == (1.0, 0.0, 2.0)


def test_a_fresh_point_is_unknown_and_validities_count_from_it():
    assert SurfacePoint().validity is Validity.UNKNOWN
    assert [int(one) for one in VALIDITIES] == list(range(7))
    assert {one.name for one in fields(SurfacePoint)} > set(FIELDS)
