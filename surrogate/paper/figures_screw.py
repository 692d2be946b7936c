# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the screw over speed beside the study: torque (6b), Stribeck, film (11)."""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from surrogate.asperities.law import AsperityLaw
from surrogate.paper.cases import STANDING
from surrogate.paper.curves import Curve, lowest, NO_CONTACT
from surrogate.paper.figures import (
    captioned_figure,
    draw_curve,
    entrainment,
    finish,
    limit,
    speed_axis,
)
from surrogate.paper.marks import REPORTED_FILM
from surrogate.paper.rows import Array, StudyRow
from surrogate.paper.trends import apparent_friction, contact_speeds, screw_speeds
from surrogate.plotting.style import BLUE, GREEN, GREY, PURPLE, VERMILION
from surrogate.surface.aims import RCS_LIMIT
from surrogate.units import MILLI, NANO

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
    torque = screw_speeds(rows, 'friction_torque')
    turn, least = lowest(torque)
    figure = captioned_figure(
        3.9,
        'Friction torque of the nominal screw, preload only, ISO VG 68 at 40 °C. Contacts of '
        'balls and raceways only: wipers, recirculation and ball-to-ball contact are not in it. '
        f'Least where the roughness rolls: {MILLI * least:.1f} mN m at {turn:g} rev/min. Grey: '
        'one draw of the same roughness, standing still.',
    )
    axes = figure.subplots()
    parts: tuple[tuple[str, str, str, str], ...] = (
        ('friction_torque', 'friction torque, rolling roughness', 'black', 'o-'),
        ('sliding_torque', 'sliding', VERMILION, 's--'),
        ('rolling_torque', 'rolling losses', BLUE, '^-.'),
    )
    for name, label, colour, style in parts:
        _draw(axes, screw_speeds(rows, name), MILLI, style, colour, label)
    standing = screw_speeds(rows, 'friction_torque', STANDING)
    _draw(axes, standing, MILLI, 'v:', GREY, 'friction torque, standing roughness')
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


def figure_stribeck(law: AsperityLaw, rows: Sequence[StudyRow]) -> Figure:
    """Return Stribeck curve, load shares and film over entrainment speed (11)."""
    figure = captioned_figure(
        8.2,
        'Nominal screw, preload only, ISO VG 68 at 40 °C; grey: roughness that stands still. (a) '
        'Mean traction against the slip over the normal force, its parts, and the coefficient '
        'that would make the rolling losses, too. (b) Worst contact; zero is drawn at the lower '
        "edge; bands: standard deviation, of the law's onset or of the contact's draws. (c) "
        'Central film of the smooth contacts.',
    )
    first, second, third = figure.subplots(3, 1, sharex=True)
    for name, label, colour, style in (
        ('friction_coefficient', 'friction coefficient', 'black', 'o-'),
        ('asperity_coefficient', 'asperity share', VERMILION, 's--'),
        ('film_coefficient', 'film share', BLUE, '^-.'),
    ):
        _draw(first, screw_speeds(rows, name), 1.0, style, colour, label)
    _draw(first, apparent_friction(rows), 1.0, 'D:', PURPLE, 'all losses taken as sliding')
    standing = screw_speeds(rows, 'friction_coefficient', STANDING)
    _draw(first, standing, 1.0, 'v:', GREY, 'friction coefficient, standing')
    first.set(ylabel='friction coefficient [-]', ylim=(0, 0.2))
    _draw_shares(second, law, rows)
    _draw(third, screw_speeds(rows, 'central_film'), NANO, 'o-', 'black', 'central film')
    _mark_films(third)
    for axes, letter in zip((first, second, third), 'abc', strict=True):
        speed_axis(axes, label=axes is third, top=axes is first)
        finish(axes, letter)
    return figure


def _draw_shares(axes: Axes, law: AsperityLaw, rows: Sequence[StudyRow]) -> None:
    """Draw RCS where the roughness rolls, and where it stands still."""
    rolling = screw_speeds(rows, 'rcs')
    speed, spread = entrainment(rolling.at), math.exp(law.deviation)
    share = np.maximum(rolling.mean, NO_CONTACT)
    axes.fill_betweenx(share, speed / spread, speed * spread, color='0.85', linewidth=0)
    for found, label, colour, style in (
        (rolling, 'RCS, rolling roughness', 'black', 'o-'),
        (screw_speeds(rows, 'rcs', STANDING), 'RCS, standing roughness', GREY, 'v:'),
        (contact_speeds(rows), 'RCS, one contact, standing roughness of the study', GREEN, 's--'),
    ):
        _draw(axes, found, 1.0, style, colour, label, floor=NO_CONTACT)
    limit(axes, RCS_LIMIT, f'limit {RCS_LIMIT:g}')
    axes.set(ylabel='share of the load [-]', yscale='log', ylim=(NO_CONTACT, 1.3))


def _mark_films(axes: Axes) -> None:
    """Mark the published film, and film ratios of the published roughness."""
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
