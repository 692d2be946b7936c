# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of contact by the topography of a raceway: the speed at which its summits begin to touch.

Contact begins where the smooth film no longer bridges the acting height of what a rolling contact
leaves of the roughness. The constants are fitted to marches of strips whose summits were cut, see
`studies/results/asperity_marches.csv` and `film_marches.csv`.

"""

from dataclasses import dataclass, replace
from functools import lru_cache
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.asperities.running_in import running_tiles, RunningContact
from surrogate.asperities.topography import acting_roughness, ActingRoughness, WAVE_POWER
from surrogate.ehl import ContactLubricant
from surrogate.formulas.geometry import Contact
from surrogate.formulas.line import central_film_line, Line, line_at, moes_line

Array = NDArray[np.float64]
FLOORS = 2.8
"""Film over the film floor at the onset of a raceway that is nearly smooth [-]."""
HEIGHTS = 3.3
"""Film beyond it over acting height, floor and pressure at the onset of coarse marches [-]."""
FLOOR_POWER = -WAVE_POWER
"""Exponent of the film floor in that film [-]."""
PRESSURE, PRESSURE_POWER = 0.9e9, -0.235
"""Hertz pressure to which the constant belongs [Pa] and exponent of the pressure [-]."""
COARSE_FILM = 0.978
"""Film at the onset on 8 x 6 nodes in the shortest wave at a speed that stands still over that on
5 x 4 at one that falls [-]: two pairs of marches at 0.89 of the speed, and 1.08 for the lag, where
film over height goes with the power 0.55 of the speed."""
LOG_SPEEDS = np.linspace(math.log(1e-5), math.log(1e2), 140)
"""Logarithms of the entrainment speeds among which an onset is looked for [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TopographyOnset:
    """
    Onset of contact on one raceway.

    Its acting roughness, None where all is smooth; the speed over that which this tells, and the
    film over that which the law tells [-].

    """

    acting: ActingRoughness | None
    factor: float = 1.0
    film_factor: float = 1.0

    def speeds(
        self, line: Line, oil: ContactLubricant, floor: float, *, film: float = 1.0
    ) -> Array:
        """
        Return the entrainment speed of the onset [m/s] for every pressure of a line; 0 if smooth.

        The fastest at which the film is below `film` [-] times that which the acting height and
        the film floor [m] ask for.

        """
        if self.acting is None:
            return np.zeros(np.shape(line.max_pressure))
        pressure = np.asarray(line.max_pressure)[..., None]
        every = replace(line, max_pressure=pressure)
        spare = np.log(self.film_over_law(every, np.exp(LOG_SPEEDS), oil, floor) / film)
        below = spare[..., :-1] < 0
        last = len(LOG_SPEEDS) - 2 - np.argmax(below[..., ::-1], axis=-1)
        low, high = (np.take_along_axis(spare, (last + k)[..., None], -1)[..., 0] for k in (0, 1))
        step = LOG_SPEEDS[1] - LOG_SPEEDS[0]
        fastest = np.exp(LOG_SPEEDS[last] - low / (high - low) * step)
        return self.factor * np.asarray(np.where(below.any(axis=-1), fastest, 0.0))

    def film_over_law(
        self, line: Line, speed: ArrayLike, oil: ContactLubricant, floor: float
    ) -> Array:
        """
        Return the smooth film over that at which the law lets contact begin [-].

        At entrainment speeds [m/s] of a rough raceway, film floor [m].

        """
        assert self.acting is not None
        M1, L = moes_line(line, speed, oil.viscosity, oil.pressure_viscosity)
        reduction = M1**0.75 / np.sqrt(L) / line.semi_axis
        central = central_film_line(line, speed, oil.viscosity, oil.pressure_viscosity)
        height = self.acting.height(reduction, line.max_pressure)
        wanted = film_at_onset(height, floor, line.max_pressure)
        return np.asarray(central / (self.film_factor * wanted))

    def speed(
        self,
        contact: Contact,
        load: float,
        oil: ContactLubricant,
        floor: float,
        *,
        film: float = 1.0,
    ) -> float:
        """Return the onset speed [m/s] in the middle of a contact under a load [N]."""
        return float(self.speeds(line_at(contact, load, 0.0), oil, floor, film=film))


def film_at_onset(height: ArrayLike, floor: float, pressure: ArrayLike) -> Array:
    """
    Return the smooth central film at which contact begins [m].

    For acting heights [m^0.78], a film floor [m] and Hertz pressures [Pa].

    """
    over = (np.asarray(pressure) / PRESSURE) ** PRESSURE_POWER
    rough = HEIGHTS * floor**FLOOR_POWER * over * np.asarray(height)
    return np.asarray(COARSE_FILM * (FLOORS * floor + rough))


@lru_cache(maxsize=64)
def onset_of(contact: RunningContact) -> TopographyOnset:
    """
    Return the onset of contact on a raceway as it runs.

    It takes seconds, once for each topography. Raises InputError as `running_tiles` does.

    """
    tiles = running_tiles(contact)
    if not tiles:
        return TopographyOnset(acting=None)
    modulus = 0.5 * contact.reduced_modulus
    return TopographyOnset(acting=acting_roughness(tiles, modulus, contact.resolved_wave))
