# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Published closed forms of film, asperity share and rolling resistance, with their ranges.

Films follow the smooth isothermal contact with the entrainment along x. Each formula names the
groups it was fitted over in `RANGES`; `outside_range` tells where a use leaves them. Inside a
formula the symbols are those of its paper.

"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.geometry import Contact

Array = NDArray[np.float64]
LEAST_FACTOR = 0.3
"""Least film factor of inlet heating [-]: the fit is not used below."""

RANGES: dict[str, dict[str, tuple[float, float]]] = {
    # The thirty-four computed cases of the paper.
    'central_film_hamrock_dowson_1977': {
        'speed': (8.4e-13, 5.05e-11),
        'load': (1.1e-7, 1.3e-6),
        'material': (2.3e3, 6.8e3),
        'radius_ratio': (1.0, 26.0),
    },
    'central_film_nijenbanning_1994': {
        'moes_load': (1.0, 1e4),
        'moes_material': (0.0, 25.0),
        'radius_ratio': (1.0, 20.0),
    },
    'rolling_force_biboulet_houpert_2010': {'moes_load': (1.0, 1e4), 'radius_ratio': (1.0, 100.0)},
}
"""Fitted range of each formula in the groups of `Groups` [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Groups:
    """
    Dimensionless groups of a lubricated contact, of any shape.

    U = eta0 us/(E' Rx), W = Q/(E' Rx^2), G = alpha E' (Hamrock, Dowson); M = W (2U)^(-3/4),
    L = G (2U)^(1/4) (Moes); radius ratio Ry/Rx.

    """

    speed: Array
    load: Array
    material: Array
    radius_ratio: float

    @property
    def moes_load(self) -> Array:
        """Moes load parameter M [-]."""
        return np.asarray(self.load * (2 * self.speed) ** -0.75)

    @property
    def moes_material(self) -> Array:
        """Moes material parameter L [-]."""
        return np.asarray(self.material * (2 * self.speed) ** 0.25)


def groups(
    contact: Contact,
    load: ArrayLike,
    entrainment_speed: ArrayLike,
    viscosity: ArrayLike,
    pressure_viscosity: ArrayLike,
) -> Groups:
    """Return the groups for load [N], speed [m/s], viscosity [Pa s], coefficient [1/Pa]."""
    modulus, radius = contact.reduced_modulus, contact.radius_x
    speed = np.asarray(viscosity) * np.asarray(entrainment_speed) / (modulus * radius)
    return Groups(
        speed=np.asarray(speed),
        load=np.asarray(load) / (modulus * radius**2),
        material=np.asarray(pressure_viscosity) * modulus,
        radius_ratio=contact.radius_y / contact.radius_x,
    )


def outside_range(formula: str, g: Groups) -> tuple[str, ...]:
    """Return a phrase for each group in which a use of `formula` leaves its range."""
    phrases = []
    for name, (low, high) in RANGES[formula].items():
        values = np.asarray(getattr(g, name), dtype=float)
        values = values[np.isfinite(values)]
        if values.size and (values.min() < low or values.max() > high):
            far = values.max() if values.max() > high else values.min()
            phrases.append(f'{name} {far:.3g} (fitted {low:.3g} to {high:.3g})')
    return tuple(phrases)


def central_film_hamrock_dowson_1977(contact: Contact, g: Groups) -> Array:
    """
    Return the central film [m].

    Hc = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 e^(-0.73 k)), k = 1.03 (Ry/Rx)^0.64: Hamrock,
    Dowson, J. Lubr. Technol. 99 (1977) 264. About 4 to 10 % above converged solutions.

    """
    U, W, G, k = g.speed, g.load, g.material, 1.03 * g.radius_ratio**0.64
    film = 2.69 * U**0.67 * G**0.53 * W**-0.067 * (1 - 0.61 * np.exp(-0.73 * k))
    return np.asarray(film * contact.radius_x)


def minimum_film_hamrock_dowson_1977(contact: Contact, g: Groups) -> Array:
    """
    Return the minimum film [m].

    Hm = 3.63 U^0.68 G^0.49 W^-0.073 (1 - e^(-0.68 k)), source as for the central film. Within 7 %
    from ellipticity 3 on; up to 90 % off for circular contacts.

    """
    U, W, G, k = g.speed, g.load, g.material, 1.03 * g.radius_ratio**0.64
    film = 3.63 * U**0.68 * G**0.49 * W**-0.073 * (1 - np.exp(-0.68 * k))
    return np.asarray(film * contact.radius_x)


def central_film_nijenbanning_1994(contact: Contact, g: Groups) -> Array:
    """
    Return the central film [m] by a fit over all regimes.

    Rigid and elastic, isoviscous and piezoviscous asymptotes joined: Nijenbanning, Venner, Moes,
    Wear 176 (1994) 217, for an incompressible fluid.

    """
    D, M, L = 1 / g.radius_ratio, g.moes_load, g.moes_material
    shape = 1 + 0.006 * np.log(D) + 0.63 * D ** (4 / 7)
    H_RI = 145 * (1 + 0.796 * D ** (14 / 15)) ** (-15 / 7) / D * M**-2
    H_RP = 1.29 * (1 + 0.691 * D) ** (-2 / 3) * L ** (2 / 3)
    H_EI = 3.18 * shape ** (-14 / 25) * D ** (-1 / 15) * M ** (-2 / 15)
    H_EP = 1.48 * shape ** (-7 / 20) * D ** (-1 / 24) * M ** (-1 / 12) * L**0.75
    H_00 = 1.8 / D
    s = 1.5 * (1 + np.exp(-1.2 * H_EI / H_EP))
    isoviscous = (H_RI**1.5 + (H_EI**-4 + H_00**-4) ** (-3 / 8)) ** (2 * s / 3)
    film = (isoviscous + (H_RP**-8 + H_EP**-8) ** (-s / 8)) ** (1 / s)
    return np.asarray(film * contact.radius_x * np.sqrt(2 * g.speed))


def film_ratio(film: ArrayLike, rms: float) -> Array:
    """Return Lambda [-] of a film [m] over Rq `rms` [m], infinite where a film parts smooth."""
    film = np.asarray(film, dtype=float)
    return np.asarray(film / rms if rms else np.where(film > 0, np.inf, film))


def rolling_force_biboulet_houpert_2010(contact: Contact, g: Groups) -> Array:
    """
    Return the hydrodynamic rolling force on each surface [N].

    F = F_e + (F_i - F_e)/(1 + M/6.6), F_i = 2.9766 E' Rx^2 (Ry/Rx)^0.3316 W^(1/3) U^(2/3)
    isoviscous rigid, F_e = 7.5826 E' Rx^2 (Ry/Rx)^0.4055 W^(1/3) U^(3/4) elastic, M = W U^(-3/4):
    Biboulet, Houpert, Proc. IMechE J 224 (2010) 765 and 777.

    """
    U, W, k = g.speed, g.load, g.radius_ratio
    scale = contact.reduced_modulus * contact.radius_x**2 * np.cbrt(W)
    rigid = 2.9766 * scale * k**0.3316 * U ** (2 / 3)
    elastic = 7.5826 * scale * k**0.4055 * U**0.75
    # 1/(1 + M/6.6) written so that a contact at rest is legal.
    weight = 6.6 * U**0.75 / np.maximum(6.6 * U**0.75 + W, np.finfo(float).tiny)
    return np.asarray(elastic + (rigid - elastic) * weight)


def film_factor_gupta_1992(*, pressure: Array, loading: Array, slide_roll: float) -> Array:
    """
    Return the central film with heating by shear in the inlet over that without [-].

    (1 - 13.2 (p_H/E') L^0.42) / (1 + 0.213 (1 + 2.23 S^0.83) L^0.64): Gupta, Cheng, Zhu, Forster,
    Schrand, J. Tribol. 114 (1992) 55. Hertz `pressure` p_H/E', thermal `loading` L = eta0 beta
    us^2/k with the relative slope of viscosity beta and the conductivity k, `slide_roll` ratio S.
    At least `LEAST_FACTOR`: the numerator is linear in the pressure and ends below zero.

    """
    drop = 1 - 13.2 * pressure * loading**0.42
    factor = drop / (1 + 0.213 * (1 + 2.23 * slide_roll**0.83) * loading**0.64)
    return np.asarray(np.maximum(factor, LEAST_FACTOR))
