# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Law of asperity contact: its growth below the speed at which a rolling contact begins to touch.

Strips that were marched at other pressures, temperatures and places of the raceway share one curve
over the speed by that of the onset, and the onset comes at one film over the roughness that acts.

"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator
from surrogate.asperities.acting import speed_at_ratio, Waves
from surrogate.datasheet import DATA
from surrogate.ehl import Condition, ContactLubricant
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.formulas.line import central_film_line, line_at
from surrogate.surface.file import read

Array = NDArray[np.float64]
SHIPPED = DATA / 'asperity_law.json'
ONSET_RCS = 0.01
"""RCS at the onset [-]."""
PLACES = 8
"""Places across a contact at which it is looked up [-]."""
NOTHING = 1e-7
"""RCS that counts as none [-]."""
FLOOR_POWER = 1 / 3
"""Exponent in the floor of the film over the acting rms at the onset [-]."""


@dataclass(frozen=True, slots=True)
class AsperityContact:
    """
    RCS, asperity share and rolling loss over that of a smooth contact [-] of one contact.

    Standard deviation of RCS between strips of the raceway [-], NaN if not known.

    """

    rcs: float
    asperity_share: float
    loss_factor: float
    rcs_deviation: float = math.nan


AT_REST = AsperityContact(1.0, 1.0, 1.0, 0.0)
"""Asperities carry all of a load that does not move."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityLaw:
    """
    Curves over the logarithm of the speed by that of the onset, and where the onset is.

    `onset_ratio` is the smooth film, by formula, over the rms of all acting waves at the onset [-]
    for the floor `film_floor` [m] and the Hertz pressure `pressure` [Pa]; it falls with that
    pressure by the `pressure_power` [-], since pressure presses summits flat. `log_speed` rises;
    RCS, asperity share and rolling loss over that of a smooth contact there [-]. Standard
    deviation between marches of the logarithm of the onset speed and standard error of that of
    the law [-], how many marches, the shortest wave in them [m]; `source` says in words where the
    law is from.

    """

    onset_ratio: float
    film_floor: float
    pressure: float
    pressure_power: float
    log_speed: tuple[float, ...]
    rcs: tuple[float, ...]
    asperity_share: tuple[float, ...]
    loss_factor: tuple[float, ...]
    deviation: float
    standard_error: float
    marches: int
    shortest_wave: float
    source: str

    @property
    def error_share(self) -> float:
        """Return the standard error of the onset speed over its deviation between marches [-]."""
        return self.standard_error / self.deviation if self.deviation else 1.0

    def ratio(self, floor: float, pressure: ArrayLike) -> Array:
        """
        Return the film over the acting rms at the onset [-] for a floor [m] and pressures [Pa].

        It goes with the cube root of the floor, measured from 1 to 5 nm.

        """
        at_floor = self.onset_ratio * (floor / self.film_floor) ** FLOOR_POWER
        return np.asarray(at_floor * (np.asarray(pressure) / self.pressure) ** self.pressure_power)

    def onset(
        self, waves: Waves, contact: Contact, load: float, oil: ContactLubricant, floor: float
    ) -> float:
        """
        Return the entrainment speed of the onset [m/s] in the middle of a contact.

        Under a load [N], with a film floor [m]; 0 where the raceway is smooth.

        """
        line = line_at(contact, load, 0.0)
        ratio = self.ratio(floor, line.max_pressure)
        return float(speed_at_ratio(waves, line, oil, ratio))

    def contact(
        self,
        waves: Waves,
        contact: Contact,
        condition: Condition,
        oil: ContactLubricant,
        floor: float,
    ) -> AsperityContact:
        """
        Return what asperities do in an elliptical contact under a condition, film floor [m].

        Integrated over strips across the contact, each with its share of the load, which falls
        with the square of the half length: Gauss-Legendre. A smooth film below the floor touches
        everywhere, whatever the roughness.

        """
        if not condition.entrainment_speed:
            return AT_REST
        points, weights = np.polynomial.legendre.leggauss(2 * PLACES)
        place, share = points[PLACES:], 1.5 * weights[PLACES:] * (1 - points[PLACES:] ** 2)
        strips = line_at(contact, condition.load, place)
        onset = speed_at_ratio(waves, strips, oil, self.ratio(floor, strips.max_pressure))
        film = central_film_line(
            strips, condition.entrainment_speed, oil.viscosity, oil.pressure_viscosity
        )
        with np.errstate(divide='ignore'):
            over = np.log(condition.entrainment_speed) - np.log(onset)
        over = np.where(film < floor, -math.inf, over)
        found = self.at(over)
        apart = [share @ self.at(over + side * self.deviation)['rcs'] for side in (-0.5, 0.5)]
        # The weights add up to 1 but for rounding.
        rcs, touching = (
            min(float(share @ found[name]), 1.0) for name in ('rcs', 'asperity_share')
        )
        return AsperityContact(
            rcs=rcs,
            asperity_share=touching,
            loss_factor=float(share @ found['loss_factor']),
            rcs_deviation=float(apart[0] - apart[1]),
        )

    def at(self, log_speed: Array) -> dict[str, Array]:
        """
        Return the curves at logarithms of the speed over that of the onset [-].

        Slower than known, RCS and share go to 1 with the speed; faster, RCS goes on as a power of
        it, and none of it counts below `NOTHING`; the loss goes to that of a smooth contact.

        """
        rcs, share = (self._share(log_speed, one) for one in (self.rcs, self.asperity_share))
        return {
            'rcs': rcs,
            'asperity_share': np.minimum(rcs, share),
            'loss_factor': self._loss(log_speed),
        }

    def _loss(self, log_speed: Array) -> Array:
        """Return the rolling loss over that of a smooth contact [-]."""
        found = np.interp(log_speed, self.log_speed, self.loss_factor)
        faster = np.maximum(log_speed - self.log_speed[-1], 0.0)
        return np.asarray(1 + (found - 1) * np.exp(-faster))

    def _share(self, log_speed: Array, known: tuple[float, ...]) -> Array:
        """Return a share [-]: a cubic of its logarithm within, and what `at` says beyond."""
        nodes, logs = np.array(self.log_speed), np.log(known)
        first, last = nodes[0], nodes[-1]
        inside = PchipInterpolator(nodes, logs)(np.clip(log_speed, first, last))
        steep = (logs[-1] - logs[-2]) / (last - nodes[-2])
        found = np.exp(inside + steep * np.maximum(log_speed - last, 0.0))
        slow = 1 - (1 - known[0]) * np.exp(np.minimum(log_speed - first, 0.0))
        found = np.where(log_speed < first, slow, found)
        return np.asarray(np.where(found < NOTHING, 0.0, found))

    def to_json(self) -> dict[str, Any]:
        """Return the law in plain JSON types."""
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in asdict(self).items()
        }


def law_from_json(content: Mapping[str, Any]) -> AsperityLaw:
    """Return the law that `to_json` wrote."""
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in content.items()
    }
    return AsperityLaw(**values)


def law_of_surface(path: Path) -> AsperityLaw:
    """Return the law that a full-tier surface was built with; InputError for another tier."""
    header = read(path).header
    if 'law' not in header:
        raise InputError(f'{path}: a surface of tier {header["tier"]}, allowed is full')
    return law_from_json(header['law'])


@lru_cache(maxsize=1)
def shipped_law() -> AsperityLaw:
    """Return the law of the nominal screw and oil, which stands in for that of others."""
    return law_from_json(json.loads(SHIPPED.read_text(encoding='utf-8')))
