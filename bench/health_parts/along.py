# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A place of the stroke that is worn, and the play between motor and table.

Steel grows by 11.5e-6 per kelvin. A screw of accuracy grade 5 has a travel variation of 23 um over
300 mm and 8 um in a turn (ISO 3408-3). Stiffness and skew of the encoders are assumed.

"""

import math

from health_parts.cycles import Motion
from health_parts.machine import Array
import numpy as np

WORN_AT, WORN_WIDTH = 0.6, 0.04  # centre and half width over the stroke
GROWTH = 11.5e-6  # [1/K]
ERROR, ERROR_LENGTH = 12e-6, 0.3  # [m] amplitude of the travel variation, and its length
TURN_ERROR = 2e-6  # [m]
SKEW = 4e-4  # [s] by which the scale is sampled later
NOISE = 0.5e-6  # [m] of the scale
FLEXIBILITY = 0.2e-6  # [m s2/m] wind-up under the inertia of the table, over its acceleration


def worn_place(share: float | Array, worn: float | Array) -> Array:
    """Return the factor of the friction at a share of the stroke: `worn` in the middle of it."""
    near = np.clip((np.asarray(share) - WORN_AT) / WORN_WIDTH, -1.0, 1.0)
    return 1.0 + (np.asarray(worn) - 1.0) * 0.5 * (1.0 + np.cos(math.pi * near))


def played(motor: Array, play: float) -> Array:
    """Return where a table stands [m] that a motor at `motor` [m] drags with a `play` [m]."""
    table = np.empty_like(motor)
    here = float(motor[0]) - 0.5 * play
    for k, there in enumerate(motor.tolist()):
        here = min(max(here, there - 0.5 * play), there + 0.5 * play)
        table[k] = here
    return table


def table_position(
    moved: Motion, time: Array, lead: float, *, play: float, warm: float, rng: np.random.Generator
) -> Array:
    """
    Return the position of the table [m] as its scale says it at times [s].

    The screw of a `lead` [m] is warmer by `warm` [K] than when it was measured.

    """
    motor = moved.position
    error = ERROR * np.sin(2.0 * math.pi * motor / ERROR_LENGTH)
    error = error + TURN_ERROR * np.sin(2.0 * math.pi * motor / lead)
    grown = GROWTH * warm * motor
    bent = -FLEXIBILITY * moved.acceleration * lead / (2.0 * math.pi)
    later = moved.speed * lead / (2.0 * math.pi) * SKEW
    noise = NOISE * rng.standard_normal(len(time))
    return np.asarray(played(motor, play) + error + grown + bent + later + noise)
