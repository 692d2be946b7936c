# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of a screw: of a solved point, of the onset of contact, of the sensitivity of a point.

A point shows pressure, film and slip of all contacts that carry load, the onset lines of speed,
new and run in at three temperatures, and the sensitivity what each input changes (a tornado).

"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
import math
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactSolution, punctured_nodes
from surrogate.formulas.geometry import SIDES
from surrogate.parameters import Lubricant, Screw
from surrogate.plotting.style import (
    BLUE,
    draw_picture,
    GREEN,
    GREY,
    MAP,
    new_figure,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    YELLOW,
)
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.screw.sensitivity import BANDS, EFFICIENCY_SPEED, ONSET, shown, TORQUE
from surrogate.screw.solve import ScrewSolution
from surrogate.units import GIGA, MICRO, MILLI, NANO, RPM, ZERO_CELSIUS

Array = NDArray[np.float64]

VIEW = 1.2
"""Half width of the maps over the semi-axes [-]."""
ARROWS = (5, 9)
"""Arrows of slip along and across a contact."""
FILM_SPAN = 30.0
"""Top of the film scale over its bottom [-]."""
AROUND = -15.0, 0.0, 15.0
"""Temperatures of the lines of speed about the one that is asked for [K]."""
STATES = {'new': 'new', 'run_in': 'run in'}
ZONES = ((VERMILION, '//', 'in contact'), (YELLOW, '', 'perhaps'), (GREEN, '', 'free of contact'))
"""Colour, hatch for a print in grey, and word of the parts of a line of speed."""
LABEL = {'boxstyle': 'round,pad=0.15', 'fc': 'w', 'ec': 'none'}
PANELS = {
    ONSET: ('Contact begins', 'speed [rev/min]', RPM),
    TORQUE: ('Friction torque', 'torque [N m]', 1.0),
    EFFICIENCY_SPEED: ('Efficiency falls to 0.85', 'speed [rev/min]', RPM),
}
"""Title, label and unit [SI] of the quantities that are drawn."""
BAND_COLOURS = GREY, SKY, PURPLE
"""Of the bands of the onset."""
COLOURS = {'low': BLUE, 'high': ORANGE}
"""Colours of the ends of an input."""


def draw_point(
    folder: Path, screw: Screw, solution: ScrewSolution, record: dict[str, Any]
) -> Path:
    """Write the picture of a point to `folder` as PNG and return its path."""
    return draw_picture(
        folder / 'point_contacts.png', lambda: figure_point(screw, solution, record)
    )


def figure_point(screw: Screw, solution: ScrewSolution, record: dict[str, Any]) -> Figure:
    """Return one column per solved contact: pressure above, film and slip below."""
    pressed = [
        contact
        for contact in solution.contacts
        if contact.solved is not None and contact.solved.converged
    ]
    figure = new_figure(2.3 * max(len(pressed), 2) + 1.2, 7.4)
    figure.suptitle(
        f'{record["screw"]}, {record["oil"]}: {record["speed_rad_s"] / RPM:g} rev/min, '
        f'{record["load_N"]:g} N, {record["temperature_K"] - ZERO_CELSIUS:g} °C\n'
        f'friction torque {MILLI * record["friction_torque_Nm"]:.1f} mN m, '
        f'efficiency {record["efficiency"]:.3f}, $\\Lambda$ {record["film_ratio"]:.2f}, '
        f'RCS {100 * record["rcs"]:.2g} %'
    )
    if pressed:
        axes = np.atleast_2d(figure.subplots(2, len(pressed), squeeze=False))
        solved = [contact.solved for contact in pressed if contact.solved is not None]
        top = GIGA * max(contact.pressed.max_pressure for contact in solved)
        bottom = NANO * min(float(contact.pressed.film.min()) for contact in solved)
        film = LogNorm(bottom, FILM_SPAN * bottom)
        for column, (contact, solved_contact) in enumerate(zip(pressed, solved, strict=True)):
            (upper, lower), rough = axes[:, column], solved_contact.pressed
            pressure = _map(upper, rough, GIGA * rough.pressure, vmin=0, vmax=top)
            gap = _map(lower, rough, NANO * rough.film, norm=film)
            _mark_contact(lower, rough)
            _draw_slip(lower, screw, contact, rough)
            upper.set_title(
                f'{contact.nut} nut, ball on {contact.side}\n{contact.ball.normal_force:.1f} N, '
                f'RCS {100 * solved_contact.asperities.rcs:.2g} %'
            )
            lower.set_xlabel('along the track [µm]', fontsize=8)
        for row in (0, 1):
            axes[row, 0].set_ylabel('across the track [µm]', fontsize=8)
        figure.colorbar(pressure, ax=axes[0], label='total pressure [GPa]')
        figure.colorbar(gap, ax=axes[1], label='film [nm], arrows: slip', extend='max')
    return figure


