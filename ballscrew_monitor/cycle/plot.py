# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture of a cycle: its path over the operating map, and its course in time."""

from collections.abc import Sequence
import itertools
import math
from pathlib import Path

from ballscrew_monitor.cycle.operating_map import BOX, draw_map, legend_entries
from ballscrew_monitor.cycle.state_trace import Trace
from ballscrew_monitor.recordings.summary import EventRecord, Summary
from ballscrew_msgs.msg import BallScrewState
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np
from numpy.typing import NDArray
from surrogate.plotting.style import BLUE, draw_picture, GREEN, GREY, new_figure, PURPLE, VERMILION
from surrogate.surface import FILM_RATIO_LIMITS, REGIMES, Surface
from surrogate.units import RPM

Array = NDArray[np.float64]

SIZE = (11.0, 14.5)  # [inch]
ZONES = (
    (BallScrewState.ZONE_UNKNOWN, GREY, 'not judged'),
    (BallScrewState.ZONE_OUTSIDE, VERMILION, 'outside'),
    (BallScrewState.ZONE_OPTIMAL, GREEN, 'optimal'),
)
LEVELS = (
    (BallScrewState.LEVEL_UNKNOWN, '#e4e4e4', 'unknown'),
    (BallScrewState.LEVEL_OK, '#8fd3bb', 'ok'),
    (BallScrewState.LEVEL_WARN, '#f0a56e', 'warning'),
)
REGIME_COLOURS = ('#fbe3d6', '#fdf6d3', '#dbeaf5')
SMALLEST_RCS = 1e-4  # [-] the bottom of its strip; smaller ones are drawn on it
NAME_MARGIN = 0.003  # [-] of the axes, on both sides of the name of an event
NEAR_EDGE = (0.96, 0.93)  # parts of the map from which on a mark is left of or below its spot
STRIPS = (1.25, 1.25, 0.8, 1.25, 1.35, 1.35, 0.35)


def draw(trace: Trace, summary: Summary, surface: Surface, path: Path) -> None:
    """Write the picture to `path` (PNG), which appears only when it is complete."""
    draw_picture(path, lambda: figure_cycle(trace, summary, surface))


def figure_cycle(trace: Trace, summary: Summary, surface: Surface) -> Figure:
    """Return the operating map with the path of the cycle, and its course in time below."""
    figure = new_figure(*SIZE)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.0, 1.15), squeeze=False)[:, 0]
    axes = upper.subplots()
    mean, others = draw_map(axes, trace, surface)
    _draw_path(axes, trace, summary)
    banded = math.isfinite(surface.limit_band[0])
    _finish_map(axes, trace, mean, others=others, banded=banded)
    axes.set_title(
        f'Ball screw axis {trace.axis}: cycle on the operating map\n'
        f'screw {surface.screw_name}, oil {surface.oil_name}, '
        f'{surface.tier.replace("_", "-")} model, map at {mean:.0f} °C oil',
        fontsize=12,
    )
    _draw_strips(lower.subplots(len(STRIPS), 1, sharex=True, height_ratios=STRIPS), trace, summary)
    return figure


def _draw_path(axes: Axes, trace: Trace, summary: Summary) -> None:
    moving = np.abs(trace.speed) >= trace.limits.standstill
    speed = np.where(moving, np.abs(trace.speed) / RPM, math.nan)
    axes.plot(speed, trace.opposing_load, color='#b0b0b0', linewidth=0.5, zorder=4)
    for zone, colour, _ in ZONES:
        chosen = moving & (trace.zone == zone)
        axes.scatter(
            speed[chosen], trace.opposing_load[chosen], s=7, color=colour, zorder=5, linewidths=0.0
        )
    for event in summary.events:
        _mark_event(axes, trace, speed, event, summary)


