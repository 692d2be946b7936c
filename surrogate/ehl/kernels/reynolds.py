# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Discrete Reynolds equation, its exact linearisation and its free boundaries, compiled.

Arrays have x along the first axis. Everything is in Hertz units: pressure over the Hertz pressure,
film over a^2/Rx, x over a; fluxes are multiplied by dx. Stencil planes: 0 centre, 1 west, 2 east,
3 south, 4 north, 5 second west.

"""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit
from surrogate.formulas.lubricant import ROELANDS_PRESSURE

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

DENSITY_PRESSURE = 5.9e8
"""Pressure constant of the Dowson-Higginson density [Pa]."""
LEAST_REACTION = 0.1
"""Least weight of a row in the flux error, where flow outweighs the film by far [-]."""


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
    out: Array,
) -> None:
    """
    Fill the planes of film properties, all in Hertz units [-].

    0 density, 1 its slope in pressure, 2 film, 3 logarithm of viscosity, 4 its slope, 5 fluidity.
    The film never falls below the floor, and does not react to the gap on contact nodes: plane 6
    is 1 where it reacts, 0 elsewhere.

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
            out[0, i, j] = density
            out[1, i, j] = slope
            out[2, i, j] = floor if contact[i, j] else max(gap[i, j], floor)
            out[3, i, j] = log_viscosity
            out[4, i, j] = stiffening
            out[5, i, j] = math.exp(-log_viscosity)
            out[6, i, j] = 0.0 if contact[i, j] else 1.0


@njit(cache=True, error_model='numpy', inline='always')
def mean_fluidity(
    log_a: float, log_b: float, fluidity_a: float, fluidity_b: float
) -> tuple[float, float, float]:
    """
    Return the logarithmic mean of two fluidities and its slopes in both logarithms of viscosity.

    It is the mean over the pressures between the nodes, so that a face passes what Kirchhoff's
    pressure, the integral of dp/eta, drives: exact for exponential viscosity however steep.

    """
    r = log_b - log_a
    if abs(r) < 0.02:
        return (
            fluidity_a * (1.0 - r * (0.5 - r * (1.0 / 6.0 - r / 24.0))),
            fluidity_a * (-0.5 + r * (1.0 / 6.0 - r / 24.0)),
            fluidity_a * (-0.5 + r * (1.0 / 3.0 - r / 8.0)),
        )
    mean = (fluidity_a - fluidity_b) / r
    return mean, (mean - fluidity_a) / r, (fluidity_b - mean) / r


@njit(cache=True, error_model='numpy', inline='always')
def face_flow(
    film: Array, i: int, j: int, k: int, n: int, climbs: bool, series: bool
) -> tuple[float, float, float, float, float]:
    """
    Return the flow factor rho h^3/eta [-] between nodes (i, j) and (k, n) and its four slopes.

    Slopes: in the pressures of both nodes, then in their gaps. In `series` h^3 is
    2 a^2 b^2/(a + b), what a flux meets where the film goes from a to b: the thin end rules; else
    the plain mean. The fluidity is the logarithmic mean where the pressure `climbs`; where it
    falls along the flow that would let Newton find the edge of the rupture one power of e at a
    time, and the plain mean serves.

    """
    fluid_a, fluid_b = film[5, i, j], film[5, k, n]
    mean, in_a, in_b = 0.5 * (fluid_a + fluid_b), -0.5 * fluid_a, -0.5 * fluid_b
    if climbs:
        mean, in_a, in_b = mean_fluidity(film[3, i, j], film[3, k, n], fluid_a, fluid_b)
    a, b = film[2, i, j], film[2, k, n]
    cube, in_a3, in_b3 = 0.5 * (a * a * a + b * b * b), 1.5 * a * a, 1.5 * b * b
    if series:
        cube = 2.0 * a * a * b * b / (a + b)
        in_a3, in_b3 = cube * (2.0 / a - 1.0 / (a + b)), cube * (2.0 / b - 1.0 / (a + b))
    dense = 0.5 * (film[0, i, j] + film[0, k, n])
    return (
        dense * cube * mean,
        cube * (0.5 * film[1, i, j] * mean + dense * in_a * film[4, i, j]),
        cube * (0.5 * film[1, k, n] * mean + dense * in_b * film[4, k, n]),
        dense * mean * in_a3 * film[6, i, j],
        dense * mean * in_b3 * film[6, k, n],
    )


