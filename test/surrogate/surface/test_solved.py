# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A solved point and a looked-up one have the same fields."""

from dataclasses import fields
import math

from surrogate.surface import FIELDS, SolvedPoint, SurfacePoint


def test_fields_are_those_of_a_surface_and_without_a_solve_unknown():
    names = [field.name for field in fields(SolvedPoint)]
    assert tuple(name for name in names if name in FIELDS) == FIELDS
    assert set(names) - set(FIELDS) == {'converged', 'status', 'worst_contact', 'rcs_deviation'}
    assert all(hasattr(SurfacePoint, name) for name in (*FIELDS, 'worst_contact'))
    none = SolvedPoint(converged=False)
    assert all(math.isnan(getattr(none, name)) for name in FIELDS)
    assert none.worst_contact == -1
