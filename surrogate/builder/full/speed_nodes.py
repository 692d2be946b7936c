# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nodes of one axis where the interpolation needs them, found by halving intervals that fail."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class NodeSample:
    """Friction torque [N m] and RCS [-] at one place of the axis, or over another axis there."""

    torque: ArrayLike
    rcs: ArrayLike


@dataclass(frozen=True, slots=True)
class Target:
    """
    Allowed errors of efficiency and of RCS, absolute and relative where that is more [-].

    The efficiency is that against a load with the `ideal_torque` [N m].

    """

    ideal_torque: float
    efficiency: float
    rcs: float
    rcs_relative: float

    def worst(self, found: NodeSample, wanted: NodeSample) -> float:
        """Return the largest error of an interpolated sample over the allowed one, or NaN [-]."""
        share, wanted_share = np.asarray(found.rcs), np.asarray(wanted.rcs)
        allowed = np.maximum(self.rcs, self.rcs_relative * wanted_share)
        efficiency, wanted_efficiency = (
            self.ideal_torque / (self.ideal_torque + np.asarray(sample.torque))
            for sample in (found, wanted)
        )
        wrong = np.maximum(
            np.abs(efficiency - wanted_efficiency) / self.efficiency,
            np.abs(share - wanted_share) / allowed,
        )
        return float(np.max(wrong))


def refine_nodes(
    first: Array, solve: Callable[[Array], dict[float, NodeSample]], target: Target, most: int
) -> Array:
    """
    Return nodes of an axis, intervals halved until their middles are met or `most` are used.

    Those given at first stay, also where they are more. `solve` returns samples at places, NaN
    where it fails: there is no node but at those given.

    """
    if len(first) >= most:
        return np.asarray(first)
    known = solve(np.asarray(first))
    nodes = sorted(known)
    pending = list(zip(nodes, nodes[1:]))
    while pending and len(known) < most:
        middles = solve(np.array([0.5 * (low + high) for low, high in pending]))
        wrong = {
            place: target.worst(interpolate(known, place), sample)
            for place, sample in middles.items()
        }
        missed = [place for place in middles if wrong[place] > 1]
        room = most - len(known)
        taken = sorted(missed, key=lambda place: -wrong[place])[:room]
        known |= {place: middles[place] for place in taken}
        pending = [
            half
            for low, high in pending
            for middle in [0.5 * (low + high)]
            if middle in taken
            for half in ((low, middle), (middle, high))
        ]
    return np.array(sorted(known))


def interpolate(known: dict[float, NodeSample], place: float) -> NodeSample:
    """Return a sample between solved ones by the monotone cubic of a surface; NaN if too few."""
    places = sorted(place for place, sample in known.items() if _is_known(sample))
    if len(places) < 2:
        return NodeSample(np.nan, np.nan)
    torque, rcs = (
        PchipInterpolator(places, [getattr(known[p], name) for p in places])(place)
        for name in ('torque', 'rcs')
    )
    return NodeSample(torque, rcs)


def _is_known(sample: NodeSample) -> bool:
    return bool(np.isfinite(sample.torque).all() and np.isfinite(sample.rcs).all())
