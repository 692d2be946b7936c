# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A point as a record, whatever the tier: plain numbers for JSON, SI units, NaN where unknown.

The numbers of a result stand under the keys of their declaration, beside what the classical
formulas say of the same point.

"""

from collections.abc import Sequence
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas import torque
from surrogate.formulas.film import central_film_nijenbanning_1994
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.inlet import heating_factor, starved_speed
from surrogate.formulas.load_sharing import nut_forces, UNLOADING_RATIO
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.results import declared
from surrogate.screw.opened import Contacts
from surrogate.screw.point import PointContact, ScrewPoint
from surrogate.surface import regime_of
from surrogate.units import digits, RPM, ZERO_CELSIUS

Array = NDArray[np.float64]
CONSTANT_FRICTION = 0.005
"""Effective friction coefficient of the constant-friction comparator [-]."""
WEAR = 'asperity_pressure_Pa', 'asperity_power_W'
"""Keys of the load on asperities per Hertz area, and times the sliding speed."""
KEYS = {
    'tier': 'model',
    'status': 'how the solve ended, with the reason of a number that is not known',
    'warnings': 'sentences about ratings and ranges',
    'formula_warnings': 'formulas beyond the range that they were fitted over',
    'screw': 'name of the sheet',
    'oil': 'name of the sheet',
    'roughness': 'stated roughness with its assumptions',
    'film_floor_m': 'of the oil',
    'film_factor': 'of the oil',
    'speed_rad_s': 'as asked',
    'load_N': 'as asked',
    'opposing_load_N': 'positive against the motion',
    'temperature_K': 'of the oil',
    'efficiency': '0 at zero load',
    'friction_torque_Nm': 'lost torque',
    'driving_torque_Nm': 'torque on the screw, negative when the load drives it',
    'back_driving': 'whether the load drives the screw',
    'rcs': 'of the worst contact',
    'asperity_share': 'of the worst contact',
    'asperity_pressure_Pa': 'asperity load over the area of the Hertz ellipse, of the contact '
    'with most of it',
    'asperity_power_W': 'asperity load times mean sliding speed, of the contact with most of it',
    'film_ratio': 'Lambda of the thinnest smooth film',
    'regime': 'by the film ratio',
    'central_film_m': 'of the thinnest contact',
    'minimum_film_m': 'of the thinnest contact',
    'inlet_heating': 'whether heating of the inlet thins the films',
    'inlet_heating_factor': 'least factor on a film; 0.3 stands for beyond the fit',
    'friction_coefficient': 'mean traction against the slip over the normal forces',
    'max_pressure_Pa': 'of the most pressed contact',
    'worst_contact': '`nut` and `side` of the largest RCS',
    'normal_force_loaded_N': 'of a ball of the loaded nut, before friction',
    'normal_force_relieved_N': 'of a ball of the relieved nut, before friction',
    'entrainment_speed_m_s': 'of a ball, before friction',
    'contact_angle_A_rad': 'of a ball of the loaded nut on the screw',
    'contact_angle_B_rad': 'of the same ball on the nut',
    'contacts': 'the four contacts, keys below',
    'comparators': 'constant friction, catalogue drag, a second film formula',
    'wall_s': 'wall time',
    'contact_onset': 'where contact begins: `sentence`, `speed_rad_s`, `speed_range_rad_s`, '
    '`measure` (the measurement that narrows it most), `measured_range_rad_s` (what that leaves), '
    '`fastest_speed_rad_s`, `temperature_K`, `optimal_zone`',
    'typical_drag': 'only with a typical drag on the sheet: `drag_Nm`, `friction_torque_Nm` and '
    '`efficiency` with it, each `low`, `typical`, `high` by the drag',
}
"""Keys of a point of either tier, as `ballscrew point --json` prints it."""
CONTACT_KEYS = {
    'nut': 'loaded or relieved',
    'side': 'screw or nut',
    'reason': 'of a number that is not known',
    'normal_force_N': 'of a ball',
    'semi_axis_x_m': 'along the track',
    'semi_axis_y_m': 'across it',
    'hertz_pressure_Pa': 'largest Hertz pressure',
    'central_film_m': 'of the smooth contact',
    'minimum_film_m': 'of the smooth contact',
    'film_ratio': 'Lambda',
    'rcs': 'share of the load on punctured nodes',
    'asperity_share': 'share that asperities carry',
    'friction_coefficient': 'of the sliding',
    'rolling_force_N': 'on each surface',
    'sliding_torque_Nm': 'of all balls of the nut',
    'rolling_torque_Nm': 'of all balls of the nut',
    'asperity_pressure_Pa': 'as above',
    'asperity_power_W': 'as above',
}
"""Keys of each of its contacts."""


def point_record(
    opened: Contacts,
    lubricant: Lubricant,
    point: OperatingPoint,
    result: ScrewPoint[Any],
    formulas: ScrewPoint[Array],
    *,
    tier: str,
    reasons: Sequence[str],
    sliding: Sequence[float],
    angles: tuple[float, float],
    warnings: Sequence[str] = (),
    formula_warnings: Sequence[str] = (),
    inlet_heating: bool,
) -> dict[str, Any]:
    """
    Return what both tiers tell of a point.

    For each contact the reason why it has no numbers, empty if it has, and its mean sliding speed
    [m/s]; contact angles [rad] at screw and nut; warnings of the tier, after those of ratings.
    `formulas` are the point by published formulas, for comparison.

    """
    screw = opened.sheet
    contacts = [
        with_wear(
            {'nut': contact.nut, 'side': contact.side, 'reason': reason} | declared(contact), slip
        )
        for contact, reason, slip in zip(result.contacts, reasons, sliding, strict=True)
    ]
    # The speed that a contact is taken at: a starved inlet has less to shear.
    speed = starved_speed(lubricant, formulas.entrainment_speed)
    heating = [
        float(
            heating_factor(
                screw, lubricant, contact.side, contact.normal_force, speed, point.temperature
            )
        )
        for contact in formulas.contacts
        if contact.normal_force > 0
    ]
    worst, (loaded, relieved) = contacts[int(result.worst_contact)], result.normal_forces
    return {
        'tier': tier,
        'status': result.status,
        'warnings': [*rating_warnings(screw, lubricant, point), *warnings],
        'formula_warnings': list(formula_warnings),
        'screw': screw.name,
        'oil': lubricant.name,
        'roughness': roughness_sentence(screw.roughness, screw.ball_roughness),
        'film_floor_m': lubricant.film_floor,
        'film_factor': lubricant.film_factor,
        'speed_rad_s': point.speed,
        'load_N': point.load,
        'opposing_load_N': point.opposing_load,
        'temperature_K': point.temperature,
        **declared(result),
        **most_wear(contacts),
        'regime': regime_of(float(result.film_ratio)).word,
        'inlet_heating': inlet_heating,
        'inlet_heating_factor': min(heating, default=math.nan),
        'worst_contact': {key: worst[key] for key in ('nut', 'side')},
        'normal_force_loaded_N': float(loaded),
        'normal_force_relieved_N': float(relieved),
        'contact_angle_A_rad': angles[0],
        'contact_angle_B_rad': angles[1],
        'contacts': contacts,
        'comparators': _comparators(opened, point, formulas.contacts[0]),
        **_with_drag(screw, point, float(result.friction_torque)),
    }


def _with_drag(screw: Screw, point: OperatingPoint, friction_torque: float) -> dict[str, Any]:
    """Return torque and efficiency with a typical drag, nothing where it is identified."""
    if screw.likely_drag is None:
        return {}
    place = friction_torque, point.opposing_load, screw.lead
    return {'typical_drag': torque.with_typical_drag(*place, screw.likely_drag)}


def with_wear(contact: dict[str, Any], sliding: float) -> dict[str, Any]:
    """Return the record of a contact with its numbers of wear, mean `sliding` speed [m/s]."""
    if not contact['normal_force_N']:
        return contact | dict.fromkeys(WEAR, 0.0)
    carried = contact['asperity_share'] * contact['normal_force_N']
    area = math.pi * contact['semi_axis_x_m'] * contact['semi_axis_y_m']
    return contact | dict(zip(WEAR, (carried / area, carried * sliding), strict=True))


def most_wear(contacts: list[dict[str, Any]]) -> dict[str, float]:
    """Return each number of wear of the contact that has the most of it."""
    return {name: float(np.max([contact[name] for contact in contacts])) for name in WEAR}


def _comparators(
    opened: Contacts, point: OperatingPoint, loaded_screw: PointContact[Array]
) -> dict[str, Any]:
    screw, load = opened.sheet, point.opposing_load
    angle = helix_angle(screw)
    forces = [float(force) for force in nut_forces(load, screw.preload)]
    opposing, assisting = forces if load >= 0 else forces[::-1]
    film, groups = math.nan, loaded_screw.film_groups
    if point.speed and groups is not None:
        contact = opened.geometry[loaded_screw.side]
        film = float(central_film_nijenbanning_1994(contact, groups))
    driving = torque.torque_constant_friction(
        opposing, assisting, screw.pitch_radius, angle, CONSTANT_FRICTION
    )
    friction = driving - torque.driving_torque(0.0, load, screw.lead)
    return {
        'constant_friction_coefficient': CONSTANT_FRICTION,
        'constant_friction_torque_Nm': driving,
        'constant_friction_efficiency': torque.efficiency(friction, load, screw.lead),
        'catalogue_drag_torque_Nm': torque.drag_torque_catalogue(screw.preload, screw.lead, angle),
        'central_film_nijenbanning_m': film,
        'reason': '' if film > 0 else 'no film at rest or without load',
    }


def rating_warnings(screw: Screw, lubricant: Lubricant, point: OperatingPoint) -> list[str]:
    """Return a sentence for each rating or range of a sheet that the point leaves."""
    warnings = []
    product = abs(point.speed) * 2 * screw.pitch_radius
    if product > screw.speed_limit:
        warnings.append(
            f'speed: D n is {digits(product / RPM)} m rev/min, the screw allows '
            f'{screw.speed_limit / RPM:.3g}'
        )
    if abs(point.load) > screw.static_rating:
        warnings.append(
            f'load: {abs(point.load):.0f} N, the static rating is {screw.static_rating:.0f} N'
        )
    if screw.preload and abs(point.load) >= UNLOADING_RATIO * screw.preload:
        what = 'the relieved nut carries nothing'
        if screw.nut == 'oversize':
            what = 'friction alone presses the relieved flanks'
        warnings.append(
            f'load: {what}, unloading begins at {UNLOADING_RATIO * screw.preload:.4g} N'
        )
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    if not low <= point.temperature <= high:
        warnings.append(
            f'temperature: {point.temperature - ZERO_CELSIUS:.4g} degC, the oil sheet '
            f'covers {low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC'
        )
    return warnings
