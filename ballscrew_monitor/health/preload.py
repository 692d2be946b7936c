# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The preload that is left, beside what a wiper may add.

For each share of the preload the size of a constant drag is that of least chi squared; another
warmth of the contacts stands in the covariance. The law by which friction follows the preload is
itself in doubt: another power of it changes the friction everywhere by one share of what is lost.

"""

from collections.abc import Sequence
import math

from ballscrew_monitor.health.causes import birge, INTERVAL
from ballscrew_monitor.health.change import Change
from ballscrew_monitor.health.companions import Companions, NONE_BUILT
from ballscrew_monitor.health.life import unknown
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import Cause, CauseCode, Quantity
import numpy as np

NAME = 'preload'
SHARES = np.linspace(0.3, 1.2, 46)
"""Shares of the preload that are tried [-]."""
LAW_DOUBT = 0.15
"""Standard deviation of the power by which friction follows the preload [-]."""
DRAG_DOUBT = 0.3
"""Standard deviation of the constant drag that may have come beside, over the friction [-]."""
WIDEST = 0.5
"""Width of an interval above which a preload is not known [-]."""


def preload_of(
    change: Change | None,
    model: Model,
    reason: str,
    companions: Companions | str,
    causes: Sequence[Cause] = (),
) -> Quantity:
    """
    Return the preload over that of the baseline, with an interval, or why it is not known.

    It is not known where a change of the preload is among the excluded `causes`.

    """
    if change is None:
        return unknown(NAME, '-', reason)
    if isinstance(companions, str):
        return unknown(NAME, '-', companions or NONE_BUILT)
    if any(one.excluded and one.code is CauseCode.PRELOAD_LOST for one in causes):
        return unknown(NAME, '-', 'not known: something else has changed the friction more')
    measured = all(one.temperature_measured for one in change.points)
    chis = np.array([_misfit(change, model, share) for share in SHARES])
    if not np.isfinite(chis).any():
        return unknown(NAME, '-', 'not known: the companions do not reach these places')
    best = int(np.nanargmin(chis))
    scale = birge(float(chis[best]), max(len(change.groups) - 1, 1))
    within = SHARES[chis <= chis[best] + INTERVAL * scale]
    if within[-1] - within[0] > WIDEST or best == 0:
        why = 'wiper, warmth and preload look alike at these speeds and loads'
        more = '' if measured else '; measure the oil temperature'
        return unknown(NAME, '-', f'not known: {why}{more}')
    step, value = float(SHARES[1] - SHARES[0]), float(SHARES[best])
    return Quantity(
        name=NAME,
        value=value,
        low=float(within[0]) - 0.5 * step,
        high=float(within[-1]) + 0.5 * step,
        evidence=f'{len(change.groups)} places, beside a constant drag',
    )


def _misfit(change: Change, model: Model, share: float) -> float:
    """
    Return minus twice the logarithm of the likelihood at a share of the preload [-].

    Up to a constant: chi squared, and the determinant of the covariance, which the doubt of the
    law makes grow with the loss, over that without a loss.

    """
    apart = change.change - model.relieved(change.points, share)
    if not np.isfinite(apart).all():
        return math.nan
    drag = np.full_like(apart, DRAG_DOUBT * change.friction.mean())
    law = LAW_DOUBT * math.log(share) * change.friction
    inverse, beside = np.linalg.inv(change.covariance), np.stack([drag, law], axis=1)
    pull = beside.T @ inverse @ apart
    normal = beside.T @ inverse @ beside + np.eye(2)
    chi = float(apart @ inverse @ apart - pull @ np.linalg.solve(normal, pull))
    return chi + math.log(float(np.linalg.det(normal)) / float(normal[0, 0]))
