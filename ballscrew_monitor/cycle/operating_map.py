# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The operating map under a cycle: what the surface says of speed and opposing load.

It holds at one oil temperature, the mean of the run in motion; the border RCS = limit is drawn for
the coldest and the warmest oil too, because it moves with the oil.

"""

from collections.abc import Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import celsius
from ballscrew_monitor.cycle.state_trace import LimitsInForce, Trace
from ballscrew_monitor.recordings.operating_field import (
    Field,
    judged_speeds,
    loads_around,
    map_temperatures,
    sample,
)
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np
from numpy.typing import NDArray
from surrogate.plotting.style import BLUE, PURPLE
from surrogate.surface import FILM_RATIO_LIMITS, Surface

Array = NDArray[np.float64]

OPTIMAL_FILL, GREY = '#dff2ea', '#404040'
EFFICIENCIES = (0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.97)
TICKS = [first * 10.0**power for power in range(-2, 6) for first in (1, 2, 5)]  # [rev/min]
TOP, BELOW_TOP = 0.975, 0.925  # heights of the labels, as parts of the map
BOX = {'boxstyle': 'round,pad=0.15', 'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.85}


def draw_map(axes: Axes, trace: Trace, surface: Surface) -> tuple[float, bool]:
    """Draw the map; return its temperature [degC] and whether there are borders at others."""
    moving = np.abs(trace.speed) >= trace.limits.standstill
    oil = trace.temperature[moving & np.isfinite(trace.temperature)]
    # Without any motion the datasheet's temperature is as good as another.
    spread = oil if oil.size else np.array([celsius(surface.reference_temperature)])
    mean, others = map_temperatures(float(spread.min()), float(spread.mean()), float(spread.max()))
    spans = _spans(surface, trace)
    field = sample(surface, mean, **spans)
    _draw_zone(axes, field, trace.limits)
    _draw_lines(axes, field, trace.limits, mean)
    for degrees in others:
        other = sample(surface, degrees, **spans)
        _draw_border(axes, other, trace.limits, degrees, width=1.2, linestyles='dashed')
    _label(axes, field)
    return mean, bool(others)


def _spans(surface: Surface, trace: Trace) -> dict[str, tuple[float, float]]:
    moving = np.abs(trace.speed) >= trace.limits.standstill
    loads = trace.opposing_load[moving & np.isfinite(trace.opposing_load)]
    low, high = (float(loads.min()), float(loads.max())) if loads.size else (math.nan, math.nan)
    return {
        'speeds': judged_speeds(surface, trace.limits.standstill),
        'loads': loads_around(surface, low, high, light_load=trace.limits.light_load),
    }


def _draw_zone(axes: Axes, field: Field, limits: LimitsInForce) -> None:
    """Fill the optimal zone; under a light load only RCS counts."""
    optimal = field.is_optimal(
        rcs=limits.rcs, efficiency=limits.efficiency, light_load=limits.light_load
    )
    axes.contourf(
        field.speed,
        field.load,
        optimal.astype(float),
        levels=[0.5, 1.5],
        colors=[OPTIMAL_FILL],
        zorder=0,
    )
    axes.axhspan(
        -limits.light_load,
        limits.light_load,
        facecolor='none',
        edgecolor='#b5b5b5',
        hatch='..',
        linewidth=0.0,
        zorder=1,
    )


def _draw_lines(axes: Axes, field: Field, limits: LimitsInForce, degrees: float) -> None:
    shown = field.judged_efficiency(limits.light_load)
    lines = _contour(axes, field, shown, EFFICIENCIES, BLUE, width=0.6, alpha=0.75)
    axes.clabel(lines, fmt=lambda value: f'{100 * value:.0f} %', fontsize=7)
    _contour(axes, field, shown, [limits.efficiency], BLUE, width=2.2, zorder=3)
    _draw_border(axes, field, limits, degrees, width=2.2)
    for factor in filter(math.isfinite, field.band):
        moved = dataclasses.replace(field, speed=factor * field.speed)
        _contour(axes, moved, field.rcs, [limits.rcs], PURPLE, width=0.9, linestyles='dashdot')
    ratios = _contour(
        axes, field, field.film_ratio, FILM_RATIO_LIMITS, GREY, width=0.9, linestyles='dotted'
    )
    for level, paths in zip(FILM_RATIO_LIMITS, ratios.allsegs, strict=True):
        _name_line(axes, field, paths, f'Λ = {level:.0f}', GREY, TOP)


def _draw_border(
    axes: Axes, field: Field, limits: LimitsInForce, degrees: float, *, width: float, **more: Any
) -> None:
    """Draw the limit of RCS with the temperature that it holds at."""
    lines = _contour(axes, field, field.rcs, [limits.rcs], PURPLE, width=width, zorder=3, **more)
    _name_line(axes, field, lines.allsegs[0], f'{degrees:.0f} °C', PURPLE, BELOW_TOP)


def _contour(
    axes: Axes,
    field: Field,
    values: Array,
    levels: Sequence[float],
    colour: str,
    *,
    width: float,
    zorder: float = 2,
    **more: Any,
) -> QuadContourSet:
    """Draw lines of `values` on the grid of a field; `more` is what matplotlib takes."""
    return axes.contour(
        field.speed,
        field.load,
        values,
        levels=levels,
        colors=colour,
        linewidths=width,
        zorder=zorder,
        **more,
    )


def _name_line(
    axes: Axes, field: Field, paths: Sequence[Array], text: str, colour: str, height: float
) -> None:
    """Write on a line where it comes nearest to a `height` [-] of the map."""
    points = [path for path in paths if len(path)]
    if points:
        line = np.concatenate(points)
        level = field.load[0] + height * (field.load[-1] - field.load[0])
        x, y = line[np.argmin(np.abs(line[:, 1] - level))].tolist()
        axes.text(
            x, y, text, fontsize=8, color=colour, ha='center', va='center', bbox=BOX, zorder=6
        )


def _label(axes: Axes, field: Field) -> None:
    low, high = float(field.speed[0]), float(field.speed[-1])
    axes.set_xscale('log')
    ticks = [tick for tick in TICKS if low <= tick <= high]
    axes.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(low, high)
    axes.set_ylim(field.load[0], field.load[-1])
    axes.axhline(0.0, color='black', linewidth=0.6, zorder=2)
    axes.set_xlabel(
        'screw speed, either direction [rev/min]; each point was judged at its own oil temperature'
    )
    axes.set_ylabel('axial load [N]\nassists the motion  |  opposes the motion')


def legend_entries(limits: LimitsInForce, mean: float, *, others: bool, banded: bool) -> list[Any]:
    """Return what the lines of the map mean."""
    entries: list[Any] = [
        Patch(facecolor=OPTIMAL_FILL, edgecolor='none', label=f'optimal zone at {mean:.0f} °C'),
        Patch(
            facecolor='none',
            edgecolor='#b5b5b5',
            hatch='....',
            linewidth=0.0,
            label='light load: efficiency not judged',
        ),
        Line2D([], [], color=PURPLE, linewidth=2.2, label=f'RCS = {limits.rcs:g}'),
        Line2D(
            [], [], color=BLUE, linewidth=2.2, label=f'efficiency = {100 * limits.efficiency:g} %'
        ),
    ]
    if others:
        entries.insert(
            3,
            Line2D(
                [],
                [],
                color=PURPLE,
                linewidth=1.2,
                linestyle='dashed',
                label='RCS limit, coldest and warmest oil',
            ),
        )
    if banded:
        entries.append(
            Line2D(
                [],
                [],
                color=PURPLE,
                linewidth=0.9,
                linestyle='dashdot',
                label='RCS limit, thinnest and thickest boundary film',
            )
        )
    entries.append(
        Line2D(
            [],
            [],
            color=GREY,
            linewidth=0.9,
            linestyle='dotted',
            label='film ratio Λ = ' + ' and '.join(f'{limit:g}' for limit in FILM_RATIO_LIMITS),
        )
    )
    return entries
