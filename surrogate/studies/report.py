# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page of the comparison with the published study: its trends, and numbers that are none."""

from collections.abc import Iterable, Mapping
import math
from typing import Any, NamedTuple

import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import Screw
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.full_record import law_sentence
from surrogate.studies.readings import (
    counted,
    ERRORS,
    REPORTED_FILM,
    SAME,
    summary,
    trend_table,
    trends,
)
from surrogate.studies.rows import (
    constant_friction_efficiency,
    efficiencies,
    mapped,
    paired_change,
    pick,
    StudyRow,
)
from surrogate.studies.tasks import (
    EFFICIENCY_LOAD,
    LOADS,
    MARK_RPM,
    ONSET,
    OURS,
    PRELOAD,
    ROUGH_LOADS,
    SHORT,
    SLOW,
    STANDING,
)
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, RCS_LIMIT
from surrogate.units import NANO

FILM_SAID = f'{REPORTED_FILM:.0f} nm, rough'
ETA_RISES, WITH_LOAD = 'trend: rises with speed', 'trend: rises with load'


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
        f'Rolling: {law_sentence(screw, ScrewSettings())}; that speed has a '
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


def table(found: Iterable[Mark]) -> str:
    """Return marks as a table in Markdown."""
    lines = ['| number | ours | reported |', '|---|---|---|']
    return '\n'.join(lines + [f'| {m.name} | {m.shown} | {m.reported} |' for m in found])


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


def _mean(rows: Iterable[StudyRow], name: str, **wanted: Any) -> float:
    values = [getattr(row, name) for row in pick(rows, **wanted)]
    return float(np.mean(values)) if values else math.nan


def _contacts(rows: list[StudyRow]) -> list[Mark]:
    """Return films of smooth contacts, and what the load changes of rough ones."""
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'rough': False}
    smooth = NANO * _mean(rows, 'central_film', load=PRELOAD, **wanted)
    short, loaded = (
        NANO * _mean(rows, 'central_film', load=load, case=SHORT, **wanted)
        for load in (PRELOAD, LOADS[-1])
    )
    name = 'central film, inlet of 1.5 half-widths and 0.113 Pa s'
    return [
        Mark('central film, smooth, 502.65 mm/s, preload only', smooth, 'nm', FILM_SAID),
        Mark(f'{name}, preload only', short, 'nm', FILM_SAID),
        Mark(f'{name}, {LOADS[-1]:g} N over preload only', loaded / short, '', WITH_LOAD),
        _change('RCS', 'rcs', rows, ONSET, WITH_LOAD),
        _change(
            'distance of the asperity load from the centre',
            'asperity_distance',
            rows,
            SLOW,
            'trend: moves to the centre',
        ),
    ]


def _change(name: str, column: str, rows: list[StudyRow], rpm: float, said: str) -> Mark:
    """Return by how much a column of standing roughness differs from preload, draw by draw."""
    load, wanted = ROUGH_LOADS[-1], {'kind': 'contact', 'rough': True, 'rpm': rpm}
    mean, error, draws = paired_change(rows, column, 'load', PRELOAD, load, **wanted)
    words = f'{name}, one contact, standing, {rpm:g} rev/min, {load:g} N less preload only'
    return Mark(f'{words}, {counted(draws)}', mean, '', said, error)


def _torques(rows: list[StudyRow]) -> list[Mark]:
    """Return the rolling share of the torque, and other rules of friction beside ours."""
    wanted: dict[str, Any] = {'kind': 'screw', 'load': PRELOAD, 'rpm': MARK_RPM}
    torque, rolling, sliding, central, track = (
        {case: _mean(rows, f'{name}_torque', case=case, **wanted) for case in (OURS, STANDING)}
        for name in ('friction', 'rolling', 'sliding', 'central_film', 'track')
    )
    name = 'rolling share of the torque, {} roughness, 600 rev/min, preload only'
    return [
        Mark(name.format('rolling'), rolling[OURS] / torque[OURS]),
        Mark(name.format('standing'), rolling[STANDING] / torque[STANDING]),
        Mark(
            "sliding torque with the central film in Eyring's law over ours, 600 rev/min",
            central[OURS] / sliding[OURS],
        ),
        Mark(
            'torque of friction along the track over ours, 600 rev/min', track[OURS] / torque[OURS]
        ),
    ]


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
