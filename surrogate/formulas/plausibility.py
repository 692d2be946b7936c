# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers of a sheet that do not suit each other, with the number that would fit.

The static rating ties balls and load together: it leaves a dent of 1e-4 ball diameters, for which
a ball is pressed by 4 to 4.5 GPa whatever its size.

"""

from collections.abc import Iterator
import math

from surrogate.files import InputError
from surrogate.formulas.geometry import helix_angle, hertz, screw_contact, SIDES
from surrogate.formulas.load_sharing import normal_force, UNLOADING_RATIO
from surrogate.formulas.shaft import shaft_doubts
from surrogate.parameters import Screw
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.standards import CUTOFFS, RA_OVER_RQ
from surrogate.raceway.stated import Roughness
from surrogate.units import GIGA, MICRO, MILLI

RATED = 4.2e9
"""Pressure of a ball at the static rating [Pa], ISO 76."""
POSSIBLE, USUAL = (2e9, 8e9), (2.7e9, 5.2e9)
"""Pressure at the static rating that is allowed, and beyond which there is a doubt [Pa]."""
LEAST_PRELOAD, MOST_PRELOAD, USUAL_PRELOAD = 5e-4, 0.1, 0.02
"""Least preload over static rating that is allowed, largest and median of usual ones [-]."""
LEAST_FILL = 0.2
"""Loaded turns times ball over ball-circle diameter; a diameter as radius gives a quarter [-]."""
LEAST_RMS, MOST_RMS, RZ_OVER_RQ = 0.05e-6, 0.8e-6, 5.0
"""Usual Rq across the track [m], and Rz over it [-]."""
MOST_SLOPE = math.radians(10.0)
"""Largest usual rms slope of a raceway [rad]."""
NEAR = 1.25
"""Factor on Rq within which the table of cut-offs may give another row [-]."""


def rated_pressure(screw: Screw) -> float:
    """Return the Hertz pressure under the static rating [Pa], of the side that is pressed more."""
    force = float(normal_force(screw, screw.static_rating))
    return max(float(hertz(screw_contact(screw, side), force).max_pressure) for side in SIDES)


def rating_by_hertz(screw: Screw) -> float:
    """Return the load that presses each ball by 4.2 GPa [N]."""
    return screw.static_rating * (RATED / rated_pressure(screw)) ** 3


def check_plausible(screw: Screw) -> None:
    """Raise InputError for a rating, number of balls or preload that no screw has."""
    pressure, fit = rated_pressure(screw), rating_by_hertz(screw)
    low, high = POSSIBLE
    if not low <= pressure <= high:
        balls = max(1, round(screw.loaded_balls_per_nut * screw.static_rating / fit))
        raise InputError(
            f'{screw.name}: {_rating(screw)}, allowed is {GIGA * low:g} to {GIGA * high:g} GPa: '
            f'{float(f"{fit / MILLI:.3g}"):g} kN or {balls} balls would fit'
        )
    low, high = (share * screw.static_rating for share in (LEAST_PRELOAD, MOST_PRELOAD))
    if 0 < screw.preload < low:
        kilo = MILLI * screw.preload
        fit = kilo if low <= kilo <= high else USUAL_PRELOAD * screw.static_rating
        raise InputError(
            f'{screw.name}: preload_N is {screw.preload:g} N with static_rating_kN '
            f'{screw.static_rating / MILLI:g} kN, allowed is 0 or {low:.3g} N and more: '
            f'{fit:.4g} N would fit'
        )


def doubts(screw: Screw, *, rating: bool = True) -> list[str]:
    """Return a sentence for each number that is possible but unusual, of the `rating` if asked."""
    sentences = []
    circle = 2 * math.pi * screw.pitch_radius / math.cos(helix_angle(screw))
    turns = screw.loaded_balls_per_nut * screw.ball_diameter / circle
    if turns * screw.ball_diameter < LEAST_FILL * 2 * screw.pitch_radius:
        radius = MILLI * screw.pitch_radius
        sentences.append(
            f'pitch_radius_mm is {radius:g} mm, on which the balls fill {turns:.2g} turns: '
            f'if it is the diameter, {radius / 2:g} mm would fit'
        )
    if rating and not USUAL[0] <= rated_pressure(screw) <= USUAL[1]:
        fit = rating_by_hertz(screw) / MILLI
        sentences.append(f'{_rating(screw)}, usual is 4 to 4.5 GPa: {fit:.3g} kN would fit')
    sentences += _doubts_of_roughness(screw.roughness)
    load = screw.working_load or UNLOADING_RATIO * screw.preload
    sentences += shaft_doubts(screw, screw.fastest_speed, load, ', by the sheet')
    return [f'{screw.name}: {sentence}' for sentence in sentences]


def _rating(screw: Screw) -> str:
    return (
        f'static_rating_kN is {screw.static_rating / MILLI:g} kN and presses '
        f'{screw.loaded_balls_per_nut} balls by {GIGA * rated_pressure(screw):.3g} GPa each'
    )


def _doubts_of_roughness(sheet: Roughness) -> Iterator[str]:
    """Yield doubts about height against lay, slope and cut-off."""
    rms = f'roughness: rms_um is {MICRO * sheet.rms:g} um'
    slope = scale_spectrum(sheet).rms_slope if sheet.rms else 0.0
    if sheet.rms > MOST_RMS:
        fit = MICRO * sheet.rms / RZ_OVER_RQ
        yield f'{rms}, usual is up to {MICRO * MOST_RMS:g}: if it is Rz, {fit:.2g} um would fit'
    if 0 < sheet.rms < LEAST_RMS and sheet.lay == 'longitudinal':
        fit = MICRO * LEAST_RMS
        yield f'{rms}, as of a trace along the lay: across it {fit:g} um and more would fit'
    if slope > MOST_SLOPE:
        fit = MICRO * sheet.rms * math.tan(MOST_SLOPE) / math.tan(slope)
        yield (
            f'{rms} with a slope of {math.degrees(slope):.3g} deg, usual is up to '
            f'{math.degrees(MOST_SLOPE):g} deg: up to {fit:.2g} um would fit'
        )
    for (limit, below), (_, above) in zip(CUTOFFS, CUTOFFS[1:], strict=False):
        step = limit / RA_OVER_RQ
        if sheet.cutoff_long is None and step / NEAR < sheet.rms < step * NEAR:
            yield (
                f'{rms} without cutoff_long_mm, and the table changes at {MICRO * step:g} um: '
                f'{MILLI * below:g} or {MILLI * above:g} mm would fit, as it was measured'
            )
