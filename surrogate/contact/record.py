# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A contact as a record, standing or rolling: plain numbers for JSON, a page for a person."""

from collections.abc import Iterator, Mapping
import math
from typing import Any

from surrogate.contact.case import ContactCase
from surrogate.contact.surface import composite_rms, raceway_waves, roughness_words
from surrogate.ehl import ContactSolution
from surrogate.ehl.friction import slide_roll_friction
from surrogate.ehl.moving import MovingSolution, StripContact
from surrogate.ehl.moving.interface import HARDNESS, THIN_FILMS
from surrogate.formulas.geometry import hertz
from surrogate.raceway.patch import Raceway
from surrogate.results import declared, Mean
from surrogate.units import GIGA, MICRO, MILLI, NANO

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
"""Keys of the record where the roughness stands."""
ROLLING_KEYS = {
    'status': 'how the march ended',
    'converged': 'whether the numbers are valid',
    'kinematics': 'rolling',
    'rcs': 'average over time',
    'asperity_share': 'average',
    'mean_film_m': 'over the inner 0.8 of the Hertz zone',
    'film_rms_m': 'the same zone',
    'least_film_m': 'smallest film',
    'thin_film_m': '1, 3, 5 and 10 nm',
    'thin_share': 'part of the Hertz zone with films below each; 0 up to the floor',
    'max_pressure_Pa': 'average of the largest pressure',
    'hard_pressure_Pa': 'pressure at which steel yields',
    'hard_share': 'part of the load above it',
    'film_traction': 'at `slide_roll_ratio`, oil alone',
    'slide_roll_ratio': 'as stated',
    'rolling_force_N': 'with roughness',
    'smooth_rolling_force_N': 'of the smooth contact',
    'central_film_m': 'of the smooth contact',
    'film_ratio': 'that film over the complete Rq of raceway and ball',
    'memory_length_m': 'distance over which RCS forgets',
    'transits': 'contact lengths that rolled through',
    'places': 'tracks side by side',
    'steps': 'of the march',
    'steps_failed': 'of the march',
    'newton_iterations': 'number',
    'krylov_iterations': 'number',
    'grid': 'nodes along and across',
    'strip_width_m': 'of a strip',
    'semi_axis_x_m': 'of the Hertz ellipse, along the track',
    'hertz_pressure_Pa': 'largest Hertz pressure',
    'film_floor_m': 'floor at which asperities carry',
    'roughness': 'the printed sentence, Rq, cut-offs, slope, D and G',
    'wall_s': 'wall time',
}
"""Keys where it rolls; a standard error beside an average has the key of the average."""
Solution = ContactSolution | MovingSolution


def contact_record(
    case: ContactCase, solution: Solution, surface: Raceway | None
) -> dict[str, Any]:
    """
    Return a solution in SI units, JSON types; shares, errors and transits [-].

    The rolling force of roughness that stands holds the tail between inlet and meniscus unless the
    case states its domain. Where the roughness rolls, a standard error is that of the average
    before it, and in its unit; roughness is NaN or None where a surface is not by the standard.

    """
    if isinstance(solution, MovingSolution):
        numbers = _rolling(case, solution, surface)
    else:
        friction = case.roughness.asperity_friction if case.roughness else ASPERITY_FRICTION
        numbers = {
            'rolling_force_N': float(solution.whole_rolling_force),
            'friction_coefficient': [
                friction_coefficient(solution, ratio, friction) for ratio in case.slide_roll_ratio
            ],
            'grid': [len(solution.x), len(solution.y)],
        }
    return {
        'status': solution.status.value,
        'converged': bool(solution.converged),
        **declared(solution),
        **numbers,
        'film_floor_m': float(solution.settings.film_floor),
        'wall_s': float(solution.wall_time),
    }


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


