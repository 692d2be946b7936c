# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a contact: curves along the track and maps, over the way where roughness rolls."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np
from numpy.typing import NDArray
from surrogate.contact.record import hertz_of
from surrogate.ehl import ContactSolution
from surrogate.ehl.moving import MovingSolution
from surrogate.ehl.results import PUNCTURED
from surrogate.plotting.style import BLUE, draw_picture, GREY, MAP, new_figure, VERMILION
from surrogate.raceway.patch import Raceway
from surrogate.units import GIGA, MICRO, NANO

Array = NDArray[np.float64]

FILM_SPAN = 1.8
"""Top of the film scale of a contact that stands over that percentile [-]."""
INLET = 3.0
"""Most of the inlet that curves show, over the semi-axis [-]."""
VIEW = 1.35
"""Half width of maps over the semi-axes, where the domain reaches so far [-]."""
TOP = 90.0
"""Percentile of the film in the Hertz zone that scales its maps [%]."""


def draw_contact(
    folder: Path, solution: ContactSolution | MovingSolution, surface: Raceway | None = None
) -> Iterator[Path]:
    """Write the pictures of a solution to `folder` as PNG and yield their paths."""
    pictures: dict[str, Callable[[], Figure]] = {}
    if isinstance(solution, MovingSolution):
        if solution.centre_films.size:  # none where all steps failed
            pictures['rolling_contact.png'] = lambda: figure_rolling(solution)
    else:
        pictures['contact_profiles.png'] = lambda: figure_profiles(solution)
        pictures['contact_maps.png'] = lambda: figure_maps(solution)
        if surface is not None:
            pictures['contact_roughness.png'] = lambda: figure_roughness(solution, surface)
    for name, draw in pictures.items():
        yield draw_picture(folder / name, draw)


def _figure(
    width: float, height: float, solution: ContactSolution | MovingSolution, numbers: str
) -> Figure:
    figure = new_figure(width, height)
    condition, lubricant = solution.condition, solution.lubricant
    figure.suptitle(
        f'{condition.load:.4g} N, {condition.entrainment_speed:g} m/s, '
        f'{lubricant.viscosity:g} Pa s; {numbers}'
        + ('' if solution.converged else f'\nNOT CONVERGED: {solution.status.value}'),
        color='black' if solution.converged else VERMILION,
    )
    return figure


def _numbers(solution: ContactSolution) -> str:
    film, rcs = NANO * solution.central_film, 100 * solution.rcs
    return f'central film {film:.3g} nm, RCS {rcs:.2g} %'


def figure_profiles(solution: ContactSolution) -> Figure:
    """
    Return pressure (film, asperities, total, Hertz) and film along x.

    On the centre line and, where asperities carry, on the line that carries most of their load.

    """
    columns = _lines(solution)
    figure = _figure(2.0 + 4.5 * len(columns), 6.5, solution, _numbers(solution))
    panels = figure.subplots(2, len(columns), sharex=True, sharey='row', squeeze=False)
    x, a = MICRO * solution.x, MICRO * solution.semi_axis_x
    there_and_back = (lambda x: np.divide(x, a), lambda s: np.multiply(s, a))
    for (upper, lower), column in zip(panels.T, columns, strict=True):
        y = float(solution.y[column])
        asperity = GIGA * solution.asperity_pressure[:, column]
        upper.plot(x, GIGA * solution.film_pressure[:, column], color=BLUE, lw=1.4, label='film')
        if asperity.any():
            upper.fill_between(x, asperity, color=VERMILION, alpha=0.35, linewidth=0)
            upper.plot(x, asperity, color=VERMILION, linewidth=1.2, label='asperities')
            total = GIGA * solution.pressure[:, column]
            upper.plot(x, total, color='black', linewidth=0.9, linestyle=':', label='total')
        inside = 1 - (solution.x / solution.semi_axis_x) ** 2 - (y / solution.semi_axis_y) ** 2
        hertz = GIGA * (solution.hertz_pressure * np.sqrt(np.maximum(inside, 0.0)))
        upper.plot(
            x, hertz, color=GREY, linestyle='--', linewidth=1.0, label='Hertz, dry and smooth'
        )
        upper.set_title(f'y = {MICRO * y:.0f} µm')
        upper.grid(visible=True)
        _draw_film(lower, solution, column)
        second = upper.secondary_xaxis('top', functions=there_and_back)
        second.set_xlabel('x over the Hertz semi-axis [-]', fontsize=8)
        second.tick_params(labelsize=8)
        lower.set_xlabel('x along the track [µm], the oil enters at the left')
    left = max(solution.x[0], -INLET * solution.semi_axis_x)
    panels[0, 0].set(
        ylabel='pressure [GPa]', ylim=(0, None), xlim=(MICRO * left, MICRO * solution.x[-1])
    )
    panels[1, 0].set(ylabel='film [nm]', ylim=(0, _film_top(solution)))
    panels[0, 0].legend(frameon=False, loc='upper left')
    panels[0, -1].legend(frameon=False, loc='upper left')
    panels[1, 0].legend(frameon=False, loc='center left')
    panels[1, -1].legend(frameon=False, loc='center left')
    return figure


