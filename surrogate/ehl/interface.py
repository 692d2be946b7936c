# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs and result of the contact solver."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.results import required

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Law = Literal['roelands_dh', 'barus_incompressible']
RoughHeights = Array | Callable[[Array, Array], Array]
"""Heights [m], material positive: an array on the solution grid or a function of x and y [m]."""
LARGEST_GRID = 2049
NO_FADING = 1e9
"""Logarithm of the viscosity that no oil reaches: the wedge is of order 2 throughout [-]."""


class Status(Enum):
    """How a solve ended, in a sentence."""

    NOT_SOLVED = 'Nothing was solved.'
    CONVERGED = (
        'Converged: flux, load and contact conditions hold and no node lies below the floor.'
    )
    STALLED = 'The iteration ended before flux, load and contact errors were small.'
    CONTINUATION_FAILED = (
        'The path from an easier case was cut so fine that it was given up before the case.'
    )
    OUT_OF_TIME = 'The time cap was reached before convergence.'
    GRID_TOO_COARSE = (
        'The grid is too coarse for the film: a smooth surface would touch; refine it.'
    )
    DOMAIN_TOO_SMALL = 'Pressure or contact reaches the edge of the domain: widen it.'


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactLubricant:
    """
    Oil at the temperature of one contact.

    Ambient viscosity [Pa s], pressure-viscosity coefficient [1/Pa], Eyring stress [Pa]; `law` is
    'roelands_dh' (Roelands viscosity, Dowson-Higginson density) or 'barus_incompressible'; largest
    shear stress over the pressure [-], None without a limit.

    """

    viscosity: float
    pressure_viscosity: float
    eyring_stress: float = 5e6
    law: Law = 'roelands_dh'
    limiting_shear_share: float | None = None

    def __post_init__(self) -> None:
        _require('viscosity', self.viscosity, 'Pa s', 1e-4, 100.0)
        _require('pressure_viscosity', self.pressure_viscosity, '1/Pa', 1e-10, 1e-7)
        _require('eyring_stress', self.eyring_stress, 'Pa', 1e4, 1e9)
        if self.limiting_shear_share is not None:
            _require('limiting_shear_share', self.limiting_shear_share, '-', 0.0, 1.0)
        if self.law not in ('roelands_dh', 'barus_incompressible'):
            raise InputError(
                f'law is {self.law!r}, allowed is roelands_dh or barus_incompressible'
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class Condition:
    """Normal load [N] and entrainment speed [m/s], mean of both surfaces; 0 is the dry contact."""

    load: float
    entrainment_speed: float

    def __post_init__(self) -> None:
        _require('load', self.load, 'N', 1e-6, 1e7)
        _require('entrainment_speed', self.entrainment_speed, 'm/s', 0.0, 1e3)


@dataclass(frozen=True, kw_only=True, slots=True)
class Settings:
    """
    How to solve.

    Nodes along and across the track, both odd; `domain` = inlet, outlet and side over the semi-
    axes of the Hertz ellipse (-4.5, 1.5, 3 means x from -4.5 a to 1.5 a, |y| < 3 b), None for the
    production rule; `open_inlet` continues the pressure beyond the inlet as the rigid isoviscous
    solution does (None: on the production domain only); film floor [m]; relative tolerances of
    flux, load and contact gap; what a linear solve of a rough contact leaves of its residual [-],
    at most 0.01 where Newton stalls; cap of Newton iterations of one solve [-] and of the whole
    call [s]; `error_estimate` also solves the half grid; `refine` solves a smooth contact that
    touches on grids up to four times as fine (the result then has more nodes than asked for);
    order of the upstream wedge, 1 or 2 (None: 2, but 1 where all of a smooth contact touches);
    logarithm of the viscosity at which a limited wedge fades to order 1 [-],
    docs/theory/contact_solver.md; how far outside the Hertz zone summits are sought that need room
    on the production domain, over the semi-axes; `spacing` puts nodes across the track of that
    domain at multiples of it [m], at the same places of a rough surface whatever the load, or of
    it times a power of sqrt(2): down to `ny` nodes, up where the domain is much wider than the
    contact; distance of the inlet meniscus from the centre [m], for the rolling tail.

    """

    nx: int = 257
    ny: int = 65
    domain: tuple[float, float, float] | None = None
    open_inlet: bool | None = None
    film_floor: float = 3e-9
    flux_tolerance: float = 1e-4
    load_tolerance: float = 1e-6
    gap_tolerance: float = 1e-4
    krylov_tolerance: float = 0.01
    newton_limit: int = 40
    time_cap: float = 60.0
    error_estimate: bool = True
    refine: bool = True
    wedge_order: int | None = None
    wedge_fading: float = 2.5
    summit_reach: float = 2.0
    spacing: float | None = None
    meniscus_length: float = 1e-3

    def __post_init__(self) -> None:
        for name in ('nx', 'ny'):
            value = getattr(self, name)
            if not (isinstance(value, int) and 17 <= value <= LARGEST_GRID and value % 2):
                raise InputError(
                    f'{name} is {value!r}, allowed is an odd number from 17 to {LARGEST_GRID}'
                )
        if self.domain is not None:
            good = (
                len(self.domain) == 3
                and all(math.isfinite(edge) for edge in self.domain)
                and -50 <= self.domain[0] <= -1.1
                and 1.1 <= self.domain[1] <= 20
                and 1.05 <= self.domain[2] <= 20
            )
            if not good:
                raise InputError(
                    f'domain is {self.domain!r}, allowed is inlet -50 to -1.1, outlet 1.1 to 20, '
                    'side 1.05 to 20, over the semi-axes'
                )
        _require('film_floor', self.film_floor, 'm', 1e-12, 1e-6)
        for name in ('flux_tolerance', 'load_tolerance', 'gap_tolerance'):
            _require(name, getattr(self, name), '-', 1e-12, 0.1)
        _require('krylov_tolerance', self.krylov_tolerance, '-', 1e-6, 0.5)
        _require('newton_limit', self.newton_limit, '-', 1, 1000)
        _require('time_cap', self.time_cap, 's', 1e-3, 1e6)
        _require('wedge_fading', self.wedge_fading, '-', 0.1, NO_FADING)
        _require('summit_reach', self.summit_reach, '-', 0.1, 20)
        if self.spacing is not None:
            _require('spacing', self.spacing, 'm', 1e-9, 1e-2)
            if self.domain is not None:
                raise InputError(f'spacing is {self.spacing!r} m, allowed is None with a domain')
        _require('meniscus_length', self.meniscus_length, 'm', 0.0, 1.0)
        if self.wedge_order not in (None, 1, 2):
            raise InputError(f'wedge_order is {self.wedge_order!r}, allowed is 1, 2 or None')


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactSolution:
    """
    Fields, sums and quality of one solved contact.

    Arrays (nx, ny), x first; pressures are zero on the border. Film and asperity pressure [Pa],
    film [m] (the true gap), places [m], masks of nodes where asperities carry and where the film
    has ruptured; central and global minimum film [m]; both extrapolated from the half grid [m] and
    the estimated relative error of the central film [-], NaN without estimate; largest total
    pressure, Hertz pressure [Pa], semi-axes and approach [m]; `rcs`, share of the load on
    punctured nodes [-], `rcs_error`, what it differs by on the half grid [-], `asperity_share`,
    integral of pa over the load [-]; relative load error, `residual`, sum over a line of the flux
    imbalance over the local flow, weighted by how far the film gives way to it, contact gap error
    over the floor [-]; rolling force on each surface [N] from the domain and from the tail between
    inlet and meniscus; iterations, wall time [s]. Unless converged the films, shares, largest
    pressure and force are NaN and the arrays those of the last iterate.

    """

    contact: Contact
    lubricant: ContactLubricant
    condition: Condition
    settings: Settings
    status: Status
    film_pressure: Array
    asperity_pressure: Array
    film: Array
    x: Array
    y: Array
    contact_mask: Mask
    cavitation_mask: Mask
    central_film: float = required('m')
    minimum_film: float = required('m')
    extrapolated_film: float
    extrapolated_minimum: float
    film_error: float = required()
    max_pressure: float = required('Pa')
    hertz_pressure: float = required('Pa')
    semi_axis_x: float = required('m')
    semi_axis_y: float = required('m')
    approach: float
    rcs: float = required()
    rcs_error: float = required()
    asperity_share: float = required()
    load_error: float = required()
    residual: float = required()
    gap_error: float
    rolling_force: float
    rolling_tail: float
    newton_iterations: int = required()
    krylov_iterations: int = required()
    wall_time: float

    @property
    def converged(self) -> bool:
        """Whether every condition of the result holds."""
        return self.status is Status.CONVERGED

    @property
    def pressure(self) -> Array:
        """Total pressure [Pa]."""
        return self.film_pressure + self.asperity_pressure

    @property
    def node_area(self) -> float:
        """Area that a node stands for [m2]."""
        return float((self.x[1] - self.x[0]) * (self.y[1] - self.y[0]))

    @property
    def distance(self) -> Array:
        """Distance of the nodes from the centre over the semi-axes [-]: 1 on the Hertz ellipse."""
        x, y = self.x / self.semi_axis_x, self.y / self.semi_axis_y
        return np.asarray(np.hypot(x[:, None], y[None, :]))

    @property
    def whole_rolling_force(self) -> float:
        """Force on each surface by rolling [N], in the domain and in the tail to the meniscus."""
        return self.rolling_force + self.rolling_tail


def check_contact(contact: Contact) -> None:
    """Raise InputError for radii or modulus that no contact has."""
    _require('radius_x', contact.radius_x, 'm', 1e-6, 1e3)
    _require('radius_y', contact.radius_y, 'm', 1e-6, 1e3)
    _require('reduced_modulus', contact.reduced_modulus, 'Pa', 1e5, 1e13)
    ratio = contact.radius_y / contact.radius_x
    if not 1e-3 <= ratio <= 1e3:
        raise InputError(f'radius_y / radius_x is {ratio:g}, allowed is 0.001 to 1000')


def _require(name: str, value: float, unit: str, low: float, high: float) -> None:
    good = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    if not good or not math.isfinite(value) or not low <= value <= high:
        raise InputError(f'{name} is {value!r} {unit}, allowed is {low:g} to {high:g} {unit}')
