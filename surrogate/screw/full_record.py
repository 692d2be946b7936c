# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the full tier as a record: plain numbers for JSON, beside the classical formulas."""

from collections.abc import Iterator
import math
import time
from typing import Any

import numpy as np
from surrogate.asperities.law import FILM_BANDS
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw import closed_form
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.opened import Contacts
from surrogate.screw.record import point_record
from surrogate.screw.solve import ScrewSolution, solve_screw, TIER
from surrogate.units import GIGA

LOAD_CHANGE = 0.01
"""Change of a normal force by friction and inertia that is warned about [-]."""
FILM_ERROR = 0.1
"""Estimated error of a central film that is warned about [-]."""
KEYS = {
    'converged': 'whether the numbers are valid',
    'energy_error': 'difference of both derivations of the torque, over the friction torque',
    'load_change': 'remaining change of the iteration between contacts and balance',
    'rcs_deviation': 'standard deviation of RCS between marched strips and the law',
    'asperity_law': 'state of the raceway and pressure at which its summits are cut',
}
"""Keys that a point of the full tier has besides."""
CONTACT_KEYS = {
    'contact_angle_rad': 'of the ball',
    'max_pressure_Pa': 'of the smooth film',
    'film_error': 'estimated relative error of the central film',
    'opposite_flank_approach_m': 'way of the ball towards its other flank',
}
"""Keys that its contacts have besides."""


def full_record(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, settings: ScrewSettings
) -> tuple[ScrewSolution, dict[str, Any]]:
    """Solve one point in the full tier; return it with its record."""
    started = time.perf_counter()
    opened = Contacts.of(screw)
    solution = solve_screw(opened, lubricant, point, settings=settings)
    record = solution_record(opened, lubricant, point, solution, settings)
    return solution, record | {'wall_s': time.perf_counter() - started}


def solution_record(
    opened: Contacts,
    lubricant: Lubricant,
    point: OperatingPoint,
    solution: ScrewSolution,
    settings: ScrewSettings,
) -> dict[str, Any]:
    """
    Return a point of the full tier as plain numbers, SI units, NaN where unknown.

    The keys are those of the closed-form record, with its warnings about ratings and its
    comparators.

    """
    screw, heated = opened.sheet, settings.inlet_heating
    place = abs(point.speed), point.opposing_load, point.temperature
    screw_side, nut_side = solution.contacts[:2]
    sliding = []
    for contact in solution.contacts:
        mean = math.nan
        if contact.solved is not None and contact.motion is not None:
            pressed = contact.solved.pressed
            slip = np.hypot(*contact_slip(screw, pressed, contact.side, contact.motion))
            mean = float(np.average(slip, weights=pressed.pressure))
        sliding.append(mean)
    record = point_record(
        opened,
        lubricant,
        point,
        solution,
        closed_form.solve(opened, lubricant, *place, inlet_heating=heated),
        tier=TIER,
        reasons=[_reason(solution, contact) for contact in solution.contacts],
        sliding=sliding,
        angles=(screw_side.contact_angle, nut_side.contact_angle),
        warnings=[*_warnings(screw, solution)],
        inlet_heating=heated,
    )
    return record | {
        'converged': solution.converged,
        'rcs_deviation': solution.rcs_deviation,
        'asperity_law': law_sentence(screw, settings),
    }


def _reason(solution: ScrewSolution, contact: ScrewContact) -> str:
    """Return why a contact has no numbers, empty if it has."""
    if contact.solved is None:
        return 'no load on this nut, so no contact'
    return '' if solution.converged else solution.status


def _warnings(screw: Screw, solution: ScrewSolution) -> Iterator[str]:
    """Yield what is doubtful of a solution."""
    if solution.load_change > LOAD_CHANGE:
        yield (
            'balls: friction and inertia change a normal force by '
            f'{100 * solution.load_change:.2g} %, the contacts were solved before that'
        )
    for contact in solution.contacts:
        approach, clearance = contact.opposite_flank_approach, screw.flank_clearance
        if clearance is not None and approach > clearance:
            yield (
                f'{contact.nut} nut, {contact.side}: the ball comes {1e6 * approach:.2g} um '
                f'towards the other flank, its clearance is {1e6 * clearance:g} um: a third '
                'contact, which is not solved'
            )
    for contact in solution.contacts:
        if contact.film_error > FILM_ERROR:
            yield (
                f'{contact.nut} nut, {contact.side}: the film is known to '
                f'{100 * contact.film_error:.0f} % only, the contact is hardly pressed'
            )


def law_sentence(screw: Screw, settings: ScrewSettings) -> str:
    """Say where the asperity contact of a point is from."""
    sheet = screw.roughness
    if settings.kinematics == 'smooth' or not screw.composite_rms:
        return 'no roughness'
    state = 'new' if sheet.state == 'new' else 'run in'
    band = (
        f'film at the onset by the topography, within {FILM_BANDS[sheet.lay]:g} of nine of ten '
        'marches'
    )
    return (
        f'roughness that rolls, {state}, summits cut at {GIGA * sheet.cutting_pressure:g} GPa; '
        f'{sheet.calibration or band}'
    )
