# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A march under way: step after step at one place of the raceway after the other."""

from dataclasses import dataclass, field, replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.grid import Grid, GridState
from surrogate.ehl.moving.feed import Feed
from surrogate.ehl.moving.interface import MarchSettings, MarchStatus, MovingSolution
from surrogate.ehl.moving.line import StripContact
from surrogate.ehl.moving.step import Step, step_limits, Stepper
from surrogate.ehl.moving.sums import averages, Gauge, Measure
from surrogate.ehl.watch import at, tell
from surrogate.formulas.geometry import Contact

Array = NDArray[np.float64]
RUN_IN = 2.7
"""Way of the raceway until rough material fills the contact [semi-axes]."""
STALLED = 3
"""Steps in a row without convergence after which a march is given up [-]."""
FEW = 0.02
"""Share of steps that may fail without a march being in doubt [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SmoothPath:
    """
    Smooth contacts along the way of a march: one, or those of a speed that changes.

    Entrainment speeds [m/s] in equal steps of their logarithm, and the contact at each.

    """

    speeds: Array
    states: tuple[GridState, ...]

    def at(self, share: float) -> tuple[float, GridState]:
        """Return speed [m/s] and smooth contact at a share of the way [-]."""
        last = len(self.states) - 1
        if last == 0:
            return float(self.speeds[0]), self.states[0]
        place = min(max(share, 0.0), 1.0) * last
        first = min(int(place), last - 1)
        weight = place - first
        low, high = self.states[first], self.states[first + 1]
        return float(math.exp(np.interp(place, np.arange(last + 1), np.log(self.speeds)))), (
            GridState(
                film_pressure=(1 - weight) * low.film_pressure + weight * high.film_pressure,
                asperity_pressure=low.asperity_pressure,
                approach=(1 - weight) * low.approach + weight * high.approach,
            )
        )


@dataclass(kw_only=True)
class March:
    """
    A march under way: what has been measured at each place, and what it took.

    It leaves a place once the mean RCS of the last `turn` steps is `enough` [-].

    """

    case: ScaledCase
    grid: Grid
    settings: MarchSettings
    path: SmoothPath | None
    enough: float = math.inf
    turn: int = 1
    places: list[list[Measure]] = field(default_factory=list)
    last: Step | None = None
    steps: int = 0
    planned: int = 0
    failed: int = 0
    failed_in_a_row: int = 0
    newton: int = 0
    krylov: int = 0
    ended: MarchStatus | None = None

    def __post_init__(self) -> None:
        self.gauge = Gauge(
            case=self.case, grid=self.grid, slide_roll_ratio=self.settings.slide_roll_ratio
        )

    def run(self, transits: float) -> None:
        """March so many transits at each place, until the march ends."""
        self.planned = self.settings.places * len(self._moves(transits))
        self._tell(0, math.nan)
        settings, path = self.settings, self.path
        if path is None:
            return
        run_in, length = RUN_IN / self.grid.dx, 2 * transits / self.grid.dx
        for place in range(settings.places):
            self.places.append([])
            stepper = self._stepper()
            feed = Feed(
                case=self.case,
                grid=self.grid,
                place=self._place(place, RUN_IN + 2 * transits),
                ramp=settings.moving,
                side_slip=settings.side_slip,
            )
            for moved in self._moves(transits):
                stepper.follow(*path.at((moved - run_in) / length))
                step = stepper.step(feed.at(moved if settings.moving else 0))
                self._count(step)
                if self.ended is not None:
                    return
                if moved > run_in:
                    self.places[-1].append(self.gauge.measure(step))
                    last = [measure.rcs for measure in self.places[-1][slice(-self.turn, None)]]
                    if len(last) == self.turn and sum(last) >= self.enough * self.turn:
                        break

    def _moves(self, transits: float) -> range:
        """Return by how many nodes the raceway has moved on at each step at a place [-]."""
        stride = self.settings.stride
        return range(stride, round((RUN_IN + 2 * transits) / self.grid.dx) + stride, stride)

    def _place(self, number: int, length: float) -> tuple[float, float]:
        """
        Return a place on the raceway [m], so far from the others that no track overlaps.

        `length` is that of a track over the semi-axis [-]. A strip that repeats has none beside
        it, but for itself.

        """
        x, y = self.grid.x, self.grid.y
        along = number * (length + float(x[-1] - x[0]))
        across = 0.0 if self.grid.periodic else number * float(y[-1] - y[0])
        return along * self.case.semi_axis_x, across * self.case.semi_axis_x

    def _stepper(self, knot: int = 0) -> Stepper:
        """Return a stepper at rest in one of the smooth contacts of the way."""
        assert self.path is not None
        settings, speed = self.settings, float(self.path.speeds[knot])
        condition = replace(self.case.condition, entrainment_speed=speed)
        case = replace(self.case, condition=condition)
        return Stepper(
            case=case,
            grid=self.grid,
            smooth=self.path.states[knot],
            limits=step_limits(
                settings.flux_tolerance, settings.load_tolerance, settings.gap_tolerance
            ),
            stride=settings.stride,
            moving=settings.moving,
            shear=0.5
            * case.hertz_pressure
            * case.height_unit
            / (case.semi_axis_x * settings.ripple_eyring_stress),
        )

    def _count(self, step: Step) -> None:
        good = step.outcome.converged
        self.last = step
        self.steps += 1
        self.failed += not good
        self.failed_in_a_row = 0 if good else self.failed_in_a_row + 1
        self.newton += step.newton
        self.krylov += step.krylov
        self._tell(step.newton, step.outcome.flux_error)
        if self.failed_in_a_row == STALLED:
            self.ended = MarchStatus.STALLED

    def _tell(self, count: int, residual: float) -> None:
        """Tell who watches how many steps are made, and what the last one took [-]."""
        with at(step=self.steps, steps=self.planned):
            tell(count, residual)

    @property
    def status(self) -> MarchStatus:
        """How the march ended."""
        if self.path is None:
            return MarchStatus.NO_SMOOTH_FILM
        if self.ended is None and self.failed > FEW * self.steps:
            return MarchStatus.STALLED
        return self.ended or (MarchStatus.SOME_STEPS if self.failed else MarchStatus.CONVERGED)

    def solution(self, contact: Contact | StripContact, wall_time: float) -> MovingSolution:
        """Return the averages of what was measured, however the march ended; wall time [s]."""
        case = self.case
        bare = MovingSolution(
            contact=contact,
            lubricant=case.lubricant,
            condition=case.condition,
            settings=self.settings,
            status=self.status,
            steps=self.steps,
            steps_failed=self.failed,
            newton_iterations=self.newton,
            krylov_iterations=self.krylov,
            wall_time=wall_time,
        )
        if not any(self.places):
            return bare
        step_length = self.settings.stride * self.grid.dx
        smooth = self.smooth_measures()[0]
        assert self.last is not None
        state = self.last.outcome.state
        return replace(
            bare,
            **averages(self.places, step_length),
            x=self.grid.x,
            centre_films=np.array([step.centre_film for steps in self.places for step in steps]),
            transits=sum(map(len, self.places)) * step_length / 2,
            smooth_rolling_loss=smooth.rolling_loss,
            central_film=smooth.centre_film,
            x_nodes=self.grid.x * case.semi_axis_x,
            y_nodes=self.grid.y * case.semi_axis_x,
            film=self.last.outcome.gap * case.height_unit,
            pressure=(state.film_pressure + state.asperity_pressure) * case.hertz_pressure,
        )

    def smooth_measures(self) -> list[Measure]:
        """Return the numbers of the smooth contacts along the way."""
        assert self.path is not None
        still = np.zeros(self.grid.shape)
        steps = (self._stepper(knot).step(still) for knot in range(len(self.path.states)))
        return [self.gauge.measure(step) for step in steps]
