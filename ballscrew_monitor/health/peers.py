# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Axes beside each other: one screw and one programme should take one friction torque.

An axis whose baseline was learned when it was already worse, or drifted with it, looks normal
against itself. Beside its peers it does not.

"""

from collections.abc import Mapping
import dataclasses
import math
import statistics
from typing import Any

from ballscrew_monitor.health.history import effects_of, history_of
from ballscrew_monitor.health.records import Quantity, TOLERANCE
from ballscrew_monitor.health.words import percent
import numpy as np
from numpy.typing import NDArray

FEWEST_PEERS = 2
"""Other axes with which one axis is compared: with a single one, either may have changed."""
LATEST = 4
"""Logs of an axis that count as now."""
LEAST_COMMON = 0.5
"""Share of the groups of an axis that a peer has, too, from which on they compare."""
OWN_DOUBT = 0.02
"""Standard deviation of the friction of an axis from log to log, at least [-]."""
NAME = 'friction beside peers'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Peer:
    """
    An axis among its peers.

    `difference` [-] of its friction torque from the median of theirs; `range_of_peers` [-] is the
    largest difference between two of them; `is_apart` where the interval lies beyond that range
    and beyond what counts as normal.

    """

    axis: str
    difference: Quantity
    peers: int
    range_of_peers: float
    is_apart: bool

    @property
    def text(self) -> str:
        """Return the difference in a sentence."""
        among = 'beyond what these' if self.is_apart else 'no more than these'
        return (
            f'Axis {self.axis}: its friction torque differs by {percent(self.difference)} from '
            f'that of {self.peers} axes with the same programme, {among} differ by.'
        )


def ranked(cells: Mapping[str, NDArray[Any]], lead: float) -> list[Peer]:
    """
    Return axes with at least two peers, the one that differs most first.

    `cells` are those of the logs by axis, arrays of CELL, all of one screw with a `lead` [m].

    """
    levels = {axis: level for axis, own in cells.items() if (level := _level(own, lead))}
    peers = [_peer(axis, levels) for axis in levels]
    known = [one for one in peers if one is not None]
    return sorted(known, key=lambda one: (not one.is_apart, -abs(one.difference.value)))


def _level(cells: NDArray[Any], lead: float) -> dict[Any, float]:
    """Return ln(friction) of the latest logs by group, at one temperature for all axes."""
    history = history_of(cells, lead)
    if history is None:
        return {}
    effects = effects_of(history)
    now = float(np.mean(effects.logs.effect[-LATEST:]))
    seen = (history.weight[-LATEST:].sum(axis=0) > 0.0).tolist()
    pairs = zip(history.groups, effects.groups, seen, strict=True)
    return {group: float(level) + now for group, level, known in pairs if known}


def _difference(own: Mapping[Any, float], other: Mapping[Any, float]) -> float:
    """Return the mean difference of ln(friction) in common groups [-], NaN for too few."""
    common = [group for group in own if group in other]
    if len(common) < LEAST_COMMON * len(own):
        return math.nan
    return statistics.mean(own[group] - other[group] for group in common)


def _peer(axis: str, levels: Mapping[str, Mapping[Any, float]]) -> Peer | None:
    others = {
        peer: difference
        for peer in levels
        if peer != axis and math.isfinite(difference := _difference(levels[axis], levels[peer]))
    }
    if len(others) < FEWEST_PEERS:
        return None
    apart = (abs(value - other) for value in others.values() for other in others.values())
    spread = max(apart)
    value = statistics.median(others.values())
    reach = 1.96 * OWN_DOUBT * math.sqrt(1.0 + 1.0 / len(others))
    return Peer(
        axis=axis,
        difference=Quantity(
            name=NAME,
            value=math.expm1(value),
            low=math.expm1(value - reach),
            high=math.expm1(value + reach),
            evidence=f'{len(levels[axis])} places, the last {LATEST} logs',
        ),
        peers=len(others),
        range_of_peers=math.expm1(spread),
        is_apart=abs(value) - reach > max(TOLERANCE, spread),
    )
