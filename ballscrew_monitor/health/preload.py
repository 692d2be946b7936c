# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The preload that is left, beside what a wiper and another warmth of the contacts may add.

For each share of the preload the size of a constant drag and of a shift in temperature are those
of least chi squared; the shift is known to a few kelvin where the oil temperature is measured.

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
MEASURED_SHIFT, ASSUMED_SHIFT = 2.0, 10.0
"""Standard deviation of the temperature at the contacts from that in use [K]."""
WIDEST = 0.4
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
    chis = np.array([_chi(change, model, share, measured) for share in SHARES])
    if not np.isfinite(chis).any():
        return unknown(NAME, '-', 'not known: the companions do not reach these places')
    best = int(np.nanargmin(chis))
    spare = max(len(change.groups) - 1, 1)
    within = SHARES[chis <= chis[best] + INTERVAL * birge(float(chis[best]), spare)]
    if within[-1] - within[0] > WIDEST or best == 0:
        why = 'wiper, warmth and preload look alike at these speeds and loads'
        more = '' if measured else '; measure the oil temperature'
        return unknown(NAME, '-', f'not known: {why}{more}')
    step = float(SHARES[1] - SHARES[0])
    return Quantity(
        name=NAME,
        value=float(SHARES[best]),
        low=float(within[0]) - 0.5 * step,
        high=float(within[-1]) + 0.5 * step,
        evidence=f'{len(change.groups)} places, beside a constant drag and '
        f'{MEASURED_SHIFT if measured else ASSUMED_SHIFT:g} K at the contacts',
    )


def _chi(change: Change, model: Model, share: float, measured: bool) -> float:
    """Return the least chi squared at a share of the preload [-]."""
    shift = MEASURED_SHIFT if measured else ASSUMED_SHIFT
    apart = change.change - model.relieved(change.points, share)
    warmth = model.warmer(change.points, shift)
    if not np.isfinite(apart).all():
        return math.nan
    drag = change.friction.mean() * np.ones_like(apart)
    design = np.stack([drag, np.nan_to_num(warmth)], axis=1)
    inverse = np.linalg.inv(change.covariance)
    normal = design.T @ inverse @ design + np.diag([1.0, 1.0])
    sizes = np.linalg.solve(normal, design.T @ inverse @ apart)
    rest = apart - design @ sizes
    return float(rest @ inverse @ rest + sizes @ sizes)
