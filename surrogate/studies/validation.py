# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Published values beside ours: the record of all comparisons, SI units, and its tables.

Our numbers are those of the nominal screw with ISO VG 68 at the temperature of its sheet, without
axial load, from the functions that solve points and surfaces, and efficiencies of shipped sizes.

"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
import math
from pathlib import Path
from typing import Any

import numpy as np
from surrogate.asperities.running_in import running_tiles
from surrogate.catalogue.screw import typical_drag
from surrogate.ehl import Condition, Settings, solve_contact
from surrogate.ehl.moving import march_strip, MarchSettings, strip_at
from surrogate.files.limits import read_text
from surrogate.files.plain_yaml import plain_values
from surrogate.formulas import film, torque
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.line import (
    amplitude_reduction_venner_1997,
    central_film_line,
    line_at,
    moes_line,
)
from surrogate.formulas.load_sharing import normal_force
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.raceway.tile import Tile
from surrogate.screw.contacts import oil_at, ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_over_pressure, onset_point, with_raceway
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw
from surrogate.studies import drag
from surrogate.studies.curves import Array, markdown_table
from surrogate.studies.tasks import OIL, SCREW
from surrogate.units import RPM

PUBLISHED = plain_values(read_text(Path(__file__).parents[1] / 'data' / 'published.yaml'))
"""Published values, each declared once with its source, and measurements without a number."""
WAVES = (0.25, 0.5, 1.0)
"""Lengths of the waves that are marched, over the half length of the contact [-]."""
WAVE_SPEED, WAVE_HEIGHT = 0.1, 0.1
"""Entrainment speed of those marches [m/s], amplitude of the waves over the film [-]."""
LOADS, SPEEDS = (5.0, 27.6, 100.0), (100.0, 600.0, 1500.0)
"""Normal forces [N] and screw speeds [rev/min] at which rolling forces are compared."""
WIDTHS = (1.3, 2.0, 3.0, 6.0)
"""Half widths of the oil across the track over the semi-axis [-]; the last fills the groove."""
FAST, SLOW = 600.0, 100.0
"""Screw speeds at which torques are compared [rev/min]."""
DRAG_SPEEDS = (150.0, 600.0, 2000.0)
"""Screw speeds at which the contacts are held against a formula [rev/min]."""
THIN_FILMS = (0.05, 0.1)
"""Film ratios at which the share of the load on the film is compared [-]."""
NEWTONIAN = 1e8
"""Eyring stress of an oil that does not thin before it reaches its limiting stress [Pa]."""
PRODUCTION = Settings(error_estimate=False)
ISOTHERMAL = ScrewSettings(inlet_heating=False)
"""The published numbers have no heating in the inlet, but for the row that says so."""
CORE = 0.4
"""Share of the material ratio curve that the secant of the core spans, ISO 25178-2 [-]."""
ROLLING = 'normal force [N]', 'rev/min', 'M of Moes', 'domain', 'with the tail', 'with ripples'
COMPARED = 'what', 'source', 'what was read', 'published', 'ours', 'verdict', 'reason'
"""Heads of the tables of rolling forces and of comparisons."""


class ValidationCase:
    """
    The nominal screw and its oil, with what many comparisons need.

    Temperature [K], oil and contact at the screw, normal force [N], the screw with a new raceway,
    both opened.

    """

    def __init__(self) -> None:
        self.screw, self.lubricant = load_screw(SCREW), load_lubricant(OIL)
        self.temperature = self.lubricant.reference_temperature
        self.oil = oil_at(self.lubricant, self.temperature)
        self.opened = Contacts.of(self.screw)
        self.contact = self.opened.geometry['screw']
        self.load = float(normal_force(self.screw, self.screw.preload))
        self.new = Contacts.of(with_raceway(self.screw, state='new'))

    @cached_property
    def onset(self) -> Mapping[str, float]:
        """Return where contact of a new raceway begins, SI units."""
        return onset_point(self.new, self.lubricant, 0.0, self.temperature)

    @cached_property
    def rolling(self) -> list[dict[str, float]]:
        """Return rolling forces over load and speed beside the formula, SI units."""
        return [rolling_force(self, load, rpm) for load in LOADS for rpm in SPEEDS]

    @cached_property
    def waves(self) -> list[tuple[float, float]]:
        """Return what is left of waves by pure rolling, and by the published curve [-]."""
        return [march_wave(self, length) for length in WAVES]

    def point(self, rpm: float) -> OperatingPoint:
        """Return the point at a speed [rev/min]."""
        return OperatingPoint(speed=rpm * RPM, load=0.0, temperature=self.temperature)

    def solved(self, rpm: float, settings: ScrewSettings) -> ScrewSolution:
        """Return the screw at a speed [rev/min]."""
        return solve_screw(self.opened, self.lubricant, self.point(rpm), settings=settings)

    def groups(self, load: float, speed: float) -> film.Groups:
        """Return the groups of the contact at a normal force [N] and an entrainment [m/s]."""
        oil = self.oil
        return film.groups(self.contact, load, speed, oil.viscosity, oil.pressure_viscosity)


