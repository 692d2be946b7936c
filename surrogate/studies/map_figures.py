# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Maps beside the published study: RCS and efficiency over speed and load (12), optimal zone (13).

Torque is interpolated between the nodes, and efficiency follows from it.

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
from surrogate.plotting.style import BLUE, GREY, VERMILION
from surrogate.screw.record import CONSTANT_FRICTION
from surrogate.studies.drawing import declared_figure, entrainment, finish, limit, shades, STYLES
from surrogate.studies.rows import Array, constant_friction_efficiency, grid, NO_CONTACT, StudyRow
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT

SHOWN = (5.0, 50.0, 200.0, 1000.0)
"""Speeds at which efficiency is drawn over load [rev/min]."""
FINE = 161
"""Points of a map along a side [-]."""
ZONE = '#bfe3d0'
Rows = Sequence[StudyRow]


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
    speed, load = (np.geomspace(one[0], one[-1], FINE) for one in (speeds, loads))
    friction, log_rcs = (_between(speeds, loads, values, speed, load) for values in (torque, rcs))
    return FineMap(entrainment(speed), load, np.exp(log_rcs), _efficiency(screw, load, friction))


def _efficiency(screw: Screw, load: Array, torque: Array) -> Array:
    """Return the efficiency [-] under loads [N] of torques [N m], a line for each load."""
    return np.array(
        [
            [efficiency(float(one), float(force), screw.lead) for one in line]
            for force, line in zip(load, torque, strict=True)
        ]
    )


def _between(speeds: Array, loads: Array, values: Array, speed: Array, load: Array) -> Array:
    """Return values at finer places: monotone cubics along the speed, then along the load."""
    places, lines = np.log(speeds), []
    for line in values:  # gaps, nodes that failed, are bridged straight
        good = np.isfinite(line)
        lines.append(np.interp(places, places[good], line[good]))
    along = PchipInterpolator(places, np.array(lines), axis=1)(np.log(speed))
    return np.asarray(PchipInterpolator(np.log(loads), along, axis=0)(np.log(load)))


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
    _draw_loads(places['load'], screw, rows)
    return figure


def _map_axes(axes: Axes, rows: Rows) -> None:
    speeds, loads, solved = grid(rows, 'rcs')
    x, y = np.meshgrid(entrainment(speeds), loads)
    known = np.isfinite(solved)
    axes.plot(x[known], y[known], '.', color='0.55', markersize=3)
    labels = {'xlabel': 'entrainment speed [mm/s]', 'ylabel': 'axial load [N]'}
    axes.set(xscale='log', yscale='log', **labels)


def _draw_loads(axes: Axes, screw: Screw, rows: Rows) -> None:
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
        shifted = found._replace(speed=math.exp(sign * law.deviation) * found.speed)
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
