# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Loads of a full-tier surface: zero, the load at which the relieved nut becomes idle, and others.

At that load torque and RCS jump, because the balls of the relieved nut are no longer solved; so a
node lies on either side of it, and some crowd below, where the contacts of that nut shrink to
nothing. Loads between are where interpolation over the load fails, seen on chains of few draws.
Loads of either sign share their chains: all here are magnitudes but the nodes of the file.

"""

from collections.abc import Callable
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.full.columns import BESIDE
from surrogate.builder.full.settings import FullSettings
from surrogate.builder.full.speed_nodes import NodeSample, refine_nodes, Target
from surrogate.formulas.load_sharing import idle_load
from surrogate.parameters import Screw

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LoadPieces:
    """Magnitudes [N] between which fields are smooth: below and above the idle load."""

    shared: Array
    alone: Array

    @property
    def magnitudes(self) -> Array:
        """Return all magnitudes, rising."""
        return np.union1d(self.shared, self.alone)

    def with_more(self, loads: Array) -> 'LoadPieces':
        """Return the pieces with more magnitudes [N], each in the piece that it lies within."""
        ends = self.shared[-1] if self.shared.size else -math.inf
        return LoadPieces(
            np.union1d(self.shared, loads[loads < ends]),
            np.union1d(self.alone, loads[loads >= ends]),
        )


def first_loads(screw: Screw, settings: FullSettings) -> LoadPieces:
    """Return the magnitudes that refinement begins with."""
    low, high = settings.load_range
    least = 0.0 if low <= 0 <= high else min(abs(low), abs(high))
    most, idle = max(abs(low), abs(high)), idle_load(screw)
    ends = [abs(end) for end in (low, high) if least < abs(end) < most]
    below, above = (1 - BESIDE) * idle, (1 + BESIDE) * idle
    shared = alone = np.empty(0)
    if least < below:
        shared = np.linspace(least, below if most > above else most, settings.load_cells + 1)
        if most > above:
            shared = np.union1d(shared, _towards(shared, settings.idle_halvings))
    if most > above or least >= below:
        cells = settings.unloaded_cells if below > 0 else settings.load_cells
        alone = np.linspace(above if least < below else least, most, cells + 1)
    return LoadPieces(
        np.union1d(shared, [end for end in ends if end <= below]),
        np.union1d(alone, [end for end in ends if end >= above]),
    )


def _towards(loads: Array, times: int) -> Array:
    """Return loads [N] that halve `times` what is left from the last but one to the last."""
    return np.asarray(loads[-1] - (loads[-1] - loads[-2]) * 0.5 ** np.arange(1, times + 1))


def refine_loads(
    first: LoadPieces, solve: Callable[[Array], dict[float, NodeSample]], target: Target, most: int
) -> LoadPieces:
    """
    Return magnitudes with more of them where `solve`, which returns profiles, differs.

    At most `most`; of these no more than a third are above the idle load, where fields are smooth,
    unless there were more at first.

    """
    alone = max(most // 3, len(first.alone))
    rooms = {'shared': most - alone, 'alone': alone}
    pieces = {
        name: refine_nodes(getattr(first, name), solve, target, room)
        if len(getattr(first, name)) > 1
        else getattr(first, name)
        for name, room in rooms.items()
    }
    return LoadPieces(**pieces)


def signed_loads(
    screw: Screw, settings: FullSettings, pieces: LoadPieces
) -> tuple[Array, list[float]]:
    """Return the load nodes [N] of either sign within the range, and the breaks among them."""
    low, high = settings.load_range
    nodes = np.union1d(-pieces.magnitudes, pieces.magnitudes) + 0.0
    nodes = nodes[(nodes >= low) & (nodes <= high)]
    beside = [(1 + side) * idle_load(screw) for side in (-BESIDE, BESIDE)]
    breaks = [
        float(load)
        for load in nodes
        if load == 0 or any(math.isclose(abs(load), edge, rel_tol=1e-9) for edge in beside)
    ]
    return nodes, breaks
