# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Oil and lubrication that would bring a programme into its zone: temperature, grade, film, speed.

A surface is of one oil. Another grade is as viscous at the temperature of the machine as this oil
is at another one, where the surface is asked. A film that is f times as thick is that of a speed
f^(1/0.67) times as high, of which RCS alone is asked. An advice on speed is given where the axis
allows it, since a process may set the feed.

"""

from collections.abc import Sequence
import dataclasses
import math

from ballscrew_monitor.core.advice import Advisor
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.lubrication import opposed
from ballscrew_monitor.health.records import Cell
from surrogate.formulas.grades import equivalent_temperature, ISO_VG
from surrogate.surface import Surface, Validity
from surrogate.units import MICRO, MINUTE, TURN, ZERO_CELSIUS

NAN = math.nan
AIMED = 0.9
"""Share of the time of a programme that a remedy brings into the zone [-]."""
MOST_POINTS = 60
"""Points of a programme that are asked, those with most time first."""
FILM_EXPONENT = 0.67
"""Exponent of the speed in the film of a point contact, Hamrock and Dowson (1977) [-]."""

Place = tuple[float, float, float]
"""Speed |w| [rad/s], opposing load [N], temperature [K]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Remedy:
    """
    What of one kind would bring most of a programme into the zone.

    `kind` is temperature [degC], grade [mm2/s], film factor [-] or feed [m/min]; `value` the
    nearest that does, NaN for none; `share` of the time inside with it [-]; `reason` why none.

    """

    kind: str
    value: float = NAN
    share: float = NAN
    reason: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Remedies:
    """Share of the time inside the zone as it is [-], and what would change it."""

    share: float
    remedies: Sequence[Remedy] = ()

    @property
    def text(self) -> str:
        """Return the advice as a sentence, empty where nothing has to be done or would help."""
        helpful = [_WORDS[one.kind].format(one.value) for one in self.remedies if _helps(one)]
        if math.isnan(self.share) or self.share >= AIMED or not helpful:
            return ''
        return (
            f'{100 * self.share:.0f} % of the motion lies in the zone; at least '
            f'{100 * AIMED:.0f} % would with {" or with ".join(helpful)}'
        )


_WORDS = {
    'temperature': 'an oil temperature of {:.0f} degC',
    'grade': 'ISO VG {:.0f} at this temperature',
    'film factor': 'a film factor of {:.2f} (more oil or grease at the contact)',
    'feed': 'feeds of {:.3g} m/min and more',
}


def remedies_of(
    points: Sequence[Cell], surface: Surface, limits: Limits, *, speed_allowed: bool = False
) -> Remedies:
    """
    Return what would bring the points of a programme into the zone.

    The share is NaN without a point that the surface knows. `speed_allowed`: the axis is free in
    its speed.

    """
    kept = sorted(points, key=lambda one: one.duration, reverse=True)[:MOST_POINTS]
    programme = Programme(surface, limits, kept)
    share = programme.share()
    if math.isnan(share) or share >= AIMED:
        return Remedies(share=share)
    found = [_temperature(programme), _grade(programme), _film(programme)]
    if speed_allowed:
        found.append(_feed(programme))
    return Remedies(share=share, remedies=found)


@dataclasses.dataclass(frozen=True, slots=True)
class Programme:
    """Points that are asked on a surface, and what they are held against."""

    surface: Surface
    limits: Limits
    points: Sequence[Cell]

    @property
    def temperature(self) -> float:
        """Mean temperature over the time [K]."""
        time = sum(one.duration for one in self.points)
        return sum(one.temperature * one.duration for one in self.points) / time

    def share(
        self,
        *,
        warmer: float = 0.0,
        temperature_ratio: float = 1.0,
        faster: float = 1.0,
        slowest: float = 0.0,
        efficiency: bool = True,
    ) -> float:
        """
        Return the share of the time inside the zone [-], NaN where less than half is known.

        Points are `warmer` [K], at temperatures and speeds of other ratios [-], none slower than
        `slowest` [rad/s]; without `efficiency` RCS alone is asked.

        """
        inside = known = 0.0
        for one in self.points:
            speed, load, temperature = place_of(one)
            place = max(speed * faster, slowest), load, temperature * temperature_ratio + warmer
            good = self.is_inside(place, efficiency=efficiency)
            if good is not None:
                known += one.duration
                inside += one.duration * good
        time = sum(one.duration for one in self.points)
        return inside / known if known > 0.5 * time else NAN

    def is_inside(self, place: Place, *, efficiency: bool = True) -> bool | None:
        """Tell whether a place lies in the zone; None where the surface has no number."""
        found = self.surface.lookup(*place)
        if found.validity is not Validity.VALID:
            return None
        light = abs(place[1]) < self.limits.light_load
        fit = light or not efficiency or found.efficiency >= self.limits.efficiency
        return found.rcs < self.limits.rcs and fit


