# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lubrication of a programme: the film's part in the life, severity of contact, boundary running.

The factor of ISO 281 is a stated analogy, since the standard is about bearings; it is shown as a
ratio of rates and never as hours.

"""

from collections.abc import Iterable, Mapping, Sequence
import itertools
import math

from ballscrew_monitor.core.conversions import Direction, opposing_load
from ballscrew_monitor.health.energy import FEWEST_DAYS, student, within
from ballscrew_monitor.health.life import HOUR, KNOWN_SHARE, NO_RATING, Rated, RECENT, recent
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
from surrogate.surface import Regime, regime_of, Surface, SurfacePoint
from surrogate.units import MINUTE

NAN = math.nan
CONTAMINATION = (0.3, 0.5, 0.8)
"""Least, usual and largest contamination factor eC of a lubricated axis [-], ISO 281, table 13."""
THRUST = 3.0  # divisor of the fatigue limit for thrust bearings in ISO 281, 1 for radial ones [-]
FILM_SLACK = 1.5  # factor within which the film ratio is known [-]
CASES = (
    (CONTAMINATION[1] / THRUST, 1.0),
    *itertools.product(
        (CONTAMINATION[0] / THRUST, CONTAMINATION[2]), (1 / FILM_SLACK, FILM_SLACK)
    ),
)
"""What stands before Cu / P, with factors on the film, the usual ones first [-]."""
NORMAL_BOUNDARY, BOUNDARY_SLACK = 0.2, 0.1
"""Share of boundary running that makes it normal, and growth that still is [-]."""
RATE, SHIFT = 'lubrication part of the burn rate', 'severity shift'


def opposed(cell: Cell) -> float:
    """Return the load of a cell that opposes its motion [N]."""
    positive = cell.direction > 0
    return opposing_load(cell.axial_load, Direction.POSITIVE if positive else Direction.NEGATIVE)


def looked_up(surface: Surface, cell: Cell) -> SurfacePoint:
    """Return what a surface states for the motion of a cell."""
    return surface.lookup(abs(cell.speed), opposed(cell), cell.temperature)


def lubrication_rate(
    cells: Sequence[Cell], surface: Surface, rated: Rated | None, today: int
) -> Quantity:
    """
    Return how much faster the film lets life pass now than on all days [-].

    Mean of 1 / a of ISO 281 over the damage of the cells now, over that of all of them: an
    analogy, since the standard is about bearings. Above 1 is worse. `today` counts days.

    """
    if rated is None:
        return unknown(RATE, '-', NO_RATING)
    latest = recent(cells, today, RECENT)
    films = {id(cell): looked_up(surface, cell).film_ratio for cell in cells}
    for part, when in ((latest, f'the last {RECENT} days'), (cells, 'all days')):
        time = sum(cell.duration for cell in part)
        known = sum(cell.duration for cell in part if math.isfinite(films[id(cell)]))
        reason = ''
        if time < HOUR:
            reason = (
                f'not known yet: {time / MINUTE:.3g} min of steady motion in {when}, needed are 60'
            )
        elif known < KNOWN_SHARE * time:
            reason = (
                f'not known: the surface has a film for {100 * known / time:.3g} % of the steady '
                f'motion in {when}, needed are {100 * KNOWN_SHARE:g} %'
            )
        if reason:
            return unknown(RATE, '-', reason)
    rates = [
        _slowness(latest, films, rated, *case) / _slowness(cells, films, rated, *case)
        for case in CASES
    ]
    text = (
        f'{len(cells)} points, the film of the surface in use, fatigue limit C0/22, and the '
        'factor of ISO 281 by analogy'
    )
    return quantity(RATE, '-', (rates[0], min(rates), max(rates)), text)


def _slowness(
    cells: Iterable[Cell], films: Mapping[int, float], rated: Rated, share: float, slack: float
) -> float:
    """Return the mean of 1 / a over the damage of cells [-]."""
    limit = share * fatigue_limit_iso_281_2007(rated.static_rating, rated.pitch_diameter)
    spent = worn = 0.0
    for cell in cells:
        film = films[id(cell)]
        if math.isfinite(film):
            load, _ = nut_forces_iso_3408_2006(cell.axial_load, rated.preload)
            life = life_iso_3408_2006(rated.dynamic_rating, load)
            damage = abs(cell.speed) * cell.duration / life
            kappa = viscosity_ratio_iso_1281_2008(slack * film)
            spent += damage
            worn += damage / life_factor_iso_281_2007(kappa, limit / load if load else math.inf)
    return worn / spent if spent else NAN


def severity_quantities(
    bins: Sequence[SpectrumBin], baseline: Baseline | None, today: int
) -> list[Quantity]:
    """
    Return the share of the motion in classes of severity now, and the shift of the mean class.

    A shift of 1 is ten times the severity, as the classes are cut; its interval is by the scatter
    between periods of days. `today` counts days since 1970.

    """
    latest = recent(bins, today, RECENT)
    known = sum(sum(each.wear_time) for each in latest)
    if known < HOUR:
        reason = f'not known yet: severity of {known / MINUTE:.3g} min of motion, needed are 60'
        return [unknown(SHIFT, 'classes', reason)]
    text = f'{known / HOUR:.3g} h of motion in {RECENT} days'
    shares = [
        quantity(f'severity class {place}', '-', [time / known] * 3, text)
        for place, time in enumerate(_times(latest))
        if time > 0.0
    ]
    if baseline is None:
        reason = 'not known yet: there is no baseline'
        return [*shares, unknown(SHIFT, 'classes', reason)]
    before, now = _mean_classes(within(bins, baseline)), _mean_classes(latest)
    count = f'{len(before)} periods of the baseline'
    if min(len(before), len(now)) < FEWEST_DAYS:
        reason = f'not known yet: severity of {count} and {len(now)} now, needed are {FEWEST_DAYS}'
        return [*shares, unknown(SHIFT, 'classes', reason)]
    value, widths = 0.0, []
    for sign, means in ((-1.0, before), (1.0, now)):
        freedom, mean = len(means) - 1, sum(means) / len(means)
        spread = sum((each - mean) ** 2 for each in means) / freedom
        widths.append(student(freedom) * math.sqrt(spread / len(means)))
        value += sign * mean
    half = math.hypot(*widths)
    ends = value, value - half, value + half
    return [*shares, quantity(SHIFT, 'classes', ends, f'{count}, {len(now)} now')]


def _mean_classes(bins: Iterable[SpectrumBin]) -> list[float]:
    """Return the mean class of each period of days with motion of known severity."""
    periods: dict[tuple[int, int], list[SpectrumBin]] = {}
    for each in bins:
        periods.setdefault((each.first_day, each.days), []).append(each)
    times = [time for time in map(_times, periods.values()) if sum(time) > 0.0]
    return [sum(place * part for place, part in enumerate(time)) / sum(time) for time in times]


def _times(bins: Iterable[SpectrumBin]) -> list[float]:
    """Return the time in each class [s]."""
    columns = itertools.zip_longest(*(each.wear_time for each in bins), fillvalue=0.0)
    return [sum(column) for column in columns]


def usual_boundary(
    cells: Sequence[Cell], baseline: Baseline | None, surface: Surface, today: int
) -> tuple[float, float] | None:
    """
    Return the share of the motion in the boundary regime in the baseline and now [-].

    None for an axis for which boundary running is not normal. `today` counts days since 1970.

    """
    latest = recent(cells, today, RECENT)
    if baseline is None:
        return None
    first = [cell for cell in cells if baseline.begin <= cell.start < baseline.end]
    if not latest or not first:
        return None
    shares = []
    for part in (first, latest):
        regimes = [
            (regime_of(looked_up(surface, cell).film_ratio), cell.duration) for cell in part
        ]
        known = sum(time for regime, time in regimes if regime is not Regime.UNKNOWN)
        boundary = sum(time for regime, time in regimes if regime is Regime.BOUNDARY)
        shares.append(boundary / known if known else NAN)
    before, now = shares
    normal = before >= NORMAL_BOUNDARY and now <= before + BOUNDARY_SLACK
    return (before, now) if normal else None


def boundary_note(before: float, now: float) -> str:
    """Return in a sentence that running in the boundary regime is normal for an axis."""
    return (
        f'boundary running is normal for this axis: {100 * before:.0f} % of its motion in '
        f'the baseline and {100 * now:.0f} % now'
    )
