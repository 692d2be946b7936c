# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What other assumptions make of the same screw, beside the trends that the study reports."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from surrogate.paper.cases import (
    EFFICIENCY_LOAD,
    HIGH,
    MARK_RPM,
    ONSET,
    PRELOAD,
    SHORT,
    SLOW,
    THIN,
)
from surrogate.paper.curves import (
    constant_friction_efficiency,
    Curve,
    curve,
    efficiencies,
    mapped,
    NO_CONTACT,
    pick,
)
from surrogate.paper.figures import captioned_figure, entrainment, finish, limit, speed_axis
from surrogate.paper.mark import REPORTED_FILM
from surrogate.paper.marks_contact import relieved_rows
from surrogate.paper.rows import StudyRow
from surrogate.parameters import Screw
from surrogate.plotting.style import BLUE, GREEN, GREY, VERMILION
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT
from surrogate.units import NANO


def figure_alternatives(screw: Screw, rows: Sequence[StudyRow]) -> Figure:
    """Return efficiency, film and RCS under other assumptions than ours."""
    figure = captioned_figure(
        7.2,
        'Black: our model. Reported: efficiency and film rise with speed and load, contact lasts '
        'to higher speeds than ours, RCS rises with load. (a) Screw under '
        f'{EFFICIENCY_LOAD:g} N. (b) Central film at 502.65 mm/s. (c) Preload only; zero is drawn '
        'at the lower edge. (d) Mean of the draws. '
        'Statistical: Aihara share of the film ratio, closed forms.',
    )
    panels = figure.subplots(2, 2)
    _draw_losses(panels[0, 0], screw, rows)
    _draw_films(panels[0, 1], rows)
    _draw_speeds(panels[1, 0], rows)
    _draw_loads(panels[1, 1], rows)
    return figure


def _draw_losses(axes: Axes, screw: Screw, rows: Sequence[StudyRow]) -> None:
    """Draw 1 - efficiency over speed; a logarithm shows all rules of friction at once."""
    solved = pick(mapped(rows), kind='screw', load=EFFICIENCY_LOAD)
    formulas = sorted(pick(rows, kind='formulas', load=EFFICIENCY_LOAD), key=lambda row: row.rpm)
    lines: tuple[tuple[str, list[StudyRow], str, dict[str, Any]], ...] = (
        ('full model', solved, 'friction_torque', {'color': 'black', 'marker': 'o'}),
        ('without rolling', solved, 'sliding_torque', {'color': BLUE, 'marker': 's', 'ls': '--'}),
        (
            'statistical, without rolling',
            formulas,
            'sliding_torque',
            {'color': VERMILION, 'ls': '-.'},
        ),
        ('along the track', solved, 'track_torque', {'color': GREEN, 'marker': '^', 'ls': ':'}),
    )
    for label, found, column, style in lines:
        speed = entrainment([row.rpm for row in found])
        axes.plot(
            speed, 1 - efficiencies(screw, found, column), label=label, **style, markersize=4
        )
    constant = 1 - constant_friction_efficiency(screw, EFFICIENCY_LOAD)
    axes.axhline(constant, color=GREY, linewidth=1.0, label='constant friction 0.005')
    limit(axes, 1 - EFFICIENCY_LIMIT, 'limit, efficiency 0.85')
    axes.set(ylabel='1 - efficiency [-]', yscale='log', ylim=(0.008, 9))
    speed_axis(axes, top=False)
    finish(axes, 'a', 'losses over speed', legend='upper right')


