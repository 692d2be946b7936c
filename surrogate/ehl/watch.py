# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Watcher of a solve: it sees every iteration and can end the solve by an exception.

A solve is many levels deep and its results must not depend on who looks on, so the watcher is not
an argument of each of them: it belongs to the context in which a solve is called.

"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
import math


@dataclass(frozen=True, kw_only=True, slots=True)
class Iteration:
    """
    Where a solve is.

    Stage in words; nut 1 loaded, 2 relieved; side 1 screw, 2 nut; 0 none; count of the Newton
    iteration on the grid at work and its relative residual [-]. Between the steps of a march, how
    many are made, of how many; else 0.

    """

    stage: str = ''
    nut: int = 0
    side: int = 0
    count: int = 0
    residual: float = math.nan
    step: int = 0
    steps: int = 0


Watcher = Callable[[Iteration], None]
_WATCHER: ContextVar[Watcher | None] = ContextVar('watcher', default=None)
NOWHERE = Iteration()
_PLACE: ContextVar[Iteration] = ContextVar('place', default=NOWHERE)


@contextmanager
def watched(watcher: Watcher) -> Iterator[None]:
    """Call `watcher` at every iteration of the solves in this context."""
    token = _WATCHER.set(watcher)
    try:
        yield
    finally:
        _WATCHER.reset(token)


@contextmanager
def at(
    *,
    stage: str | None = None,
    nut: int | None = None,
    side: int | None = None,
    step: int | None = None,
    steps: int | None = None,
) -> Iterator[None]:
    """Say where the solves in this context are."""
    here = {'stage': stage, 'nut': nut, 'side': side, 'step': step, 'steps': steps}
    known = {name: value for name, value in here.items() if value is not None}
    token = _PLACE.set(replace(_PLACE.get(), **known))  # type: ignore[arg-type]
    try:
        yield
    finally:
        _PLACE.reset(token)


def tell(count: int, residual: float) -> None:
    """Tell the watcher, if there is one, of an iteration and its relative residual [-]."""
    watcher = _WATCHER.get()
    if watcher is not None:
        watcher(replace(_PLACE.get(), count=count, residual=residual))
