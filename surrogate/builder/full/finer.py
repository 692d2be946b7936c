# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
More nodes where a held-out point is missed: the axis that is to blame, and the middle of its cell.

To blame is the axis along which the surface moves at the point when one of the nodes beside it is
left out, by more than the point is missed: with intervals of twice the length errors are four
times as large and more. That takes no solve. Failing that it is an axis that cannot be tested so,
as both nodes are ends or breaks. Where no axis is to blame, as with few draws in hot and cold oil,
nodes would not help.

"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.full.held_out import HeldOut, HeldOutPlace, judged
from surrogate.builder.full.speed_nodes import NodeSample, Target
from surrogate.surface import Surface
from surrogate.surface.file import SurfaceData

Array = NDArray[np.float64]
Places = NDArray[np.intp]
Kind = TypeVar('Kind', bound=np.generic)

AXES = ('speed', 'load')
"""Axes that get more nodes, in the order of a cell."""
NARROWEST = 1e-3
"""Narrowest interval that is halved, over the range of its axis [-]."""


@dataclass(frozen=True, slots=True)
class Room:
    """How many nodes there may still be along the speed and of magnitudes of the load [-]."""

    speeds: int
    loads: int


def nodes_for_misses(
    data: SurfaceData, held_out: Sequence[HeldOut], target: Target, lead: float, room: Room
) -> tuple[Array, Array]:
    """
    Return speed coordinates [-] and magnitudes of the load [N] that misses ask for.

    The worst come first, as long as there is `room`; two in one interval ask for one node.

    """
    asked: dict[str, list[float]] = {'speed': [], 'load': []}
    left = {'speed': room.speeds, 'load': room.loads}
    for one in sorted(held_out, key=lambda one: -one.miss):
        axis = _to_blame(data, one, judged(target, one.point[1], lead)) if one.miss > 1 else None
        if axis is None:
            continue
        nodes, place = _axis(data, axis), one.cell[AXES.index(axis)]
        low, high = nodes[[place, place + 1]].tolist()
        middle = 0.5 * (low + high) if axis == 'speed' else abs(0.5 * (low + high))
        wide = high - low > NARROWEST * (nodes[-1] - nodes[0])
        if wide and middle not in asked[axis] and len(asked[axis]) < left[axis]:
            asked[axis].append(middle)
    return np.array(asked['speed']), np.array(asked['load'])


def _to_blame(data: SurfaceData, one: HeldOut, target: Target) -> str | None:
    """
    Return the axis along which a node less moves the surface by more than a miss, if any.

    Failing that, the first of which nothing is known.

    """
    whole = _sample(data, one.point)
    moved = {
        axis: [
            change
            for less in _lacking(data, one, axis)
            for change in [target.worst(_sample(less, one.point), whole)]
            if math.isfinite(change)
        ]
        for axis in AXES
        if not _is_jump(data, one, axis)
    }
    worst = max(moved, key=lambda axis: max(moved[axis], default=0.0))
    if max(moved[worst], default=0.0) > one.miss:
        return worst
    return next((axis for axis, changes in moved.items() if not changes), None)


def _is_jump(data: SurfaceData, one: HeldOut, axis: str) -> bool:
    """Tell whether a cell is that across the idle load, between two breaks of one sign."""
    ends = data.load[[one.cell[1], one.cell[1] + 1]]
    breaks = np.isin(ends, data.header['load_breaks'])
    return bool(axis == 'load' and breaks.all() and (ends != 0).all() and ends.prod() > 0)


def _lacking(data: SurfaceData, one: HeldOut, axis: str) -> Iterator[SurfaceData]:
    """Yield surfaces without one of the nodes beside a point, but for ends and breaks."""
    place = one.cell[AXES.index(axis)]
    fixed = [0, len(_axis(data, axis)) - 1]
    if axis == 'load':
        fixed += np.flatnonzero(np.isin(data.load, data.header['load_breaks'])).tolist()
    for left_out in sorted({place, place + 1} - set(fixed)):
        kept = [
            np.setdiff1d(np.arange(len(_axis(data, name))), left_out if name == axis else [])
            for name in AXES
        ]
        yield with_nodes(data, *kept)


def _axis(data: SurfaceData, axis: str) -> Array:
    return data.speed_coordinate if axis == 'speed' else data.load


def _sample(data: SurfaceData, point: HeldOutPlace) -> NodeSample:
    found = Surface(data).lookup(*point)
    return NodeSample(found.friction_torque, found.rcs)


def with_nodes(data: SurfaceData, speeds: Places, loads: Places) -> SurfaceData:
    """Return a surface with only these nodes of its own along speed and load, errors unknown."""
    cells = (len(speeds) - 1, len(loads) - 1, len(data.temperature) - 1)

    def part(values: NDArray[Kind]) -> NDArray[Kind]:
        return values[np.ix_(speeds, loads)]

    return replace(
        data,
        speed_coordinate=data.speed_coordinate[speeds],
        load=data.load[loads],
        log_onset=data.log_onset[loads],
        fields={name: part(values) for name, values in data.fields.items()},
        errors={name: np.full(cells, np.nan) for name in data.errors},
        worst_contact=part(data.worst_contact),
        mask=part(data.mask),
        deviations={name: part(values) for name, values in data.deviations.items()},
        standard_errors={name: part(values) for name, values in data.standard_errors.items()},
    )
