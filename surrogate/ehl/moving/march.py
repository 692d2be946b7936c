# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""March a contact while its rough raceway rolls through it, and average what happens."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
import time

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import make_case, ScaledCase
from surrogate.ehl.domain import production_domain
from surrogate.ehl.grid import Grid, GridState
from surrogate.ehl.interface import (
    check_contact,
    Condition,
    ContactLubricant,
    ContactSolution,
    RoughHeights,
)
from surrogate.ehl.moving.feed import Feed, raceway_heights
from surrogate.ehl.moving.interface import (
    LEAST_TRANSITS,
    MarchSettings,
    MarchStatus,
    MovingSolution,
)
from surrogate.ehl.moving.line import scale_strip, smooth_strip, strip_case, StripContact
from surrogate.ehl.moving.step import Step, step_limits, Stepper
from surrogate.ehl.moving.sums import average, Gauge, Measure
from surrogate.ehl.scales import scale_contact, ScaledContact
from surrogate.ehl.solver import solve_contact
from surrogate.ehl.to_si import state_from_solution
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact

Array = NDArray[np.float64]
PRODUCTION = MarchSettings()
RUN_IN = 2.7
"""Way of the raceway until rough material fills the contact [semi-axes]."""
STALLED = 3
"""Steps in a row without convergence after which a march is given up [-]."""
FEW = 0.02
"""Share of steps that may fail without a march being in doubt [-]."""
LEAST_INLET, LEAST_SIDE = 2.3, 1.3
"""Least inlet and side of the domain [semi-axes]: rough material enters in the inlet."""
SAMPLE = 64
"""Points along and across at which the highest summit of a raceway is looked for [-]."""


def march_contact(
    contact: Contact,
    lubricant: ContactLubricant,
    condition: Condition,
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings = PRODUCTION,
    start: ContactSolution | None = None,
) -> MovingSolution:
    """
    Let a rough raceway roll through a contact and average over time.

    `raceway` is a function z(x, y) [m] of places [m]; `transits` of the contact, two semi-axes
    each, are shared over `settings.places` beside each other, after a run-in at each. A `start`
    from a neighbouring condition saves the way to the smooth contact. Raises InputError for
    inputs that no contact has and for less than a transit at each place; everything else is a
    status.

    """
    check_contact(contact)
    _check_transits(transits, settings)
    began = time.perf_counter()
    scaled = scale_contact(contact, lubricant, condition, raceway)
    steady = settings.steady(settings.domain or marching_domain(scaled))
    with at(stage='rolling contact'):
        smooth = solve_contact(
            contact, lubricant, condition, roughness=flat, settings=steady, start=start
        )
        case = make_case(contact, lubricant, condition, steady, raceway)
        grid = case.grid(settings.nx, settings.ny, symmetric=False)
        march = _March(
            case=case,
            grid=grid,
            settings=settings,
            smooth=state_from_solution(case, grid, smooth) if smooth.converged else None,
            deadline=began + settings.time_cap,
        )
        march.run(transits / settings.places)
    return march.solution(contact, time.perf_counter() - began)


def march_strip(
    strip: StripContact,
    lubricant: ContactLubricant,
    entrainment_speed: float,
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings = PRODUCTION,
) -> MovingSolution:
    """
    Let a rough raceway roll through a strip of a long contact and average over time.

    As `march_contact`, at an entrainment speed [m/s]. The raceway has to repeat with the width of
    the strip; the columns of the strip stand in for `settings.ny`, and of a domain only inlet and
    outlet count.

    """
    _check_transits(transits, settings)
    began = time.perf_counter()
    scaled = scale_strip(strip, lubricant, entrainment_speed, raceway)
    case = strip_case(scaled, settings.steady(settings.domain or marching_domain(scaled)))
    grid = case.grid(settings.nx, strip.columns, symmetric=False)
    with at(stage='rolling contact'):
        smooth, converged = smooth_strip(case, grid)
        march = _March(
            case=case,
            grid=grid,
            settings=settings,
            smooth=smooth if converged else None,
            deadline=began + settings.time_cap,
        )
        march.run(transits / settings.places)
    return march.solution(strip, time.perf_counter() - began)


def _check_transits(transits: float, settings: MarchSettings) -> None:
    if not transits >= LEAST_TRANSITS * settings.places:
        raise InputError(
            f'transits is {transits!r}, allowed is {LEAST_TRANSITS:g} or more at each of '
            f'{settings.places} places: a shorter strip has not been through the contact'
        )


def flat(x: Array, y: Array) -> Array:
    """Return heights of a raceway without roughness [m]: the solver of rough contacts, smooth."""
    return np.zeros(np.broadcast_shapes(x.shape, y.shape))


def marching_domain(scaled: ScaledContact) -> tuple[float, float, float]:
    """Return inlet, outlet and side over the semi-axes, with room for the highest summit."""
    a, b = scaled.semi_axis_x, scaled.semi_axis_y
    sample = raceway_heights(
        scaled.roughness, np.linspace(-4 * a, 4 * a, SAMPLE), np.linspace(-b, b, SAMPLE)
    )
    summit = float(sample.max() - sample.mean())
    everywhere = replace(scaled, roughness=lambda x, y: np.full(x.shape, summit))
    inlet, outlet, side = production_domain(everywhere, summit_reach=2.0)
    return min(inlet, -LEAST_INLET), outlet, max(side, LEAST_SIDE)


