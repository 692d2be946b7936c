# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the full tier as a record: plain numbers for JSON, beside the classical formulas."""

import math
import time
from typing import Any

import numpy as np
from surrogate.asperities.law import band_of
from surrogate.formulas.geometry import opposite_flank_approach
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.screw.closed_form_record import closed_form_record, most_wear, with_wear
from surrogate.screw.contacts import ScrewSettings, shortest_on_grid, smooth_film
from surrogate.screw.nut import contact_slip, rolling_force, ScrewContact
from surrogate.screw.solve import ScrewSolution, solve_screw, TIER
from surrogate.surface import regime_of
from surrogate.units import GIGA

LOAD_CHANGE = 0.01
"""Change of a normal force by friction and inertia that is warned about [-]."""
FILM_ERROR = 0.1
"""Estimated error of a central film that is warned about [-]."""
FEWEST_NODES = 4.0
"""Nodes per shortest wave below which a rough contact is warned about [-]."""


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
    started, settings = time.perf_counter(), settings or ScrewSettings()
    found = solve_screw(screw, lubricant, point, settings=settings)
    record = solution_record(screw, lubricant, point, found, settings)
    return record | {'wall_s': time.perf_counter() - started}


def solution_record(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    found: ScrewSolution,
    settings: ScrewSettings,
) -> dict[str, Any]:
    """Return a solved point as plain numbers, SI units, NaN where unknown."""
    formulas = closed_form_record(screw, lubricant, point, inlet_heating=settings.inlet_heating)
    contacts = [
        with_wear(_contact_record(screw, found, contact), _slides(screw, contact))
        for contact in found.contacts
    ]
    worst = found.contacts[found.worst_contact]
    return formulas | {
        'tier': TIER,
        'status': found.status,
        'converged': found.converged,
        'warnings': [
            *_warnings(formulas['warnings'], found),
            *_coarse(found, shortest_on_grid(screw, settings)),
            *_third_contacts(screw, contacts),
            *_uncertain_films(contacts),
        ],
        'efficiency': found.efficiency,
        'friction_torque_Nm': found.friction_torque,
        'driving_torque_Nm': found.driving_torque,
        'energy_error': found.energy_error,
        'load_change': found.load_change,
        'back_driving': found.back_driving,
        'normal_force_loaded_N': found.normal_forces[0],
        'normal_force_relieved_N': found.normal_forces[1],
        'rcs': found.rcs,
        'rcs_deviation': found.rcs_deviation,
        'asperity_share': found.asperity_share,
        **most_wear(contacts),
        'asperity_law': law_sentence(screw, settings),
        'roughness': roughness_sentence(screw.roughness, screw.ball_roughness),
        'film_ratio': found.film_ratio,
        'regime': regime_of(found.film_ratio).word,
        'central_film_m': found.central_film,
        'minimum_film_m': found.minimum_film,
        'friction_coefficient': found.friction_coefficient,
        'max_pressure_Pa': found.max_pressure,
        'worst_contact': {'nut': worst.nut, 'side': worst.side},
        'contact_angle_A_rad': contacts[0]['contact_angle_rad'],
        'contact_angle_B_rad': contacts[1]['contact_angle_rad'],
        'contacts': contacts,
    }


def _contact_record(screw: Screw, found: ScrewSolution, contact: ScrewContact) -> dict[str, Any]:
    """Return one contact; NaN with a reason where it carries no load or was not solved."""
    solved, ball = contact.solved, contact.ball
    head = {'nut': contact.nut, 'side': contact.side}
    if solved is None:
        return head | _unknown('no load on this nut, so no contact') | {'normal_force_N': 0.0}
    pressed, asperities = solved.pressed, solved.asperities
    return head | {
        'reason': '' if found.converged else found.status,
        'normal_force_N': ball.normal_force,
        'contact_angle_rad': ball.angle,
        'semi_axis_x_m': pressed.semi_axis_x,
        'semi_axis_y_m': pressed.semi_axis_y,
        'hertz_pressure_Pa': pressed.hertz_pressure,
        'max_pressure_Pa': pressed.max_pressure,
        'central_film_m': smooth_film(solved.smooth),
        'film_error': solved.smooth.film_error,
        'minimum_film_m': pressed.minimum_film,
        'film_ratio': contact.film_ratio,
        'rcs': asperities.rcs,
        'asperity_share': asperities.asperity_share,
        'friction_coefficient': contact.friction_coefficient,
        'rolling_force_N': rolling_force(screw, solved),
        'opposite_flank_approach_m': opposite_flank_approach(
            screw, contact.side, ball.angle, pressed.approach
        ),
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
        'film_error',
        'minimum_film_m',
        'film_ratio',
        'rcs',
        'asperity_share',
        'friction_coefficient',
        'rolling_force_N',
        'opposite_flank_approach_m',
        'sliding_torque_Nm',
        'rolling_torque_Nm',
    )
    return {'reason': reason} | dict.fromkeys(names, math.nan)


