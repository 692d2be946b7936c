# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Nominal life of a screw at its programme, the share that is used up, and how fast it goes now.

Nominal life is that of ISO 3408-5, which nine of ten screws reach: neither wear nor dirt nor a
poor film is in it. Damage is that of Palmgren. The spectrum knows loads against the motion and not
which nut they press: damage counts as if one nut were always the pressed one, which is the most;
loads that change nuts use up to 7 % less.

"""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import math
from typing import Any, TypeVar

from ballscrew_monitor.health.records import Cell, Quantity, quantity, SpectrumBin, unknown
from surrogate.files import InputError
from surrogate.formulas.life import (
    combined_damage,
    damage_palmgren_1924,
    nut_forces_iso_3408_2006,
    SLOPE,
)
from surrogate.units import MINUTE, RPM, TURN

NAN = math.nan
Item = TypeVar('Item', SpectrumBin, Cell)
RECENT = 7  # days that count as now
HOUR = 60 * MINUTE  # one hour [s], also the time in motion before a number is given
KNOWN_SHARE = 0.8  # least share of the motion whose load must be known [-]
LOAD_UNCERTAINTY = 0.1  # of the measured load [-]
WITHIN_BAND = 1.13
"""Largest mean cube of loads in a band, whose ends differ by 1.5, over the cube of their mean."""
SHARED_LEAST = 2.0 ** (1 / SLOPE - 1)
"""Damage of two nuts that take turns over that of one nut that is always pressed [-]."""
NO_RATING = 'not known: the sheet has no dynamic_rating_kN, or the surface was built without it'
SPEED_SHARE, LOAD_SHARE = 0.8, 0.5
"""Shares of critical speed and buckling load that makers allow [-]."""
NAMES = {
    'life at this programme': 'rev',
    'hours of life at this programme': 'h',
    'share of life used': '-',
    'hours left at this programme': 'h',
    'burn rate': '-',
}
"""Quantities of a life, with their units."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Rated:
    """Dynamic rating of one nut, static rating and preload [N], pitch diameter [m]."""

    dynamic_rating: float
    static_rating: float
    preload: float
    pitch_diameter: float

    def __post_init__(self) -> None:
        """Refuse ratings that are not above zero."""
        for name, unit in (
            ('dynamic_rating', 'N'),
            ('static_rating', 'N'),
            ('pitch_diameter', 'm'),
        ):
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise InputError(f'life: {name} is {value:g} {unit}, allowed is above 0')
        if not 0.0 <= self.preload < math.inf:
            raise InputError(f'life: preload is {self.preload:g} N, allowed is at least 0')


def rated_of(header: Mapping[str, Any]) -> Rated | None:
    """Return the ratings that the header of a surface states; None without a dynamic rating."""
    screw, rating = header['inputs']['screw'], header.get('service', {}).get('dynamic_rating')
    if rating is None:
        return None
    return Rated(
        dynamic_rating=float(rating),
        static_rating=float(screw['static_rating']),
        preload=float(screw['preload']),
        pitch_diameter=2 * float(screw['pitch_radius']),
    )


@dataclasses.dataclass(frozen=True, slots=True)
class Damage:
    """
    Share of the nominal life that is used up [-], least and most; turns [rev], time [s].

    `known` is the share of the turns whose load is known [-].

    """

    value: float
    low: float
    high: float
    turns: float
    time: float
    known: float

    def reason(self, when: str) -> str:
        """Return why a damage of some days is not to be given, '' where it is."""
        if self.time < HOUR:
            return (
                f'not known yet: {self.time / MINUTE:.3g} min in motion in {when}, needed are 60'
            )
        if self.known < KNOWN_SHARE:
            return (
                f'not known: the load was measured in {100 * self.known:.3g} % of the motion in '
                f'{when}, needed are {100 * KNOWN_SHARE:g} %'
            )
        return ''


def recent(items: Iterable[Item], today: int, days: int) -> list[Item]:
    """Return bins or cells whose period reaches into the last days, `today` counted."""
    return [item for item in items if item.first_day + item.days > today - days + 1]


