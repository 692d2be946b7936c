# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Plain twin of `judge/derived_load.py`: the load of a motor torque over arrays of all loads.

Every crossing is refined, not only the first and the last one.

"""

from collections.abc import Callable
import dataclasses
import math

from ballscrew_monitor.core.conversions import axial_load, Direction, machine_torque
from ballscrew_monitor.core.state import LoadDerivation
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface, Validity
from surrogate.units import TURN

NAN = math.nan
TOLERANCE = 1e-6  # [N] of the last step to a root, which converges faster than linearly
MOST_STEPS = 60
STANDSTILL = 'the screw stands still, friction may hold any part of the load'
NO_ACCELERATION = 'the acceleration is not known yet, and with it the torque that inertia takes'
Array = NDArray[np.float64]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class DerivedLoad:
    """
    A load [N] in the machine frame and the half width of the range in which it lies [N].

    Both are NaN unless `validity` is VALID; `reason` is why not, as a sentence.

    """

    validity: Validity = Validity.UNKNOWN
    axial_load: float = NAN
    uncertainty: float = NAN
    reason: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Running:
    """
    How the screw runs, in the machine frame.

    speed [rad/s], acceleration and by how much it changes of late [rad/s2], motor_torque [N m],
    temperature [K].

    """

    speed: float
    acceleration: float
    acceleration_change: float
    motor_torque: float
    temperature: float
    direction: Direction


def derive_load(running: Running, surface: Surface, settings: LoadDerivation) -> DerivedLoad:
    """Return the load that the torque of a moving screw stands for, or why it is not known."""
    taken = settings.inertia * running.acceleration if settings.inertia else 0.0
    if math.isnan(taken):
        return DerivedLoad(reason=NO_ACCELERATION)
    drag = surface.drag(running.speed)
    parts, measured = abs(taken) + drag, abs(running.motor_torque)
    if parts > settings.largest_share * measured:
        return DerivedLoad(
            reason=f'inertia and drag take {parts:.3g} N m and the torque is {measured:.3g} N m, '
            f'allowed is a share of {settings.largest_share:g}: too little is left for the load'
        )
    driving = machine_torque(running.motor_torque - taken, running.direction)
    margin = settings.torque_uncertainty + settings.parts_uncertainty * parts
    if settings.inertia:
        margin += settings.inertia * running.acceleration_change
    return _machine(_solve(surface, running, driving, margin), running.direction)


def _machine(found: DerivedLoad, direction: Direction) -> DerivedLoad:
    """Return a load that opposes the motion in the machine frame."""
    return dataclasses.replace(found, axial_load=axial_load(found.axial_load, direction))


def _solve(surface: Surface, running: Running, driving: float, margin: float) -> DerivedLoad:
    """
    Return the opposing load of a driving torque [N m] that is known within a margin [N m].

    Several loads are one answer where the margin cannot tell them apart.

    """
    speed, temperature = abs(running.speed), running.temperature
    loads, torques = surface.driving_torques(speed, temperature)
    known = np.flatnonzero(np.isfinite(torques))
    if not known.size:
        middle = float(loads[len(loads) // 2])
        validity = Validity(int(surface.lookup(speed, middle, temperature).validity))
        return DerivedLoad(validity=Validity.MASKED if validity == Validity.VALID else validity)
    loads, excess = loads[known], torques[known] - driving
    places = np.flatnonzero((excess[1:] > 0) != (excess[:-1] > 0))
    if not places.size:
        return _outside(loads, driving)
    if np.any(np.diff(known)[places] > 1):
        return DerivedLoad(validity=Validity.MASKED)

    def rest(load: float) -> float:
        return surface.lookup(speed, load, temperature).driving_torque - driving

    roots = [
        _root(rest, *(float(end) for end in (loads[i], loads[i + 1], excess[i], excess[i + 1])))
        for i in places
    ]
    return _answer(surface, running, roots, loads, excess, margin)


def _answer(
    surface: Surface,
    running: Running,
    roots: list[float],
    loads: Array,
    excess: Array,
    margin: float,
) -> DerivedLoad:
    """Return the only load, the middle of several within the margin, or why there is none."""
    per_newton = surface.lead / TURN  # [N m] of torque for a load without friction
    if roots[-1] - roots[0] > 2.0 * margin / per_newton:
        return DerivedLoad(
            reason=f'the torque is that of several loads, from {roots[0]:.4g} to '
            f'{roots[-1]:.4g} N that oppose the motion'
        )
    load = 0.5 * (roots[0] + roots[-1])
    point = surface.lookup(abs(running.speed), load, running.temperature)
    if point.validity != Validity.VALID or math.isnan(load):
        return DerivedLoad(validity=Validity.MASKED)
    errors = (point.friction_torque_error, point.friction_torque_stderr)
    margin += math.fsum(error for error in errors if math.isfinite(error))
    return DerivedLoad(
        validity=Validity.VALID,
        axial_load=load,
        uncertainty=_reach(load, loads, excess, margin, per_newton),
    )


def _outside(loads: Array, driving: float) -> DerivedLoad:
    return DerivedLoad(
        validity=Validity.LOAD_OUT_OF_RANGE,
        reason=f'the torque along the motion, {driving:.3g} N m, asks for a load outside the '
        f'surface, {loads[0]:.4g} to {loads[-1]:.4g} N that oppose the motion',
    )


def _reach(load: float, loads: Array, excess: Array, margin: float, per_newton: float) -> float:
    """
    Return how far from `load` [N] a load may lie whose excess torque [N m] is within the margin.

    Linear between the scanned loads; beyond their ends friction counts as constant.

    """
    places = [loads[np.abs(excess) <= margin]]
    for level in (-margin, margin):
        i = np.flatnonzero((excess[1:] > level) != (excess[:-1] > level))
        part = (level - excess[i]) / (excess[i + 1] - excess[i])
        places.append(loads[i] + part * (loads[i + 1] - loads[i]))
    reach = float(np.abs(np.concatenate(places) - load).max(initial=0.0))
    for end, left in ((loads[0], excess[0] + margin), (loads[-1], margin - excess[-1])):
        if left > 0.0:
            reach = max(reach, abs(float(end) - load) + float(left) / per_newton)
    return reach


def _root(
    rest: Callable[[float], float], low: float, high: float, below: float, above: float
) -> float:
    """
    Return the root between two loads [N] with rests [N m] of unlike sign; NaN if it is lost.

    Anderson and Bjorck, BIT 13 (1973) 253: the secant, with the rest of an end that stays made
    smaller.

    """
    if above == 0.0:
        return high
    for _ in range(MOST_STEPS):
        middle = (low * above - high * below) / (above - below)
        here = rest(middle)
        if here == 0.0 or math.isnan(here):
            return middle if here == 0.0 else NAN
        if (here > 0.0) is (above > 0.0):
            smaller = 1.0 - here / above
            below *= smaller if smaller > 0.0 else 0.5
        else:
            low, below = high, above
        moved = abs(middle - high)
        high, above = middle, here
        if moved <= TOLERANCE:
            return middle
    return NAN
