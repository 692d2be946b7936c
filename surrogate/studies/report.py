# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The page of the comparison with the published study: its trends, and numbers that are none.

A trend is the course of a number over speed or load, for roughness that stands still and that
rolls. Ours agrees where it takes the reported course, in part where it takes that among others.

"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
import math
from typing import Any, Literal, NamedTuple

import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import Screw
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.full_record import law_sentence
from surrogate.studies.rows import (
    Along,
    apparent_friction,
    Array,
    constant_friction_efficiency,
    contact_speeds,
    crossing,
    Curve,
    curve,
    efficiencies,
    mapped,
    markdown_table,
    nut_rows,
    paired_change,
    pick,
    screw_speeds,
    StudyRow,
)
from surrogate.studies.tasks import (
    EFFICIENCY_LOAD,
    LOADS,
    MARK_RPM,
    ONSET,
    OURS,
    PRELOAD,
    REPORTED_FILM,
    ROLLING_RPM,
    ROUGH_LOADS,
    SHORT,
    SLOW,
    STANDING,
)
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
ETA_RISES, WITH_LOAD = 'trend: rises with speed', 'trend: rises with load'


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


class Mark(NamedTuple):
    """
    A number of ours: what it is, value, unit, what is reported, standard error (NaN: none).

    `trend` in what is reported means that only the direction is known.

    """

    name: str
    value: float
    unit: str = ''
    reported: str = ''
    error: float = math.nan

    @property
    def shown(self) -> str:
        """Return value, error and unit as text."""
        more = '' if math.isnan(self.error) else f' ± {self.error:.2g}'
        return f'{self.value:.4g}{more} {self.unit}'.strip()


def report(screw: Screw, law: AsperityLaw, rows: Mapping[str, StudyRow]) -> str:
    """Return the page: where its numbers are from, the trends side by side, other numbers."""
    seconds = sum(row.seconds for row in rows.values() if row.status == 'CONVERGED')
    every = trends(screw, law, rows.values())
    parts = (
        '# Numbers beside the published study',
        'Written by `ballscrew figures`; docs/theory/validation.md says what they mean. '
        f'{len(rows)} solves, {seconds:.0f} s of processor time.',
        f'Rolling: {law_sentence(screw, ScrewSettings())}; that film has a '
        f'standard deviation of {100 * law.deviation:.0f} %.',
        '## Trends',
        'Standing roughness is, in single contacts, that of the study, and in the screw one draw '
        'of its own Rq by the standard. Agrees: the course over all places is the reported one; '
        f'in part: a part of it is. Changes below {100 * SAME:g} %, of efficiencies below '
        f'{EFFICIENCY_TOLERANCE:g}, of means below {ERRORS:g} standard errors, count as none.',
        trend_table(every),
        summary(every),
        '## Other numbers',
        table(marks(screw, rows)),
    )
    return '\n\n'.join(parts) + '\n'


def trend_table(every: Iterable[Trend]) -> str:
    """Return trends as a table in Markdown; a column for each model, and what agrees."""
    heads = 'trend', 'published', 'standing roughness', 'agrees', 'rolling roughness', 'agrees'
    return markdown_table(
        heads,
        (
            [name, published, *(cell for reading in readings for cell in reading or ('', ''))]
            for name, published, *readings in every
        ),
    )


def summary(every: Sequence[Trend]) -> str:
    """Return as a list which trends agree where the roughness rolls."""
    lines = []
    for agrees, head in (('yes', 'agree'), ('in part', 'agree in part'), ('no', 'differ')):
        names = [one.name for one in every if one.rolling and one.rolling.agrees == agrees]
        lines.append(f'* Rolling roughness, {head}: {"; ".join(names) or "none"}.')
    changed = [
        one.name
        for one in every
        if one.standing and one.rolling and one.standing.agrees != one.rolling.agrees
    ]
    return '\n'.join([*lines, f'* Unlike standing roughness: {"; ".join(changed) or "none"}.'])


