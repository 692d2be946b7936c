# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Traction on a ball at one contact: forces, moments and lost power for a given relative motion.

A traction is a set of places with a friction force each, which opposes the slip there. The sums
over the places and their exact derivatives are what the balance of the ball needs.

"""

from dataclasses import dataclass, fields, replace
import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactSolution
from surrogate.ehl.friction import node_strengths, NodeStrengths
from surrogate.files import InputError
from surrogate.formulas.geometry import Side
from surrogate.formulas.kinematics import heathcote_radius
from surrogate.parameters import Screw
from surrogate.screw.ball_motion import Array
from surrogate.screw.ball_sums import sum_friction

SAMPLE = 7
"""Nodes of a solved contact for one of its sample [-]."""
LARGEST_SLIP = 0.1
"""Slip over the entrainment speed that no rolling ball comes near [-]."""
FEW = 2000
"""Nodes that are not worth a sample [-]."""


class Traction(Protocol):
    """
    Friction law on the places of one contact.

    The friction force of a place at a given slip is proportional to the normal force of the
    contact. `growth` is the exponent of the size of the patch in the normal force [-],
    `slip_floor` [m/s] enters as sqrt(slip^2 + floor^2).

    """

    @property
    def growth(self) -> float:
        """Exponent of the size of the patch in the normal force [-]."""

    @property
    def slip_floor(self) -> float:
        """Floor of the slip speed [m/s]."""

    def places(self, load: float) -> tuple[Array, Array]:
        """Return x along the entrainment and y across it [m] under a `load` [N]."""

    def strengths(self, load: float) -> tuple[Array, Array, Array, Array]:
        """
        Return what makes the friction of each place.

        Boundary and Eyring force [N], rate [s/m] and limit [N]: boundary + min(eyring asinh(rate
        slip), limit).

        """

    def sample(self) -> 'Traction':
        """Return about the same friction on fewer places, for the way to a solution."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wrench:
    """
    What a contact does to the ball by friction.

    `values`: forces along t and along e_p [N], moments about t, e and e_p through the ball centre
    [N m]. `by_motion` (5, 5) and `by_load` (5) are their derivatives by the relative motion
    [m/s, rad/s] and the normal force [N]. Lost power [W], integrated from the slip.

    """

    values: Array
    by_motion: Array
    by_load: Array
    power: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedTraction:
    """
    Friction over the pressurised nodes of a solved contact, or over some of them.

    Strengths of the `nodes` under the `load` [N] of the solution, to which another normal force is
    scaled; slip floor [m/s].

    """

    nodes: NodeStrengths
    load: float
    slip_floor: float = 1e-4

    @property
    def growth(self) -> float:
        """Exponent of the size of the patch in the normal force [-]: the nodes stay, 0."""
        return 0.0

    def places(self, load: float) -> tuple[Array, Array]:
        """Return the nodes x, y [m], the same under any `load` [N]."""
        return self.nodes.x, self.nodes.y

    def strengths(self, load: float) -> tuple[Array, Array, Array, Array]:
        """Return the strengths of each node, the forces scaled to `load` [N]."""
        scale, nodes = load / self.load, self.nodes
        return scale * nodes.boundary, scale * nodes.eyring, nodes.rate, scale * nodes.limit

    def sample(self) -> 'SolvedTraction':
        """Return every `SAMPLE`-th node, each for as many; itself where nodes are few."""
        if self.nodes.x.size < FEW:
            return self
        return replace(self, nodes=self.nodes.taken(slice(None, None, SAMPLE), SAMPLE))


FREE = SolvedTraction(
    nodes=NodeStrengths(**{field.name: np.empty(0) for field in fields(NodeStrengths)}),
    load=1.0,
    slip_floor=math.inf,
)
"""No friction at all: that of a flank without a contact, or of one that the ball has left."""


def solved_traction(
    solution: ContactSolution,
    *,
    asperity_friction: float = 0.1,
    asperity_share: float | None = None,
    slip_floor: float = 1e-4,
    neglected: float = 0.0,
) -> SolvedTraction:
    """
    Return the friction over a solved contact, as `contact_friction` integrates it.

    Boundary coefficient and share [-] as in `node_strengths`, slip floor [m/s]; `neglected`,
    largest share of the friction [-] of the weak nodes that are left out. Raises InputError for a
    solution that did not converge.

    """
    if not solution.converged:
        raise InputError(f'no traction without a solved contact: {solution.status.value}')
    if not (math.isfinite(slip_floor) and slip_floor > 0):
        raise InputError(f'slip_floor is {slip_floor!r} m/s, allowed is more than 0')
    nodes = node_strengths(
        solution, asperity_friction=asperity_friction, asperity_share=asperity_share
    )
    # The weaker a node, the later it saturates: its share is largest at a slip above any.
    slip = LARGEST_SLIP * solution.condition.entrainment_speed
    used = _strongest(nodes.boundary + nodes.sheared(slip), neglected)
    return SolvedTraction(
        nodes=nodes.taken(used), load=solution.condition.load, slip_floor=slip_floor
    )


def _strongest(friction: Array, neglected: float) -> NDArray[np.bool_]:
    """Return the places that bear all but a share [-] of the friction."""
    rising = np.sort(friction, axis=None)
    weak = int(np.searchsorted(np.cumsum(rising), neglected * rising.sum()))
    return np.asarray((friction > 0) & (friction >= rising[weak]))


def integrate_traction(
    screw: Screw,
    side: Side,
    traction: Traction,
    load: float,
    motion: Array,
    *,
    direction: float = 1.0,
    slip_floor: float = 0.0,
) -> Wrench:
    """
    Integrate the friction of one contact with normal force `load` [N]; none without load.

    Slip as in `slip_maps`; `motion` against the raceway [m/s, rad/s] as `relative_motion` gives
    it; `direction` of the entrainment along t, 1 or -1; a slip floor [m/s] above that of the law.
    The traction of a place is -f(|V|) V/|V|; power is lost as the sum of f V^2/|V|, apart from the
    forces.

    """
    if not load > 0:
        traction, load = FREE, 1.0
    x, y = (direction * place for place in traction.places(load))
    values, by_motion, by_size, power = sum_friction(
        x,
        y,
        *traction.strengths(load),
        np.asarray(motion, dtype=np.float64),
        0.5 * screw.ball_diameter,
        heathcote_radius(screw, side),
        max(slip_floor, traction.slip_floor),
    )
    by_load = (values + traction.growth * by_size) / load
    return Wrench(values=values, by_motion=by_motion, by_load=by_load, power=power)
