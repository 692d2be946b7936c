# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fatigue damage of a screw by the loads that it has borne, by ISO 3408-5 and Palmgren.

The spectrum knows loads against the motion and not which nut they press. Damage counts as if one
nut were always the pressed one, which is the most; loads that change nuts use up to 7 % less.

"""

from collections.abc import Iterable, Mapping
import dataclasses
import math
from typing import Any, TypeVar

from ballscrew_monitor.health.records import Cell, SpectrumBin
from surrogate.files import InputError
from surrogate.formulas.life import (
    combined_damage,
    damage_palmgren_1924,
    nut_forces_iso_3408_2006,
    SLOPE,
)
from surrogate.units import TURN

NAN = math.nan
Item = TypeVar('Item', SpectrumBin, Cell)
WITHIN_BAND = 1.13
"""Largest mean cube of loads in a band, whose ends differ by 1.5, over the cube of their mean."""
SHARED_LEAST = 2.0 ** (1 / SLOPE - 1)
"""Damage of two nuts that take turns over that of one nut that is always pressed [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Rated:
    """Dynamic rating of one nut, static rating and preload [N], pitch diameter [m]."""

    dynamic_rating: float
    static_rating: float
    preload: float
    pitch_diameter: float

    def __post_init__(self) -> None:
        """Refuse ratings that are not above zero."""
        above = ('dynamic_rating', 'N'), ('static_rating', 'N'), ('pitch_diameter', 'm')
        for name, unit in above:
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise InputError(f'life: {name} is {value:g} {unit}, allowed is above 0')
        if not 0.0 <= self.preload < math.inf:
            raise InputError(f'life: preload is {self.preload:g} N, allowed is at least 0')


@dataclasses.dataclass(frozen=True, slots=True)
class Damage:
    """Share of the nominal life that is used up [-], least and most; turns [rev], time [s]."""

    value: float
    low: float
    high: float
    turns: float
    time: float
    known: float

    def scaled(self, factor: float) -> tuple[float, float, float]:
        """Return value, least and most times a factor."""
        return self.value * factor, self.low * factor, self.high * factor


def rated_of(header: Mapping[str, Any], preload_share: float = 1.0) -> Rated | None:
    """
    Return the ratings that the header of a surface states; None without a dynamic rating.

    `preload_share` is what is left of the preload of the sheet [-].

    """
    screw, rating = header['inputs']['screw'], header.get('service', {}).get('dynamic_rating')
    if rating is None:
        return None
    return Rated(
        dynamic_rating=float(rating),
        static_rating=float(screw['static_rating']),
        preload=preload_share * float(screw['preload']),
        pitch_diameter=2 * float(screw['pitch_radius']),
    )


def recent(items: Iterable[Item], today: int, days: int) -> list[Item]:
    """Return bins or points whose period reaches into the last days, `today` counted."""
    return [one for one in items if one.first_day + one.days > today - days + 1]


def damage_of(bins: Iterable[SpectrumBin], rated: Rated, load_uncertainty: float) -> Damage:
    """
    Return what bins of motion have used up.

    Motion under an unknown load counts as the other; between none and the largest of the others.

    """
    bins = list(bins)
    loads = [
        (abs(one.axial_load), one.angle / TURN) for one in bins if math.isfinite(one.axial_load)
    ]
    turns, time = sum(one.angle for one in bins) / TURN, sum(one.time for one in bins)
    seen = sum(count for _, count in loads)
    largest = max((load for load, _ in loads), default=0.0)
    unseen = max(turns - seen, 0.0)
    more, less = 1 + load_uncertainty, 1 - load_uncertainty
    value = combined_damage(*_both_nuts(loads, rated)) * (turns / seen if seen else NAN)
    low = sum(_both_nuts([*_times(loads, less), (0.0, unseen)], rated)) * SHARED_LEAST
    high = combined_damage(*_both_nuts(_times([*loads, (largest, unseen)], more), rated))
    # One band is as wide as the widest; loads within the preload vary less.
    return Damage(value, low, high * WITHIN_BAND, turns, time, seen / turns if turns else 0.0)


def _both_nuts(loads: Iterable[tuple[float, float]], rated: Rated) -> tuple[float, float]:
    """Return the damage of the pressed and of the relieved nut under loads [N] and turns."""
    forces = [(*nut_forces_iso_3408_2006(load, rated.preload), turns) for load, turns in loads]
    rating = rated.dynamic_rating
    return (
        damage_palmgren_1924(((pressed, turns) for pressed, _, turns in forces), rating),
        damage_palmgren_1924(((relieved, turns) for _, relieved, turns in forces), rating),
    )


def _times(loads: Iterable[tuple[float, float]], factor: float) -> list[tuple[float, float]]:
    return [(load * factor, turns) for load, turns in loads]