def place_of(point: Cell) -> Place:
    """Return where a point lies on a surface."""
    return abs(point.speed), opposed(point), point.temperature


def _temperature(programme: Programme) -> Remedy:
    """Return the nearest whole degree that helps; all points are shifted alike."""
    here, (low, high) = programme.temperature, programme.surface.temperature_range
    degrees = range(math.ceil(low - ZERO_CELSIUS), math.floor(high - ZERO_CELSIUS) + 1)
    for degree in sorted(degrees, key=lambda one: abs(one + ZERO_CELSIUS - here)):
        share = programme.share(warmer=degree + ZERO_CELSIUS - here)
        if share >= AIMED:
            return Remedy(kind='temperature', value=float(degree), share=share)
    text = f'no temperature of the surface, {degrees[0]} to {degrees[-1]} degC, would'
    return Remedy(kind='temperature', reason=text)


def _grade(programme: Programme) -> Remedy:
    """Return the grade next to that of the oil that helps."""
    oil = programme.surface.header['inputs']['lubricant']
    try:
        at_40, at_100 = (float(oil[f'kinematic_viscosity_{at}']) for at in (40, 100))
    except KeyError:
        return Remedy(kind='grade', reason='not known: the surface does not state its oil')
    for grade in sorted(ISO_VG, key=lambda one: abs(math.log(one / (MICRO * at_40)))):
        ratio = equivalent_temperature(1.0, grade / MICRO, at_40, at_100)
        share = programme.share(temperature_ratio=ratio)
        if share >= AIMED:
            return Remedy(kind='grade', value=float(grade), share=share)
    return Remedy(kind='grade', reason='no grade that the surface can tell would')


def _film(programme: Programme) -> Remedy:
    """Return the film factor of oil in plenty if the sheet states less, and it helps."""
    factor = float(programme.surface.header['inputs']['lubricant'].get('film_factor', 1.0))
    if factor >= 1.0:
        return Remedy(kind='film factor', reason='the sheet of the oil states oil in plenty')
    faster = (1.0 / factor) ** (1.0 / FILM_EXPONENT)
    share = programme.share(faster=faster, efficiency=False)
    if share >= AIMED:
        return Remedy(kind='film factor', value=1.0, share=share)
    return Remedy(kind='film factor', reason='oil in plenty would not')


def _feed(programme: Programme) -> Remedy:
    """Return the slowest feed at which the programme lies inside, slower points raised to it."""
    advisors = (
        Advisor(
            speed=one.speed,
            axial_load=one.axial_load,
            temperature=one.temperature,
            direction=Direction.POSITIVE if one.direction > 0 else Direction.NEGATIVE,
            surface=programme.surface,
            limits=programme.limits,
            speed_allowed=True,
        )
        for one in programme.points
    )
    nearest = {abs(one.target_speed) for one in advisors}
    for speed in sorted(filter(math.isfinite, nearest)):
        share = programme.share(slowest=speed)
        if share >= AIMED:
            feed = speed * programme.surface.lead / TURN * MINUTE
            return Remedy(kind='feed', value=feed, share=share)
    return Remedy(kind='feed', reason='no feed of the surface would')


def _helps(one: Remedy) -> bool:
    return math.isfinite(one.value)
