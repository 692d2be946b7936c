# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction torque of solved contacts at the points of a run, from a small table.

Pressure and film of a contact follow the product of viscosity and speed, so contacts are solved
once per node of that product. Shear does not: the pressure-viscosity law bends with the oil, and
boundary friction acts in the balance of the balls. So the balls are balanced again on the solved
contacts for every viscosity and every friction coefficient of the table, which is cheap.

"""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np
from scipy.interpolate import CubicSpline
from surrogate.files import InputError
from surrogate.formulas.lubricant import lubricant_state
from surrogate.identify.data import Array, NoLoadRun
from surrogate.identify.model import (
    anchored,
    bare,
    ContactModel,
    FRICTION_BOUNDS,
    thickened,
    VISCOSITY_BOUNDS,
)
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.progress import OnProgress
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw, TIER
from surrogate.units import RPM

NODES_PER_DECADE, FEWEST_NODES, MOST_SPEEDS = 10, 5, 10
"""Nodes of viscosity times speed; up to so many measured speeds are solved as they are."""
APART = 1.05
"""Least ratio of neighbouring speeds that are nodes themselves [-]."""
FACTORS = 5
"""Viscosities of the table where it has more than one."""
FRICTIONS = (FRICTION_BOUNDS[0], 0.05, 0.1, 0.15, 0.2, FRICTION_BOUNDS[1])
"""Friction coefficients of the table where it is identified [-]."""
ROUNDING = 1e-9
"""Relative difference of loads that are equal [-]."""
TEMPERATURE_SPREAD, LOAD_SPREAD = 10.0, 0.1
"""Largest distance from the mean temperature [K], and from the mean load over the preload [-]."""
SAME_VISCOSITY = 1e-3
"""Spread of the viscosity that counts as none [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Table:
    """
    Friction torque [N m] by speed at the mean viscosity, viscosity and asperity friction.

    Axes: speeds [rad/s], viscosities over the mean one [-], friction coefficients [-]; asperity
    share [-] at each speed.

    """

    nodes: Array
    factors: Array
    frictions: Array
    torque: Array
    shares: Array

    def at(self, speed: Array, thickness: Array, friction: float) -> Array:
        """Return the torque [N m] at speeds [rad/s] and viscosities over the mean one [-]."""
        return np.einsum(
            'pn,pv,pf,nvf->p',
            _weights(np.log(self.nodes), np.log(speed * thickness)),
            _weights(np.log(self.factors), np.log(thickness)),
            _weights(self.frictions, np.full(len(speed), friction)),
            self.torque,
        )


def solved_model(
    screw: Screw,
    lubricant: Lubricant,
    run: NoLoadRun,
    fitted: Sequence[str] = (),
    *,
    settings: ScrewSettings | None = None,
    progress: OnProgress | None = None,
) -> ContactModel:
    """
    Solve the table of a run for the `fitted` parameters and return what interpolates it.

    Seconds per node; `progress` is told how many of them are done. Raises InputError where the
    run spreads over more temperature or load than one table holds, and for a point that does not
    converge.

    """
    oil, load = anchored(lubricant, run.mean_temperature), _load(screw, run)
    thick, speed = _thickness(oil, run), np.abs(run.speed)
    frictions = np.array([screw.roughness.asperity_friction])
    if 'asperity_friction' in fitted:
        frictions = np.unique((*FRICTIONS, *frictions))
    factors = _factors(thick, 'viscosity_factor' in fitted)
    nodes, told = _nodes(speed, factors), progress or _nobody
    table = _solve_table(screw, oil, load, nodes, factors, frictions, settings, told)
    return ContactModel(
        torque=lambda factor, friction: table.at(speed, thick * factor, friction),
        asperity_share=np.interp(np.log(speed * thick), np.log(nodes), table.shares),
        tier=TIER,
        screw=bare(screw),
        lubricant=oil,
    )


def _nobody(done: int, total: int) -> None:
    """Take no notice of the progress."""


def _solve_table(
    screw: Screw,
    oil: Lubricant,
    load: float,
    nodes: Array,
    factors: Array,
    frictions: Array,
    settings: ScrewSettings | None,
    progress: OnProgress,
) -> _Table:
    torque, shares = np.empty((len(nodes), len(factors), len(frictions))), np.empty(len(nodes))
    progress(0, len(nodes))
    found: ScrewSolution | None = None
    for number, node in enumerate(nodes):
        found = _solve(bare(screw), oil, node, load, settings, found)
        shares[number] = found.asperity_share
        torque[number] = _rebalanced(screw, oil, node, load, found, factors, frictions, settings)
        progress(number + 1, len(nodes))
    return _Table(nodes=nodes, factors=factors, frictions=frictions, torque=torque, shares=shares)


def _load(screw: Screw, run: NoLoadRun) -> float:
    """Return the one load [N] of a run."""
    load = float(run.load.mean())
    spread = float(np.abs(run.load - load).max())
    if spread > LOAD_SPREAD * screw.preload + ROUNDING * abs(load):
        raise InputError(
            f'{run.source}: load_N is up to {spread:.3g} N from its mean, allowed is '
            f'{LOAD_SPREAD * screw.preload:.3g} N in the full tier; split the data or use '
            '--tier closed_form'
        )
    return load


def _thickness(oil: Lubricant, run: NoLoadRun) -> Array:
    """Return the viscosity at every point over that at the mean temperature [-]."""
    spread = float(np.abs(run.temperature - run.mean_temperature).max())
    if spread > TEMPERATURE_SPREAD:
        raise InputError(
            f'{run.source}: the temperature is up to {spread:.3g} K from its mean, allowed is '
            f'{TEMPERATURE_SPREAD:g} K in the full tier; split the data or use --tier closed_form'
        )
    return lubricant_state(oil, run.temperature).viscosity / oil.viscosity


def _factors(thick: Array, fitted: bool) -> Array:
    """Return the viscosities of the table over that at the mean temperature [-]."""
    low, high = float(thick.min()), float(thick.max())
    if fitted:
        low, high = VISCOSITY_BOUNDS[0] * low, VISCOSITY_BOUNDS[1] * high
    if high / low - 1 < SAME_VISCOSITY:
        return np.ones(1)
    return np.geomspace(low, high, FACTORS)


def _nodes(speed: Array, factors: Array) -> Array:
    """Return speeds [rad/s] at the mean viscosity whose products span those of the run."""
    distinct = np.unique(speed)
    apart = bool((distinct[1:] / distinct[:-1] >= APART).all())
    if len(factors) == 1 and len(distinct) <= MOST_SPEEDS and apart:
        return distinct
    low, high = distinct[0] * factors[0], distinct[-1] * factors[-1]
    number = math.ceil(NODES_PER_DECADE * math.log10(high / low)) + 1
    return np.geomspace(low, high, max(number, FEWEST_NODES))


def _solve(
    screw: Screw,
    oil: Lubricant,
    speed: float,
    load: float,
    settings: ScrewSettings | None,
    start: ScrewSolution | None,
) -> ScrewSolution:
    """Solve a node at the mean viscosity, from its neighbour."""
    point = _point(oil, speed, load)
    return _converged(solve_screw(screw, oil, point, settings=settings, start=start), speed)


def _rebalanced(
    screw: Screw,
    oil: Lubricant,
    node: float,
    load: float,
    found: ScrewSolution,
    factors: Array,
    frictions: Array,
    settings: ScrewSettings | None,
) -> Array:
    """Return the friction torque [N m] for every viscosity and friction coefficient."""
    table = np.empty((len(factors), len(frictions)))
    for row, factor in enumerate(factors):
        thick, point = thickened(oil, factor), _point(oil, node / factor, load)
        for column, friction in enumerate(frictions):
            rough = bare(screw, float(friction))
            balanced = rebalance_screw(rough, thick, point, found, settings=settings)
            table[row, column] = _converged(balanced, node).friction_torque
    return table


def _point(oil: Lubricant, speed: float, load: float) -> OperatingPoint:
    return OperatingPoint(speed=float(speed), load=load, temperature=oil.reference_temperature)


def _converged(found: ScrewSolution, speed: float) -> ScrewSolution:
    if not found.converged:
        raise InputError(
            f'the screw at {speed / RPM:.4g} rev/min was not solved: {found.status} '
            'Leave such speeds out or use --tier closed_form'
        )
    return found


def _weights(nodes: Array, places: Array) -> Array:
    """Return the weight of every node at every place, of the cubic spline through the nodes."""
    if len(nodes) == 1:
        return np.ones((len(places), 1))
    spline = CubicSpline(nodes, np.eye(len(nodes)))
    return np.asarray(spline(np.clip(places, nodes[0], nodes[-1])))
