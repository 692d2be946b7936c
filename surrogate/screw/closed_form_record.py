# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the closed-form tier as a record, and the page of a record of either tier."""

from collections.abc import Iterator, Mapping
import math
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas import torque
from surrogate.formulas.film import Groups, outside_range, rolling_force_biboulet_houpert_2010
from surrogate.formulas.sliding import mean_sliding_speed
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.point import ScrewPoint
from surrogate.screw.record import point_record
from surrogate.units import RPM, ZERO_CELSIUS

Array = NDArray[np.float64]
FORMULAS = ('central_film_hamrock_dowson_1977', rolling_force_biboulet_houpert_2010.__name__)
IDLE = 'no load on this nut, so no film'


def closed_form_record(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, *, inlet_heating: bool = True
) -> dict[str, Any]:
    """
    Solve one point in the closed-form tier and return it as plain numbers.

    SI units, NaN where unknown. Four quadrants: the speed's sign is the direction of motion, the
    load opposes the motion when both have one sign. Shear heats the inlet if `inlet_heating`; the
    least factor on a film is stated in any case.

    """
    started, opened = time.perf_counter(), Contacts.of(screw)
    place = abs(point.speed), point.opposing_load, point.temperature
    result = closed_form.solve(opened, lubricant, *place, inlet_heating=inlet_heating)
    loaded = float(result.friction_torque), point.opposing_load, screw.lead
    record = point_record(
        opened,
        lubricant,
        point,
        result,
        result,
        tier=closed_form.TIER,
        reasons=['' if contact.normal_force > 0 else IDLE for contact in result.contacts],
        sliding=[
            mean_sliding_speed(screw, contact.side, float(contact.normal_force), point.speed)
            for contact in result.contacts
        ],
        angles=(screw.contact_angle, screw.contact_angle),
        formula_warnings=formula_warnings(result) if point.speed else (),
        inlet_heating=inlet_heating,
    )
    return record | {
        'efficiency': torque.efficiency(*loaded),
        'driving_torque_Nm': float(torque.driving_torque(*loaded)),
        'back_driving': torque.is_back_driving(*loaded),
        'wall_s': time.perf_counter() - started,
    }


def formula_warnings(result: ScrewPoint[Array]) -> list[str]:
    """Return a sentence for each formula that contacts use beyond what it was fitted over."""
    # The groups of all contacts as one, so that a range is left only once.
    every = [contact.film_groups for contact in result.contacts if contact.film_groups is not None]
    g = Groups(
        speed=np.stack([g.speed for g in every]),
        load=np.stack([g.load for g in every]),
        material=np.stack([g.material for g in every]),
        radius_ratio=max(g.radius_ratio for g in every),
    )
    ranges = ((formula, outside_range(formula, g)) for formula in FORMULAS)
    return [
        f'{formula} outside its range: {", ".join(phrases)}'
        for formula, phrases in ranges
        if phrases
    ]


def _deviation(deviation: float) -> str:
    """Return the words about what strips of a raceway differ by [-], none where not known."""
    return '' if math.isnan(deviation) else f', strips differ by {100 * deviation:.2g} %'


def drag_rows(record: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the row of efficiency and torque with a typical drag, where it is not identified."""
    if 'typical_drag' not in record:
        return
    texts = []
    for key, words, unit in (
        ('efficiency', 'efficiency', ''),
        ('friction_torque_Nm', 'friction torque', ' N m'),
        ('drag_Nm', 'drag', ' N m'),
    ):
        low, middle, high = sorted(record['typical_drag'][key].values())
        texts.append(f'{words} {middle:.3g} ({low:.3g} to {high:.3g}){unit}')
    yield 'with typical drag', ', '.join(texts)


def page(record: Mapping[str, Any], *, verbose: bool = False) -> str:
    """Return a record as a page of text in workshop units; `verbose` with ranges of formulas."""
    rows = [
        (
            'efficiency',
            f'{record["efficiency"]:.3f}'
            + ' of the contacts' * ('typical_drag' in record)
            + (', load drives the screw' if record['back_driving'] else ''),
        ),
        ('friction torque', f'{record["friction_torque_Nm"]:.4f} N m'),
        ('driving torque', f'{record["driving_torque_Nm"]:.4f} N m'),
        *drag_rows(record),
        ('regime', f'{record["regime"]} by Lambda {record["film_ratio"]:.2f}; RCS decides'),
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
    film = 1e9 * compared['central_film_nijenbanning_m']
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
            + (compared['reason'] or f'Nijenbanning film {film:.1f} nm'),
            f'  roughness: {record["roughness"]}',
            *(f'  contact: {record[name]}' for name in ('asperity_law',) if name in record),
            f'  status: {record["status"]}',
            *(f'  warning: {text}' for text in record['warnings']),
            *(f'  formulas: {text}' for text in record['formula_warnings'] if verbose),
        ]
    )
