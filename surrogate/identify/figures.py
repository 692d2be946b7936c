# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Picture of an identification: measured and modelled torque over speed, and the residual."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter
import numpy as np
from surrogate.identify.data import Array, NoLoadRun
from surrogate.identify.fit import Identification
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, ORANGE, VERMILION
from surrogate.units import MILLI, RPM

DIRECTIONS = ((1.0, 'o', 'positive'), (-1.0, 's', 'negative'))
LOG_SPAN = 20.0
"""Largest speed over smallest from which on the speed axis is logarithmic [-]."""
HEADROOM = 1.35
"""Top of the residual axis over what the points need [-]: the legend lies above them."""


def draw_identification(
    folder: Path,
    run: NoLoadRun,
    fit: Identification,
    title: str,
    onset: Mapping[str, Any] | None = None,
) -> Path:
    """Write `identify.png` to a folder and return its path."""
    return draw_picture(
        folder / 'identify.png', lambda: figure_identification(run, fit, title, onset)
    )


def figure_identification(
    run: NoLoadRun, fit: Identification, title: str, onset: Mapping[str, Any] | None = None
) -> Figure:
    """Return torque over speed above with the onset of the record, the residual below."""
    figure = new_figure(7.0, 6.2)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.6, 1.0])
    if onset is not None:
        speed, low, high = (onset[f'speed{end}_rad_s'] / RPM for end in ('', '_low', '_high'))
        label = 'onset taken, not fitted' if onset['reason'] else 'onset, extrapolated'
        if not onset['reason']:
            upper.axvspan(low, high, color=ORANGE, alpha=0.2, linewidth=0)
        upper.axvline(speed, color=ORANGE, linestyle='--', label=label)
    _draw_torque(upper, run, fit)
    order = np.argsort(np.abs(run.speed))
    rpm, band = np.abs(run.speed)[order] / RPM, MILLI * fit.band[order]
    lower.fill_between(
        rpm, -band, band, color=BLUE, alpha=0.15, linewidth=0, label='95 % of the points'
    )
    lower.axhline(0, color=BLUE, linewidth=1.0)
    _draw_points(lower, run, run.torque - fit.after, '')
    lower.set_ylim(top=HEADROOM * lower.get_ylim()[1])
    lower.set_ylabel('measured - model [mN m]')
    lower.set_xlabel('screw speed [rev/min]')
    lower.legend(frameon=False, loc='upper right')
    upper.set_title(title)
    if rpm[-1] > LOG_SPAN * rpm[0]:
        lower.set_xscale('log')
        lower.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        lower.xaxis.set_major_formatter('{x:g}')
        lower.xaxis.set_minor_formatter(NullFormatter())
    for axes in (upper, lower):
        axes.grid(visible=True)
    return figure


def _draw_torque(axes: Axes, run: NoLoadRun, fit: Identification) -> None:
    """Draw torques in the direction of the motion, so that both directions share an axis."""
    order = np.argsort(np.abs(run.speed))
    rpm = np.abs(run.speed)[order] / RPM
    axes.fill_between(
        rpm, MILLI * fit.contacts[order], color=VERMILION, alpha=0.2, lw=0, label='contacts'
    )
    for sign, _, name in _directions(run):
        chosen = order[run.direction[order] == sign]
        axes.plot(
            np.abs(run.speed[chosen]) / RPM,
            MILLI * sign * fit.before[chosen],
            color=GREY,
            linewidth=1.2,
            linestyle='-.' if sign > 0 else ':',
            label=f'model, datasheet{name}',
        )
        axes.plot(
            np.abs(run.speed[chosen]) / RPM,
            MILLI * sign * fit.after[chosen],
            color=BLUE,
            linewidth=1.3,
            linestyle='-' if sign > 0 else (0, (5, 1.5)),
            label=f'model, identified{name}',
        )
    _draw_points(axes, run, run.torque, 'measured')
    axes.set_ylim(0 if (run.direction * run.torque > 0).all() else None)
    axes.set_ylabel('torque along the motion [mN m]')
    axes.legend(frameon=False)


def _draw_points(axes: Axes, run: NoLoadRun, torque: Array, label: str) -> None:
    """Draw points in the direction of the motion, one standard deviation up and down."""
    for sign, marker, name in _directions(run):
        chosen = run.direction == sign
        axes.errorbar(
            np.abs(run.speed[chosen]) / RPM,
            MILLI * sign * torque[chosen],
            yerr=None if run.torque_std is None else MILLI * run.torque_std[chosen],
            fmt=marker,
            markersize=4,
            color='black',
            markerfacecolor='white' if sign < 0 else 'black',
            elinewidth=0.8,
            capsize=2,
            label=f'{label}{name}' if label else '',
        )


def _directions(run: NoLoadRun) -> list[tuple[float, str, str]]:
    """Return sign, marker and label of the directions that were measured."""
    both = run.both_directions
    return [
        (sign, marker, f', {name} direction' if both else '')
        for sign, marker, name in DIRECTIONS
        if (run.direction == sign).any()
    ]
