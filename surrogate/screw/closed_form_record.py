# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One operating point as a record: plain numbers for JSON, and a page for a person."""

from collections.abc import Mapping
import math
import time
from typing import Any

import numpy as np
from surrogate.formulas import torque
from surrogate.formulas.film import (
    central_film_nijenbanning_1994,
    Groups,
    outside_range,
    rolling_force_biboulet_houpert_2010,
)
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.inlet import heating_factor, starved_speed
from surrogate.formulas.load_sharing import nut_forces, UNLOADING_RATIO
from surrogate.formulas.sliding import mean_sliding_speed
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.surface import regime_of
from surrogate.units import RPM, ZERO_CELSIUS

CONSTANT_FRICTION = 0.005
"""Effective friction coefficient of the constant-friction comparator [-]."""
WEAR = 'asperity_pressure_Pa', 'asperity_power_W'
"""Keys of the load on asperities per Hertz area, and times the sliding speed."""
FORMULAS = ('central_film_hamrock_dowson_1977', rolling_force_biboulet_houpert_2010.__name__)
STATUS = 'closed form: published formulas, asperity contact by the topography'


def closed_form_record(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, *, inlet_heating: bool = True
) -> dict[str, Any]:
    """
    Solve one point in the closed-form tier and return it as plain numbers.

    SI units, NaN where unknown. Four quadrants: the speed's sign is the direction of motion, the
    load opposes the motion when both have one sign. Shear heats the inlet if `inlet_heating`; the
    least factor on a film is stated in any case.

    """
    started = time.perf_counter()
    load = point.opposing_load
    result = closed_form.solve(
        screw, lubricant, abs(point.speed), load, point.temperature, inlet_heating=inlet_heating
    )
    friction_torque, film_ratio = float(result.friction_torque), float(result.film_ratio)
    contacts = [
        with_wear(_contact_record(one), _slides(screw, one, point.speed))
        for one in result.contacts
    ]
    worst = contacts[int(result.worst_contact)]
    return {
        'tier': closed_form.TIER,
        'status': STATUS,
        'warnings': _warnings(screw, lubricant, point, result),
        'screw': screw.name,
        'oil': lubricant.name,
        'roughness': roughness_sentence(screw.roughness, screw.ball_roughness),
        'film_floor_m': lubricant.film_floor,
        'film_factor': lubricant.film_factor,
        'speed_rad_s': point.speed,
        'load_N': point.load,
        'opposing_load_N': load,
        'temperature_K': point.temperature,
        'efficiency': torque.efficiency(friction_torque, load, screw.lead),
        'friction_torque_Nm': friction_torque,
        'driving_torque_Nm': float(torque.driving_torque(friction_torque, load, screw.lead)),
        'back_driving': torque.is_back_driving(friction_torque, load, screw.lead),
        'rcs': float(result.rcs),
        'asperity_share': float(result.asperity_share),
        **most_wear(contacts),
        'film_ratio': film_ratio,
        'regime': regime_of(film_ratio).word,
        'central_film_m': float(result.central_film),
        'minimum_film_m': float(result.minimum_film),
        'inlet_heating': inlet_heating,
        'inlet_heating_factor': _heating_factor(screw, lubricant, point, result),
        'friction_coefficient': float(result.friction_coefficient),
        'max_pressure_Pa': float(result.max_pressure),
        'worst_contact': {key: worst[key] for key in ('nut', 'side')},
        'normal_force_loaded_N': float(result.contacts[0].normal_force),
        'normal_force_relieved_N': float(result.contacts[2].normal_force),
        'entrainment_speed_m_s': float(result.entrainment_speed),
        'contact_angle_A_rad': screw.contact_angle,
        'contact_angle_B_rad': screw.contact_angle,
        'contacts': contacts,
        'comparators': _comparators(screw, point, result.contacts[0]),
        'wall_s': time.perf_counter() - started,
    }


def _heating_factor(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, result: closed_form.ScrewResult
) -> float:
    """Return the least film factor of the heated inlets of contacts that carry [-]."""
    # The speed that a contact is taken at: a starved inlet has less to shear.
    speed = starved_speed(lubricant, result.entrainment_speed)
    factors = [
        float(
            heating_factor(screw, lubricant, one.side, one.normal_force, speed, point.temperature)
        )
        for one in result.contacts
        if one.normal_force > 0
    ]
    return min(factors, default=math.nan)


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


def _slides(screw: Screw, contact: closed_form.ContactResult, speed: float) -> float:
    """Return the mean sliding speed [m/s] of a contact at a screw speed [rad/s]."""
    return mean_sliding_speed(screw, contact.side, float(contact.normal_force), speed)


def _contact_record(contact: closed_form.ContactResult) -> dict[str, Any]:
    return {
        'nut': contact.nut,
        'side': contact.side,
        'reason': '' if contact.normal_force > 0 else 'no load on this nut, so no film',
        'normal_force_N': float(contact.normal_force),
        'semi_axis_x_m': float(contact.ellipse.semi_axis_x),
        'semi_axis_y_m': float(contact.ellipse.semi_axis_y),
        'hertz_pressure_Pa': float(contact.ellipse.max_pressure),
        'central_film_m': float(contact.central_film),
        'minimum_film_m': float(contact.minimum_film),
        'film_ratio': float(contact.film_ratio),
        'rcs': float(contact.rcs),
        'asperity_share': float(contact.asperity_share),
        'friction_coefficient': float(contact.friction_coefficient),
        'rolling_force_N': float(contact.rolling_force),
        'sliding_torque_Nm': float(contact.sliding_torque),
        'rolling_torque_Nm': float(contact.rolling_torque),
    }