def rolling_force(
    case: ValidationCase, load: float, rpm: float, settings: Settings = PRODUCTION
) -> dict[str, float]:
    """Return the rolling force at a normal force [N] and a screw speed [rev/min]."""
    speed = case.opened.rates.entrainment * rpm * RPM
    condition = Condition(load=load, entrainment_speed=speed)
    place = case.contact, condition, case.oil, case.lubricant.film_floor
    smooth = solve_contact(case.contact, case.oil, condition, settings=settings)
    groups = case.groups(load, speed)
    formula = float(film.rolling_force_biboulet_houpert_2010(case.contact, groups))
    ratio = smooth.whole_rolling_force / formula
    return {
        'load_N': load,
        'speed_rad_s': rpm * RPM,
        'moes_load': float(groups.moes_load),
        'domain_over_formula': smooth.rolling_force / formula,
        'smooth_over_formula': ratio,
        'rough_over_formula': case.opened.law.contact('screw', *place).loss_factor * ratio,
    }


def march_wave(case: ValidationCase, length: float) -> tuple[float, float]:
    """
    Return what is left of a wave by pure rolling, and by the published curve [-].

    `length` of the wave over the half length of the contact [-].

    """
    strip = strip_at(case.contact, case.load, 0.0, 1e-5, 4)
    given = strip.line, WAVE_SPEED, case.oil.viscosity, case.oil.pressure_viscosity
    height = WAVE_HEIGHT * float(central_film_line(*given))
    number = 2 * math.pi / (length * strip.semi_axis)
    settings = MarchSettings(nx=129, places=1, film_floor=1e-10)

    def wave(x: Array, y: Array) -> Array:
        return height * np.cos(number * x) + 0 * y

    march = march_strip(strip, case.oil, WAVE_SPEED, wave, transits=2.0, settings=settings)
    curve = amplitude_reduction_venner_1997(length, 1.0, *moes_line(*given))
    return math.sqrt(2) * float(march.centre_films.std()) / height, float(curve)


def wide(width: float) -> Settings:
    """Return how to solve a contact with oil far in front of it and so wide, semi-axes [-]."""
    domain = (-16.0, 1.5, width)
    return replace(PRODUCTION, nx=601, ny=129, domain=domain, open_inlet=True)


def tiles_of(opened: Contacts) -> list[Tile]:
    """Return tiles of the raceway on the screw as it runs."""
    return running_tiles(opened.running['screw'])


def reduced_peak_height(heights: Array) -> float:
    """
    Return Spk [m] of heights [m]: ISO 25178-2, by the secant of the core with the least slope.

    The summits above the core as a triangle of equal area.

    """
    curve = np.sort(heights, axis=None)[::-1]
    span = round(CORE * curve.size)
    drops = curve[: curve.size - span] - curve[span:]
    first = int(drops.argmin())
    top = curve[first] + first / span * drops[first]
    above = curve[curve > top] - top
    return float(2 * above.mean()) if above.size else 0.0


def waves_over_curve(case: ValidationCase) -> list[float]:
    """Return the amplitudes that are left over those of the published curve [-]."""
    return [left / curve for left, curve in case.waves]


def short_wave(case: ValidationCase) -> list[float]:
    """Return what is left of the shortest wave [-]."""
    return [case.waves[0][0]]


def film_ratio_at_onset(case: ValidationCase) -> list[float]:
    """Return the film ratio at the onset of a new raceway [-]."""
    return [case.onset['central_film_m'] / case.screw.composite_rms]


def load_on_film(case: ValidationCase) -> list[float]:
    """Return the shares of the load that thin films carry [-]."""
    speeds = np.geomspace(1e-4, 1.0, 200)
    line = line_at(case.contact, case.load, 0.0)
    films = central_film_line(line, speeds, case.oil.viscosity, case.oil.pressure_viscosity)
    wanted = np.log(np.array(THIN_FILMS) * case.screw.composite_rms)
    speed = np.exp(np.interp(wanted, np.log(films), np.log(speeds)))
    place = case.contact, case.load, case.oil, case.lubricant.film_floor
    return (1 - case.new.law.touching('screw', *place, speed)[1]).tolist()


