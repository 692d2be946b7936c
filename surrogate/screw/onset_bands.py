# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The one band of an onset: by what is not known of screw and oil, and by the numerics.

Build, points, the command `onset` and the sensitivity have it from here. All causes are
independent, so the logarithms of their factors add up as squares, each side for itself.

"""

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from surrogate.asperities.law import FILM_POWER, SLOPE
from surrogate.files import InputError
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import law_band
from surrogate.screw.uncertain_inputs import Ends, INPUTS, ScrewCase, Varied
from surrogate.surface.aims import RCS_RELATIVE_TOLERANCE
from surrogate.surface.lookup import both_bands

INTERPOLATION = RCS_RELATIVE_TOLERANCE / (-SLOPE * FILM_POWER)
"""Logarithm of the speed by which a surface may be off at the limit of RCS [-]."""
Measured = Sequence[tuple[str, Sequence[float]]]
"""How inputs are measured, and the onset at both ends of each over the stated one [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class OnsetBands:
    """
    Least and largest onset speed over the stated one [-].

    By what is `unknown`, by the `numerics` of law and lookup, and what measurements leave of the
    former, in the order in which they narrow it.

    """

    unknown: Ends
    numerics: Ends
    measure: tuple[tuple[str, Ends], ...] = ()

    @property
    def whole(self) -> Ends:
        """Band by both."""
        return both_bands(self.unknown, self.numerics)

    @property
    def narrowed(self) -> tuple[str, Ends] | None:
        """Measurement that narrows it most, with the band by both that is left, None for none."""
        for name, left in self.measure:
            return name, both_bands(left, self.numerics)
        return None

    def record(self) -> dict[str, Any]:
        """Return the bands as plain data, as the header of a surface has them."""
        return {
            'limit_band': list(self.unknown),
            'numerical_band': list(self.numerics),
            'measure': [
                {'measurement': name, 'limit_band': [*left]} for name, left in self.measure
            ],
        }


def onset_bands(screw: Screw, lubricant: Lubricant, load: float, temperature: float) -> OnsetBands:
    """
    Return the bands of an onset under a load [N] at a temperature [K], seconds for new raceways.

    A calibrated onset has the band of its calibration.

    """
    point = OperatingPoint(speed=0.0, load=load, temperature=temperature)
    case = ScrewCase(screw=screw, lubricant=lubricant, point=point).faster_side
    measured = (
        [] if screw.roughness.onset_band else [varied for varied in INPUTS if varied.measured]
    )
    return bands_of(case, onset_factors(case, measured))


def bands_of(case: ScrewCase, factors: Measured) -> OnsetBands:
    """Return the bands of a case by the factors of its inputs, of those `measured` alone."""
    if not case.onset:
        return OnsetBands(unknown=(1.0, 1.0), numerics=(1.0, 1.0))
    calibrated, known = case.roughness.onset_band, [each for each in factors if each[0]]
    if calibrated:
        return OnsetBands(unknown=(1 / calibrated, calibrated), numerics=numerical_band(case))
    return OnsetBands(
        unknown=unknown_band(known), numerics=numerical_band(case), measure=_narrowed(known)
    )


def onset_factors(case: ScrewCase, inputs: Iterable[Varied]) -> Measured:
    """Return the onsets at both ends of inputs; NaN at an end that the model refuses."""
    stated = case.onset or math.nan
    with ThreadPoolExecutor() as threads:  # each end may be another raceway, a second or two
        speeds = [
            (varied.measured, [threads.submit(_onset, varied, case, end) for end in ends])
            for varied in inputs
            if (ends := varied.bounds(case))
        ]
    return [(name, [speed.result() / stated for speed in both]) for name, both in speeds]


def _onset(varied: Varied, case: ScrewCase, value: float) -> float:
    try:
        return varied.at(case, value).onset
    except InputError:
        return math.nan


def unknown_band(factors: Measured, *measured: str) -> Ends:
    """Return the band of inputs of which some are `measured`; NaN where one is not known."""
    left = [ends for name, ends in factors if name not in measured]
    logs = np.log(np.reshape(left, (-1, 2)))
    low, high = np.minimum(logs.min(axis=1), 0.0), np.maximum(logs.max(axis=1), 0.0)
    return (
        math.exp(-np.hypot.reduce(low, initial=0.0)),
        math.exp(np.hypot.reduce(high, initial=0.0)),
    )


def _narrowed(factors: Measured) -> tuple[tuple[str, Ends], ...]:
    """Return the measurement that narrows the band most, then the next, with what is left."""
    done: dict[str, Ends] = {}
    for _ in range(2):
        names = {name for name, _ in factors} - {*done}
        left = {name: unknown_band(factors, *done, name) for name in sorted(names)}
        if left:
            best = min(left, key=lambda name: spread(left[name]))
            done[best] = left[best]
    return tuple(done.items())


def spread(factors: Sequence[float]) -> float:
    """Return how far the onset moves between the ends, as a logarithm [-]; a NaN is most."""
    logs = np.log([*factors, 1.0])
    return float(np.nan_to_num(logs.max() - logs.min(), nan=math.inf))


def numerical_band(case: ScrewCase) -> Ends:
    """
    Return the band by law and lookup [-].

    Nine of ten marched strips lie within that of the law, which a calibration takes out.

    """
    place = case.lubricant, case.point.opposing_load, case.point.temperature
    law: Mapping[str, Any] = {'band': (1.0, 1.0)}
    if not case.roughness.onset_band:
        law = law_band(Contacts.of(case.screw), *place)
    return both_bands(law['band'], (math.exp(-INTERPOLATION), math.exp(INTERPOLATION)))