def _lines(solution: ContactSolution) -> list[int]:
    middle = int(np.argmin(np.abs(solution.y)))
    carried = solution.asperity_pressure.sum(axis=0)
    most = int(np.argmax(carried))
    return [middle] if most == middle or carried[most] == 0 else [middle, most]


def _draw_film(axes: Axes, solution: ContactSolution, column: int) -> None:
    x, film = MICRO * solution.x, NANO * solution.film[:, column]
    lowest, floor = NANO * solution.film.min(axis=1), NANO * solution.settings.film_floor
    axes.plot(x, film, color=BLUE, linewidth=1.4, label='film on this line')
    axes.plot(x, lowest, color=GREY, linewidth=0.8, label='least film over y')
    axes.axhline(floor, color=VERMILION, linestyle='--', linewidth=0.9, label='film floor')
    touching = solution.contact_mask[:, column]
    if touching.any():
        mark: dict[str, Any] = {
            'linestyle': 'none',
            'marker': 'v',
            'markersize': 4,
            'color': VERMILION,
        }
        axes.plot(x[touching], film[touching], label='asperity contact', **mark)
    axes.grid(visible=True)


def figure_maps(solution: ContactSolution) -> Figure:
    """Return maps of total pressure and film with the Hertz ellipse and the touching nodes."""
    figure = _figure(8.0, 6.0, solution, _numbers(solution))
    left, right = figure.subplots(1, 2, sharey=True)
    rows, columns = _view(solution)
    pressure = GIGA * solution.pressure[rows, columns]
    film = NANO * solution.film[rows, columns]
    mesh = _mesh(left, solution, pressure, vmin=0)
    figure.colorbar(mesh, ax=left, location='bottom', label='total pressure [GPa]')
    least = 0.8 * film.min() if solution.minimum_film > 2 * solution.settings.film_floor else 0.0
    mesh = _mesh(right, solution, film, vmin=least, vmax=_film_top(solution))
    figure.colorbar(mesh, ax=right, location='bottom', label='film [nm]', extend='max')
    if _mark_contact(right, solution):
        mark = Line2D([], [], linestyle='none', marker='s', color=VERMILION)
        figure.legend(
            handles=[mark], labels=['asperity contact'], loc='outside lower right', frameon=False
        )
    _finish_map(left, solution, 'Pressure')
    _finish_map(right, solution, 'Film')
    return figure


def figure_roughness(solution: ContactSolution, surface: Raceway) -> Figure:
    """Return the rough surface and how film and asperities share the pressure."""
    figure = _figure(11.0, 6.0, solution, _numbers(solution))
    first, second, third = figure.subplots(1, 3, sharey=True)
    rows, columns = _view(solution)
    heights = MICRO * surface.heights(solution.x[rows], solution.y[columns])
    most = float(np.abs(heights).max())
    mesh = _mesh(first, solution, heights, cmap='PuOr_r', vmin=-most, vmax=most)
    figure.colorbar(mesh, ax=first, location='bottom', label='height out of the raceway [µm]')
    top = GIGA * float(solution.film_pressure[rows, columns].max())
    mesh = _mesh(second, solution, GIGA * solution.film_pressure[rows, columns], vmin=0, vmax=top)
    figure.colorbar(mesh, ax=second, location='bottom', label='film pressure [GPa]')
    mesh = _mesh(
        third, solution, GIGA * solution.asperity_pressure[rows, columns], cmap='inferno_r', vmin=0
    )
    figure.colorbar(mesh, ax=third, location='bottom', label='asperity pressure [GPa]')
    kind = f', {surface.patch}, heights times {surface.scale:.3g}' if surface.patch else ''
    _finish_map(first, solution, f'Raceway{kind}')
    _finish_map(second, solution, 'Carried by the film')
    _finish_map(third, solution, f'Carried by asperities: {100 * solution.asperity_share:.2g} %')
    return figure