def _draw_films(axes: Axes, rows: Sequence[StudyRow]) -> None:
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM}
    ours = curve(rows, 'load', 'central_film', rough=False, **wanted)
    short = curve(rows, 'load', 'central_film', case=SHORT, **wanted)
    formula = curve(rows, 'load', 'central_film', kind='formulas', rpm=MARK_RPM)
    axes.plot(ours.at, NANO * ours.mean, 'o-', color='black', label='smooth, open inlet')
    label = 'inlet of 1.5 half-widths, 0.113 Pa s'
    axes.plot(short.at, NANO * short.mean, 's--', color=BLUE, label=label, markersize=4)
    axes.plot(formula.at, NANO * formula.mean, ':', color=GREY, label='Hamrock-Dowson')
    for number, draw in enumerate(sorted({row.draw for row in pick(rows, rough=True, **wanted)})):
        film = curve(rows, 'load', 'central_film', draw=draw, **wanted)
        name = 'rough, the very centre, each draw' if number == 0 else None
        axes.plot(film.at, NANO * film.mean, '-.', color=VERMILION, linewidth=0.8, label=name)
    axes.plot(0, REPORTED_FILM, 'D', color=GREEN, label=f'reported {REPORTED_FILM:.0f} nm')
    axes.set(ylabel='central film [nm]', xlabel='axial load [N]', ylim=(95, 235))
    finish(axes, 'b', 'film over load, loaded nut', legend='upper left')


def _draw_speeds(axes: Axes, rows: Sequence[StudyRow]) -> None:
    lines: tuple[tuple[str, dict[str, Any], dict[str, Any]], ...] = (
        ('full model', {'kind': 'screw'}, {'color': 'black', 'marker': 'o'}),
        (
            'oil at 80 °C',
            {'kind': 'contact', 'case': THIN, 'rough': True},
            {'color': BLUE, 'marker': 's', 'ls': '--'},
        ),
        (
            'floor 10 nm',
            {'kind': 'contact', 'case': HIGH},
            {'color': GREEN, 'marker': '^', 'ls': ':'},
        ),
        ('statistical share', {'kind': 'formulas'}, {'color': VERMILION, 'ls': '-.'}),
    )
    for label, wanted, style in lines:
        found = curve(rows, 'rpm', 'rcs', load=PRELOAD, **wanted)
        mean = np.maximum(found.mean, NO_CONTACT)
        axes.plot(entrainment(found.at), mean, label=label, **style, markersize=4)
    limit(axes, RCS_LIMIT, 'limit 0.01')
    axes.set(ylabel='RCS [-]', yscale='log', ylim=(NO_CONTACT, 2), xlim=(1.5, 5000))
    speed_axis(axes, top=False)
    finish(axes, 'c', 'RCS over speed', legend='lower right')


def _draw_loads(axes: Axes, rows: Sequence[StudyRow]) -> None:
    """Draw RCS over that at preload, which differs by orders between the lines."""
    solved: dict[str, Any] = {'kind': 'contact', 'rough': True}
    lines: tuple[tuple[str, Curve, dict[str, Any]], ...] = (
        (
            f'full model, {SLOW:g} rev/min, loaded nut',
            curve(rows, 'load', 'rcs', rpm=SLOW, **solved),
            {'color': 'black', 'marker': 'o'},
        ),
        (
            f'full model, {ONSET:g} rev/min, loaded nut',
            curve(rows, 'load', 'rcs', rpm=ONSET, **solved),
            {'color': BLUE, 'marker': 'v', 'ls': '--'},
        ),
        (
            f'full model, {ONSET:g} rev/min, relieved nut',
            curve(relieved_rows(list(rows)), 'load', 'rcs', rpm=ONSET, **solved),
            {'color': GREEN, 'marker': '^', 'ls': ':'},
        ),
        (
            f'statistical, {MARK_RPM:g} rev/min, loaded nut',
            curve(rows, 'load', 'rcs_loaded', kind='formulas', rpm=MARK_RPM),
            {'color': VERMILION, 'ls': '-.'},
        ),
    )
    for label, found, style in lines:
        axes.plot(found.at, found.mean / found.mean[0], label=label, **style, markersize=4)
    axes.set(ylabel='RCS over that at preload [-]', ylim=(0.5, 1.9), xlabel='axial load [N]')
    finish(axes, 'd', 'RCS over load', legend='upper left')