def _rolling(
    case: ContactCase, solution: MovingSolution, surface: Raceway | None
) -> dict[str, Any]:
    assert case.roughness is not None
    assert surface is not None
    settings, (semi_axis, _, pressure) = solution.settings, hertz_of(solution)
    standard = raceway_waves(case.roughness) if case.roughness.patch == 'standard' else None
    roughness = {
        'sentence': roughness_words(case.roughness, surface),
        'rms_m': composite_rms(case.roughness),
        'raceway_rms_m': case.roughness.rms or 0.0,
        'cutoff_long_m': standard.band.cutoff_long if standard else math.nan,
        'cutoff_short_m': standard.band.cutoff_short if standard else math.nan,
        'cutoff_by_table': standard.cutoff_by_table if standard else None,
        'rms_slope_rad': standard.rms_slope if standard else math.nan,
        'fractal_dimension': standard.fractal_dimension if standard else math.nan,
        'fractal_roughness_m': standard.fractal_roughness if standard else math.nan,
        'shortest_wavelength_m': surface.shortest_wavelength,
    }
    strip = solution.contact if isinstance(solution.contact, StripContact) else None
    return {
        'kinematics': case.kinematics,
        'thin_film_m': list(THIN_FILMS),
        'thin_share': [share.value for share in solution.thin_shares],
        'thin_share_standard_error': [share.error for share in solution.thin_shares],
        'hard_pressure_Pa': HARDNESS,
        'slide_roll_ratio': settings.slide_roll_ratio,
        'rolling_force_N': solution.rolling_loss.value,
        'rolling_force_standard_error_N': solution.rolling_loss.error,
        'smooth_rolling_force_N': solution.smooth_rolling_loss,
        'film_ratio': solution.central_film / composite_rms(case.roughness),
        'memory_length_m': solution.memory * semi_axis,
        'places': settings.places,
        'grid': [settings.nx, strip.columns if strip else settings.ny],
        'strip_width_m': strip.width if strip else math.nan,
        'semi_axis_x_m': semi_axis,
        'hertz_pressure_Pa': pressure,
        'roughness': roughness,
    }


def hertz_of(solution: MovingSolution) -> tuple[float, float, float]:
    """Return the semi-axes of the Hertz zone [m] and its pressure [Pa]; a strip has no end."""
    contact = solution.contact
    if isinstance(contact, StripContact):
        return contact.semi_axis, math.inf, contact.max_pressure
    ellipse = hertz(contact, solution.condition.load)
    return float(ellipse.semi_axis_x), float(ellipse.semi_axis_y), float(ellipse.max_pressure)


def contact_page(
    record: Mapping[str, Any], case: ContactCase, solution: Solution, surface: Raceway | None
) -> str:
    """Return a record as a page of text in workshop units."""
    if isinstance(solution, MovingSolution):
        kind, rows = 'rolling contact', _rolling_rows(record, case, solution)
    else:
        kind, rows = 'contact', _standing_rows(record, case, solution, surface)
    return '\n'.join(
        [
            f'{kind} {1e3 * case.radius_x:g} x {1e3 * case.radius_y:g} mm: {case.load:g} N, '
            f'{case.entrainment_speed:g} m/s, {case.viscosity:g} Pa s, {case.fluid}',
            *(f'  {name:22} {words}' for name, words in rows),
            f'  status: {record["status"]}',
        ]
    )


