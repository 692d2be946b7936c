# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the full tier as a record: plain numbers for JSON, beside the classical formulas."""

import math
import time
from typing import Any

import numpy as np
from surrogate.ball_motion import BallMotion, slip_field, slip_floor
from surrogate.contact_friction import contact_friction
from surrogate.nut import ScrewContact, ScrewSettings
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.point import closed_form_record, regime
from surrogate.screw import ScrewSolution, solve_screw, TIER


def full_record(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    settings: ScrewSettings | None = None,
) -> dict[str, Any]:
    """
    Solve one point in the full tier and return it as plain numbers, SI units, NaN where unknown.

    The keys are those of the closed-form record, with its warnings about ratings and its
    comparators.

    """
    started = time.perf_counter()
    found = solve_screw(screw, lubricant, point, settings=settings)
    formulas = closed_form_record(screw, lubricant, point)
    contacts = [_contact_record(screw, found, contact) for contact in found.contacts]
    worst = min(contacts, key=_thickness)
    return formulas | {
        'tier': TIER,
        'status': found.status,
        'warnings': [text for text in formulas['warnings'] if 'outside its range' not in text],
        'efficiency': found.efficiency,
        'friction_torque_Nm': found.friction_torque,
        'driving_torque_Nm': found.driving_torque,
        'energy_error': found.energy_error,
        'back_driving': found.back_driving,
        'rcs': found.rcs,
        'asperity_share': found.asperity_share,
        'film_ratio': found.film_ratio,
        'regime': regime(found.film_ratio),
        'central_film_m': found.central_film,
        'minimum_film_m': _least(contacts, 'minimum_film_m'),
        'friction_coefficient': _mean_friction(contacts),
        'max_pressure_Pa': _most(contacts, 'max_pressure_Pa'),
        'worst_contact': {key: worst[key] for key in ('nut', 'side')},
        'contact_angle_A_rad': contacts[0]['contact_angle_rad'],
        'contact_angle_B_rad': contacts[1]['contact_angle_rad'],
        'contacts': contacts,
        'wall_s': time.perf_counter() - started,
    }


def _contact_record(screw: Screw, found: ScrewSolution, contact: ScrewContact) -> dict[str, Any]:
    """Return one contact; NaN with a reason where it carries no load or was not solved."""
    rough, ball = contact.rough, contact.ball
    head = {'nut': contact.nut, 'side': contact.side}
    if rough is None:
        return head | _unknown('no load on this nut, so no contact') | {'normal_force_N': 0.0}
    return head | {
        'reason': '' if found.converged else found.status,
        'normal_force_N': ball.normal_force,
        'contact_angle_rad': ball.angle,
        'semi_axis_x_m': rough.semi_axis_x,
        'semi_axis_y_m': rough.semi_axis_y,
        'hertz_pressure_Pa': rough.hertz_pressure,
        'max_pressure_Pa': rough.max_pressure,
        'central_film_m': contact.film_ratio * screw.roughness.rms,
        'minimum_film_m': rough.minimum_film,
        'film_ratio': contact.film_ratio,
        'rcs': rough.rcs,
        'asperity_share': rough.asperity_share,
        'friction_coefficient': _friction(screw, contact),
        'rolling_force_N': rough.rolling_force + rough.rolling_tail,
        'sliding_torque_Nm': screw.loaded_balls_per_nut * ball.slip_power / _speed(contact),
        'rolling_torque_Nm': screw.loaded_balls_per_nut * ball.rolling_power / _speed(contact),
    }


def _unknown(reason: str) -> dict[str, Any]:
    names = (
        'contact_angle_rad',
        'semi_axis_x_m',
        'semi_axis_y_m',
        'hertz_pressure_Pa',
        'max_pressure_Pa',
        'central_film_m',
        'minimum_film_m',
        'film_ratio',
        'rcs',
        'asperity_share',
        'friction_coefficient',
        'rolling_force_N',
        'sliding_torque_Nm',
        'rolling_torque_Nm',
    )
    return {'reason': reason} | dict.fromkeys(names, math.nan)


def _speed(contact: ScrewContact) -> float:
    """Return the screw speed of the balance [rad/s]."""
    return contact.motion.screw_speed if contact.motion else math.nan


def _friction(screw: Screw, contact: ScrewContact) -> float:
    """Return the mean traction against the slip over the load [-], at the balanced motion."""
    motion, rough = contact.motion, contact.rough
    if motion is None or rough is None:
        return math.nan
    slip_x, slip_y = _slip(screw, contact, motion)
    return contact_friction(
        rough,
        slip_x=slip_x,
        slip_y=slip_y,
        asperity_friction=screw.roughness.asperity_friction,
        slip_floor=slip_floor(screw, motion.screw_speed),
    ).coefficient


def _slip(
    screw: Screw, contact: ScrewContact, motion: BallMotion
) -> tuple[np.ndarray[Any, np.dtype[np.float64]], np.ndarray[Any, np.dtype[np.float64]]]:
    assert contact.rough is not None
    x, y = np.meshgrid(contact.rough.x, contact.rough.y, indexing='ij')
    return slip_field(screw, contact.side, motion, x, y)


def _thickness(contact: dict[str, Any]) -> float:
    ratio = contact['film_ratio']
    return math.inf if math.isnan(ratio) else float(ratio)


def _mean_friction(contacts: list[dict[str, Any]]) -> float:
    """Return the friction coefficient over all normal forces [-]."""
    pressed = [contact for contact in contacts if contact['normal_force_N'] > 0]
    total = sum(contact['normal_force_N'] for contact in pressed)
    friction = sum(
        contact['normal_force_N'] * contact['friction_coefficient'] for contact in pressed
    )
    return friction / total if total else math.nan


def _least(contacts: list[dict[str, Any]], key: str) -> float:
    return min((c[key] for c in contacts if not math.isnan(c[key])), default=math.nan)


def _most(contacts: list[dict[str, Any]], key: str) -> float:
    return max((c[key] for c in contacts if not math.isnan(c[key])), default=math.nan)
