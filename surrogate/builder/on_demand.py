# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve of one operating point on demand: the model behind one function.

What asks knows neither the solver nor its settings: it hands over what the header of a surface
says, and a point, and gets plain numbers back. A point is solved as the surface was, with the
same law of asperity contact, so that what both differ by is the error of the surface.

"""

from collections.abc import Callable, Mapping
from dataclasses import asdict
import resource
import time
from typing import Any

from surrogate.compiler import check
from surrogate.ehl.watch import Iteration, watched
from surrogate.files import InputError
from surrogate.parameters import OperatingPoint, screw_and_oil
from surrogate.screw import solve_screw
from surrogate.screw.opened import Contacts
from surrogate.screw.point import kept_point
from surrogate.surface import SolvedPoint
from surrogate.tasks.worker import cancelled, tell

CONTACTS = 4
"""Contacts of a point: both nuts with screw and nut [-]."""
PAUSE = 0.2
"""Shortest time between two steps that a worker tells [s]: nobody reads faster."""
Progress = Callable[[Mapping[str, Any]], None]


class Cancelled(Exception):
    """The solve was taken back."""


def solve_point(
    request: Mapping[str, Any],
    *,
    progress: Progress = lambda step: None,
    cancel: Callable[[], bool] = lambda: False,
) -> SolvedPoint:
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
        return kept_point(solve_screw(Contacts.of(screw), oil, point))


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


def solve(request: Mapping[str, Any]) -> dict[str, Any]:
    """
    Solve the point of a request in a worker, which tells its steps and may be asked to end.

    The result is a `SolvedPoint` as plain JSON. Raises InputError where memory runs out, and where
    the solver cannot be compiled.

    """
    last = -PAUSE

    def report(step: Mapping[str, Any]) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= PAUSE:
            last = now
            tell(step)

    try:
        check()
        return asdict(solve_point(request, progress=report, cancel=cancelled.is_set))
    except ImportError as error:
        raise InputError(
            f'a full solve needs numba: {error}: pip install numba where the node runs'
        ) from None
    except MemoryError:
        most = resource.getrlimit(resource.RLIMIT_DATA)[0]
        raise InputError(f'the solve needs more than {most / 2**30:g} GiB of memory') from None