def table(every: Iterable[Mark]) -> str:
    """Return marks as a table in Markdown."""
    return markdown_table(
        ('number', 'ours', 'reported'), ((mark.name, mark.shown, mark.reported) for mark in every)
    )


def trends(screw: Screw, law: AsperityLaw, found: Iterable[StudyRow]) -> list[Trend]:
    """Return every trend that the rows tell something of."""
    rows = list(found)
    every = [
        _contact_ends(screw, law, rows),
        *_over_speed(rows),
        _efficiency(screw, rows, f'speed, {EFFICIENCY_LOAD:g} N', 'rpm', load=EFFICIENCY_LOAD),
        _efficiency(screw, rows, f'load, {MARK_RPM:g} rev/min', 'load', rpm=MARK_RPM),
        *_over_load(rows),
        _film(rows),
    ]
    return [trend for trend in every if trend.standing or trend.rolling]


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


def _contact_ends(screw: Screw, law: AsperityLaw, rows: list[StudyRow]) -> Trend:
    """Return the speeds at which contact ends, and the film ratios there."""
    film = screw_speeds(rows, 'central_film')

    def end(rcs: Curve, note: str) -> Reading | None:
        speed = crossing(rcs, RCS_LIMIT)
        if math.isnan(speed) or not len(film.at):
            return None
        ratio = float(np.interp(speed, film.at, film.mean)) / screw.roughness.rms
        inside = DETERMINISTIC[0] <= ratio <= DETERMINISTIC[1]
        said = f'{speed:.3g} rev/min, film ratio {ratio:.3g}{note}'
        return Reading(said, 'yes' if inside else 'no')

    both = (
        end(contact_speeds(rows), ' (one contact, roughness of the study)'),
        end(screw_speeds(rows, 'rcs', STANDING), ' (screw, Rq by the standard)'),
    )
    stands = [reading for reading in both if reading]
    agrees: Agreement = 'yes' if all(reading.agrees == 'yes' for reading in stands) else 'no'
    return Trend(
        f'contact at higher speeds: RCS passes {RCS_LIMIT:g}, preload only',
        'higher; deterministic solutions begin at film ratios of '
        f'{DETERMINISTIC[0]:g} to {DETERMINISTIC[1]:g}',
        Reading('; '.join(reading.said for reading in stands), agrees) if stands else None,
        end(
            screw_speeds(rows, 'rcs'), f', standard deviation {100 * law.deviation:.0f} % in film'
        ),
    )


def _over_speed(rows: list[StudyRow]) -> Iterator[Trend]:
    """Return the courses under preload over speed."""
    contact, rolling = contact_speeds(rows), screw_speeds(rows, 'rcs')
    note = f' (one contact, {counted(contact.draws)})'
    yield Trend(
        'RCS, preload only',
        'falls',
        read_course(contact.at, contact.mean, FALLS, 'rev/min', note=note),
        read_course(rolling.at, rolling.mean, FALLS, 'rev/min'),
    )
    cases = STANDING, OURS
    torque, friction = (
        [screw_speeds(rows, name, case) for case in cases]
        for name in ('friction_torque', 'friction_coefficient')
    )
    apparent = [apparent_friction(rows, case) for case in cases]
    for name, factor, curves in (
        ('friction torque [mN m], preload only', MILLI, torque),
        ('friction coefficient of the sliding, preload only', 1.0, friction),
        ('friction coefficient, all losses taken as sliding', 1.0, apparent),
    ):
        both = [read_course(line.at, factor * line.mean, TURNS, 'rev/min') for line in curves]
        yield Trend(name, 'falls, then rises', *both)


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
    return Trend(f'efficiency over {name}', 'rises', *readings)