def _standing_rows(
    record: Mapping[str, Any],
    case: ContactCase,
    solution: ContactSolution,
    surface: Raceway | None,
) -> Iterator[tuple[str, str]]:
    yield 'roughness', roughness_words(case.roughness, surface)
    yield 'film floor', f'{NANO * solution.settings.film_floor:.3g} nm'
    error = solution.film_error
    grid = '' if math.isnan(error) else f', grid error about {100 * error:.2g} %'
    yield 'central film', f'{NANO * record["central_film_m"]:.2f} nm{grid}'
    yield 'minimum film', f'{NANO * record["minimum_film_m"]:.2f} nm'
    yield 'largest pressure', f'{GIGA * record["max_pressure_Pa"]:.4f} GPa'
    axes = ' x '.join(f'{MICRO * record[f"semi_axis_{axis}_m"]:.1f}' for axis in 'xy')
    yield 'Hertz', f'{GIGA * record["hertz_pressure_Pa"]:.4f} GPa, semi-axes {axes} um'
    half = solution.rcs_error
    words = '' if math.isnan(half) else f', RCS on the half grid differs by {half:.2g}'
    yield 'RCS, asperity share', f'{record["rcs"]:.3g}, {record["asperity_share"]:.3g}{words}'
    yield 'rolling force', f'{MILLI * record["rolling_force_N"]:.3g} mN on each surface'
    for ratio, value in zip(case.slide_roll_ratio, record['friction_coefficient'], strict=True):
        yield f'friction, slip {100 * ratio:g} %', f'{value:.4f}'
    nx, ny = record['grid']
    yield (
        'solver',
        f'{nx} x {ny} nodes, {record["newton_iterations"]} Newton and '
        f'{record["krylov_iterations"]} Krylov iterations, {record["wall_s"]:.2f} s',
    )
    yield (
        'errors',
        f'flux {record["residual"]:.1e}, load {record["load_error"]:.1e}, contact gap '
        f'{solution.gap_error:.1e}',
    )


def _rolling_rows(
    record: Mapping[str, Any], case: ContactCase, solution: MovingSolution
) -> Iterator[tuple[str, str]]:
    for part in record['roughness']['sentence'].split('; '):
        yield 'roughness', part
    if case.strip is not None:
        words = f'at {case.strip.place:g} b across, {MICRO * record["strip_width_m"]:g} um wide'
        yield 'strip', words
    film, ratio = NANO * record['central_film_m'], record['film_ratio']
    yield 'smooth central film', f'{film:.2f} nm, Lambda {ratio:.3g}'
    yield 'film floor', f'{NANO * record["film_floor_m"]:.3g} nm'
    yield 'RCS', _with_error(solution.rcs)
    yield 'asperity share', _with_error(solution.asperity_share)
    yield 'mean film', f'{_with_error(solution.mean_film, NANO)} nm'
    yield 'film rms', f'{_with_error(solution.film_rms, NANO)} nm'
    yield 'least film', f'{_with_error(solution.least_film, NANO)} nm'
    for thin, share in zip(THIN_FILMS, solution.thin_shares, strict=True):
        yield f'zone below {NANO * thin:g} nm', f'{_with_error(share, 100.0)} %'
    yield 'largest pressure', f'{_with_error(solution.max_pressure, GIGA)} GPa'
    yield f'load above {GIGA * HARDNESS:g} GPa', f'{_with_error(solution.hard_share, 100.0)} %'
    slip = f'slip {100 * record["slide_roll_ratio"]:g} %'
    yield 'film traction', f'{_with_error(solution.film_traction)}, {slip}'
    smooth = f'smooth {MILLI * record["smooth_rolling_force_N"]:.3g} mN'
    loss = _with_error(solution.rolling_loss, MILLI)
    yield 'rolling force', f'{loss} mN on each surface, {smooth}'
    yield 'memory', f'RCS forgets over {MICRO * record["memory_length_m"]:.3g} um of the way'
    nx, ny = record['grid']
    words = f'{record["transits"]:.3g} transits over {record["places"]} places, {nx} x {ny} nodes'
    steps = f'{record["steps"]} steps, {record["steps_failed"]} of them failed'
    yield 'march', f'{words}, {steps}, {record["wall_s"]:.1f} s'


def _with_error(mean: Mean, unit: float = 1.0) -> str:
    """Return an average and its standard error, which one place does not have."""
    error = '' if math.isnan(mean.error) else f' +- {unit * mean.error:.2g}'
    return f'{unit * mean.value:.3g}{error}'