@dataclass(kw_only=True)
class _March:
    """A march under way: what has been measured at each place, and what it took."""

    case: ScaledCase
    grid: Grid
    settings: MarchSettings
    smooth: GridState | None
    deadline: float
    places: list[list[Measure]] = field(default_factory=list)
    last: Step | None = None
    steps: int = 0
    failed: int = 0
    newton: int = 0
    krylov: int = 0
    ended: MarchStatus | None = None

    def __post_init__(self) -> None:
        """Make the gauge."""
        self.gauge = Gauge(
            case=self.case, grid=self.grid, slide_roll_ratio=self.settings.slide_roll_ratio
        )

    def run(self, transits: float) -> None:
        """March so many transits at each place, until the march ends."""
        for place in range(self.settings.places if self.smooth else 0):
            self.places.append([])
            for step in self._track(place, transits):
                self.places[-1].append(self.gauge.measure(step))
            if self.ended is not None:
                return

    def _track(self, place: int, transits: float) -> Iterator[Step]:
        """Yield the steps at a place, less the run-in."""
        stepper = self._stepper()
        feed = Feed(
            case=self.case, grid=self.grid, place=self._place(place), ramp=self.settings.moving
        )
        run_in, length = RUN_IN / self.grid.dx, 2 * transits / self.grid.dx
        in_a_row = 0
        for moved in self._moves(run_in + length):
            step = stepper.step(feed.at(moved if self.settings.moving else 0))
            in_a_row = 0 if step.outcome.converged else in_a_row + 1
            self._count(step)
            if in_a_row == STALLED:
                self.ended = MarchStatus.STALLED
            elif time.perf_counter() > self.deadline:
                self.ended = MarchStatus.OUT_OF_TIME
            if self.ended is not None:
                return
            if moved > run_in:
                yield step

    def _moves(self, nodes: float) -> range:
        """Return by how many nodes the raceway has moved after each step."""
        stride = self.settings.stride
        return range(stride, round(nodes) + stride, stride)

    def _place(self, number: int) -> tuple[float, float]:
        """Return a place on the raceway [m], so far from the others that no track overlaps."""
        width = self.grid.y[-1] - self.grid.y[0]
        return 0.0, number * float(width) * self.case.semi_axis_x

    def _stepper(self) -> Stepper:
        settings = self.settings
        assert self.smooth is not None
        return Stepper(
            case=self.case,
            grid=self.grid,
            smooth=self.smooth,
            limits=step_limits(
                settings.flux_tolerance, settings.load_tolerance, settings.gap_tolerance
            ),
            stride=settings.stride,
            moving=settings.moving,
        )

    def _count(self, step: Step) -> None:
        self.last = step
        self.steps += 1
        self.failed += not step.outcome.converged
        self.newton += step.newton
        self.krylov += step.krylov

    def _status(self) -> MarchStatus:
        if self.smooth is None:
            return MarchStatus.NO_SMOOTH_FILM
        if self.ended is None and self.failed > FEW * self.steps:
            return MarchStatus.STALLED
        return self.ended or (MarchStatus.SOME_STEPS if self.failed else MarchStatus.CONVERGED)

    def solution(self, contact: Contact | StripContact, wall_time: float) -> MovingSolution:
        """Return the averages of what was measured, in whatever way the march ended."""
        case = self.case
        bare = MovingSolution(
            contact=contact,
            lubricant=case.lubricant,
            condition=case.condition,
            settings=self.settings,
            status=self._status(),
            steps=self.steps,
            steps_failed=self.failed,
            newton_iterations=self.newton,
            krylov_iterations=self.krylov,
            wall_time=wall_time,
        )
        return self._with_averages(bare) if any(self.places) else bare

    def _with_averages(self, bare: MovingSolution) -> MovingSolution:
        step_length = self.settings.stride * self.grid.dx
        found, smooth = average(self.places, step_length), self._smooth()
        assert self.last is not None
        state, case = self.last.outcome.state, self.case
        return replace(
            bare,
            **found.numbers,  # type: ignore[arg-type]
            thin_shares=found.thin_shares,
            x=self.grid.x,
            rcs_along=found.rcs_along,
            centre_films=np.array([one.centre_film for steps in self.places for one in steps]),
            memory=found.memory,
            transits=sum(map(len, self.places)) * step_length / 2,
            smooth_rolling_loss=smooth.rolling_loss,
            central_film=smooth.centre_film,
            x_nodes=self.grid.x * case.semi_axis_x,
            y_nodes=self.grid.y * case.semi_axis_x,
            film=self.last.outcome.gap * case.height_unit,
            pressure=(state.film_pressure + state.asperity_pressure) * case.hertz_pressure,
        )

    def _smooth(self) -> Measure:
        """Return the numbers of the smooth contact."""
        return self.gauge.measure(self._stepper().step(np.zeros(self.grid.shape)))