def _over_load(rows: list[StudyRow]) -> list[Trend]:
    """
    Return the courses over load; the film of rolling roughness is that of smooth contacts.

    Errors of rough contacts are those of changes draw by draw.

    """

    def ensemble(some: list[StudyRow], name: str, rpm: float, factor: float) -> Reading | None:
        wanted: dict[str, Any] = {'rpm': rpm, 'rough': True}
        line = curve(some, 'load', name, **wanted)
        errors = [
            paired_change(some, name, 'load', PRELOAD, load, **wanted)[1] for load in line.at
        ]
        same = factor * np.maximum(SAME * np.abs(line.mean), ERRORS * np.nan_to_num(errors))
        note = f' ({rpm:g} rev/min, one contact, {counted(line.draws)})'
        return read_course(line.at, factor * line.mean, RISES, 'N', same, note)

    points, note = mapped(rows, case=OURS, rpm=ROLLING_RPM), f' ({ROLLING_RPM:g} rev/min)'
    at = np.array([row.load for row in points])
    shares, films = [], []
    for nut in ('loaded', 'relieved'):
        some = nut_rows(rows, nut)
        rcs = np.array([getattr(row, f'rcs_{nut}') for row in points])
        rolling = read_course(at, rcs, RISES, 'N', note=note)
        standing = ensemble(some, 'rcs', SLOW, 1.0)
        shares.append(Trend(f'RCS over load, {nut} nut', 'rises', standing, rolling))
        smooth = curve(some, 'load', 'central_film', rpm=MARK_RPM, rough=False)
        rolling = read_course(smooth.at, NANO * smooth.mean, RISES, 'N')
        standing = ensemble(some, 'mean_film', MARK_RPM, NANO)
        title = f'film over load [nm], {nut} nut, 502.65 mm/s'
        films.append(Trend(title, 'rises', standing, rolling))
    return [*shares, *films]


def _film(rows: list[StudyRow]) -> Trend:
    """Return the central film at the one point that is published, agreeing within `SAME`."""
    readings: list[Reading | None] = []
    for column, rough in (('mean_film', True), ('central_film', False)):
        wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'load': PRELOAD}
        line = curve(rows, 'load', column, rough=rough, **wanted)
        if not len(line.at):
            readings.append(None)
            continue
        film, error = NANO * line.mean[0], np.nan_to_num(NANO * line.error[0])
        near = abs(film - REPORTED_FILM) <= max(SAME * REPORTED_FILM, ERRORS * error)
        said = f'{film:.1f}{f" ± {error:.1f}" if error else ""} nm'
        readings.append(Reading(said, 'yes' if near else 'no'))
    name = 'central film, 502.65 mm/s, preload only'
    return Trend(name, f'{REPORTED_FILM:.0f} nm', *readings)


def marks(screw: Screw, rows: Mapping[str, StudyRow]) -> list[Mark]:
    """Return every number that the rows allow: contacts first, then the screw."""
    every = list(rows.values())
    found = [
        *_contacts(every),
        *_torques(every),
        *_efficiencies(screw, every),
        *_statistical(screw, every),
    ]
    return [mark for mark in found if math.isfinite(mark.value)]


def _contacts(rows: list[StudyRow]) -> Iterator[Mark]:
    """Return films of smooth contacts, and what the load changes of rough ones, draw by draw."""
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'rough': False}
    smooth = NANO * _mean(rows, 'central_film', load=PRELOAD, **wanted)
    short, loaded = (
        NANO * _mean(rows, 'central_film', load=load, case=SHORT, **wanted)
        for load in (PRELOAD, LOADS[-1])
    )
    name, said = (
        'central film, inlet of 1.5 half-widths and 0.113 Pa s',
        f'{REPORTED_FILM:.0f} nm, rough',
    )
    yield Mark('central film, smooth, 502.65 mm/s, preload only', smooth, 'nm', said)
    yield Mark(f'{name}, preload only', short, 'nm', said)
    yield Mark(f'{name}, {LOADS[-1]:g} N over preload only', loaded / short, '', WITH_LOAD)
    centre, load = 'distance of the asperity load from the centre', ROUGH_LOADS[-1]
    for name, column, rpm, said in (
        ('RCS', 'rcs', ONSET, WITH_LOAD),
        (centre, 'asperity_distance', SLOW, 'trend: moves to the centre'),
    ):
        wanted = {'kind': 'contact', 'rough': True, 'rpm': rpm}
        mean, error, draws = paired_change(rows, column, 'load', PRELOAD, load, **wanted)
        words = f'{name}, one contact, standing, {rpm:g} rev/min, {load:g} N less preload only'
        yield Mark(f'{words}, {counted(draws)}', mean, '', said, error)


