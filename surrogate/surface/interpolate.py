# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of one point, in the subset of Python that also compiles; see `compiled`.

Every sum is written out, so that an interpreted and a compiled lookup agree to the last bit.

"""

import dataclasses
import math
from typing import Any

from surrogate.formulas.torque import driving_torque, efficiency, efficiency_slope, is_back_driving
from surrogate.surface.correction import TRUST_RADIUS
from surrogate.surface.hermite import hermite_weights, patch_weights, Weights
from surrogate.surface.tables import ERRORS, ONSETS, PULL, ROUNDING, SPREADS, SurfaceTables, WIDTH

NAN = math.nan
VALID = 1
SPEED_BELOW, SPEED_ABOVE, LOAD_OUTSIDE, HEAT_OUTSIDE, MASKED = 2, 3, 4, 5, 6
LARGEST_EXPONENT = 709.0
"""An exponential beyond it is taken as infinite [-]."""
# Places of the fields in a row of the table, in the order of FIELDS.
TORQUE, RCS, SHARE, RATIO, CENTRAL, MINIMUM, COEFFICIENT, PRESSURE = range(8)
Face = tuple[float, ...]


@dataclasses.dataclass(slots=True)
class Found:
    """
    What a surface says of one point, and where the point lies in it.

    Numbers are NaN, cells and the worst contact -1 unless `validity` is VALID. friction_torque,
    its error, standard deviation and standard error, and driving_torque [N m]; film_ratio, rcs,
    efficiency, asperity_share, friction_coefficient and fractions of cells [-]; central_film,
    minimum_film [m]; max_pressure [Pa]. `corrected`: a full solve near the point has pulled it.

    """

    validity: int = 0
    speed_cell: int = -1
    load_cell: int = -1
    heat_cell: int = -1
    speed_fraction: float = NAN
    load_fraction: float = NAN
    heat_fraction: float = NAN
    friction_torque: float = NAN
    rcs: float = NAN
    film_ratio: float = NAN
    efficiency: float = NAN
    driving_torque: float = NAN
    corrected: bool = False
    asperity_share: float = NAN
    central_film: float = NAN
    minimum_film: float = NAN
    friction_coefficient: float = NAN
    max_pressure: float = NAN
    worst_contact: int = -1
    friction_torque_error: float = NAN
    friction_torque_std: float = NAN
    friction_torque_stderr: float = NAN
    rcs_error: float = NAN
    rcs_std: float = NAN
    rcs_stderr: float = NAN
    efficiency_error: float = NAN
    efficiency_std: float = NAN
    efficiency_stderr: float = NAN
    back_driving: bool = False

    @property
    def worst_nut(self) -> int:
        """Nut of the worst contact: 1 pressed by the load, 2 relieved, 0 unknown."""
        return self.worst_contact // 2 + 1

    @property
    def worst_side(self) -> int:
        """Side of the worst contact: 1 screw, 2 nut, 0 unknown."""
        return self.worst_contact % 2 + 1 if self.worst_contact >= 0 else 0


def look_up(
    tables: SurfaceTables, speed: float, load: float, temperature: float, point: Found
) -> int:
    """
    Locate a point and look up the numbers that are judged; return the validity.

    Speed |w| [rad/s], opposing load [N], temperature [K]. Fills validity, cells, fractions,
    friction torque, RCS, film ratio, efficiency, driving torque, worst contact and `corrected`.

    """
    if not tables.temperature_low <= temperature <= tables.temperature_high:
        return leave(point, HEAT_OUTSIDE)
    if not tables.load_low <= load <= tables.load_high:
        return leave(point, LOAD_OUTSIDE)
    if not tables.speed_low <= speed <= tables.speed_high:
        return leave(point, SPEED_ABOVE if speed > tables.speed_high else SPEED_BELOW)
    speeds, loads, heats = tables.speed_nodes, tables.load_nodes, tables.heat_nodes
    j, k = cell_below(loads, load), cell_below(heats, temperature)
    v, w = fraction_of(loads, j, load), fraction_of(heats, k, temperature)
    face = face_weights(loads, j, v, heats, k, w)
    row, across = tables.load_rows[j], len(heats)
    s = math.log(speed) - onset_on_face(tables.onset, row * across + k, across, face)
    # The mapping rounds, so an end may be passed by a rounding.
    inside = min(max(s, speeds[0]), speeds[-1])
    if not abs(inside - s) < ROUNDING:
        return leave(point, SPEED_BELOW if s < speeds[0] else SPEED_ABOVE)
    i = cell_below(speeds, inside)
    u = fraction_of(speeds, i, inside)
    cell = (i * (len(loads) - 1) + j) * (across - 1) + k
    if not tables.open_cells[cell]:
        return leave(point, MASKED)
    point.validity = VALID
    point.speed_cell, point.load_cell, point.heat_cell = i, j, k
    point.speed_fraction, point.load_fraction, point.heat_fraction = u, v, w
    fast, values, along = hermite_weights(width_of(speeds, i), u), tables.values, tables.rows
    at = (i * along + row) * across + k
    torque = field(values, TORQUE, at, across, along, fast, face)
    rcs = field(values, RCS, at, across, along, fast, face)
    ratio = field(values, RATIO, at, across, along, fast, face)
    pull, weight = tables.pull_of_cell[cell], 0.0
    if pull >= 0:
        weight = pull_weight(tables.pulls, pull, point)
        torque = pulled(tables.pulls, pull, weight, TORQUE, torque)
        rcs = pulled(tables.pulls, pull, weight, RCS, rcs)
        ratio = pulled(tables.pulls, pull, weight, RATIO, ratio)
    point.friction_torque, point.rcs, point.film_ratio = torque, share(rcs), exponential(ratio)
    point.corrected = weight != 0.0
    node = ((i + (u > 0.5)) * len(loads) + j + (v > 0.5)) * across + k + (w > 0.5)
    point.worst_contact = tables.worst_contacts[node]
    fill_torques(point, load, tables.lead)
    return VALID


def leave(point: Found, validity: int) -> int:
    """Say why what is judged is not known; return that."""
    point.validity = validity
    point.speed_cell = point.load_cell = point.heat_cell = -1
    point.speed_fraction = point.load_fraction = point.heat_fraction = NAN
    point.friction_torque = point.rcs = point.film_ratio = NAN
    point.efficiency = point.driving_torque = NAN
    point.corrected, point.worst_contact = False, -1
    return validity


def fill_torques(point: Found, load: float, lead: float) -> None:
    """Fill in what follows from the friction torque at an opposing load [N]; lead [m]."""
    point.efficiency = efficiency(point.friction_torque, load, lead)
    point.driving_torque = driving_torque(point.friction_torque, load, lead)


def look_up_rest(tables: SurfaceTables, load: float, point: Found) -> None:
    """Fill in all that `look_up` left, at the place that it found; opposing load [N]."""
    if point.validity != VALID:
        leave_rest(point)
        return
    i, j, k = point.speed_cell, point.load_cell, point.heat_cell
    u, v, w = point.speed_fraction, point.load_fraction, point.heat_fraction
    loads, across, along = tables.load_nodes, len(tables.heat_nodes), tables.rows
    fast = hermite_weights(width_of(tables.speed_nodes, i), u)
    face = face_weights(loads, j, v, tables.heat_nodes, k, w)
    at, values = (i * along + tables.load_rows[j]) * across + k, tables.values
    shared = field(values, SHARE, at, across, along, fast, face)
    central = field(values, CENTRAL, at, across, along, fast, face)
    minimum = field(values, MINIMUM, at, across, along, fast, face)
    coefficient = field(values, COEFFICIENT, at, across, along, fast, face)
    pressure = field(values, PRESSURE, at, across, along, fast, face)
    cell = (i * (len(loads) - 1) + j) * (across - 1) + k
    pull = tables.pull_of_cell[cell]
    if pull >= 0:
        weight = pull_weight(tables.pulls, pull, point)
        shared = pulled(tables.pulls, pull, weight, SHARE, shared)
        central = pulled(tables.pulls, pull, weight, CENTRAL, central)
        minimum = pulled(tables.pulls, pull, weight, MINIMUM, minimum)
        coefficient = pulled(tables.pulls, pull, weight, COEFFICIENT, coefficient)
        pressure = pulled(tables.pulls, pull, weight, PRESSURE, pressure)
    point.asperity_share = share(shared)
    point.central_film, point.minimum_film = exponential(central), exponential(minimum)
    point.friction_coefficient, point.max_pressure = coefficient, pressure
    point.friction_torque_error = tables.errors[ERRORS * cell]
    point.rcs_error = tables.errors[ERRORS * cell + 1]
    slope = efficiency_slope(point.friction_torque, load, tables.lead)
    point.efficiency_error = point.friction_torque_error * slope
    point.back_driving = is_back_driving(point.friction_torque, load, tables.lead)
    if not tables.has_spreads:
        leave_spreads(point)
        return
    corners = corner_weights(u, v, w)
    node = SPREADS * ((i * len(loads) + j) * across + k)
    across, along = SPREADS * across, SPREADS * len(loads) * across
    spreads = tables.spreads
    point.friction_torque_std = spread(spreads, node, across, along, corners)
    point.friction_torque_stderr = spread(spreads, node + 1, across, along, corners)
    point.rcs_std = spread(spreads, node + 2, across, along, corners)
    point.rcs_stderr = spread(spreads, node + 3, across, along, corners)
    point.efficiency_std = point.friction_torque_std * slope
    point.efficiency_stderr = point.friction_torque_stderr * slope


def leave_rest(point: Found) -> None:
    """Say that all that `look_up` leaves is not known."""
    point.asperity_share = point.central_film = point.minimum_film = NAN
    point.friction_coefficient = point.max_pressure = NAN
    point.friction_torque_error = point.rcs_error = point.efficiency_error = NAN
    leave_spreads(point)
    point.back_driving = False


def leave_spreads(point: Found) -> None:
    """Say that what strips of the raceway differ by is not known."""
    point.friction_torque_std = point.rcs_std = point.efficiency_std = NAN
    point.friction_torque_stderr = point.rcs_stderr = point.efficiency_stderr = NAN


def cell_below(nodes: Any, value: float) -> int:
    """Return the cell of a value between the ends; a node belongs to the cell above it."""
    low, high = 0, len(nodes) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if nodes[middle] <= value:
            low = middle
        else:
            high = middle
    return low


def fraction_of(nodes: Any, cell: int, value: float) -> float:
    """Return at which fraction of a cell a value lies [-]."""
    return (value - nodes[cell]) / (nodes[cell + 1] - nodes[cell])  # type: ignore[no-any-return]


def width_of(nodes: Any, cell: int) -> float:
    """Return the width of a cell."""
    return nodes[cell + 1] - nodes[cell]  # type: ignore[no-any-return]


def face_weights(loads: Any, j: int, v: float, heats: Any, k: int, w: float) -> Face:
    """Return the weights of a cell's face at fractions of its load and temperature [-]."""
    return patch_weights(
        hermite_weights(width_of(loads, j), v), hermite_weights(width_of(heats, k), w)
    )


