# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Viscosity grades, and the line of ASTM D341 that carries a viscosity over temperatures.

Plain arithmetic on floats: the online half uses it too.

"""

import math

from surrogate.units import ZERO_CELSIUS

ISO_VG = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460)
"""Grades of ISO 3448: kinematic viscosity at 40 degC [mm2/s]."""
WARM, HOT = 40 + ZERO_CELSIUS, 100 + ZERO_CELSIUS
"""Temperatures at which a data sheet states the kinematic viscosity [K]."""
OFFSET = 0.7
"""Constant of ASTM D341 that is added to a viscosity [mm2/s]."""


def double_log(viscosity: float) -> float:
    """Return log log (nu + 0.7) of a kinematic viscosity [m2/s], with nu in mm2/s: ASTM D341."""
    return math.log10(math.log10(viscosity * 1e6 + OFFSET))


def slope_astm_d341(at_40: float, at_100: float) -> float:
    """Return B of log log (nu + 0.7) = A - B log T [-] by kinematic viscosities [m2/s]."""
    return (double_log(at_40) - double_log(at_100)) / (math.log10(HOT) - math.log10(WARM))


def temperature_astm_d341(viscosity: float, at_40: float, at_100: float) -> float:
    """Return the temperature [K] at which an oil has a kinematic viscosity, all in [m2/s]."""
    drop = double_log(at_40) - double_log(viscosity)
    return float(10.0 ** (math.log10(WARM) + drop / slope_astm_d341(at_40, at_100)))


def equivalent_temperature(temperature: float, grade: float, at_40: float, at_100: float) -> float:
    """
    Return the temperature [K] at which an oil is as viscous as another `grade` at `temperature`.

    The other oil has `grade` [m2/s] at 40 degC and the same slope B, so T' = T times a constant:
    log T' = log T + (log log (nu_40 + 0.7) - log log (grade + 0.7)) / B. Viscosities of this oil
    at 40 and 100 degC [m2/s].

    """
    return temperature * temperature_astm_d341(grade, at_40, at_100) / WARM
