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

from ballscrew_monitor.core.advice import advised_speed
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.lubrication import opposed
from ballscrew_monitor.health.records import Cell
from surrogate.formulas.grades import equivalent_temperature, ISO_VG
from surrogate.surface import Surface, Validity
from surrogate.units import MICRO, MINUTE, TURN, ZERO_CELSIUS

AIMED = 0.9  # share of the time of a programme that a remedy brings into the zone [-]
MOST_POINTS = 60  # points of a programme that are asked, those with most time first
FILM_EXPONENT = 0.67
"""Exponent of the speed in the film of a point contact, Hamrock and Dowson (1977) [-]."""

WORDS = {
    'temperature': 'an oil temperature of {:.0f} degC',
    'grade': 'ISO VG {:.0f} at this temperature',
    'film factor': 'a film factor of {:.2f} (more oil or grease at the contact)',
    'feed': 'feeds of {:.3g} m/min and more',
}


def remedy_text(
    points: Sequence[Cell], surface: Surface, limits: Limits, *, speed_allowed: bool = False
) -> str:
    """
    Return in a sentence what would bring the points of a programme into the zone.

    Empty where they are, where nothing helps, and without a point that the surface knows.
    `speed_allowed`: the axis is free in its speed.

    """
    kept = sorted(points, key=lambda point: point.duration, reverse=True)[:MOST_POINTS]
    programme = Programme(surface, limits, kept)
    share = programme.share()
    if math.isnan(share) or share >= AIMED:
        return ''
    remedies = remedies_of(programme, speed_allowed=speed_allowed)
    if not remedies:
        return ''
    helpful = (WORDS[kind].format(value) for kind, value in remedies.items())
    return (
        f'{100 * share:.0f} % of the motion lies in the zone; at least {100 * AIMED:.0f} % would '
        f'with {" or with ".join(helpful)}'
    )


@dataclasses.dataclass(frozen=True, slots=True)
class Programme:
    """Points that are asked on a surface, and what they are held against."""

    surface: Surface
    limits: Limits
    points: Sequence[Cell]

    @property
    def temperature(self) -> float:
        """Mean temperature over the time [K]."""
        time = sum(point.duration for point in self.points)
        return sum(point.temperature * point.duration for point in self.points) / time

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
        for point in self.points:
            speed, load = max(abs(point.speed) * faster, slowest), opposed(point)
            temperature = point.temperature * temperature_ratio + warmer
            state = self.surface.lookup(speed, load, temperature)
            if state.validity is Validity.VALID:
                light = not efficiency or abs(load) < self.limits.light_load
                good = light or state.efficiency >= self.limits.efficiency
                known += point.duration
                inside += point.duration * (state.rcs < self.limits.rcs and good)
        time = sum(point.duration for point in self.points)
        return inside / known if known > 0.5 * time else math.nan


def remedies_of(programme: Programme, *, speed_allowed: bool = False) -> dict[str, float]:
    """
    Return the nearest values that bring most of a programme into the zone, by their kind.

    temperature [degC], grade [mm2/s], film factor [-] and, where `speed_allowed`, feed [m/min].

    """
    remedies: dict[str, float] = {}
    surface, oil = programme.surface, programme.surface.header['inputs']['lubricant']
    here, (low, high) = programme.temperature, surface.temperature_range
    degrees = range(math.ceil(low - ZERO_CELSIUS), math.floor(high - ZERO_CELSIUS) + 1)
    for degree in sorted(degrees, key=lambda each: abs(each + ZERO_CELSIUS - here)):
        if programme.share(warmer=degree + ZERO_CELSIUS - here) >= AIMED:
            remedies['temperature'] = float(degree)
            break
    if {'kinematic_viscosity_40', 'kinematic_viscosity_100'} <= oil.keys():
        at_40, at_100 = (float(oil[f'kinematic_viscosity_{at}']) for at in (40, 100))
        for grade in sorted(ISO_VG, key=lambda each: abs(math.log(each / (MICRO * at_40)))):
            ratio = equivalent_temperature(1.0, grade / MICRO, at_40, at_100)
            if programme.share(temperature_ratio=ratio) >= AIMED:
                remedies['grade'] = float(grade)
                break
    factor = float(oil.get('film_factor', 1.0))
    faster = (1.0 / factor) ** (1.0 / FILM_EXPONENT)
    if factor < 1.0 and programme.share(faster=faster, efficiency=False) >= AIMED:
        remedies['film factor'] = 1.0
    if not speed_allowed:
        return remedies
    # The slowest feed at which the programme lies inside, slower points raised to it.
    nearest = {
        abs(
            advised_speed(
                surface,
                programme.limits,
                speed=point.speed,
                axial_load=point.axial_load,
                temperature=point.temperature,
                direction=Direction.POSITIVE if point.direction > 0 else Direction.NEGATIVE,
            )
        )
        for point in programme.points
    }
    for speed in sorted(filter(math.isfinite, nearest)):
        if programme.share(slowest=speed) >= AIMED:
            remedies['feed'] = speed * surface.lead / TURN * MINUTE
            break
    return remedies
