# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lubricant laws, one function per published law, and the state of an oil at a temperature."""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.grades import double_log, OFFSET, slope_astm_d341, WARM
from surrogate.parameters import Lubricant

Array = NDArray[np.float64]

ROELANDS_PRESSURE = 1.96e8
"""Reference pressure of the Roelands law [Pa]."""
ROELANDS_OFFSET = 9.67
"""ln of the Roelands reference viscosity 6.31e-5 Pa s, with the opposite sign [-]."""
GOLD_EXPONENT_MINERAL = 0.139
"""Exponent of the pressure-viscosity coefficient of mineral oils in viscosity [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LubricantState:
    """
    Oil at ambient pressure and one or many temperatures.

    Viscosity [Pa s], pressure-viscosity coefficient [1/Pa], density [kg/m3], Eyring stress [Pa],
    largest shear stress over the pressure [-], None without a limit.

    """

    viscosity: Array
    pressure_viscosity: Array
    density: Array
    eyring_stress: float
    limiting_shear_share: float | None = None


def kinematic_viscosity_astm_d341(temperature: ArrayLike, at_40: float, at_100: float) -> Array:
    """
    Kinematic viscosity [m2/s] at `temperature` [K] through two known values [m2/s].

    log log (nu + 0.7) = A - B log T with nu in mm2/s: ASTM D341, valid from 2 to 2e7 mm2/s.

    """
    cooler = np.log10(temperature) - math.log10(WARM)
    exponent = double_log(at_40) - slope_astm_d341(at_40, at_100) * cooler
    return np.asarray((10.0 ** (10.0**exponent) - OFFSET) * 1e-6)


def pressure_viscosity_gold_2001(reference: float, viscosity_ratio: ArrayLike) -> Array:
    """
    Pressure-viscosity coefficient [1/Pa] from its `reference` [1/Pa] and nu / nu_reference [-].

    alpha = alpha_ref (nu / nu_ref)^0.139 for mineral oils: Gold et al., Lubrication Science 13
    (2001).

    """
    return np.asarray(reference * np.asarray(viscosity_ratio) ** GOLD_EXPONENT_MINERAL)


def lubricant_state(lubricant: Lubricant, temperature: ArrayLike) -> LubricantState:
    """
    Return the oil at `temperature` [K], any shape, anchored at its reference temperature.

    eta = eta_ref nu rho / (nu_ref rho_ref); density falls linearly.

    """

    def kinematic(kelvin: ArrayLike) -> Array:
        return kinematic_viscosity_astm_d341(
            kelvin, lubricant.kinematic_viscosity_40, lubricant.kinematic_viscosity_100
        )

    temperature = np.asarray(temperature, dtype=float)
    warming = temperature - lubricant.reference_temperature
    density = lubricant.density - lubricant.density_slope * warming
    ratio = kinematic(temperature) / kinematic(lubricant.reference_temperature)
    return LubricantState(
        viscosity=lubricant.viscosity * ratio * density / lubricant.density,
        pressure_viscosity=pressure_viscosity_gold_2001(lubricant.pressure_viscosity, ratio),
        density=density,
        eyring_stress=lubricant.eyring_stress,
        limiting_shear_share=lubricant.limiting_shear_share,
    )


def viscosity_roelands_1966(
    pressure: ArrayLike, viscosity: ArrayLike, pressure_viscosity: ArrayLike
) -> Array:
    """
    Viscosity [Pa s] under `pressure` [Pa], ambient `viscosity` [Pa s], coefficient [1/Pa].

    eta = eta0 exp{(ln eta0 + 9.67) [(1 + p/p0)^z - 1]}, z = alpha p0 / (ln eta0 + 9.67): Roelands,
    thesis, Delft (1966).

    """
    span = np.log(viscosity) + ROELANDS_OFFSET
    exponent = np.asarray(pressure_viscosity) * ROELANDS_PRESSURE / span
    growth = (1.0 + np.asarray(pressure) / ROELANDS_PRESSURE) ** exponent - 1.0
    return np.asarray(viscosity * np.exp(span * growth))


def shear_stress_eyring_1936(
    viscosity: ArrayLike, shear_rate: ArrayLike, eyring_stress: float
) -> Array:
    """
    Shear stress [Pa] at `viscosity` [Pa s] and `shear_rate` [1/s].

    tau = tau0 asinh(eta gamma / tau0): Eyring, J. Chem. Phys. 4 (1936) 283.

    """
    newtonian = np.asarray(viscosity) * np.asarray(shear_rate)
    return np.asarray(eyring_stress * np.arcsinh(newtonian / eyring_stress))


def limiting_shear_stress_bair_winer_1979(pressure: ArrayLike, share: float) -> Array:
    """
    Largest shear stress [Pa] that an oil bears under `pressure` [Pa].

    tau_L = Lambda p with the `share` Lambda [-]: Bair, Winer, J. Lubr. Technol. 101 (1979) 258.

    """
    return np.asarray(share * np.asarray(pressure))
