# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Maps beside the published study: RCS and efficiency over speed and load (12), optimal zone (13).

Torque is interpolated between the nodes, and efficiency follows from it.

"""

from collections.abc import Sequence
import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np
from scipy.interpolate import PchipInterpolator
from surrogate.asperities.law import AsperityLaw
from surrogate.formulas.torque import efficiency
from surrogate.paper.curves import constant_friction_efficiency, grid, NO_CONTACT
from surrogate.paper.figures import captioned_figure, entrainment, finish, shades, STYLES
from surrogate.paper.rows import Array, StudyRow
from surrogate.parameters import Screw
from surrogate.plotting.style import BLUE, GREY, PURPLE, VERMILION
from surrogate.screw.record import CONSTANT_FRICTION
from surrogate.surface.aims import EFFICIENCY_LIMIT, RCS_LIMIT

SHOWN = (5.0, 50.0, 200.0, 1000.0)
"""Speeds at which efficiency is drawn over load [rev/min]."""
FINE = 161
"""Points of a map along a side [-]."""
RCS_COLOUR, ETA_COLOUR = VERMILION, BLUE


def fine_map(screw: Screw, rows: Sequence[StudyRow]) -> tuple[Array, Array, Array, Array]:
    """
    Return speeds [rev/min], loads [N], RCS and efficiency [-] between the nodes of the map.

    Monotone cubics over the logarithms of speed and load, of torque and of the logarithm of RCS.

    """
    speeds, loads, torque = grid(rows, 'friction_torque')
    rcs = np.log(np.maximum(grid(rows, 'rcs')[2], NO_CONTACT))
    fine = np.geomspace(speeds[0], speeds[-1], FINE), np.geomspace(loads[0], loads[-1], FINE)
    friction, log_rcs = (_between(speeds, loads, values, *fine) for values in (torque, rcs))
    eta = np.array(
        [
            [efficiency(float(one), float(load), screw.lead) for one in line]
            for load, line in zip(fine[1], friction, strict=True)
        ]
    )
    return fine[0], fine[1], np.exp(log_rcs), eta


def _between(speeds: Array, loads: Array, values: Array, speed: Array, load: Array) -> Array:
    """Return values at finer places: monotone cubics along the speed, then along the load."""
    known = np.array([_filled(np.log(speeds), line) for line in values])
    along = PchipInterpolator(np.log(speeds), known, axis=1)(np.log(speed))
    return np.asarray(PchipInterpolator(np.log(loads), along, axis=0)(np.log(load)))


def _filled(places: Array, line: Array) -> Array:
    """Return a line of the map with its gaps, nodes that failed, bridged straight."""
    good = np.isfinite(line)
    return np.interp(places, places[good], line[good])


def figure_maps(screw: Screw, rows: Sequence[StudyRow]) -> Figure:
    """Return maps of RCS and efficiency, and efficiency beside constant friction (12)."""
    figure = captioned_figure(
        6.9,
        'Nominal screw, ISO VG 68 at 40 °C, rolling roughness, the nodes (dots) solved, torque '
        'interpolated between them and efficiency derived from it. RCS is that '
        f'of the worst of four contacts; below {NO_CONTACT:g} it counts as 0. (c) Friction '
        f'coefficient {CONSTANT_FRICTION:g} for constant friction, an assumption.',
    )
    places = figure.subplot_mosaic([['rcs', 'eta'], ['load', 'load']], height_ratios=(1.25, 1))
    speed, load, rcs, eta = fine_map(screw, rows)
    levels = np.logspace(np.log10(NO_CONTACT), 0, 13)
    filled = places['rcs'].contourf(
        entrainment(speed),
        load,
        np.log10(np.clip(rcs, NO_CONTACT, 1)),
        np.log10(levels),
        cmap='inferno_r',
    )
    bar = figure.colorbar(filled, ax=places['rcs'], label='RCS [-]')
    bar.set_ticks(
        range(-6, 1), labels=['0', *(f'$10^{{{power}}}$' for power in range(-5, 0)), '1']
    )
    filled = places['eta'].contourf(
        entrainment(speed), load, eta, np.linspace(0.4, 1.0, 13), cmap='cividis', extend='min'
    )
    figure.colorbar(filled, ax=places['eta'], label='efficiency [-]')
    _line(places['rcs'], speed, load, rcs, RCS_LIMIT, 'white')
    _line(places['eta'], speed, load, eta, EFFICIENCY_LIMIT, 'white')
    for name, letter, title in (
        ('rcs', 'a', f'RCS, line: {RCS_LIMIT:g}'),
        ('eta', 'b', f'efficiency, line: {EFFICIENCY_LIMIT:g}'),
    ):
        _map_axes(places[name], rows)
        finish(places[name], letter, title)
    _draw_loads(places['load'], screw, rows)
    return figure


def _line(axes: Axes, speed: Array, load: Array, field: Array, value: float, colour: str) -> None:
    axes.contour(entrainment(speed), load, field, [value], colors=[colour], linewidths=2.0)


def _map_axes(axes: Axes, rows: Sequence[StudyRow]) -> None:
    speeds, loads, solved = grid(rows, 'rcs')
    x, y = np.meshgrid(entrainment(speeds), loads)
    known = np.isfinite(solved)
    axes.plot(x[known], y[known], '.', color='0.55', markersize=3)
    axes.set(
        xscale='log', yscale='log', xlabel='entrainment speed [mm/s]', ylabel='axial load [N]'
    )


def _draw_loads(axes: Axes, screw: Screw, rows: Sequence[StudyRow]) -> None:
    """Draw efficiency over load at some speeds, and that of constant friction."""
    speeds, loads, torque = grid(rows, 'friction_torque')
    chosen = [i for i, rpm in enumerate(speeds) if rpm in SHOWN]
    for i, colour, style in zip(chosen, shades(len(chosen)), STYLES, strict=False):
        eta = [
            efficiency(float(friction), float(load), screw.lead)
            for friction, load in zip(torque[:, i], loads, strict=True)
        ]
        line = {'color': colour, 'linestyle': style, 'marker': 'o', 'markersize': 4}
        axes.plot(loads, eta, label=f'mixed EHL, {speeds[i]:g} rev/min', **line)
    fine = np.geomspace(loads[0], loads[-1], 60)
    constant = [constant_friction_efficiency(screw, float(load)) for load in fine]
    label = f'constant friction {CONSTANT_FRICTION:g}, any speed'
    axes.plot(fine, constant, color='0.7', linewidth=3.5, label=label, zorder=1)
    axes.axhline(EFFICIENCY_LIMIT, color=PURPLE, linestyle='--', linewidth=1.0, label='limit 0.85')
    axes.set(xscale='log', xlabel='axial load [N]', ylabel='efficiency [-]', ylim=(0.15, 1.0))
    finish(axes, 'c', 'efficiency over load', legend='lower right')


def figure_zone(screw: Screw, law: AsperityLaw, rows: Sequence[StudyRow]) -> Figure:
    """Return the optimal zone in the plane of speed and load (13)."""
    figure = captioned_figure(
        4.6,
        f'Optimal zone (shaded): RCS below {RCS_LIMIT:g} and efficiency {EFFICIENCY_LIMIT:g} or '
        'more. Nominal screw, ISO VG 68 at 40 °C, rolling roughness, dots: solved points. Red '
        'dotted: RCS where the law is off by its standard deviation.',
    )
    axes = figure.subplots()
    speed, load, rcs, eta = fine_map(screw, rows)
    good = (rcs < RCS_LIMIT) & (eta >= EFFICIENCY_LIMIT)
    axes.contourf(entrainment(speed), load, good.astype(float), [0.5, 1.5], colors=['#bfe3d0'])
    for field, value, colour, style in (
        (rcs, RCS_LIMIT, RCS_COLOUR, 'solid'),
        (eta, EFFICIENCY_LIMIT, ETA_COLOUR, 'dashed'),
    ):
        axes.contour(
            entrainment(speed),
            load,
            field,
            [value],
            colors=[colour],
            linestyles=[style],
            linewidths=1.8,
        )
    for sign in (-1, 1):
        shifted = math.exp(sign * law.deviation) * entrainment(speed)
        axes.contour(
            shifted, load, rcs, [RCS_LIMIT], colors=[RCS_COLOUR], linestyles='dotted', linewidths=1
        )
    others = axes.contour(
        entrainment(speed), load, eta, [0.7, 0.9, 0.95, 0.98], colors=[GREY], linewidths=0.7
    )
    _map_axes(axes, rows)
    axes.clabel(others, fontsize=7, fmt='η %.2f', inline_spacing=2)
    handles = [
        Line2D([], [], color=RCS_COLOUR, label=f'RCS {RCS_LIMIT:g}'),
        Line2D([], [], color=ETA_COLOUR, linestyle='--', label=f'efficiency {EFFICIENCY_LIMIT:g}'),
        Line2D([], [], marker='s', color='#bfe3d0', linestyle='none', label='optimal zone'),
    ]
    finish(axes, legend=None)
    axes.legend(handles=handles, fontsize=8, loc='lower left', framealpha=1)
    return figure