def _map(axes: Axes, rough: ContactSolution, field: Array, **options: Any) -> Any:
    x, y = MICRO * rough.x, MICRO * rough.y
    mesh = axes.pcolormesh(x, y, field.T, cmap=MAP, shading='nearest', rasterized=True, **options)
    turn = np.linspace(0, 2 * np.pi, 181)
    a, b = MICRO * rough.semi_axis_x, MICRO * rough.semi_axis_y
    axes.plot(a * np.cos(turn), b * np.sin(turn), color='white', linestyle='--', linewidth=0.9)
    axes.set(xlim=(-VIEW * a, VIEW * a), ylim=(-VIEW * b, VIEW * b))
    axes.tick_params(labelsize=7)
    return mesh


def _mark_contact(axes: Axes, rough: ContactSolution) -> None:
    touching = np.where(punctured_nodes(rough), 1.0, np.nan)
    if np.isfinite(touching).any():
        axes.pcolormesh(
            MICRO * rough.x,
            MICRO * rough.y,
            touching.T,
            cmap=ListedColormap([VERMILION]),
            shading='nearest',
            rasterized=True,
        )


def _draw_slip(axes: Axes, screw: Screw, contact: ScrewContact, rough: ContactSolution) -> None:
    if contact.motion is None:
        return
    along, across = contact_slip(screw, rough, contact.side, contact.motion)
    turn = 1 if contact.side == SIDES[0] else -1  # the nut's entrainment runs against t
    rows = [int(np.argmin(np.abs(rough.x - s * rough.semi_axis_x))) for s in _spread(ARROWS[0])]
    columns = [int(np.argmin(np.abs(rough.y - s * rough.semi_axis_y))) for s in _spread(ARROWS[1])]
    grid = np.ix_(rows, columns)
    x, y = np.meshgrid(rough.x[rows], rough.y[columns], indexing='ij')
    inside = (x / rough.semi_axis_x) ** 2 + (y / rough.semi_axis_y) ** 2 < 1
    slip_x, slip_y = turn * along[grid][inside], turn * across[grid][inside]
    axes.quiver(MICRO * x[inside], MICRO * y[inside], slip_x, slip_y, color='white', width=0.008)
    longest = float(np.hypot(slip_x, slip_y).max())
    axes.set_title(f'longest arrow {MILLI * longest:.2g} mm/s', fontsize=8)


def _spread(count: int) -> Array:
    return np.linspace(-0.8, 0.8, count)


def draw_onset(
    folder: Path, screw: Screw, lubricant: Lubricant, record: Mapping[str, Any]
) -> Path:
    """Draw the onset of a screw and oil into a folder and return the path of the picture."""
    name = f'onset_{record["screw"]}_{record["oil"]}.png'
    return draw_picture(folder / name, lambda: figure_onset(screw, lubricant, record))


