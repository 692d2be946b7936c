# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction over a solved contact: Eyring where the film carries, boundary where it is punctured.

The traction on a surface opposes its slip against the other. It is mu_a p on punctured nodes and
tau0 asinh(eta(p) |slip| / (tau0 h)) elsewhere in the pressurised area, up to the limit of the oil.

"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.ehl import ContactLubricant, ContactSolution, punctured_nodes
from surrogate.files import InputError
from surrogate.formulas.lubricant import (
    limiting_shear_stress_bair_winer_1979,
    viscosity_roelands_1966,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class NodeStrengths:
    """
    What makes the friction force of each node, boundary + min(eyring asinh(rate slip), limit).

    Places `x` along the entrainment, `y` across [m]; `boundary` [N], the friction force of
    punctured nodes, which slip does not change; `eyring` [N], Eyring stress times area of the
    nodes that shear, and `rate` [s/m], eta(p)/(tau0 h) there; `limit` [N], the largest force of
    the oil, infinite where it has none. All arrays of one shape.

    """

    x: Array
    y: Array
    boundary: Array
    eyring: Array
    rate: Array
    limit: Array

    def sheared(self, speed: Array | float) -> Array:
        """Return the friction force of the oil [N] at each node at a slip `speed` [m/s]."""
        return np.minimum(self.eyring * np.arcsinh(self.rate * speed), self.limit)

    def taken(self, nodes: slice | NDArray[np.bool_], weight: float = 1.0) -> 'NodeStrengths':
        """Return some of the nodes, each of which stands for `weight` of them [-]."""
        return NodeStrengths(
            x=self.x[nodes],
            y=self.y[nodes],
            boundary=weight * self.boundary[nodes],
            eyring=weight * self.eyring[nodes],
            rate=self.rate[nodes],
            limit=weight * self.limit[nodes],
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactFriction:
    """
    Friction on the surface whose slip against the other is given.

    Forces along x and y [N], moment about the normal through the centre, from x to y [N m], lost
    power [W]; mean traction against the slip over the load [-] and its parts from film and
    asperities [-]; traction magnitude on the grid [Pa].

    """

    force_x: float
    force_y: float
    spin_moment: float
    power: float
    coefficient: float
    film_coefficient: float
    asperity_coefficient: float
    traction: Array


def viscosity_of(lubricant: ContactLubricant, pressure: ArrayLike) -> Array:
    """Return the viscosity [Pa s] of a contact's oil under `pressure` [Pa]."""
    if lubricant.law == 'barus_incompressible':
        return np.asarray(
            lubricant.viscosity * np.exp(lubricant.pressure_viscosity * np.asarray(pressure))
        )
    return viscosity_roelands_1966(pressure, lubricant.viscosity, lubricant.pressure_viscosity)


def node_strengths(
    solution: ContactSolution,
    *,
    asperity_friction: float = 0.1,
    asperity_share: float | None = None,
) -> NodeStrengths:
    """
    Return the strengths of all nodes of a solved contact, arrays on the grid.

    Boundary coefficient [-] of punctured nodes; with an `asperity_share` [-], known from
    elsewhere, every node has that share of boundary friction and shears the rest of its oil.
    Raises InputError for options that make no sense.

    """
    if not 0 <= asperity_friction <= 1:
        raise InputError(f'asperity_friction is {asperity_friction!r}, allowed is 0 to 1')
    x, y = np.meshgrid(solution.x, solution.y, indexing='ij')
    area, stress = solution.node_area, solution.lubricant.eyring_stress
    dry = punctured_nodes(solution)
    wet = ~dry & (solution.film_pressure > 0) & (solution.film > 0)
    viscosity = viscosity_of(solution.lubricant, solution.film_pressure)
    touching = dry.astype(float) if asperity_share is None else np.full(x.shape, asperity_share)
    limit, share = np.full(x.shape, np.inf), solution.lubricant.limiting_shear_share
    if share is not None:
        largest = limiting_shear_stress_bair_winer_1979(solution.film_pressure, share)
        limit = (1 - touching) * area * largest
    return NodeStrengths(
        x=x,
        y=y,
        boundary=touching * asperity_friction * solution.pressure * area,
        eyring=np.where(wet, (1 - touching) * stress * area, 0.0),
        limit=limit,
        rate=np.divide(viscosity, stress * solution.film, out=np.zeros_like(x), where=wet),
    )


def contact_friction(
    solution: ContactSolution,
    *,
    slip_x: ArrayLike,
    slip_y: ArrayLike = 0.0,
    asperity_friction: float = 0.1,
    asperity_share: float | None = None,
    slip_floor: float = 0.0,
) -> ContactFriction:
    """
    Integrate the friction of a contact with a slip field.

    Slip [m/s] of the surface along x and y, numbers or arrays on the grid; boundary coefficient
    and share [-] as in `node_strengths`; |slip| is sqrt(slip^2 + `slip_floor`^2) [m/s] where a
    direction is needed. Raises InputError for slip that does not fit the grid.

    """
    vx, vy = _on_grid(solution, slip_x, 'slip_x'), _on_grid(solution, slip_y, 'slip_y')
    if not 0 <= slip_floor < np.inf:
        raise InputError(f'slip_floor is {slip_floor!r} m/s, allowed is 0 or more')
    nodes = node_strengths(
        solution, asperity_friction=asperity_friction, asperity_share=asperity_share
    )
    speed = np.sqrt(vx**2 + vy**2 + slip_floor**2)
    sheared = nodes.sheared(speed)
    friction = nodes.boundary + sheared
    per_speed = np.divide(friction, speed, out=np.zeros_like(friction), where=speed > 0)
    fx, fy = -per_speed * vx, -per_speed * vy
    normal = solution.condition.load
    return ContactFriction(
        force_x=float(fx.sum()),
        force_y=float(fy.sum()),
        spin_moment=float((nodes.x * fy - nodes.y * fx).sum()),
        power=-float((fx * vx + fy * vy).sum()),
        coefficient=float(friction.sum() / normal),
        film_coefficient=float(sheared.sum() / normal),
        asperity_coefficient=float(nodes.boundary.sum() / normal),
        traction=friction / solution.node_area,
    )


def slide_roll_friction(
    solution: ContactSolution, slide_roll_ratio: float, *, asperity_friction: float = 0.1
) -> ContactFriction:
    """
    Integrate the friction under uniform sliding along x.

    `slide_roll_ratio` is (u1 - u2) over the entrainment speed (u1 + u2)/2 [-]; the result holds
    for surface 1.

    """
    slip = slide_roll_ratio * solution.condition.entrainment_speed
    return contact_friction(solution, slip_x=slip, asperity_friction=asperity_friction)


def _on_grid(solution: ContactSolution, slip: ArrayLike, name: str) -> Array:
    values = np.asarray(slip, dtype=float)
    if values.shape not in ((), solution.film.shape):
        raise InputError(
            f'{name} has shape {values.shape}, allowed is a number or the grid '
            f'{solution.film.shape}'
        )
    if not np.isfinite(values).all():
        raise InputError(f'{name} holds a value that is not finite, allowed are finite m/s')
    return np.broadcast_to(values, solution.film.shape)
