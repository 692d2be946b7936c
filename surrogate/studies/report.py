# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The page of the comparison with the published study: its trends beside ours.

A trend is the course of a number over speed or load, for single contacts whose roughness stands
still and for the screw, whose roughness rolls. Ours agrees where it takes the reported course, in
part where it takes that among others.

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
from surrogate.studies.curves import Array, Curve, screw_speeds, StudyRow
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


def report(screw: Screw, law: AsperityLaw, rows: Mapping[str, StudyRow]) -> str:
    """Return the page: where its numbers are from, the trends side by side, other numbers."""
    seconds = sum(row.seconds for row in rows.values() if row.status == 'CONVERGED')
    parts = (
        '# Numbers beside the published study',
        'Written by `ballscrew figures`; docs/theory/validation.md says what they mean. '
        f'{len(rows)} solves, {seconds:.0f} s of processor time.',
        f'Rolling: {law_sentence(screw, ScrewSettings())}; that film has a '
        f'standard deviation of {100 * law.deviation:.0f} %.',
        'Standing roughness is that of the study, in single contacts; rolling roughness that of '
        'the screw. Agrees: the course over all places is the reported one; in part: a part of it '
        f'is. Changes below {100 * SAME:g} %, of efficiencies below {EFFICIENCY_TOLERANCE:g}, of '
        f'means below {ERRORS:g} standard errors, count as none.',
        trend_table(trends(screw, law, rows.values())),
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


def trends(screw: Screw, law: AsperityLaw, rows: Iterable[StudyRow]) -> list[Trend]:
    """Return every trend that the rows tell something of."""
    known = list(rows)
    every = [
        _contact_ends(screw, law, known),
        *_over_speed(known),
        *_efficiency(screw, known),
        *_over_load(known),
        _film(known),
    ]
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

    return Trend(
        f'contact at higher speeds: RCS passes {RCS_LIMIT:g}, preload only',
        'higher; deterministic solutions begin at film ratios of '
        f'{DETERMINISTIC[0]:g} to {DETERMINISTIC[1]:g}',
        end(curves.contact_speeds(rows), ''),
        end(
            screw_speeds(rows, 'rcs'), f', standard deviation {100 * law.deviation:.0f} % in film'
        ),
    )


def _over_speed(rows: list[StudyRow]) -> Iterator[Trend]:
    contact, rolling = curves.contact_speeds(rows), screw_speeds(rows, 'rcs')
    note = f' ({counted(contact.draws)})'
    yield Trend(
        'RCS, preload only',
        'falls',
        read_course(contact.at, contact.mean, FALLS, 'rev/min', note=note),
        read_course(rolling.at, rolling.mean, FALLS, 'rev/min'),
    )
    torque, friction = (
        screw_speeds(rows, name) for name in ('friction_torque', 'friction_coefficient')
    )
    for name, factor, line in (
        ('friction torque [mN m], preload only', MILLI, torque),
        ('friction coefficient of the sliding, preload only', 1.0, friction),
        ('friction coefficient, all losses taken as sliding', 1.0, curves.apparent_friction(rows)),
    ):
        course_of = read_course(line.at, factor * line.mean, TURNS, 'rev/min')
        yield Trend(name, 'falls, then rises', None, course_of)


def _efficiency(screw: Screw, rows: list[StudyRow]) -> Iterator[Trend]:
    for name, unit, reported, wanted in (
        ('speed', 'rev/min', RISES, {'load': tasks.EFFICIENCY_LOAD}),
        ('load', 'N', RISES_THEN_FALLS, {'rpm': tasks.MARK_RPM}),
    ):
        points = curves.mapped(rows, **wanted)
        at = np.array([row.rpm if name == 'speed' else row.load for row in points])
        eta, same = curves.efficiencies(screw, points), np.full(len(at), EFFICIENCY_TOLERANCE)
        ((other, value),) = wanted.items()
        place = f'{value:g} {"N" if other == "load" else "rev/min"}'
        reading = read_course(at, eta, reported, unit, same)
        yield Trend(f'efficiency over {name}, {place}', ', then '.join(reported), None, reading)


def _over_load(rows: list[StudyRow]) -> Iterator[Trend]:
    """Yield the courses over load; the film of rolling roughness is that of smooth contacts."""
    points, note = curves.mapped(rows, rpm=tasks.ROLLING_RPM), f' ({tasks.ROLLING_RPM:g} rev/min)'
    at = np.array([row.load for row in points])
    contacts = {nut: curves.nut_rows(rows, nut) for nut in (tasks.LOADED, tasks.RELIEVED)}
    for nut, known in contacts.items():
        rcs = np.array([getattr(row, f'rcs_{nut}') for row in points])
        standing = _ensemble(known, 'rcs', tasks.SLOW, RISES)
        rolling = read_course(at, rcs, RISES, 'N', note=note)
        yield Trend(f'RCS over load, {nut} nut', 'rises', standing, rolling)
    yield Trend(
        'distance of the asperity load from the centre over load, loaded nut',
        'falls',
        _ensemble(contacts[tasks.LOADED], 'asperity_distance', tasks.SLOW, FALLS),
        None,
    )
    for nut, known in contacts.items():
        smooth = curves.curve(known, 'load', 'central_film', rpm=tasks.MARK_RPM, rough=False)
        standing = _ensemble(known, 'mean_film', tasks.MARK_RPM, RISES, NANO)
        rolling = read_course(smooth.at, NANO * smooth.mean, RISES, 'N')
        yield Trend(f'film over load [nm], {nut} nut, 502.65 mm/s', 'rises', standing, rolling)


def _ensemble(
    contacts: list[StudyRow], name: str, rpm: float, reported: tuple[str, ...], factor: float = 1.0
) -> Reading | None:
    """Return the course of rough contacts over load; errors are of changes draw by draw."""
    wanted: dict[str, Any] = {'rpm': rpm, 'rough': True}
    line = curves.curve(contacts, 'load', name, **wanted)
    errors = [curves.paired_error(contacts, name, load, **wanted) for load in line.at]
    same = factor * np.maximum(SAME * np.abs(line.mean), ERRORS * np.nan_to_num(errors))
    note = f' ({rpm:g} rev/min, {counted(line.draws)})'
    return read_course(line.at, factor * line.mean, reported, 'N', same, note)


def _film(rows: list[StudyRow]) -> Trend:
    """Return the central film that is published; that of rolling roughness is smooth."""
    readings: list[Reading | None] = [None, None]
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': tasks.MARK_RPM, 'load': tasks.PRELOAD}
    for i, (column, rough) in enumerate((('mean_film', True), ('central_film', False))):
        line = curves.curve(rows, 'load', column, rough=rough, **wanted)
        if len(line.at):
            film, error = NANO * line.mean[0], np.nan_to_num(NANO * line.error[0])
            same = max(SAME * tasks.REPORTED_FILM, ERRORS * error)
            near = abs(film - tasks.REPORTED_FILM) <= same
            text = f'{film:.1f}{f" ± {error:.1f}" if error else ""} nm'
            readings[i] = Reading(text, 'yes' if near else 'no')
    name = 'central film, 502.65 mm/s, preload only'
    return Trend(name, f'{tasks.REPORTED_FILM:.0f} nm', *readings)