def figure_onset(screw: Screw, lubricant: Lubricant, record: Mapping[str, Any]) -> Figure:
    """Return a line of speed for each state and temperature: in contact, perhaps, and free."""
    screw = replace(screw, working_load=record['working_load_N'])
    rows = list(_onset_rows(screw, lubricant, record))
    slowest = 0.3 * min((low for _, low, _ in rows if low), default=screw.fastest_speed / 30)
    ends = slowest / RPM, screw.fastest_speed / RPM
    figure = new_figure(7.2, 0.42 * len(rows) + 1.7)
    axes = figure.subplots()
    for place, (_, low, high) in enumerate(rows):
        edges = np.clip([ends[0], low / RPM, high / RPM, ends[1]], *ends)
        for begin, end, (colour, hatch, _) in zip(edges, edges[1:], ZONES):
            axes.barh(place, end - begin, 0.72, begin, color=colour, hatch=hatch, ec='w', lw=0)
        for edge in {speed for speed in edges[1:3].tolist() if ends[0] < speed < ends[1]}:
            text = f'{edge:.0f}' if edge >= 100 else f'{edge:.2g}'
            axes.annotate(text, (edge, place), ha='center', va='center', bbox=LABEL, size='small')
    axes.set(
        xscale='log',
        xlim=ends,
        xlabel='speed of the screw [rev/min]',
        title=f'{record["screw"]}, {record["oil"]}, {record["load_N"]:g} N',
    )
    axes.set_yticks(range(len(rows)), [name for name, _, _ in rows])
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter(lambda value, _: f'{value:g}')
    patches = [Patch(fc=colour, hatch=hatch, ec='w', label=text) for colour, hatch, text in ZONES]
    figure.legend(handles=patches, loc='outside lower center', ncols=3)
    return figure


def _onset_rows(
    screw: Screw, lubricant: Lubricant, record: Mapping[str, Any]
) -> Iterator[tuple[str, float, float]]:
    """Yield state and temperature in words, and between which speeds [rad/s] contact begins."""
    warm = lubricant.minimum_temperature, lubricant.maximum_temperature
    around = np.clip(record['temperature_K'] + np.array(AROUND), *warm).tolist()
    for state, stated in record['states'].items():
        opened = Contacts.of(with_raceway(screw, state=state))
        for kelvin in dict.fromkeys(around):
            speed = onset_point(opened, lubricant, record['load_N'], kelvin)['speed_rad_s']
            low, high = stated['band']
            yield f'{STATES[state]}, {kelvin - ZERO_CELSIUS:.0f} °C', low * speed, high * speed


def draw_sensitivity(folder: Path, record: Mapping[str, Any]) -> Path:
    """Draw a record of `sensitivity_record` into a folder and return the path of the picture."""
    name = f'sensitivity_{record["screw"]}_{record["oil"]}.png'
    return draw_picture(folder / name, lambda: figure_sensitivity(record))


def figure_sensitivity(record: Mapping[str, Any]) -> Figure:
    """Return bars of what each input changes, the largest on top, and the bands of the onset."""
    panels = [name for name in PANELS if math.isfinite(record['stated'][name])]
    rows = [*record['inputs'][::-1]]
    figure = new_figure(2.2 + 2.4 * len(panels), 1.6 + 0.28 * (len(rows) + len(BANDS)))
    every = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, name in zip(every, panels, strict=True):
        title, label, unit = PANELS[name]
        axes.set(title=title, xlabel=label)
        stated = record['stated'][name] / unit
        for place, row in enumerate(rows):
            ends = [(row[f'at_{end}'][name] / unit - stated, end) for end in COLOURS]
            # The longer bar first, so that it does not hide another on its side.
            for reached, end in sorted(ends, key=lambda reach: -abs(reach[0])):
                axes.barh(place, reached, left=stated, color=COLOURS[end], height=0.7)
        axes.axvline(stated, color='black', linewidth=0.8)
        axes.grid(axis='x')
    every[0].use_sticky_edges = False
    # Below the bars of the onset, its bands.
    onset = record['stated'][ONSET] / RPM
    every[0].axhline(-0.5, color='black', linewidth=0.8)
    for place, (name, shade) in enumerate(zip(BANDS.values(), BAND_COLOURS, strict=True)):
        low, high = (factor * onset for factor in record[name])
        every[0].barh(-1 - place, high - low, left=low, color=shade, height=0.7)
    every[0].set_yticks(
        range(-len(BANDS), len(rows)), [*BANDS][::-1] + [_label(row) for row in rows]
    )
    marks = [Patch(color=colour, label=f'input is {end}') for end, colour in COLOURS.items()]
    every[-1].legend(handles=marks, loc='lower right')
    figure.suptitle(
        f'{record["screw"]}, {record["oil"]}: {record["speed_rad_s"] / RPM:g} rev/min, '
        f'{record["load_N"]:g} N, {record["temperature_K"] - ZERO_CELSIUS:g} °C'
    )
    return figure


def _label(row: Mapping[str, Any]) -> str:
    return f'{row["key"]}  {shown(row["low"])} to {shown(row["high"])}'
