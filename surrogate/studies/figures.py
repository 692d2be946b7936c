# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""All pictures beside the study and their files; of single contacts here (4, 7 to 10)."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
import numpy as np
from surrogate.parameters import load_screw
from surrogate.plotting.style import BLUE, draw_picture, GREY, VERMILION
from surrogate.raceway.short_waves import without_short_waves
from surrogate.screw.opened import Contacts
from surrogate.studies import screw_figures as screws
from surrogate.studies.curves import Array, curve, StudyRow
from surrogate.studies.screw_figures import DECLARED, declared_figure, finish, shades, STYLES
from surrogate.studies.solve import published_patch, SHORTEST_ON_GRID, Study
from surrogate.studies.tasks import LOADS, MARK_RPM, OURS, RELIEVED, REPORTED_FILM, SCREW, solves
from surrogate.units import GIGA, MICRO, NANO

SHOWN_LOADS = tuple(LOADS[i] for i in (0, 2, 4, 5))
"""Axial loads whose smooth profiles are drawn [N]."""
VIEW = 1.3
"""Half width of maps over the semi-axes [-]."""
WIDE = 0.5e-3
"""Half side of the piece of raceway that is shown [m]."""
REPORTED = f'reported {REPORTED_FILM:.0f} nm'
Drawn = tuple[StudyRow, SimpleNamespace]
"""A row and its fields: places x, y and semi-axes a, b [um], pressures [GPa], film [nm]."""


def draw_figures(
    study: Study, figures: Iterable[str], folder: Path, measured: screws.Measured | None = None
) -> Iterator[Path]:
    """Draw some figures of a study into a folder; yield the paths."""
    draw = pictures(study, measured)
    for figure in figures:
        yield draw_picture(folder / f'{DECLARED[figure]["file"]}.png', draw[figure])


def pictures(
    study: Study, measured: screws.Measured | None = None
) -> dict[str, Callable[[], Figure]]:
    """Return what draws each figure of the study."""
    screw, rows = load_screw(SCREW), list(study.rows.values())
    opened = Contacts.of(screw)
    return {
        '4': lambda: figure_fractal(study, opened),
        '6b': lambda: screws.figure_torque(rows, measured),
        '7': lambda: figure_smooth_speed(study),
        '8': lambda: figure_smooth_load(study),
        '9': lambda: figure_rough(study, '9'),
        '10': lambda: figure_rough(study, '10'),
        '11': lambda: screws.figure_stribeck(opened.law, rows),
        '12': lambda: screws.figure_maps(screw, rows),
        '13': lambda: screws.figure_zone(screw, opened.law, rows),
        'trends': lambda: screws.figure_trends(screw, rows),
    }


def drawn(study: Study, figure: str) -> list[Drawn]:
    """Return the converged contacts that a figure shows, in the units of pictures."""
    keys = [task.key for task in solves(1)[figure] if task.fields]
    solved = [key for key in keys if study.rows[key].status == 'CONVERGED']
    return [(study.rows[key], _scaled(study.fields[key])) for key in solved]


def _scaled(fields: dict[str, Any]) -> SimpleNamespace:
    arrays = {name: np.array(values) for name, values in fields.items()}
    x, y, a, b = (MICRO * arrays[name] for name in ('x', 'y', 'semi_axis_x', 'semi_axis_y'))
    oil, asperities = (GIGA * arrays[f'{name}_pressure'] for name in ('film', 'asperity'))
    hertz = GIGA * arrays['hertz_pressure'] * np.sqrt(np.maximum(1 - (x / a) ** 2, 0))
    heights, film = MICRO * arrays['heights'], NANO * arrays['film']
    middle = int(np.argmin(np.abs(y)))
    oil_line, asperity_line, film = (field[:, middle] for field in (oil, asperities, film))
    ends = {'x': x, 'y': y, 'a': a, 'b': b, 'hertz': hertz, 'heights': heights}
    lines = {'oil_line': oil_line, 'asperity_line': asperity_line, 'film': film}
    return SimpleNamespace(oil=oil, asperities=asperities, **ends, **lines)


