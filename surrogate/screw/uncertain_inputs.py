# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs of a screw, its oil and its operating point, each with the range in which it may lie."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
import math
from typing import Any, Literal

from surrogate.formulas.geometry import Side
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.standards import long_cutoff_iso_21920, RA_OVER_RQ
from surrogate.raceway.stated import Roughness
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, run_in_at, side_onsets, with_raceway

Part = Literal['point', 'lubricant', 'screw', 'roughness']
Ends = tuple[float, float]
FLOORS = 'film_floor_low', 'film_floor_high'
APART = 1.05
"""Onset of one side over that of the other from which on other raceways keep the order [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewCase:
    """A screw with its oil at an operating point, and the side whose onset it has, if one."""

    screw: Screw
    lubricant: Lubricant
    point: OperatingPoint
    side: Side | None = None

    @property
    def roughness(self) -> Roughness:
        """Roughness of the raceway."""
        return self.screw.roughness

    def changed(self, part: Part, **values: float) -> 'ScrewCase':
        """Return a case with other values [SI] in a part, of both sides for oil and point."""
        if part == 'roughness':
            return replace(self, screw=with_raceway(self.screw, **values))
        side = self.side if part == 'screw' else None
        return replace(self, **{part: replace(getattr(self, part), **values)}, side=side)

    @property
    def faster_side(self) -> 'ScrewCase':
        """Case of the side where contact begins faster, `APART` or more: half of the work."""
        oil = oil_at(self.lubricant, self.point.temperature)
        floor, load = self.lubricant.film_floor, self.point.opposing_load
        sides = side_onsets(Contacts.of(self.screw), oil, floor, load)
        slower, faster = sorted(sides, key=sides.__getitem__)
        return replace(self, side=faster if sides[faster] > APART * sides[slower] else None)

    @property
    def onset(self) -> float:
        """Screw speed at which contact begins [rad/s]."""
        opened = Contacts.of(self.screw)
        place = self.point.opposing_load, self.point.temperature
        sides = opened.on_side(self.side) if self.side else opened
        return onset_point(sides, self.lubricant, *place)['speed_rad_s']


@dataclass(frozen=True, slots=True)
class Varied:
    """
    An input, a field of a part of a case, with the range in which it may lie.

    The `reason` of the range, and how the input is measured, empty for one that is in no band. The
    range is `times` below and above the stated value [-], or `plus` [SI], or `ends` say it [SI],
    None where a sheet has no such input. Fields that change `also`: to the value of an end, by the
    step of another range.

    """

    part: Part
    name: str
    reason: str
    measured: str = ''
    times: float = 1.0
    plus: float = 0.0
    ends: Callable[[ScrewCase], Ends | None] | None = None
    also: tuple[str, ...] = ()

    def stated(self, case: ScrewCase) -> float | None:
        """Return the stated value [SI], None where there is none."""
        value: float | None = getattr(getattr(case, self.part), self.name)
        return value

    def bounds(self, case: ScrewCase) -> Ends | None:
        """Return the ends [SI] within what a sheet may state, None where it has no such input."""
        value, ends = self.stated(case), self.ends(case) if self.ends is not None else None
        if self.ends is None and value:
            ends = value / self.times - self.plus, value * self.times + self.plus
        if ends is None:
            return None
        return self.within(case, self.name, ends[0]), self.within(case, self.name, ends[1])

    def rules(self, case: ScrewCase, name: str) -> Mapping[str, Any]:
        """Return what a sheet states of a field of the part: unit, factor, limits."""
        every = fields(getattr(case, self.part))
        return next(spec.metadata for spec in every if spec.name == name)

    def within(self, case: ScrewCase, name: str, value: float) -> float:
        """Return a value of a field of the part, or the next one that a sheet may state [SI]."""
        rules = self.rules(case, name)
        least, most = ((rules[end] + rules['shift']) * rules['factor'] for end in ('low', 'high'))
        return min(max(value, least), most)

    def at(self, case: ScrewCase, value: float) -> ScrewCase:
        """Return a case in which the input has a value [SI]."""
        if self.name in ('hardness', 'run_in_pressure'):
            # The same state, cut at another pressure: marches hold.
            marches = {name: getattr(case.roughness, name) for name in Roughness.MARCHED}
            return replace(case, screw=with_raceway(run_in_at(case.screw, value), **marches))
        if self.ends is not None:
            return case.changed(self.part, **dict.fromkeys((self.name, *self.also), value))
        part, step = getattr(case, self.part), value - (self.stated(case) or 0.0)
        moved = {name: self.within(case, name, getattr(part, name) + step) for name in self.also}
        return case.changed(self.part, **{self.name: value}, **moved)


def _heights(case: ScrewCase) -> Ends:
    """Return the likely Rq of a typical raceway, or that by which traces of one differ."""
    low, high = case.roughness.likely_rms
    if low is None or high is None:
        low, high = case.roughness.rms / 1.1, 1.1 * case.roughness.rms
    return low, high


def _floors(case: ScrewCase) -> Ends:
    return case.lubricant.film_floor_low, case.lubricant.film_floor_high


def _cutoffs(case: ScrewCase) -> Ends | None:
    """Return the neighbours of the long cut-off by the table, None where the sheet states it."""
    if case.roughness.cutoff_long is not None or not case.roughness.rms:
        return None
    middle = long_cutoff_iso_21920(RA_OVER_RQ * case.roughness.rms)
    return middle / math.sqrt(10), middle * math.sqrt(10)


def _runs_in(case: ScrewCase) -> bool:
    return (case.roughness.state, case.roughness.traced) == ('run_in', 'new')


def _pressures(case: ScrewCase) -> Ends | None:
    """Return the pressures from the lowest of running in up to none of it."""
    return (case.roughness.run_in_low, case.roughness.hardness) if _runs_in(case) else None


def _hardness(case: ScrewCase) -> Ends | None:
    """Return softer and harder steel, None where running in cuts the summits."""
    hardness = case.roughness.hardness
    return None if _runs_in(case) else (hardness / 1.15, 1.15 * hardness)


def _working_loads(case: ScrewCase) -> Ends | None:
    """Return half and double of the largest working load, None where no summits ran in."""
    load = Contacts.of(case.screw).working_load
    return (0.5 * load, 2.0 * load) if _runs_in(case) else None


SENSOR, SAMPLE = 'oil temperature at the nut', 'viscosity of a sample of the oil'
TRACE, RUN = 'trace of the raceway as it runs', 'film floor by torque at slow speeds'
"""Measurements; the last finds what no gauge tells, boundary film and supply of oil. A fit of the
onset itself to such a torque takes the place of all of them, with an interval of its own."""
INPUTS = (
    Varied('point', 'temperature', '5 K from sensor to contact', SENSOR, plus=5.0),
    Varied('lubricant', 'viscosity', 'width of an ISO 3448 grade', SAMPLE, times=1.1),
    Varied('lubricant', 'film_floor', 'range of the oil sheet', RUN, ends=_floors, also=FLOORS),
    Varied('lubricant', 'film_factor', 'grease or little oil leave 0.7', RUN, times=1 / 0.7),
    Varied('roughness', 'rms', 'its range, or traces differ by 10 %', TRACE, ends=_heights),
    Varied('roughness', 'fractal_dimension', 'fits to traces differ by 0.1', TRACE, plus=0.1),
    Varied('roughness', 'rms_slope', 'traces of a raceway differ by 20 %', TRACE, times=1.2),
    Varied('roughness', 'cutoff_long', 'not stated: rows beside it', TRACE, ends=_cutoffs),
    Varied('roughness', 'run_in_pressure', 'lowest, to not run in', TRACE, ends=_pressures),
    Varied('screw', 'working_load', 'half and double, in no band', ends=_working_loads),
    Varied('roughness', 'hardness', '58 to 64 HRC, in no band', ends=_hardness),
    Varied('screw', 'preload', 'setting and wear, in no band', times=1.2),
    Varied(
        'screw', 'conformity_screw', 'grinding, in no band', plus=0.01, also=('conformity_nut',)
    ),
    Varied('roughness', 'cutoff_short', 'scatter of tiles, in no band', times=2.0),
)
"""
Inputs with their ranges: those of the sheets if they state any, else a usual spread.

Those in no band move the onset by less than a fifth, or have no measurement.

"""
