# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Axes beside each other: one screw and one programme should take one friction torque.

An axis whose baseline was learned when it was already worse, or drifted with it, looks normal
against itself. Beside its peers it does not.

"""

from collections.abc import Mapping, Sequence
import dataclasses
from itertools import permutations
import statistics

from ballscrew_monitor.health.assess import TOLERANCE
from ballscrew_monitor.health.change import Change, change_between
from ballscrew_monitor.health.energy import student
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint, Quantity
from ballscrew_monitor.health.words import percent
from surrogate.surface import Surface

FEWEST_PEERS = 2
"""Other axes with which one axis is compared: with a single one, either may have changed."""
LEAST_COMMON = 0.5
"""Share of the stretches of an axis at places that a peer has, too, from which on they compare."""
NAME = 'friction beside peers'

Pairs = Mapping[tuple[str, str], Change]


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


def ranked(points: Mapping[str, Sequence[ComparablePoint]], surface: Surface) -> list[Peer]:
    """
    Return axes with at least two peers, the one that differs most first.

    `points` of equal days by axis, all of the screw of `surface`.

    """
    pairs = {
        (peer, axis): change
        for peer, axis in permutations(points, 2)
        if (change := _compared(points[peer], points[axis], surface)) is not None
    }
    peers = (_peer(axis, pairs) for axis in points)
    known = [one for one in peers if one is not None]
    return sorted(known, key=lambda one: (not one.is_apart, -abs(one.difference.value)))


def _compared(
    peer: Sequence[ComparablePoint], axis: Sequence[ComparablePoint], surface: Surface
) -> Change | None:
    """Return how an axis differs from a peer, None where programmes have little in common."""
    change = change_between(peer, axis, Model(surface))
    total = sum(one.stretches for one in axis)
    return None if change is None or change.stretches < LEAST_COMMON * total else change


def _peer(axis: str, pairs: Pairs) -> Peer | None:
    own = {peer: change for (peer, other), change in pairs.items() if other == axis}
    if len(own) < FEWEST_PEERS:
        return None
    among = [
        abs(change.common) for (one, other), change in pairs.items() if {one, other} <= own.keys()
    ]
    value = statistics.median(change.common for change in own.values())
    reach = max(student(change.freedom) * change.deviation for change in own.values())
    spread = max(among, default=0.0)
    return Peer(
        axis=axis,
        difference=Quantity(
            name=NAME,
            value=value,
            low=value - reach,
            high=value + reach,
            evidence=f'{sum(one.stretches for one in own.values())} stretches at common places',
        ),
        peers=len(own),
        range_of_peers=spread,
        is_apart=abs(value) - reach > max(TOLERANCE, spread),
    )
