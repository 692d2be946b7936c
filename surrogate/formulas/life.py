# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fatigue life of a ball screw by ISO 3408-5, and lubrication by analogy with ISO 281.

A life is reached by nine screws of ten. ISO 281 holds for rolling bearings, and no standard
carries it over to ball screws: its factor serves to compare two programmes of one screw. Plain
arithmetic on floats, since the online half uses it too; an unknown number gives an unknown one.

"""

from collections.abc import Iterable
import math

RATED_LIFE = 1e6
"""Life under the dynamic rating [rev]."""
SEPARATION = 2.0**1.5
"""Axial load over preload at which the relieved nut carries nothing [-]."""
SLOPE = 10 / 9
"""Weibull slope of the lives of ball bearings, by which those of two nuts combine [-]."""
KAPPA_RANGE = (0.1, 4.0)
"""Viscosity ratios for which ISO 281 states its factor [-]; it is constant beyond them."""
LARGEST_FACTOR = 50.0
"""Largest life modification factor that ISO 281 allows [-]."""
LAMBDA_EXPONENT = 1.3
"""Exponent of the film ratio in the viscosity ratio [-]."""
LARGEST_PITCH, LIMIT_SHARE = 0.1, 22.0
"""Pitch diameter up to which C0 over the fatigue limit is constant [m], and that ratio [-]."""
_FACTORS = ((0.4, 2.2649, 0.054381), (1.0, 1.9987, 0.19087), (math.inf, 1.9987, 0.071739))
# Viscosity ratio below which a row holds, C and p of ISO 281 (31) to (33).


def nut_forces_iso_3408_2006(load: float, preload: float) -> tuple[float, float]:
    """
    Return the axial forces in the pressed and in the relieved nut [N].

    F1 = Fp (1 + F / (2^(3/2) Fp))^(3/2), F2 = F1 - F, up to F = 2^(3/2) Fp, beyond which the
    pressed nut carries F alone: ISO 3408-5:2006, 7.1.3. `load` [N] counts by its amount, `preload`
    [N] at least 0. The springs of Hertz in `load_sharing` give a pressed nut up to 2.5 % less.

    """
    force = abs(load)
    if force >= SEPARATION * preload:
        return force, 0.0
    pressed: float = preload * (1 + force / (SEPARATION * preload)) ** 1.5
    return pressed, pressed - force


def life_iso_3408_2006(rating: float, load: float) -> float:
    """
    Return the nominal life of a nut [rev], infinite without load.

    L = (C / F)^3 1e6: ISO 3408-5:2006, 7.2. Dynamic `rating` C [N], `load` in the nut F [N].

    """
    worn = (abs(load) / rating) ** 3
    return RATED_LIFE / worn if worn else math.inf


def damage_palmgren_1924(spectrum: Iterable[tuple[float, float]], rating: float) -> float:
    """
    Return the share of the nominal life of a nut that a spectrum uses up [-].

    sum N_i / L_i: Palmgren, Z. VDI 68 (1924) 339. `spectrum` has loads of the nut [N] with their
    turns [rev], `rating` is the dynamic one [N].

    """
    return sum(turns / life_iso_3408_2006(rating, load) for load, turns in spectrum)


def combined_damage(first: float, second: float) -> float:
    """
    Return the share of the life of a screw that is used up [-] by those of its two nuts [-].

    D = N / L and L = (L1^(-10/9) + L2^(-10/9))^(-9/10): ISO 3408-5:2006, 7.2.3, a screw fails
    when one of its nuts does. So D = (D1^(10/9) + D2^(10/9))^(9/10).

    """
    if not 0.0 < first + second < math.inf:
        return float(first + second)
    larger, smaller = max(first, second), min(first, second)
    # By the ratio, since powers of a small damage underflow.
    return float(larger * (1.0 + (smaller / larger) ** SLOPE) ** (1 / SLOPE))


def fatigue_limit_iso_281_2007(static_rating: float, pitch_diameter: float) -> float:
    """
    Return the load below which ISO 281 expects no fatigue [N], by the rule for ball bearings.

    Cu = C0 / 22 for pitch diameters up to 100 mm, times (100 mm / Dpw)^(1/2) beyond: ISO 281:2007,
    (B.18), (B.19). `static_rating` C0 [N], `pitch_diameter` Dpw [m].

    """
    size = min(1.0, math.sqrt(LARGEST_PITCH / pitch_diameter))
    return static_rating * size / LIMIT_SHARE


def viscosity_ratio_iso_1281_2008(film_ratio: float) -> float:
    """
    Return the viscosity ratio kappa [-] by the film ratio Lambda [-].

    kappa = Lambda^1.3: ISO 281:2007, 9.3.3.3.2, and ISO/TR 1281-2:2008, (57).

    """
    if math.isnan(film_ratio):
        return math.nan
    return float(max(film_ratio, 0.0) ** LAMBDA_EXPONENT)


def life_factor_iso_281_2007(viscosity_ratio: float, limit_ratio: float) -> float:
    """
    Return the life modification factor of ball bearings [-], 0.1 to 50.

    a = 0.1 [1 - (2.5671 - C / kappa^p)^0.83 (eC Cu / P)^(1/3)]^(-9.3): ISO 281:2007, (31) to (33).
    `viscosity_ratio` kappa [-], `limit_ratio` eC Cu / P [-] with the contamination factor eC, the
    fatigue limit Cu and the load P; thrust bearings have eC Cu / (3 P) instead, (37) to (39).

    """
    if math.isnan(viscosity_ratio) or math.isnan(limit_ratio):
        return math.nan
    low, high = KAPPA_RANGE
    kappa = min(max(viscosity_ratio, low), high)
    c, p = next((c, p) for below, c, p in _FACTORS if kappa < below)
    film = max(2.5671 - c / kappa**p, 0.0) ** 0.83
    left = 1 - film * math.cbrt(limit_ratio)
    least = (0.1 / LARGEST_FACTOR) ** (1 / 9.3)
    return LARGEST_FACTOR if left <= least else float(0.1 * left**-9.3)
