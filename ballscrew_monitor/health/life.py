# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Nominal life of a screw at its programme, the share that is used up, and how fast it goes now.

Nominal life is that of ISO 3408-5, which nine of ten screws reach: neither wear nor dirt nor a
poor film is in it.

"""

from collections.abc import Iterator, Mapping, Sequence
import math
from typing import Any

from ballscrew_monitor.health.damage import (
    Damage,
    damage_of,
    Rated,
    recent,
    SHARED_LEAST,
    WITHIN_BAND,
)
from ballscrew_monitor.health.records import Quantity, SpectrumBin
from surrogate.files import InputError
from surrogate.units import MINUTE, RPM

NAN = math.nan
RECENT = 7
"""Days that count as now."""
HOUR = 60 * MINUTE
"""One hour [s], also the time in motion before a number is told."""
KNOWN_SHARE = 0.8
"""Least share of the motion whose load must be known [-]."""
LOAD_UNCERTAINTY = 0.1
"""Uncertainty of the measured load unless another is stated [-]."""
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


def life_quantities(
    bins: Sequence[SpectrumBin],
    rated: Rated | None,
    today: int,
    *,
    load_uncertainty: float = LOAD_UNCERTAINTY,
    turns_before: float = NAN,
) -> list[Quantity]:
    """
    Return life, hours and hours left at the programme of now, share used, and rate of now.

    `today` counts days since 1970; `load_uncertainty` [-]; `turns_before` monitoring [rev], NaN
    where not known, which are counted at the mean damage per turn of all that was seen.

    """
    if not 0.0 <= load_uncertainty < 1.0:
        raise InputError(
            f'life: load_uncertainty is {load_uncertainty:g}, allowed is 0 to below 1'
        )
    if rated is None:
        return [unknown(name, unit, NO_RATING) for name, unit in NAMES.items()]
    now, every = (
        damage_of(some, rated, load_uncertainty) for some in (recent(bins, today, RECENT), bins)
    )
    reasons = _reason(now, f'the last {RECENT} days'), _reason(every, 'all days')
    return list(_quantities(now, every, reasons, turns_before))


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


def _quantities(
    now: Damage, every: Damage, reasons: tuple[str, str], turns_before: float
) -> Iterator[Quantity]:
    life, hours, share, left, rate = NAMES
    lately, whole = reasons
    text = f'ISO 3408-5, {now.turns:.3g} revolutions in {now.time / HOUR:.3g} h of motion'
    for name, amount in ((life, now.turns), (hours, now.time / HOUR)):
        yield _inverse(name, NAMES[name], amount, now, lately, text)
    before = 0.0 if math.isnan(turns_before) else turns_before
    used = every.scaled(1 + before / every.turns if every.turns else NAN)
    seen = 'since monitoring began; revolutions before it are not known'
    if not math.isnan(turns_before):
        seen = f'with {before:.3g} revolutions before monitoring'
    yield _told(share, '-', used, whole, f'ISO 3408-5 and Palmgren, {seen}')
    yield _left(left, now, used, lately or whole, text)
    yield _rate(rate, now, every, lately or whole)


def _left(
    name: str, now: Damage, used: tuple[float, float, float], reason: str, text: str
) -> Quantity:
    hours = now.time / HOUR
    share, least, most = used
    ends = (
        (max(1 - part, 0.0) * hours / damage if damage else math.inf)
        for part, damage in ((share, now.value), (most, now.high), (least, now.low))
    )
    return _told(name, 'h', tuple(ends), reason, text)  # type: ignore[arg-type]


def _rate(name: str, now: Damage, every: Damage, reason: str) -> Quantity:
    """Return the damage per time in motion of now over that of all days."""
    if reason or not every.value:
        return unknown(name, '-', reason or 'no load has used up anything yet')
    value = now.value / now.time * every.time / every.value
    # An error of the load is in both; nuts that take turns and widths of bands are not.
    slack = WITHIN_BAND / SHARED_LEAST
    text = f'the last {RECENT} days over all days, each by time in motion'
    return _told(name, '-', (value, value / slack, value * slack), '', text)


def _inverse(
    name: str, unit: str, amount: float, damage: Damage, reason: str, text: str
) -> Quantity:
    ends = (
        amount / part if part else math.inf for part in (damage.value, damage.high, damage.low)
    )
    return _told(name, unit, tuple(ends), reason, text)  # type: ignore[arg-type]


def _told(
    name: str, unit: str, ends: tuple[float, float, float], reason: str, evidence: str
) -> Quantity:
    if reason:
        return unknown(name, unit, reason)
    value, low, high = ends
    if not math.isfinite(high):
        return unknown(name, unit, 'without preload and load the screw does not tire')
    return Quantity(name=name, unit=unit, value=value, low=low, high=high, evidence=evidence)


def _reason(damage: Damage, when: str) -> str:
    """Return why a damage is not to be told, empty where it is."""
    if damage.time < HOUR:
        return f'not known yet: {damage.time / MINUTE:.3g} min in motion in {when}, needed are 60'
    if damage.known < KNOWN_SHARE:
        return (
            f'not known: the load was measured in {100 * damage.known:.3g} % of the motion in '
            f'{when}, needed are {100 * KNOWN_SHARE:g} %'
        )
    return ''


def unknown(name: str, unit: str, reason: str) -> Quantity:
    """Return a quantity that is not known, and why."""
    return Quantity(name=name, unit=unit, reason=reason)
