# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Model fitted to a run: torque on the screw by its parameters, with their ranges and scales.

The parasitic parts, the offset and the seal are linear with exact derivatives; viscosity, asperity
friction and onset act through the contacts.

"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
import itertools
import math
from operator import itemgetter

import numpy as np
from scipy.optimize import nnls
from surrogate.files import InputError
from surrogate.identify.data import Array, NoLoadRun
from surrogate.identify.model import (
    ContactModel,
    FRICTION_BOUNDS,
    ONSET_BOUNDS,
    ONSET_FRICTIONS,
    VISCOSITY_BOUNDS,
)
from surrogate.parameters import Screw
from surrogate.units import digits, RPM

SPARE_POINTS, SPEED_SPAN = 2, 2.0
"""Points beyond the number of parameters, largest speed over smallest [-]: the least accepted."""
LARGEST_TORQUE = 1e3
"""Upper bound of both parasitic parts, that of the datasheet [N m], [N m s/rad]."""
SEAL_SLIDING = np.geomspace(0.003, 0.5, 16)
"""Sliding speeds at the pitch radius over which the friction of a seal may fade [m/s]."""
FADE_VALUES = 2
"""Sliding speed and power, which are fitted beside the named parameters."""
FINER = (1 / 4, 1 / 8, 1 / 16, 1 / 32, 1 / 64)
"""Octaves by which the sliding speed that fits best is refined, half as many as the power."""
SEAL_POWERS = (0.5, 1.0, 2.0)
"""Powers of the speed by which it may fade [-], from Armstrong-Helouvry et al. (1994)."""
ONSET_SPEEDS, SAME_SPEED = 8, 1.05
"""Speeds from which on an onset is fitted; ratio from which on two of them differ [-]."""
STEP = 1e-3
"""Step of the differences over a parameter's range [-]."""
NO_EFFECT = 1e-6
"""Change of the torque over a parameter's range that counts as none, relative [-]."""
AT_BOUND = 1e-9
"""Distance from a bound that counts as none, over the scale of the parameter [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DragProblem:
    """
    A run, its contacts, and the parameters in SI units.

    Names, size by which each is scaled, bounds, value in the datasheet; torque of the load at
    every point [N m]; share of the boundary friction of a seal that is left there [-].

    """

    run: NoLoadRun
    contacts: ContactModel
    names: tuple[str, ...]
    scale: Array
    low: Array
    high: Array
    start: Array
    load_torque: Array
    fade: Array

    def torque(self, values: Array) -> Array:
        """Return the torque on the screw [N m]."""
        run, given = self.run, dict(zip(self.names, values, strict=True))
        return (
            run.direction * (self.contact_torque(values) + given['parasitic_torque'])
            + given['parasitic_torque_rate'] * run.speed
            + given.get('torque_offset', 0.0)
            + given.get('seal_torque', 0.0) * run.direction * self.fade
            + self.load_torque
        )

    def contact_torque(self, values: Array) -> Array:
        """Return the friction torque of the contacts [N m]."""
        given = dict(zip(self.names, values, strict=True))
        sheet = self.contacts.screw.roughness
        return self.contacts.torque(
            float(given.get('viscosity_factor', 1.0)),
            float(given.get('asperity_friction', sheet.asperity_friction)),
            float(given.get('onset_factor', sheet.onset_factor)),
        )

    def residual(self, values: Array) -> Array:
        """Return measured minus modelled torque [N m]."""
        return self.run.torque - self.torque(values)

    def jacobian(self, values: Array) -> Array:
        """Return the derivative of the torque by each parameter, one column each."""
        run = self.run
        exact = {
            'parasitic_torque': run.direction,
            'parasitic_torque_rate': run.speed,
            'torque_offset': np.ones_like(run.speed),
            'seal_torque': run.direction * self.fade,
        }
        columns = [
            exact[name] if name in exact else run.direction * self._slope(values, place)
            for place, name in enumerate(self.names)
        ]
        return np.stack(columns, axis=1)

    def _slope(self, values: Array, place: int) -> Array:
        step = STEP * (self.high[place] - self.low[place])
        up, down = values.copy(), values.copy()
        up[place] = min(values[place] + step, self.high[place])
        down[place] = max(values[place] - step, self.low[place])
        rise = self.contact_torque(up) - self.contact_torque(down)
        return np.asarray(rise / (up[place] - down[place]))

    def with_best_fade(
        self, start: Array, held: Iterable[str], sigma: Array
    ) -> tuple['DragProblem', Array]:
        """
        Return the problem whose seal fades as the points ask for, and what they ask of the rest.

        It starts from `SEAL_SLIDING` and `SEAL_POWERS`, by least squares over `sigma` [N m] at the
        onset factor of `start`; the torque is linear in all else that is not `held`.

        """
        outer = {'onset_factor', 'seal_torque'} | set(held)
        free = [place for place, name in enumerate(self.names) if name not in outer]
        free.append(self.names.index('seal_torque'))
        either, least = np.isinf(self.low[free]), start.copy()
        least[free] = np.where(either, 0.0, self.low[free])
        rest, room = self.residual(least) / sigma, (self.high - least)[free]
        columns = self.jacobian(least)[:, free] / sigma[:, None]
        sliding = self.contacts.screw.pitch_radius * np.abs(self.run.speed)

        def faded(power: float, over: float) -> tuple[float, float, float, Array, Array]:
            fade = np.exp(-((sliding / over) ** power))
            columns[:, -1] = self.run.direction * fade / sigma
            amounts, norm = _bounded(columns, rest, room, either)
            return norm, power, over, fade, amounts

        tried = [faded(*fade) for fade in itertools.product(SEAL_POWERS, SEAL_SLIDING.tolist())]
        for step in 2.0 ** np.array(FINER):
            _, power, over, *_ = min(tried, key=itemgetter(0))
            tried += [faded(power, over * step), faded(power, over / step)]
            _, power, over, *_ = min(tried, key=itemgetter(0))
            tried += [faded(power * step**2, over), faded(power / step**2, over)]
        *_, fade, amounts = min(tried, key=itemgetter(0))
        least[free] += amounts
        return replace(self, fade=fade), least

    def misfit(self, residual: Array) -> float:
        """
        Return the mean square of what the points of one speed have in common [-].

        Of a `residual` over the standard deviation [-]; both directions of one speed repeat an
        error of the model, and not the noise.

        """
        order = np.argsort(np.abs(self.run.speed))
        speed = np.abs(self.run.speed)[order]
        group = np.cumsum(np.append(0, speed[1:] >= SAME_SPEED * speed[:-1]))
        along = np.bincount(group, (self.run.direction * residual)[order])
        # An offset is what directions do not have in common; the fade is fitted, too.
        freedom = len(along) - len(self.names) - FADE_VALUES + ('torque_offset' in self.names)
        squares = float(np.sum(along**2 / np.bincount(group)))
        return squares / freedom if freedom > 0 else math.nan

    def without_effect(self, values: Array) -> dict[str, str]:
        """Return the parameters on which no point depends near `values`, with the reason."""
        change = np.abs(self.jacobian(values)).max(axis=0) * (self.high - self.low)
        none = change < NO_EFFECT * np.abs(self.run.torque).max()
        return {
            name: 'no point depends on it: kept as in the datasheet'
            for name, nothing in zip(self.names, none, strict=True)
            if nothing
        }

    def at_bounds(self, values: Array) -> dict[str, str]:
        """Return the parameters at an end of their range, with the reason."""
        reasons = {}
        for place, name in enumerate(self.names):
            near = AT_BOUND * self.scale[place]
            if values[place] <= self.low[place] + near:
                reasons[name] = f'at its lower bound {self.low[place]:g}, the data ask for less'
            elif values[place] >= self.high[place] - near:
                reasons[name] = f'at its upper bound {self.high[place]:g}, the data ask for more'
        return reasons


def _bounded(columns: Array, rest: Array, room: Array, either: Array) -> tuple[Array, float]:
    """Return the amounts of columns, from 0 to `room` or of `either` sign, and the norm left."""
    amounts, norm = nnls(np.hstack([columns, -columns[:, either]]), rest)
    own, opposite = np.split(amounts, [len(room)])
    own[either] -= opposite
    over = own > room
    if over.any():
        # An end that is passed without it is where the least squares with it lie.
        rest = rest - columns[:, over] @ room[over]
        own[~over], norm = _bounded(columns[:, ~over], rest, room[~over], either[~over])
        own[over] = room[over]
    return own, float(norm)


def drag_problem(
    screw: Screw, run: NoLoadRun, contacts: ContactModel, fitted: Sequence[str]
) -> DragProblem:
    """
    Return what is fitted: both parasitic parts, the offset if it shows, and those `fitted`.

    Raises InputError for a run from which they cannot follow.

    """
    if not len(run.speed):
        raise InputError(f'{run.source}: holds no point in motion')
    rows = _rows(screw, run, fitted)
    names, scale, low, high, start = zip(*rows)
    problem = DragProblem(
        run=run,
        contacts=contacts,
        names=names,
        scale=np.array(scale),
        low=np.array(low),
        high=np.array(high),
        start=np.clip(start, low, high),
        load_torque=run.load * screw.lead / (2 * math.pi),
        fade=np.zeros_like(run.speed),
    )
    _check(problem)
    return problem


def _rows(
    screw: Screw, run: NoLoadRun, fitted: Sequence[str]
) -> list[tuple[str, float, float, float, float]]:
    """Return name, scale, bounds and value in the datasheet of each parameter."""
    size = float(np.abs(run.torque).mean()) or 1.0
    rate = size / float(np.abs(run.speed).max())
    rough = screw.roughness
    rows = [
        ('parasitic_torque', size, 0.0, LARGEST_TORQUE, screw.parasitic_torque),
        ('parasitic_torque_rate', rate, 0.0, LARGEST_TORQUE, screw.parasitic_torque_rate),
    ]
    if run.both_directions:
        rows.append(('torque_offset', size, -math.inf, math.inf, 0.0))
    if 'viscosity_factor' in fitted:
        rows.append(('viscosity_factor', 0.1, *VISCOSITY_BOUNDS, 1.0))
    if 'asperity_friction' in fitted:
        ends = ONSET_FRICTIONS if 'onset_factor' in fitted else FRICTION_BOUNDS
        rows.append(('asperity_friction', 0.01, *ends, rough.asperity_friction))
    if 'onset_factor' in fitted:
        rows.append(('onset_factor', 0.1, *ONSET_BOUNDS, rough.onset_factor))
    if 'seal_torque' in fitted:
        rows.append(('seal_torque', size, 0.0, LARGEST_TORQUE, 0.0))
    return rows


def _check(problem: DragProblem) -> None:
    fade = FADE_VALUES if 'seal_torque' in problem.names else 0
    run, wanted = problem.run, len(problem.names) + fade + SPARE_POINTS
    speed = np.abs(run.speed) / RPM
    if len(speed) < wanted:
        raise InputError(
            f'{run.source}: has {len(speed)} points in motion, allowed is {wanted} or more for '
            f'{len(problem.names)} parameters ({", ".join(problem.names)})'
        )
    if speed.max() < SPEED_SPAN * speed.min():
        raise InputError(
            f'{run.source}: the speeds reach from {digits(speed.min(), 4)} to '
            f'{digits(speed.max(), 4)} rev/min, allowed is a span of {SPEED_SPAN:g} to 1 or more'
        )
    if 'onset_factor' in problem.names:
        ordered = np.sort(speed)
        number = 1 + int((ordered[1:] >= SAME_SPEED * ordered[:-1]).sum())
        if number < ONSET_SPEEDS:
            raise InputError(
                f'{problem.run.source}: has {number} speeds, allowed are {ONSET_SPEEDS} or more '
                'for the onset of contact, from below the upturn of the torque to well above it'
            )
        if not problem.contacts.screw.composite_rms:
            raise InputError(
                'screw: raceway and balls are smooth, allowed for the onset of contact is an Rq '
                'above 0 in roughness'
            )
    drag = float((run.direction * (run.torque - problem.load_torque)).mean())
    if not run.both_directions and drag <= 0:
        raise InputError(
            f'{run.source}: the mean friction torque is {drag:.3g} N m, allowed is more than 0: '
            'friction has the sign of the motion, so torque and speed must agree in sign'
        )
