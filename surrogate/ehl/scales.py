# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One contact and its scales, those of Hertz: all that its domain is found from."""

from dataclasses import dataclass
import math

from surrogate.ehl.interface import Condition, ContactLubricant, RoughHeights
from surrogate.formulas.film import (
    central_film_hamrock_dowson_1977,
    central_film_nijenbanning_1994,
    groups,
)
from surrogate.formulas.geometry import Contact, hertz


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaledContact:
    """
    A contact, its oil, condition and roughness, with its scales.

    Semi-axes [m], Hertz pressure [Pa], height unit a^2/Rx [m].

    """

    contact: Contact
    lubricant: ContactLubricant
    condition: Condition
    roughness: RoughHeights | None
    semi_axis_x: float
    semi_axis_y: float
    hertz_pressure: float
    height_unit: float

    @property
    def ellipticity(self) -> float:
        """Semi-axis along y over that along x [-]."""
        return self.semi_axis_y / self.semi_axis_x

    def film_estimate(self, speed: float) -> float:
        """
        Return the central film by formula, in Hertz units [-], at a speed [m/s].

        The fit over all regimes; where it is far above the piezoviscous-elastic one, the geometric
        mean of both: its rigid branch explodes below its range of loads.

        """
        g = groups(
            self.contact,
            self.condition.load,
            speed,
            self.lubricant.viscosity,
            self.lubricant.pressure_viscosity,
        )
        all_regimes = float(central_film_nijenbanning_1994(self.contact, g))
        elastic = float(central_film_hamrock_dowson_1977(self.contact, g))
        film = min(all_regimes, max(1.5 * elastic, math.sqrt(all_regimes * elastic)))
        return film / self.height_unit

    def speed_of_film(self, film: float) -> float:
        """Speed [m/s] whose smooth film is about `film` [Hertz units], by formula."""
        trial = 1.0
        for _ in range(12):
            trial *= film / self.film_estimate(trial)
        return trial


def scale_contact(
    contact: Contact,
    lubricant: ContactLubricant,
    condition: Condition,
    roughness: RoughHeights | None,
) -> ScaledContact:
    """Scale a contact by its dry and smooth one, which is that of Hertz."""
    dry = hertz(contact, condition.load)
    a = float(dry.semi_axis_x)
    return ScaledContact(
        contact=contact,
        lubricant=lubricant,
        condition=condition,
        roughness=roughness,
        semi_axis_x=a,
        semi_axis_y=float(dry.semi_axis_y),
        hertz_pressure=float(dry.max_pressure),
        height_unit=a * a / contact.radius_x,
    )
