# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of contact on a screw, the fastest speed it allows, and whether a zone is left between.

One sentence says it, of a surface or of the sheets: without a load, at one oil temperature. Where
there is no optimal zone, it says which oil, temperature or roughness would make contact begin
slower: the speed of the onset goes with one over the viscosity and with a power of Rq.

"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.aims import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT
from surrogate.surface.batch import look_up_many
from surrogate.surface.lookup import Surface
from surrogate.units import MICRO, MINUTE, RPM, TURN, ZERO_CELSIUS

Array = NDArray[np.float64]
NAN = math.nan
SPEEDS, LOADS = 60, 41
"""Places of a grid on which a zone is looked for."""
TEMPERATURES, HALVINGS = 12, 8
"""Colder temperatures that are tried, and halvings of the step that finds a zone."""
WORST = 1.2
"""Speed at which the worst contact begins over that of the loaded nut, at most [-]."""
RMS_POWER = 0.7
"""Exponent of the speed of the onset in the Rq that has it [-]."""
MARCHED_RMS = 0.05e-6, 0.4e-6
"""Rq of the raceways that were marched [m]."""
MARCHED = 'marched on this raceway: '
"""What stands before an onset by strips of the very raceway."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ZoneLimits:
    """RCS and efficiency [-] that bound the zone, and the load [N] below which RCS alone does."""

    rcs: float
    efficiency: float
    light_load: float

    @property
    def of_film(self) -> 'ZoneLimits':
        """Return the limit of RCS alone."""
        return replace(self, efficiency=-math.inf)

    def has_zone(self, rcs: Array, efficiency: Array, load: Array) -> bool:
        """Return True if one of some points, opposing loads [N], is optimal; NaN is not."""
        fit = (efficiency >= self.efficiency) | (np.abs(load) < self.light_load)
        return bool(np.any((rcs < self.rcs) & fit))


def usual_limits(preload: float) -> ZoneLimits:
    """Return the limits of a zone unless others are stated; preload [N]."""
    return ZoneLimits(rcs=RCS_LIMIT, efficiency=EFFICIENCY_LIMIT, light_load=LIGHT_LOAD * preload)


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactOnset:
    """
    Speed [rad/s] at which contact begins without a load at a temperature [K], 0 if it never does.

    `band`: between which factors of it that lies, NaN where not known, and between which if that
    was measured which narrows it most, by name and band, None where nothing does; `fastest`, the
    speed that the screw allows, and up to which a zone is looked for, `reach` [rad/s]. Without a
    zone contact must begin `slower`, a factor [-], as it does at `colder` [K], NaN if at no
    temperature in question. Viscosity at 40 degC [m2/s], lead [m], Rq of the raceway [m], its
    likely ends if not measured, and whether its onset is `calibrated`, or `marched` on strips of
    it.

    """

    speed: float
    temperature: float
    band: tuple[float, float] = (NAN, NAN)
    measure: tuple[str, tuple[float, float]] | None = None
    fastest: float
    reach: float
    oil: str
    zone: bool
    slower: float = NAN
    colder: float = NAN
    viscosity: float
    rms: float
    likely_rms: Sequence[float | None] = ()
    calibrated: bool = False
    marched: bool = False
    lead: float

    def sentence(self, *, as_feed: bool = False) -> str:
        """Return all of it; `as_feed` in m/min first, as an axis moves, beside rev/min."""
        begins = 'Contact never begins, for raceway and balls are smooth'
        if self.speed:
            between = ''
            if math.isfinite(self.band[0]):
                between = f' ({self._between(self.band)}{self._remedy()})'
            begins = (
                f'{MARCHED * self.marched}contact begins at {self._speed(self.speed, as_feed)}'
                f'{between} at {self.temperature - ZERO_CELSIUS:.3g} degC'
            )
            begins = begins[0].upper() + begins[1:]
            law = law_doubt(
                rms=self.rms, likely_rms=self.likely_rms, measured=self.calibrated or self.marched
            )
            begins += f'; {law}' * bool(law)
        limit = self._speed(self.fastest, as_feed)
        return f"{begins}; this screw's limit is {limit}; {self._zone(as_feed)}"

    def record(self) -> dict[str, Any]:
        """Return the sentence and its speeds [rad/s] as plain data."""
        return {
            'sentence': f'{self.sentence()}.',
            'speed_rad_s': self.speed,
            'speed_range_rad_s': [factor * self.speed for factor in self.band],
            'measure': self.measure and self.measure[0],
            'measured_range_rad_s': self.measure
            and [factor * self.speed for factor in self.measure[1]],
            'fastest_speed_rad_s': self.fastest,
            'temperature_K': self.temperature,
            'optimal_zone': self.zone,
        }

    def _between(self, band: tuple[float, float]) -> str:
        return ' to '.join(_rounded(factor * self.speed / RPM) for factor in band)

    def _remedy(self) -> str:
        """Say what a measurement leaves of the band."""
        if self.measure is None:
            return ' by its calibration' if self.calibrated else ''
        name, left = self.measure
        return f'; a measured {name} leaves {self._between(left)}'

    def _speed(self, speed: float, as_feed: bool) -> str:
        turns = f'{_rounded(speed / RPM)} rev/min'
        feed = _rounded(speed * self.lead / TURN * MINUTE)
        return f'{feed} m/min, {turns}' if as_feed else turns

    def _zone(self, as_feed: bool) -> str:
        if self.zone:
            return f'in {self.oil} there is an optimal zone'
        text = f'in {self.oil} there is no optimal zone'
        if self.reach < (1 - 1e-6) * self.fastest:
            text += f' up to {self._speed(self.reach, as_feed)}, where the surface ends'
        if not math.isfinite(self.slower):
            return f'{text}: where no contact is, friction takes too much; lower the preload'
        thicker = self.slower * self.viscosity * MICRO
        ways = [
            f'with oil of {_rounded(thicker)} mm2/s at 40 degC '
            f'(now {_rounded(self.viscosity * MICRO)})'
        ]
        if math.isfinite(self.colder):
            ways.append(f'below {self.colder - ZERO_CELSIUS:.3g} degC')
        if self.rms:
            smoother = self.rms / self.slower**RMS_POWER * MICRO
            ways.append(f'with Rq {smoother:.2g} um (now {self.rms * MICRO:.2g})')
        remedies = f'{", ".join(ways[:-1])} or {ways[-1]}' if ways[1:] else ways[0]
        return f'{text}: contact begins slow enough {remedies}'


def law_doubt(
    *, rms: float, likely_rms: Sequence[float | None] = (), measured: bool = False
) -> str:
    """
    Say where the law of the onset is beyond the marches; empty where it is not.

    Rq [m] as the sheet has it, 0 if smooth, with its lowest and highest likely value if not
    measured; what was measured or marched on the raceway itself takes the place of other marches.

    """
    low, high = MARCHED_RMS
    heights = [height for height in (rms, *likely_rms) if height]
    if measured or not rms or low <= min(heights) <= max(heights) <= high:
        return ''
    if low <= rms <= high:
        return (
            f'the likely Rq, {MICRO * min(heights):.3g} to {MICRO * max(heights):.3g} um, reaches '
            f'beyond the {MICRO * low:g} to {MICRO * high:g} um that were marched'
        )
    return (
        f'Rq is {MICRO * rms:.3g} um, and raceways of {MICRO * low:g} to {MICRO * high:g} um were '
        'marched: beyond them nobody knows how far the law is off'
    )


def contact_onset(
    *,
    onset: Callable[[float], float],
    has_zone: Callable[[float], bool],
    has_film: Callable[[float], bool],
    temperature: float,
    coldest: float,
    reach: float,
    **known: Any,
) -> ContactOnset:
    """
    Return where contact begins at a temperature [K], and what would give a zone if there is none.

    `onset` gives the speed [rad/s] at a temperature; `has_zone` and `has_film` tell whether any
    point is optimal there, and whether any keeps the limit of RCS. `known` are more fields.

    """
    speed, zone = onset(temperature), has_zone(temperature)
    slower = colder = NAN
    if not zone and not has_film(temperature):
        places: list[float] = np.linspace(temperature, coldest, TEMPERATURES + 1).tolist()
        warmer, heat = next(
            (pair for pair in zip(places, places[1:]) if has_zone(pair[1])), (NAN, NAN)
        )
        for _ in range(HALVINGS if math.isfinite(heat) else 0):
            middle = 0.5 * (warmer + heat)
            warmer, heat = (warmer, middle) if has_zone(middle) else (middle, heat)
        colder = heat  # the warmest that has a zone
        slower = speed / onset(colder) if math.isfinite(colder) else WORST * speed / reach
    return ContactOnset(
        speed=speed,
        temperature=temperature,
        zone=zone,
        slower=slower,
        colder=colder,
        reach=reach,
        **known,
    )


def onset_of_surface(
    surface: Surface, temperature: float | None = None, limits: ZoneLimits | None = None
) -> ContactOnset:
    """
    Return what a surface says of contact at a temperature [K] of the oil, by what its file holds.

    By default at the temperature of the oil sheet; at the nearest one that the surface covers.

    """
    (coldest, warmest), inputs = surface.temperature_range, surface.header['inputs']
    screw, oil = inputs['screw'], inputs['lubricant']
    wanted = surface.reference_temperature if temperature is None else temperature
    limits = limits or usual_limits(surface.preload)
    fastest = screw['speed_limit'] / (2 * screw['pitch_radius'])
    reach = min(fastest, surface.speed_range[1])
    grid = surface, surface.speed_range[0], reach
    return contact_onset(
        onset=lambda heat: surface.onset_speed(0.0, heat),
        has_zone=lambda heat: _has(*grid, heat, limits),
        has_film=lambda heat: _has(*grid, heat, limits.of_film),
        temperature=min(max(wanted, coldest), warmest),
        coldest=coldest,
        reach=reach,
        band=surface.onset_band,
        measure=surface.onset_measure,
        fastest=fastest,
        oil=surface.oil_name,
        viscosity=oil['kinematic_viscosity_40'],
        rms=screw['roughness']['rms'],
        likely_rms=(screw['roughness'].get('rms_low'), screw['roughness'].get('rms_high')),
        calibrated=screw['roughness']['onset_band'] is not None,
        marched=screw['roughness'].get('marched_film') is not None,
        lead=surface.lead,
    )


def _has(
    surface: Surface, slowest: float, fastest: float, temperature: float, limits: ZoneLimits
) -> bool:
    speeds, loads = grid_of((slowest, fastest), surface.load_range)
    rows = look_up_many(surface, speeds, loads, np.full(speeds.size, temperature))
    return limits.has_zone(rows['rcs'], rows['efficiency'], loads)


def grid_of(speeds: tuple[float, float], loads: tuple[float, float]) -> tuple[Array, Array]:
    """Return speeds [rad/s] and loads [N] of the points among which a zone is looked for."""
    across, up = np.meshgrid(np.geomspace(*speeds, SPEEDS), np.linspace(*loads, LOADS))
    return across.ravel(), up.ravel()


def _rounded(value: float) -> str:
    """Return a number as it is read: whole from 100 on, else with three digits."""
    return f'{value:.0f}' if abs(value) >= 100 else f'{value:.3g}'