def _torques(rows: list[StudyRow]) -> Iterator[Mark]:
    """Return the rolling share of the torque, and other rules of friction beside ours."""
    wanted: dict[str, Any] = {'kind': 'screw', 'load': PRELOAD, 'rpm': MARK_RPM}
    for name, above, below, case in (
        ('rolling share of the torque, rolling roughness', 'rolling', 'friction', OURS),
        ('rolling share of the torque, standing roughness', 'rolling', 'friction', STANDING),
        (
            "sliding torque with the central film in Eyring's law over ours",
            *('central_film', 'sliding', OURS),
        ),
        ('torque of friction along the track over ours', 'track', 'friction', OURS),
    ):
        part, whole = (
            _mean(rows, f'{torque}_torque', case=case, **wanted) for torque in (above, below)
        )
        only = ', preload only' if above == 'rolling' else ''
        yield Mark(f'{name}, 600 rev/min{only}', part / whole)


def _efficiencies(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    """Return efficiencies where the roughness rolls, with and without the rolling losses."""
    points = mapped(rows, case=OURS)
    at_load = [row for row in points if row.load == EFFICIENCY_LOAD]
    if len(at_load) < 2:
        return []
    eta, free = (
        efficiencies(screw, at_load, f'{name}_torque') for name in ('friction', 'sliding')
    )
    best = int(np.argmax(eta))
    constant = [constant_friction_efficiency(screw, row.load) for row in points]
    gains = efficiencies(screw, points) - constant
    least = points[int(np.argmin(gains))]
    places = [f'{row.rpm:g} rev/min, {EFFICIENCY_LOAD:g} N' for row in at_load]
    name = (
        f'efficiency less that of constant friction 0.005, least of {len(points)} points, '
        f'at {least.rpm:g} rev/min, {least.load:g} N'
    )
    return [
        Mark(f'best efficiency, {places[best]}', eta[best]),
        *(
            Mark(f'efficiency without rolling losses, {places[i]}', free[i], '', ETA_RISES)
            for i in sorted({0, best, len(free) - 1})
        ),
        Mark(name, float(gains.min()), '', 'trend: mixed EHL is above'),
    ]


def _statistical(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    """Return what published formulas with a statistical asperity share say."""
    speeds = sorted(pick(rows, kind='formulas', load=EFFICIENCY_LOAD), key=lambda row: row.rpm)
    if len(speeds) < 2:
        return []
    shares = [
        _mean(rows, 'rcs_loaded', kind='formulas', rpm=MARK_RPM, load=load)
        for load in (PRELOAD, LOADS[-1])
    ]
    eta = efficiencies(screw, speeds, 'sliding_torque')
    touching = sum(row.rcs >= RCS_LIMIT for row in speeds)  # the slowest: the share falls
    share = f'statistical share, loaded nut, 600 rev/min, {LOADS[-1]:g} N over preload only'
    name = f'efficiency, statistical share, without rolling losses, {EFFICIENCY_LOAD:g} N'
    return [
        Mark(share, shares[1] / shares[0], '', WITH_LOAD),
        *(Mark(f'{name}, {speeds[i].rpm:g} rev/min', eta[i], '', ETA_RISES) for i in (0, -1)),
        Mark(
            f'{name}, least step between speeds with a share of {RCS_LIMIT:g} or more',
            float(np.diff(eta[:touching]).min(initial=math.inf)),
        ),
    ]


def _mean(rows: Iterable[StudyRow], name: str, **wanted: Any) -> float:
    values = [getattr(row, name) for row in pick(rows, **wanted)]
    return float(np.mean(values)) if values else math.nan
