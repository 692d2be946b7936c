# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Picture of a solved point: pressure, film and slip of all contacts that carry load."""

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactSolution, punctured_nodes
from surrogate.formulas.geometry import SIDES
from surrogate.parameters import Screw
from surrogate.plotting.style import draw_picture, MAP, new_figure, VERMILION
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.solve import ScrewSolution
from surrogate.units import GIGA, MICRO, MILLI, NANO, RPM, ZERO_CELSIUS

Array = NDArray[np.float64]

VIEW = 1.2
"""Half width of the maps over the semi-axes [-]."""
ARROWS = (5, 9)
"""Arrows of slip along and across a contact."""
FILM_SPAN = 30.0
"""Top of the film scale over its bottom [-]."""


def draw_point(folder: Path, screw: Screw, found: ScrewSolution, record: dict[str, Any]) -> Path:
    """Write the picture of a point to `folder` as PNG and return its path."""
    return draw_picture(folder / 'point_contacts.png', lambda: figure_point(screw, found, record))


def figure_point(screw: Screw, found: ScrewSolution, record: dict[str, Any]) -> Figure:
    """Return one column per solved contact: pressure above, film and slip below."""
    pressed = [
        contact
        for contact in found.contacts
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
        top = GIGA * max(one.pressed.max_pressure for one in solved)
        bottom = NANO * min(float(one.pressed.film.min()) for one in solved)
        film = LogNorm(bottom, FILM_SPAN * bottom)
        for column, (contact, one) in enumerate(zip(pressed, solved, strict=True)):
            (upper, lower), rough = axes[:, column], one.pressed
            pressure = _map(upper, rough, GIGA * rough.pressure, vmin=0, vmax=top)
            gap = _map(lower, rough, NANO * rough.film, norm=film)
            _mark_contact(lower, rough)
            _draw_slip(lower, screw, contact, rough)
            upper.set_title(
                f'{contact.nut} nut, ball on {contact.side}\n{contact.ball.normal_force:.1f} N, '
                f'RCS {100 * one.asperities.rcs:.2g} %'
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
    """Colour the nodes where asperities carry."""
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
    """Draw the slip of the ball at some places of the ellipse."""
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
