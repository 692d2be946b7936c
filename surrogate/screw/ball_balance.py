# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Quasi-static balance of one ball under friction: contact angles, loads, motion, lost power, torque.

Newton's method on the equations, from the ball that rolls without gross slip and weak viscous
friction, which then sharpens in stages. The torque of the ball on the screw comes out twice: from
the loads on the screw, and from the power lost in the contacts.

"""

from collections.abc import Sequence
from dataclasses import replace
import math

import numpy as np
from surrogate.files import InputError
from surrogate.formulas.geometry import helix_angle, SIDES
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.parameters import Screw
from surrogate.screw.ball_equations import (
    BallFlank,
    BallProblem,
    FourPointBall,
    linearise,
    residual,
    TwoPointBall,
    wrenches,
)
from surrogate.screw.ball_motion import Array, Flank
from surrogate.screw.ball_result import (
    BalanceStatus,
    BallBalance,
    converged_balances,
    unloaded_balance,
)
from surrogate.screw.ball_traction import Traction

FIRST_FLOOR, STAGE_RATIOS, STAGE_TOLERANCE = 3.0, (10.0, 3.0, 1.5, math.inf), 0.2
"""Slip floor of the first stage over the helical slip, ratios of floors of following stages, and
last scaled Newton step of all stages but the last [-]; at last without stages."""
SMALLEST_DAMPING = 1 / 64
"""Where a Newton step is given up [-]."""
LARGEST_CONDITION = 1e14
"""Condition of the equations above which the motion counts as undetermined [-]."""
STEP_TOLERANCE, BALANCE_TOLERANCE, NEWTON_LIMIT = 1e-8, 1e-10, 40
"""Largest last Newton step and largest imbalance over the normal force, most Newton steps of one
solve [-]."""
Iterate = tuple[Array, BalanceStatus, int]
"""Where a Newton iteration ended: scaled unknowns, status, steps."""


def balance_ball(
    screw: Screw,
    speed: float,
    *,
    screw_traction: Traction,
    nut_traction: Traction,
    normal_force: float | None = None,
    axial_force: float | None = None,
    flank: Flank = 1,
    screw_rolling_force: float = 0.0,
    nut_rolling_force: float = 0.0,
) -> BallBalance:
    """
    Balance one ball at a screw `speed` [rad/s], not zero.

    Either the normal force on the screw [N] or the axial force per ball [N] is given, at least 0.
    The load opposes the motion where flank times speed is positive. Rolling forces [N] on each
    surface of a contact enter as couples; where a summit carries a small contact behind its centre
    they are negative. Raises InputError for numbers that make no sense; failure to converge is a
    status.

    """
    _check(speed, flank, normal_force, axial_force)
    _check_rolling('screw_rolling_force', screw_rolling_force)
    _check_rolling('nut_rolling_force', nut_rolling_force)
    force = normal_force
    if force is None:
        assert axial_force is not None
        force = _normal_force(screw, axial_force)
    laws = (screw_traction, screw_rolling_force), (nut_traction, nut_rolling_force)
    problem = TwoPointBall(
        screw=screw,
        speed=float(speed),
        flanks=tuple(
            BallFlank(side=side, flank=flank, traction=traction, rolling_force=rolling)
            for side, (traction, rolling) in zip(SIDES, laws)
        ),
        force_unit=force,
        axial_force=axial_force,
    )
    if force == 0:
        return unloaded_balance(problem)
    return balance_pairs(problem)[0]


def balance_pairs(problem: BallProblem) -> tuple[BallBalance, ...]:
    """Return the balance of a ball for each pair of its flanks; all end with one status."""
    unknowns, status, steps = _solve(problem)
    if status is BalanceStatus.CONVERGED:
        balances = converged_balances(problem, unknowns, steps)
        if balances[0].imbalance <= BALANCE_TOLERANCE:
            return balances
        status = BalanceStatus.STALLED
    return tuple(
        BallBalance(status=status, speed=problem.speed, flank=place.flank, iterations=steps)
        for place in problem.flanks[::2]
    )


def balance_four_points(
    screw: Screw,
    speed: float,
    *,
    flanks: tuple[BallFlank, ...],
    axial_forces: Sequence[float],
    preload_force: float,
) -> tuple[BallBalance, ...]:
    """
    Balance one ball that touches all four flanks at a screw `speed` [rad/s], not zero.

    `flanks` of screw and nut that carry more, then the others; axial forces per ball [N] of both
    pairs without friction, whose difference the ball carries; normal force of all under preload
    alone [N], above 0. Friction moves the normal forces and may lift the ball off a flank of the
    lighter pair. Returns the balance for each pair: torque, axial force and power add up.

    """
    loaded, relieved = (_normal_force(screw, force) for force in axial_forces)
    problem = FourPointBall(
        screw=screw,
        speed=float(speed),
        flanks=flanks,
        force_unit=loaded,
        axial_force=axial_forces[0] - axial_forces[1],
        relieved_force=relieved,
        preload_force=preload_force,
    )
    return balance_pairs(problem)


def _normal_force(screw: Screw, axial_force: float) -> float:
    """Return the normal force without friction [N] of a ball under an axial force [N]."""
    return axial_force / (math.sin(screw.contact_angle) * math.cos(helix_angle(screw)))


def _solve(problem: BallProblem) -> Iterate:
    """Solve with friction that sharpens in a few large stages, or else in many small ones."""
    coarse = tuple(replace(place, traction=place.traction.sample()) for place in problem.flanks)
    rough = replace(problem, flanks=coarse)
    for ratio in STAGE_RATIOS:
        iterate: Iterate = problem.frictionless(), BalanceStatus.NOT_SOLVED, 0
        stages = [replace(rough, slip_floor=floor) for floor in _floors(problem, ratio)]
        for stage in (*stages, problem):
            sharp = stage.slip_floor == problem.slip_floor
            tolerance = STEP_TOLERANCE if sharp else STAGE_TOLERANCE
            iterate = _newton(stage, iterate, tolerance)
            if iterate[1] is not BalanceStatus.CONVERGED:
                break
        else:
            return iterate
    return iterate


def _floors(problem: BallProblem, ratio: float) -> list[float]:
    """
    Return falling slip floors [m/s], the last that of the problem.

    Far above the slip the floor leaves weak viscous friction, and the ball near its motion without
    gross slip.

    """
    slip = no_slip_rates(problem.screw).helical_slip * abs(problem.speed)
    own = min(place.traction.slip_floor for place in problem.flanks)
    count = math.ceil(max(0.0, math.log(FIRST_FLOOR * slip / own, ratio)))
    return [*(own * ratio**power for power in range(count, 0, -1)), problem.slip_floor]


def _newton(problem: BallProblem, start: Iterate, tolerance: float) -> Iterate:
    """
    Iterate with damping by the natural monotonicity test.

    A step is shortened until the next one, with the old Jacobian, is shorter: Deuflhard, Newton
    Methods for Nonlinear Problems (2004), section 3.3.

    """
    unknowns, _, before = start
    friction = wrenches(problem, unknowns)
    for steps in range(before + 1, before + 1 + NEWTON_LIMIT):
        imbalance, jacobian = linearise(problem, unknowns, friction)
        rows = np.abs(jacobian).max(axis=1, keepdims=True)
        finite = np.isfinite(jacobian).all() and rows.min() > 0
        if not (finite and np.linalg.cond(jacobian / rows) < LARGEST_CONDITION):
            # Whatever the size of their rows, the equations leave an unknown open.
            return unknowns, BalanceStatus.UNDETERMINED, steps
        step = np.asarray(np.linalg.solve(jacobian, -imbalance), dtype=np.float64)
        if np.linalg.norm(step) <= tolerance:
            legal = _legal(problem, unknowns + step)
            status = BalanceStatus.CONVERGED if legal else BalanceStatus.OUT_OF_RANGE
            return unknowns + step, status, steps
        damping = 1.0
        while damping >= SMALLEST_DAMPING:
            trial = unknowns + damping * step
            if _legal(problem, trial):
                rubbing = wrenches(problem, trial)
                left = np.linalg.solve(
                    jacobian, residual(problem, trial, [wrench.values for wrench in rubbing])
                )
                if np.linalg.norm(left) <= (1 - 0.5 * damping) * np.linalg.norm(step):
                    break
            damping *= 0.5
        else:  # no step is legal and leaves a shorter one to go
            legal = _legal(problem, unknowns + SMALLEST_DAMPING * step)
            status = BalanceStatus.STALLED if legal else BalanceStatus.OUT_OF_RANGE
            return unknowns, status, steps
        unknowns, friction = trial, rubbing
    return unknowns, BalanceStatus.STALLED, steps


def _legal(problem: BallProblem, unknowns: Array) -> bool:
    """Return True if all contacts press and lie on their flanks."""
    values = problem.scales * unknowns
    angles = np.array(problem.angles(values))
    pressed = min(problem.normal_forces(values)[:2]) > 0
    return bool(pressed and angles.min() > 0 and angles.max() < 0.5 * math.pi)


def _check(
    speed: float, flank: int, normal_force: float | None, axial_force: float | None
) -> None:
    if not (math.isfinite(speed) and speed):
        raise InputError(f'speed is {speed!r} rad/s, allowed is any finite number but 0')
    if flank not in (1, -1):
        raise InputError(f'flank is {flank!r}, allowed is 1 or -1')
    if (normal_force is None) == (axial_force is None):
        raise InputError('give either normal_force or axial_force, not both and not none')
    for name, force in (('normal_force', normal_force), ('axial_force', axial_force)):
        if force is not None and not (math.isfinite(force) and force >= 0):
            raise InputError(f'{name} is {force!r} N, allowed is 0 or more')


def _check_rolling(name: str, force: float) -> None:
    if not math.isfinite(force):
        raise InputError(f'{name} is {force!r} N, allowed is any finite number')
