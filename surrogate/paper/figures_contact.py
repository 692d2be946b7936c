# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of single contacts beside the published study: surface, pressure and film (4, 7-10)."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
import numpy as np
from surrogate.paper.cases import MARK_RPM, RELIEVED
from surrogate.paper.curves import curve
from surrogate.paper.figures import captioned_figure, finish, shades, STYLES
from surrogate.paper.marks import REPORTED_FILM
from surrogate.paper.rows import Array, ContactFields, StudyRow
from surrogate.plotting.style import BLUE, GREY, VERMILION
from surrogate.raceway.fractal import FractalSurface
from surrogate.units import GIGA, MICRO, NANO

Drawn = tuple[StudyRow, ContactFields]
VIEW = 1.3
"""Half width of maps over the semi-axes [-]."""
WIDE = 0.5e-3
"""Half side of the piece of raceway that is shown [m]."""


def figure_fractal(drawn: Drawn, raceway: FractalSurface) -> Figure:
    """Return surface, film and asperity pressure of a mixed contact, and a cut along it (4)."""
    row, found = drawn
    figure = captioned_figure(
        6.6,
        f'Draw {row.draw} of the raceway, D 2.68, G 0.97 nm, Rq 0.12 µm over the Hertz rectangle '
        'at unloading, waves down to 20.6 µm, standing still; contact at the screw (dashed) at '
        f'{row.rpm:g} rev/min, preload only ({row.normal_force:.1f} N), ISO VG 68 at 40 °C. RCS '
        f'{row.rcs:.2f}: the share of the load on punctured nodes; asperities carry '
        f'{row.asperity_share:.2f}. The cut is the centre line.',
    )
    upper, lower = np.asarray(figure.subfigures(2, 1, height_ratios=(1.65, 1)))
    panels = upper.subplots(1, 4, width_ratios=(2.1, 1, 1, 1))
    _draw_raceway(panels[0], found, raceway)
    x, y = MICRO * found.x, MICRO * found.y
    maps: Sequence[tuple[str, Array, dict[str, Any]]] = (
        ('height [µm]', MICRO * found.heights, {'cmap': 'PuOr_r'}),
        ('film [GPa]', GIGA * found.film_pressure, {'cmap': 'Blues', 'vmin': 0}),
        ('asperities [GPa]', GIGA * found.asperity_pressure, {'cmap': 'Reds', 'vmin': 0}),
    )
    for axes, letter, (label, values, style) in zip(panels[1:], 'bcd', maps, strict=True):
        mesh = axes.pcolormesh(x, y, values.T, shading='nearest', rasterized=True, **style)
        bar = upper.colorbar(mesh, ax=axes, location='bottom')
        bar.set_label(label, fontsize=8)
        bar.ax.tick_params(labelsize=7)
        _outline(axes, found)
        a, b = MICRO * found.semi_axis_x, MICRO * found.semi_axis_y
        axes.set(xlim=(-VIEW * a, VIEW * a), ylim=(-VIEW * b, VIEW * b), xlabel='x [µm]')
        axes.set_title(f'({letter})', loc='left')
    panels[1].set_ylabel('y across the track [µm]')
    axes = lower.subplots()
    _draw_split(axes, found)
    axes.set(xlabel='x along the track [µm], oil enters at the left', ylabel='pressure [GPa]')
    finish(axes, 'e', 'who carries on the centre line')
    return figure


def _draw_raceway(axes: Axes, found: ContactFields, raceway: FractalSurface) -> None:
    place = np.linspace(-WIDE, WIDE, 401)
    heights = MICRO * raceway.heights(place, place)
    mesh = axes.pcolormesh(
        MICRO * place, MICRO * place, heights.T, cmap='PuOr_r', shading='nearest', rasterized=True
    )
    bar = axes.get_figure().colorbar(  # type: ignore[union-attr]
        mesh, ax=axes, location='bottom', label='height of the raceway [µm]'
    )
    bar.ax.tick_params(labelsize=7)
    _outline(axes, found)
    axes.set(xlabel='x [µm]', ylabel='y [µm]', aspect='equal')
    axes.set_title('(a) 1 mm x 1 mm of one draw', loc='left')


def _outline(axes: Axes, found: ContactFields) -> None:
    size = 2 * MICRO * found.semi_axis_x, 2 * MICRO * found.semi_axis_y
    axes.add_patch(Ellipse((0, 0), *size, fill=False, linestyle='--', linewidth=0.9))


def _draw_split(axes: Axes, found: ContactFields) -> None:
    """Draw film and asperity pressure and Hertz's on the centre line."""
    middle = _middle(found)
    x, asperity = MICRO * found.x, GIGA * found.asperity_pressure[:, middle]
    axes.plot(x, GIGA * found.film_pressure[:, middle], color=BLUE, linewidth=1.2, label='film')
    if asperity.any():
        axes.fill_between(x, asperity, color=VERMILION, alpha=0.35, linewidth=0)
        axes.plot(x, asperity, color=VERMILION, linewidth=1.0, label='asperities')
    axes.plot(x, _hertz(found), color=GREY, linestyle='--', linewidth=1.0, label='Hertz')
    axes.set(ylim=(0, None), xlim=_span(found))


def _hertz(found: ContactFields) -> Array:
    inside = np.maximum(1 - (found.x / found.semi_axis_x) ** 2, 0)
    return np.asarray(GIGA * found.hertz_pressure * np.sqrt(inside))


def _span(found: ContactFields) -> tuple[float, float]:
    return -1.9 * MICRO * found.semi_axis_x, 1.4 * MICRO * found.semi_axis_x


