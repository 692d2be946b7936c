# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve of one operating point on demand: the model behind one function.

What asks knows neither the solver nor its settings: it hands over what the header of a surface
says, and a point, and gets plain numbers back. Unless a number of draws is asked for, a point is
solved as the surface was: with its draws and weights, so that what both differ by is the error of
the surface and not of the draws. With a number of draws it is solved as `ballscrew point` does.

"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from surrogate.builder.full.chain import chain_inputs, solve_chain, solved_chain, solved_point
from surrogate.builder.full.draws import deviation, WeightedDraws
from surrogate.builder.full.tier import drawn
from surrogate.builder.tiers import screw_and_oil
from surrogate.ehl.watch import Iteration, watched
from surrogate.parameters import OperatingPoint
from surrogate.screw import ScrewSettings, solve_screw
from surrogate.screw.contacts import GRID_WAVELENGTH
from surrogate.screw.solve import TIER
from surrogate.surface import FIELDS, SolvedPoint

DEFAULT_DRAWS = 4
"""Draws of a point of a surface that has none of its own [-]."""
ROUGH, NUTS_AND_SIDES = 'rough contact', 4
Progress = Callable[[Mapping[str, Any]], None]


class Cancelled(Exception):
    """The solve was taken back."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PointOverDraws:
    """
    A point over its draws: means, deviations and standard errors of the fields of a surface [SI].

    `worst_contact` numbers the contact as a surface does, -1 without contact. Numbers are NaN
    unless `converged`; `status` says why.

    """

    converged: bool
    status: str
    draws: int
    worst_contact: int = -1
    means: Mapping[str, float] = field(default_factory=dict)
    deviations: Mapping[str, float] = field(default_factory=dict)
    standard_errors: Mapping[str, float] = field(default_factory=dict)


def solve_point(
    request: Mapping[str, Any],
    *,
    progress: Progress = lambda step: None,
    cancel: Callable[[], bool] = lambda: False,
) -> PointOverDraws:
    """
    Solve the point of a request by the full tier.

    `request` holds the `header` of a surface, the `point` with speed [rad/s], opposing load [N]
    and temperature [K], and the number of `draws`, 0 for those of the surface. `progress` is told
    of each iteration; `cancel` is asked at each, and ends the solve with `Cancelled`. Raises
    InputError for inputs that no screw has.

    """
    header, place, count = request['header'], request['point'], int(request['draws'])
    point = OperatingPoint(
        speed=float(place['speed']),
        load=float(place['opposing_load']),
        temperature=float(place['temperature']),
    )
    own = not count and header['tier'] == TIER
    draws = drawn(header) if own else WeightedDraws(count or DEFAULT_DRAWS)
    solve = _as_built if own else _as_a_point
    watcher = _Watcher(draws.at(point.load), progress, cancel)
    found: list[SolvedPoint] = []
    with watched(watcher):
        for draw in range(watcher.draws):
            watcher.draw = draw
            found.append(solve(header, point, draw))
    return _combined(found, draws, point.load)


def _as_built(header: Mapping[str, Any], point: OperatingPoint, draw: int) -> SolvedPoint:
    """Solve one draw as it was solved for the surface."""
    screw, oil = screw_and_oil(header['inputs'])
    wavelength = header['settings'].get('grid_wavelength', GRID_WAVELENGTH)
    chain = chain_inputs(
        screw, oil, abs(point.load), point.temperature, draw, [point.speed], wavelength
    )
    return solved_chain(solve_chain(chain)).under(point.load)[0]


def _as_a_point(header: Mapping[str, Any], point: OperatingPoint, draw: int) -> SolvedPoint:
    """Solve one draw as a point by itself."""
    screw, oil = screw_and_oil(header['inputs'])
    settings = replace(ScrewSettings(), draw=draw)
    return solved_point(solve_screw(screw, oil, point, settings=settings))


def _combined(found: Sequence[SolvedPoint], draws: WeightedDraws, load: float) -> PointOverDraws:
    """Return the numbers of a point over its draws; one that failed fails the point."""
    failed = [one.status for one in found if not one.converged]
    if failed:
        return PointOverDraws(converged=False, status=failed[0], draws=len(found))
    values = np.array([[getattr(one, name) for one in found] for name in FIELDS])
    weights = draws.weights(values, np.full(len(FIELDS), load))
    groups = (
        np.sum(weights * values, axis=-1),
        deviation(values, weights),
        draws.standard_error(values, weights),
    )
    means, deviations, errors = (dict(zip(FIELDS, group.tolist())) for group in groups)
    return PointOverDraws(
        converged=True,
        status=found[0].status,
        draws=len(found),
        worst_contact=found[0].worst_contact,
        means=means,
        deviations=deviations,
        standard_errors=errors,
    )


class _Watcher:
    """Turns iterations into steps with the part that is done."""

    def __init__(self, draws: int, progress: Progress, cancel: Callable[[], bool]) -> None:
        self.draws, self.draw = draws, 0
        self._progress, self._cancel = progress, cancel
        self._begun: list[tuple[str, int, int]] = []
        self._of_draw = -1

    def __call__(self, now: Iteration) -> None:
        if self._cancel():
            raise Cancelled
        if self._of_draw != self.draw:
            self._of_draw, self._begun = self.draw, []
        here = (now.stage, now.nut, now.side)
        if here not in self._begun:
            self._begun.append(here)
        self._progress(
            {
                'stage': f'draw {self.draw + 1} of {self.draws}, {now.stage}',
                'nut': now.nut,
                'side': now.side,
                'iteration': now.count,
                'residual': now.residual,
                'fraction': (self.draw + self._share()) / self.draws,
            }
        )

    def _share(self) -> float:
        """Return the part of this draw that is done [-], by its rough contacts: they take long."""
        return sum(stage == ROUGH for stage, _, _ in self._begun[:-1]) / NUTS_AND_SIDES


def solved_frame(found: PointOverDraws) -> dict[str, Any]:
    """Return a solved point as plain JSON."""
    return {
        'converged': found.converged,
        'status': found.status,
        'draws': found.draws,
        'worst_contact': found.worst_contact,
        'means': dict(found.means),
        'deviations': dict(found.deviations),
        'standard_errors': dict(found.standard_errors),
    }
