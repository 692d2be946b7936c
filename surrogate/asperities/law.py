# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Law of asperity contact: where it begins on the raceways of a screw, and how it grows below.

The onset follows from the topography of each raceway. Below it contact grows over the smooth
central film by that at the onset: how fast depends on how flat the summits were cut, the rolling
loss on pressure and lay. The onsets are those of `studies/results/asperity_marches.csv` and
`film_marches.csv`.

"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit, logit
from surrogate.asperities.running_in import RunningContact
from surrogate.asperities.topography import ActingRoughness
from surrogate.asperities.topography_onset import LOG_SPEEDS, onset_of, PRESSURE, TopographyOnset
from surrogate.ehl import Condition, ContactLubricant
from surrogate.formulas.geometry import Contact, Side
from surrogate.formulas.line import central_film_line, Line, line_at
from surrogate.raceway.stated import NINE_OF_TEN, Roughness

Array = NDArray[np.float64]
ONSET_RCS = 0.01
"""RCS at the onset [-]."""
VERSION = 'topography 8'
"""Of the law, among what results that it decides are kept by."""
PLACES = 8
"""Places across a contact at which it is looked up [-]."""
NOTHING = 1e-7
"""RCS that counts as none [-]."""
SLOPE, BEND, SLOPE_CUT = -6.5, -2.27, -1.2
"""Of the logit of RCS over the logarithm of the film by that at the onset [-], and what `cut` of a
raceway adds to the slope: contact grows slower on plateaus."""
FILM_POWER = 0.7
"""Exponent of the speed in the smooth central film, about [-]."""
SHARE = 0.84, 0.16
"""Asperity share over RCS where RCS is small, and how it rises with RCS [-]."""
LOSS, LOSS_SLOPE = (1.27, 0.09, -0.23), (0.04, -0.05, 0.18)
"""Loss at the onset and its slope over the logarithm of the film: usual, over the logarithm of the
pressure, over the lay [-]."""
LOSS_RIDGES, RIDGE_FLOORS = -0.20, 17.0
"""What ridges along the track add to the loss over the logarithm of the film at the onset by the
film floor [-], and the ratio at which that is nothing [-]: high ridges guide the oil."""
PRESSURES = 0.4e9, 1.5e9
"""Hertz pressures of the marches [Pa]."""
LEAST_LOSS = 0.4
"""Least rolling loss over that of a smooth contact [-]; 0.39 in the marches, on high ridges."""
LOSS_THINNEST = -1.0
"""Logarithm of the film by that at the onset below which the loss keeps its value [-]."""
SMOOTH_FROM, FADING = 1.0, 0.25
"""Logarithm of the film by that at the onset at which half of the change of the loss is left, and
its width [-]."""
SOFT_FILM, SOFT_LOSS = 0.18, 0.03
"""Widths of the bends to the thinnest film and to the least loss [-]."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(2 * PLACES)
FILM_BANDS = {'isotropic': 1.15, 'longitudinal': 1.3, 'transverse': 1.35}
"""Factor in film within which the topography tells nine of ten marched strips, by the lay [-]; of
strips that were held out, by `studies/film_marches.py: nine_of_ten`."""


@dataclass(frozen=True, slots=True)
class AsperityContact:
    """
    RCS, asperity share and rolling loss over that of a smooth contact [-] of one contact.

    Standard deviation of RCS between the law and marched strips [-], NaN if not known.

    """

    rcs: float
    asperity_share: float
    loss_factor: float
    rcs_deviation: float = math.nan


REST = 1e-12  # [m/s] slower is at rest: powers of what is next to nothing overflow
AT_REST = AsperityContact(1.0, 1.0, 1.0, 0.0)
"""Asperities carry all of a load that does not move."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityLaw:
    """
    Onsets of contact on the raceways of a screw by their side.

    Standard `deviation` of the logarithm of the film at the onset between law and marches [-]; of
    a calibrated onset that of the logarithm of its speed, `speed_deviation`, takes its place.

    """

    onsets: Mapping[Side, TopographyOnset]
    deviation: float
    speed_deviation: float = 0.0

    def shifted(self, deviations: float) -> 'AsperityLaw':
        """Return the law whose onsets are off by so many of its standard deviations [-]."""
        film, speed = (
            math.exp(deviations * one) for one in (self.deviation, self.speed_deviation)
        )
        onsets = {
            side: replace(onset, factor=speed * onset.factor, film_factor=film * onset.film_factor)
            for side, onset in self.onsets.items()
        }
        return replace(self, onsets=onsets)

    def contact(
        self,
        side: Side,
        contact: Contact,
        condition: Condition,
        oil: ContactLubricant,
        floor: float,
    ) -> AsperityContact:
        """
        Return what asperities do in an elliptical contact under a condition, film floor [m].

        Integrated over strips across the contact, each with its share of the load, which falls
        with the square of the half length: Gauss-Legendre.

        """
        if not condition.entrainment_speed:
            return AT_REST
        speeds = np.array([condition.entrainment_speed])
        # As stated, and where the onset is off by half of its deviation either way.
        (rcs, share, loss), (later, *_), (sooner, *_) = (
            [
                float(values[0])
                for values in law.touching(side, contact, condition.load, oil, floor, speeds)
            ]
            for law in (self, self.shifted(0.5), self.shifted(-0.5))
        )
        return AsperityContact(rcs, share, loss, rcs_deviation=later - sooner)

    def touching(
        self,
        side: Side,
        contact: Contact,
        load: float,
        oil: ContactLubricant,
        floor: float,
        speeds: Array,
    ) -> tuple[Array, Array, Array]:
        """Return RCS, asperity share and loss factor [-] of `contact` at many speeds [m/s]."""
        acting, factor = self.onsets[side].acting, self.onsets[side].factor
        if acting is None:
            none = np.zeros(np.shape(speeds))
            return none, none, none + 1.0
        share, strips, onset = self._strips(side, contact, load, oil, floor)
        # A factor on the onset moves all that is below it.
        at_onset = film_of(strips, onset[:, None] / factor, oil)
        with np.errstate(divide='ignore'):
            over = np.log(film_of(strips, speeds / factor, oil) / at_onset)
        rcs = rcs_at(over, growth_of(acting))
        loss = loss_at(over, strips.max_pressure[:, None], acting.lay, at_onset / floor)
        # Summed place by place, so that a speed does not depend on those beside it. The weights
        # add up to 1 but for rounding.
        rcs, carried, loss = (
            (share[:, None] * values).sum(axis=0) for values in (rcs, share_at(rcs), loss)
        )
        return np.minimum(rcs, 1.0), np.minimum(carried, 1.0), loss

    def _strips(
        self, side: Side, contact: Contact, load: float, oil: ContactLubricant, floor: float
    ) -> tuple[Array, Line, Array]:
        """Return strips across a contact: share of the load, line, speed of the onset [m/s]."""
        place = _POINTS[PLACES:]
        share = 1.5 * _WEIGHTS[PLACES:] * (1 - place**2)
        strips = line_at(contact, load, place)
        onsets = self.onsets[side].speeds(strips, oil, floor)
        return share, strips, np.maximum(onsets, math.exp(LOG_SPEEDS[0]))


