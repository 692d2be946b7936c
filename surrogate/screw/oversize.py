# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A nut with oversize balls: four contacts of each ball, solved, and the balance of the ball.

The balls are too large for the room between screw and nut and press both flanks of each. An axial
load presses one diagonal pair of flanks, as it does the loaded one of two nuts, and relieves the
other. The ball has one motion for both pairs, so that all flanks spin; where friction lifts the
ball off a flank of the lighter pair, it rests on three.

"""

from collections.abc import Sequence

from surrogate.formulas.load_sharing import IDLE_SHARE, normal_force
from surrogate.parameters import OperatingPoint, Screw
from surrogate.screw.ball_balance import balance_four_points
from surrogate.screw.contacts import RollingContact, solve_sides, SolvedContact
from surrogate.screw.nut import (
    balanced_nut,
    contact_failure,
    CREEP,
    flanks_of,
    FLOATING_SHARE,
    load_change,
    NutLoad,
    SolvedNut,
)

LIGHT_SHARE = 0.05
"""Least normal force of the lighter pair over that of the other under which its contacts are first
solved [-]: friction alone presses the ball by about as much."""

DAMPINGS = (1.0, 1.0, 0.5, 0.5, 0.5, 0.5)
"""Steps from the solved normal forces to those of the balance, in logarithms [-]: the force of a
light flank may come back from a whole one."""

Pair = Sequence[SolvedContact | None]


def solve_oversize(
    screw: Screw,
    point: OperatingPoint,
    carried: Sequence[NutLoad],
    contacts: Sequence[RollingContact],
    pairs: Sequence[Pair],
    *,
    tolerance: float,
) -> list[SolvedNut]:
    """
    Balance the ball of a nut with oversize balls between its pairs of solved contacts.

    Friction and inertia move the normal forces; where by more than the `tolerance` [-], contacts
    are solved again under the forces found, until they agree or all `DAMPINGS` are used.

    """
    light = carried[1].force < FLOATING_SHARE * carried[0].force
    if light and contact_failure(carried[1].nut, pairs[1]):
        pairs = pairs[0], (None, None)
    nuts = make_oversize(screw, point, carried, pairs)
    for damping in DAMPINGS:
        if not max(load_change(nut) for nut in nuts) > tolerance:
            break
        again: list[Pair] = []
        for nut, pair in zip(nuts, pairs, strict=True):
            loads = [before.pressed.condition.load for before in pair if before is not None]
            if len(loads) < len(pair):
                again.append(pair)
                continue
            # Towards the forces of the balance; of flanks that were left as before.
            forces = [
                load * (contact.ball.normal_force / load) ** damping
                if contact.solved is not None
                else load
                for contact, load in zip(nut.contacts, loads, strict=True)
            ]
            again.append(solve_sides(contacts, (forces[0], forces[1])))
        pairs = again
        nuts = make_oversize(screw, point, carried, pairs)
    return nuts


def make_oversize(
    screw: Screw, point: OperatingPoint, carried: Sequence[NutLoad], pairs: Sequence[Pair]
) -> list[SolvedNut]:
    """Balance the ball between its pairs of solved contacts, None of a flank that it leaves."""
    for load, pair in zip(carried, pairs, strict=True):
        failure = contact_failure(load.nut, pair)
        if failure:
            return [
                balanced_nut(screw, load, pair, None, failure)
                for load, pair in zip(carried, pairs, strict=True)
            ]
    flanks = [
        flanks_of(screw, point, load.flank, pair)
        for load, pair in zip(carried, pairs, strict=True)
    ]
    balls = balance_four_points(
        screw,
        abs(point.speed) or CREEP,
        flanks=(*flanks[0], *flanks[1]),
        axial_forces=[load.force / screw.loaded_balls_per_nut for load in carried],
        preload_force=float(normal_force(screw, screw.preload)),
    )
    least = IDLE_SHARE * balls[0].screw.normal_force
    return [
        balanced_nut(
            screw,
            load,
            [
                None if part.normal_force <= least else contact
                for contact, part in zip(pair, (ball.screw, ball.nut), strict=True)
            ],
            ball,
        )
        for load, pair, ball in zip(carried, pairs, balls, strict=True)
    ]