def figure_fractal(study: Study, opened: Contacts) -> Figure:
    """Return surface, film and asperity pressure of a mixed contact, and a cut along it (4)."""
    row, contact = drawn(study, '4')[0]
    figure = declared_figure('4', row=row)
    upper, lower = np.asarray(figure.subfigures(2, 1, height_ratios=(1.65, 1)))
    panels = upper.subplots(1, 4, width_ratios=(2.1, 1, 1, 1))
    raceway = without_short_waves(published_patch(opened, row.draw), SHORTEST_ON_GRID)
    place = np.linspace(-WIDE, WIDE, 401)
    heights, side = MICRO * raceway.heights(place, place), MICRO * place
    label = 'height of the raceway [µm]'
    _draw_map(panels[0], contact, (side, side, heights), {'cmap': 'PuOr_r'}, label)
    panels[0].set(xlabel='x [µm]', ylabel='y [µm]', aspect='equal')
    panels[0].set_title('(a) 1 mm x 1 mm of one draw', loc='left')
    for axes, letter, label, values, style in (
        (panels[1], 'b', 'height [µm]', contact.heights, {'cmap': 'PuOr_r'}),
        (panels[2], 'c', 'film [GPa]', contact.oil, {'cmap': 'Blues', 'vmin': 0}),
        (panels[3], 'd', 'asperities [GPa]', contact.asperities, {'cmap': 'Reds', 'vmin': 0}),
    ):
        bar = _draw_map(axes, contact, (contact.x, contact.y, values), style, '')
        bar.set_label(label, fontsize=8)
        spans = {'xlim': VIEW * contact.a, 'ylim': VIEW * contact.b}
        axes.set(xlabel='x [µm]', **{name: (-end, end) for name, end in spans.items()})
        axes.set_title(f'({letter})', loc='left')
    panels[1].set_ylabel('y across the track [µm]')
    axes = lower.subplots()
    _draw_split(axes, contact)
    axes.set(xlabel='x along the track [µm], oil enters at the left', ylabel='pressure [GPa]')
    finish(axes, 'e', 'who carries on the centre line')
    return figure


def _draw_map(
    axes: Any, contact: SimpleNamespace, field: tuple[Array, Array, Array], style: Any, label: str
) -> Any:
    x, y, values = field
    mesh = axes.pcolormesh(x, y, values.T, shading='nearest', rasterized=True, **style)
    bar = axes.get_figure().colorbar(mesh, ax=axes, location='bottom', label=label)
    bar.ax.tick_params(labelsize=7)
    ellipse: dict[str, Any] = {'fill': False, 'linestyle': '--', 'linewidth': 0.9}
    axes.add_patch(Ellipse((0, 0), 2 * contact.a, 2 * contact.b, **ellipse))
    return bar


def _draw_split(axes: Axes, contact: SimpleNamespace) -> None:
    axes.plot(contact.x, contact.oil_line, color=BLUE, linewidth=1.2, label='film')
    if contact.asperity_line.any():
        axes.fill_between(
            contact.x, contact.asperity_line, color=VERMILION, alpha=0.35, linewidth=0
        )
        line: dict[str, Any] = {'color': VERMILION, 'linewidth': 1.0}
        axes.plot(contact.x, contact.asperity_line, label='asperities', **line)
    axes.plot(contact.x, contact.hertz, color=GREY, linestyle='--', linewidth=1.0, label='Hertz')
    axes.set(ylim=(0, None), xlim=(-1.9 * contact.a, 1.4 * contact.a))


def figure_smooth_speed(study: Study) -> Figure:
    """Return pressure and film of the smooth contact at several speeds (7)."""
    figure = declared_figure('7')
    series = drawn(study, '7')
    labels = [f'{1e3 * row.entrainment_speed:.1f} mm/s, {row.rpm:g} rev/min' for row, _ in series]
    _, right = _draw_series(figure, series, labels, 2)
    right.plot(0, REPORTED_FILM, marker='D', color='black', markersize=5, linestyle='none')
    arrow = {'arrowstyle': '->', 'linewidth': 0.7}
    right.annotate(REPORTED, (0, REPORTED_FILM), (-22, 102), fontsize=8, arrowprops=arrow)
    right.set_ylim(0, 420)
    return figure