def onset_on_face(onset: Any, node: int, across: int, face: Face) -> float:
    """Return the logarithm of the onset speed [rad/s] on the face above a node."""
    c0, dl0, dt0, c1, dl1, dt1, c2, dl2, dt2, c3, dl3, dt3 = face
    i = ONSETS * node
    j = i + ONSETS * across
    return (  # type: ignore[no-any-return]
        c0 * onset[i]
        + dl0 * onset[i + 1]
        + dt0 * onset[i + 2]
        + c1 * onset[i + 3]
        + dl1 * onset[i + 4]
        + dt1 * onset[i + 5]
        + c2 * onset[j]
        + dl2 * onset[j + 1]
        + dt2 * onset[j + 2]
        + c3 * onset[j + 3]
        + dl3 * onset[j + 4]
        + dt3 * onset[j + 5]
    )


def field(
    values: Any, name: int, node: int, across: int, along: int, fast: Weights, face: Face
) -> float:
    """
    Return a field, transformed, in the cell above a node.

    `across` nodes lie between neighbours along the load, `along` as often between those along
    the speed.

    """
    a, da, b, db = fast
    across *= WIDTH
    low = WIDTH * node + name
    value, slope = on_face(values, low, across, face)
    other, other_slope = on_face(values, low + along * across, across, face)
    return a * value + da * slope + b * other + db * other_slope


