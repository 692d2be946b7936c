# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a surface over speed and load: what it says, how sure it is, and the zone."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
import math
from pathlib import Path
import textwrap
from typing import Any

from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
import numpy as np
from numpy.typing import NDArray
from surrogate.plotting.style import (
    BROWN,
    draw_picture,
    GREEN,
    LESS_IS_GOOD,
    MAP,
    new_figure,
    PURPLE,
    REGIMES_BY_METAL,
    SKY,
    VERMILION,
)
from surrogate.surface import FILM_RATIO_LIMITS, onset_of_surface, REGIMES, Surface, Validity
from surrogate.surface.aims import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT
from surrogate.units import RPM, ZERO_CELSIUS

Array = NDArray[np.float64]

GRID = (181, 141)
"""Points along speed and load [-]."""
EFFICIENCY_SHOWN = 0.6
"""Lower end of the efficiency scale [-]: what lies below is as dark as this."""
LIMIT: dict[str, Any] = {'colors': VERMILION, 'linewidths': 1.6}
LIGHT, UNKNOWN = '#d9d9d9', '#bdbdbd'
"""Colours of a light load and of no answer."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Slice:
    """
    The surface at one temperature: speed [rev/min], load [N], fields [load, speed].

    Load below which no efficiency is judged [N]; least and largest limit of RCS in speed over that
    of the fields [-] by the line that shows it, NaN if not known.

    """

    speed: Array
    load: Array
    fields: dict[str, Array]
    light: float
    bands: dict[str, tuple[float, float]]


def cut(surface: Surface, temperature: float) -> Slice:
    """Return the surface at a temperature [K]; NaN where it has no answer."""
    slow, fast = surface.speed_range
    speed = np.clip(np.geomspace(slow, fast, GRID[0]), slow, fast)
    load = np.linspace(*surface.load_range, GRID[1])
    points = [surface.lookup(w, f, temperature) for f in load.tolist() for w in speed.tolist()]
    names = ('efficiency', 'rcs', 'film_ratio', 'efficiency_error', 'rcs_error', 'rcs_std')
    shape = (len(load), len(speed))
    valid = np.reshape([point.validity is Validity.VALID for point in points], shape)
    fields = {
        name: np.where(
            valid, np.reshape([getattr(point, name) for point in points], shape), np.nan
        )
        for name in names
    }
    light = LIGHT_LOAD * surface.preload
    bands = {'dashed': surface.onset_band, 'dotted': surface.numerical_band}
    return Slice(speed=speed / RPM, load=load, fields=fields, light=light, bands=bands)


def draw_surface(folder: Path, surface: Surface, temperatures: Sequence[float]) -> Iterator[Path]:
    """Write a picture per temperature [K] to `folder` as PNG and yield the paths."""
    for kelvin in temperatures:
        name = f'surface_{kelvin - ZERO_CELSIUS:g}degC.png'
        yield draw_picture(folder / name, partial(figure_surface, surface, kelvin))


def figure_surface(surface: Surface, temperature: float) -> Figure:
    """Return what the surface says at a temperature [K], and how far strips of it differ."""
    part = cut(surface, temperature)
    panels: list[Callable[[Figure, Axes, Slice], None]] = [
        _draw_zone,
        _draw_efficiency,
        _draw_rcs,
        _draw_film_ratio,
        _draw_regime,
        _draw_error,
    ]
    rows = len(panels) // 2
    figure = new_figure(7.2, 1.0 + 2.9 * rows)
    figure.suptitle(
        f'{surface.screw_name}, {surface.oil_name}, {temperature - ZERO_CELSIUS:g} degC, '
        f'tier {surface.tier}, surface {surface.sha256[:8]}\n'
        f'{textwrap.fill(onset_of_surface(surface, temperature).sentence(), 90)}\n'
        'bright is good in every map; grey: not known',
        fontsize=8,
    )
    grid = figure.subplots(rows, 2, sharex=True, sharey=True)
    for draw, axes in zip(panels, grid.flat):
        draw(figure, axes, part)
    for axes in grid[-1]:
        axes.set_xlabel('speed [rev/min]')
    for axes in grid[:, 0]:
        axes.set_ylabel('load against motion [N]')
    grid[0, 0].set(xscale='log', xlim=(part.speed[0], part.speed[-1]))
    return figure


def _map(
    figure: Figure, axes: Axes, part: Slice, values: Array, title: str, label: str, **options: Any
) -> None:
    axes.set_title(title)
    axes.set_facecolor(UNKNOWN)
    if not np.isfinite(values).any():
        axes.text(0.5, 0.5, 'not known', transform=axes.transAxes, ha='center')
        return
    mesh = axes.pcolormesh(
        part.speed, part.load, values, **{'cmap': MAP, 'rasterized': True, **options}
    )
    bar = figure.colorbar(mesh, ax=axes, label=label)
    bar.ax.tick_params(labelsize=8)


def _limit(axes: Axes, part: Slice, values: Array, levels: list[float]) -> None:
    if _reaches(values, levels):
        lines = axes.contour(part.speed, part.load, values, levels=levels, **LIMIT)
        if len(levels) > 1:
            axes.clabel(lines, fmt='%g', fontsize=7)


def _reaches(values: Array, levels: list[float]) -> bool:
    known = values[np.isfinite(values)]
    return bool(known.size) and any(known.min() < level < known.max() for level in levels)


def _draw_efficiency(figure: Figure, axes: Axes, part: Slice) -> None:
    values, title = part.fields['efficiency'], f'Efficiency, line: {EFFICIENCY_LIMIT}'
    _map(figure, axes, part, values, title, '[-]', vmin=EFFICIENCY_SHOWN, vmax=1.0)
    _limit(axes, part, values, [EFFICIENCY_LIMIT])


def _draw_rcs(figure: Figure, axes: Axes, part: Slice) -> None:
    values = part.fields['rcs']
    norm = LogNorm(1e-4, 1.0)
    words = zip(part.bands.items(), ('its band', 'numerics alone'), strict=True)
    title = f'RCS, line: {RCS_LIMIT}' + ''.join(
        f', {style}: {text}' for (style, band), text in words if math.isfinite(band[0])
    )
    _map(figure, axes, part, np.maximum(values, 1e-4), title, '[-]', norm=norm, cmap=LESS_IS_GOOD)
    _limit(axes, part, values, [RCS_LIMIT])
    for style, band in part.bands.items() if _reaches(values, [RCS_LIMIT]) else ():
        for factor in filter(math.isfinite, band):
            speed = factor * part.speed
            axes.contour(speed, part.load, values, levels=[RCS_LIMIT], linestyles=style, **LIMIT)


def _draw_film_ratio(figure: Figure, axes: Axes, part: Slice) -> None:
    values = part.fields['film_ratio']
    known = values[np.isfinite(values) & (values > 0)]
    norm = LogNorm(known.min(), known.max()) if known.size else None
    _map(figure, axes, part, values, 'Film ratio Lambda, lines: 1 and 3', '[-]', norm=norm)
    _limit(axes, part, values, [1.0, 3.0])


def _classes(
    axes: Axes, part: Slice, values: Array, title: str, names: Sequence[tuple[str, str]]
) -> None:
    """Draw numbered classes with a legend of those that occur."""
    colours = [colour for _, colour in names]
    axes.pcolormesh(
        part.speed,
        part.load,
        values,
        cmap=ListedColormap(colours),
        norm=BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours)),
        rasterized=True,
    )
    axes.set_facecolor(UNKNOWN)
    axes.set_title(title)
    numbers = {int(value) for value in values[np.isfinite(values)]}
    patches = [
        Patch(color=colour, label=name)
        for number, (name, colour) in enumerate(names)
        if number in numbers
    ]
    axes.legend(handles=patches, fontsize=7, loc='upper left', framealpha=0.9)


def _draw_regime(figure: Figure, axes: Axes, part: Slice) -> None:
    spread = part.fields['rcs_std']
    if np.isfinite(spread).any():
        # Where it is known, how far strips differ takes the place of the regime.
        _log_map(figure, axes, part, spread, 'RCS over strips', 'standard deviation [-]')
        return
    ratio = part.fields['film_ratio']
    bands = np.where(np.isfinite(ratio), np.digitize(ratio, FILM_RATIO_LIMITS), np.nan)
    low, high = FILM_RATIO_LIMITS
    ranges = (f'< {low:g}', f'{low:g} to {high:g}', f'>= {high:g}')
    names = [
        (f'{regime.word}, {span}', colour)
        for regime, span, colour in zip(REGIMES, ranges, REGIMES_BY_METAL, strict=True)
    ]
    _classes(axes, part, bands, 'Regime by Lambda', names)


def _draw_zone(figure: Figure, axes: Axes, part: Slice) -> None:
    title = f'Zone: RCS < {RCS_LIMIT}, efficiency >= {EFFICIENCY_LIMIT}'
    names = [
        ('optimal', GREEN),
        ('too much contact', PURPLE),
        ('too much loss', SKY),
        ('both', BROWN),
        ('light load, no efficiency', LIGHT),
    ]
    _classes(axes, part, zone_classes(part), title, names)


def zone_classes(part: Slice) -> Array:
    """Return 0 optimal, 1 too much contact, 2 too much loss, 3 both, 4 light load, NaN unknown."""
    rcs, efficiency = part.fields['rcs'], part.fields['efficiency']
    classes = (rcs >= RCS_LIMIT) + 2.0 * (efficiency < EFFICIENCY_LIMIT)
    light = np.abs(part.load)[:, None] < part.light
    classes = np.where(light & (rcs < RCS_LIMIT), 4.0, np.where(light, 1.0, classes))
    return np.where(np.isfinite(rcs), classes, np.nan)


def _draw_error(figure: Figure, axes: Axes, part: Slice) -> None:
    # Beside zero load no efficiency is judged, and its error has no meaning.
    light = np.abs(part.load)[:, None] < part.light
    efficiency = np.where(light, np.nan, part.fields['efficiency_error'])
    _log_map(
        figure,
        axes,
        part,
        np.fmax(efficiency, part.fields['rcs_error']),
        'Interpolation error, larger of both',
        'of efficiency and RCS [-]',
    )


def _log_map(
    figure: Figure, axes: Axes, part: Slice, values: Array, title: str, label: str
) -> None:
    """Draw three decades below the largest value, which is bad."""
    known = values[np.isfinite(values)]
    top = float(known.max()) if known.size and known.max() > 0 else 1.0
    norm = LogNorm(1e-3 * top, top)
    least = np.maximum(values, 1e-3 * top)
    _map(figure, axes, part, least, title, label, norm=norm, cmap=LESS_IS_GOOD)