def figure_smooth_load(study: Study) -> Figure:
    """Return pressure and film of the smooth contact at several loads (8)."""
    figure = declared_figure('8')
    series = [(row, contact) for row, contact in drawn(study, '8') if row.load in SHOWN_LOADS]
    labels = [f'{row.load:g} N ({row.normal_force:.0f} N per ball)' for row, _ in series]
    *_, right = _draw_series(figure, series, labels, 3)
    wanted: dict[str, Any] = {'kind': 'contact', 'rpm': MARK_RPM, 'rough': False}
    for case, style, name in ((OURS, 'o-', 'loaded nut'), (RELIEVED, 's--', 'relieved nut')):
        film = curve(study.rows.values(), 'load', 'central_film', case=case, **wanted)
        right.plot(film.at, NANO * film.mean, style, markersize=4, label=name)
    right.plot(0, REPORTED_FILM, 'D', color='black', label=REPORTED)
    right.set(xlabel='axial load [N]', ylabel='central film [nm]', ylim=(120, 190))
    finish(right, 'c')
    return figure


def _draw_series(
    figure: Figure, series: Sequence[Drawn], labels: Sequence[str], columns: int
) -> list[Axes]:
    panels = list(figure.subplots(1, columns))
    colours = shades(len(series))
    for (_, contact), label, colour, style in zip(series, labels, colours, STYLES, strict=False):
        line = {'color': colour, 'linestyle': style, 'linewidth': 1.3}
        panels[0].plot(contact.x, contact.oil_line, label=label, **line)
        panels[1].plot(contact.x, contact.film, label=label, **line)
    last = series[-1][1]
    if len({row.normal_force for row, _ in series}) == 1:
        hertz = {'color': GREY, 'linestyle': (0, (1, 1)), 'linewidth': 1.0, 'label': 'Hertz'}
        panels[0].plot(last.x, last.hertz, **hertz)
    films = [float(contact.film[np.argmin(np.abs(contact.x))]) for _, contact in series]
    panels[0].set(ylabel='pressure [GPa]', ylim=(0, None))
    panels[1].set(ylabel='film [nm]', ylim=(0, 2.2 * max(films)))
    for axes, letter in zip(panels[:2], 'ab', strict=True):
        axes.set(xlim=(-1.9 * last.a, 1.4 * last.a), xlabel='x along the track [µm]')
        finish(axes, letter, legend='upper left' if letter == 'a' else None)
    panels[0].set_ylim(0, 1.75 * float(panels[0].dataLim.y1))
    return panels


def figure_rough(study: Study, name: str) -> Figure:
    """Return pressure and film of the rough contact at several speeds (9) or loads (10)."""
    series = drawn(study, name)
    figure = declared_figure(name, draw=series[0][0].draw)
    panels = figure.subplots(2, len(series), sharex='col', squeeze=False)
    top = 1.1 * max(float((contact.oil + contact.asperities).max()) for _, contact in series)
    for column, (row, contact) in enumerate(series):
        upper, lower = panels[:, column]
        _draw_split(upper, contact)
        upper.set_ylim(0, top)
        title = (
            f'{row.rpm:g} rev/min, {row.load:g} N on the screw\n'
            f'{row.normal_force:.0f} N per ball, RCS {row.rcs:.2g}'
        )
        finish(upper, title=title, legend='upper left' if column == 0 else None)
        lower.plot(contact.x, contact.film, color=BLUE, linewidth=1.2)
        if row.rcs:
            floor = {'color': VERMILION, 'linestyle': ':', 'linewidth': 1.2}
            lower.axhline(NANO * row.minimum_film, **floor)
        inside = np.abs(contact.x) < contact.a
        lower.set(xlabel='x [µm]', ylim=(0, 2.0 * np.percentile(contact.film[inside], 90)))
        finish(lower)
    panels[0, 0].set_ylabel('pressure [GPa]')
    panels[1, 0].set_ylabel('film [nm]')
    return figure
