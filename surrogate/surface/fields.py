# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The fields of a surface, in table order."""

FIELDS = (
    'friction_torque',
    'rcs',
    'asperity_share',
    'film_ratio',
    'central_film',
    'minimum_film',
    'friction_coefficient',
    'max_pressure',
)
"""Interpolated fields in table order."""
MEASURED = FIELDS[:2]
"""Fields whose measured interpolation error and spread a point tells, torque and RCS."""
LOGARITHMIC = ('film_ratio', 'central_film', 'minimum_film')
"""Fields that are interpolated by their logarithm."""
SHARES = ('rcs', 'asperity_share')
"""Fields between 0 and 1."""