def _slides(screw: Screw, contact: ScrewContact) -> float:
    """Return the mean sliding speed under the pressure of a contact [m/s], NaN if not balanced."""
    if contact.solved is None or contact.motion is None:
        return math.nan
    pressed = contact.solved.pressed
    slip = np.hypot(*contact_slip(screw, pressed, contact.side, contact.motion))
    return float(np.average(slip, weights=pressed.pressure))


def _speed(contact: ScrewContact) -> float:
    """Return the screw speed of the balance [rad/s]."""
    return contact.motion.screw_speed if contact.motion else math.nan


def _warnings(rated: list[str], found: ScrewSolution) -> list[str]:
    """Return the warnings about ratings, and those of the full model."""
    warnings = [text for text in rated if 'outside its range' not in text]
    if found.load_change > LOAD_CHANGE:
        warnings.append(
            f'balls: friction and inertia change a normal force by {100 * found.load_change:.2g} '
            '%, the contacts were solved before that'
        )
    return warnings


def _coarse(found: ScrewSolution, wave: float) -> list[str]:
    """Return a warning where roughness that stands has few nodes per shortest wave [m]."""
    grids = (one.pressed.y for one in found.loaded_contacts)
    least = min((wave / float(y[1] - y[0]) for y in grids), default=math.inf)
    if least >= FEWEST_NODES:
        return []
    return [
        f'roughness: {least:.2g} nodes per shortest wave across the track, asperity contact is '
        f'resolved from {FEWEST_NODES:g}'
    ]


def law_sentence(screw: Screw, settings: ScrewSettings) -> str:
    """Say where the asperity contact of a point is from."""
    if settings.kinematics != 'rolling':
        return {'standing': 'roughness that stands still', 'smooth': 'no roughness'}[
            settings.kinematics
        ]
    sheet = screw.roughness
    if not screw.composite_rms:
        return 'no roughness'
    state = 'new' if sheet.state == 'new' else 'run in'
    band = f'onset by the topography, within {band_of(sheet):g} of nine of ten marches'
    return (
        f'roughness that rolls, {state}, summits cut at {GIGA * sheet.cutting_pressure:g} GPa; '
        f'{sheet.calibration or band}'
    )


def _uncertain_films(contacts: list[dict[str, Any]]) -> list[str]:
    """Return a warning for each contact whose film is known badly: hardly pressed, thick film."""
    return [
        f'{contact["nut"]} nut, {contact["side"]}: the film is known to '
        f'{100 * contact["film_error"]:.0f} % only, the contact is hardly pressed'
        for contact in contacts
        if contact['film_error'] > FILM_ERROR
    ]


def _third_contacts(screw: Screw, contacts: list[dict[str, Any]]) -> list[str]:
    """Return a warning for each contact whose ball would reach the other flank of its groove."""
    if screw.flank_clearance is None:
        return []
    return [
        f'{contact["nut"]} nut, {contact["side"]}: the ball comes '
        f'{1e6 * contact["opposite_flank_approach_m"]:.2g} um towards the other flank, its '
        f'clearance is {1e6 * screw.flank_clearance:g} um: a third contact, which is not solved'
        for contact in contacts
        if contact['opposite_flank_approach_m'] > screw.flank_clearance
    ]
