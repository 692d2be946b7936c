# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Captions, axes and lines of all pictures of the comparison with the published study."""

from functools import cache
from pathlib import Path
import textwrap
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from surrogate.formulas.kinematics import entrainment_speed_paper
from surrogate.limits import read_text
from surrogate.parameters import load_screw
from surrogate.plain_yaml import plain_values
from surrogate.plotting.style import new_figure, PURPLE
from surrogate.studies.rows import Curve
from surrogate.units import MILLI, RPM

WIDTH, CAPTION_LETTERS = 7.2, 118
"""Width [inch] and letters in a line of a caption."""
DECLARED = plain_values(read_text(Path(__file__).parents[1] / 'data' / 'study_figures.yaml'))
"""File, height [inch] and caption of each figure by its number."""
STYLES = ('-', '--', '-.', ':', (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)))


def declared_figure(name: str, **numbers: Any) -> Figure:
    """Return an empty figure of the study with its caption below, which tells some numbers."""
    figure = new_figure(WIDTH, DECLARED[name]['height'])
    text = textwrap.fill(DECLARED[name]['caption'].format(**numbers), CAPTION_LETTERS)
    figure.supxlabel(text, x=0.012, ha='left', fontsize=7.5, color='#333333')
    return figure


def shades(count: int) -> list[Any]:
    """Return colours of a series, dark to light, that also keep apart in grey."""
    return [matplotlib.colormaps['viridis'](x) for x in np.linspace(0.0, 0.82, count)]


def entrainment(rpm: Any) -> Any:
    """Return w r_m / 2 [mm/s] for screw speeds [rev/min]."""
    return _one_rpm() * np.asarray(rpm)


@cache
def _one_rpm() -> float:
    return MILLI * float(entrainment_speed_paper(load_screw('nominal'), RPM))


def speed_axis(axes: Axes, *, label: bool = True, top: bool = True) -> None:
    """Make the lower axis the entrainment speed [mm/s], logarithmic, the upper one rev/min."""
    axes.set_xscale('log')
    if label:
        axes.set_xlabel('entrainment speed $\\omega r_m/2$ [mm/s]')
    if top:
        one = float(entrainment(1.0))
        upper = axes.secondary_xaxis(
            'top', functions=(lambda u: np.divide(u, one), lambda n: np.multiply(n, one))
        )
        upper.set_xlabel('screw speed [rev/min]', fontsize=8)
        upper.tick_params(labelsize=8)


def finish(axes: Axes, letter: str = '', title: str = '', legend: Any = 'best') -> None:
    """Add grid, title and legend."""
    axes.grid(visible=True)
    if letter or title:
        axes.set_title(f'({letter}) {title}' if letter else title, loc='left')
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, loc=legend)


def over_speed(
    axes: Axes,
    found: Curve,
    style: str,
    colour: str,
    label: str,
    *,
    factor: float = 1.0,
    floor: float = 0.0,
) -> None:
    """Draw means times a factor over speed, the standard deviation as a band; marker and line."""
    x, mean = entrainment(found.at), np.maximum(factor * found.mean, floor)
    line: dict[str, Any] = {'marker': style[0], 'linestyle': style[1:], 'markersize': 4}
    axes.plot(x, mean, color=colour, label=label, **line)
    if np.isfinite(found.deviation).any():
        low, high = (
            np.maximum(factor * (found.mean + sign * found.deviation), floor) for sign in (-1, 1)
        )
        axes.fill_between(x, low, high, color=colour, alpha=0.15, linewidth=0)


def limit(axes: Axes, value: float, label: str) -> None:
    """Mark a limit or a published number."""
    axes.axhline(value, color=PURPLE, linestyle='--', linewidth=1.0, label=label)
