# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Law of asperity contact: where it begins on the raceways of a screw, and how it grows below.

The onset follows from the topography of each raceway. Over the speed by that of the onset, marched
strips of all spectra share one curve of RCS and, by pressure and lay, one line of rolling loss;
`studies/results/asperity_marches.csv` holds the onsets.

"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit, logit
from surrogate.asperities.running_in import RunningContact
from surrogate.asperities.topography_onset import onset_of, PRESSURE, TopographyOnset
from surrogate.ehl import Condition, ContactLubricant
from surrogate.formulas.geometry import Contact, Side
from surrogate.formulas.line import Line, line_at
from surrogate.raceway.stated import Roughness

Array = NDArray[np.float64]
ONSET_RCS = 0.01
"""RCS at the onset [-]."""
VERSION = 'topography 2'
"""Of the law, among what results that it decides are kept by."""
PLACES = 8
"""Places across a contact at which it is looked up [-]."""
NOTHING = 1e-7
"""RCS that counts as none [-]."""
SLOPE, BEND = -4.69, -1.09
"""Of the logit of RCS over the logarithm of the speed by that of the onset [-]."""
SLOWEST = -(1 + SLOPE) / (2 * BEND)
"""Logarithm of the speed by that of the onset below which what oil carries goes with the speed
[-]: there the slope of the logit reaches -1, at 0.18 of the onset."""
SHARE = 0.84, 0.16
"""Asperity share over RCS where RCS is small, and how it rises with RCS [-]."""
LOSS, LOSS_SLOPE = (1.28, 0.24, -0.20), (0.03, -0.25, 0.23)
"""Loss at the onset and its slope: usual, over the logarithm of the pressure, over the lay [-]."""
PRESSURES = 0.4e9, 1.5e9
"""Hertz pressures of the marches [Pa]."""
LEAST_LOSS = 0.75
"""Least rolling loss over that of a smooth contact [-]; 0.82 in the marches."""
LOSS_SLOWEST = -1.4
"""Logarithm of the speed by that of the onset below which the loss keeps its value [-]."""
SMOOTH_FROM, FADING = 1.4, 0.35
"""Logarithm of the speed by that of the onset at which half of the change of the loss is left,
and its width [-]."""
SOFT_SPEED, SOFT_LOSS = 0.25, 0.03
"""Widths of the bends to the slowest speed and to the least loss [-]."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(2 * PLACES)
BANDS = {'isotropic': 1.3, 'longitudinal': 2.0, 'transverse': 2.0}
"""Factor within which the topography tells nine of ten marched strips, by the lay [-]; seven of
the strips had a longitudinal lay, two a transverse one."""
NINE_OF_TEN = 1.645
"""Standard deviations on either side within which nine of ten lie [-]."""


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


AT_REST = AsperityContact(1.0, 1.0, 1.0, 0.0)
"""Asperities carry all of a load that does not move."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityLaw:
    """
    Onsets of contact on the raceways of a screw by their side.

    Standard `deviation` of the logarithm of the onset speed between law and marches [-].

    """

    onsets: Mapping[Side, TopographyOnset]
    deviation: float

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
        # As stated, and where the onset is off by half of its deviation either way.
        apart = np.exp(self.deviation * np.array([0.0, -0.5, 0.5]))
        speeds = condition.entrainment_speed * apart
        found = self.touching(side, contact, condition.load, oil, floor, speeds)
        (rcs, slower, faster), (share, *_), (loss, *_) = (values.tolist() for values in found)
        return AsperityContact(rcs, share, loss, rcs_deviation=slower - faster)

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
        share, strips, onset = self._strips(side, contact, load, oil, floor)
        with np.errstate(divide='ignore', invalid='ignore'):
            over = np.where(speeds > 0, np.log(speeds) - onset[:, None], -math.inf)
        rcs, loss = rcs_at(over), self._loss(side, over, strips.max_pressure[:, None])
        # Summed place by place, so that a speed does not depend on those beside it. The weights
        # add up to 1 but for rounding.
        rcs, carried, loss = (
            (share[:, None] * values).sum(axis=0) for values in (rcs, share_at(rcs), loss)
        )
        return np.minimum(rcs, 1.0), np.minimum(carried, 1.0), loss

    def _loss(self, side: Side, log_speed: Array, pressure: Array) -> Array:
        acting = self.onsets[side].acting
        return loss_at(log_speed, pressure, acting.lay if acting else 0.0)

    def _strips(
        self, side: Side, contact: Contact, load: float, oil: ContactLubricant, floor: float
    ) -> tuple[Array, Line, Array]:
        """Return strips across a contact: share of the load, line, logarithm of the onset."""
        place = _POINTS[PLACES:]
        share = 1.5 * _WEIGHTS[PLACES:] * (1 - place**2)
        strips = line_at(contact, load, place)
        # A smooth raceway has its onset at rest: as slow as a number can tell.
        onsets = np.maximum(self.onsets[side].speeds(strips, oil, floor), np.finfo(float).tiny)
        return share, strips, np.log(onsets)


