# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve of one operating point on demand: the model behind one function.

What asks knows neither the solver nor its settings: it hands over the inputs of a surface, as its
header has them, and a point, and gets plain numbers back.

"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from surrogate.builder.tiers import screw_and_oil
from surrogate.ehl.watch import Iteration, watched
from surrogate.parameters import OperatingPoint
from surrogate.screw import ScrewSettings, ScrewSolution, solve_screw
from surrogate.screw.ensemble import spread
from surrogate.surface import FIELDS

WEIGHTS = {'smooth contact': 1.0, 'rough contact': 3.0}
"""About how long the solves of a contact take, one over the other [-]."""
CONTACTS = 4
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
    Solve the point of a request by the full tier, for as many draws as it asks for.

    `request` holds the `inputs` of a surface, the `point` with speed [rad/s], opposing load [N]
    and temperature [K], and `draws`. `progress` is told of each iteration; `cancel` is asked at
    each, and ends the solve with `Cancelled`. Raises InputError for inputs that no screw has.

    """
    screw, oil = screw_and_oil(request['inputs'])
    place, draws = request['point'], int(request['draws'])
    point = OperatingPoint(
        speed=float(place['speed']),
        load=float(place['opposing_load']),
        temperature=float(place['temperature']),
    )
    watcher, settings, found = _Watcher(draws, progress, cancel), ScrewSettings(), []
    with watched(watcher):
        for draw in range(draws):
            watcher.draw = draw
            found.append(solve_screw(screw, oil, point, settings=replace(settings, draw=draw)))
            if not found[-1].converged:
                return PointOverDraws(converged=False, status=found[-1].status, draws=draws)
    return _combined(found)


def _combined(found: list[ScrewSolution]) -> PointOverDraws:
    """Return the numbers of a point over its draws."""
    spreads = {name: spread([getattr(one, name) for one in found]) for name in FIELDS}
    return PointOverDraws(
        converged=True,
        status=found[0].status,
        draws=len(found),
        worst_contact=found[0].worst_contact,
        means={name: one.mean for name, one in spreads.items()},
        deviations={name: one.deviation for name, one in spreads.items()},
        standard_errors={name: one.error for name, one in spreads.items()},
    )


class _Watcher:
    """Turns iterations into steps with the part that is done."""

    def __init__(self, draws: int, progress: Progress, cancel: Callable[[], bool]) -> None:
        self._total = draws * CONTACTS * sum(WEIGHTS.values())
        self._progress, self._cancel = progress, cancel
        self._begun: list[tuple[int, str, int, int]] = []
        self.draw = 0

    def __call__(self, now: Iteration) -> None:
        if self._cancel():
            raise Cancelled
        here = (self.draw, now.stage, now.nut, now.side)
        if here not in self._begun:
            self._begun.append(here)
        self._progress(
            {
                'stage': f'{now.stage}, draw {self.draw + 1}',
                'nut': now.nut,
                'side': now.side,
                'iteration': now.count,
                'residual': now.residual,
                'fraction': self._fraction(),
            }
        )

    def _fraction(self) -> float:
        """Return the part that is done [-]; contacts that are solved again count once."""
        done = sum(WEIGHTS.get(stage, 0.0) for _, stage, _, _ in self._begun[:-1])
        return min(done / self._total, 1.0)


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