def on_face(values: Any, i: int, across: int, face: Face) -> tuple[float, float]:
    """
    Interpolate one field on a face, out of its values and slopes at four corners.

    Return it and its slope along the speed, whose own slopes count as zero.

    """
    c0, dl0, dt0, c1, dl1, dt1, c2, dl2, dt2, c3, dl3, dt3 = face
    j = i + across
    return (
        c0 * values[i]
        + dl0 * values[i + 16]
        + dt0 * values[i + 24]
        + c1 * values[i + 32]
        + dl1 * values[i + 48]
        + dt1 * values[i + 56]
        + c2 * values[j]
        + dl2 * values[j + 16]
        + dt2 * values[j + 24]
        + c3 * values[j + 32]
        + dl3 * values[j + 48]
        + dt3 * values[j + 56],
        c0 * values[i + 8] + c1 * values[i + 40] + c2 * values[j + 8] + c3 * values[j + 40],
    )


def share(value: float) -> float:
    """Return a value between 0 and 1: a patch may pass its corners by a hair; NaN stays NaN."""
    return 0.0 if value < 0.0 else 1.0 if value > 1.0 else value


def exponential(value: float) -> float:
    """Return the exponential, which never overflows."""
    return math.inf if value > LARGEST_EXPONENT else math.exp(value)


