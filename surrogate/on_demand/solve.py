# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve of one operating point on demand: the model behind one function.

What asks knows neither the solver nor its settings: it hands over what the header of a surface
says, and a point, and gets plain numbers back. A point is solved as the surface was, with the
same law of asperity contact, so that what both differ by is the error of the surface.

"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
import math
from typing import Any

from surrogate.builder.full.chain import solved_point
from surrogate.ehl.watch import Iteration, watched
from surrogate.parameters import OperatingPoint, screw_and_oil
from surrogate.screw import solve_screw
from surrogate.surface import FIELDS, SolvedPoint

CONTACTS = 4
"""Contacts of a point: both nuts with screw and nut [-]."""
Progress = Callable[[Mapping[str, Any]], None]


class Cancelled(Exception):
    """The solve was taken back."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PointOnDemand:
    """
    A solved point: values, deviations and standard errors of the fields of a surface [SI].

    Deviations are those between strips of the raceway. `worst_contact` numbers the contact as a
    surface does, -1 without contact. Numbers are NaN unless `converged`; `status` says why.

    """

    converged: bool
    status: str
    worst_contact: int = -1
    means: Mapping[str, float] = field(default_factory=dict)
    deviations: Mapping[str, float] = field(default_factory=dict)
    standard_errors: Mapping[str, float] = field(default_factory=dict)


def solve_point(
    request: Mapping[str, Any],
    *,
    progress: Progress = lambda step: None,
    cancel: Callable[[], bool] = lambda: False,
) -> PointOnDemand:
    """
    Solve the point of a request by the full tier.

    `request` holds the `header` of a surface and the `point` with speed [rad/s], opposing load [N]
    and temperature [K]. Each iteration calls `progress` and asks `cancel`,
    which ends the solve with `Cancelled`. Raises InputError for inputs that no screw has.

    """
    header, place = request['header'], request['point']
    point = OperatingPoint(
        speed=float(place['speed']),
        load=float(place['opposing_load']),
        temperature=float(place['temperature']),
    )
    screw, oil = screw_and_oil(header['inputs'])
    with watched(_Watcher(progress, cancel)):
        found = solve_screw(screw, oil, point)
    return _answer(solved_point(found))


def _answer(found: SolvedPoint) -> PointOnDemand:
    if not found.converged:
        return PointOnDemand(converged=False, status=found.status)
    nothing = dict.fromkeys(FIELDS, math.nan)
    return PointOnDemand(
        converged=True,
        status=found.status,
        worst_contact=found.worst_contact,
        means={name: getattr(found, name) for name in FIELDS},
        deviations=nothing | {'rcs': found.rcs_deviation},
        standard_errors=nothing | {'rcs': found.rcs_deviation},
    )


class _Watcher:
    """Turns iterations into steps with the part that is done."""

    def __init__(self, progress: Progress, cancel: Callable[[], bool]) -> None:
        self._progress, self._cancel = progress, cancel
        self._begun: list[tuple[int, int]] = []

    def __call__(self, now: Iteration) -> None:
        if self._cancel():
            raise Cancelled
        if (now.nut, now.side) not in self._begun:
            self._begun.append((now.nut, now.side))
        self._progress(
            {
                'stage': now.stage,
                'nut': now.nut,
                'side': now.side,
                'iteration': now.count,
                'residual': now.residual,
                'fraction': (len(self._begun) - 1) / CONTACTS,
            }
        )


def solved_frame(found: PointOnDemand) -> dict[str, Any]:
    """Return a solved point as plain JSON."""
    return {
        'converged': found.converged,
        'status': found.status,
        'worst_contact': found.worst_contact,
        'means': dict(found.means),
        'deviations': dict(found.deviations),
        'standard_errors': dict(found.standard_errors),
    }
