# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lubrication of a programme: the film's part in the life, severity of contact, boundary running.

The factor of ISO 281 is a stated analogy, since the standard is about bearings; it is shown as a
ratio of rates and never as hours.

"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
import itertools
import math

from ballscrew_monitor.core.conversions import Direction, opposing_load
from ballscrew_monitor.health.damage import Rated, recent
from ballscrew_monitor.health.energy import FEWEST_DAYS, student, within
from ballscrew_monitor.health.life import HOUR, KNOWN_SHARE, NO_RATING, RECENT
from ballscrew_monitor.health.records import (
    Baseline,
    Cell,
    Quantity,
    quantity,
    SpectrumBin,
    unknown,
)
from surrogate.formulas.life import (
    fatigue_limit_iso_281_2007,
    life_factor_iso_281_2007,
    life_iso_3408_2006,
    nut_forces_iso_3408_2006,
    viscosity_ratio_iso_1281_2008,
)
from surrogate.surface import Regime, regime_of, Surface
from surrogate.units import MINUTE

NAN = math.nan
CONTAMINATION = (0.3, 0.5, 0.8)
"""Least, usual and largest contamination factor eC of a lubricated axis [-], ISO 281, table 13."""
THRUST = 3.0
"""Divisor of the fatigue limit for thrust bearings in ISO 281 [-]; a radial bearing has 1."""
FILM_SLACK = 1.5
"""Factor within which the film ratio is known [-]."""
NORMAL_BOUNDARY, BOUNDARY_SLACK = 0.2, 0.1
"""Share of boundary running that makes it normal, and growth that still is [-]."""


def lubrication_rate(
    points: Sequence[Cell], surface: Surface, rated: Rated | None, today: int
) -> Quantity:
    """
    Return how much faster the film lets life pass now than on all days [-].

    Mean of 1 / a of ISO 281 over the damage of the points now, over that of all of them: an
    analogy, since the standard is about bearings. Above 1 is worse. `today` counts days.

    """
    name, unit = 'lubrication part of the burn rate', '-'
    if rated is None:
        return unknown(name, unit, NO_RATING)
    latest = recent(points, today, RECENT)
    films = {id(one): _film_ratio(surface, one) for one in points}
    for some, when in ((latest, f'the last {RECENT} days'), (points, 'all days')):
        reason = _film_reason(some, films, when)
        if reason:
            return unknown(name, unit, reason)
    found = [
        _mean_slowness(latest, films, rated, *case) / _mean_slowness(points, films, rated, *case)
        for case in _cases()
    ]
    text = (
        f'{len(points)} points, the film of the surface in use, fatigue limit C0/22, and the '
        'factor of ISO 281 by analogy'
    )
    return quantity(name, unit, (found[0], min(found), max(found)), text)


def _film_reason(points: Iterable[Cell], films: Mapping[int, float], when: str) -> str:
    points = list(points)
    time = sum(one.duration for one in points)
    known = sum(one.duration for one in points if math.isfinite(films[id(one)]))
    if time < HOUR:
        return f'not known yet: {time / MINUTE:.3g} min of steady motion in {when}, needed are 60'
    if known < KNOWN_SHARE * time:
        return (
            f'not known: the surface has a film for {100 * known / time:.3g} % of the steady '
            f'motion in {when}, needed are {100 * KNOWN_SHARE:g} %'
        )
    return ''


def _mean_slowness(
    points: Iterable[Cell],
    films: Mapping[int, float],
    rated: Rated,
    limit_share: float,
    film_slack: float,
) -> float:
    """Return the mean of 1 / a over the damage of points [-]."""
    limit = fatigue_limit_iso_281_2007(rated.static_rating, rated.pitch_diameter)
    spent = worn = 0.0
    for one in points:
        if not math.isfinite(films[id(one)]):
            continue
        load, _ = nut_forces_iso_3408_2006(one.axial_load, rated.preload)
        damage = abs(one.speed) * one.duration / life_iso_3408_2006(rated.dynamic_rating, load)
        kappa = viscosity_ratio_iso_1281_2008(film_slack * films[id(one)])
        ratio = limit_share * limit / load if load else math.inf
        spent += damage
        worn += damage / life_factor_iso_281_2007(kappa, ratio)
    return worn / spent if spent else NAN


def _cases() -> Iterator[tuple[float, float]]:
    """Yield what stands before Cu / P with factors on the film, the usual ones first."""
    least, usual, most = CONTAMINATION
    yield usual / THRUST, 1.0
    for share in (least / THRUST, most):
        for slack in (1 / FILM_SLACK, FILM_SLACK):
            yield share, slack


