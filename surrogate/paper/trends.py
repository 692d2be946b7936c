# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Each trend of the published study beside ours: roughness that stands still, and that rolls.

A trend is the course of a number over speed or load. Ours agrees where it takes the reported
course, in part where it takes that among others.

"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any, Literal

import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.paper.cases import (
    EFFICIENCY_LOAD,
    MARK_RPM,
    OURS,
    PRELOAD,
    RELIEVED,
    ROLLING_RPM,
    ROUGH_SPEEDS,
    SLOW,
    STANDING,
)
from surrogate.paper.curves import (
    Along,
    crossing,
    Curve,
    curve,
    efficiencies,
    mapped,
    paired_change,
)
from surrogate.paper.marks import counted, REPORTED_FILM
from surrogate.paper.rows import Array, StudyRow
from surrogate.parameters import Screw
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, RCS_LIMIT
from surrogate.units import MILLI, NANO

Agreement = Literal['yes', 'in part', 'no']
SAME = 0.02
"""Change that counts as none, over the number itself [-]; of efficiencies their tolerance."""
ERRORS = 2.0
"""Change of a mean over draws that counts as none, over its standard error [-]."""
DETERMINISTIC = (0.6, 1.2)
"""Film ratios at which published deterministic solutions show contact begin [-]."""
FALLS, RISES, TURNS = ('falls',), ('rises',), ('falls', 'rises')
ROUGH: dict[str, Any] = {'kind': 'contact', 'rough': True}


@dataclass(frozen=True, kw_only=True, slots=True)
class Reading:
    """What one model says of a trend, and whether the study says so too."""

    said: str
    agrees: Agreement


@dataclass(frozen=True, kw_only=True, slots=True)
class Trend:
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
    for one in found:
        cells = [
            cell
            for reading in (one.standing, one.rolling)
            for cell in ((reading.said, reading.agrees) if reading else ('', ''))
        ]
        lines.append(f'| {" | ".join([one.name, one.published, *cells])} |')
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
    said = f'{values[0]:.3g} at {at[0]:g} {unit}, {", ".join(path)}{note}'
    part: Agreement = 'in part' if set(words) & set(reported) else 'no'
    return Reading(said=said, agrees='yes' if words == reported else part)


def apparent_friction(rows: Iterable[StudyRow], case: str = OURS) -> Curve:
    """Return the friction coefficient that would make all losses by sliding, over speed."""
    friction, torque, sliding = (
        screw_speeds(rows, name, case)
        for name in ('friction_coefficient', 'friction_torque', 'sliding_torque')
    )
    return replace(friction, mean=friction.mean * torque.mean / sliding.mean)


def screw_speeds(rows: Iterable[StudyRow], name: str, case: str = OURS) -> Curve:
    """Return a column of the screw under preload over speed."""
    return curve(rows, 'rpm', name, kind='screw', load=PRELOAD, case=case)


def contact_speeds(rows: Iterable[StudyRow]) -> Curve:
    """Return RCS of a contact with the study's roughness, which stands still, over speed."""
    near = [row for row in rows if row.rpm in ROUGH_SPEEDS]
    return curve(near, 'rpm', 'rcs', load=PRELOAD, **ROUGH)


def nut_rows(rows: Iterable[StudyRow], nut: str) -> list[StudyRow]:
    """Return contacts of a nut, those under preload for either, as a case of its own."""
    case = OURS if nut == 'loaded' else RELIEVED
    return [
        replace(row, case=OURS)
        for row in rows
        if row.kind == 'contact'
        and (row.case == case or (row.case == OURS and row.load == PRELOAD))
    ]


def _ensemble(
    rows: list[StudyRow], name: str, rpm: float, reported: tuple[str, ...], factor: float = 1.0
) -> Reading | None:
    """Return the course of rough contacts over load; errors are those of changes draw by draw."""
    wanted: dict[str, Any] = {'rpm': rpm, 'rough': True}
    found = curve(rows, 'load', name, **wanted)
    errors = [paired_change(rows, name, 'load', PRELOAD, load, **wanted)[1] for load in found.at]
    same = np.maximum(SAME * np.abs(found.mean), ERRORS * np.nan_to_num(errors))
    note = f' ({rpm:g} rev/min, one contact, {counted(found.draws)})'
    return read_course(found.at, factor * found.mean, reported, 'N', factor * same, note)


def _contact_ends(screw: Screw, law: AsperityLaw, rows: list[StudyRow]) -> Trend:
    """Return the speeds at which contact ends, and the film ratios there."""
    film, rolling = (screw_speeds(rows, name) for name in ('central_film', 'rcs'))
    one, whole = contact_speeds(rows), screw_speeds(rows, 'rcs', STANDING)
    standing = [
        _end(screw, film, one, ' (one contact, roughness of the study)'),
        _end(screw, film, whole, ' (screw, Rq by the standard)'),
    ]
    known = [reading for reading in standing if reading]
    both = Reading(
        said='; '.join(reading.said for reading in known),
        agrees='yes' if all(reading.agrees == 'yes' for reading in known) else 'no',
    )
    return Trend(
        name=f'contact at higher speeds: RCS passes {RCS_LIMIT:g}, preload only',
        published='higher; deterministic solutions begin at film ratios of '
        f'{DETERMINISTIC[0]:g} to {DETERMINISTIC[1]:g}',
        standing=both if known else None,
        rolling=_end(screw, film, rolling, f', standard deviation {100 * law.deviation:.0f} %'),
    )


