# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of the whole screw: torque, friction, efficiency, and other rules of friction."""

from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator
from surrogate.formulas.torque import efficiency
from surrogate.paper.cases import (
    EFFICIENCY_LOAD,
    LOADS,
    MAP_LOADS,
    MARK_RPM,
    PRELOAD,
    SLOW,
    STRIBECK_SPEEDS,
)
from surrogate.paper.curves import (
    constant_friction_efficiency,
    crossing,
    Curve,
    curve,
    efficiencies,
    lowest,
    mapped,
    pick,
)
from surrogate.paper.mark import counted, Mark, mean_of, over_preload
from surrogate.paper.rows import StudyRow
from surrogate.parameters import Screw
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT
from surrogate.units import MILLI

SCREW: dict[str, Any] = {'kind': 'screw', 'load': PRELOAD}
FALLS_RISES, ETA_RISES = 'trend: falls, then rises', 'trend: rises with speed'
SAMPLES = (2.0, 25.0, 200.0, 1000.0)
"""Speeds at which the friction coefficient is listed [rev/min]."""
LOAD_STEPS = 400
"""Steps of a search over the load [-]."""


def screw_marks(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    """Return the numbers of the screw."""
    return [
        *_torque(rows),
        *_friction(rows),
        *_onset(screw, rows),
        *_nuts(rows),
        *_efficiency(screw, rows),
        *_statistical(screw, rows),
        *_other_rules(rows),
    ]


def _torque(rows: list[StudyRow]) -> list[Mark]:
    torque = curve(rows, 'rpm', 'friction_torque', **SCREW)
    if not len(torque.at):
        return []
    turn, least = lowest(torque)
    name = f'torque, preload only, {counted(torque.draws)}'
    return [
        Mark(name=f'speed of the least {name}', value=turn, unit='rev/min'),
        Mark(name=f'least {name}', value=MILLI * least, unit='mN m', reported=FALLS_RISES),
        Mark(name='torque at 2 rev/min over the least', value=torque.mean[0] / least),
        Mark(name='torque at 1000 rev/min over the least', value=torque.mean[-1] / least),
        Mark(
            name='rolling share of the torque at 600 rev/min',
            value=mean_of(rows, 'rolling_torque', rpm=MARK_RPM, **SCREW)
            / mean_of(rows, 'friction_torque', rpm=MARK_RPM, **SCREW),
        ),
    ]


def _friction(rows: list[StudyRow]) -> list[Mark]:
    apparent = apparent_friction(rows)
    if not len(apparent.at):
        return []
    turn, least = lowest(apparent)
    return [
        *(
            Mark(
                name=f'friction coefficient of the sliding, {rpm:g} rev/min',
                value=mean_of(rows, 'friction_coefficient', rpm=rpm, **SCREW),
                reported=FALLS_RISES,
            )
            for rpm in SAMPLES
        ),
        Mark(
            name='speed of the least coefficient, all losses taken as sliding',
            value=turn,
            unit='rev/min',
        ),
        Mark(name='least coefficient, all losses taken as sliding', value=least),
        Mark(
            name='that coefficient at 1000 rev/min over the least',
            value=apparent.mean[-1] / least,
            reported=FALLS_RISES,
        ),
    ]


def apparent_friction(rows: list[StudyRow]) -> Curve:
    """Return the friction coefficient that would make all losses by sliding, over speed."""
    friction, torque, sliding = (
        curve(rows, 'rpm', name, **SCREW)
        for name in ('friction_coefficient', 'friction_torque', 'sliding_torque')
    )
    nothing = np.full(len(friction.at), np.nan)
    return Curve(
        at=friction.at,
        mean=friction.mean * torque.mean / sliding.mean,
        deviation=nothing,
        error=nothing,
        draws=friction.draws,
    )


def _onset(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    name = f'speed where RCS passes {RCS_LIMIT:g}'
    ours, share = (
        curve(rows, 'rpm', 'rcs', kind=kind, load=PRELOAD) for kind in ('screw', 'formulas')
    )
    film, speed = curve(rows, 'rpm', 'central_film', **SCREW), crossing(ours, RCS_LIMIT)
    thinnest = np.interp(speed, film.at, film.mean) if len(film.at) else np.nan
    return [
        Mark(
            name=f'{name}, worst of four contacts',
            value=speed,
            unit='rev/min',
            reported='trend: contact at higher speeds',
        ),
        Mark(name='film ratio there', value=float(thinnest) / screw.roughness.rms),
        Mark(
            name='statistical share at 1000 rev/min, preload only',
            value=share.mean[-1] if STRIBECK_SPEEDS[-1] in share.at else np.nan,
        ),
    ]


def _nuts(rows: list[StudyRow]) -> list[Mark]:
    """Return how RCS of both nuts differs over the map, well inside contact."""
    ends = [pick(mapped(rows), kind='screw', rpm=SLOW, load=MAP_LOADS[i]) for i in (0, -1)]
    if not all(ends):
        return []
    return [
        Mark(
            name=f'RCS of the {nut} nut, {SLOW:g} rev/min, {MAP_LOADS[-1]:g} N over '
            f'{MAP_LOADS[0]:g} N',
            value=getattr(ends[1][0], name) / getattr(ends[0][0], name),
            reported='trend: rises with load',
        )
        for nut, name in (('loaded', 'rcs_loaded'), ('relieved', 'rcs_relieved'))
    ]


def _efficiency(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    points = mapped(rows)
    at_load = pick(points, kind='screw', load=EFFICIENCY_LOAD)
    if len(at_load) < 2:
        return []
    eta, rolling_free = (
        efficiencies(screw, at_load, name) for name in ('friction_torque', 'sliding_torque')
    )
    best, where = int(np.argmax(eta)), f'{EFFICIENCY_LOAD:g} N'
    gains = [
        float(value) - constant_friction_efficiency(screw, row.load)
        for value, row in zip(efficiencies(screw, points), points, strict=True)
    ]
    fastest = f'{at_load[-1].rpm:g} rev/min, {where}'
    least = int(np.argmin(gains))
    place = f'{points[least].rpm:g} rev/min, {points[least].load:g} N'
    return [
        Mark(
            name=f'speed of the best efficiency, {where}', value=at_load[best].rpm, unit='rev/min'
        ),
        Mark(name=f'best efficiency, {where}', value=eta[best]),
        Mark(name=f'efficiency, {fastest}', value=eta[-1], reported=ETA_RISES),
        *(
            Mark(
                name=f'efficiency without rolling, {at_load[i].rpm:g} rev/min, {where}',
                value=rolling_free[i],
            )
            for i in (0, best, -1)
        ),
        *(
            Mark(
                name=f'least load for efficiency {EFFICIENCY_LIMIT:g}, {at_load[i].rpm:g} rev/min',
                value=least_load(screw, [row for row in points if row.rpm == at_load[i].rpm]),
                unit='N',
            )
            for i in (best, -1)
        ),
        Mark(
            name='efficiency less that of constant friction 0.005, least of '
            f'{len(points)} points, at {place}',
            value=gains[least],
            reported='trend: mixed EHL is above',
        ),
    ]


def least_load(screw: Screw, rows: list[StudyRow]) -> float:
    """Return the load [N] at which rows of one speed pass the limit, by their torque."""
    rows = sorted(rows, key=lambda row: row.load)
    places = np.log([row.load for row in rows])
    loads = np.geomspace(rows[0].load, rows[-1].load, LOAD_STEPS)
    torque = PchipInterpolator(places, [row.friction_torque for row in rows])(np.log(loads))
    eta = [
        efficiency(float(friction), float(load), screw.lead)
        for friction, load in zip(torque, loads, strict=True)
    ]
    return float(np.interp(EFFICIENCY_LIMIT, eta, loads))


def _statistical(screw: Screw, rows: list[StudyRow]) -> list[Mark]:
    """Return what published formulas with a statistical asperity share say."""
    wanted: dict[str, Any] = {'kind': 'formulas'}
    speeds = sorted(pick(rows, load=EFFICIENCY_LOAD, **wanted), key=lambda row: row.rpm)
    if len(speeds) < 2:
        return []
    eta = efficiencies(screw, speeds, 'sliding_torque')
    name = f'efficiency, statistical share, without rolling, {EFFICIENCY_LOAD:g} N'
    return [
        Mark(
            name=f'statistical share, loaded nut, 600 rev/min, {LOADS[-1]:g} N over preload only',
            value=over_preload(rows, 'rcs_loaded', LOADS[-1], rpm=MARK_RPM, **wanted),
            reported='trend: rises with load',
        ),
        Mark(name=f'{name}, {speeds[0].rpm:g} rev/min', value=eta[0]),
        Mark(name=f'{name}, {speeds[-1].rpm:g} rev/min', value=eta[-1], reported=ETA_RISES),
        Mark(name=f'{name}, least step between speeds', value=float(np.diff(eta).min())),
    ]


def _other_rules(rows: list[StudyRow]) -> list[Mark]:
    """Return what other rules of friction make of the same solved contacts."""
    torque, sliding, central, track = (
        mean_of(rows, f'{name}_torque', rpm=MARK_RPM, **SCREW)
        for name in ('friction', 'sliding', 'central_film', 'track')
    )
    return [
        Mark(
            name="sliding torque with the central film in Eyring's law over ours, 600 rev/min",
            value=central / sliding,
        ),
        Mark(
            name='torque of friction along the track over ours, 600 rev/min', value=track / torque
        ),
        Mark(
            name='torque of friction along the track over our sliding torque, 600 rev/min',
            value=track / sliding,
        ),
    ]
