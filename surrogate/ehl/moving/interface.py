# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings and result of a contact whose rough raceway rolls through it."""

from dataclasses import dataclass, field
from enum import Enum
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.interface import Condition, ContactLubricant, NO_FADING, Settings
from surrogate.ehl.moving.line import StripContact
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.results import Mean, number

Array = NDArray[np.float64]
THIN_FILMS = (1e-9, 3e-9, 5e-9, 10e-9)
"""Films below which the share of the contact is reported [m]."""
LEAST_TRANSITS = 1.0
LEAST_EYRING = 1e5
"""Least Eyring stress of the flow of the ripples [Pa]."""
HARDNESS = 7e9
"""Pressure that steel of 60 HRC bears before it yields, about its hardness [Pa]."""


class MarchStatus(Enum):
    """How a march ended, in a sentence."""

    CONVERGED = 'Converged: flux, load and contact conditions hold in every step.'
    SOME_STEPS = 'A few steps ended before their errors were small; they are in the averages.'
    STALLED = 'The march was given up where several steps in a row did not converge.'
    NO_SMOOTH_FILM = 'The smooth contact that the march starts from was not solved.'


@dataclass(frozen=True, kw_only=True, slots=True)
class MarchSettings:
    """
    How to march.

    Nodes along and across the track, both odd; nodes that the columns move on in a step;
    `domain` as in `Settings`, None for one with room for all summits; places beside each other on
    the raceway over which the transits are shared; film floor [m]; relative tolerances of flux,
    load and contact gap of a step; slide-roll ratio at which traction is measured [-].
    `moving` False lets the raceway stand still, for comparison. Eyring stress of
    an oil that the flow of its ripples thins [Pa], infinity for a Newtonian one; way sideways over
    way along of the raceway against the ball [-], the oil goes half of it.

    """

    nx: int = 129
    ny: int = 257
    stride: int = 1
    domain: tuple[float, float, float] | None = None
    places: int = 4
    film_floor: float = 3e-9
    flux_tolerance: float = 3e-3
    load_tolerance: float = 1e-3
    gap_tolerance: float = 3e-2
    slide_roll_ratio: float = 0.019
    moving: bool = True
    ripple_eyring_stress: float = math.inf
    side_slip: float = 0.0

    def __post_init__(self) -> None:
        self.steady()
        for name, low, high in (('stride', 1, 16), ('places', 1, 1000)):
            value = getattr(self, name)
            if not (isinstance(value, int) and low <= value <= high):
                raise InputError(f'{name} is {value!r}, allowed is a number from {low} to {high}')
        if not 0 <= self.slide_roll_ratio <= 2:
            raise InputError(f'slide_roll_ratio is {self.slide_roll_ratio!r}, allowed is 0 to 2')
        if not self.ripple_eyring_stress >= LEAST_EYRING:
            raise InputError(
                f'ripple_eyring_stress is {self.ripple_eyring_stress!r} Pa, allowed is '
                f'{LEAST_EYRING:g} Pa or more'
            )
        if not abs(self.side_slip) <= 1:
            raise InputError(f'side_slip is {self.side_slip!r}, allowed is -1 to 1')

    def steady(self, domain: tuple[float, float, float] | None = None) -> Settings:
        """Return the settings of the steady solver on the grid of the march."""
        return Settings(
            nx=self.nx,
            ny=self.ny,
            domain=domain or self.domain,
            open_inlet=True,
            film_floor=self.film_floor,
            error_estimate=False,
            refine=False,
            wedge_fading=NO_FADING,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingSolution:
    """
    Averages over time and place of a contact that a rough raceway rolls through.

    Share of the load on punctured nodes `rcs` and share that asperities carry [-]; mean film and
    its rms over the inner 0.8 of the Hertz zone [m]; mean over time of the least film there [m];
    share of the Hertz zone with films below `THIN_FILMS` [-]; largest pressure [Pa] and share of
    the load at pressures above `HARDNESS` [-]; traction coefficient of the film at the slide-roll
    ratio of the settings [-]. Loss by rolling as a force on each surface [N]: Poiseuille
    dissipation over twice the entrainment speed; the same from the moment of the pressure over
    twice the radius, less what load and elastic bodies take up, which also holds what the inlet
    outside the domain takes; dissipation of the smooth contact. Central film of the smooth contact
    [m]; `rcs_along` over `x` over the semi-axis [-]: share of the load on punctured nodes per
    semi-axis; film at the centre in each averaged step, place after place [m]; length over which
    RCS forgets [semi-axes]; transits made, steps and those that did not converge; iterations; wall
    time [s]; film and pressure of the last step at `x_nodes`, `y_nodes` [m, Pa]. Numbers are NaN
    where nothing was averaged.

    """

    contact: Contact | StripContact
    lubricant: ContactLubricant
    condition: Condition
    settings: MarchSettings
    status: MarchStatus
    rcs: Mean = number(default=Mean())
    asperity_share: Mean = number(default=Mean())
    mean_film: Mean = number('m', default=Mean())
    film_rms: Mean = number('m', default=Mean())
    least_film: Mean = number('m', default=Mean())
    thin_shares: tuple[Mean, ...] = field(default=(Mean(),) * len(THIN_FILMS))
    max_pressure: Mean = number('Pa', default=Mean())
    hard_share: Mean = number(default=Mean())
    film_traction: Mean = number(default=Mean())
    rolling_loss: Mean = Mean()
    moment_loss: Mean = Mean()
    smooth_rolling_loss: float = math.nan
    central_film: float = number('m')
    x: Array = field(default_factory=lambda: np.empty(0))
    rcs_along: Array = field(default_factory=lambda: np.empty(0))
    centre_films: Array = field(default_factory=lambda: np.empty(0))
    memory: float = math.nan
    transits: float = number(default=0.0)
    steps: int = number(default=0)
    steps_failed: int = number(default=0)
    newton_iterations: int = number(default=0)
    krylov_iterations: int = number(default=0)
    wall_time: float = 0.0
    x_nodes: Array = field(default_factory=lambda: np.empty(0))
    y_nodes: Array = field(default_factory=lambda: np.empty(0))
    film: Array = field(default_factory=lambda: np.empty((0, 0)))
    pressure: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def converged(self) -> bool:
        """Whether all transits were made and nearly all steps converged."""
        return self.status in (MarchStatus.CONVERGED, MarchStatus.SOME_STEPS)
