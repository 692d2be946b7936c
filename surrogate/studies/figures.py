# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of the screw beside the study's: figures 6b, 11, 12 and 13.

Torque (6b), Stribeck and film (11); maps of RCS and efficiency over speed and load (12) and the
optimal zone (13): torque is interpolated between the nodes, and efficiency follows.

"""

from collections.abc import Iterable, Iterator, Sequence
from functools import cache, partial
import math
from pathlib import Path
import textwrap
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np
from scipy.interpolate import PchipInterpolator
from surrogate.asperities.law import AsperityLaw
from surrogate.files.limits import read_text
from surrogate.files.plain_yaml import plain_values
from surrogate.formulas.kinematics import entrainment_speed_paper
from surrogate.formulas.torque import efficiency
from surrogate.parameters import load_screw, Screw
from surrogate.plotting.style import BLUE, draw_picture, GREEN, GREY, new_figure, PURPLE, VERMILION
from surrogate.studies import curves, tasks
from surrogate.studies.curves import Array, Curve, NO_CONTACT, screw_speeds, StudyRow
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT
from surrogate.units import MILLI, NANO, RPM

SLOPE = 0.60
"""Slope of film over the law of the onset in speed, of the screw of the study [-]."""
WIDTH, CAPTION_LETTERS = 7.2, 118
"""Width [inch] and letters in a line of a caption."""
DECLARED = plain_values(read_text(Path(__file__).parents[1] / 'data' / 'study_figures.yaml'))
"""File, height [inch] and caption of each figure by its number."""
STYLES = ('-', '--', '-.', ':', (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)))
ROUGHNESS = 120.0
"""Rq of the published screw [nm]."""
MARK_SPEED = 502.65
"""Entrainment speed of the published central film [mm/s]."""
SHOWN = (5.0, 50.0, 200.0, 1000.0)
"""Speeds at which efficiency is drawn over load [rev/min]."""
FINE = 161
"""Points of a map along a side [-]."""
ZONE = '#bfe3d0'
Rows = Sequence[StudyRow]


def draw_figures(
    screw: Screw, law: AsperityLaw, rows: Rows, figures: Iterable[str], folder: Path
) -> Iterator[Path]:
    """Draw some figures of a study into a folder; yield the paths."""
    for name in figures:
        if name in DECLARED:
            drawn = partial(picture, screw, law, rows, name)
            yield draw_picture(folder / f'{DECLARED[name]["file"]}.png', drawn)


def picture(screw: Screw, law: AsperityLaw, rows: Rows, name: str) -> Figure:
    """Return a figure of the study by its number."""
    if name == '6b':
        return figure_torque(rows)
    if name == '11':
        return figure_stribeck(law, rows)
    return figure_maps(screw, rows) if name == '12' else figure_zone(screw, law, rows)


def declared_figure(name: str, **numbers: Any) -> Figure:
    """Return an empty figure of the study with its caption below, which tells some numbers."""
    figure = new_figure(WIDTH, DECLARED[name]['height'])
    text = textwrap.fill(DECLARED[name]['caption'].format(**numbers), CAPTION_LETTERS)
    figure.supxlabel(text, x=0.012, ha='left', fontsize=7.5, color='#333333')
    return figure


def shades(count: int) -> list[Any]:
    """Return colours of a series, dark to light, that also keep apart in grey."""
    return [matplotlib.colormaps['viridis'](x) for x in np.linspace(0.0, 0.82, count)]


def entrainment(rpm: Any) -> Any:
    """Return w r_m / 2 [mm/s] for screw speeds [rev/min]."""
    return _speed_of_one_rpm() * np.asarray(rpm)


@cache
def _speed_of_one_rpm() -> float:
    return MILLI * float(entrainment_speed_paper(load_screw(tasks.SCREW), RPM))


def speed_axis(axes: Axes, *, label: bool = True, top: bool = True) -> None:
    """Make the lower axis the entrainment speed [mm/s], logarithmic, the upper one rev/min."""
    axes.set_xscale('log')
    if label:
        axes.set_xlabel('entrainment speed $\\omega r_m/2$ [mm/s]')
    if top:
        unit = _speed_of_one_rpm()
        upper = axes.secondary_xaxis(
            'top', functions=(lambda u: np.divide(u, unit), lambda rpm: np.multiply(rpm, unit))
        )
        upper.set_xlabel('screw speed [rev/min]', fontsize=8)
        upper.tick_params(labelsize=8)


def finish(axes: Axes, letter: str = '', title: str = '', legend: Any = 'best') -> None:
    """Add grid, title and legend."""
    axes.grid(visible=True)
    if letter or title:
        axes.set_title(f'({letter}) {title}' if letter else title, loc='left')
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, loc=legend)


def limit(axes: Axes, value: float, label: str) -> None:
    """Mark a limit or a published number."""
    axes.axhline(value, color=PURPLE, linestyle='--', linewidth=1.0, label=label)


def over_speed(
    axes: Axes, *lines: tuple[Curve, str, str, str], factor: float = 1.0, floor: float = 0.0
) -> None:
    """
    Draw means times a factor over speed, the standard deviation as a band.

    Curve, marker and line, colour, label.

    """
    for line, style, colour, label in lines:
        x = entrainment(line.at)
        marked: dict[str, Any] = {'marker': style[0], 'ls': style[1:], 'markersize': 4}
        mean, low, high = (
            np.maximum(factor * values, floor)
            for values in (line.mean, line.mean - line.deviation, line.mean + line.deviation)
        )
        axes.plot(x, mean, color=colour, label=label, **marked)
        if np.isfinite(line.deviation).any():
            axes.fill_between(x, low, high, color=colour, alpha=0.15, linewidth=0)


def figure_torque(rows: Rows) -> Figure:
    """Return the friction torque over entrainment speed (6b)."""
    torque = screw_speeds(rows, 'friction_torque')
    least = int(np.argmin(torque.mean))
    figure = declared_figure('6b', least=MILLI * torque.mean[least], rpm=torque.at[least])
    axes = figure.subplots()
    over_speed(
        axes,
        (torque, 'o-', 'black', 'friction torque'),
        (screw_speeds(rows, 'sliding_torque'), 's--', VERMILION, 'sliding'),
        (screw_speeds(rows, 'rolling_torque'), '^-.', BLUE, 'rolling losses'),
        factor=MILLI,
    )
    axes.set(ylabel='friction torque [mN m]', ylim=(0, None))
    speed_axis(axes)
    finish(axes)
    return figure


def figure_stribeck(law: AsperityLaw, rows: Rows) -> Figure:
    """Return Stribeck curve, load shares and film over entrainment speed (11)."""
    figure = declared_figure('11')
    first, second, third = figure.subplots(3, 1, sharex=True)
    friction = screw_speeds(rows, 'friction_coefficient')
    over_speed(
        first,
        (friction, 'o-', 'black', 'friction coefficient'),
        (screw_speeds(rows, 'asperity_coefficient'), 's--', VERMILION, 'asperity share'),
        (screw_speeds(rows, 'film_coefficient'), '^-.', BLUE, 'film share'),
        (curves.apparent_friction(rows), 'D:', PURPLE, 'all losses taken as sliding'),
    )
    first.set(ylabel='friction coefficient [-]', ylim=(0, 0.2))
    rolling, contact = screw_speeds(rows, 'rcs'), curves.contact_speeds(rows)
    speed, spread = entrainment(rolling.at), math.exp(law.deviation / SLOPE)
    share = np.maximum(rolling.mean, NO_CONTACT)
    second.fill_betweenx(share, speed / spread, speed * spread, color='0.85', linewidth=0)
    over_speed(
        second,
        (rolling, 'o-', 'black', 'RCS, rolling roughness'),
        (contact, 's--', GREEN, 'RCS, one contact, standing roughness of the study'),
        floor=NO_CONTACT,
    )
    limit(second, RCS_LIMIT, f'limit {RCS_LIMIT:g}')
    second.set(ylabel='share of the load [-]', yscale='log', ylim=(NO_CONTACT, 1.3))
    over_speed(
        third, (screw_speeds(rows, 'central_film'), 'o-', 'black', 'central film'), factor=NANO
    )
    label = f'reported, rough: {tasks.REPORTED_FILM:.0f} nm at {MARK_SPEED} mm/s'
    third.plot(MARK_SPEED, tasks.REPORTED_FILM, 'D', color=VERMILION, label=label)
    for ratio in (1, 3):  # film ratios of the published roughness
        level = ratio * ROUGHNESS
        third.axhline(level, color='0.4', linestyle=':', linewidth=1.0)
        place: dict[str, Any] = {'xycoords': ('axes fraction', 'data'), 'ha': 'right'}
        third.annotate(f'Λ = {ratio}', (0.985, level), fontsize=8, va='bottom', **place)
    third.set(ylabel='film [nm]', yscale='log', ylim=(1, 1000))
    for axes, letter in zip((first, second, third), 'abc', strict=True):
        speed_axis(axes, label=axes is third, top=axes is first)
        finish(axes, letter)
    return figure


def fine_map(screw: Screw, rows: Rows) -> tuple[Array, Array, Array, Array]:
    """
    Return entrainment speeds [mm/s], loads [N], RCS and efficiency [-] between the nodes.

    Monotone cubics over the logarithms of speed and load, of torque and of the logarithm of RCS.

    """
    speeds, loads, torque = curves.grid(rows, 'friction_torque')
    rcs = np.log(np.maximum(curves.grid(rows, 'rcs')[2], NO_CONTACT))
    speed, load = (np.geomspace(axis[0], axis[-1], FINE) for axis in (speeds, loads))

    def between(values: Array) -> Array:
        places, lines = np.log(speeds), []
        for line in values:  # gaps, nodes that failed, are bridged straight
            good = np.isfinite(line)
            lines.append(np.interp(places, places[good], line[good]))
        along = PchipInterpolator(places, np.array(lines), axis=1)(np.log(speed))
        return np.asarray(PchipInterpolator(np.log(loads), along, axis=0)(np.log(load)))

    eta = _efficiency(screw, load, between(torque))
    return entrainment(speed), load, np.exp(between(rcs)), eta


def _efficiency(screw: Screw, loads: Array, torques: Array) -> Array:
    """Return the efficiency [-] under loads [N] of torques [N m], a line for each load."""
    return np.array(
        [
            [efficiency(float(torque), float(load), screw.lead) for torque in line]
            for load, line in zip(loads, torques, strict=True)
        ]
    )


def figure_maps(screw: Screw, rows: Rows) -> Figure:
    """Return maps of RCS and efficiency, and efficiency over load (12)."""
    figure = declared_figure('12', no_contact=NO_CONTACT)
    places = figure.subplot_mosaic([['rcs', 'eta'], ['load', 'load']], height_ratios=(1.25, 1))
    speed, load, rcs, eta = fine_map(screw, rows)
    log_rcs = np.log10(np.clip(rcs, NO_CONTACT, 1))
    powers, etas = np.linspace(np.log10(NO_CONTACT), 0, 13), np.linspace(0.4, 1.0, 13)
    red, blue = {'cmap': 'inferno_r'}, {'cmap': 'cividis', 'extend': 'min'}
    panels: tuple[tuple[Any, ...], ...] = (
        ('rcs', 'a', 'RCS', rcs, log_rcs, powers, RCS_LIMIT, red),
        ('eta', 'b', 'efficiency', eta, eta, etas, EFFICIENCY_LIMIT, blue),
    )
    for name, letter, title, field, shown, levels, value, style in panels:
        axes = places[name]
        filled = axes.contourf(speed, load, shown, levels, **style)
        bar = figure.colorbar(filled, ax=axes, label=f'{title} [-]')
        if name == 'rcs':
            words = ['0', *(f'$10^{{{power}}}$' for power in range(-5, 0)), '1']
            bar.set_ticks(range(-6, 1), labels=words)
        axes.contour(speed, load, field, [value], colors=['white'], linewidths=2.0)
        _map_axes(axes, rows)
        finish(axes, letter, f'{title}, line: {value:g}')
    _draw_efficiency(places['load'], screw, rows)
    return figure


def _map_axes(axes: Axes, rows: Rows) -> None:
    speeds, loads, solved = curves.grid(rows, 'rcs')
    x, y = np.meshgrid(entrainment(speeds), loads)
    known = np.isfinite(solved)
    axes.plot(x[known], y[known], '.', color='0.55', markersize=3)
    labels = {'xlabel': 'entrainment speed [mm/s]', 'ylabel': 'axial load [N]'}
    axes.set(xscale='log', yscale='log', **labels)


def _draw_efficiency(axes: Axes, screw: Screw, rows: Rows) -> None:
    speeds, loads, torque = curves.grid(rows, 'friction_torque')
    eta = _efficiency(screw, loads, torque)
    shown = [i for i, rpm in enumerate(speeds) if rpm in SHOWN]
    for i, colour, style in zip(shown, shades(len(shown)), STYLES, strict=False):
        line = {'color': colour, 'linestyle': style, 'marker': 'o', 'markersize': 4}
        axes.plot(loads, eta[:, i], label=f'mixed EHL, {speeds[i]:g} rev/min', **line)
    limit(axes, EFFICIENCY_LIMIT, 'limit 0.85')
    axes.set(xscale='log', xlabel='axial load [N]', ylabel='efficiency [-]', ylim=(0.15, 1.0))
    finish(axes, 'c', 'efficiency over load', legend='lower right')


def figure_zone(screw: Screw, law: AsperityLaw, rows: Rows) -> Figure:
    """Return the optimal zone in the plane of speed and load (13)."""
    figure = declared_figure('13', rcs=RCS_LIMIT, efficiency=EFFICIENCY_LIMIT)
    axes = figure.subplots()
    speed, load, rcs, eta = fine_map(screw, rows)
    good = (rcs < RCS_LIMIT) & (eta >= EFFICIENCY_LIMIT)
    axes.contourf(speed, load, good.astype(float), [0.5, 1.5], colors=[ZONE])
    red: dict[str, Any] = {'colors': [VERMILION]}
    blue: dict[str, Any] = {'colors': [BLUE], 'linestyles': ['dashed'], 'linewidths': 1.8}
    axes.contour(speed, load, rcs, [RCS_LIMIT], linestyles=['solid'], linewidths=1.8, **red)
    axes.contour(speed, load, eta, [EFFICIENCY_LIMIT], **blue)
    for sign in (-1, 1):
        apart = math.exp(sign * law.deviation / SLOPE) * speed
        axes.contour(apart, load, rcs, [RCS_LIMIT], linestyles='dotted', linewidths=1, **red)
    others = axes.contour(speed, load, eta, [0.7, 0.9, 0.95, 0.98], colors=[GREY], linewidths=0.7)
    _map_axes(axes, rows)
    axes.clabel(others, fontsize=7, fmt='η %.2f', inline_spacing=2)
    handles = [
        Line2D([], [], color=VERMILION, label=f'RCS {RCS_LIMIT:g}'),
        Line2D([], [], color=BLUE, linestyle='--', label=f'efficiency {EFFICIENCY_LIMIT:g}'),
        Line2D([], [], marker='s', color=ZONE, linestyle='none', label='optimal zone'),
    ]
    finish(axes, legend=None)
    axes.legend(handles=handles, fontsize=8, loc='lower left', framealpha=1)
    return figure
