# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction torque of contacts at the points of a run, from a small table.

Pressure and film of a contact follow the product of viscosity and speed, so contacts are solved
once per node of that product. Shear does not: the pressure-viscosity law bends with the oil, and
boundary friction acts in the balance of the balls. So the balls are balanced again on the solved
contacts for every viscosity, friction coefficient and onset of the table, which is cheap. Where
the onset is identified, the formulas of the closed-form tier fill such a table, too.

"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
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
    ONSET_BOUNDS,
    thickened,
    VISCOSITY_BOUNDS,
)
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw import closed_form
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.point import ScrewPoint
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw, TIER
from surrogate.tasks.progress import OnProgress
from surrogate.units import digits, RPM

NODES_PER_DECADE, FEWEST_NODES, MOST_SPEEDS = 10, 5, 10
"""Nodes of viscosity times speed; up to so many measured speeds are solved as they are."""
APART = 1.05
"""Least ratio of neighbouring speeds that are nodes themselves [-]."""
FACTORS, FEW_FACTORS = 5, 3
"""Viscosities of the table where they are identified, and where they spread with the oil alone."""
FRICTIONS = (FRICTION_BOUNDS[0], 0.05, 0.1, 0.15, 0.2, FRICTION_BOUNDS[1])
"""Friction coefficients of the table where it is identified [-]."""
LINEAR = FRICTION_BOUNDS
"""Friction coefficients of the table by formulas [-], in which the torque is linear in it."""
ONSETS = np.geomspace(*ONSET_BOUNDS, 25)
"""Onset factors of the table where they are identified [-]."""
ROUNDING = 1e-9
"""Relative difference of loads that are equal [-]."""
TEMPERATURE_SPREAD, LOAD_SPREAD = 10.0, 0.1
"""Largest distance from the mean temperature [K], and from the mean load over the preload [-]."""
SAME_VISCOSITY = 1e-3
"""Spread of the viscosity that counts as none [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Axes:
    """
    Axes of a table, and its place.

    Speeds at the mean viscosity [rad/s], viscosities over the mean one [-], friction coefficients
    [-], onset factors [-]; screw, oil anchored at the run, axial load [N].

    """

    nodes: Array
    factors: Array
    frictions: Array
    onsets: Array
    screw: Screw
    oil: Lubricant
    load: float

    def screws(self) -> list[list[Screw]]:
        """Return the screw of every friction coefficient and onset factor."""
        return [
            [
                bare(self.screw, asperity_friction=friction, onset_factor=onset)
                for onset in self.onsets
            ]
            for friction in self.frictions
        ]

    def at(self, torque: Array, speed: Array, thickness: Array, onset: float) -> Array:
        """
        Return the torque [N m] by point and friction coefficient.

        At speeds [rad/s] and viscosities over the mean one [-], of a table of torque [N m].

        """
        begun = _weights(np.log(self.onsets), np.log([onset]))[0]
        return np.einsum(
            'pn,pv,nvf->pf',
            _weights(np.log(self.nodes), np.log(speed * thickness)),
            _weights(np.log(self.factors), np.log(thickness)),
            torque @ begun,
        )

    def of(self, rows: Array, friction: float) -> Array:
        """Return the torque [N m] of every point at one friction coefficient [-]."""
        return np.asarray(rows @ _weights(self.frictions, np.array([friction]))[0])


def solved_model(
    screw: Screw,
    lubricant: Lubricant,
    run: NoLoadRun,
    fitted: Sequence[str] = (),
    *,
    settings: ScrewSettings | None = None,
    progress: OnProgress = lambda done, total: None,
) -> ContactModel:
    """
    Solve the table of a run for the `fitted` parameters and return what interpolates it.

    Seconds per node; `progress` is told how many of them are done. Raises InputError where the
    run spreads over more temperature or load than one table holds, and for a point that does not
    converge.

    """
    axes = _axes(screw, lubricant, run, fitted, FRICTIONS)
    opened, load = Contacts.of(bare(axes.screw)), axes.load
    torque, shares = [], np.empty(len(axes.nodes))
    progress(0, len(axes.nodes))
    solution: ScrewSolution | None = None
    for number, node in enumerate(axes.nodes.tolist()):  # each from its neighbour
        point = _point(axes.oil, node, load)
        solution = solve_screw(opened, axes.oil, point, settings=settings, start=solution)
        shares[number] = _converged(solution, node).asperity_share
        torque.append(_rebalanced(axes, node, solution, settings))
        progress(number + 1, len(axes.nodes))
    return _model(axes, run, TIER, np.array(torque), shares)


def formula_model(
    screw: Screw, lubricant: Lubricant, run: NoLoadRun, fitted: Sequence[str] = ()
) -> ContactModel:
    """Return what interpolates such a table of the closed-form tier; raises InputError as well."""
    axes = _axes(screw, lubricant, run, fitted, LINEAR)
    torque = [
        [[_formula(axes, rough, factor).friction_torque for rough in row] for row in axes.screws()]
        for factor in axes.factors.tolist()
    ]
    share = _formula(axes, bare(screw), 1.0).asperity_share
    return _model(axes, run, closed_form.TIER, np.moveaxis(np.array(torque), -1, 0), share)


def _formula(axes: _Axes, screw: Screw, factor: float) -> ScrewPoint[Array]:
    oil = thickened(axes.oil, factor)
    speeds, kelvin = axes.nodes / factor, axes.oil.reference_temperature
    return closed_form.solve(Contacts.of(screw), oil, speeds, axes.load, kelvin)


def _axes(
    screw: Screw,
    lubricant: Lubricant,
    run: NoLoadRun,
    fitted: Sequence[str],
    frictions: Sequence[float],
) -> _Axes:
    """Return the axes for what is fitted; friction coefficients [-] where they are."""
    oil, load, sheet = (
        anchored(lubricant, run.mean_temperature),
        _load(screw, run),
        screw.roughness,
    )
    thick, speeds = _thickness(oil, run), np.unique(np.abs(run.speed))
    low, high = float(thick.min()), float(thick.max())
    varies = 'viscosity_factor' in fitted
    if varies:
        low, high = VISCOSITY_BOUNDS[0] * low, VISCOSITY_BOUNDS[1] * high
    factors = np.ones(1)
    if high / low - 1 >= SAME_VISCOSITY:
        factors = np.geomspace(low, high, FACTORS if varies else FEW_FACTORS)
    apart = bool((speeds[1:] / speeds[:-1] >= APART).all())
    if len(factors) > 1 or len(speeds) > MOST_SPEEDS or not apart:
        # The products of speed and viscosity span those of the run.
        slow, fast = speeds[0] * factors[0], speeds[-1] * factors[-1]
        number = math.ceil(NODES_PER_DECADE * math.log10(fast / slow)) + 1
        speeds = np.geomspace(slow, fast, max(number, FEWEST_NODES))
    stated = np.array([sheet.asperity_friction])
    return _Axes(
        nodes=speeds,
        factors=factors,
        frictions=np.unique((*frictions, *stated)) if 'asperity_friction' in fitted else stated,
        onsets=ONSETS if 'onset_factor' in fitted else np.array([sheet.onset_factor]),
        screw=screw,
        oil=oil,
        load=load,
    )


def _model(axes: _Axes, run: NoLoadRun, tier: str, torque: Array, shares: Array) -> ContactModel:
    """Return the contacts of a run by a table of torque [N m], shares [-] at its speeds."""
    thick, speed = _thickness(axes.oil, run), np.abs(run.speed)

    @lru_cache(maxsize=256)
    def rows(factor: float, onset: float) -> Array:
        return axes.at(torque, speed, thick * factor, onset)

    return ContactModel(
        torque=lambda factor, friction, onset: axes.of(rows(factor, onset), friction),
        asperity_share=np.interp(np.log(speed * thick), np.log(axes.nodes), shares),
        tier=tier,
        screw=bare(axes.screw),
        lubricant=axes.oil,
    )


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


def _rebalanced(
    axes: _Axes, node: float, solution: ScrewSolution, settings: ScrewSettings | None
) -> list[list[list[float]]]:
    """Return the friction torque [N m] for every viscosity, friction coefficient and onset."""

    def torque(rough: Screw, factor: float) -> float:
        thick, point = thickened(axes.oil, factor), _point(axes.oil, node / factor, axes.load)
        balanced = rebalance_screw(Contacts.of(rough), thick, point, solution, settings=settings)
        return _converged(balanced, node).friction_torque

    return [
        [[torque(rough, factor) for rough in row] for row in axes.screws()]
        for factor in axes.factors.tolist()
    ]


def _point(oil: Lubricant, speed: float, load: float) -> OperatingPoint:
    return OperatingPoint(speed=float(speed), load=load, temperature=oil.reference_temperature)


def _converged(solution: ScrewSolution, speed: float) -> ScrewSolution:
    if not solution.converged:
        raise InputError(
            f'the screw at {digits(speed / RPM, 4)} rev/min was not solved: {solution.status} '
            'Leave such speeds out or use --tier closed_form'
        )
    return solution


def _weights(nodes: Array, places: Array) -> Array:
    """Return the weight of every node at every place, of the cubic spline through the nodes."""
    if len(nodes) == 1:
        return np.ones((len(places), 1))
    spline = _splines(tuple(nodes.tolist()))
    return np.asarray(spline(np.clip(places, nodes[0], nodes[-1])))


@lru_cache(maxsize=16)
def _splines(nodes: tuple[float, ...]) -> CubicSpline:
    """Return the splines that are 1 at one node and 0 at the others."""
    return CubicSpline(nodes, np.eye(len(nodes)))