def _mark_event(
    axes: Axes, trace: Trace, speed: Array, event: EventRecord, summary: Summary
) -> None:
    """Write the number of the event at the median of its points outside."""
    begin, end = summary.span(event)
    inside = (
        (trace.time >= begin)
        & (trace.time <= end)
        & np.isfinite(speed)
        & (trace.zone == BallScrewState.ZONE_OUTSIDE)
    )
    if not inside.any():
        return
    spot = (float(np.median(speed[inside])), float(np.median(trace.opposing_load[inside])))
    axes.annotate(
        str(event.event_id),
        spot,
        xytext=_towards_inside(axes, spot),
        textcoords='offset points',
        fontsize=9,
        fontweight='bold',
        ha='center',
        va='center',
        zorder=8,
        bbox={'boxstyle': 'circle,pad=0.25', 'facecolor': 'white', 'edgecolor': VERMILION},
        arrowprops={'arrowstyle': '-', 'color': VERMILION},
    )


def _towards_inside(axes: Axes, spot: tuple[float, float]) -> tuple[float, float]:
    """Return where a mark is from its spot [point]: above and right of it, but within the map."""
    x, y = axes.transAxes.inverted().transform(axes.transData.transform(spot))
    return (18 if x < NEAR_EDGE[0] else -18), (16 if y < NEAR_EDGE[1] else -16)


def _finish_map(axes: Axes, trace: Trace, mean: float, *, others: bool, banded: bool) -> None:
    moving = np.abs(trace.speed) >= trace.limits.standstill
    dots = [
        Line2D(
            [],
            [],
            marker='o',
            linestyle='',
            markersize=5,
            color=colour,
            label=f'operating point, {name}',
        )
        for zone, colour, name in reversed(ZONES)
        if (moving & (trace.zone == zone)).any()
    ]
    dots.append(Line2D([], [], marker='$1$', linestyle='', color='black', label='warning number'))
    axes.legend(
        handles=dots + legend_entries(trace.limits, mean, others=others, banded=banded),
        fontsize=8,
        loc='upper center',
        bbox_to_anchor=(0.5, -0.11),
        ncols=3,
        frameon=False,
    )


def _draw_strips(strips: Sequence[Axes], trace: Trace, summary: Summary) -> None:
    speed, load, oil, efficiency, ratio, rcs, level = strips
    _line(speed, trace, trace.speed / RPM, 'speed\n[rev/min]')
    _line(load, trace, trace.axial_load, 'axial load\n[N]')
    _line(oil, trace, trace.temperature, 'oil\n[°C]')
    _draw_efficiency(efficiency, trace)
    _draw_ratio(ratio, trace)
    _draw_rcs(rcs, trace)
    _draw_level(level, trace)
    for strip in strips:
        strip.grid(axis='x', color='#d0d0d0', linewidth=0.5)
        strip.tick_params(labelsize=8)
        for event in summary.events if strip is not ratio else ():
            strip.axvspan(
                *summary.span(event), color='#f0a56e', alpha=0.16, linewidth=0.0, zorder=0
            )
    strips[-1].set_xlim(0.0, float(trace.time[-1]) or 1.0)
    strips[-1].set_xlabel('time [s]')
    _name_events(level, summary)


def _line(axes: Axes, trace: Trace, values: Array, label: str) -> None:
    axes.plot(trace.time, values, color='black', linewidth=0.8)
    axes.axhline(0.0, color=GREY, linewidth=0.5) if values.min() < 0.0 < values.max() else None
    axes.set_ylabel(label, fontsize=8)


def _dots(axes: Axes, trace: Trace, values: Array, label: str) -> None:
    """Draw a judged quantity in the colours of the zones."""
    for zone, colour, _ in ZONES:
        chosen = trace.zone == zone
        axes.scatter(
            trace.time[chosen], values[chosen], s=2.5, color=colour, linewidths=0.0, zorder=3
        )
    axes.set_ylabel(label, fontsize=8)


def _draw_efficiency(axes: Axes, trace: Trace) -> None:
    _dots(axes, trace, 100.0 * trace.efficiency, 'efficiency\n[%]')
    axes.axhline(100.0 * trace.limits.efficiency, color=BLUE, linewidth=1.4, zorder=2)
    axes.set_ylim(50.0, 100.0)
    _name_limit(
        axes, 100.0 * trace.limits.efficiency, f'limit {100 * trace.limits.efficiency:g} %', BLUE
    )