@njit(cache=True, error_model='numpy', inline='always')
def limited_change(here: float, before: float) -> tuple[float, float, float]:
    """
    Return the change to the node before, limited where it is large, and its two slopes.

    The change d = before - here becomes d here/(here + |d|): what is extrapolated stays positive,
    and the inlet of a thin film may be missed by the nodes. A smooth film so found, at order 2
    throughout, is right within 0.3 % where the node distance is 0.1 to 0.8 of the inlet length.

    """
    change = before - here
    ratio = here / (here + abs(change))
    if change > 0.0:
        return change * ratio, 1.0 - 2.0 * ratio, ratio * ratio
    return change * ratio, -1.0 - 2.0 * change / here * ratio * ratio, ratio * ratio


@njit(cache=True, error_model='numpy', inline='always')
def carried_mass(
    film: Array, i: int, j: int, order: float, fading: float
) -> tuple[float, float, float, float, float]:
    """
    Return rho h [-] that leaves node (i, j) downstream, its slopes in p, h here, p, h before.

    Order 2 extrapolates rho h from the node before, order 1 does not. With `fading` above 0 what
    is extrapolated is limited where the change is large, and fades where the logarithm of the
    viscosity passes that: there the flow hardly depends on pressure, rho h is constant along x
    and order 1 exact.

    """
    k = max(i - 1, 0)
    here, before = film[0, i, j] * film[2, i, j], film[0, k, j] * film[2, k, j]
    drop, in_here, in_before = before - here, -1.0, 1.0
    share, by_stiffness = 0.5 * (order - 1.0), 0.0
    if fading > 0.0:
        drop, in_here, in_before = limited_change(here, before)
        stiff = film[3, i, j] / fading
        kept = 1.0 / (1.0 + stiff**4)
        by_stiffness = 4.0 * share * kept * kept * stiff**3 / fading * film[4, i, j]
        share *= kept
    by_here, by_before = 1.0 - share * in_here, -share * in_before
    return (
        here - share * drop,
        by_here * film[1, i, j] * film[2, i, j] + by_stiffness * drop,
        by_here * film[0, i, j] * film[6, i, j],
        by_before * film[1, k, j] * film[2, k, j],
        by_before * film[0, k, j] * film[6, k, j],
    )