def run_in_speeds(case: ValidationCase) -> list[float]:
    """Return the onset after running in over that of a new raceway, over its pressures [-]."""
    place = case.lubricant, 0.0, case.temperature
    sheet = case.screw.roughness
    pressures = sheet.run_in_low, sheet.run_in_high
    speeds = onset_over_pressure(case.new.sheet, *place, pressures)
    return [speed / case.onset['speed_rad_s'] for speed in speeds]


def run_in_height(case: ValidationCase) -> list[float]:
    """Return by which share running in lowers the rms height of the tiles [-]."""
    new, worn = (
        np.mean([tile.heights.std() for tile in tiles_of(opened)])
        for opened in (case.new, Contacts.of(with_raceway(case.screw, state='run_in')))
    )
    return [float(1 - worn / new)]


def film_parameter_at_onset(case: ValidationCase) -> list[float]:
    """Return (h_m + f h_c)/Spk at the onset of a new raceway for f of 0 and 1 [-]."""
    groups = case.groups(case.load, case.onset['entrainment_speed_m_s'])
    least = float(film.minimum_film_hamrock_dowson_1977(case.contact, groups))
    central = float(film.central_film_hamrock_dowson_1977(case.contact, groups))
    peaks = float(np.mean([reduced_peak_height(tile.heights) for tile in tiles_of(case.new)]))
    return [least / peaks, (least + central) / peaks]


def rolling_over_formula(case: ValidationCase) -> list[float]:
    """Return rolling forces of smooth contacts over those of the formula, not light ones [-]."""
    return [row['smooth_over_formula'] for row in case.rolling if row['load_N'] > LOADS[0]]


def rough_rolling_over_formula(case: ValidationCase) -> list[float]:
    """Return the same for rolling forces with roughness [-]."""
    return [row['rough_over_formula'] for row in case.rolling if row['load_N'] > LOADS[0]]


def drag_torque(case: ValidationCase) -> list[float]:
    """Return the friction torque of the contacts at the slower speed [N m]."""
    return [case.solved(SLOW, ISOTHERMAL).friction_torque]


def contacts_over_formula(case: ValidationCase) -> list[float]:
    """Return the friction torque of the contacts over that of a published formula [-]."""
    return [
        case.solved(rpm, ISOTHERMAL).friction_torque
        / torque.friction_torque_jungnickel_2010(
            2 * case.screw.loaded_balls_per_nut,
            case.load,
            speed=rpm * RPM,
            pitch_radius=case.screw.pitch_radius,
            ball_radius=0.5 * case.screw.ball_diameter,
            helix_angle=helix_angle(case.screw),
            kinematic_viscosity=case.lubricant.kinematic_viscosity_40,
            density=case.lubricant.density,
        )
        for rpm in DRAG_SPEEDS
    ]


def sealed_drag(case: ValidationCase) -> list[float]:
    """Return the friction torque of the contacts and of a typical drag [N m]."""
    return [case.solved(FAST, ISOTHERMAL).friction_torque + typical_drag(case.screw)[1]]


OURS: dict[str, Callable[[ValidationCase], list[float]]] = {
    number.__name__: number
    for number in (
        *(waves_over_curve, short_wave, film_ratio_at_onset, load_on_film, run_in_speeds),
        *(run_in_height, film_parameter_at_onset, rolling_over_formula),
        *(rough_rolling_over_formula, drag_torque, contacts_over_formula, sealed_drag),
        *(drag.efficiency_with_drag, drag.efficiency_of_load, drag.efficiency_over_load),
        *(drag.drag_over_preload, drag.drag_over_measured, drag.stribeck_branches),
    )
}
"""Our numbers by the names that the published values give them."""


