# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A page as one picture: the maps of its axes, each above its columns over time."""

from collections.abc import Sequence
import math
from pathlib import Path
import re
import textwrap
from typing import Any

from ballscrew_monitor.report import map_record
from ballscrew_monitor.report.judging import AxisCase, LogCase
from ballscrew_monitor.report.map_record import OperatingMap
from ballscrew_monitor.report.page import component
from ballscrew_monitor.report.time_series import BAR_LEGEND, BARS, drawn_rows, panels
from ballscrew_monitor.report.verdict import verdict_of
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, ListedColormap, LogNorm, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np
import polars as pl
from surrogate.plotting.style import draw_picture, new_figure

WIDTH, HEIGHT = 11.0, 16.0  # [inch] of an axis
LINE = 90  # letters
COLOURS = dict(re.findall(r'--([\w-]+): (#\w+);', component('page.css').partition('@media')[0]))
"""Those of the page on light paper, by their names."""
STYLES = {
    'rcs': ('rcs', 2.2, None),
    'rcs_other': ('rcs', 1.2, '6 4'),
    'rcs_band': ('rcs', 0.9, '8 3 2 3'),
    'efficiency': ('efficiency', 2.2, None),
    'efficiency_other': ('efficiency', 0.6, None),
    'film': ('muted', 1.0, '2 3'),
}
"""Colour, width and dashes of the lines of a map, by their kinds."""
TICKS = [first * 10.0**power for power in range(-5, 6) for first in (1, 2, 5)]
DARKEST, DECADES = 0.85, 3  # of the time spent: opacity of the longest, and its range
CENTRED: dict[str, Any] = {'ha': 'center', 'va': 'center', 'clip_on': True}
ROOM = (0.022, 0.035)  # half the width and the height of a name, as parts of a map
BOX = {'boxstyle': 'round,pad=0.15', 'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.85}


def draw_log(log: LogCase, maps: Sequence[OperatingMap], path: Path) -> None:
    """Write the picture to `path` (PNG), which appears only when it is complete."""
    draw_picture(path, lambda: figure_log(log, maps))


def figure_log(log: LogCase, maps: Sequence[OperatingMap]) -> Figure:
    """Return the axes of a recording side by side; there is at least one."""
    figure = new_figure(WIDTH * len(maps), HEIGHT)
    parts = figure.subfigures(1, len(maps), squeeze=False)[0]
    for part, case, chart in zip(parts, log.axes, maps, strict=True):
        upper, lower = part.subfigures(2, 1, height_ratios=(1.0, 1.25), squeeze=False)[:, 0]
        axes, surface, verdict = upper.subplots(), case.surface, verdict_of(case)
        judged, contact = (
            textwrap.fill(sentence, LINE) for sentence in (verdict.whole, verdict.contact)
        )
        axes.set_title(
            f'{judged}\n{contact}\n'
            f'screw {surface.screw_name}, oil {surface.oil_name}, '
            f'{surface.tier.replace("_", "-")} model, map at {chart.temperature:g} °C oil',
            fontsize=11,
        )
        _draw_map(axes, case, chart)
        rows, shown = drawn_rows(case), panels(case)
        heights = 80, *(panel['height'] for panel in shown)
        strips = lower.subplots(len(heights), 1, sharex=True, height_ratios=heights)
        _draw_bars(strips[0], case, rows)
        shade = {'color': COLOURS['outside'], 'alpha': 0.14, 'linewidth': 0.0, 'zorder': 0}
        for strip, panel in zip(strips[1:], shown, strict=True):
            _draw_panel(strip, panel, rows)
            for event in case.outcome.events if not panel['bands'] else ():
                strip.axvspan(*case.span(event), **shade)
        strips[-1].set_xlim(0.0, case.survey.length or 1.0)
        strips[-1].set_xlabel('time [s]')
    return figure


def _draw_map(axes: Axes, case: AxisCase, chart: OperatingMap) -> None:
    axes.set_xscale('log')
    zone = np.ma.masked_not_equal(chart.zone, map_record.OPTIMAL)
    axes.pcolormesh(*_edges(chart, zone), zone, cmap=ListedColormap([COLOURS['zone']]))
    longest = map_record.longest_dwell(chart.dwell)
    heat = [to_rgba(COLOURS['heat'], opacity) for opacity in (0.1, DARKEST)]
    axes.pcolormesh(
        *_edges(chart, chart.dwell),
        np.ma.masked_equal(chart.dwell, 0.0),
        cmap=LinearSegmentedColormap.from_list('heat', heat),
        norm=LogNorm(vmin=longest * 10.0**-DECADES, vmax=longest),
    )
    light = {'facecolor': 'none', 'edgecolor': COLOURS['hatch'], 'hatch': '..', 'linewidth': 0.0}
    axes.axhspan(-chart.light_load, chart.light_load, **light)
    for line in chart.lines:
        colour, width, dash = STYLES[line.kind]
        dashes = _dashes(dash)
        axes.plot(*line.points.T, color=COLOURS[colour], linewidth=width, linestyle=dashes)
    _name_lines(axes, chart)
    for mark in chart.events:
        circle = {'boxstyle': 'circle', 'facecolor': 'white', 'edgecolor': COLOURS['outside']}
        axes.text(
            mark['speed'], mark['load'], str(mark['number']), bbox=circle, zorder=8, **CENTRED
        )
    axes.set(xlim=chart.speed, ylim=chart.load)
    # Speeds stand below the map, as feeds if the log speaks of these, then turns above it.
    axes.minorticks_off()
    axes.set_xlabel('screw speed, either direction [rev/min]')
    if chart.feed:
        above = axes.secondary_xaxis('top')
        above.minorticks_off()
        above.set_xticks(*_ticks(chart, 1.0), fontsize=8)
        above.set_xlabel('screw speed [rev/min]', fontsize=8)
        axes.set_xlabel('feed, either direction [m/min]')
    axes.set_xticks(*_ticks(chart, chart.feed or 1.0))
    axes.set_ylabel('axial load [N]: assists | opposes')
    entries = [_entry(*sample, label=text) for sample, text in map_record.map_legend(case, chart)]
    _legend(axes, entries, -0.1)


def _ticks(chart: OperatingMap, unit: float) -> tuple[list[float], list[str]]:
    """Return places and texts of round speeds, `unit` of which are 1 rev/min."""
    low, high = (unit * speed for speed in chart.speed)
    ticks = [tick for tick in TICKS if low <= tick <= high]
    return [tick / unit for tick in ticks], [f'{tick:g}' for tick in ticks]


def _edges(chart: OperatingMap, cells: Any) -> tuple[Any, Any]:
    rows, columns = cells.shape
    return np.geomspace(*chart.speed, columns + 1), np.linspace(*chart.load, rows + 1)


def _name_lines(axes: Axes, chart: OperatingMap) -> None:
    """Write on each line where it is nearest to its height, unless a name is there already."""
    taken: list[tuple[float, float]] = []
    slowest, fastest = np.log(chart.speed)
    for line in reversed(chart.lines):  # the limits come last, and first to a place
        known = line.points[np.isfinite(line.points[:, 1])]
        if line.label and len(known):
            parts = (
                (np.log(known[:, 0]) - slowest) / (fastest - slowest),
                (known[:, 1] - chart.load[0]) / np.ptp(chart.load),
            )
            points = np.stack(parts, axis=-1)
            across, up = points[np.argmin(np.abs(points[:, 1] - line.height))].tolist()
            place = min(max(across, ROOM[0]), 1.0 - ROOM[0]), up
            if all(abs(place[0] - x) > 2 * ROOM[0] or abs(up - y) > ROOM[1] for x, y in taken):
                taken.append(place)
                colour, _, _ = STYLES[line.kind]
                style = CENTRED | {'color': COLOURS[colour], 'bbox': BOX, 'zorder': 6}
                axes.text(*place, line.label, fontsize=8, transform=axes.transAxes, **style)


def _dashes(dash: str | None) -> Any:
    return (0, tuple(map(float, dash.split()))) if dash else 'solid'


def _entry(kind: str, shape: str = 'fill', dash: str | None = None, *, label: str) -> Any:
    """Return a sample of a colour, as `page.swatch` does."""
    colour = COLOURS.get(kind, COLOURS['muted'])
    if shape == 'line':
        return Line2D([], [], color=colour, linestyle=_dashes(dash), label=label)
    hatch = '....' if shape == 'dots' else None
    face = 'none' if hatch else colour
    return Patch(facecolor=face, edgecolor=colour, hatch=hatch, linewidth=0.0, label=label)


def _legend(axes: Axes, entries: list[Any], height: float) -> None:
    place: dict[str, Any] = {'loc': 'upper center', 'bbox_to_anchor': (0.5, height)}
    axes.legend(handles=entries, ncols=3, frameon=False, fontsize=8, **place)


def _draw_bars(axes: Axes, case: AxisCase, rows: pl.DataFrame) -> None:
    edges = np.append(rows['time'], rows['time'][-1])
    for place, (key, _, colours) in enumerate(reversed(BARS)):
        cmap = ListedColormap([COLOURS[colour] for colour in colours])
        limits: dict[str, Any] = {'vmin': -0.5, 'vmax': len(colours) - 0.5}
        axes.pcolormesh(
            edges, [place, place + 0.9], rows[key].to_numpy()[None], cmap=cmap, **limits
        )
        for event in case.worst_first[: map_record.MARKED] if key == 'level' else ():
            middle = 0.5 * sum(case.span(event))
            axes.text(middle, place + 0.45, str(event.event_id), fontsize=8, **CENTRED)
    axes.set_yticks(np.arange(len(BARS)) + 0.45, [title for _, title, _ in reversed(BARS)])
    axes.tick_params(length=0, labelsize=8)
    axes.spines[:].set_visible(False)
    _legend(axes, [_entry(kind, label=text) for kind, text in BAR_LEGEND if kind in COLOURS], 2.0)


def _draw_panel(axes: Axes, panel: dict[str, Any], rows: pl.DataFrame) -> None:
    """Draw the numbers of a panel with its limits and bands; what is below its floor, on it."""
    floor, seen = panel['floor'], list(panel['show'])
    for series in panel['series']:
        values = rows[series['key']].to_numpy()
        values = values if floor is None else np.maximum(values, floor)
        style = 'dashed' if series['dashed'] else 'solid'
        axes.plot(
            rows['time'], values, color=COLOURS[series['colour']], linewidth=0.8, linestyle=style
        )
        known = values[np.isfinite(values)]
        seen += [known.min(), known.max()] if known.size else []
    for limit in panel['limits']:
        axes.axhline(limit['value'], color=COLOURS[limit['colour']], linewidth=1.4)
        _name_level(axes, limit['value'], limit['label'], 'bottom')
    low, high = min(seen, default=0.0), max(seen, default=1.0)
    if floor is None:  # numbers with a margin, as `panel.js` has them
        margin = 0.06 * (high - low) or 0.05 * abs(high) or 1.0
        low, high = low - margin, min(high + margin, panel['most'] or math.inf)
    else:
        low, high = low / 1.3, high * 1.3
    axes.set_ylim(low, high)
    for band in panel['bands']:
        axes.axhspan(band['low'], band['high'], color=COLOURS[band['colour']], zorder=-1)
        middle = math.sqrt(max(band['low'], low) * min(band['high'], high))
        _name_level(axes, middle, band['label'], 'center')
    axes.set_yscale('linear' if floor is None else 'log')
    axes.set_title(panel['title'], loc='left', fontsize=8, pad=3)
    axes.tick_params(labelsize=8)
    axes.grid(visible=True)


def _name_level(axes: Axes, value: float, text: str, side: str) -> None:
    place: dict[str, Any] = {'transform': axes.get_yaxis_transform(), 'ha': 'right', 'va': side}
    axes.text(0.995, value, text, fontsize=7, clip_on=True, bbox=BOX, **place)
