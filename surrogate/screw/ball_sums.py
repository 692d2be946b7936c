# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sums of friction over the places of one contact, with exact derivatives; compiled."""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit

Array = NDArray[np.float64]


@njit(cache=True, error_model='numpy')
def sum_friction(
    x: Array,
    y: Array,
    boundary: Array,
    eyring: Array,
    rate: Array,
    limit: Array,
    motion: Array,
    radius: float,
    deformed: float,
    slip_floor: float,
) -> tuple[Array, Array, Array, float]:
    """
    Add up -f V/|V| over places, f = boundary + min(eyring asinh(rate |V|), limit).

    Places [m], strengths as in `Traction`, motion against the raceway [m/s, rad/s], radius of the
    ball and Heathcote's [m]. Returns forces and moments (5), their derivatives by the motion (5,
    5) and by the logarithm of the size of the patch (5), and the lost power f V^2/|V| [W].

    """
    total, grown, power = np.zeros(5), np.zeros(5), 0.0
    upper = np.zeros(15)
    for n in range(x.size):
        bow = y[n] * y[n] / (2 * deformed)
        arm = radius - bow
        slip_t = motion[0] + motion[3] * y[n] - motion[4] * arm
        slip_p = motion[1] + motion[2] * arm - motion[3] * x[n]
        square = slip_t * slip_t + slip_p * slip_p
        speed = math.sqrt(square + slip_floor * slip_floor)
        force, slope = boundary[n], 0.0
        if eyring[n] > 0:
            shear = rate[n] * speed
            root = math.sqrt(1 + shear * shear)
            # asinh of what is not negative: log1p stays exact for weak shear.
            sheared = eyring[n] * math.log1p(shear + shear * shear / (1 + root))
            force += min(sheared, limit[n])
            slope = eyring[n] * rate[n] / root if sheared < limit[n] else 0.0
        drag = force / speed
        bend = (slope - drag) / (speed * speed)
        power += drag * square
        tumble, spin, roll = arm * slip_p, y[n] * slip_t - x[n] * slip_p, -arm * slip_t
        total[0] -= drag * slip_t
        total[1] -= drag * slip_p
        total[2] -= drag * tumble
        total[3] -= drag * spin
        total[4] -= drag * roll
        upper[0] -= drag + bend * slip_t * slip_t
        upper[1] -= bend * slip_t * slip_p
        upper[2] -= bend * slip_t * tumble
        upper[3] -= drag * y[n] + bend * slip_t * spin
        upper[4] -= bend * slip_t * roll - drag * arm
        upper[5] -= drag + bend * slip_p * slip_p
        upper[6] -= drag * arm + bend * slip_p * tumble
        upper[7] -= bend * slip_p * spin - drag * x[n]
        upper[8] -= bend * slip_p * roll
        upper[9] -= drag * arm * arm + bend * tumble * tumble
        upper[10] -= bend * tumble * spin - drag * arm * x[n]
        upper[11] -= bend * tumble * roll
        upper[12] -= drag * (x[n] * x[n] + y[n] * y[n]) + bend * spin * spin
        upper[13] -= bend * spin * roll - drag * y[n] * arm
        upper[14] -= drag * arm * arm + bend * roll * roll
        more_t = motion[3] * y[n] + 2 * motion[4] * bow
        more_p = -2 * motion[2] * bow - motion[3] * x[n]
        change = bend * (slip_t * more_t + slip_p * more_p)
        grown[0] -= drag * more_t + change * slip_t
        grown[1] -= drag * more_p + change * slip_p
        grown[2] -= drag * (arm * more_p - 2 * bow * slip_p) + change * tumble
        grown[3] -= drag * (y[n] * more_t - x[n] * more_p) + (drag + change) * spin
        grown[4] -= drag * (2 * bow * slip_t - arm * more_t) + change * roll
    matrix, n = np.empty((5, 5)), 0
    for k in range(5):
        for m in range(k, 5):
            matrix[k, m] = matrix[m, k] = upper[n]
            n += 1
    return total, matrix, grown, power