def _draw_ratio(axes: Axes, trace: Trace) -> None:
    _dots(axes, trace, trace.film_ratio, 'film ratio Λ\n[-]')
    axes.set_yscale('log')
    low, high = 0.02, 10.0
    ticks = [0.1, *FILM_RATIO_LIMITS, high]
    axes.set_yticks(ticks, [f'{tick:g}' for tick in ticks])
    axes.minorticks_off()
    spans = itertools.pairwise((low, *FILM_RATIO_LIMITS, high))
    for regime, (begin, end), colour in zip(REGIMES, spans, REGIME_COLOURS, strict=True):
        axes.axhspan(begin, end, color=colour, linewidth=0.0, zorder=-1)
        axes.text(
            0.995,
            math.sqrt(begin * end),
            regime.word,
            fontsize=7,
            ha='right',
            va='center',
            transform=axes.get_yaxis_transform(),
            bbox=BOX,
        )
    axes.set_ylim(low, high)


def _draw_rcs(axes: Axes, trace: Trace) -> None:
    _dots(axes, trace, np.maximum(trace.rcs, SMALLEST_RCS), 'RCS\n[-]')
    axes.set_yscale('log')
    axes.set_ylim(0.7 * SMALLEST_RCS, 1.5)
    axes.set_yticks([SMALLEST_RCS, 1e-2, 1.0], [f'\u2264 {SMALLEST_RCS:g}', '0.01', '1'])
    axes.axhline(trace.limits.rcs, color=PURPLE, linewidth=1.4, zorder=2)
    _name_limit(axes, trace.limits.rcs, f'limit {trace.limits.rcs:g}', PURPLE)


def _name_limit(axes: Axes, value: float, text: str, colour: str) -> None:
    axes.text(
        0.995,
        value,
        text,
        fontsize=7,
        color=colour,
        ha='right',
        va='bottom',
        transform=axes.get_yaxis_transform(),
        bbox=BOX,
    )


def _draw_level(axes: Axes, trace: Trace) -> None:
    for level, colour, _ in LEVELS:
        axes.fill_between(
            trace.time,
            0.0,
            1.0,
            where=trace.level == level,
            color=colour,
            step='post',
            linewidth=0.0,
        )
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.set_ylabel('warning', fontsize=8, rotation=0, ha='right', va='center')


def _name_events(axes: Axes, summary: Summary) -> None:
    """
    Write number and cause of each event in its middle, or the number alone where that is too wide.

    A name stays within the axes, beside which that of the strip stands, and ends before the next
    event begins; where not even the number has room, none is written.

    """
    width = axes.get_xlim()[1]
    spans = [(begin / width, end / width) for begin, end in map(summary.span, summary.events)]
    limits = [begin for begin, _ in spans[1:]] + [1.0] * bool(spans)
    free = 0.0
    for event, (begin, end), limit in zip(summary.events, spans, limits, strict=True):
        for words in (f'{event.event_id}: {event.quantity}', str(event.event_id)):
            label = _name_event(axes, words, 0.5 * (begin + end), (free, limit))
            if label is not None:
                free = label
                break


def _name_event(axes: Axes, words: str, middle: float, room: tuple[float, float]) -> float | None:
    """Write a name near `middle` [-] within its room; return its end, None where it has none."""
    label = axes.text(
        middle,
        0.5,
        words,
        fontsize=8,
        ha='center',
        va='center',
        fontweight='bold',
        transform=axes.transAxes,
    )
    half = 0.5 * label.get_window_extent().width / axes.get_window_extent().width + NAME_MARGIN
    low, high = room[0] + half, room[1] - half
    if low > high:
        label.remove()
        return None
    label.set_x(min(max(middle, low), high))
    return float(label.get_position()[0]) + half