def _film_top(solution: ContactSolution) -> float:
    """Return the top of the film scale [nm]: what happens inside the Hertz ellipse fills it."""
    film = float(np.percentile(solution.film[solution.distance < 1], TOP))
    return FILM_SPAN * NANO * max(film, solution.settings.film_floor)


def _view(solution: ContactSolution) -> tuple[slice, slice]:
    return (
        _within(solution.x, VIEW * solution.semi_axis_x),
        _within(solution.y, VIEW * solution.semi_axis_y),
    )


def _within(axis: Array, limit: float) -> slice:
    inside = np.flatnonzero(np.abs(axis) <= limit)
    return slice(int(inside[0]), int(inside[-1]) + 1)


def _mesh(axes: Axes, solution: ContactSolution, field: Array, **options: Any) -> QuadMesh:
    rows, columns = _view(solution)
    return axes.pcolormesh(
        MICRO * solution.x[rows],
        MICRO * solution.y[columns],
        field.T,
        **{'cmap': MAP, 'shading': 'nearest', 'rasterized': True, **options},
    )


def _mark_contact(axes: Axes, solution: ContactSolution) -> bool:
    """Colour the nodes where asperities carry; tell whether there are any."""
    rows, columns = _view(solution)
    mask = solution.contact_mask[rows, columns]
    if mask.any():
        _mesh(axes, solution, np.where(mask, 1.0, np.nan), cmap=ListedColormap([VERMILION]))
    return bool(mask.any())


def _finish_map(axes: Axes, solution: ContactSolution, title: str) -> None:
    _draw_zone(axes, solution.semi_axis_x, solution.semi_axis_y)
    axes.set_title(title)
    axes.set_xlabel('x along the track [µm]')
    if axes.get_subplotspec().colspan.start == 0:  # type: ignore[union-attr]
        axes.set_ylabel('y across the track [µm]')


def _draw_zone(axes: Axes, a: float, b: float) -> None:
    """Draw the edge of the Hertz zone [m]: an ellipse, or the two lines of a strip."""
    turn = np.linspace(0, 2 * np.pi, 181)
    edges = (
        [(a * np.cos(turn), b * np.sin(turn))]
        if np.isfinite(b)
        else [(np.full(2, side), np.array(axes.get_ylim()) / MICRO) for side in (-a, a)]
    )
    for along, across in edges:
        x, y = MICRO * along, MICRO * across
        axes.plot(x, y, color='white', linewidth=1.7)
        axes.plot(x, y, color='black', linewidth=0.8, linestyle='--')


def figure_rolling(solution: MovingSolution) -> Figure:
    """Return the film of the last step, RCS along x and the film at the centre on its way."""
    film, rcs = NANO * solution.central_film, solution.rcs
    error = '' if np.isnan(rcs.error) else f' ± {100 * rcs.error:.1g}'
    numbers = (
        f'smooth central film {film:.3g} nm, RCS {100 * rcs.value:.2g}{error} % over '
        f'{solution.transits:.3g} transits'
    )
    figure = _figure(10.5, 6.4, solution, numbers)
    panels = figure.subplot_mosaic([['film', 'rcs'], ['film', 'centre']], width_ratios=(1, 1.35))
    _draw_last_film(panels['film'], solution)
    _draw_rcs(panels['rcs'], solution)
    _draw_centre(panels['centre'], solution)
    figure.legend(loc='outside lower right', ncols=4, frameon=False)
    return figure


def _draw_last_film(axes: Axes, solution: MovingSolution) -> None:
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
    _draw_zone(axes, a, b)
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
