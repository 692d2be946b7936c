# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The trends of the published study at once: rolling and standing roughness, other assumptions."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from surrogate.paper.cases import (
    EFFICIENCY_LOAD,
    MARK_RPM,
    OURS,
    PRELOAD,
    ROLLING_RPM,
    SHORT,
    SLOW,
    STANDING,
)
from surrogate.paper.curves import (
    constant_friction_efficiency,
    curve,
    efficiencies,
    mapped,
    NO_CONTACT,
    pick,
)
from surrogate.paper.figures import captioned_figure, entrainment, finish, limit, speed_axis
from surrogate.paper.marks import REPORTED_FILM
from surrogate.paper.rows import StudyRow
from surrogate.paper.trends import contact_speeds, nut_rows, screw_speeds
from surrogate.parameters import Screw
from surrogate.plotting.style import BLUE, GREEN, GREY, VERMILION
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT
from surrogate.units import NANO

ROLLS: dict[str, Any] = {'color': 'black', 'marker': 'o', 'markersize': 4}
STANDS: dict[str, Any] = {'color': GREY, 'marker': 'v', 'ls': '--', 'markersize': 4}
STATISTICAL: dict[str, Any] = {'color': VERMILION, 'ls': '-.'}


def figure_trends(screw: Screw, rows: Sequence[StudyRow]) -> Figure:
    """Return efficiency, film and RCS of rolling and standing roughness and other assumptions."""
    figure = captioned_figure(
        7.2,
        'Black: rolling roughness; grey: standing still, same Rq by the standard, one draw. '
        'Reported: efficiency and film rise with speed and load, RCS falls with speed, rises with '
        f'load. (a) Screw under {EFFICIENCY_LOAD:g} N. (b) Central film at 502.65 mm/s, loaded '
        'nut. (c) Preload only; zero is drawn at the lower edge. (d) Over that of the least load. '
        'Statistical: share by the film ratio, closed forms.',
    )
    panels = figure.subplots(2, 2)
    _draw_losses(panels[0, 0], screw, rows)
    _draw_films(panels[0, 1], rows)
    _draw_speeds(panels[1, 0], rows)
    _draw_loads(panels[1, 1], rows)
    return figure


def _draw_losses(axes: Axes, screw: Screw, rows: Sequence[StudyRow]) -> None:
    """Draw 1 - efficiency over speed; a logarithm shows all rules of friction at once."""
    rolling, standing = (
        mapped(rows, load=EFFICIENCY_LOAD, case=case) for case in (OURS, STANDING)
    )
    formulas = sorted(pick(rows, kind='formulas', load=EFFICIENCY_LOAD), key=lambda row: row.rpm)
    lines: tuple[tuple[str, list[StudyRow], str, dict[str, Any]], ...] = (
        ('rolling', rolling, 'friction_torque', ROLLS),
        ('standing', standing, 'friction_torque', STANDS),
        ('rolling, no rolling losses', rolling, 'sliding_torque', {'color': BLUE, 'ls': '--'}),
        ('statistical, no rolling losses', formulas, 'sliding_torque', STATISTICAL),
        ('friction along the track', rolling, 'track_torque', {'color': GREEN, 'ls': ':'}),
    )
    for label, found, column, style in lines:
        speed = entrainment([row.rpm for row in found])
        axes.plot(speed, 1 - efficiencies(screw, found, column), label=label, **style)
    constant = 1 - constant_friction_efficiency(screw, EFFICIENCY_LOAD)
    axes.axhline(constant, color='0.75', linewidth=1.0, label='constant friction 0.005')
    limit(axes, 1 - EFFICIENCY_LIMIT, 'limit, efficiency 0.85')
    axes.set(ylabel='1 - efficiency [-]', yscale='log', ylim=(0.008, 30))
    speed_axis(axes, top=False)
    finish(axes, 'a', 'losses over speed', legend='upper right')


def _draw_films(axes: Axes, rows: Sequence[StudyRow]) -> None:
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM}
    for label, column, more, style in (
        ('smooth, as where it rolls', 'central_film', {'rough': False}, ROLLS),
        ('standing, inner half, study', 'mean_film', {'rough': True}, STANDS),
        ('inlet 1.5 half-widths, 0.113 Pa s', 'central_film', {'case': SHORT}, {'color': BLUE}),
        ('Hamrock-Dowson', 'central_film', {'kind': 'formulas'}, STATISTICAL),
    ):
        found = curve(rows, 'load', column, **(wanted | more))
        axes.plot(found.at, NANO * found.mean, label=label, **style)
    axes.plot(0, REPORTED_FILM, 'D', color=GREEN, label=f'reported {REPORTED_FILM:.0f} nm')
    axes.set(ylabel='central film [nm]', xlabel='axial load [N]', ylim=(120, 220))
    finish(axes, 'b', 'film over load', legend='upper left')


def _draw_speeds(axes: Axes, rows: Sequence[StudyRow]) -> None:
    study = {'color': GREEN, 'marker': 's', 'ls': ':', 'markersize': 4}
    for label, found, style in (
        ('rolling', screw_speeds(rows, 'rcs'), ROLLS),
        ('standing', screw_speeds(rows, 'rcs', STANDING), STANDS),
        ('standing, study', contact_speeds(rows), study),
        ('statistical', curve(rows, 'rpm', 'rcs', kind='formulas', load=PRELOAD), STATISTICAL),
    ):
        axes.plot(entrainment(found.at), np.maximum(found.mean, NO_CONTACT), label=label, **style)
    limit(axes, RCS_LIMIT, 'limit 0.01')
    axes.set(ylabel='RCS [-]', yscale='log', ylim=(NO_CONTACT, 2))
    speed_axis(axes, top=False)
    finish(axes, 'c', 'RCS over speed', legend='lower left')


def _draw_loads(axes: Axes, rows: Sequence[StudyRow]) -> None:
    """Draw RCS over that at the least load, which differs by orders between the lines."""
    rolls: dict[str, Any] = {'kind': 'screw', 'rpm': ROLLING_RPM}
    study = {'color': GREEN, 'marker': 's', 'markersize': 4}
    for label, found, style in (
        (
            f'rolling, {ROLLING_RPM:g} rev/min, loaded nut',
            curve(rows, 'load', 'rcs_loaded', **rolls),
            ROLLS,
        ),
        (
            'the same, relieved nut',
            curve(rows, 'load', 'rcs_relieved', **rolls),
            ROLLS | {'ls': ':', 'mfc': 'none'},
        ),
        (
            f'standing, study, {SLOW:g} rev/min, loaded nut',
            curve(nut_rows(rows, 'loaded'), 'load', 'rcs', rpm=SLOW, rough=True),
            study | {'ls': '--'},
        ),
        (
            'the same, relieved nut',
            curve(nut_rows(rows, 'relieved'), 'load', 'rcs', rpm=SLOW, rough=True),
            study | {'ls': ':', 'mfc': 'none'},
        ),
        (
            f'statistical, {MARK_RPM:g} rev/min, loaded nut',
            curve(rows, 'load', 'rcs_loaded', kind='formulas', rpm=MARK_RPM),
            STATISTICAL,
        ),
    ):
        axes.plot(found.at, found.mean / found.mean[0], label=label, **style)
    axes.set(
        ylabel='RCS over that of the least load [-]', ylim=(0.5, 2.2), xlabel='axial load [N]'
    )
    finish(axes, 'd', 'RCS over load', legend='upper left')
