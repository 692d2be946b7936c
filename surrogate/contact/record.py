# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A solved contact as a record: plain numbers for JSON, and a page for a person."""

from collections.abc import Mapping
import math
from typing import Any

from surrogate.contact.case import ContactCase
from surrogate.contact.surface import roughness_words
from surrogate.ehl import ContactSolution
from surrogate.ehl.friction import slide_roll_friction
from surrogate.raceway.patch import Raceway
from surrogate.results import declared

ASPERITY_FRICTION = 0.1
"""Boundary friction coefficient of a case without roughness [-], for dry contacts."""
KEYS = {
    'status': 'how the solve ended',
    'converged': 'whether the numbers are valid',
    'central_film_m': 'central film',
    'minimum_film_m': 'smallest film',
    'max_pressure_Pa': 'largest pressure',
    'hertz_pressure_Pa': 'largest Hertz pressure',
    'semi_axis_x_m': 'of the Hertz ellipse, along the track',
    'semi_axis_y_m': 'across it',
    'rcs': 'share of the load on punctured nodes',
    'asperity_share': 'share that asperities carry',
    'rolling_force_N': 'on each surface, with the tail to the meniscus unless `domain` is stated',
    'friction_coefficient': 'one for each `slide_roll_ratio`',
    'load_error': 'relative',
    'residual': 'of the flux',
    'newton_iterations': 'number',
    'krylov_iterations': 'number',
    'grid': 'nodes along and across',
    'wall_s': 'wall time',
    'film_error': 'relative, estimated from the half grid',
    'rcs_error': 'the same of RCS',
    'film_floor_m': 'floor at which asperities carry',
}
"""Keys of the record."""


def friction_coefficient(
    solution: ContactSolution, slide_roll_ratio: float, asperity_friction: float
) -> float:
    """Return the friction over the load [-] for slip along x; 0 without slip, NaN if unsolved."""
    if not solution.converged:
        return math.nan
    if slide_roll_ratio == 0.0:
        return 0.0
    friction = slide_roll_friction(solution, slide_roll_ratio, asperity_friction=asperity_friction)
    return friction.coefficient


def contact_record(case: ContactCase, solution: ContactSolution) -> dict[str, Any]:
    """
    Return a solution in SI units, JSON types.

    The rolling force holds the tail between inlet and meniscus unless the case states its domain.

    """
    friction = case.roughness.asperity_friction if case.roughness else ASPERITY_FRICTION
    return {
        'status': solution.status.value,
        'converged': bool(solution.converged),
        **declared(solution),
        'rolling_force_N': float(solution.whole_rolling_force),
        'friction_coefficient': [
            friction_coefficient(solution, ratio, friction) for ratio in case.slide_roll_ratio
        ],
        'grid': [len(solution.x), len(solution.y)],
        'film_floor_m': float(solution.settings.film_floor),
        'wall_s': float(solution.wall_time),
    }


def contact_page(
    record: Mapping[str, Any],
    case: ContactCase,
    solution: ContactSolution,
    surface: Raceway | None,
) -> str:
    """Return a record as a page of text in workshop units."""
    error, half = solution.film_error, ''
    if not math.isnan(solution.rcs_error):
        half = f', RCS on the half grid differs by {solution.rcs_error:.2g}'
    friction = [
        (f'friction, slip {100 * ratio:g} %', f'{value:.4f}')
        for ratio, value in zip(case.slide_roll_ratio, record['friction_coefficient'], strict=True)
    ]
    rows = [
        ('roughness', roughness_words(case.roughness, surface)),
        ('film floor', f'{1e9 * solution.settings.film_floor:.3g} nm'),
        (
            'central film',
            f'{1e9 * record["central_film_m"]:.2f} nm'
            + ('' if math.isnan(error) else f', grid error about {100 * error:.2g} %'),
        ),
        ('minimum film', f'{1e9 * record["minimum_film_m"]:.2f} nm'),
        ('largest pressure', f'{1e-9 * record["max_pressure_Pa"]:.4f} GPa'),
        (
            'Hertz',
            f'{1e-9 * record["hertz_pressure_Pa"]:.4f} GPa, semi-axes '
            f'{1e6 * record["semi_axis_x_m"]:.1f} x {1e6 * record["semi_axis_y_m"]:.1f} um',
        ),
        ('RCS, asperity share', f'{record["rcs"]:.3g}, {record["asperity_share"]:.3g}' + half),
        ('rolling force', f'{1e3 * record["rolling_force_N"]:.3g} mN on each surface'),
        *friction,
        (
            'solver',
            f'{record["grid"][0]} x {record["grid"][1]} nodes, {record["newton_iterations"]} '
            f'Newton and {record["krylov_iterations"]} Krylov iterations, '
            f'{record["wall_s"]:.2f} s',
        ),
        (
            'errors',
            f'flux {record["residual"]:.1e}, load {record["load_error"]:.1e}, contact gap '
            f'{solution.gap_error:.1e}',
        ),
    ]
    return '\n'.join(
        [
            f'contact {1e3 * case.radius_x:g} x {1e3 * case.radius_y:g} mm: {case.load:g} N, '
            f'{case.entrainment_speed:g} m/s, {case.viscosity:g} Pa s, {case.fluid}',
            *(f'  {name:22} {words}' for name, words in rows),
            f'  status: {record["status"]}',
        ]
    )
