# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Estimates and zones of many rows at once.

What `estimate` and `judge` say of a single point, by the same lookup.

"""

import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.estimate import (
    ContactState,
    DOMINANT_RCS,
    estimate,
    MachinePoint,
    PointEstimate,
    PointSource,
    PointValidity,
)
from ballscrew_monitor.core.judgement import judge, Limits, Verdict, Zone
from ballscrew_monitor.recordings.bulk.levels import Sign
from ballscrew_monitor.recordings.columns import BY_VALIDITY, LIGHT_LOAD, Reason, STANDSTILL
from ballscrew_monitor.recordings.rows import gate_bits, reason_of
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import FILM_RATIO_LIMITS, look_up_many, Surface, Validity

Array = NDArray[np.float64]
Codes = NDArray[np.uint8]

_REASONS = np.array([BY_VALIDITY[each] for each in sorted(BY_VALIDITY)], dtype=np.uint8)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Points:
    """Operating points; speed [rad/s], axial_load [N], temperature [K], motor_torque [N m]."""

    speed: Array
    axial_load: Array
    temperature: Array
    motor_torque: Array
    speed_source: Codes
    axial_load_source: Codes
    temperature_source: Codes
    motor_torque_source: Codes
    direction: Codes
    held: NDArray[np.bool_]

    def point(self, at: int) -> MachinePoint:
        """Return one of the points."""
        return MachinePoint(
            speed=float(self.speed[at]),
            axial_load=float(self.axial_load[at]),
            temperature=float(self.temperature[at]),
            motor_torque=float(self.motor_torque[at]),
            speed_source=PointSource(int(self.speed_source[at])),
            axial_load_source=PointSource(int(self.axial_load_source[at])),
            temperature_source=PointSource(int(self.temperature_source[at])),
            motor_torque_source=PointSource(int(self.motor_torque_source[at])),
            direction=Direction(int(self.direction[at])),
            direction_held=bool(self.held[at]),
        )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Judgements:
    """
    Columns of what the model says of points, and `sign` for the held level.

    efficiency, rcs and film_ratio [-], friction_torque and machine_torque [N m].

    """

    validity: Codes
    efficiency: Array
    rcs: Array
    film_ratio: Array
    friction_torque: Array
    machine_torque: Array
    worst_nut: Codes
    regime: Codes
    contact_state: Codes
    gates: Codes
    zone: Codes
    reason: Codes
    sign: Codes

    def put(self, at: int, point: MachinePoint, result: PointEstimate, verdict: Verdict) -> None:
        """Set what the model says of one point."""
        numbers = result.numbers
        values: dict[str, Any] = {
            'validity': result.validity,
            'efficiency': result.efficiency,
            'rcs': result.rcs,
            'film_ratio': result.film_ratio,
            'friction_torque': math.nan if numbers is None else numbers.friction_torque,
            'machine_torque': result.machine_torque,
            'worst_nut': result.worst_nut,
            'regime': result.regime,
            'contact_state': result.contact_state,
            'gates': gate_bits(verdict),
            'zone': verdict.zone,
            'reason': reason_of(point, result, verdict),
            'sign': sign_of(verdict),
        }
        for name, value in values.items():
            getattr(self, name)[at] = value


def sign_of(verdict: Verdict) -> Sign:
    """Return what a verdict does to the level."""
    if verdict.zone is Zone.OPTIMAL:
        return Sign.CLEAR if verdict.clear else Sign.OPTIMAL
    return Sign.OUTSIDE if verdict.zone is Zone.OUTSIDE else Sign.NONE


class Estimator:
    """Judges many points of one surface under the same limits."""

    def __init__(self, surface: Surface, limits: Limits) -> None:
        """Lay out the tables of the surface."""
        self.surface, self.limits = surface, limits

    def single(self, point: MachinePoint) -> tuple[PointEstimate, Verdict]:
        """Return estimate and verdict of one point, as the monitor makes them."""
        result = estimate(point, self.surface, rcs_limit=self.limits.rcs)
        return result, judge(point, result, self.limits)

    def __call__(self, points: Points) -> Judgements:
        """Return what the model says of points."""
        lost = _lost(points)
        opposing = np.where(
            points.direction == Direction.POSITIVE, 0.0 - points.axial_load, points.axial_load
        )
        found = look_up_many(self.surface, np.abs(points.speed), opposing, points.temperature)
        validity = np.where(points.direction == 0, PointValidity.UNKNOWN, found['validity'])
        validity = np.where(lost.any(axis=0), PointValidity.NO_INPUT, validity).astype(np.uint8)
        valid = validity == Validity.VALID
        names = ('friction_torque', 'rcs', 'film_ratio', 'efficiency', 'driving_torque')
        friction, rcs, film, efficiency, driving = (
            np.where(valid, found[name], np.nan) for name in names
        )
        gates = self._gates(points)
        return Judgements(
            validity=validity,
            efficiency=efficiency,
            rcs=rcs,
            film_ratio=film,
            friction_torque=friction,
            machine_torque=np.where(
                points.direction == Direction.NEGATIVE, 0.0 - driving, driving
            ),
            worst_nut=_nuts(np.where(valid, found['worst_contact'], -1), points.axial_load),
            regime=_regimes(film),
            contact_state=self._contact_states(rcs),
            gates=gates,
            **self._zones(validity, gates, rcs, efficiency, lost),
        )

    def _gates(self, points: Points) -> Codes:
        still = (np.abs(points.speed) < self.limits.standstill_speed) & (
            points.speed_source != PointSource.HELD
        )
        light = (np.abs(points.axial_load) < self.limits.light_load) & (
            points.axial_load_source != PointSource.HELD
        )
        return (STANDSTILL * still + LIGHT_LOAD * light).astype(np.uint8)

    def _contact_states(self, rcs: Array) -> Codes:
        bands = [rcs < self.limits.rcs, rcs < DOMINANT_RCS, rcs >= 0.0]
        names = [ContactState.NONE, ContactState.PARTIAL, ContactState.DOMINANT]
        return np.select(bands, names, ContactState.UNKNOWN).astype(np.uint8)

    def _zones(
        self, validity: Codes, gates: Codes, rcs: Array, efficiency: Array, lost: NDArray[np.bool_]
    ) -> dict[str, Codes]:
        """Return zone, reason and sign."""
        limits, light = self.limits, gates & LIGHT_LOAD != 0
        still = gates & STANDSTILL != 0
        known = (validity == PointValidity.VALID) & ~still & ~np.isnan(rcs + efficiency)
        outside = (rcs >= limits.rcs) | (~light & (efficiency < limits.efficiency))
        zone = np.where(known, np.where(outside, Zone.OUTSIDE, Zone.OPTIMAL), Zone.UNKNOWN)
        clear = rcs < limits.rcs_to_clear
        clear &= light | (efficiency >= limits.efficiency_to_clear)
        sign = np.where(outside, Sign.OUTSIDE, np.where(clear, Sign.CLEAR, Sign.OPTIMAL))
        reason = np.where(still, Reason.STANDSTILL, _REASONS[validity])
        absent = (validity == PointValidity.NO_INPUT) & ~still
        if absent.any():
            reason[absent] = _lost_reasons(lost[:, absent])
        return {
            'zone': zone.astype(np.uint8),
            'reason': np.where(known, Reason.JUDGED, reason).astype(np.uint8),
            'sign': np.where(known, sign, Sign.NONE).astype(np.uint8),
        }


def _lost(points: Points) -> NDArray[np.bool_]:
    """Return a row for speed, load and temperature each: whether it cannot be used."""
    held = PointSource.HELD
    lost = np.stack(
        [
            ~np.isfinite(points.speed) | (points.speed_source == held),
            ~np.isfinite(points.axial_load) | (points.axial_load_source == held),
            ~np.isfinite(points.temperature) | (points.temperature_source == held),
        ]
    )
    # Finite numbers with an infinite sum are beyond any range, all of them.
    with np.errstate(invalid='ignore', over='ignore'):
        total = points.speed + points.axial_load + points.temperature
    return lost | (~lost.any(axis=0) & ~np.isfinite(total))


def _lost_reasons(lost: NDArray[np.bool_]) -> Codes:
    single = np.select(list(lost), [Reason.NO_SPEED, Reason.NO_LOAD, Reason.NO_TEMPERATURE])
    return np.where(lost.sum(axis=0) == 1, single, Reason.NO_INPUTS).astype(np.uint8)


def _nuts(contact: NDArray[np.int64], load: Array) -> Codes:
    """Return the nut of the worst contact in the machine frame."""
    nut = contact // 2 + 1
    positive = (nut == 1) == (load > 0.0)
    names = np.where(positive, Nut.POSITIVE, Nut.NEGATIVE)
    known = ((nut == 1) | (nut == 2)) & (np.abs(load) > 0.0)
    return np.where(known, names, Nut.UNKNOWN).astype(np.uint8)


def _regimes(film: Array) -> Codes:
    regime = np.searchsorted(FILM_RATIO_LIMITS, film, 'right') + 1
    return np.where(np.isnan(film), 0, regime).astype(np.uint8)
