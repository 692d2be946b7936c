# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of the screw beside the study: torque (6b), Stribeck and film (11), trends.

Maps of RCS and efficiency over speed and load (12) and the optimal zone (13): torque is
interpolated between the nodes, and efficiency follows from it.

"""

from collections.abc import Sequence
import math
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np
from scipy.interpolate import PchipInterpolator
from surrogate.asperities.law import AsperityLaw
from surrogate.formulas.torque import efficiency
from surrogate.parameters import Screw
from surrogate.plotting.style import BLUE, GREEN, GREY, PURPLE, VERMILION
from surrogate.screw.record import CONSTANT_FRICTION
from surrogate.studies.drawing import (
    declared_figure,
    entrainment,
    finish,
    limit,
    over_speed,
    shades,
    speed_axis,
    STYLES,
)
from surrogate.studies.rows import (
    apparent_friction,
    Array,
    constant_friction_efficiency,
    contact_speeds,
    curve,
    efficiencies,
    grid,
    mapped,
    NO_CONTACT,
    nut_rows,
    pick,
    screw_speeds,
    StudyRow,
)
from surrogate.studies.tasks import (
    EFFICIENCY_LOAD,
    MARK_RPM,
    OURS,
    PRELOAD,
    REPORTED_FILM,
    ROLLING_RPM,
    SHORT,
    SLOW,
    STANDING,
)
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT
from surrogate.units import MILLI, NANO

SLOPE = 0.60
"""Slope of film over the law of the onset in speed, of the screw of the study [-]."""
ROUGHNESS = 120.0
"""Rq of the published screw [nm]."""
MARK_SPEED = 502.65
"""Entrainment speed of the published central film [mm/s]."""
ROLLS: dict[str, Any] = {'color': 'black', 'marker': 'o', 'markersize': 4}
STANDS: dict[str, Any] = {'color': GREY, 'marker': 'v', 'ls': '--', 'markersize': 4}
STUDY: dict[str, Any] = {'color': GREEN, 'marker': 's', 'markersize': 4}
STATISTICAL: dict[str, Any] = {'color': VERMILION, 'ls': '-.'}
SHOWN = (5.0, 50.0, 200.0, 1000.0)
"""Speeds at which efficiency is drawn over load [rev/min]."""
FINE = 161
"""Points of a map along a side [-]."""
ZONE = '#bfe3d0'
Rows = Sequence[StudyRow]
Measured = tuple[Array, Array, Array]
"""Measured speeds [rev/min], torque and its standard deviation [N m]."""


def read_measured(lines: Sequence[dict[str, str]]) -> Measured:
    """
    Return measurements from the lines of a CSV.

    Columns speed_rev_min, torque_Nm and, if known, deviation_Nm; raises KeyError or ValueError.

    """
    names = ('speed_rev_min', 'torque_Nm', 'deviation_Nm')
    rpm, torque, deviation = (
        np.array([float(line.get(name) or 'nan') for line in lines]) for name in names
    )
    if not len(lines) or not (np.isfinite([rpm, torque]).all() and (rpm > 0).all()):
        raise ValueError('needs numbers in speed_rev_min, above 0, and torque_Nm')
    return rpm, torque, np.nan_to_num(deviation)


def figure_torque(rows: Rows, measured: Measured | None = None) -> Figure:
    """Return the friction torque over entrainment speed, with measurements if given (6b)."""
    torque = screw_speeds(rows, 'friction_torque')
    least = int(np.argmin(torque.mean))
    figure = declared_figure('6b', least=MILLI * torque.mean[least], rpm=torque.at[least])
    axes = figure.subplots()
    for column, case, *style in (
        ('friction_torque', OURS, 'o-', 'black', 'friction torque, rolling roughness'),
        ('sliding_torque', OURS, 's--', VERMILION, 'sliding'),
        ('rolling_torque', OURS, '^-.', BLUE, 'rolling losses'),
        ('friction_torque', STANDING, 'v:', GREY, 'friction torque, standing roughness'),
    ):
        over_speed(axes, screw_speeds(rows, column, case), *style, factor=MILLI)
    if measured is not None:
        rpm, mean, deviation = measured
        bar: dict[str, Any] = {'yerr': MILLI * deviation, 'capsize': 3, 'markersize': 4}
        x, y = entrainment(rpm), MILLI * mean
        axes.errorbar(x, y, fmt='D', color=GREEN, label='measured', **bar)
    axes.set(ylabel='friction torque [mN m]', ylim=(0, None))
    speed_axis(axes)
    finish(axes)
    return figure


def figure_stribeck(law: AsperityLaw, rows: Rows) -> Figure:
    """Return Stribeck curve, load shares and film over entrainment speed (11)."""
    figure = declared_figure('11')
    first, second, third = figure.subplots(3, 1, sharex=True)
    friction, standing = (
        screw_speeds(rows, 'friction_coefficient', case) for case in (OURS, STANDING)
    )
    for found, *style in (
        (friction, 'o-', 'black', 'friction coefficient'),
        (screw_speeds(rows, 'asperity_coefficient'), 's--', VERMILION, 'asperity share'),
        (screw_speeds(rows, 'film_coefficient'), '^-.', BLUE, 'film share'),
        (apparent_friction(rows), 'D:', PURPLE, 'all losses taken as sliding'),
        (standing, 'v:', GREY, 'friction coefficient, standing'),
    ):
        over_speed(first, found, *style)
    first.set(ylabel='friction coefficient [-]', ylim=(0, 0.2))
    _draw_shares(second, law, rows)
    film = screw_speeds(rows, 'central_film')
    over_speed(third, film, 'o-', 'black', 'central film', factor=NANO)
    # The published film, and film ratios of the published roughness.
    label = f'reported, rough: {REPORTED_FILM:.0f} nm at {MARK_SPEED} mm/s'
    third.plot(MARK_SPEED, REPORTED_FILM, 'D', color=VERMILION, label=label)
    for ratio in (1, 3):
        level = ratio * ROUGHNESS
        third.axhline(level, color='0.4', linestyle=':', linewidth=1.0)
        place: dict[str, Any] = {'xycoords': ('axes fraction', 'data'), 'ha': 'right'}
        third.annotate(f'Λ = {ratio}', (0.985, level), fontsize=8, va='bottom', **place)
    third.set(ylabel='film [nm]', yscale='log', ylim=(1, 1000))
    for axes, letter in zip((first, second, third), 'abc', strict=True):
        speed_axis(axes, label=axes is third, top=axes is first)
        finish(axes, letter)
    return figure


def _draw_shares(axes: Axes, law: AsperityLaw, rows: Rows) -> None:
    """Draw RCS where the roughness rolls, and where it stands still."""
    rolling = screw_speeds(rows, 'rcs')
    speed, spread = entrainment(rolling.at), math.exp(law.deviation / SLOPE)
    share = np.maximum(rolling.mean, NO_CONTACT)
    axes.fill_betweenx(share, speed / spread, speed * spread, color='0.85', linewidth=0)
    standing, contact = screw_speeds(rows, 'rcs', STANDING), contact_speeds(rows)
    for found, *style in (
        (rolling, 'o-', 'black', 'RCS, rolling roughness'),
        (standing, 'v:', GREY, 'RCS, standing roughness'),
        (contact, 's--', GREEN, 'RCS, one contact, standing roughness of the study'),
    ):
        over_speed(axes, found, *style, floor=NO_CONTACT)
    limit(axes, RCS_LIMIT, f'limit {RCS_LIMIT:g}')
    axes.set(ylabel='share of the load [-]', yscale='log', ylim=(NO_CONTACT, 1.3))


def figure_trends(screw: Screw, rows: Rows) -> Figure:
    """Return efficiency, film and RCS of rolling and standing roughness and other assumptions."""
    figure = declared_figure('trends', load=EFFICIENCY_LOAD)
    panels = figure.subplots(2, 2)
    _draw_losses(panels[0, 0], screw, rows)
    axes = panels[0, 1]
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
    axes = panels[1, 0]
    for label, found, style in (
        ('rolling', screw_speeds(rows, 'rcs'), ROLLS),
        ('standing', screw_speeds(rows, 'rcs', STANDING), STANDS),
        ('standing, study', contact_speeds(rows), STUDY | {'ls': ':'}),
        ('statistical', curve(rows, 'rpm', 'rcs', kind='formulas', load=PRELOAD), STATISTICAL),
    ):
        axes.plot(entrainment(found.at), np.maximum(found.mean, NO_CONTACT), label=label, **style)
    limit(axes, RCS_LIMIT, 'limit 0.01')
    axes.set(ylabel='RCS [-]', yscale='log', ylim=(NO_CONTACT, 2))
    speed_axis(axes, top=False)
    finish(axes, 'c', 'RCS over speed', legend='lower left')
    _draw_loads(panels[1, 1], rows)
    return figure


def _draw_losses(axes: Axes, screw: Screw, rows: Rows) -> None:
    """Draw 1 - efficiency over speed; a logarithm shows all rules of friction at once."""
    rolling, standing = (
        mapped(rows, load=EFFICIENCY_LOAD, case=case) for case in (OURS, STANDING)
    )
    formulas = sorted(pick(rows, kind='formulas', load=EFFICIENCY_LOAD), key=lambda row: row.rpm)
    for label, found, column, style in (
        ('rolling', rolling, 'friction_torque', ROLLS),
        ('standing', standing, 'friction_torque', STANDS),
        ('rolling, no rolling losses', rolling, 'sliding_torque', {'color': BLUE, 'ls': '--'}),
        ('statistical, no rolling losses', formulas, 'sliding_torque', STATISTICAL),
        ('friction along the track', rolling, 'track_torque', {'color': GREEN, 'ls': ':'}),
    ):
        speed = entrainment([row.rpm for row in found])
        axes.plot(speed, 1 - efficiencies(screw, found, column), label=label, **style)
    constant = 1 - constant_friction_efficiency(screw, EFFICIENCY_LOAD)
    axes.axhline(constant, color='0.75', linewidth=1.0, label='constant friction 0.005')
    limit(axes, 1 - EFFICIENCY_LIMIT, 'limit, efficiency 0.85')
    axes.set(ylabel='1 - efficiency [-]', yscale='log', ylim=(0.008, 30))
    speed_axis(axes, top=False)
    finish(axes, 'a', 'losses over speed', legend='upper right')


def _draw_loads(axes: Axes, rows: Rows) -> None:
    """Draw RCS over that at the least load, which differs by orders between the lines."""
    rolls: dict[str, Any] = {'kind': 'screw', 'rpm': ROLLING_RPM}
    stands: dict[str, Any] = {'rpm': SLOW, 'rough': True}
    formulas: dict[str, Any] = {'kind': 'formulas', 'rpm': MARK_RPM}
    relieved = {'ls': ':', 'mfc': 'none'}
    rolling = f'rolling, {ROLLING_RPM:g} rev/min, loaded nut'
    standing = f'standing, study, {SLOW:g} rev/min, loaded nut'
    statistical = f'statistical, {MARK_RPM:g} rev/min, loaded nut'
    same = 'the same, relieved nut'
    for label, some, column, wanted, style in (
        (rolling, rows, 'rcs_loaded', rolls, ROLLS),
        (same, rows, 'rcs_relieved', rolls, ROLLS | relieved),
        (standing, nut_rows(rows, 'loaded'), 'rcs', stands, STUDY | {'ls': '--'}),
        (same, nut_rows(rows, 'relieved'), 'rcs', stands, STUDY | relieved),
        (statistical, rows, 'rcs_loaded', formulas, STATISTICAL),
    ):
        found = curve(some, 'load', column, **wanted)
        axes.plot(found.at, found.mean / found.mean[0], label=label, **style)
    label = 'RCS over that of the least load [-]'
    axes.set(ylabel=label, ylim=(0.5, 2.2), xlabel='axial load [N]')
    finish(axes, 'd', 'RCS over load', legend='upper left')


class FineMap(NamedTuple):
    """Entrainment speeds [mm/s], loads [N], RCS and efficiency [-] between the nodes."""

    speed: Array
    load: Array
    rcs: Array
    eta: Array

    def line(self, axes: Axes, field: Array, values: Sequence[float], **style: Any) -> Any:
        """Draw lines of equal values of a field."""
        return axes.contour(self.speed, self.load, field, values, **style)


def fine_map(screw: Screw, rows: Rows) -> FineMap:
    """
    Return the map between its nodes.

    Monotone cubics over the logarithms of speed and load, of torque and of the logarithm of RCS.

    """
    speeds, loads, torque = grid(rows, 'friction_torque')
    rcs = np.log(np.maximum(grid(rows, 'rcs')[2], NO_CONTACT))
    speed, load = (np.geomspace(axis[0], axis[-1], FINE) for axis in (speeds, loads))

    def between(values: Array) -> Array:
        places, lines = np.log(speeds), []
        for line in values:  # gaps, nodes that failed, are bridged straight
            good = np.isfinite(line)
            lines.append(np.interp(places, places[good], line[good]))
        along = PchipInterpolator(places, np.array(lines), axis=1)(np.log(speed))
        return np.asarray(PchipInterpolator(np.log(loads), along, axis=0)(np.log(load)))

    friction, log_rcs = between(torque), between(rcs)
    return FineMap(entrainment(speed), load, np.exp(log_rcs), _efficiency(screw, load, friction))


def _efficiency(screw: Screw, load: Array, torque: Array) -> Array:
    """Return the efficiency [-] under loads [N] of torques [N m], a line for each load."""
    return np.array(
        [
            [efficiency(float(one), float(force), screw.lead) for one in line]
            for force, line in zip(load, torque, strict=True)
        ]
    )


def figure_maps(screw: Screw, rows: Rows) -> Figure:
    """Return maps of RCS and efficiency, and efficiency beside constant friction (12)."""
    figure = declared_figure('12', no_contact=NO_CONTACT, friction=CONSTANT_FRICTION)
    places = figure.subplot_mosaic([['rcs', 'eta'], ['load', 'load']], height_ratios=(1.25, 1))
    found = fine_map(screw, rows)
    log_rcs = np.log10(np.clip(found.rcs, NO_CONTACT, 1))
    powers, etas = np.linspace(np.log10(NO_CONTACT), 0, 13), np.linspace(0.4, 1.0, 13)
    red, blue = {'cmap': 'inferno_r'}, {'cmap': 'cividis', 'extend': 'min'}
    panels: tuple[tuple[Any, ...], ...] = (
        ('rcs', 'a', 'RCS', log_rcs, powers, RCS_LIMIT, red),
        ('eta', 'b', 'efficiency', found.eta, etas, EFFICIENCY_LIMIT, blue),
    )
    for name, letter, title, shown, levels, value, style in panels:
        axes = places[name]
        filled = axes.contourf(found.speed, found.load, shown, levels, **style)
        bar = figure.colorbar(filled, ax=axes, label=f'{title} [-]')
        if name == 'rcs':
            words = ['0', *(f'$10^{{{power}}}$' for power in range(-5, 0)), '1']
            bar.set_ticks(range(-6, 1), labels=words)
        found.line(axes, getattr(found, name), [value], colors=['white'], linewidths=2.0)
        _map_axes(axes, rows)
        finish(axes, letter, f'{title}, line: {value:g}')
    _draw_efficiency(places['load'], screw, rows)
    return figure


def _map_axes(axes: Axes, rows: Rows) -> None:
    speeds, loads, solved = grid(rows, 'rcs')
    x, y = np.meshgrid(entrainment(speeds), loads)
    known = np.isfinite(solved)
    axes.plot(x[known], y[known], '.', color='0.55', markersize=3)
    labels = {'xlabel': 'entrainment speed [mm/s]', 'ylabel': 'axial load [N]'}
    axes.set(xscale='log', yscale='log', **labels)


def _draw_efficiency(axes: Axes, screw: Screw, rows: Rows) -> None:
    """Draw efficiency over load at some speeds, and that of constant friction."""
    speeds, loads, torque = grid(rows, 'friction_torque')
    eta = _efficiency(screw, loads, torque)
    chosen = [i for i, rpm in enumerate(speeds) if rpm in SHOWN]
    for i, colour, style in zip(chosen, shades(len(chosen)), STYLES, strict=False):
        line = {'color': colour, 'linestyle': style, 'marker': 'o', 'markersize': 4}
        axes.plot(loads, eta[:, i], label=f'mixed EHL, {speeds[i]:g} rev/min', **line)
    fine = np.geomspace(loads[0], loads[-1], 60)
    constant = [constant_friction_efficiency(screw, float(load)) for load in fine]
    label = f'constant friction {CONSTANT_FRICTION:g}, any speed'
    axes.plot(fine, constant, color='0.7', linewidth=3.5, label=label, zorder=1)
    limit(axes, EFFICIENCY_LIMIT, 'limit 0.85')
    axes.set(xscale='log', xlabel='axial load [N]', ylabel='efficiency [-]', ylim=(0.15, 1.0))
    finish(axes, 'c', 'efficiency over load', legend='lower right')


def figure_zone(screw: Screw, law: AsperityLaw, rows: Rows) -> Figure:
    """Return the optimal zone in the plane of speed and load (13)."""
    figure = declared_figure('13', rcs=RCS_LIMIT, efficiency=EFFICIENCY_LIMIT)
    axes = figure.subplots()
    found = fine_map(screw, rows)
    good = (found.rcs < RCS_LIMIT) & (found.eta >= EFFICIENCY_LIMIT)
    axes.contourf(found.speed, found.load, good.astype(float), [0.5, 1.5], colors=[ZONE])
    red, blue = {'colors': [VERMILION]}, {'colors': [BLUE], 'linestyles': ['dashed']}
    found.line(axes, found.rcs, [RCS_LIMIT], linestyles=['solid'], linewidths=1.8, **red)
    found.line(axes, found.eta, [EFFICIENCY_LIMIT], linewidths=1.8, **blue)
    for sign in (-1, 1):
        apart = math.exp(sign * law.deviation / SLOPE)
        shifted = found._replace(speed=apart * found.speed)
        shifted.line(axes, found.rcs, [RCS_LIMIT], linestyles='dotted', linewidths=1, **red)
    others = found.line(axes, found.eta, [0.7, 0.9, 0.95, 0.98], colors=[GREY], linewidths=0.7)
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