def figure_smooth_speed(drawn: Sequence[Drawn]) -> Figure:
    """Return pressure and film of the smooth contact at several speeds (7)."""
    figure = captioned_figure(
        3.9,
        'Smooth contact of ball and screw, preload only (27.6 N), ISO VG 68 at 40 °C, centre '
        'line. The mark is the published central film at 502.65 mm/s, which is of a rough '
        'surface.',
    )
    labels = [f'{1e3 * row.entrainment_speed:.1f} mm/s, {row.rpm:g} rev/min' for row, _ in drawn]
    left, right = _draw_series(figure, drawn, labels, 2)
    right.plot(0, REPORTED_FILM, marker='D', color='black', markersize=5, linestyle='none')
    right.annotate(
        f'reported {REPORTED_FILM:.0f} nm',
        (0, REPORTED_FILM),
        (-22, 102),
        fontsize=8,
        arrowprops={'arrowstyle': '->', 'linewidth': 0.7},
    )
    right.set_ylim(0, 420)
    return figure


def figure_smooth_load(drawn: Sequence[Drawn], rows: Sequence[StudyRow]) -> Figure:
    """Return pressure and film of the smooth contact at several loads (8)."""
    figure = captioned_figure(
        3.9,
        'Smooth contact of ball and screw of the loaded nut at 502.65 mm/s, ISO VG 68 at 40 °C, '
        'centre line, for axial loads on the screw; (c) central film of both nuts. The published '
        'film rises with load; ours falls weakly in the loaded nut and rises in the relieved one.',
    )
    labels = [f'{row.load:g} N ({row.normal_force:.0f} N per ball)' for row, _ in drawn]
    *_, right = _draw_series(figure, drawn, labels, 3)
    for case, style, name in (('ours', 'o-', 'loaded nut'), (RELIEVED, 's--', 'relieved nut')):
        film = curve(
            rows, 'load', 'central_film', kind='contact', rpm=MARK_RPM, rough=False, case=case
        )
        right.plot(film.at, NANO * film.mean, style, markersize=4, label=name)
    right.plot(0, REPORTED_FILM, 'D', color='black', label=f'reported {REPORTED_FILM:.0f} nm')
    right.set(xlabel='axial load [N]', ylabel='central film [nm]', ylim=(120, 190))
    finish(right, 'c')
    return figure


def _draw_series(
    figure: Figure, drawn: Sequence[Drawn], labels: Sequence[str], columns: int
) -> list[Axes]:
    """Draw pressure and film of a series on the centre line into the first panels."""
    panels = list(figure.subplots(1, columns))
    for (_, found), label, colour, style in zip(
        drawn, labels, shades(len(drawn)), STYLES, strict=False
    ):
        x, line = MICRO * found.x, {'color': colour, 'linestyle': style, 'linewidth': 1.3}
        panels[0].plot(x, GIGA * found.film_pressure[:, _middle(found)], label=label, **line)
        panels[1].plot(x, NANO * found.film[:, _middle(found)], label=label, **line)
    last = drawn[-1][1]
    if len({found.hertz_pressure for _, found in drawn}) == 1:
        hertz = {'color': GREY, 'linestyle': (0, (1, 1)), 'linewidth': 1.0, 'label': 'Hertz'}
        panels[0].plot(MICRO * last.x, _hertz(last), **hertz)
    films = [found.film[np.argmin(np.abs(found.x)), _middle(found)] for _, found in drawn]
    top = 2.2 * NANO * float(max(films))
    panels[0].set(ylabel='pressure [GPa]', ylim=(0, None))
    panels[1].set(ylabel='film [nm]', ylim=(0, top))
    for axes, letter in zip(panels[:2], 'ab', strict=True):
        axes.set(xlim=_span(last), xlabel='x along the track [µm]')
        finish(axes, letter, legend='upper left' if letter == 'a' else None)
    panels[0].set_ylim(0, 1.75 * float(panels[0].dataLim.y1))
    return panels


def _middle(found: ContactFields) -> int:
    """Return the column of the centre line."""
    return int(np.argmin(np.abs(found.y)))


def figure_rough(drawn: Sequence[Drawn]) -> Figure:
    """Return pressure and film of the rough contact at several speeds (9) or loads (10)."""
    caption = (
        f'Rough contact of ball and screw in the loaded nut, draw {drawn[0][0].draw}, standing '
        'still, ISO VG 68 at 40 °C, centre line. Dotted: the film floor; a node there counts as '
        'punctured.'
    )
    figure = captioned_figure(4.9, caption)
    panels = figure.subplots(2, len(drawn), sharex='col', squeeze=False)
    top = 1.1 * GIGA * max(float(_total(found).max()) for _, found in drawn)
    for column, (row, found) in enumerate(drawn):
        title = (
            f'{row.rpm:g} rev/min, {row.load:g} N on the screw\n'
            f'{row.normal_force:.0f} N per ball, RCS {row.rcs:.2g}'
        )
        upper, lower = panels[:, column]
        _draw_split(upper, found)
        upper.set_ylim(0, top)
        finish(upper, title=title, legend='upper left' if column == 0 else None)
        film = NANO * found.film[:, _middle(found)]
        inside = np.abs(found.x) < found.semi_axis_x
        lower.plot(MICRO * found.x, film, color=BLUE, linewidth=1.2)
        if row.rcs:
            floor = {'color': VERMILION, 'linestyle': ':', 'linewidth': 1.2}
            lower.axhline(NANO * row.minimum_film, **floor)
        lower.set(xlabel='x [µm]', ylim=(0, 2.0 * np.percentile(film[inside], 90)))
        finish(lower)
    panels[0, 0].set_ylabel('pressure [GPa]')
    panels[1, 0].set_ylabel('film [nm]')
    return figure


def _total(found: ContactFields) -> Array:
    return found.film_pressure + found.asperity_pressure