def rcs_at(log_speed: ArrayLike) -> Array:
    """
    Return RCS at logarithms of the speed by that of the onset [-].

    Slower than marched the load that oil carries, over that of asperities, falls as the speed
    does. RCS below `NOTHING` is 0.

    """
    x = np.asarray(log_speed, dtype=float)
    known = np.maximum(x, SLOWEST)
    found = expit(logit(ONSET_RCS) + SLOPE * known + BEND * known**2 - np.minimum(x - SLOWEST, 0))
    return np.asarray(np.where(found < NOTHING, 0.0, found))


def share_at(rcs: Array) -> Array:
    """Return the share of the load that asperities carry at an RCS [-]."""
    return np.asarray(rcs * (SHARE[0] + SHARE[1] * rcs))


def loss_at(log_speed: Array, pressure: Array, lay: float) -> Array:
    """
    Return the rolling loss over that of a smooth contact [-].

    At logarithms of the speed by that of the onset [-], Hertz pressures [Pa] and a lay as
    `ActingRoughness` has it.

    """
    pressed = np.log(np.clip(pressure, *PRESSURES) / PRESSURE)
    at_onset, slope = (
        usual + over_pressure * pressed + over_lay * lay
        for usual, over_pressure, over_lay in (LOSS, LOSS_SLOPE)
    )
    return loss_along(at_onset, slope, log_speed)


def loss_along(at_onset: Array | float, slope: Array | float, log_speed: Array) -> Array:
    """
    Return the loss [-] of a value at the onset and a slope over the logarithm of the speed [-].

    The line bends to the value of `LOSS_SLOWEST` and to `LEAST_LOSS`; the faster, the less of it
    is left.

    """
    line = at_onset + slope * _above(log_speed, LOSS_SLOWEST, SOFT_SPEED)
    change = _above(line, LEAST_LOSS, SOFT_LOSS) - 1
    return np.asarray(1 + change * expit((SMOOTH_FROM - log_speed) / FADING))


def _above(values: Array, least: float, width: float) -> Array:
    """Return values [-] that bend smoothly to the least one, over a width [-]."""
    return np.asarray(least + width * np.logaddexp(0.0, (values - least) / width))


def law_of(contacts: Mapping[Side, RunningContact], sheet: Roughness) -> AsperityLaw:
    """
    Return the law of the raceways of a screw by their side.

    The onset factor and the calibration of the sheet act here alone. Raises InputError as
    `onset_of` does.

    """
    return AsperityLaw(
        onsets={
            side: replace(onset_of(contact), factor=sheet.onset_factor)
            for side, contact in contacts.items()
        },
        deviation=math.log(band_of(sheet)) / NINE_OF_TEN,
    )


def band_of(sheet: Roughness) -> float:
    """Return the factor within which nine of ten onsets lie [-], by calibration or marches."""
    return sheet.onset_band or BANDS[sheet.lay]