def pull_weight(pulls: Any, pull: int, point: Found) -> float:
    """Return the weight of a correction at a place of its cell [-]."""
    at = PULL * pull
    return (
        bump(point.speed_fraction, pulls[at])
        * bump(point.load_fraction, pulls[at + 1])
        * bump(point.heat_fraction, pulls[at + 2])
    )


def pulled(pulls: Any, pull: int, weight: float, name: int, value: float) -> float:
    """Return a transformed value with a correction at its weight."""
    if weight == 0.0:
        return value
    at = PULL * pull + 3 + name
    return value + weight * (pulls[at] * value + pulls[at + 8])  # type: ignore[no-any-return]


def bump(fraction: float, centre: float) -> float:
    """
    Return the bump along one axis [-]: a smoothstep up to the centre and one down from it.

    3 t^2 - 2 t^3, t being the distance from the edge of the trust region over its reach.

    """
    if fraction == centre:
        return 1.0
    reach = min(TRUST_RADIUS, centre if fraction < centre else 1.0 - centre)
    t = max(1.0 - abs(fraction - centre) / reach, 0.0)
    return t * t * (3.0 - 2.0 * t)


def corner_weights(u: float, v: float, w: float) -> tuple[float, ...]:
    """Return the weights of the eight corners of a cell, the last fraction running fastest."""
    p, q, r = 1.0 - u, 1.0 - v, 1.0 - w
    return (p * q * r, p * q * w, p * v * r, p * v * w, u * q * r, u * q * w, u * v * r, u * v * w)


def spread(spreads: Any, i: int, across: int, along: int, corners: tuple[float, ...]) -> float:
    """Return what strips differ by, linear between the nodes: never below zero."""
    c0, c1, c2, c3, c4, c5, c6, c7 = corners
    j, k, m = i + across, i + along, i + along + across
    return (
        part(c0, spreads[i])
        + part(c1, spreads[i + SPREADS])
        + part(c2, spreads[j])
        + part(c3, spreads[j + SPREADS])
        + part(c4, spreads[k])
        + part(c5, spreads[k + SPREADS])
        + part(c6, spreads[m])
        + part(c7, spreads[m + SPREADS])
    )


def part(weight: float, value: float) -> float:
    """Return the part of a node, which is nothing at no weight, known or not."""
    return weight * value if weight > 0.0 else 0.0
