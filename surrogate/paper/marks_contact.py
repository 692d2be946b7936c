# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of single contacts: films, asperities, and what other assumptions make of them."""

from dataclasses import replace
from typing import Any

from surrogate.paper.cases import (
    CLEAR,
    HIGH,
    LOADS,
    MARK_RPM,
    ONSET,
    OURS,
    PRELOAD,
    RELIEVED,
    RELIEVED_LOADS,
    ROUGH_LOADS,
    SHORT,
    SLOW,
    SMOOTH,
    THIN,
)
from surrogate.paper.curves import crossing, curve, paired_change, pick
from surrogate.paper.mark import counted, FILM_SAID, Mark, mean_of, over_preload
from surrogate.paper.rows import StudyRow
from surrogate.surface.aims import RCS_LIMIT
from surrogate.units import NANO

ROUGH: dict[str, Any] = {'kind': 'contact', 'rough': True}
FILM_RISES = 'trend: rises with load'
RCS_RISES = 'trend: rises with load'


def contact_marks(rows: list[StudyRow]) -> list[Mark]:
    """Return the numbers of contacts."""
    return [
        *_smooth_film(rows),
        *_rough_film(rows),
        *_asperities(rows),
        *_loads(rows),
        *_other_contacts(rows),
    ]


def _smooth_film(rows: list[StudyRow]) -> list[Mark]:
    smooth: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'rough': False}
    top, relieved = LOADS[-1], RELIEVED_LOADS[-1]
    return [
        Mark(
            name='central film, smooth, 502.65 mm/s, preload only',
            value=NANO * mean_of(rows, 'central_film', load=PRELOAD, **smooth),
            unit='nm',
            reported=FILM_SAID,
        ),
        Mark(
            name=f'central film, smooth, loaded nut, {top:g} N over preload only',
            value=over_preload(rows, 'central_film', top, **smooth),
            reported=FILM_RISES,
        ),
        Mark(
            name=f'central film, smooth, relieved nut, {relieved:g} N over preload only',
            value=over_preload(rows, 'central_film', relieved, case=RELIEVED, **smooth),
            reported=FILM_RISES,
        ),
    ]


def _rough_film(rows: list[StudyRow]) -> list[Mark]:
    wanted, last = {'rpm': MARK_RPM, **ROUGH}, ROUGH_LOADS[-1]
    film = curve(rows, 'load', 'mean_film', **wanted)
    mean, error, draws = paired_change(rows, 'mean_film', 'load', PRELOAD, last, **wanted)
    if not draws:
        return []
    ends = [
        {row.draw: row.central_film for row in pick(rows, load=load, **wanted)}
        for load in (PRELOAD, last)
    ]
    ratios = [ends[1][draw] / ends[0][draw] for draw in ends[0] if draw in ends[1]]
    return [
        Mark(
            name=f'mean film of the inner half, rough, 502.65 mm/s, preload, {counted(draws)}',
            value=NANO * film.mean[0],
            error=NANO * film.error[0],
            unit='nm',
            reported=FILM_SAID,
        ),
        Mark(
            name=f'mean film of the inner half, rough, {last:g} N less preload only',
            value=NANO * mean,
            error=NANO * error,
            unit='nm',
            reported=FILM_RISES,
        ),
        *(
            Mark(
                name=f'film at the very centre, rough, {last:g} N over preload only, {which} draw',
                value=value,
                reported=FILM_RISES,
            )
            for which, value in (('lowest', min(ratios)), ('highest', max(ratios)))
        ),
    ]


def _asperities(rows: list[StudyRow]) -> list[Mark]:
    found = []
    for rpm in (SLOW, ONSET, CLEAR):
        rcs = curve(rows, 'rpm', 'rcs', rpm=rpm, load=PRELOAD, **ROUGH)
        if rcs.draws > 1:
            found.append(
                Mark(
                    name=f'RCS at {rpm:g} rev/min, preload only, {counted(rcs.draws)}',
                    value=rcs.mean[0],
                    error=rcs.error[0],
                    reported='trend: falls with speed',
                )
            )
    return found


def _loads(rows: list[StudyRow]) -> list[Mark]:
    """Return what changes with the load, in the same draws."""
    relieved = relieved_rows(rows)
    distance = 'distance of the asperity load from the centre'
    centre = 'trend: moves to the centre'
    return [
        mark
        for load in ROUGH_LOADS[1:]
        for mark in (
            _change('RCS, loaded nut', 'rcs', rows, SLOW, load, RCS_RISES),
            _change('RCS, loaded nut', 'rcs', rows, ONSET, load, RCS_RISES),
            _change('RCS, relieved nut', 'rcs', relieved, ONSET, load, RCS_RISES),
            _change(f'{distance}, loaded nut', 'asperity_distance', rows, SLOW, load, centre),
        )
    ]


def relieved_rows(rows: list[StudyRow]) -> list[StudyRow]:
    """Return rough contacts of the relieved nut as a case of its own, from preload on."""
    return [
        replace(row, case=OURS)
        for row in rows
        if row.kind == 'contact'
        and row.draw != SMOOTH
        and (row.case == RELIEVED or (row.case == OURS and row.load == PRELOAD))
    ]


def _change(
    name: str, column: str, rows: list[StudyRow], rpm: float, load: float, said: str
) -> Mark:
    """Return by how much a column differs from preload, in the same draws."""
    mean, error, draws = paired_change(rows, column, 'load', PRELOAD, load, rpm=rpm, **ROUGH)
    return Mark(
        name=f'{name}, {rpm:g} rev/min, {load:g} N less preload only, {counted(draws)}',
        value=mean,
        error=error,
        reported=said,
    )


def _other_contacts(rows: list[StudyRow]) -> list[Mark]:
    short: dict[str, Any] = {'kind': 'contact', 'case': SHORT, 'rpm': MARK_RPM}
    found = [
        Mark(
            name=f'speed where RCS passes {RCS_LIMIT:g}, {name}, one contact',
            value=crossing(curve(rows, 'rpm', 'rcs', load=PRELOAD, case=case, **ROUGH), RCS_LIMIT),
            unit='rev/min',
        )
        for case, name in ((THIN, 'oil at 80 degC'), (HIGH, 'floor 10 nm'))
    ]
    name = 'central film, inlet of 1.5 half-widths and 0.113 Pa s'
    return [
        *found,
        Mark(
            name='central film, smooth, oil at 80 degC, 502.65 mm/s, preload only',
            value=NANO
            * mean_of(rows, 'central_film', case=THIN, rpm=MARK_RPM, rough=False, load=PRELOAD),
            unit='nm',
            reported=FILM_SAID,
        ),
        Mark(
            name=f'{name}, preload only',
            value=NANO * mean_of(rows, 'central_film', load=PRELOAD, **short),
            unit='nm',
            reported=FILM_SAID,
        ),
        Mark(
            name=f'{name}, {LOADS[-1]:g} N over preload only',
            value=over_preload(rows, 'central_film', LOADS[-1], **short),
            reported=FILM_RISES,
        ),
    ]
