# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Measures of a step of a march, and their averages over its steps and places."""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.friction import viscosity_of
from surrogate.ehl.grid import Grid
from surrogate.ehl.kernels.moving import dissipated
from surrogate.ehl.moving.interface import HARDNESS, THIN_FILMS
from surrogate.ehl.moving.step import Step
from surrogate.ehl.results import central_film, PUNCTURED
from surrogate.ehl.system import film_planes, thin_film
from surrogate.results import Mean

Array = NDArray[np.float64]
CORE = 0.8
"""Part of the Hertz zone, over its semi-axes, where the film is averaged [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Measure:
    """
    Numbers of one step, as in `MovingSolution`.

    Entrainment speed [m/s], whether the step converged, shares and traction [-], films [m],
    pressure [Pa], losses [N]; RCS along the track per semi-axis [-].

    """

    speed: float
    converged: bool
    rcs: float
    asperity_share: float
    mean_film: float
    film_rms: float
    least_film: float
    max_pressure: float
    hard_share: float
    film_traction: float
    rolling_loss: float
    moment_loss: float
    centre_film: float
    thin_shares: Array
    rcs_along: Array


class Gauge:
    """Measures the steps of one contact on its grid."""

    def __init__(self, *, case: ScaledCase, grid: Grid, slide_roll_ratio: float) -> None:
        self.case, self.grid, self.slide_roll_ratio = case, grid, slide_roll_ratio
        # The distance of the nodes that count over the semi-axes [-], else infinity.
        counts = grid.weights > 0
        self._distance = np.where(counts[None, :], case.distance(grid), np.inf)
        self._force = (
            case.hertz_pressure * case.height_unit * case.semi_axis_x
        )  # along the track [N]

    def measure(self, step: Step) -> Measure:
        """Return the numbers of a step."""
        case, grid, outcome = self.case, self.grid, step.outcome
        unit, gap = case.height_unit, np.maximum(outcome.gap, case.floor)
        punctured = outcome.gap <= PUNCTURED * case.floor
        total = outcome.state.film_pressure + outcome.state.asperity_pressure
        touching = np.where(punctured, total, 0.0)
        hard = total > HARDNESS / case.hertz_pressure
        core = self._distance < CORE
        inside = gap[self._distance < 1.0] * unit
        # The Eyring traction of the film.
        pressure, oil = outcome.state.film_pressure, case.lubricant
        wet = ~punctured & (pressure > 0) & (grid.weights > 0)
        viscosity = viscosity_of(oil, pressure[wet] * case.hertz_pressure)
        slip = self.slide_roll_ratio * step.speed
        stress = oil.eyring_stress * np.arcsinh(
            viscosity * slip / (oil.eyring_stress * gap[wet] * unit)
        )
        area = grid.dx * grid.dy * case.semi_axis_x**2
        return Measure(
            speed=step.speed,
            converged=outcome.converged,
            rcs=grid.integral(touching) / case.load,
            asperity_share=grid.integral(outcome.state.asperity_pressure) / case.load,
            mean_film=float(gap[core].mean()) * unit,
            film_rms=float(gap[core].std()) * unit,
            least_film=float(inside.min()),
            max_pressure=float(total.max()) * case.hertz_pressure,
            hard_share=grid.integral(np.where(hard, total, 0.0)) / case.load,
            film_traction=float(stress.sum()) * area / case.condition.load,
            rolling_loss=self._rolling_loss(step),
            moment_loss=-0.5
            * (grid.integral(total * grid.x[:, None]) + step.stored)
            * self._force,
            centre_film=central_film(grid, outcome.gap) * unit,
            thin_shares=np.array([np.mean(inside < film) for film in THIN_FILMS]),
            rcs_along=touching @ grid.weights / grid.dx / case.load,
        )

    def _rolling_loss(self, step: Step) -> float:
        """Return the Poiseuille dissipation over twice the entrainment speed [N]."""
        grid, problem, outcome = self.grid, step.problem, step.outcome
        pressure = outcome.state.film_pressure
        film = film_planes(problem, pressure, outcome.gap, outcome.contact)
        assert problem.columns is not None
        thin_film(grid, problem.columns, pressure, film)
        lost = dissipated(
            pressure,
            film,
            problem.mobility,
            grid.aspect,
            problem.fading > 0.0,
            problem.inlet,
            grid.periodic,
        )
        return 0.5 * lost * grid.dy * self._force


NUMBERS = (
    'rcs',
    'asperity_share',
    'mean_film',
    'film_rms',
    'least_film',
    'max_pressure',
    'hard_share',
    'film_traction',
    'rolling_loss',
    'moment_loss',
)
"""Numbers of a `Measure` that are averaged into a `Mean` of the same name."""


def averages(places: Sequence[Sequence[Measure]], step_length: float) -> dict[str, Any]:
    """
    Return averages of a `MovingSolution` over the steps of all places that have any.

    Steps are `step_length` [semi-axes] apart; each place has an equal share.

    """
    places = [steps for steps in places if steps]
    numbers: dict[str, Any] = {
        name: _mean([np.mean([getattr(step, name) for step in steps]) for steps in places])
        for name in NUMBERS
    }
    thin = np.array([np.mean([step.thin_shares for step in steps], axis=0) for steps in places])
    along = [np.mean([step.rcs_along for step in steps], axis=0) for steps in places]
    tracks = [np.array([step.rcs for step in steps]) for steps in places]
    return numbers | {
        'thin_shares': tuple(_mean(column) for column in thin.T),
        'rcs_along': np.mean(along, axis=0),
        'memory': _memory(tracks) * step_length,
    }


def _mean(values: Sequence[float] | Array) -> Mean:
    """Return the mean of equal shares and its standard error, in their unit [any]."""
    value = float(np.mean(values))
    if len(values) < 2:
        return Mean(value=value)
    return Mean(value=value, error=float(np.std(values, ddof=1)) / math.sqrt(len(values)))


def _memory(tracks: Sequence[Array]) -> float:
    """Return after how many steps the autocorrelation is below 1/e [-]; NaN if it never is."""
    longest = min(track.size for track in tracks)
    total = np.zeros(longest)
    for track in tracks:
        rest = track - track.mean()
        start = track.size - 1
        total += np.correlate(rest, rest, 'full')[start:][:longest]
    if not total[0] > 0:
        return math.nan
    below = np.flatnonzero(total < total[0] / math.e)
    return float(below[0]) if below.size else math.nan
