# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Confidence intervals of a least-squares fit from its Jacobian, and where there are none."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

Array = NDArray[np.float64]

CONFIDENCE = 0.95
"""Probability that an interval holds the true value [-]."""
SMALLEST_SINGULAR = 1e-6
"""Singular value of the scaled Jacobian, over the largest, that counts as none [-]."""
TAKES_PART = 0.1
"""Share in an undetermined direction from which on a parameter takes part in it [-]."""


def student_factor(degrees_of_freedom: int) -> float:
    """Return the half width of an interval over the standard error [-]."""
    return float(student.ppf(0.5 * (1 + CONFIDENCE), degrees_of_freedom))


def undetermined(names: tuple[str, ...], jacobian: Array) -> dict[str, str]:
    """Return the parameters that the data cannot tell from one another, with the reason."""
    if not names:
        return {}
    sizes = np.linalg.norm(jacobian, axis=0)
    _, singular, directions = np.linalg.svd(jacobian / sizes)
    lost = directions[singular < SMALLEST_SINGULAR * singular[0]]
    mixed = [
        name
        for name, part in zip(names, np.abs(lost).max(axis=0, initial=0.0), strict=True)
        if part > TAKES_PART
    ]
    return {name: f'the data cannot tell {" from ".join(mixed)}' for name in mixed}


def covariance(jacobian: Array, residual: Array, spread: float = 0.0) -> tuple[Array, float]:
    """
    Return the covariance of the parameters and the variance of a point, in squares of residuals.

    s^2 (J^T J)^-1 with s^2 over the degrees of freedom. With a `spread` above 0, in units of the
    residual, the points were weighed by soft_l1, psi(z) = z / sqrt(1 + z^2), and s^2 becomes
    spread^2 sum psi^2 / (n - p) / mean(psi')^2: Huber, Robust Statistics (1981), section 7.6. Of a
    Jacobian without full rank only the determined directions are inverted.

    """
    points, parameters = jacobian.shape
    freedom = points - parameters
    sizes = np.linalg.norm(jacobian, axis=0)
    scaled = jacobian / sizes
    inverse = np.linalg.pinv(scaled.T @ scaled, rcond=SMALLEST_SINGULAR**2, hermitian=True)
    variance = float(residual @ residual) / freedom
    if spread > 0:
        z = residual / spread
        slope = float(np.mean((1 + z * z) ** -1.5))
        variance = spread**2 * float(np.sum(z * z / (1 + z * z))) / freedom / slope**2
    return variance * inverse / np.outer(sizes, sizes), variance


def correlation(cover: Array) -> Array:
    """Return the correlation [-] of a covariance."""
    size = np.sqrt(np.diag(cover))
    known = np.where(size > 0, size, math.nan)
    return cover / np.outer(known, known)
