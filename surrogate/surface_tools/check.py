# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Re-measure a surface: fresh solves at random points, by the solver of its tier.

Random points are neither nodes nor the centres of cells at which a builder measures its errors.

"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import math
import random
from typing import Any

import numpy as np
from surrogate.builder.tiers import solve_point
from surrogate.formulas import torque
from surrogate.surface import Surface
from surrogate.surface.aims import EFFICIENCY_TOLERANCE, rcs_tolerance
from surrogate.surface.file import SurfaceData

STATED_FACTOR = 3.0
"""Largest error found over one that the file states [-]; it is stated for few places of a cell,
which are not the worst."""
STATED = ('friction_torque', 'rcs')


@dataclass(frozen=True, kw_only=True, slots=True)
class CheckResult:
    """
    What a check found.

    Points asked for, points tried, those that the solver or the surface had no number for, those
    that miss what is aimed at; largest error of efficiency [-] and of RCS over that aimed at [-];
    largest of either over what is accepted [-], which is what is aimed at or, where that is more,
    `STATED_FACTOR` times what the file states for the cell; largest of each of `STATED` over the
    largest that the file states [-], NaN where it states none.

    """

    asked: int
    tried: int
    unsolved: int
    silent: int
    missed: int
    efficiency: float
    rcs: float
    accepted: float
    stated: Mapping[str, float]

    @property
    def passed(self) -> bool:
        """Whether something was compared, everything answered, and all is within the limits."""
        # Written so that a NaN fails, but for errors that the file does not state.
        return (
            self.accepted <= 1.0
            and not self.silent
            and not any(ratio > STATED_FACTOR for ratio in self.stated.values())
        )

    def sentence(self) -> str:
        """Return the result in words."""
        stated = ', '.join(
            f'{name.replace("_", " ")} {ratio:.2g}' if math.isfinite(ratio) else f'{name} not said'
            for name, ratio in self.stated.items()
        )
        verdict = 'passed' if self.passed else 'FAILED'
        return (
            f'{verdict}, hash verified, {self.tried} of {self.asked} '
            f'points solved, {self.silent} without an answer, {self.unsolved} without a solution, '
            f'largest error: efficiency {self.efficiency:.2g} (aim {EFFICIENCY_TOLERANCE}), '
            f'RCS {100 * self.rcs:.0f} % of the aim, {self.missed} points miss an aim; over '
            f'the aim or {STATED_FACTOR:g} times what the file states for the cell: '
            f'{self.accepted:.2g} (allowed 1); over the largest that it states: {stated} '
            f'(allowed {STATED_FACTOR:g})'
        )


def check_surface(
    data: SurfaceData,
    points: int,
    seed: int,
    has_time: Callable[[], bool],
    step: Callable[[], None] = lambda: None,
) -> CheckResult:
    """
    Compare at up to `points` random points, as long as `has_time` says so before each.

    Calls `step` after each.

    """
    surface, drawn = Surface(data), random.Random(seed)
    errors: list[dict[str, float]] = []
    tried = unsolved = silent = 0
    while tried < points and has_time():
        error = _compare(surface, data.header, drawn)
        step()
        tried += 1
        unsolved += error is None
        if error is not None and all(map(math.isfinite, error.values())):
            errors.append(error)
        else:
            silent += error is not None
    worst = {
        name: max((error[name] for error in errors), default=math.nan)
        for name in ('efficiency', 'rcs_over_aim', 'accepted', *STATED)
    }
    stated = {name: surface.errors[name][0] for name in STATED}
    return CheckResult(
        asked=points,
        tried=tried,
        unsolved=unsolved,
        silent=silent,
        missed=sum(
            error['efficiency'] > EFFICIENCY_TOLERANCE or error['rcs_over_aim'] > 1
            for error in errors
        ),
        efficiency=worst['efficiency'],
        rcs=worst['rcs_over_aim'],
        accepted=worst['accepted'],
        stated={
            name: worst[name] / most if most > 0 else math.nan for name, most in stated.items()
        },
    )


def _compare(
    surface: Surface, header: Mapping[str, Any], drawn: random.Random
) -> dict[str, float] | None:
    """
    Return the errors at a random point: NaN without an answer, None without a solution.

    Of the efficiency [-], of RCS over that aimed at [-], the larger of both over what is accepted
    [-], and of each of `STATED`.

    """
    slow, fast = surface.speed_range
    speed = math.exp(drawn.uniform(math.log(slow), math.log(fast)))
    load = drawn.uniform(*surface.load_range)
    kelvin = drawn.uniform(*surface.temperature_range)
    solved = solve_point(header, speed, load, kelvin)
    if not (solved.converged and math.isfinite(solved.rcs)):
        return None
    point, rcs = surface.lookup(speed, load, kelvin), solved.rcs
    aim = rcs_tolerance(rcs)
    errors = {name: abs(getattr(point, name) - getattr(solved, name)) for name in STATED}
    efficiency = torque.efficiency(solved.friction_torque, load, surface.lead)
    wrong = abs(point.efficiency - efficiency)
    return {
        'efficiency': wrong,
        'rcs_over_aim': errors['rcs'] / aim,
        'accepted': max(
            wrong / _larger(EFFICIENCY_TOLERANCE, point.efficiency_error),
            errors['rcs'] / _larger(aim, point.rcs_error),
        ),
        **errors,
    }


def _larger(aim: float, stated: float) -> float:
    """Return what is accepted: the aim, or more where a cell states more."""
    return float(np.fmax(aim, STATED_FACTOR * stated))
