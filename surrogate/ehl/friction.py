# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction over a solved contact: Eyring where the film carries, boundary where it is punctured.

The traction on a surface opposes its slip against the other. It is mu_a p on punctured nodes and
tau0 asinh(eta(p) |slip| / (tau0 h)) elsewhere in the pressurised area.

"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.ehl import ContactLubricant, ContactSolution, punctured_nodes
from surrogate.files import InputError
from surrogate.formulas.lubricant import shear_stress_eyring_1936, viscosity_roelands_1966

Array = NDArray[np.float64]


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


def contact_friction(
    solution: ContactSolution,
    *,
    slip_x: ArrayLike,
    slip_y: ArrayLike = 0.0,
    asperity_friction: float = 0.1,
    film: Literal['local', 'central'] = 'local',
    slip_floor: float = 0.0,
) -> ContactFriction:
    """
    Integrate the friction of a contact with a slip field.

    Slip [m/s] of the surface along x and y, numbers or arrays on the grid; boundary coefficient
    [-]; `film` shears the local or the central film; |slip| is sqrt(slip^2 + `slip_floor`^2) [m/s]
    where a direction is needed. Raises InputError for slip that does not fit the grid.

    """
    vx, vy = _on_grid(solution, slip_x, 'slip_x'), _on_grid(solution, slip_y, 'slip_y')
    _check_options(asperity_friction, film, slip_floor)
    speed = np.sqrt(vx**2 + vy**2 + slip_floor**2)
    dry = punctured_nodes(solution)
    boundary = np.where(dry, asperity_friction * solution.pressure, 0.0)
    sheared = np.where(dry, 0.0, _film_traction(solution, speed, film))
    traction = boundary + sheared
    per_speed = np.divide(traction, speed, out=np.zeros_like(traction), where=speed > 0)
    tx, ty = -per_speed * vx, -per_speed * vy
    area = (solution.x[1] - solution.x[0]) * (solution.y[1] - solution.y[0])
    normal = solution.condition.load / area
    return ContactFriction(
        force_x=float(tx.sum() * area),
        force_y=float(ty.sum() * area),
        spin_moment=float((solution.x[:, None] * ty - solution.y[None, :] * tx).sum() * area),
        power=-float((tx * vx + ty * vy).sum() * area),
        coefficient=float(traction.sum() / normal),
        film_coefficient=float(sheared.sum() / normal),
        asperity_coefficient=float(boundary.sum() / normal),
        traction=traction,
    )


def slide_roll_friction(
    solution: ContactSolution,
    slide_roll_ratio: float,
    *,
    asperity_friction: float = 0.1,
    film: Literal['local', 'central'] = 'local',
) -> ContactFriction:
    """
    Integrate the friction under uniform sliding along x.

    `slide_roll_ratio` is (u1 - u2) over the entrainment speed (u1 + u2)/2 [-]; the result holds
    for surface 1.

    """
    slip = slide_roll_ratio * solution.condition.entrainment_speed
    return contact_friction(solution, slip_x=slip, asperity_friction=asperity_friction, film=film)


def _film_traction(solution: ContactSolution, speed: Array, film: str) -> Array:
    """Return Eyring's stress where the film carries pressure."""
    pressure = solution.film_pressure
    thickness = solution.film if film == 'local' else np.full_like(pressure, solution.central_film)
    wet = pressure > 0
    rate = np.divide(speed, thickness, out=np.zeros_like(speed), where=wet & (thickness > 0))
    viscosity = viscosity_of(solution.lubricant, pressure)
    return shear_stress_eyring_1936(viscosity, rate, solution.lubricant.eyring_stress)


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


def _check_options(asperity_friction: float, film: str, slip_floor: float) -> None:
    if not 0 <= asperity_friction <= 1:
        raise InputError(f'asperity_friction is {asperity_friction!r}, allowed is 0 to 1')
    if film not in ('local', 'central'):
        raise InputError(f'film is {film!r}, allowed is local or central')
    if not 0 <= slip_floor < np.inf:
        raise InputError(f'slip_floor is {slip_floor!r} m/s, allowed is 0 or more')
