# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Faults of the inputs that the residual of the baseline itself shows, before any change.

A load of the wrong sign or unit, a wrong torque constant or gear ratio and an offset of the sensor
move the measured torque away from the surface by far more than the surface errs, each by its
pattern. The doubts are wide: the surface is not fitted to the axis here.

"""

from collections.abc import Sequence

from ballscrew_monitor.health.causes import birge, Candidate, CANDIDATES, EXCLUDED
from ballscrew_monitor.health.change import mean_points, telling
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import CauseCode, ComparablePoint
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface

Array = NDArray[np.float64]
FAULTS = (CauseCode.LOAD_SIGN_OR_UNIT, CauseCode.TORQUE_CONSTANT, CauseCode.SENSOR_OFFSET)
SHARED_ERROR, OWN_ERROR = 0.3, 0.1
"""Errors of the friction of the surface: of all groups alike, and of each [-]."""
CONSTANT_ERROR = 0.5
"""Constant drag that the surface does not know of, over the mean friction [-]."""
LOAD_ERROR = 0.03
"""Error of the torque of the load [-]."""
CERTAIN, LEFT = 30.0, 0.3
"""Fall of chi squared from which a fault is told, and the part of it that may be left [-]."""
MOST_FACTOR = 1000.0
"""Largest factor on the torque that is told, that of mN m for N m [-]."""
NOT_IDENTIFIED = (
    'the measured torque lies far from that of the surface, which has no parasitic torque: '
    'identify it by a run without load (ballscrew identify); torque constant and gear ratio are '
    'not judged before'
)
NOT_TOLD = (
    'the measured torque lies far from that of the surface, and the motion so far does not tell '
    'why: check sign and unit of the load, torque constant, gear ratio and offset'
)
NEITHER = (
    'the measured torque lies far from that of the surface, and the motion so far does not tell '
    'why: check sign and unit of the load, and the offset; the surface has no parasitic torque: '
    'identify it by a run without load (ballscrew identify)'
)
"""What is said where neither is told nor identified: nothing of the torque constant."""


def input_fault(points: Sequence[ComparablePoint], surface: Surface) -> str:
    """Return in a sentence which input is wrong by the points of a baseline, or ''."""
    model = Model(surface)
    means = list(mean_points(telling(points, model)).values())
    if len(means) <= len(FAULTS):
        return ''
    residual = model.residuals(means)
    inverse: Array = np.linalg.inv(_covariance(model, means)).astype(float)
    nothing = float(residual @ inverse @ residual)
    fits = [
        (*_fit(one.pattern(model, means, 1.0), residual, inverse), one)
        for one in CANDIDATES
        if one.code in FAULTS
    ]
    (chi, size, best), (second, *_), *_ = sorted(fits, key=lambda fit: fit[0])
    if nothing - chi < CERTAIN or chi > LEFT * nothing:
        return ''
    if second - chi < EXCLUDED * birge(chi, len(means)):
        return NOT_TOLD if model.is_identified else NEITHER
    if best.code is CauseCode.TORQUE_CONSTANT and not model.is_identified:
        return NOT_IDENTIFIED
    return _sentence(best, size)


def _fit(pattern: Array, residual: Array, inverse: Array) -> tuple[float, float]:
    """Return the least chi squared of a pattern, and its size."""
    normal = float(pattern @ inverse @ pattern)
    size = float(pattern @ inverse @ residual) / normal if normal > 0.0 else 0.0
    apart = residual - size * pattern
    return float(apart @ inverse @ apart), size


def _covariance(model: Model, points: Sequence[ComparablePoint]) -> Array:
    friction = model.friction(points)
    ideal = np.array([model.ideal(one) for one in points])
    own = (OWN_ERROR * friction) ** 2 + (LOAD_ERROR * ideal) ** 2
    constant = CONSTANT_ERROR * float(friction.mean())
    shared = SHARED_ERROR * friction
    return np.asarray(np.diag(own) + np.outer(shared, shared) + constant**2)


def _sentence(fault: Candidate, size: float) -> str:
    if fault.code is CauseCode.SENSOR_OFFSET:
        return (
            f'the measured torque is shifted by {size:+.3g} N m in both directions since the '
            'baseline began: set the zero of the torque sensor'
        )
    if fault.code is CauseCode.TORQUE_CONSTANT and abs(1.0 - size) * MOST_FACTOR < 1.0:
        return NOT_TOLD
    if fault.code is CauseCode.TORQUE_CONSTANT:
        return (
            f'the measured torque is {1.0 / (1.0 - size):.3g} times that of the surface, with and '
            'without load: check torque constant and gear ratio'
        )
    if size < -1.0:
        return (
            f'the measured torque follows {1.0 + size:.3g} times the load: the load, or the '
            'torque, has the wrong sign'
        )
    return (
        f'the measured torque follows {1.0 + size:.3g} times the load: check unit and scale of '
        'the load'
    )