def _film_ratio(surface: Surface, point: Cell) -> float:
    return surface.lookup(abs(point.speed), opposed(point), point.temperature).film_ratio


def opposed(point: Cell) -> float:
    """Return the load of a point that opposes its motion [N]."""
    positive = point.direction > 0
    return opposing_load(point.axial_load, Direction.POSITIVE if positive else Direction.NEGATIVE)


def severity_quantities(
    bins: Sequence[SpectrumBin], baseline: Baseline | None, today: int
) -> list[Quantity]:
    """
    Return the share of the motion in classes of severity now, and the shift of the mean class.

    A shift of 1 is ten times the severity, as the classes are cut; its interval is by the scatter
    between periods of days. `today` counts days since 1970.

    """
    latest = recent(bins, today, RECENT)
    times, known = _times(latest), sum(map(sum, (one.wear_time for one in latest)))
    if known < HOUR:
        reason = f'not known yet: severity of {known / MINUTE:.3g} min of motion, needed are 60'
        return [unknown('severity shift', 'classes', reason)]
    text = f'{known / HOUR:.3g} h of motion in {RECENT} days'
    shares = [
        quantity(f'severity class {place}', '-', [time / known] * 3, text)
        for place, time in enumerate(times)
        if time > 0.0
    ]
    return [*shares, _shift(latest, bins, baseline)]


def usual_boundary(
    points: Sequence[Cell], baseline: Baseline | None, surface: Surface, today: int
) -> tuple[float, float] | None:
    """
    Return the share of the motion in the boundary regime in the baseline and now [-].

    None for an axis for which boundary running is not normal.

    `today` counts days since 1970.

    """
    latest = recent(points, today, RECENT)
    if baseline is None:
        return None
    first = [one for one in points if baseline.begin <= one.start < baseline.end]
    if not latest or not first:
        return None
    before, now = (_boundary_share(some, surface) for some in (first, latest))
    if not before >= NORMAL_BOUNDARY or not now <= before + BOUNDARY_SLACK:
        return None
    return before, now


def boundary_note(before: float, now: float) -> str:
    """Return in a sentence that running in the boundary regime is normal for an axis."""
    return (
        f'boundary running is normal for this axis: {100 * before:.0f} % of its motion in '
        f'the baseline and {100 * now:.0f} % now'
    )


def _shift(
    latest: Iterable[SpectrumBin], bins: Iterable[SpectrumBin], baseline: Baseline | None
) -> Quantity:
    name, unit = 'severity shift', 'classes'
    if baseline is None:
        return unknown(name, unit, 'not known yet: there is no baseline')
    sides = [_daily_means(some) for some in (within(bins, baseline), latest)]
    if min(map(len, sides)) < FEWEST_DAYS:
        return unknown(
            name,
            unit,
            f'not known yet: severity of {len(sides[0])} periods of the baseline and '
            f'{len(sides[1])} now, needed are {FEWEST_DAYS}',
        )
    before, now = (sum(one) / len(one) for one in sides)
    half = math.hypot(*(_half_width(one) for one in sides))
    value = now - before
    text = f'{len(sides[0])} periods of the baseline, {len(sides[1])} now'
    return quantity(name, unit, (value, value - half, value + half), text)


def _daily_means(bins: Iterable[SpectrumBin]) -> list[float]:
    """Return the mean class of each period of days with motion of known severity."""
    periods: dict[tuple[int, int], list[SpectrumBin]] = {}
    for one in bins:
        periods.setdefault((one.first_day, one.days), []).append(one)
    times = [_times(some) for some in periods.values()]
    return [
        sum(place * time for place, time in enumerate(some)) / sum(some)
        for some in times
        if sum(some) > 0.0
    ]


def _half_width(means: Sequence[float]) -> float:
    mean, count = sum(means) / len(means), len(means)
    spread = sum((one - mean) ** 2 for one in means) / (count - 1)
    return student(count - 1) * math.sqrt(spread / count)


def _times(bins: Iterable[SpectrumBin]) -> list[float]:
    """Return the time in each class [s]."""
    columns = itertools.zip_longest(*(one.wear_time for one in bins), fillvalue=0.0)
    return [sum(column) for column in columns]


def _boundary_share(points: Iterable[Cell], surface: Surface) -> float:
    """Return the share of the time of points with a known film that is in the boundary regime."""
    boundary = known = 0.0
    for one in points:
        regime = regime_of(_film_ratio(surface, one))
        known += one.duration * (regime is not Regime.UNKNOWN)
        boundary += one.duration * (regime is Regime.BOUNDARY)
    return boundary / known if known else NAN
