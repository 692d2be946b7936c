# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Result of the balance of one ball: loads, motion, lost power, and the torque in two ways."""

from dataclasses import dataclass
from enum import Enum
import math

import numpy as np
from surrogate.screw.ball_equations import (
    ball_motion,
    BallProblem,
    motions,
    normal_forces,
    NUT_ANGLE,
    residual,
    SCREW_ANGLE,
    screw_torque,
    wrenches,
)
from surrogate.screw.ball_motion import Array, BallMotion, Flank
from surrogate.screw.ball_traction import Wrench


class BalanceStatus(Enum):
    """How a balance ended, in a sentence."""

    NOT_SOLVED = 'Nothing was solved.'
    CONVERGED = 'Converged: forces, moments and the closure of the contact angles hold.'
    UNLOADED = 'The ball carries no load: no contact, no loss.'
    STALLED = 'The iteration ended before forces and moments were in balance.'
    OUT_OF_RANGE = (
        'No balance was found: a normal force vanishes or a contact angle leaves 0 to 90 degrees.'
    )
    UNDETERMINED = 'Friction is absent, or too small to decide how the ball rolls.'


@dataclass(frozen=True, kw_only=True, slots=True)
class BallContact:
    """
    One contact of the balanced ball.

    Contact angle [rad], normal force [N], traction on the ball along t and along e_p [N], spin
    moment on the ball about e [N m], spin rate against the raceway about e [rad/s], power lost by
    sliding and by rolling [W].

    """

    angle: float = math.nan
    normal_force: float = math.nan
    traction_along: float = math.nan
    traction_across: float = math.nan
    spin_moment: float = math.nan
    spin_rate: float = math.nan
    slip_power: float = math.nan
    rolling_power: float = math.nan

    @property
    def power(self) -> float:
        """Lost power [W]."""
        return self.slip_power + self.rolling_power


@dataclass(frozen=True, kw_only=True, slots=True)
class BallBalance:
    """
    One balanced ball; all numbers are NaN unless it converged.

    Contacts with screw and nut, motion (None unless converged), axial force [N] of the ball on the
    screw along the loaded flank; torque [N m] that drives the screw against this ball, positive
    along the motion, from the loads on the screw (`torque`) and from axial force and lost power
    (`energy_torque`); Newton steps of the last attempt; largest imbalance over the normal force
    [-].

    """

    status: BalanceStatus
    speed: float  # [rad/s]
    flank: Flank
    screw: BallContact = BallContact()
    nut: BallContact = BallContact()
    motion: BallMotion | None = None
    axial_force: float = math.nan
    torque: float = math.nan
    energy_torque: float = math.nan
    iterations: int = 0
    imbalance: float = math.nan

    @property
    def converged(self) -> bool:
        """Whether the numbers hold: balanced, or legally without load."""
        return self.status in (BalanceStatus.CONVERGED, BalanceStatus.UNLOADED)

    @property
    def opposing(self) -> bool:
        """Whether the load opposes the motion."""
        return self.flank * self.speed > 0

    @property
    def power(self) -> float:
        """Lost power [W]."""
        return self.screw.power + self.nut.power

    @property
    def loss_torque(self) -> float:
        """Lost power per screw speed [N m]."""
        return self.power / abs(self.speed)


def converged_balance(problem: BallProblem, unknowns: Array, iterations: int) -> BallBalance:
    """
    Return the result at scaled unknowns [-] that are in balance.

    Energy: the torque along the motion is F_z L/(2 pi), signed as the load opposes or drives, and
    the lost power over the speed.

    """
    friction, values = wrenches(problem, unknowns), problem.scales * unknowns
    contacts = [_contact(problem, which, values, friction[which]) for which in (0, 1)]
    torque, pushed = screw_torque(problem, values, friction[0].values)
    sense = math.copysign(1.0, problem.speed)
    axial_force = -problem.flank * pushed
    power = contacts[0].power + contacts[1].power
    ideal = problem.flank * axial_force * problem.screw.lead / (2 * math.pi)
    imbalance = residual(problem, unknowns, (friction[0].values, friction[1].values))
    return BallBalance(
        status=BalanceStatus.CONVERGED,
        speed=problem.speed,
        flank=problem.flank,
        screw=contacts[0],
        nut=contacts[1],
        motion=ball_motion(problem, values),
        axial_force=axial_force,
        torque=sense * torque,
        energy_torque=sense * ideal + power / abs(problem.speed),
        iterations=iterations,
        imbalance=float(np.abs(imbalance).max()),
    )


def unloaded_balance(problem: BallProblem) -> BallBalance:
    """Return the result of a ball without load: no force, no loss, no defined motion."""
    nothing = BallContact(
        normal_force=0.0,
        traction_along=0.0,
        traction_across=0.0,
        spin_moment=0.0,
        slip_power=0.0,
        rolling_power=0.0,
    )
    return BallBalance(
        status=BalanceStatus.UNLOADED,
        speed=problem.speed,
        flank=problem.flank,
        screw=nothing,
        nut=nothing,
        axial_force=0.0,
        torque=0.0,
        energy_torque=0.0,
        imbalance=0.0,
    )


def _contact(problem: BallProblem, which: int, values: Array, friction: Wrench) -> BallContact:
    """Return one contact at unscaled unknowns in balance, with its friction."""
    motion = motions(problem, values)[which]
    return BallContact(
        angle=float(values[(SCREW_ANGLE, NUT_ANGLE)[which]]),
        normal_force=float(normal_forces(problem, values)[which]),
        traction_along=float(friction.values[0]),
        traction_across=float(friction.values[1]),
        spin_moment=float(friction.values[3]),
        spin_rate=float(motion[3]),
        slip_power=friction.power,
        rolling_power=-problem.couples[which] * float(motion[4]),
    )
