# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Heating of the oil by shear in the inlet, which thins the film: an option, off by default.

A published factor on the isothermal central film. The contact is then solved at the slower
entrainment that yields this film.

"""

import math

from surrogate.files import InputError
from surrogate.formulas.film import film_factor_gupta_1992, LEAST_FACTOR
from surrogate.formulas.geometry import hertz, screw_contact, Side
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, Screw
from surrogate.units import ZERO_CELSIUS

SPEED_EXPONENT = 0.67
"""Exponent of speed in the central film of Hamrock and Dowson [-]."""
STEP = 0.5
"""Half of the temperature step of the slope of viscosity [K]."""


def heating_factor(
    screw: Screw, lubricant: Lubricant, side: Side, load: float, speed: float, temperature: float
) -> float:
    """
    Return central film with over without heating [-], NaN where the fit does not reach.

    Normal force [N], entrainment speed [m/s], temperature [K]; slide-roll ratio of the ball
    without gross slip.

    """
    contact, rates = screw_contact(screw, side), no_slip_rates(screw)
    return film_factor_gupta_1992(
        pressure=float(hertz(contact, load).max_pressure) / contact.reduced_modulus,
        loading=float(lubricant_state(lubricant, temperature).viscosity)
        * viscosity_slope(lubricant, temperature)
        * speed**2
        / lubricant.thermal_conductivity,
        slide_roll=rates.helical_slip / rates.entrainment,
    )


def heated_speed(
    screw: Screw, lubricant: Lubricant, side: Side, load: float, speed: float, temperature: float
) -> float:
    """
    Return the entrainment [m/s] whose isothermal film is that of the heated inlet.

    Raises InputError where the factor is not known.

    """
    factor = heating_factor(screw, lubricant, side, load, speed, temperature)
    if math.isnan(factor):
        raise InputError(
            f'inlet heating: entrainment is {speed:g} m/s at {temperature - ZERO_CELSIUS:g} degC, '
            'the fitted film factor is not known where it falls below '
            f'{LEAST_FACTOR:g}; leave --inlet-heating off'
        )
    return float(speed * factor ** (1 / SPEED_EXPONENT))


def viscosity_slope(lubricant: Lubricant, temperature: float) -> float:
    """Return the relative loss of viscosity with temperature [1/K]."""
    around = lubricant_state(lubricant, [temperature - STEP, temperature + STEP]).viscosity
    return math.log(around[0] / around[1]) / (2 * STEP)
