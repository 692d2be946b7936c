# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Friction of each axis over dates, with its interval."""

from collections.abc import Iterable, Mapping, Sequence
import datetime
from pathlib import Path

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.records import Condition, Health, TOLERANCE
from matplotlib.axes import Axes
from matplotlib.dates import AutoDateLocator, ConciseDateFormatter, date2num
from matplotlib.figure import Figure
import numpy as np
from numpy.typing import NDArray
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, SKY, VERMILION

WIDTH, HEIGHT = 8.0, 3.0  # [inch] of one axis
MOST_DRAWN = 40
"""Axes in one picture, which may be 65536 pixels high."""


def draw_health(courses: Mapping[str, Sequence[Health]], path: Path) -> None:
    """Write the picture of the courses of axes to `path` (PNG)."""
    draw_picture(path, lambda: figure_health(courses))


def figure_health(courses: Mapping[str, Sequence[Health]]) -> Figure:
    """Return a panel for each axis."""
    figure = new_figure(WIDTH, HEIGHT * len(courses))
    panels = figure.subplots(len(courses), 1, squeeze=False)[:, 0]
    for panel, (axis, course) in zip(panels, courses.items(), strict=True):
        panel.set_title(f'Axis {axis}: friction at equal speed and load, 95 % intervals')
        drags = [health.quantity(DRAG) for health in course]
        if any(drag.is_known for drag in drags):
            _draw(panel, course)
            continue
        panel.set_axis_off()
        place = {'transform': panel.transAxes, 'ha': 'center', 'va': 'center'}
        panel.text(0.5, 0.5, drags[-1].reason, wrap=True, **place)
    return figure


def _draw(panel: Axes, course: Sequence[Health]) -> None:
    """Draw the friction over dates, its baseline, and since when it has changed."""
    last, dates = course[-1], _dates(health.stamp for health in course)
    drags = [health.quantity(DRAG) for health in course]
    values, low, high = (
        100.0 * np.array([getattr(drag, part) for drag in drags])
        for part in ('value', 'low', 'high')
    )
    if last.baseline is not None:
        ends = _dates([last.baseline.begin, last.baseline.end])
        panel.axvspan(*ends, color=SKY, alpha=0.25, lw=0, label='baseline')
    if last.since:
        panel.axvline(_dates([last.since])[0], color=VERMILION, ls='--', label='changed')
    panel.axhline(0.0, color=GREY, lw=1.0)
    band = -100 * TOLERANCE, 100 * TOLERANCE
    panel.axhspan(*band, color=GREY, alpha=0.2, lw=0, label='normal')
    margins = np.stack([values - low, high - values])
    panel.errorbar(dates, values, margins, color=BLUE, fmt='o-', ms=4, capsize=3)
    worse = [health.condition is Condition.WORSE for health in course]
    if np.isfinite(values[worse]).any():
        panel.plot(dates[worse], values[worse], 'D', color=VERMILION, ms=7, label='worse')
    margin = 0.03 * max(float(np.ptp(dates)), 1.0)
    panel.set_xlim(dates.min() - margin, dates.max() + margin)
    locator = AutoDateLocator(maxticks=8)
    panel.xaxis.set_major_locator(locator)
    panel.xaxis.set_major_formatter(ConciseDateFormatter(locator))
    panel.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    panel.set(xlabel='date (UTC)', ylabel='change of the friction [%]')


def _dates(stamps: Iterable[int]) -> NDArray[np.float64]:
    """Return stamps [ns] as dates of a picture."""
    utc = datetime.UTC
    return np.array(
        date2num([datetime.datetime.fromtimestamp(stamp / SECOND, tz=utc) for stamp in stamps])
    )