@njit(cache=True, error_model='numpy', inline='always')
def _push(
    film: Array,
    i: int,
    j: int,
    k: int,
    n: int,
    climbs: bool,
    series: bool,
    weight: float,
    rise: float,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> float:
    """Let the flow that the `rise` of the pressure drives enter (i, j), leave the next (k, n)."""
    ahead, back = (2, 1) if k > i else (4, 3)
    flow, in_p, in_p1, in_h, in_h1 = face_flow(film, i, j, k, n, climbs, series)
    pull, flow = weight * rise, weight * flow
    residual[i, j] -= flow * rise
    by_pressure[0, i, j] += flow - in_p * pull
    by_pressure[ahead, i, j] -= flow + in_p1 * pull
    by_gap[0, i, j] -= in_h * pull
    by_gap[ahead, i, j] -= in_h1 * pull
    residual[k, n] += flow * rise
    by_pressure[0, k, n] += flow + in_p1 * pull
    by_pressure[back, k, n] -= flow - in_p * pull
    by_gap[0, k, n] += in_h1 * pull
    by_gap[back, k, n] += in_h * pull
    return flow


@njit(cache=True, error_model='numpy')
def flow_rows(
    pressure: Array,
    film: Array,
    mobility: float,
    aspect: float,
    limited: bool,
    inlet: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> None:
    """
    Add -div(flow grad p) dx and its planes dF/dp, dF/dh, face by face, in Hertz units [-].

    `mobility` multiplies all flow factors, `aspect` is (dx/dy)^2; `limited` flow factors as in
    `face_flow`. Just outside the first row the pressure is `inlet` times that inside it.

    """
    nx, ny = pressure.shape
    for i in range(nx - 1):
        for j in range(1, ny - 1):
            before = pressure[i, j] if i > 0 else inlet[j] * pressure[1, j]
            rise = pressure[i + 1, j] - before
            flow = _push(
                film,
                i,
                j,
                i + 1,
                j,
                rise > 0.0,
                limited,
                mobility,
                rise,
                residual,
                by_pressure,
                by_gap,
            )
            if i == 0:
                by_pressure[0, 1, j] -= flow * inlet[j]
        if i > 0:
            for j in range(ny - 1):
                rise = pressure[i, j + 1] - pressure[i, j]
                _push(
                    film,
                    i,
                    j,
                    i,
                    j + 1,
                    limited,
                    limited,
                    mobility * aspect,
                    rise,
                    residual,
                    by_pressure,
                    by_gap,
                )


@njit(cache=True, error_model='numpy')
def clear_border(residual: Array, by_pressure: Array, by_gap: Array) -> None:
    """Take the border rows out of the residual and its planes [-]."""
    nx, ny = residual.shape
    for j in (0, ny - 1):
        residual[:, j] = 0.0
        by_pressure[:, :, j] = 0.0
        by_gap[:, :, j] = 0.0
    for i in (0, nx - 1):
        residual[i] = 0.0
        by_pressure[:, i] = 0.0
        by_gap[:, i] = 0.0


@njit(cache=True, error_model='numpy')
def reynolds_rows(
    pressure: Array,
    film: Array,
    mobility: float,
    aspect: float,
    order: float,
    fading: float,
    inlet: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> None:
    """
    Assemble F = -div(flow grad p) dx + d(rho h)/dx dx and its planes dF/dp, dF/dh [-].

    `order` and `fading` as in `carried_mass`, flow factors are limited with it; the rest as in
    `flow_rows`. Border rows get zero planes.

    """
    nx, ny = pressure.shape
    residual[:] = 0.0
    by_pressure[:] = 0.0
    by_gap[:] = 0.0
    for i in range(nx - 1):
        for j in range(1, ny - 1):
            # The mass that node (i, j) carries downstream leaves it and enters the next.
            here = order if i > 1 else 1.0
            mass, in_p, in_h, in_p1, in_h1 = carried_mass(film, i, j, here, fading)
            k = i + 1
            residual[i, j] += mass
            by_pressure[0, i, j] += in_p
            by_pressure[1, i, j] += in_p1
            by_gap[0, i, j] += in_h
            by_gap[1, i, j] += in_h1
            residual[k, j] -= mass
            by_pressure[1, k, j] -= in_p
            by_pressure[5, k, j] -= in_p1
            by_gap[1, k, j] -= in_h
            by_gap[5, k, j] -= in_h1
    flow_rows(pressure, film, mobility, aspect, fading > 0.0, inlet, residual, by_pressure, by_gap)
    clear_border(residual, by_pressure, by_gap)


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
    sizes: Array,
) -> float:
    """
    Replace the rows of the cavitated set by dp = -p and scale all rows.

    Returns the sum of |F|/h over the other rows [-], each weighted by the share of its size that
    the film has: where flow outweighs it, an imbalance moves the pressure by next to nothing, and
    the film by less. At least `LEAST_REACTION`, and 1 on contact nodes. Cavitated where p times
    the size of the row is below F, everywhere when dry. That size counts the film, too: the flow
    factor of a stiff fluid vanishes inside the contact. `sizes` keeps it, zero on the border and
    where cavitated.

    """
    nx, ny = pressure.shape
    total = 0.0
    cavitated[:] = False
    sizes[:] = 0.0
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            f = residual[i, j]
            lift = abs(by_gap[0, i, j]) * stiffness
            scale = max(abs(by_pressure[0, i, j]) + lift, 1e-300)
            if dry or pressure[i, j] * scale < f:
                cavitated[i, j] = True
                by_pressure[:, i, j] = 0.0
                by_gap[:, i, j] = 0.0
                by_pressure[0, i, j] = 1.0
                residual[i, j] = pressure[i, j]
                continue
            sizes[i, j] = scale
            reacts = max(lift / scale, LEAST_REACTION) if lift > 0.0 else 1.0
            total += reacts * abs(f) / film[i, j] * weights[j]
            factor = 1.0 / scale
            for plane in range(6):
                by_pressure[plane, i, j] *= factor
                by_gap[plane, i, j] *= factor
            residual[i, j] = f * factor
    return total
