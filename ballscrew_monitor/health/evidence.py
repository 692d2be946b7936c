# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Evidence of all days that an axis has left its baseline.

The last week, the last two, four and so on are held against all days before them: a change that
came fast shows in the short ones, a slow one in the long ones, which average more days. The
pattern of a cause finds what the mean hides: lost preload takes most from the friction at low
speed, where another warmth does the opposite.

"""

from collections.abc import Sequence
import math
from typing import NamedTuple

from ballscrew_monitor.health.causes import (
    birge,
    Candidate,
    CANDIDATES,
    FEWEST_GROUPS,
    STEPS,
    vertex,
)
from ballscrew_monitor.health.change import Change, Days
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CERTAIN = 12.0
"""
Fall of chi squared from which a change is certain [-].

A normal change falls by that much with a probability of 0.0005 for each cause.

"""


class Gain(NamedTuple):
    """Number of the cause that fits best, and the fall of chi squared against no change."""

    cause: int
    fall: float


def is_certain(days: Days, recent: Change, model: Model, tolerance: float) -> bool:
    """
    Tell whether a cause explains a change of some last days, and no change does not.

    The recent days must still differ from the baseline by a mean above a `tolerance` [-] with it.

    """
    tables = tables_of(days.points, model)
    number = {group: at for at, group in enumerate(days.groups)}
    lately = [number[group] for group in recent.groups]
    for change in days.splits():
        chosen = [number[group] for group in change.groups]
        gain = gain_of(change, [table[:, chosen] for table in tables])
        if gain.fall > CERTAIN:
            table = tables[gain.cause][:, lately]
            pattern = np.abs(table[_least(recent, table)[0]])
            if float(pattern.sum()) > tolerance * float(recent.friction.sum()):
                return True
    return False


def tables_of(points: Sequence[ComparablePoint], model: Model) -> list[Array]:
    """Return the patterns of each cause at points [N m], a row for each size that is tried."""
    return [_table(one, points, model) for one in CANDIDATES]


def gain_of(change: Change, tables: Sequence[Array]) -> Gain:
    """Return the best cause of a change and what it gains; 0 at too few places."""
    chis = [_least(change, table)[1] for table in tables]
    if len(change.groups) < FEWEST_GROUPS or not np.isfinite(chis).any():
        return Gain(0, 0.0)
    best = int(np.nanargmin(chis))
    nothing = float(change.change @ np.linalg.inv(change.covariance) @ change.change)
    return Gain(best, (nothing - chis[best]) / birge(chis[best], len(change.groups)))


def _table(candidate: Candidate, points: Sequence[ComparablePoint], model: Model) -> Array:
    sizes = np.linspace(candidate.low, candidate.high, STEPS).tolist()
    return np.array([candidate.pattern(model, points, size) for size in sizes])


def _least(change: Change, table: Array) -> tuple[int, float]:
    """Return the row of the least chi squared, and that at the vertex beside it."""
    apart = change.change - table
    chis = np.einsum('ij,jk,ik->i', apart, np.linalg.inv(change.covariance), apart)
    if not np.isfinite(chis).any():
        return 0, math.nan
    at = int(np.nanargmin(chis))
    return at, vertex(np.arange(len(chis), dtype=float), chis, at)[1]
