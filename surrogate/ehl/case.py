# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One contact case in Hertz units: scales, domain, grids, equations at any speed and roughness."""

from dataclasses import dataclass, fields, replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.domain import nodes_at_multiples, production_domain
from surrogate.ehl.grid import Grid, GridState, make_grid
from surrogate.ehl.half_space import deform
from surrogate.ehl.interface import Condition, ContactLubricant, RoughHeights, Settings
from surrogate.ehl.scales import scale_contact, ScaledContact
from surrogate.ehl.system import GridProblem
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.formulas.lubricant import ROELANDS_OFFSET, ROELANDS_PRESSURE

Array = NDArray[np.float64]
DOWSON_HIGGINSON = 0.34
"""Gain of density at infinite pressure [-]."""
SOFT = 0.6
"""Exponent of viscosity that converges from Hertz's pressure [-]."""
STIFF = 0.8
"""Exponent from which the way leads over a softer law [-]."""
COARSEST = 33
"""Levels are halved down to about this many nodes along x [-]."""
COARSE_STEP = 0.25
"""Largest node distance of a coarse level over the semi-axis or the width of a thick film [-]."""
COARSEST_ACROSS = 17
COARSE, UNRESOLVED = 0.6, 1.5
"""Node distance over the inlet length at which a smooth film needs limits, or is refused [-]."""
SPREAD = 0.25
"""Semi-axis of the first pressure over the width of a thick film [-]."""
TOUCHING = 2.0
"""Film by formula over the floor below which smooth surfaces are taken to touch [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaledCase(ScaledContact):
    """
    A scaled contact on its domain, and how to solve it.

    Domain: inlet, outlet and half width over the semi-axis a [-].

    """

    settings: Settings
    domain: tuple[float, float, float]
    open_inlet: bool

    @property
    def floor(self) -> float:
        """Film floor in Hertz units."""
        return self.settings.film_floor / self.height_unit

    @property
    def load(self) -> float:
        """Load in Hertz units."""
        return 2 * math.pi / 3 * self.ellipticity

    def grid(self, nx: int, ny: int, *, symmetric: bool) -> Grid:
        """Return a grid of this case."""
        compliance = (
            2
            * self.hertz_pressure
            * self.contact.radius_x
            / (math.pi * self.contact.reduced_modulus * self.semi_axis_x)
        )
        return make_grid(nx, ny, self.domain, symmetric=symmetric, compliance=compliance)

    def levels(self) -> list[tuple[int, int]]:
        """Return the cascade of grids, coarsest first."""
        nx, ny = self.settings.nx, self.settings.ny
        levels = [(nx, ny)]
        width, speed = self.domain[1] - self.domain[0], self.condition.entrainment_speed
        thick = math.sqrt(2 * self.film_estimate(speed)) if speed else 0.0
        while nx > COARSEST + 8 and 2 * width / nx < COARSE_STEP * max(1.0, thick):
            nx, ny = nx // 4 * 2 + 1, max(ny // 4 * 2 + 1, COARSEST_ACROSS)
            levels.insert(0, (nx, ny))
        return levels

    def distance(self, grid: Grid) -> Array:
        """Return the distance of the nodes from the centre over the semi-axes [-]."""
        across = grid.y / self.ellipticity
        return np.asarray(np.hypot(grid.x[:, None], across[None, :]))

    def shape_heights(self, grid: Grid) -> Array:
        """Return the smooth undeformed gap."""
        ratio = self.contact.radius_x / self.contact.radius_y
        return 0.5 * grid.x[:, None] ** 2 + 0.5 * ratio * grid.y[None, :] ** 2

    def rough_heights(self, grid: Grid) -> Array:
        """Return the roughness on a full grid, or on the half grid of an array."""
        unit, shape = self.semi_axis_x, grid.shape
        if callable(self.roughness):
            places = np.meshgrid(grid.x * unit, grid.y * unit, indexing='ij')
            heights = np.asarray(self.roughness(*places), dtype=float)
        else:
            heights = np.asarray(self.roughness, dtype=float)
            if heights.shape == (2 * shape[0] - 1, 2 * shape[1] - 1):
                heights = heights[::2, ::2]
        if heights.shape != shape:
            raise InputError(f'roughness has shape {heights.shape}, the grid has {shape}')
        if not np.isfinite(heights).all():
            raise InputError('roughness holds a height that is not finite')
        return heights / self.height_unit

    def has_heights_on(self, shape: tuple[int, int]) -> bool:
        """Return True if heights can be had on the half grid: an array needs common nodes."""
        nodes = (self.settings.nx, self.settings.ny)
        common = all(n - 1 == 2 * (half - 1) for n, half in zip(nodes, shape, strict=True))
        return self.roughness is None or callable(self.roughness) or common

    def inlet_length(self, speed: float) -> float:
        """
        Length over which the gap in front of the Hertz zone grows by the film, in Hertz units [-].

        Gap (4 sqrt(2)/3) s^(3/2) at the distance s: the pressure builds up there.

        """
        film = max(self.film_estimate(speed), self.floor)
        return float((0.75 * film / math.sqrt(2)) ** (2 / 3))

    @property
    def touches(self) -> bool:
        """Whether the surfaces touch, or may."""
        speed = self.condition.entrainment_speed
        return self.roughness is not None or (
            speed > 0 and self.film_estimate(speed) < TOUCHING * self.floor
        )

    def coarseness(self, settings: Settings, speed: float) -> float:
        """Return the node distance of the finest grid over the inlet length [-]."""
        dx = (self.domain[1] - self.domain[0]) / (settings.nx - 1)
        return dx / self.inlet_length(speed)

    @property
    def limits(self) -> bool:
        """
        Whether wedge and flow factors take what a coarse grid throws at them.

        Where surfaces touch, and where the nodes miss the inlet: the plain ones dip the film at
        the ends of the contact to a fraction, down to false contact.

        """
        speed, settings = self.condition.entrainment_speed, self.settings
        if self.touches or not speed:
            return self.touches
        across = 2 * self.domain[2] / (settings.ny - 1) / self.ellipticity
        coarseness = max(self.coarseness(settings, speed), across / self.inlet_length(speed))
        return coarseness > COARSE

    @property
    def order(self) -> float:
        """
        Order of the upstream wedge at the end of the way [-].

        All of a smooth contact touches at once, which order 2 does not survive.

        """
        smooth = self.touches and self.roughness is None
        return float(self.settings.wedge_order or (1 if smooth else 2))

    def problem(
        self, grid: Grid, speed: float, heights: Array, order: float, softness: float = 0.0
    ) -> GridProblem:
        """Return the equations on a grid at a speed [m/s]; `softness` as in `fluid_numbers`."""
        lubricant, a = self.lubricant, self.semi_axis_x
        exponent, gain = self.fluid_numbers(softness)
        shear = 12 * lubricant.viscosity * speed * a / (self.hertz_pressure * self.height_unit**2)
        return GridProblem(
            heights=heights,
            floor=self.floor,
            load=self.load,
            width=2 * self.ellipticity,
            dry=speed == 0.0,
            mobility=1 / (shear * grid.dx) if speed else 0.0,
            pressure_scale=self.hertz_pressure,
            exponent=exponent,
            density_gain=gain,
            growth=lubricant.pressure_viscosity * ROELANDS_PRESSURE / exponent,
            order=order,
            fading=self.settings.wedge_fading if self.limits else 0.0,
            inlet=self.inlet(grid),
        )

    def fluid_numbers(self, softness: float) -> tuple[float, float]:
        """
        Return the exponent of viscosity in pressure and the gain of density.

        Barus is Roelands with exponent 1; a softness of 1 takes any law back to exponent SOFT and
        the density of Dowson and Higginson, from where a stiff law is reached in steps.

        """
        exponent, gain = 1.0, 0.0
        if self.lubricant.law == 'roelands_dh':
            growth = math.log(self.lubricant.viscosity) + ROELANDS_OFFSET
            gain = DOWSON_HIGGINSON
            exponent = self.lubricant.pressure_viscosity * ROELANDS_PRESSURE / growth
        soft = min(SOFT, exponent)
        return (
            exponent + softness * (soft - exponent),
            gain + softness * (DOWSON_HIGGINSON - gain),
        )

    def inlet(self, grid: Grid) -> Array:
        """Return p outside over p inside the inlet, per column: p ~ x/h^2 of a rigid body [-]."""
        if not self.open_inlet:
            return np.zeros(grid.y.size)
        heights = self.shape_heights(grid)
        return np.asarray(grid.x[0] / grid.x[1] * (heights[1] / heights[0]) ** 2)

    def hertz_state(self, grid: Grid, speed: float) -> GridState:
        """Return Hertz's pressure [-], spread under a thick film, at the formula's film."""
        film = self.film_estimate(speed) if speed else self.floor
        spread = max(1.0, SPREAD * math.sqrt(2 * film))
        round_x = grid.x[:, None] / spread
        round_y = grid.y[None, :] / (self.ellipticity * spread)
        pressure = np.sqrt(np.maximum(1 - round_x**2 - round_y**2, 0)) / spread**2
        lift = np.empty(grid.shape)
        deform(grid.space, pressure, lift)
        i, j = np.argmin(np.abs(grid.x)), np.argmin(np.abs(grid.y))
        nothing = np.zeros(grid.shape)
        return GridState(
            film_pressure=pressure if speed else nothing,
            asperity_pressure=nothing if speed else pressure,
            approach=float(film - lift[i, j]),
        )


def make_case(
    contact: Contact,
    lubricant: ContactLubricant,
    condition: Condition,
    settings: Settings,
    roughness: RoughHeights | None,
) -> ScaledCase:
    """Scale a case by its Hertz contact and find its domain."""
    scaled = scale_contact(contact, lubricant, condition, roughness)
    domain = settings.domain or production_domain(scaled, settings.summit_reach)
    if settings.spacing:
        b = scaled.semi_axis_y
        ny, side = nodes_at_multiples(settings, domain[2] * b, b)
        settings, domain = replace(settings, ny=ny), (*domain[:2], side / b)
    open_inlet = settings.domain is None if settings.open_inlet is None else settings.open_inlet
    return ScaledCase(
        **{field.name: getattr(scaled, field.name) for field in fields(scaled)},
        settings=settings,
        domain=(domain[0], domain[1], domain[2] * scaled.ellipticity),
        open_inlet=open_inlet,
    )