def film_of(strips: Line, speeds: Array, oil: ContactLubricant) -> Array:
    """Return the smooth central film [m] of strips, one a row, at speeds [m/s]; 0 at rest."""
    rows = replace(strips, max_pressure=strips.max_pressure[:, None])
    moves = speeds > REST
    moving = np.where(moves, speeds, 1.0)
    film = central_film_line(rows, moving, oil.viscosity, oil.pressure_viscosity)
    return np.asarray(np.where(moves, film, 0.0))


def growth_of(acting: ActingRoughness) -> float:
    """Return the slope of the logit of RCS over the logarithm of the film at the onset [-]."""
    return SLOPE + SLOPE_CUT * acting.cut


def rcs_at(log_film: ArrayLike, slope: float = SLOPE) -> Array:
    """
    Return RCS at logarithms of the film by that at the onset [-].

    Thinner than marched the load that oil carries, over that of asperities, falls as the speed
    does. RCS below `NOTHING` is 0.

    """
    x, oil = np.asarray(log_film, dtype=float), 1 / FILM_POWER
    thinnest = -(slope + oil) / (2 * BEND)
    known = np.maximum(x, thinnest)
    beyond = oil * np.minimum(x - thinnest, 0)
    found = expit(logit(ONSET_RCS) + slope * known + BEND * known**2 - beyond)
    return np.asarray(np.where(found < NOTHING, 0.0, found))


def share_at(rcs: Array) -> Array:
    """Return the share of the load that asperities carry at an RCS [-]."""
    return np.asarray(rcs * (SHARE[0] + SHARE[1] * rcs))


def loss_at(log_film: Array, pressure: Array, lay: float, floors: ArrayLike) -> Array:
    """
    Return the rolling loss over that of a smooth contact [-].

    At logarithms of the film by that at the onset [-], Hertz pressures [Pa], a lay as
    `ActingRoughness` has it, and the film at the onset by the film floor [-].

    """
    pressed = np.log(np.clip(pressure, *PRESSURES) / PRESSURE)
    at_onset, slope = (
        usual + over_pressure * pressed + over_lay * lay
        for usual, over_pressure, over_lay in (LOSS, LOSS_SLOPE)
    )
    guided = LOSS_RIDGES * max(lay, 0.0) * np.log(np.asarray(floors) / RIDGE_FLOORS)
    return loss_along(at_onset + guided, slope, log_film)


def loss_along(at_onset: Array | float, slope: Array | float, log_film: Array) -> Array:
    """
    Return the loss [-] of a value at the onset and a slope over the logarithm of the film [-].

    The line bends to the value of `LOSS_THINNEST` and to `LEAST_LOSS`; the thicker the film, the
    less of it is left.

    """
    line = at_onset + slope * _above(log_film, LOSS_THINNEST, SOFT_FILM)
    change = _above(line, LEAST_LOSS, SOFT_LOSS) - 1
    return np.asarray(1 + change * expit((SMOOTH_FROM - log_film) / FADING))


def _above(values: Array, least: float, width: float) -> Array:
    """Return values [-] that bend smoothly to the least one, over a width [-]."""
    return np.asarray(least + width * np.logaddexp(0.0, (values - least) / width))


def law_of(contacts: Mapping[Side, RunningContact], sheet: Roughness) -> AsperityLaw:
    """
    Return the law of the raceways of a screw by their side.

    The onset factor, the calibration and the marches of the sheet act here alone. Raises
    InputError as `onset_of` does.

    """
    calibrated, deviation = sheet.onset_band, math.log(FILM_BANDS[sheet.lay]) / NINE_OF_TEN
    if sheet.marched_error is not None:
        deviation = sheet.marched_error
    return AsperityLaw(
        onsets={
            side: replace(
                onset_of(contact), factor=sheet.onset_factor, film_factor=sheet.marched_film or 1.0
            )
            for side, contact in contacts.items()
        },
        deviation=0.0 if calibrated else deviation,
        speed_deviation=math.log(calibrated) / NINE_OF_TEN if calibrated else 0.0,
    )
