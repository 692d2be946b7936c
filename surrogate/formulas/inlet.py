# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Inlet of a contact: a film that is not fully flooded, and oil that shear heats and so thins.

The contact is taken at the slower entrainment whose flooded isothermal film is that of the inlet
as it is. Both tiers slow down by the same functions.

"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.film import film_factor_gupta_1992
from surrogate.formulas.geometry import hertz, screw_contact, Side
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]
Speed = TypeVar('Speed', float, NDArray[np.float64])
SPEED_EXPONENT = 0.67
"""Exponent of speed in the central film of Hamrock and Dowson [-]."""
STEP = 0.5
"""Half of the temperature step of the slope of viscosity [K]."""
ROUNDS = 30
"""Rounds of the search for the speed of a heated inlet: each shrinks the error to a fifth."""


def starved_speed(lubricant: Lubricant, speed: Speed) -> Speed:
    """
    Return the speed whose flooded central film is `film_factor` of that at `speed`.

    Entrainment [m/s] or rotation [rad/s]: the one is proportional to the other.

    """
    slower: float = lubricant.film_factor ** (1 / SPEED_EXPONENT)
    return speed * slower


def heating_factor(
    screw: Screw,
    lubricant: Lubricant,
    side: Side,
    load: ArrayLike,
    speed: ArrayLike,
    temperature: ArrayLike,
) -> Array:
    """
    Return central film with over without heating [-].

    Normal forces [N], entrainment speeds [m/s] that a starved inlet has slowed, temperatures [K];
    slide-roll ratio of the ball without gross slip.

    """
    return _factor_of(screw, lubricant, side, load, temperature)(np.asarray(speed))


def inlet_speed(
    screw: Screw,
    lubricant: Lubricant,
    side: Side,
    load: ArrayLike,
    speed: ArrayLike,
    temperature: ArrayLike,
    *,
    heated: bool = True,
) -> Array:
    """
    Return the entrainment [m/s] whose flooded isothermal film is that of the inlet.

    Normal forces [N], entrainment speeds [m/s], temperatures [K]; isothermal unless `heated`.

    """
    slow = starved_speed(lubricant, np.asarray(speed, dtype=float))
    if not heated:
        return slow
    factor = heating_factor(screw, lubricant, side, load, slow, temperature)
    return np.asarray(slow * factor ** (1 / SPEED_EXPONENT))


def speed_before_inlet(
    screw: Screw, lubricant: Lubricant, side: Side, load: float, inlet: float, temperature: float
) -> float:
    """Return the slowest entrainment [m/s] whose `inlet_speed` is a given one [m/s]."""
    factor, speed = _factor_of(screw, lubricant, side, load, temperature), inlet
    for _ in range(ROUNDS):
        speed = inlet / float(factor(np.asarray(speed))) ** (1 / SPEED_EXPONENT)
    return speed / float(starved_speed(lubricant, 1.0))


def viscosity_slope(lubricant: Lubricant, temperature: ArrayLike) -> Array:
    """Return the relative loss of viscosity with temperature [1/K]."""
    kelvin = np.asarray(temperature, dtype=float)
    low, high = (lubricant_state(lubricant, kelvin + step).viscosity for step in (-STEP, STEP))
    return np.asarray(np.log(low / high) / (2 * STEP))


def _factor_of(
    screw: Screw, lubricant: Lubricant, side: Side, load: ArrayLike, temperature: ArrayLike
) -> Callable[[Array], Array]:
    """Return the film factor [-] as a function of the entrainment [m/s]."""
    contact, rates = screw_contact(screw, side), no_slip_rates(screw)
    pressure = hertz(contact, load).max_pressure / contact.reduced_modulus
    steepness = lubricant_state(lubricant, temperature).viscosity * viscosity_slope(
        lubricant, temperature
    )
    return lambda speed: film_factor_gupta_1992(
        pressure=pressure,
        loading=steepness * speed**2 / lubricant.thermal_conductivity,
        slide_roll=rates.helical_slip / rates.entrainment,
    )
