# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the screw over speed beside the study: torque (6b), Stribeck, film (11)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from surrogate.paper.cases import PRELOAD
from surrogate.paper.curves import Curve, curve, lowest, NO_CONTACT
from surrogate.paper.figures import (
    captioned_figure,
    draw_curve,
    entrainment,
    finish,
    limit,
    speed_axis,
)
from surrogate.paper.mark import counted, REPORTED_FILM
from surrogate.paper.marks_screw import apparent_friction
from surrogate.paper.rows import Array, StudyRow
from surrogate.plotting.style import BLUE, GREEN, PURPLE, VERMILION
from surrogate.surface.aims import RCS_LIMIT
from surrogate.units import MILLI, NANO

SCREW: dict[str, Any] = {'kind': 'screw', 'load': PRELOAD}
ROUGHNESS = 120.0
"""Rq of the published screw [nm]."""
MARK_SPEED = 502.65
"""Entrainment speed of the published central film [mm/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasuredTorque:
    """Measured friction torque: speeds [rev/min], torque and its standard deviation [N m]."""

    rpm: Array
    torque: Array
    deviation: Array


def figure_torque(rows: Sequence[StudyRow], measured: MeasuredTorque | None = None) -> Figure:
    """Return the friction torque over entrainment speed, with measurements if given (6b)."""
    torque = curve(rows, 'rpm', 'friction_torque', **SCREW)
    turn, least = lowest(torque)
    figure = captioned_figure(
        3.9,
        f'Friction torque of the nominal screw, preload only, ISO VG 68 at 40 °C, mean of '
        f'{counted(torque.draws)}; bands: standard deviation. Contacts of balls and raceways '
        'only: wipers, recirculation and ball-to-ball contact are not in it. Least: '
        f'{MILLI * least:.1f} mN m at {turn:g} rev/min.',
    )
    axes = figure.subplots()
    parts: tuple[tuple[str, str, str, str], ...] = (
        ('friction_torque', 'friction torque', 'black', 'o-'),
        ('sliding_torque', 'sliding', VERMILION, 's--'),
        ('rolling_torque', 'rolling', BLUE, '^-.'),
    )
    for name, label, colour, style in parts:
        _draw(axes, curve(rows, 'rpm', name, **SCREW), MILLI, style, colour, label)
    axes.plot(
        entrainment(turn),
        MILLI * least,
        'o',
        markersize=9,
        mfc='none',
        mec='black',
        label='least torque',
    )
    if measured is not None:
        axes.errorbar(
            entrainment(measured.rpm),
            MILLI * measured.torque,
            yerr=MILLI * measured.deviation,
            fmt='D',
            color=GREEN,
            capsize=3,
            markersize=4,
            label='measured',
        )
    axes.set(ylabel='friction torque [mN m]', ylim=(0, None))
    speed_axis(axes)
    finish(axes)
    return figure


def _draw(
    axes: Axes, found: Curve, factor: float, style: str, colour: str, label: str, **more: Any
) -> None:
    """Draw a curve over entrainment speed; `style` is a marker and a line."""
    draw_curve(
        axes,
        entrainment(found.at),
        found,
        factor,
        marker=style[0],
        linestyle=style[1:],
        color=colour,
        label=label,
        markersize=4,
        **more,
    )


def figure_stribeck(rows: Sequence[StudyRow]) -> Figure:
    """Return Stribeck curve, load shares and film over entrainment speed (11)."""
    friction = curve(rows, 'rpm', 'friction_coefficient', **SCREW)
    figure = captioned_figure(
        8.2,
        'Nominal screw, preload only, ISO VG 68 at 40 °C, mean of '
        f'{counted(friction.draws)}; bands: standard deviation. (a) Mean traction against the '
        'slip over the normal force, its parts, and the coefficient that would make the rolling '
        'losses, too. (b) Worst contact; zero is drawn at the lower edge. (c) Central film of '
        'the smooth contact at the screw, least film of the rough contacts, whose floor is '
        '4.1 nm.',
    )
    first, second, third = figure.subplots(3, 1, sharex=True)
    _draw(first, friction, 1.0, 'o-', 'black', 'friction coefficient')
    parts = (('asperity_coefficient', VERMILION, 's--'), ('film_coefficient', BLUE, '^-.'))
    for name, colour, style in parts:
        label = f'{name.split("_")[0]} share'
        _draw(first, curve(rows, 'rpm', name, **SCREW), 1.0, style, colour, label)
    apparent = apparent_friction(list(rows))
    _draw(first, apparent, 1.0, 'D:', PURPLE, 'all losses taken as sliding')
    first.set(ylabel='friction coefficient [-]', ylim=(0, 0.2))
    shares = (
        ('rcs', 'RCS', 'black', 'o-'),
        ('asperity_share', 'asperity share', VERMILION, 's--'),
    )
    for name, label, colour, style in shares:
        found = curve(rows, 'rpm', name, **SCREW)
        _draw(second, found, 1.0, style, colour, label, floor=NO_CONTACT)
    limit(second, RCS_LIMIT, f'limit {RCS_LIMIT:g}')
    second.set(ylabel='share of the load [-]', yscale='log', ylim=(NO_CONTACT, 1.3))
    _draw_films(third, rows)
    for axes, letter in zip((first, second, third), 'abc', strict=True):
        speed_axis(axes, label=axes is third, top=axes is first)
        finish(axes, letter)
    return figure


def _draw_films(axes: Axes, rows: Sequence[StudyRow]) -> None:
    smooth = curve(rows, 'rpm', 'central_film', kind='contact', load=PRELOAD, rough=False)
    _draw(axes, smooth, NANO, 'o-', 'black', 'central film, smooth')
    least = curve(rows, 'rpm', 'minimum_film', **SCREW)
    _draw(axes, least, NANO, 's--', BLUE, 'least film, rough')
    axes.plot(
        MARK_SPEED,
        REPORTED_FILM,
        'D',
        color=VERMILION,
        label=f'reported, rough: {REPORTED_FILM:.0f} nm at {MARK_SPEED} mm/s',
    )
    for ratio in (1, 3):
        axes.axhline(ratio * ROUGHNESS, color='0.4', linestyle=':', linewidth=1.0)
        axes.annotate(
            f'Λ = {ratio}',
            (0.985, ratio * ROUGHNESS),
            xycoords=('axes fraction', 'data'),
            fontsize=8,
            ha='right',
            va='bottom',
        )
    axes.set(ylabel='film [nm]', yscale='log', ylim=(1, 1000))


def read_measured(lines: Sequence[dict[str, str]]) -> MeasuredTorque:
    """
    Return measurements from the lines of a CSV.

    Columns speed_rev_min, torque_Nm and, if known, deviation_Nm; raises KeyError or ValueError.

    """
    columns = [
        np.array([float(line.get(name) or 'nan') for line in lines])
        for name in ('speed_rev_min', 'torque_Nm', 'deviation_Nm')
    ]
    if not len(lines) or not (np.isfinite(columns[:2]).all() and (columns[0] > 0).all()):
        raise ValueError('needs numbers in speed_rev_min, above 0, and torque_Nm')
    return MeasuredTorque(rpm=columns[0], torque=columns[1], deviation=np.nan_to_num(columns[2]))
