# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Friction of each axis over dates, with its interval."""

from collections.abc import Mapping, Sequence
import datetime
from pathlib import Path

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.records import Condition, Health, TOLERANCE
from matplotlib.axes import Axes
from matplotlib.dates import AutoDateLocator, ConciseDateFormatter, date2num
from matplotlib.figure import Figure
import numpy as np
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, SKY, VERMILION

SHOWN = {DRAG: ('change of the friction [%]', 0.0, 'friction at equal speed and load')}
WIDTH, HEIGHT = 8.0, 3.0  # [inch] of one quantity of one axis
MOST_DRAWN = 40
"""Axes in one picture, which may be 65536 pixels high."""


def draw_health(found: Mapping[str, Sequence[Health]], path: Path) -> None:
    """Write the picture of the courses of axes to `path` (PNG)."""
    draw_picture(path, lambda: figure_health(found))


def figure_health(found: Mapping[str, Sequence[Health]]) -> Figure:
    """Return a panel for each axis and quantity."""
    figure = new_figure(WIDTH, HEIGHT * len(SHOWN) * len(found))
    panels = figure.subplots(len(SHOWN) * len(found), 1, squeeze=False)[:, 0]
    wanted = [(axis, name) for axis in found for name in SHOWN]
    for panel, (axis, name) in zip(panels, wanted, strict=True):
        _draw(panel, axis, name, found[axis])
    return figure


def _draw(panel: Axes, axis: str, name: str, courses: Sequence[Health]) -> None:
    label, normal, title = SHOWN[name]
    told = [(one, one.quantity(name)) for one in courses]
    panel.set_title(f'Axis {axis}: {title}, 95 % intervals')
    if not any(quantity.is_known for _, quantity in told):
        panel.set_axis_off()
        reason = told[-1][1].reason
        panel.text(
            0.5, 0.5, reason, transform=panel.transAxes, ha='center', va='center', wrap=True
        )
        return
    dates = date2num([_date(one.stamp) for one, _ in told])
    values, low, high = (
        100.0 * np.array([getattr(quantity, part) for _, quantity in told])
        for part in ('value', 'low', 'high')
    )
    _shade(panel, courses[-1])
    panel.axhline(normal, color=GREY, lw=1.0)
    if name == DRAG:
        band = -100 * TOLERANCE, 100 * TOLERANCE
        panel.axhspan(*band, color=GREY, alpha=0.2, lw=0, label='normal')
    panel.errorbar(
        dates,
        values,
        np.stack([values - low, high - values]),
        color=BLUE,
        fmt='o-',
        ms=4,
        capsize=3,
    )
    worse = [one.condition is Condition.WORSE for one, _ in told]
    if np.isfinite(values[worse]).any():
        panel.plot(dates[worse], values[worse], 'D', color=VERMILION, ms=7, label='worse')
    margin = 0.03 * max(float(np.ptp(dates)), 1.0)
    panel.set_xlim(dates.min() - margin, dates.max() + margin)
    locator = AutoDateLocator(maxticks=8)
    panel.xaxis.set_major_locator(locator)
    panel.xaxis.set_major_formatter(ConciseDateFormatter(locator))
    panel.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    panel.set(xlabel='date (UTC)', ylabel=label)


def _shade(panel: Axes, health: Health) -> None:
    """Shade the baseline of an axis, and mark since when it has changed."""
    if health.baseline is not None:
        ends = date2num([_date(health.baseline.begin), _date(health.baseline.end)])
        panel.axvspan(*ends, color=SKY, alpha=0.25, lw=0, label='baseline')
    if health.since:
        since = date2num(_date(health.since))
        panel.axvline(since, color=VERMILION, ls='--', label='changed')


def _date(stamp: int) -> datetime.datetime:
    return datetime.datetime.fromtimestamp(stamp / SECOND, tz=datetime.UTC)
