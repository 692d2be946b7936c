# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The page of the comparison with the published study: its trends, and numbers that are none.

A trend is the course of a number over speed or load, for roughness that stands still and that
rolls. Ours agrees where it takes the reported course, in part where it takes that among others.

"""

from collections.abc import Iterable, Iterator, Mapping
import math
from typing import Any, Literal, NamedTuple

import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import Screw
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.full_record import law_sentence
from surrogate.studies import curves, tasks
from surrogate.studies.curves import Array, Curve, mean_of, screw_speeds, StudyRow
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
RISES_THEN_FALLS = ('rises', 'falls')
ETA_RISES, WITH_LOAD = 'trend: rises with speed', 'trend: rises with load'


class Reading(NamedTuple):
    """A trend by one model, in words, and whether the study reports the same."""

    text: str
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
        trend_table(trends(screw, law, rows.values())),
        '## Other numbers',
        table(marks(screw, rows)),
    )
    return '\n\n'.join(parts) + '\n'


def trend_table(every: Iterable[Trend]) -> str:
    """Return trends as a table in Markdown; a column for each model, and what agrees."""
    heads = 'trend', 'published', 'standing roughness', 'agrees', 'rolling roughness', 'agrees'
    rows = (
        [name, published, *(cell for reading in readings for cell in reading or ('', ''))]
        for name, published, *readings in every
    )
    return curves.markdown_table(heads, rows)


def table(every: Iterable[Mark]) -> str:
    """Return marks as a table in Markdown."""
    rows = ((mark.name, mark.shown, mark.reported) for mark in every)
    return curves.markdown_table(('number', 'ours', 'reported'), rows)


def trends(screw: Screw, law: AsperityLaw, rows: Iterable[StudyRow]) -> list[Trend]:
    """Return every trend that the rows tell something of."""
    known = list(rows)
    speed, load = f'speed, {tasks.EFFICIENCY_LOAD:g} N', f'load, {tasks.MARK_RPM:g} rev/min'
    every = [
        _contact_ends(screw, law, known),
        *_over_speed(known),
        _efficiency(screw, known, speed, 'rpm', load=tasks.EFFICIENCY_LOAD),
        _efficiency(screw, known, load, 'load', rpm=tasks.MARK_RPM),
        *_over_load(known),
    ]
    readings: list[Reading | None] = [None, None]
    for i, (column, rough) in enumerate((('mean_film', True), ('central_film', False))):
        wanted: dict[str, Any] = {'kind': 'contact', 'rpm': tasks.MARK_RPM, 'load': tasks.PRELOAD}
        line = curves.curve(known, 'load', column, rough=rough, **wanted)
        if len(line.at):
            film, error = NANO * line.mean[0], np.nan_to_num(NANO * line.error[0])
            same = max(SAME * tasks.REPORTED_FILM, ERRORS * error)
            near = abs(film - tasks.REPORTED_FILM) <= same
            text = f'{film:.1f}{f" ± {error:.1f}" if error else ""} nm'
            readings[i] = Reading(text, 'yes' if near else 'no')
    name = 'central film, 502.65 mm/s, preload only'
    every.append(Trend(name, f'{tasks.REPORTED_FILM:.0f} nm', *readings))
    return [trend for trend in every if trend.standing or trend.rolling]


def course(values: Array, same: Array) -> list[tuple[str, int]]:
    """
    Return where values fall and rise, in order: the word, and the place at which that ends.

    A change by less than `same`, in the unit of the values, counts as none.

    """
    turns: list[tuple[str, int]] = []
    low = high = 0
    for i, value in enumerate(values):
        word = turns[-1][0] if turns else ''
        low = i if value < values[low] else low
        high = i if value > values[high] else high
        if word != 'rises' and value > values[low] + same[i]:
            turns, high = [*turns, ('rises', i)], i
        elif word != 'falls' and value < values[high] - same[i]:
            turns, low = [*turns, ('falls', i)], i
        elif word and i == (high if word == 'rises' else low):
            turns[-1] = (word, i)
    return turns


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
    text = f'{values[0]:.3g} at {at[0]:g} {unit}, {", ".join(path)}{note}'
    return Reading(text, 'yes' if words == reported else part)


def counted(draws: int) -> str:
    """Return a number of draws in words."""
    return 'one draw' if draws == 1 else f'{draws} draws'


def _contact_ends(screw: Screw, law: AsperityLaw, rows: list[StudyRow]) -> Trend:
    film = screw_speeds(rows, 'central_film')

    def end(rcs: Curve, note: str) -> Reading | None:
        speed = curves.crossing(rcs, RCS_LIMIT)
        if math.isnan(speed) or not len(film.at):
            return None
        ratio = float(np.interp(speed, film.at, film.mean)) / screw.roughness.rms
        inside = DETERMINISTIC[0] <= ratio <= DETERMINISTIC[1]
        text = f'{speed:.3g} rev/min, film ratio {ratio:.3g}{note}'
        return Reading(text, 'yes' if inside else 'no')

    both = (
        end(curves.contact_speeds(rows), ' (one contact, roughness of the study)'),
        end(screw_speeds(rows, 'rcs', tasks.STANDING), ' (screw, Rq by the standard)'),
    )
    stands = [reading for reading in both if reading]
    agrees: Agreement = 'yes' if all(reading.agrees == 'yes' for reading in stands) else 'no'
    return Trend(
        f'contact at higher speeds: RCS passes {RCS_LIMIT:g}, preload only',
        'higher; deterministic solutions begin at film ratios of '
        f'{DETERMINISTIC[0]:g} to {DETERMINISTIC[1]:g}',
        Reading('; '.join(reading.text for reading in stands), agrees) if stands else None,
        end(
            screw_speeds(rows, 'rcs'), f', standard deviation {100 * law.deviation:.0f} % in film'
        ),
    )


def _over_speed(rows: list[StudyRow]) -> Iterator[Trend]:
    contact, rolling = curves.contact_speeds(rows), screw_speeds(rows, 'rcs')
    note = f' (one contact, {counted(contact.draws)})'
    yield Trend(
        'RCS, preload only',
        'falls',
        read_course(contact.at, contact.mean, FALLS, 'rev/min', note=note),
        read_course(rolling.at, rolling.mean, FALLS, 'rev/min'),
    )
    cases = tasks.STANDING, tasks.OURS
    torque, friction = (
        [screw_speeds(rows, name, case) for case in cases]
        for name in ('friction_torque', 'friction_coefficient')
    )
    apparent = [curves.apparent_friction(rows, case) for case in cases]
    for name, factor, lines in (
        ('friction torque [mN m], preload only', MILLI, torque),
        ('friction coefficient of the sliding, preload only', 1.0, friction),
        ('friction coefficient, all losses taken as sliding', 1.0, apparent),
    ):
        both = [read_course(line.at, factor * line.mean, TURNS, 'rev/min') for line in lines]
        yield Trend(name, 'falls, then rises', *both)


def _efficiency(
    screw: Screw, rows: list[StudyRow], name: str, along: curves.Along, **wanted: float
) -> Trend:
    reported = RISES if along == 'rpm' else RISES_THEN_FALLS
    readings = []
    for case in (tasks.STANDING, tasks.OURS):
        points = curves.mapped(rows, case=case, **wanted)
        at = np.array([getattr(row, along) for row in points])
        same = np.full(len(at), EFFICIENCY_TOLERANCE)
        unit, eta = 'rev/min' if along == 'rpm' else 'N', curves.efficiencies(screw, points)
        readings.append(read_course(at, eta, reported, unit, same))
    return Trend(f'efficiency over {name}', ', then '.join(reported), *readings)


def _over_load(rows: list[StudyRow]) -> list[Trend]:
    """
    Return the courses over load; the film of rolling roughness is that of smooth contacts.

    Errors of rough contacts are those of changes draw by draw.

    """

    def ensemble(contacts: list[StudyRow], name: str, rpm: float, factor: float) -> Reading | None:
        wanted: dict[str, Any] = {'rpm': rpm, 'rough': True}
        line = curves.curve(contacts, 'load', name, **wanted)
        errors = [
            curves.paired_change(contacts, name, 'load', tasks.PRELOAD, load, **wanted)[1]
            for load in line.at
        ]
        same = factor * np.maximum(SAME * np.abs(line.mean), ERRORS * np.nan_to_num(errors))
        note = f' ({rpm:g} rev/min, one contact, {counted(line.draws)})'
        return read_course(line.at, factor * line.mean, RISES, 'N', same, note)

    points, note = curves.mapped(rows, rpm=tasks.ROLLING_RPM), f' ({tasks.ROLLING_RPM:g} rev/min)'
    at = np.array([row.load for row in points])
    shares, films = [], []
    for nut in ('loaded', 'relieved'):
        contacts = curves.nut_rows(rows, nut)
        rcs = np.array([getattr(row, f'rcs_{nut}') for row in points])
        both = (
            ensemble(contacts, 'rcs', tasks.SLOW, 1.0),
            read_course(at, rcs, RISES, 'N', note=note),
        )
        shares.append(Trend(f'RCS over load, {nut} nut', 'rises', *both))
        smooth = curves.curve(contacts, 'load', 'central_film', rpm=tasks.MARK_RPM, rough=False)
        rolling = read_course(smooth.at, NANO * smooth.mean, RISES, 'N')
        both = ensemble(contacts, 'mean_film', tasks.MARK_RPM, NANO), rolling
        films.append(Trend(f'film over load [nm], {nut} nut, 502.65 mm/s', 'rises', *both))
    return [*shares, *films]


def marks(screw: Screw, rows: Mapping[str, StudyRow]) -> list[Mark]:
    """Return every number that the rows allow: contacts first, then the screw."""
    known = list(rows.values())
    every = [*_contacts(known), *_torques(known)]
    alone, loaded = (
        mean_of(known, 'rcs_loaded', kind='formulas', rpm=tasks.MARK_RPM, load=load)
        for load in (tasks.PRELOAD, tasks.LOADS[-1])
    )
    share = f'statistical share, loaded nut, 600 rev/min, {tasks.LOADS[-1]:g} N over preload only'
    every.append(Mark(share, loaded / alone, '', WITH_LOAD))
    speeds = curves.mapped(known, kind='formulas', load=tasks.EFFICIENCY_LOAD)
    eta = curves.efficiencies(screw, speeds, 'sliding_torque')
    name = f'efficiency, statistical share, without rolling losses, {tasks.EFFICIENCY_LOAD:g} N'
    for i in (0, -1) if len(speeds) > 1 else ():
        every.append(Mark(f'{name}, {speeds[i].rpm:g} rev/min', eta[i], '', ETA_RISES))
    return [mark for mark in every if math.isfinite(mark.value)]


def _contacts(rows: list[StudyRow]) -> Iterator[Mark]:
    """Return films of smooth contacts, and what the load changes of rough ones, draw by draw."""
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': tasks.MARK_RPM, 'rough': False}
    smooth = NANO * mean_of(rows, 'central_film', load=tasks.PRELOAD, **wanted)
    short, loaded = (
        NANO * mean_of(rows, 'central_film', load=load, case=tasks.SHORT, **wanted)
        for load in (tasks.PRELOAD, tasks.LOADS[-1])
    )
    name = 'central film, inlet of 1.5 half-widths and 0.113 Pa s'
    rough = f'{tasks.REPORTED_FILM:.0f} nm, rough'
    yield Mark('central film, smooth, 502.65 mm/s, preload only', smooth, 'nm', rough)
    yield Mark(f'{name}, preload only', short, 'nm', rough)
    yield Mark(f'{name}, {tasks.LOADS[-1]:g} N over preload only', loaded / short, '', WITH_LOAD)
    centre, load = 'distance of the asperity load from the centre', tasks.ROUGH_LOADS[-1]
    for name, column, rpm, reported in (
        ('RCS', 'rcs', tasks.ONSET, WITH_LOAD),
        (centre, 'asperity_distance', tasks.SLOW, 'trend: moves to the centre'),
    ):
        wanted = {'kind': 'contact', 'rough': True, 'rpm': rpm}
        mean, error, draws = curves.paired_change(
            rows, column, 'load', tasks.PRELOAD, load, **wanted
        )
        words = f'{name}, one contact, standing, {rpm:g} rev/min, {load:g} N less preload only'
        yield Mark(f'{words}, {counted(draws)}', mean, '', reported, error)


def _torques(rows: list[StudyRow]) -> Iterator[Mark]:
    """Return the rolling share of the torque, and other rules of friction beside ours."""
    central = "sliding torque with the central film in Eyring's law over ours, 600 rev/min"
    wanted: dict[str, Any] = {'kind': 'screw', 'load': tasks.PRELOAD, 'rpm': tasks.MARK_RPM}
    share = 'rolling share of the torque, {} roughness, 600 rev/min, preload only'
    for name, part, whole, case in (
        (share.format('rolling'), 'rolling', 'friction', tasks.OURS),
        (share.format('standing'), 'rolling', 'friction', tasks.STANDING),
        (central, 'central_film', 'sliding', tasks.OURS),
        (
            'torque of friction along the track over ours, 600 rev/min',
            'track',
            'friction',
            tasks.OURS,
        ),
    ):
        above, below = (
            mean_of(rows, f'{torque}_torque', case=case, **wanted) for torque in (part, whole)
        )
        yield Mark(name, above / below)
