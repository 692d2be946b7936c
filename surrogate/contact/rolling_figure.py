# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Picture of a contact with rolling roughness: last film, RCS along x, film at the centre."""

from collections.abc import Iterator
from pathlib import Path

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from numpy.typing import NDArray
from surrogate.contact.rolling_record import hertz_of
from surrogate.ehl.moving import MovingSolution
from surrogate.ehl.results import PUNCTURED
from surrogate.plotting.style import BLUE, draw_picture, GREY, MAP, new_figure, VERMILION
from surrogate.units import MICRO, NANO

Array = NDArray[np.float64]

TOP = 90.0
"""Percentile of the film in the Hertz zone that is the top of the film scale [%]."""
VIEW = 1.3
"""Half width of the film map over the semi-axes, where the domain reaches so far [-]."""


def draw_rolling(folder: Path, solution: MovingSolution) -> Iterator[Path]:
    """Write the picture of a march to `folder` as PNG and yield its path; none if all failed."""
    if solution.centre_films.size:
        yield draw_picture(folder / 'rolling_contact.png', lambda: figure_rolling(solution))


def figure_rolling(solution: MovingSolution) -> Figure:
    """Return the film of the last step, RCS along x and the film at the centre on its way."""
    figure = new_figure(10.5, 6.4)
    condition, rcs = solution.condition, solution.rcs
    error = '' if np.isnan(rcs.error) else f' ± {100 * rcs.error:.1g}'
    figure.suptitle(
        f'{condition.load:.3g} N, {condition.entrainment_speed:g} m/s, '
        f'{solution.lubricant.viscosity:g} Pa s; smooth central film '
        f'{NANO * solution.central_film:.3g} nm, RCS {100 * rcs.value:.2g}{error} % over '
        f'{solution.transits:.3g} transits'
        + ('' if solution.converged else f'\nNOT CONVERGED: {solution.status.value}'),
        color='black' if solution.converged else VERMILION,
    )
    panels = figure.subplot_mosaic([['film', 'rcs'], ['film', 'centre']], width_ratios=(1, 1.35))
    _draw_film(panels['film'], solution)
    _draw_rcs(panels['rcs'], solution)
    _draw_centre(panels['centre'], solution)
    figure.legend(loc='outside lower right', ncols=4, frameon=False)
    return figure


def _draw_film(axes: Axes, solution: MovingSolution) -> None:
    a, b, _ = hertz_of(solution)
    rows, columns = _within(solution.x_nodes, VIEW * a), _within(solution.y_nodes, VIEW * b)
    x, y = solution.x_nodes[rows], solution.y_nodes[columns]
    film, floor = solution.film[rows, columns], solution.settings.film_floor
    zone = (x[:, None] / a) ** 2 + (y[None, :] / b) ** 2 < 1
    mesh = axes.pcolormesh(
        MICRO * x,
        MICRO * y,
        NANO * film.T,
        cmap=colormaps[MAP].with_extremes(under=VERMILION),
        vmin=NANO * PUNCTURED * floor,
        vmax=NANO * max(float(np.percentile(film[zone], TOP)), 2 * floor),
        shading='nearest',
        rasterized=True,
    )
    # The edge of the Hertz zone: an ellipse, or two lines of a strip.
    turn = np.linspace(0, 2 * np.pi, 181)
    edges = (
        [(a * np.cos(turn), b * np.sin(turn))]
        if np.isfinite(b)
        else [(np.full(2, side), np.array(axes.get_ylim()) / MICRO) for side in (-a, a)]
    )
    for along, across in edges:
        axes.plot(MICRO * along, MICRO * across, color='white', linewidth=1.8)
        axes.plot(MICRO * along, MICRO * across, color='black', linewidth=0.9, linestyle='--')
    label = 'film [nm], punctured where it is at the floor'
    axes.figure.colorbar(mesh, ax=axes, location='right', label=label, extend='both')
    axes.set_title('(a) Film of the last step, the Hertz zone dashed')
    axes.set(xlabel='x along the track [µm]', ylabel='y across the track [µm]')


def _draw_rcs(axes: Axes, solution: MovingSolution) -> None:
    axes.fill_between(
        solution.x, 100 * solution.rcs_along, color=VERMILION, alpha=0.35, linewidth=0
    )
    axes.plot(solution.x, 100 * solution.rcs_along, color=VERMILION, linewidth=1.2)
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color=GREY, linestyle='--', linewidth=0.9)
    axes.set_title('(b) Where asperities puncture the film, mean over time')
    axes.set(
        xlabel='x over the semi-axis [-], the oil enters at the left',
        ylabel='RCS per semi-axis [%]',
        ylim=(0, None),
    )
    axes.grid(visible=True)


def _draw_centre(axes: Axes, solution: MovingSolution) -> None:
    films = NANO * solution.centre_films
    way = solution.transits * (np.arange(films.size) + 1) / films.size
    axes.plot(way, films, color=BLUE, linewidth=1.0, label='film at the centre')
    smooth, floor = NANO * solution.central_film, NANO * solution.settings.film_floor
    axes.axhline(
        smooth, color=GREY, linestyle='--', linewidth=0.9, label=f'smooth {smooth:.3g} nm'
    )
    axes.axhline(
        floor, color=VERMILION, linestyle=':', linewidth=1.2, label=f'floor {floor:.3g} nm'
    )
    places = solution.settings.places
    for place in range(1, places):
        label = 'next place' if place == 1 else None
        axes.axvline(solution.transits * place / places, color='black', linewidth=0.6, label=label)
    axes.set_title('(c) Film at the centre, place after place')
    axes.set(
        xlabel='way of the raceway [transits of 2 semi-axes]',
        ylabel='film [nm]',
        ylim=(0, None),
        xlim=(0, solution.transits),
    )
    axes.grid(visible=True)


def _within(axis: Array, limit: float) -> slice:
    inside = np.flatnonzero(np.abs(axis) <= limit)
    return slice(int(inside[0]), int(inside[-1]) + 1)
