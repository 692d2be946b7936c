# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of the comparison with the published study that are no trends."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from surrogate.paper.cases import (
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
from surrogate.paper.curves import (
    constant_friction_efficiency,
    efficiencies,
    mapped,
    paired_change,
    pick,
)
from surrogate.paper.rows import StudyRow
from surrogate.parameters import Screw
from surrogate.surface.aims import RCS_LIMIT
from surrogate.units import NANO

REPORTED_FILM = 153.0
"""Central film at 502.65 mm/s and preload only, published for the rough surface [nm]."""
FILM_SAID = f'{REPORTED_FILM:.0f} nm, rough'
ETA_RISES, WITH_LOAD = 'trend: rises with speed', 'trend: rises with load'


@dataclass(frozen=True, kw_only=True, slots=True)
class Mark:
    """
    A number of ours: what it is, value, standard error (NaN: none), unit, what is reported.

    `trend` in what is reported means that only the direction is known.

    """

    name: str
    value: float
    unit: str = '-'
    reported: str = ''
    error: float = math.nan

    @property
    def shown(self) -> str:
        """Return value, error and unit as text."""
        more = '' if math.isnan(self.error) else f' ± {self.error:.2g}'
        unit = '' if self.unit == '-' else f' {self.unit}'
        return f'{self.value:.4g}{more}{unit}'


def table(found: Iterable[Mark]) -> str:
    """Return marks as a table in Markdown."""
    lines = ['| number | ours | reported |', '|---|---|---|']
    return '\n'.join(lines + [f'| {m.name} | {m.shown} | {m.reported} |' for m in found])


def counted(draws: int) -> str:
    """Return a number of draws in words."""
    return 'one draw' if draws == 1 else f'{draws} draws'


def mean_of(rows: Iterable[StudyRow], name: str, **wanted: Any) -> float:
    """Return the mean of a column over the rows with the wanted values; NaN without any."""
    values = [getattr(row, name) for row in pick(rows, **wanted)]
    return float(np.mean(values)) if values else math.nan


def over_preload(rows: Iterable[StudyRow], name: str, load: float, **wanted: Any) -> float:
    """Return a column at a `load` [N] over that at preload [-]."""
    rows = list(rows)
    last = mean_of(rows, name, load=load, **wanted)
    return last / mean_of(rows, name, load=PRELOAD, **wanted)


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


def _contacts(rows: list[StudyRow]) -> list[Mark]:
    """Return films of smooth contacts, and what the load changes of rough ones."""
    smooth: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'rough': False}
    short = 'central film, inlet of 1.5 half-widths and 0.113 Pa s'
    last = ROUGH_LOADS[-1]
    return [
        *(
            Mark(
                name=f'{name}, preload only',
                value=NANO * mean_of(rows, 'central_film', load=PRELOAD, case=case, **smooth),
                unit='nm',
                reported=FILM_SAID,
            )
            for name, case in (('central film, smooth, 502.65 mm/s', OURS), (short, SHORT))
        ),
        Mark(
            name=f'{short}, {LOADS[-1]:g} N over preload only',
            value=over_preload(rows, 'central_film', LOADS[-1], case=SHORT, **smooth),
            reported=WITH_LOAD,
        ),
        _change('RCS', 'rcs', rows, ONSET, last, WITH_LOAD),
        _change(
            'distance of the asperity load from the centre',
            'asperity_distance',
            rows,
            SLOW,
            last,
            'trend: moves to the centre',
        ),
    ]


def _change(
    name: str, column: str, rows: list[StudyRow], rpm: float, load: float, said: str
) -> Mark:
    """Return by how much a column of standing roughness differs from preload, draw by draw."""
    mean, error, draws = paired_change(
        rows, column, 'load', PRELOAD, load, rpm=rpm, kind='contact', rough=True
    )
    return Mark(
        name=f'{name}, one contact, standing, {rpm:g} rev/min, {load:g} N less preload only, '
        f'{counted(draws)}',
        value=mean,
        error=error,
        reported=said,
    )


def _torques(rows: list[StudyRow]) -> list[Mark]:
    """Return the rolling share of the torque, and other rules of friction beside ours."""
    found = []
    for case, name in ((OURS, 'rolling'), (STANDING, 'standing')):
        torque, rolling = (
            mean_of(rows, column, kind='screw', load=PRELOAD, rpm=MARK_RPM, case=case)
            for column in ('friction_torque', 'rolling_torque')
        )
        found.append(
            Mark(
                name=f'rolling share of the torque, {name} roughness, 600 rev/min, preload only',
                value=rolling / torque,
            )
        )
    torque, sliding, central, track = (
        mean_of(rows, f'{name}_torque', kind='screw', load=PRELOAD, rpm=MARK_RPM)
        for name in ('friction', 'sliding', 'central_film', 'track')
    )
    return [
        *found,
        Mark(
            name="sliding torque with the central film in Eyring's law over ours, 600 rev/min",
            value=central / sliding,
        ),
        Mark(
            name='torque of friction along the track over ours, 600 rev/min', value=track / torque
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
    gains = efficiencies(screw, points) - [
        constant_friction_efficiency(screw, row.load) for row in points
    ]
    least = points[int(np.argmin(gains))]
    where = f'{EFFICIENCY_LOAD:g} N'
    return [
        Mark(name=f'best efficiency, {at_load[best].rpm:g} rev/min, {where}', value=eta[best]),
        *(
            Mark(
                name=f'efficiency without rolling losses, {at_load[i].rpm:g} rev/min, {where}',
                value=free[i],
                reported=ETA_RISES,
            )
            for i in sorted({0, best, len(free) - 1})
        ),
        Mark(
            name='efficiency less that of constant friction 0.005, least of '
            f'{len(points)} points, at {least.rpm:g} rev/min, {least.load:g} N',
            value=float(gains.min()),
            reported='trend: mixed EHL is above',
        ),
    ]


def _statistical(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    """Return what published formulas with a statistical asperity share say."""
    speeds = sorted(pick(rows, kind='formulas', load=EFFICIENCY_LOAD), key=lambda row: row.rpm)
    if len(speeds) < 2:
        return []
    eta = efficiencies(screw, speeds, 'sliding_torque')
    touching = sum(row.rcs >= RCS_LIMIT for row in speeds)  # the slowest: the share falls
    name = f'efficiency, statistical share, without rolling losses, {EFFICIENCY_LOAD:g} N'
    return [
        Mark(
            name=f'statistical share, loaded nut, 600 rev/min, {LOADS[-1]:g} N over preload only',
            value=over_preload(rows, 'rcs_loaded', LOADS[-1], kind='formulas', rpm=MARK_RPM),
            reported=WITH_LOAD,
        ),
        *(
            Mark(name=f'{name}, {speeds[i].rpm:g} rev/min', value=eta[i], reported=ETA_RISES)
            for i in (0, -1)
        ),
        Mark(
            name=f'{name}, least step between speeds with a share of {RCS_LIMIT:g} or more',
            value=float(np.diff(eta[:touching]).min(initial=math.inf)),
        ),
    ]
