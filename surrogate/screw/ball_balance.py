# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Quasi-static balance of one ball under friction: contact angles, loads, motion, lost power, torque.

Newton's method on the equations, from the ball that rolls without gross slip and weak viscous
friction, which then sharpens in stages. The torque of the ball on the screw comes out twice: from
the loads on the screw, and from the power lost in the contacts.

"""

from dataclasses import dataclass, replace
import math

import numpy as np
from surrogate.files import InputError
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.parameters import Screw
from surrogate.screw.ball_equations import (
    BallProblem,
    linearise,
    no_slip_unknowns,
    normal_forces,
    NUT_ANGLE,
    residual,
    SCREW_ANGLE,
    wrenches,
)
from surrogate.screw.ball_motion import Array, Flank
from surrogate.screw.ball_result import (
    BalanceStatus,
    BallBalance,
    converged_balance,
    unloaded_balance,
)
from surrogate.screw.ball_traction import Traction, Wrench

FIRST_FLOOR, STAGE_RATIOS, STAGE_TOLERANCE = 3.0, (10.0, 3.0, 1.5, math.inf), 0.2
"""Slip floor of the first stage over the helical slip, ratios of floors of following stages, and
last scaled Newton step of all stages but the last [-]; at last without stages."""
SMALLEST_DAMPING = 1 / 64
"""Where a Newton step is given up [-]."""
LARGEST_CONDITION = 1e14
"""Condition of the equations above which the motion counts as undetermined [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BalanceSettings:
    """
    How to solve.

    Largest last Newton step and largest imbalance over the normal force [-], cap of Newton steps
    of one solve [-].

    """

    step_tolerance: float = 1e-8
    balance_tolerance: float = 1e-10
    newton_limit: int = 40


@dataclass(frozen=True, slots=True)
class _Iterate:
    """Where a Newton iteration ended: scaled unknowns, status, steps."""

    unknowns: Array
    status: BalanceStatus = BalanceStatus.NOT_SOLVED
    steps: int = 0


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
    settings: BalanceSettings | None = None,
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
    problem = BallProblem(
        screw=screw,
        speed=float(speed),
        flank=flank,
        tractions=(screw_traction, nut_traction),
        rolling_forces=(screw_rolling_force, nut_rolling_force),
        normal_force=normal_force,
        axial_force=axial_force,
    )
    if problem.force_unit == 0:
        return unloaded_balance(problem)
    settings = settings or BalanceSettings()
    iterate = _solve(problem, settings)
    status = iterate.status
    if status is BalanceStatus.CONVERGED:
        balance = converged_balance(problem, iterate.unknowns, iterate.steps)
        if balance.imbalance <= settings.balance_tolerance:
            return balance
        status = BalanceStatus.STALLED
    return BallBalance(status=status, speed=problem.speed, flank=flank, iterations=iterate.steps)


def _solve(problem: BallProblem, settings: BalanceSettings) -> _Iterate:
    """Solve with friction that sharpens in a few large stages, or else in many small ones."""
    screw, nut = problem.tractions
    rough = replace(problem, tractions=(screw.sample(), nut.sample()))
    for ratio in STAGE_RATIOS:
        iterate = _Iterate(unknowns=no_slip_unknowns(problem))
        stages = [replace(rough, slip_floor=floor) for floor in _floors(problem, ratio)]
        for stage in (*stages, problem):
            sharp = stage.slip_floor == problem.slip_floor
            tolerance = settings.step_tolerance if sharp else STAGE_TOLERANCE
            iterate = _newton(stage, iterate, tolerance, settings.newton_limit)
            if iterate.status is not BalanceStatus.CONVERGED:
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
    own = min(law.slip_floor for law in problem.tractions)
    count = math.ceil(max(0.0, math.log(FIRST_FLOOR * slip / own, ratio)))
    return [*(own * ratio**power for power in range(count, 0, -1)), problem.slip_floor]


def _newton(problem: BallProblem, start: _Iterate, tolerance: float, limit: int) -> _Iterate:
    """
    Iterate with damping by the natural monotonicity test.

    A step is shortened until the next one, with the old Jacobian, is shorter: Deuflhard, Newton
    Methods for Nonlinear Problems (2004), section 3.3.

    """
    unknowns, friction = start.unknowns, wrenches(problem, start.unknowns)
    for steps in range(start.steps + 1, start.steps + 1 + limit):
        imbalance, jacobian = linearise(problem, unknowns, friction)
        if not _regular(jacobian):
            return _Iterate(unknowns, BalanceStatus.UNDETERMINED, steps)
        step = np.asarray(np.linalg.solve(jacobian, -imbalance), dtype=np.float64)
        if np.linalg.norm(step) <= tolerance:
            legal = _legal(problem, unknowns + step)
            status = BalanceStatus.CONVERGED if legal else BalanceStatus.OUT_OF_RANGE
            return _Iterate(unknowns + step, status, steps)
        trial = _search(problem, unknowns, step, jacobian)
        if trial is None:
            legal = _legal(problem, unknowns + SMALLEST_DAMPING * step)
            status = BalanceStatus.STALLED if legal else BalanceStatus.OUT_OF_RANGE
            return _Iterate(unknowns, status, steps)
        unknowns, friction = trial
    return _Iterate(unknowns, BalanceStatus.STALLED, steps)


def _search(
    problem: BallProblem, unknowns: Array, step: Array, jacobian: Array
) -> tuple[Array, tuple[Wrench, Wrench]] | None:
    """Return the first damped step that is legal and leaves a shorter one to go, and friction."""
    damping = 1.0
    while damping >= SMALLEST_DAMPING:
        trial = unknowns + damping * step
        if _legal(problem, trial):
            friction = wrenches(problem, trial)
            left = np.linalg.solve(
                jacobian, residual(problem, trial, (friction[0].values, friction[1].values))
            )
            if np.linalg.norm(left) <= (1 - 0.5 * damping) * np.linalg.norm(step):
                return trial, friction
        damping *= 0.5
    return None


def _legal(problem: BallProblem, unknowns: Array) -> bool:
    """Return True if both contacts press and lie on the loaded flank."""
    values = problem.scales * unknowns
    angles = values[[SCREW_ANGLE, NUT_ANGLE]]
    pressed = min(normal_forces(problem, values)) > 0
    return bool(pressed and angles.min() > 0 and angles.max() < 0.5 * math.pi)


def _regular(jacobian: Array) -> bool:
    """Return True if the equations decide every unknown, whatever the size of their rows."""
    rows = np.abs(jacobian).max(axis=1, keepdims=True)
    if not (np.isfinite(jacobian).all() and rows.min() > 0):
        return False
    return bool(np.linalg.cond(jacobian / rows) < LARGEST_CONDITION)


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