def damage_of(
    bins: Iterable[SpectrumBin], rated: Rated, uncertainty: float = LOAD_UNCERTAINTY
) -> Damage:
    """
    Return what bins of motion have used up.

    Motion under an unknown load counts as the other; between none and the largest of the others.
    Loads have an `uncertainty` [-].

    """
    bins = list(bins)
    loads = [(abs(b.axial_load), b.angle / TURN) for b in bins if math.isfinite(b.axial_load)]
    turns, time = sum(b.angle for b in bins) / TURN, sum(b.time for b in bins)
    seen = sum(count for _, count in loads)
    largest = max((load for load, _ in loads), default=0.0)
    unseen = max(turns - seen, 0.0)

    def nuts(loads: Iterable[tuple[float, float]], factor: float) -> tuple[float, float]:
        """Return the damage of the pressed and of the relieved nut under loads [N] and turns."""
        forces = [
            (*nut_forces_iso_3408_2006(load * factor, rated.preload), count)
            for load, count in loads
        ]
        rating = rated.dynamic_rating
        pressed = damage_palmgren_1924(((force, count) for force, _, count in forces), rating)
        relieved = damage_palmgren_1924(((force, count) for _, force, count in forces), rating)
        return pressed, relieved

    value = combined_damage(*nuts(loads, 1.0)) * (turns / seen if seen else NAN)
    low = sum(nuts([*loads, (0.0, unseen)], 1 - uncertainty)) * SHARED_LEAST
    high = combined_damage(*nuts([*loads, (largest, unseen)], 1 + uncertainty))
    # One band is as wide as the widest; loads within the preload vary less.
    return Damage(value, low, high * WITHIN_BAND, turns, time, seen / turns if turns else 0.0)


def life_quantities(
    bins: Sequence[SpectrumBin], rated: Rated | None, today: int
) -> list[Quantity]:
    """
    Return life, hours and hours left at the programme of now, share used, and rate of now.

    `today` counts days since 1970.

    """
    if rated is None:
        return [unknown(name, unit, NO_RATING) for name, unit in NAMES.items()]
    now, every = damage_of(recent(bins, today, RECENT), rated), damage_of(bins, rated)
    lately, whole = now.reason(f'the last {RECENT} days'), every.reason('all days')
    life, hours, share, left, rate = NAMES
    damages = now.value, now.high, now.low
    used = every.value, every.low, every.high
    time_left = [max(1 - part, 0.0) * (now.time / HOUR) for part in (used[0], used[2], used[1])]
    amounts = {life: [now.turns] * 3, hours: [now.time / HOUR] * 3, left: time_left}
    ends: dict[str, Sequence[float]] = {share: used}
    for name, parts in amounts.items():
        pairs = zip(parts, damages, strict=True)
        ends[name] = [part / damage if damage else math.inf for part, damage in pairs]
    idle = '' if every.value else 'no load has used up anything yet'
    reasons = {life: lately, hours: lately, share: whole}
    reasons |= {left: lately or whole, rate: lately or whole or idle}
    if not reasons[rate]:
        burn = now.value / now.time * every.time / every.value
        # An error of the load is in both; nuts that take turns and widths of bands are not.
        slack = WITHIN_BAND / SHARED_LEAST
        ends[rate] = burn, burn / slack, burn * slack
    text = f'ISO 3408-5, {now.turns:.3g} revolutions in {now.time / HOUR:.3g} h of motion'
    evidence = dict.fromkeys(NAMES, text) | {
        share: 'ISO 3408-5 and Palmgren, since monitoring began; revolutions before it are not '
        'known',
        rate: f'the last {RECENT} days over all days, each by time in motion',
    }
    for name, reason in reasons.items():
        if not reason and not math.isfinite(ends[name][2]):
            reasons[name] = 'without preload and load the screw does not tire'
    return [
        unknown(name, unit, reasons[name])
        if reasons[name]
        else quantity(name, unit, ends[name], evidence[name])
        for name, unit in NAMES.items()
    ]


def shaft_notes(header: Mapping[str, Any], speed: float, load: float) -> list[str]:
    """
    Return a sentence for a speed [rad/s] and for a load [N] that are too much for the shaft.

    Limits are 80 % of the critical speed and half of the buckling load, as the surface states.

    """
    service, notes = header.get('service', {}), []
    fastest = SPEED_SHARE * service.get('critical_speed', NAN)
    heaviest = LOAD_SHARE * service.get('buckling_load', NAN)
    if abs(speed) > fastest:
        notes.append(
            f'the screw ran at {abs(speed) / RPM:.4g} rev/min, allowed is up to '
            f'{fastest / RPM:.4g} rev/min, 80 % of its critical speed'
        )
    if abs(load) > heaviest:
        notes.append(
            f'the screw bore {abs(load):.4g} N, allowed is up to {heaviest:.4g} N, half of its '
            'buckling load, where the load presses the shaft'
        )
    return notes
