# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Each trend of the published study beside ours, for roughness that stands still and that rolls.

A trend is the course of a number over speed or load. Ours agrees where it takes the reported
course, in part where it takes that among others.

"""

from collections.abc import Iterable, Sequence
import math
from typing import Any, Literal, NamedTuple

import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import Screw
from surrogate.studies.rows import (
    Along,
    apparent_friction,
    Array,
    contact_speeds,
    crossing,
    Curve,
    curve,
    efficiencies,
    mapped,
    nut_rows,
    paired_change,
    screw_speeds,
    StudyRow,
)
from surrogate.studies.tasks import (
    EFFICIENCY_LOAD,
    MARK_RPM,
    OURS,
    PRELOAD,
    ROLLING_RPM,
    SLOW,
    STANDING,
)
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, RCS_LIMIT
from surrogate.units import MILLI, NANO

Agreement = Literal['yes', 'in part', 'no']
REPORTED_FILM = 153.0
"""Central film at 502.65 mm/s and preload only, published for the rough surface [nm]."""
SAME = 0.02
"""Change that counts as none, over the number itself [-]; of efficiencies their tolerance."""
ERRORS = 2.0
"""Change of a mean over draws that counts as none, over its standard error [-]."""
DETERMINISTIC = (0.6, 1.2)
"""Film ratios at which published deterministic solutions show contact begin [-]."""
FALLS, RISES, TURNS = ('falls',), ('rises',), ('falls', 'rises')


class Reading(NamedTuple):
    """What one model says of a trend, and whether the study says so too."""

    said: str
    agrees: Agreement


class Trend(NamedTuple):
    """A trend: name, what is reported, and both readings; None where the rows do not tell."""

    name: str
    published: str
    standing: Reading | None
    rolling: Reading | None


def trends(screw: Screw, law: AsperityLaw, found: Iterable[StudyRow]) -> list[Trend]:
    """Return every trend that the rows tell something of."""
    rows = list(found)
    every = [
        _contact_ends(screw, law, rows),
        *_over_speed(screw, rows),
        *_over_load(screw, rows),
        _film(rows),
    ]
    return [one for one in every if one.standing or one.rolling]


def summary(found: Sequence[Trend]) -> str:
    """Return as a list which trends agree where the roughness rolls."""
    lines = []
    for agrees, head in (('yes', 'agree'), ('in part', 'agree in part'), ('no', 'differ')):
        names = [one.name for one in found if one.rolling and one.rolling.agrees == agrees]
        lines.append(f'* Rolling roughness, {head}: {"; ".join(names) or "none"}.')
    changed = [
        one.name
        for one in found
        if one.standing and one.rolling and one.standing.agrees != one.rolling.agrees
    ]
    return '\n'.join([*lines, f'* Unlike standing roughness: {"; ".join(changed) or "none"}.'])


def trend_table(found: Iterable[Trend]) -> str:
    """Return trends as a table in Markdown; a column for each model, and what agrees."""
    lines = [
        '| trend | published | standing roughness | agrees | rolling roughness | agrees |',
        '|---|---|---|---|---|---|',
    ]
    for name, published, *readings in found:
        cells = [cell for reading in readings for cell in reading or ('', '')]
        lines.append(f'| {" | ".join([name, published, *cells])} |')
    return '\n'.join(lines)


def course(values: Array, same: Array) -> list[tuple[str, int]]:
    """
    Return where values fall and rise, in order: the word, and the place at which that ends.

    A change by less than `same`, in the unit of the values, counts as none.

    """
    found: list[tuple[str, int]] = []
    low = high = 0
    for i, value in enumerate(values):
        word = found[-1][0] if found else ''
        low = i if value < values[low] else low
        high = i if value > values[high] else high
        if word != 'rises' and value > values[low] + same[i]:
            found, high = [*found, ('rises', i)], i
        elif word != 'falls' and value < values[high] - same[i]:
            found, low = [*found, ('falls', i)], i
        elif word and i == (high if word == 'rises' else low):
            found[-1] = (word, i)
    return found


def read_course(
    at: Array,
    values: Array,
    reported: tuple[str, ...],
    unit: str,
    same: Array | None = None,
    note: str = '',
) -> Reading | None:
    """Return the course of a number over places in a `unit`; None with less than two places."""
    if len(values) < 2:
        return None
    turns = course(values, SAME * np.abs(values) if same is None else same)
    words = tuple(word for word, _ in turns)
    path = [f'{word} to {values[i]:.3g} at {at[i]:g}' for word, i in turns] or ['stays']
    part: Agreement = 'in part' if set(words) & set(reported) else 'no'
    said = f'{values[0]:.3g} at {at[0]:g} {unit}, {", ".join(path)}{note}'
    return Reading(said, 'yes' if words == reported else part)


def counted(draws: int) -> str:
    """Return a number of draws in words."""
    return 'one draw' if draws == 1 else f'{draws} draws'


def _ensemble(rows: list[StudyRow], name: str, rpm: float, factor: float = 1.0) -> Reading | None:
    """Return the course of rough contacts over load; errors are those of changes draw by draw."""
    wanted: dict[str, Any] = {'rpm': rpm, 'rough': True}
    found = curve(rows, 'load', name, **wanted)
    errors = [paired_change(rows, name, 'load', PRELOAD, load, **wanted)[1] for load in found.at]
    same = factor * np.maximum(SAME * np.abs(found.mean), ERRORS * np.nan_to_num(errors))
    note = f' ({rpm:g} rev/min, one contact, {counted(found.draws)})'
    return read_course(found.at, factor * found.mean, RISES, 'N', same, note)


def _contact_ends(screw: Screw, law: AsperityLaw, rows: list[StudyRow]) -> Trend:
    """Return the speeds at which contact ends, and the film ratios there."""
    film, whole = (screw_speeds(rows, name) for name in ('central_film', 'rcs'))
    stands = (
        _end(screw, film, contact_speeds(rows), ' (one contact, roughness of the study)'),
        _end(screw, film, screw_speeds(rows, 'rcs', STANDING), ' (screw, Rq by the standard)'),
    )
    known = [one for one in stands if one]
    agrees: Agreement = 'yes' if all(one.agrees == 'yes' for one in known) else 'no'
    return Trend(
        f'contact at higher speeds: RCS passes {RCS_LIMIT:g}, preload only',
        'higher; deterministic solutions begin at film ratios of '
        f'{DETERMINISTIC[0]:g} to {DETERMINISTIC[1]:g}',
        Reading('; '.join(one.said for one in known), agrees) if known else None,
        _end(screw, film, whole, f', standard deviation {100 * law.deviation:.0f} %'),
    )


def _end(screw: Screw, film: Curve, rcs: Curve, note: str) -> Reading | None:
    """Return where RCS passes the limit; None where the rows do not tell."""
    speed = crossing(rcs, RCS_LIMIT)
    if math.isnan(speed) or not len(film.at):
        return None
    ratio = float(np.interp(speed, film.at, film.mean)) / screw.roughness.rms
    inside = DETERMINISTIC[0] <= ratio <= DETERMINISTIC[1]
    said = f'{speed:.3g} rev/min, film ratio {ratio:.3g}{note}'
    return Reading(said, 'yes' if inside else 'no')


def _over_speed(screw: Screw, rows: list[StudyRow]) -> list[Trend]:
    """Return the courses over speed."""
    contact, rolling = contact_speeds(rows), screw_speeds(rows, 'rcs')
    note = f' (one contact, {counted(contact.draws)})'
    found = [
        Trend(
            'RCS, preload only',
            'falls',
            read_course(contact.at, contact.mean, FALLS, 'rev/min', note=note),
            read_course(rolling.at, rolling.mean, FALLS, 'rev/min'),
        )
    ]
    torque, friction = (
        [screw_speeds(rows, name, case) for case in (STANDING, OURS)]
        for name in ('friction_torque', 'friction_coefficient')
    )
    for name, factor, curves in (
        ('friction torque [mN m], preload only', MILLI, torque),
        ('friction coefficient of the sliding, preload only', 1.0, friction),
        (
            'friction coefficient, all losses taken as sliding',
            1.0,
            [apparent_friction(rows, case) for case in (STANDING, OURS)],
        ),
    ):
        both = [read_course(one.at, factor * one.mean, TURNS, 'rev/min') for one in curves]
        found.append(Trend(name, 'falls, then rises', *both))
    name = f'efficiency over speed, {EFFICIENCY_LOAD:g} N'
    return [*found, _efficiency(screw, rows, name, 'rpm', load=EFFICIENCY_LOAD)]


def _efficiency(
    screw: Screw, rows: list[StudyRow], name: str, along: Along, **wanted: float
) -> Trend:
    """Return the course of the efficiency over speed or load."""
    readings = []
    for case in (STANDING, OURS):
        points = mapped(rows, case=case, **wanted)
        at = np.array([getattr(row, along) for row in points])
        same = np.full(len(at), EFFICIENCY_TOLERANCE)
        unit = 'rev/min' if along == 'rpm' else 'N'
        readings.append(read_course(at, efficiencies(screw, points), RISES, unit, same))
    return Trend(name, 'rises', *readings)


def _over_load(screw: Screw, rows: list[StudyRow]) -> list[Trend]:
    """Return the courses over load; the film of rolling roughness is that of smooth contacts."""
    name, nuts = f'efficiency over load, {MARK_RPM:g} rev/min', ('loaded', 'relieved')
    points, note = mapped(rows, case=OURS, rpm=ROLLING_RPM), f' ({ROLLING_RPM:g} rev/min)'
    at = np.array([row.load for row in points])
    shares, films = [], []
    for nut in nuts:
        some = nut_rows(rows, nut)
        rcs = np.array([getattr(row, f'rcs_{nut}') for row in points])
        rolling = read_course(at, rcs, RISES, 'N', note=note)
        standing = _ensemble(some, 'rcs', SLOW)
        shares.append(Trend(f'RCS over load, {nut} nut', 'rises', standing, rolling))
        smooth = curve(some, 'load', 'central_film', rpm=MARK_RPM, rough=False)
        rolling = read_course(smooth.at, NANO * smooth.mean, RISES, 'N')
        standing = _ensemble(some, 'mean_film', MARK_RPM, NANO)
        title = f'film over load [nm], {nut} nut, 502.65 mm/s'
        films.append(Trend(title, 'rises', standing, rolling))
    return [_efficiency(screw, rows, name, 'load', rpm=MARK_RPM), *shares, *films]


def _film(rows: list[StudyRow]) -> Trend:
    """Return the central film at the one point that is published, agreeing within `SAME`."""
    readings: list[Reading | None] = []
    for name, rough in (('mean_film', True), ('central_film', False)):
        found = curve(rows, 'load', name, kind='contact', rpm=MARK_RPM, load=PRELOAD, rough=rough)
        if not len(found.at):
            readings.append(None)
            continue
        film, error = NANO * found.mean[0], np.nan_to_num(NANO * found.error[0])
        near = abs(film - REPORTED_FILM) <= max(SAME * REPORTED_FILM, ERRORS * error)
        said = f'{film:.1f}{f" ± {error:.1f}" if error else ""} nm'
        readings.append(Reading(said, 'yes' if near else 'no'))
    name = 'central film, 502.65 mm/s, preload only'
    return Trend(name, f'{REPORTED_FILM:.0f} nm', *readings)