def torque_table(case: ValidationCase) -> dict[str, float]:
    """Return the friction torque at the faster speed under other laws and inlets [N m]."""
    oils: dict[str, dict[str, Any]] = {
        'Eyring stress 5 MPa, no limit': {},
        'the same, limiting shear stress 0.08 p': {'limiting_shear_share': 0.08},
        'the same, limiting shear stress 0.05 p': {'limiting_shear_share': 0.05},
        'Eyring stress 2 MPa': {'eyring_stress': 2e6},
        'Eyring stress 10 MPa': {'eyring_stress': 1e7},
        'Newtonian up to 0.05 p': {'eyring_stress': NEWTONIAN, 'limiting_shear_share': 0.05},
        'Newtonian up to 0.08 p': {'eyring_stress': NEWTONIAN, 'limiting_shear_share': 0.08},
    }
    near, far = (
        replace(ISOTHERMAL, smooth=replace(ISOTHERMAL.smooth, meniscus_length=length))
        for length in (0.3e-3, 3e-3)
    )
    inlets = {
        'meniscus at 0.3 mm': near,
        'meniscus at 3.0 mm': far,
        'oil across the whole groove': replace(ISOTHERMAL, smooth=wide(WIDTHS[-1])),
        'inlet heating': replace(ISOTHERMAL, inlet_heating=True),
    }
    point, solved = case.point(FAST), case.solved(FAST, ISOTHERMAL)
    solutions = {
        name: rebalance_screw(
            case.opened, replace(case.lubricant, **oil), point, solved, settings=ISOTHERMAL
        )
        for name, oil in oils.items()
    } | {name: case.solved(FAST, settings) for name, settings in inlets.items()}
    return {name: solution.friction_torque for name, solution in solutions.items()}


def validation_record() -> dict[str, Any]:
    """Compute every comparison now, some half a minute."""
    case = ValidationCase()
    widths = {width: rolling_force(case, case.load, FAST, wide(width)) for width in WIDTHS}
    return {
        'screw': case.screw.name,
        'oil': case.lubricant.name,
        'temperature_K': case.temperature,
        'comparisons': [
            compared(value, OURS[value['ours']](case)) for value in PUBLISHED['values']
        ],
        'without_number': PUBLISHED['without_number'],
        'rolling': case.rolling,
        'rolling_over_width': {at: row['smooth_over_formula'] for at, row in widths.items()},
        'torque_Nm': torque_table(case),
    }


def compared(value: Mapping[str, Any], ours: Sequence[float]) -> dict[str, Any]:
    """
    Return a published value beside our numbers.

    The verdict says whether all of them lie within the published range and its tolerance.

    """
    whole = {'unit': '', 'tolerance': 0.0, 'comparable': True, **value}
    low, high = whole['published']
    low, high = low * (1 - whole['tolerance']), high * (1 + whole['tolerance'])
    verdict = 'agrees' if all(low <= number <= high for number in ours) else 'differs'
    return whole | {'ours': ours, 'verdict': verdict if whole['comparable'] else 'not comparable'}


def validation_page(record: Mapping[str, Any]) -> str:
    """Return the tables of a record in Markdown."""
    compared_rows = []
    for row in record['comparisons']:
        within = f' ± {100 * row["tolerance"]:.0f} %' if row['tolerance'] else ''
        published, ours = span(row['published']), span(row['ours'])
        numbers = f'{published}{within} {row["unit"]}'.strip(), f'{ours} {row["unit"]}'.strip()
        words = (row[key] for key in ('what', 'source', 'read'))
        compared_rows.append((*words, *numbers, row['verdict'], row['reason']))
    rolling = []
    for row in record['rolling']:
        place = f'{row["load_N"]:g}', f'{row["speed_rad_s"] / RPM:.0f}'
        ratios = [row[f'{name}_over_formula'] for name in ('domain', 'smooth', 'rough')]
        rolling.append((*place, f'{row["moes_load"]:.0f}', *(f'{ratio:.2f}' for ratio in ratios)))
    ratios = record['rolling_over_width']
    width = 'half width of the oil over the semi-axis', *(f'{width:g}' for width in ratios)
    over = 'rolling force over the formula', *(f'{ratio:.2f}' for ratio in ratios.values())
    torques = [(name, f'{torque:.3f}') for name, torque in record['torque_Nm'].items()]
    parts = (
        markdown_table(COMPARED, compared_rows),
        '\n'.join(f'* {sentence}' for sentence in record['without_number']),
        markdown_table(ROLLING, rolling),
        markdown_table(width, [over]),
        markdown_table((f'friction torque at {FAST:g} rev/min', 'N m'), torques),
    )
    return '\n\n'.join(parts)


def span(values: Sequence[float]) -> str:
    """Return one number, or the range of several, to two digits or decimals."""
    low, high = (
        f'{value:.2g}' if value < 0.1 else f'{value:.2f}' for value in (min(values), max(values))
    )
    return low if low == high else f'{low} to {high}'
