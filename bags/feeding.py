# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Parts of most scenarios: an optimal feed, a creep that is not, and the change between them.

Speeds [rev/min], loads on the nut [N], oil [degC], times [s].

"""

from courses import Course
from scenario import LimitPoint, PERIOD, Span

FEED, CREEP, LOAD, OIL = 900.0, 150.0, 1000.0, 40.0
CLEAR_DELAY = 1.0  # [s] of the parameters
LIMIT_SPEED = 401.0  # [rev/min] at which asperities begin to touch under LOAD in oil of OIL
RAMP = 0.1  # [s] of a change of speed or load
LATE = PERIOD + 0.001  # [s] by which a sample may come after what it shows
TOUCHING = LimitPoint(quantity='rcs', value=0.01, speed=LIMIT_SPEED, load=LOAD, oil=OIL)


def later(span: Span, low: float, high: float) -> Span:
    """Return a span [s] with its begin `low` and its end `high` later [s]."""
    return span[0] + low, span[1] + high


def leaves(speed: Course, number: int, limit: float = LIMIT_SPEED) -> Span:
    """Return when a falling speed begins to touch, the limit speed [rev/min] 10 % off."""
    return later(speed.pass_between(1.1 * limit, 0.9 * limit, number), 0.0, LATE)


def clears(speed: Course, number: int, limit: float = LIMIT_SPEED) -> Span:
    """Return when a rising speed has cleared; the hysteresis is worth 5 % of the speed."""
    reached = speed.pass_between(0.9 * limit, 1.155 * limit, number)
    return later(reached, CLEAR_DELAY, CLEAR_DELAY + LATE)
