# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A strip of a long contact, repeated across the track: a line contact with room for roughness.

A contact many times as wide as long is at each place nearly a line contact with the pressure of
that place, so that waves far too short for a grid over the whole contact are resolved on a strip.

"""

from dataclasses import dataclass, fields, replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.grid import Grid, GridState, make_strip_grid
from surrogate.ehl.half_space import deform
from surrogate.ehl.interface import Condition, ContactLubricant, RoughHeights, Settings
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.scales import scale_contact, ScaledContact
from surrogate.ehl.search import Search
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.formulas.line import Line, line_at, long_ellipse

Array = NDArray[np.float64]
NARROWEST, LONG_CELL = 4, 2.5
"""Columns of the strip on which the smooth contact is solved, and dy over dx there [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StripContact:
    """
    A line contact of which a strip is looked at.

    Radius of relative curvature along the track [m], reduced modulus as in `Contact` [Pa], Hertz
    pressure [Pa], width of the strip [m] and columns of nodes across it: 3^n * 2^k, k at least 2.

    """

    radius: float
    reduced_modulus: float
    max_pressure: float
    width: float
    columns: int

    def __post_init__(self) -> None:
        for name, unit in (
            ('radius', 'm'),
            ('reduced_modulus', 'Pa'),
            ('max_pressure', 'Pa'),
            ('width', 'm'),
        ):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InputError(f'strip: {name} is {value!r} {unit}, allowed is above 0')
        if good_length(self.columns) != self.columns:
            raise InputError(
                f'strip: columns is {self.columns!r}, allowed is 3^n * 2^k with k at least 2'
            )

    @property
    def line(self) -> Line:
        """Return the line contact without its width."""
        return Line(
            radius=self.radius,
            reduced_modulus=self.reduced_modulus,
            max_pressure=np.asarray(self.max_pressure),
        )

    @property
    def semi_axis(self) -> float:
        """Half width of the Hertz zone [m]."""
        return float(self.line.semi_axis)

    @property
    def load(self) -> float:
        """Load of the strip, pi/2 pH b times its width [N]."""
        return 0.5 * math.pi * self.max_pressure * self.semi_axis * self.width


def strip_at(
    contact: Contact, load: float, place: float, width: float, columns: int
) -> StripContact:
    """
    Return the strip of an elliptical contact under a load [N] at `place` across, over b [-].

    It is that of the line contact there (see `line_at`).

    """
    if not -1 < place < 1:
        raise InputError(f'strip: place is {place!r}, allowed is between -1 and 1')
    line = line_at(contact, load, place)
    return StripContact(
        radius=line.radius,
        reduced_modulus=line.reduced_modulus,
        max_pressure=float(line.max_pressure),
        width=width,
        columns=columns,
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class StripCase(ScaledCase):
    """A strip in Hertz units, all lengths over the half width b of its Hertz zone."""

    width: float

    @property
    def load(self) -> float:
        """Load in Hertz units."""
        return 0.5 * math.pi * self.width

    def grid(self, nx: int, ny: int, *, symmetric: bool) -> Grid:
        """Return a grid with `ny` columns that repeat; the smooth, symmetric strip needs few."""
        columns = NARROWEST if symmetric else ny
        return make_strip_grid(nx, columns, self.domain[:2], self.width, 1 / (2 * math.pi))

    def distance(self, grid: Grid) -> Array:
        """Return the distance of the nodes from the middle line over the half width [-]."""
        return np.abs(grid.x)[:, None] + 0.0 * grid.y[None, :]

    def shape_heights(self, grid: Grid) -> Array:
        """Return the smooth undeformed gap."""
        return 0.5 * grid.x[:, None] ** 2 + 0.0 * grid.y[None, :]

    def film_estimate(self, speed: float) -> float:
        """Return the central film by the formula of a long ellipse of the same pressure [-]."""
        line = Line(
            radius=self.contact.radius_x,
            reduced_modulus=self.contact.reduced_modulus,
            max_pressure=np.asarray(self.hertz_pressure),
        )
        long, load = long_ellipse(line)
        condition = Condition(load=float(load), entrainment_speed=speed)
        ellipse = scale_contact(long, self.lubricant, condition, None)
        return ellipse.film_estimate(speed) * ellipse.height_unit / self.height_unit

    def hertz_state(self, grid: Grid, speed: float) -> GridState:
        """Return Hertz's pressure at the formula's film [-]."""
        film = self.film_estimate(speed)
        pressure = np.sqrt(np.maximum(1 - grid.x[:, None] ** 2, 0)) + 0.0 * grid.y[None, :]
        lift = np.empty(grid.shape)
        deform(grid.space, pressure, lift)
        return GridState(
            film_pressure=pressure,
            asperity_pressure=np.zeros(grid.shape),
            approach=float(film - lift[np.argmin(np.abs(grid.x)), 1]),
        )


def scale_strip(
    strip: StripContact, lubricant: ContactLubricant, speed: float, raceway: RoughHeights
) -> ScaledContact:
    """Return a strip with the scales of its Hertz zone; entrainment speed [m/s]."""
    b = strip.semi_axis
    return ScaledContact(
        contact=long_ellipse(strip.line)[0],
        lubricant=lubricant,
        condition=Condition(load=strip.load, entrainment_speed=speed),
        roughness=raceway,
        semi_axis_x=b,
        semi_axis_y=strip.width / 2,
        hertz_pressure=strip.max_pressure,
        height_unit=b * b / strip.radius,
    )


def strip_case(scaled: ScaledContact, settings: Settings) -> StripCase:
    """Return a scaled strip on the domain of its settings."""
    assert settings.domain is not None
    return StripCase(
        **{field.name: getattr(scaled, field.name) for field in fields(scaled)},
        settings=settings,
        domain=settings.domain,
        open_inlet=True,
        width=2 * scaled.ellipticity,
    )


def smooth_strip(case: StripCase, grid: Grid) -> tuple[GridState, bool]:
    """Solve the smooth line contact on a few columns, and lay it out; True if it converged."""
    width = NARROWEST * LONG_CELL * grid.dx
    part = replace(case, width=width, semi_axis_y=0.5 * width * case.semi_axis_x)
    search = Search(case=part, deadline=math.inf)
    _, outcome = search.smooth(case.condition.entrainment_speed, final=True)
    column = outcome.state.film_pressure[:, 1:2]
    return GridState(
        film_pressure=np.repeat(column, grid.y.size, axis=1),
        asperity_pressure=np.zeros(grid.shape),
        approach=outcome.state.approach,
    ), outcome.converged