def _comparators(
    screw: Screw, point: OperatingPoint, loaded_screw: closed_form.ContactResult
) -> dict[str, Any]:
    """Return what the classical formulas say of the same point."""
    angle, load = helix_angle(screw), point.opposing_load
    forces = [float(force) for force in nut_forces(load, screw.preload)]
    opposing, assisting = forces if load >= 0 else forces[::-1]
    film = math.nan
    if point.speed:
        film = float(
            central_film_nijenbanning_1994(
                Contacts.of(screw).geometry[loaded_screw.side], loaded_screw.film_groups
            )
        )
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


def _warnings(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, result: closed_form.ScrewResult
) -> list[str]:
    """Return a sentence for each rating or fitted range that the point leaves."""
    warnings = []
    product = abs(point.speed) * 2 * screw.pitch_radius
    if product > screw.speed_limit:
        warnings.append(
            f'speed: D n is {product / RPM:.3g} m rev/min, the screw allows '
            f'{screw.speed_limit / RPM:.3g}'
        )
    if abs(point.load) > screw.static_rating:
        warnings.append(
            f'load: {abs(point.load):.4g} N, the static rating is {screw.static_rating:.4g} N'
        )
    if screw.preload and abs(point.load) >= UNLOADING_RATIO * screw.preload:
        warnings.append(
            'load: the relieved nut carries nothing, unloading begins at '
            f'{UNLOADING_RATIO * screw.preload:.4g} N'
        )
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    if not low <= point.temperature <= high:
        warnings.append(
            f'temperature: {point.temperature - ZERO_CELSIUS:.4g} degC, the oil sheet '
            f'covers {low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC'
        )
    return warnings + (formula_warnings(result) if point.speed else [])


def formula_warnings(result: closed_form.ScrewResult) -> list[str]:
    """Return a sentence for each formula that contacts use beyond what it was fitted over."""
    g = _all_groups(result.contacts)
    found = ((formula, outside_range(formula, g)) for formula in FORMULAS)
    return [
        f'{formula} outside its range: {", ".join(phrases)}'
        for formula, phrases in found
        if phrases
    ]


def _all_groups(contacts: tuple[closed_form.ContactResult, ...]) -> Groups:
    """Return the film groups of all contacts as one, so that a range is left only once."""
    every = [contact.film_groups for contact in contacts]
    return Groups(
        speed=np.stack([g.speed for g in every]),
        load=np.stack([g.load for g in every]),
        material=np.stack([g.material for g in every]),
        radius_ratio=max(g.radius_ratio for g in every),
    )


def _deviation(deviation: float) -> str:
    """Return the words about what strips of a raceway differ by [-], none where not known."""
    return '' if math.isnan(deviation) else f', strips differ by {100 * deviation:.2g} %'


def _film_by_formula(compared: Mapping[str, Any]) -> str:
    """Return the words about the film of a comparator, or why there is none."""
    film = 1e9 * compared['central_film_nijenbanning_m']
    return compared['reason'] or f'Nijenbanning film {film:.1f} nm'


def page(record: Mapping[str, Any]) -> str:
    """Return a record as a page of text in workshop units."""
    rows = [
        (
            'efficiency',
            f'{record["efficiency"]:.3f}'
            + (', load drives the screw' if record['back_driving'] else ''),
        ),
        ('friction torque', f'{record["friction_torque_Nm"]:.4f} N m'),
        ('driving torque', f'{record["driving_torque_Nm"]:.4f} N m'),
        ('regime', f'{record["regime"]}, Lambda {record["film_ratio"]:.2f}'),
        (
            'asperity wear',
            f'{1e-6 * record["asperity_pressure_Pa"]:.3g} MPa, '
            f'{1e3 * record["asperity_power_W"]:.3g} mW load times sliding',
        ),
        (
            'RCS',
            f'{100 * record["rcs"]:.2f} %'
            + (' (estimate)' if record['tier'] == closed_form.TIER else '')
            + _deviation(record.get('rcs_deviation', math.nan)),
        ),
        ('central film', f'{1e9 * record["central_film_m"]:.1f} nm'),
        ('friction coefficient', f'{record["friction_coefficient"]:.4f}'),
        ('entrainment speed', f'{1e3 * record["entrainment_speed_m_s"]:.1f} mm/s'),
    ]
    contacts = [
        f'  {contact["nut"] + " nut, " + contact["side"]:20} {contact["normal_force_N"]:9.2f} N '
        f'{1e-9 * contact["hertz_pressure_Pa"]:8.3f} GPa '
        f'{1e9 * contact["central_film_m"]:8.1f} nm {contact["film_ratio"]:8.2f}'
        f' {100 * contact["rcs"]:8.2f} %'
        for contact in record['contacts']
    ]
    compared = record['comparators']
    return '\n'.join(
        [
            f'{record["screw"]}, {record["oil"]}, tier {record["tier"]}: '
            f'{record["speed_rad_s"] / RPM:g} rev/min, {record["load_N"]:g} N, '
            f'{record["temperature_K"] - ZERO_CELSIUS:g} degC',
            *([f'  {record["contact_onset"]["sentence"]}'] if 'contact_onset' in record else []),
            *(f'  {name:20} {text}' for name, text in rows),
            '',
            '  contact              per ball     pressure     film      Lambda      RCS',
            *contacts,
            '',
            f'  compare: constant friction {compared["constant_friction_efficiency"]:.3f}, '
            f'catalogue drag {compared["catalogue_drag_torque_Nm"]:.3f} N m, '
            + _film_by_formula(compared),
            f'  roughness: {record["roughness"]}',
            *(f'  contact: {record[name]}' for name in ('asperity_law',) if name in record),
            f'  status: {record["status"]}',
            *(f'  warning: {text}' for text in record['warnings']),
        ]
    )
