# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Discrete Reynolds equation, its exact linearisation and its free boundaries, compiled.

Arrays have x along the first axis. Everything is in Hertz units: pressure over the Hertz pressure,
film over a^2/Rx, x over a; fluxes are multiplied by dx. Stencil planes: 0 centre, 1 west, 2 east,
3 south, 4 north, 5 second west.

"""

import math

from numba import njit
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

DENSITY_PRESSURE = 5.9e8
"""Pressure constant of the Dowson-Higginson density [Pa]."""
ROELANDS_PRESSURE = 1.96e8
"""Reference pressure of the Roelands law [Pa]."""


@njit(cache=True, error_model='numpy')
def fluid_at(
    pressure: float, scale: float, growth: float, exponent: float, gain: float
) -> tuple[float, float, float, float]:
    """
    Return ln(eta/eta0), its slope, density ratio, its slope, at `pressure` * `scale` [Pa].

    ln(eta/eta0) = growth [(1 + p/p0)^exponent - 1]: Roelands, and Barus with the exponent 1.
    Density 1 + gain p/(p + 5.9e8 Pa): with the gain 0.34 Dowson-Higginson as Venner and Lubrecht
    (2000) write it, which films depend on by 0.6 % against 0.6/1.7 GPa; incompressible with 0.

    """
    base = 1.0 + pressure * scale / ROELANDS_PRESSURE
    power = base**exponent if exponent != 1.0 else base
    slope = growth * exponent * power / base * scale / ROELANDS_PRESSURE
    room = DENSITY_PRESSURE + pressure * scale
    density = 1.0 + gain * pressure * scale / room
    return (
        growth * (power - 1.0),
        slope,
        density,
        gain * DENSITY_PRESSURE * scale / (room * room),
    )


@njit(cache=True, error_model='numpy')
def film_properties(
    pressure: Array,
    gap: Array,
    contact: Mask,
    floor: float,
    scale: float,
    growth: float,
    exponent: float,
    gain: float,
    mobility: float,
    out: Array,
) -> None:
    """
    Fill the planes of film properties, all in Hertz units [-].

    0 flow factor, 1 and 2 its slopes in pressure and film, 3 density, 4 slope, 5 film. The flow
    factor is `mobility` rho h^3 / eta; the film never falls below the floor, and does not react to
    the gap on contact nodes. Plane 6 is 1 where it reacts, 0 elsewhere.

    """
    nx, ny = pressure.shape
    rest = fluid_at(0.0, scale, growth, exponent, gain)
    for i in range(nx):
        for j in range(ny):
            p = pressure[i, j]
            log_viscosity, stiffening, density, slope = rest
            if p > 0.0:
                log_viscosity, stiffening, density, slope = fluid_at(
                    p, scale, growth, exponent, gain
                )
            h, free = gap[i, j], 1.0
            if contact[i, j]:
                h, free = floor, 0.0
            elif h < floor:
                h = floor
            flow = mobility * density * h * h * h
            if log_viscosity != 0.0:
                flow *= math.exp(-log_viscosity)
            out[0, i, j] = flow
            out[1, i, j] = flow * (slope / density - stiffening)
            out[2, i, j] = 3.0 * flow / h * free
            out[3, i, j] = density
            out[4, i, j] = slope
            out[5, i, j] = h
            out[6, i, j] = free


@njit(cache=True, error_model='numpy')
def reynolds_rows(
    pressure: Array,
    film: Array,
    aspect: float,
    order: float,
    inlet: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> None:
    """
    Assemble F = -div(flow grad p) dx + d(rho h)/dx dx and its planes dF/dp, dF/dh.

    Faces take the mean flow factor of two nodes, `aspect` is (dx/dy)^2. The upstream wedge has
    order 1 to 2 (a blend between). Just outside the first row the pressure is `inlet` times that
    inside it. Border rows get zero planes. Hertz units [-].

    """
    nx, ny = pressure.shape
    flow, flow_p, flow_h = film[0], film[1], film[2]
    density, density_p, height, free = film[3], film[4], film[5], film[6]
    residual[:] = 0.0
    by_pressure[:] = 0.0
    by_gap[:] = 0.0
    for i in range(1, nx - 1):
        extra = 0.5 * (order - 1.0) if i > 1 else 0.0
        w0, w1, w2 = 1.0 + extra, -1.0 - 2.0 * extra, extra
        n = max(i - 2, 0)
        for j in range(1, ny - 1):
            p, e = pressure[i, j], flow[i, j]
            west = (pressure[i - 1, j] if i > 1 else inlet[j] * p) - p
            east = pressure[i + 1, j] - p
            south, north = pressure[i, j - 1] - p, pressure[i, j + 1] - p
            ew, ee = 0.5 * (e + flow[i - 1, j]), 0.5 * (e + flow[i + 1, j])
            es, en = 0.5 * (e + flow[i, j - 1]), 0.5 * (e + flow[i, j + 1])
            pull = 0.5 * (west + east + aspect * (south + north))
            residual[i, j] = (
                -ew * west
                - ee * east
                - aspect * (es * south + en * north)
                + w0 * density[i, j] * height[i, j]
                + w1 * density[i - 1, j] * height[i - 1, j]
                + w2 * density[n, j] * height[n, j]
            )
            by_pressure[0, i, j] = (
                ew
                + ee
                + aspect * (es + en)
                - flow_p[i, j] * pull
                + w0 * density_p[i, j] * height[i, j]
            )
            by_pressure[1, i, j] = (
                -ew - 0.5 * flow_p[i - 1, j] * west + w1 * density_p[i - 1, j] * height[i - 1, j]
            )
            by_pressure[2, i, j] = -ee - 0.5 * flow_p[i + 1, j] * east
            by_pressure[3, i, j] = -aspect * (es + 0.5 * flow_p[i, j - 1] * south)
            by_pressure[4, i, j] = -aspect * (en + 0.5 * flow_p[i, j + 1] * north)
            by_pressure[5, i, j] = w2 * density_p[n, j] * height[n, j]
            if i == 1:
                by_pressure[0, i, j] -= ew * inlet[j]
            by_gap[0, i, j] = w0 * density[i, j] * free[i, j] - flow_h[i, j] * pull
            by_gap[1, i, j] = (
                w1 * density[i - 1, j] * free[i - 1, j] - 0.5 * flow_h[i - 1, j] * west
            )
            by_gap[2, i, j] = -0.5 * flow_h[i + 1, j] * east
            by_gap[3, i, j] = -0.5 * aspect * flow_h[i, j - 1] * south
            by_gap[4, i, j] = -0.5 * aspect * flow_h[i, j + 1] * north
            by_gap[5, i, j] = w2 * density[n, j] * free[n, j]


@njit(cache=True, error_model='numpy')
def contact_set(
    asperity: Array, gap: Array, floor: float, stiffness: float, symmetric: bool, contact: Mask
) -> int:
    """Mark nodes with pa * stiffness > h - floor; return their number."""
    nx, ny = gap.shape
    count = 0
    contact[:] = False
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if asperity[i, j] * stiffness > gap[i, j] - floor:
                contact[i, j] = True
                count += 1
        if symmetric:
            contact[i, 0] = contact[i, 2]
    return count


@njit(cache=True, error_model='numpy')
def free_boundary_rows(
    pressure: Array,
    film: Array,
    dry: bool,
    stiffness: float,
    weights: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
    cavitated: Mask,
) -> float:
    """
    Replace the rows of the cavitated set by dp = -p and scale all rows.

    Returns the sum of |F|/h over the other rows [-]. Cavitated where p times the size of the row
    is below F, everywhere when dry. That size counts the film, too: the flow factor of a stiff
    fluid vanishes inside the contact.

    """
    nx, ny = pressure.shape
    total = 0.0
    cavitated[:] = False
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            f = residual[i, j]
            scale = max(abs(by_pressure[0, i, j]) + abs(by_gap[0, i, j]) * stiffness, 1e-300)
            if dry or pressure[i, j] * scale < f:
                cavitated[i, j] = True
                by_pressure[:, i, j] = 0.0
                by_gap[:, i, j] = 0.0
                by_pressure[0, i, j] = 1.0
                residual[i, j] = pressure[i, j]
                continue
            total += abs(f) / film[i, j] * weights[j]
            factor = 1.0 / scale
            for plane in range(6):
                by_pressure[plane, i, j] *= factor
                by_gap[plane, i, j] *= factor
            residual[i, j] = f * factor
    return total