def _end(screw: Screw, film: Curve, rcs: Curve, note: str) -> Reading | None:
    """Return where RCS passes the limit; None where the rows do not tell."""
    speed = crossing(rcs, RCS_LIMIT)
    if math.isnan(speed) or not len(film.at):
        return None
    ratio = float(np.interp(speed, film.at, film.mean)) / screw.roughness.rms
    inside = DETERMINISTIC[0] <= ratio <= DETERMINISTIC[1]
    said = f'{speed:.3g} rev/min, film ratio {ratio:.3g}{note}'
    return Reading(said=said, agrees='yes' if inside else 'no')


def _over_speed(screw: Screw, rows: list[StudyRow]) -> list[Trend]:
    """Return the courses over speed."""
    contact = contact_speeds(rows)
    note = f' (one contact, {counted(contact.draws)})'
    rolling = screw_speeds(rows, 'rcs')
    found = [
        Trend(
            name='RCS, preload only',
            published='falls',
            standing=read_course(contact.at, contact.mean, FALLS, 'rev/min', note=note),
            rolling=read_course(rolling.at, rolling.mean, FALLS, 'rev/min'),
        )
    ]
    for name, column, factor in (
        ('friction torque [mN m], preload only', 'friction_torque', MILLI),
        ('friction coefficient of the sliding, preload only', 'friction_coefficient', 1.0),
    ):
        curves = [screw_speeds(rows, column, case) for case in (STANDING, OURS)]
        found.append(_turning(name, [replace(one, mean=factor * one.mean) for one in curves]))
    apparent = [apparent_friction(rows, case) for case in (STANDING, OURS)]
    found.append(_turning('friction coefficient, all losses taken as sliding', apparent))
    name = f'efficiency over speed, {EFFICIENCY_LOAD:g} N'
    return [*found, _efficiency(screw, rows, name, 'rpm', load=EFFICIENCY_LOAD)]


def _turning(name: str, found: list[Curve]) -> Trend:
    standing, rolling = (read_course(one.at, one.mean, TURNS, 'rev/min') for one in found)
    return Trend(name=name, published='falls, then rises', standing=standing, rolling=rolling)


def _efficiency(
    screw: Screw, rows: list[StudyRow], name: str, along: Along, **wanted: float
) -> Trend:
    """Return the course of the efficiency over speed or load."""
    readings = []
    for case in (STANDING, OURS):
        points = mapped(rows, case=case, **wanted)
        eta = efficiencies(screw, points)
        at = np.array([getattr(row, along) for row in points])
        same = np.full(len(eta), EFFICIENCY_TOLERANCE)
        unit = 'rev/min' if along == 'rpm' else 'N'
        readings.append(read_course(at, eta, RISES, unit, same))
    return Trend(name=name, published='rises', standing=readings[0], rolling=readings[1])


def _over_load(screw: Screw, rows: list[StudyRow]) -> list[Trend]:
    """Return the courses over the axial load."""
    name = f'efficiency over load, {MARK_RPM:g} rev/min'
    found = [_efficiency(screw, rows, name, 'load', rpm=MARK_RPM)]
    for nut in ('loaded', 'relieved'):
        points = mapped(rows, case=OURS, rpm=ROLLING_RPM)
        at = np.array([row.load for row in points])
        rcs = np.array([getattr(row, f'rcs_{nut}') for row in points])
        found.append(
            Trend(
                name=f'RCS over load, {nut} nut',
                published='rises',
                standing=_ensemble(nut_rows(rows, nut), 'rcs', SLOW, RISES),
                rolling=read_course(at, rcs, RISES, 'N', note=f' ({ROLLING_RPM:g} rev/min)'),
            )
        )
    return [*found, *_film_over_load(rows)]


def _film_over_load(rows: list[StudyRow]) -> list[Trend]:
    """Return the film over load; where the roughness rolls it is that of the smooth contact."""
    found = []
    for nut in ('loaded', 'relieved'):
        some = nut_rows(rows, nut)
        smooth = curve(some, 'load', 'central_film', rpm=MARK_RPM, rough=False)
        found.append(
            Trend(
                name=f'film over load [nm], {nut} nut, 502.65 mm/s',
                published='rises',
                standing=_ensemble(some, 'mean_film', MARK_RPM, RISES, NANO),
                rolling=read_course(smooth.at, NANO * smooth.mean, RISES, 'N'),
            )
        )
    return found


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
        readings.append(Reading(said=said, agrees='yes' if near else 'no'))
    return Trend(
        name='central film, 502.65 mm/s, preload only',
        published=f'{REPORTED_FILM:.0f} nm',
        standing=readings[0],
        rolling=readings[1],
    )
