# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Viscosity index, by which a data sheet tells how an oil thins with heat."""

import math

from scipy.optimize import brentq
from surrogate.files import InputError
from surrogate.units import MICRO

LEAST, MOST = 2.0, 500.0
"""Kinematic viscosity at 100 degC for which an index is defined, and the largest tried [mm2/s]."""
FITS = (
    (3.8, (1.14673, 1.7576, -0.109), (0.84155, 1.5521, -0.077)),
    (4.4, (3.38095, -15.4952, 33.196), (0.78571, 1.7929, -0.183)),
    (5.0, (2.5000, -7.2143, 13.812), (0.82143, 1.5679, 0.119)),
    (6.4, (0.10100, 16.6350, -45.469), (0.04985, 9.1613, -18.557)),
    (7.0, (3.35714, -23.5643, 78.466), (0.22619, 7.7369, -16.656)),
    (7.7, (0.01191, 21.4750, -72.870), (0.79762, -0.7321, 14.610)),
    (9.0, (0.41858, 16.1558, -56.040), (0.05794, 10.5156, -28.240)),
    (12.0, (0.88779, 7.5527, -16.600), (0.26665, 6.7015, -10.810)),
    (15.0, (0.76720, 10.7972, -38.180), (0.20073, 8.4658, -22.490)),
    (18.0, (0.97305, 5.3135, -2.200), (0.28889, 5.9741, -4.930)),
    (22.0, (0.97256, 5.2500, -0.980), (0.24504, 7.4160, -16.730)),
    (28.0, (0.91413, 7.4759, -21.820), (0.20323, 9.1267, -34.230)),
    (40.0, (0.87031, 9.7157, -50.770), (0.18411, 10.1015, -46.750)),
    (55.0, (0.84703, 12.6752, -133.310), (0.17029, 11.4866, -80.620)),
    (70.0, (0.85921, 11.1009, -83.19), (0.17130, 11.3680, -76.940)),
    (math.inf, (0.83531, 14.6731, -216.246), (0.16841, 11.8493, -96.947)),
)
"""ASTM D2270-10, table X2.1: up to a viscosity at 100 degC [mm2/s], the coefficients of the
viscosities at 40 degC [mm2/s] of oils with the index 0 and 100 as squares in it."""


def viscosity_index_astm_d2270(at_40: float, at_100: float) -> float:
    """
    Return the viscosity index [-] of kinematic viscosities at 40 and 100 degC [m2/s].

    100 (L - U)/(L - H) up to 100, above it 100 + (10^N - 1)/0.00715 with N = log(H/U)/log Y: ASTM
    D2270, ISO 2909.

    """
    warm, hot = MICRO * at_40, MICRO * at_100
    low, high = next(both for top, *both in FITS if hot <= top)
    poor, good = (a * hot * hot + b * hot + c for a, b, c in (low, high))
    if warm >= good:
        return 100 * (poor - warm) / (poor - good)
    return 100 + (10 ** (math.log(good / warm) / math.log(hot)) - 1) / 0.00715


def viscosity_at_100_astm_d2270(at_40: float, index: float) -> float:
    """
    Return the kinematic viscosity at 100 degC [m2/s] from that at 40 degC [m2/s] and the index.

    Raises InputError where no oil above 2 mm2/s has it.

    """

    def excess(hot: float) -> float:
        return viscosity_index_astm_d2270(at_40, hot / MICRO) - index

    top = min(MOST, MICRO * at_40)
    if not excess(LEAST) <= 0 <= excess(top):
        raise InputError(
            f'oil: viscosity index is {index:g} at {MICRO * at_40:g} mm2/s (40 degC), allowed is '
            f'{excess(LEAST) + index:.3g} to {excess(top) + index:.3g}'
        )
    return float(brentq(excess, LEAST, top, xtol=1e-12)) / MICRO
