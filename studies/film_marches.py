# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Designed marches at coarse waves: the film at which contact begins, over Rq, lay, state and screw.

Usage: python studies/film_marches.py [--only NAME ...] [--report].

Each march that ends is added to results/film_marches.csv and film_courses.csv at once, and one
that is there is not marched again. Last it prints how the law of the onset tells them.

"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
import math
from pathlib import Path
from typing import Any, cast

import numpy as np
import own_strips
from surrogate.asperities.law import FILM_BANDS, FILM_POWER
from surrogate.asperities.running_in import RunningContact, tile_size
from surrogate.asperities.strips import raceway_strips, RacewayStrip
from surrogate.asperities.topography import (
    HIGHER,
    isotropy,
    lay_of,
    left_by_rolling,
    LOAD_SHARE,
    RIDGE_POWER,
    TOLERANCE,
    UNCUT,
    WAVE_POWER,
)
from surrogate.asperities.topography_onset import COARSE_FILM, film_at_onset, FLOORS
from surrogate.builder.full.march import FINER
from surrogate.ehl import ContactLubricant
from surrogate.ehl.moving import SpeedRamp
from surrogate.formulas.geometry import Side
from surrogate.formulas.line import central_film_line, moes_line
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import load_lubricant, load_screw, Screw
from surrogate.raceway.dry_contact import press
from surrogate.raceway.fractal import Lay
from surrogate.raceway.stated import State
from surrogate.raceway.tile import draw_tile
from surrogate.tasks.table import read_table, write_table
from surrogate.units import ZERO_CELSIUS
from topography_onset import cut_alone

RESULTS = Path('studies/results/film_marches.csv')
COURSES = Path('studies/results/film_courses.csv')
PART = 1.0
"""Transits of a mean of a course [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """
    A march: screw, side, oil at a temperature [degC], preload over that of the sheet, roughness.

    Rq [um], lay with the fan of its ridges [deg], fractal dimension, long cut-off [mm], state,
    draw, film floor [nm], half length of the contact over the shortest wave at most [-]; role
    `fit`, `choice` for one that the form was chosen by, or `held out`.

    """

    march: str
    role: str
    screw: str
    side: str = 'screw'
    oil: str = 'iso_vg_68'
    temperature_degC: float = 40.0
    preload: float = 1.0
    rms_um: float
    lay: str = 'isotropic'
    fan_deg: float = 10.0
    fractal_dimension: float = 2.5
    cutoff_long_mm: float = 0.25
    state: str = 'new'
    draw: int = 1
    floor_nm: float = 3.0
    waves: float = 6.5


@dataclass(frozen=True, kw_only=True, slots=True)
class Marched(Case):
    """
    A case with what was marched, numbers at the onset.

    Onset speed [m/s], NaN where it was not found, and the speed that the law told before the
    march; film by the formula [nm] and of the march's smooth contact; of what rolling leaves there
    the mean gap [nm], the mean wave [um] and the rms [nm]; lay of the slopes; Hertz pressure
    [GPa], half length [um], shortest wave [um]; slope of the logarithm of film over gap in that of
    the speed; status, steps, those that failed and processor time [s].

    """

    onset_m_s: float = math.nan
    expected_m_s: float = math.nan
    film_nm: float = math.nan
    smooth_nm: float = math.nan
    gap_nm: float = math.nan
    wave_um: float = math.nan
    left_nm: float = math.nan
    slopes: float = math.nan
    pressure_GPa: float = math.nan
    half_um: float = math.nan
    shortest_um: float = math.nan
    slope: float = math.nan
    status: str = ''
    steps: int = 0
    failed: int = 0
    seconds: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """Means over a part of a march: speed [m/s], film [nm], RCS, share and loss factor [-]."""

    march: str
    speed: float
    film_nm: float
    rcs: float
    asperity_share: float
    loss_factor: float


def case(role: str, size: str, rms_um: float, lay: str, state: str, **other: Any) -> Case:
    """Return a case with the name of what it is."""
    screw = size if size == 'nominal' else f'iso3408_{size}'
    more = ' '.join(f'{key}={value}' for key, value in other.items())
    name = f'{size} {rms_um:g} {lay[:5]} {state} {more}'.strip()
    return Case(march=name, role=role, screw=screw, rms_um=rms_um, lay=lay, state=state, **other)


ISO, LON, TRA = 'isotropic', 'longitudinal', 'transverse'
CASES = (
    case('fit', 'nominal', 0.05, ISO, 'new', fractal_dimension=2.68),
    case('fit', '40x10', 0.2, LON, 'run_in'),
    case('fit', '20x5', 0.1, LON, 'new', draw=2),
    case('fit', '16x5', 0.4, ISO, 'run_in', oil='iso_vg_100'),
    case('fit', '32x10', 0.1, TRA, 'new'),
    case('fit', '63x20', 0.3, LON, 'run_in', fractal_dimension=2.4),
    case('fit', '20x5', 0.06, ISO, 'run_in', oil='iso_vg_32', draw=3),
    case('fit', '16x5', 0.2, LON, 'run_in', draw=3),
    case('fit', '40x10', 0.05, LON, 'new', draw=2),
    case('fit', '50x10', 0.2, ISO, 'new', draw=2),
    case('fit', '20x5', 0.2, TRA, 'run_in', draw=2),
    case('fit', '63x20', 0.08, ISO, 'new', draw=3, fractal_dimension=2.6),
    case('fit', '25x5', 0.4, LON, 'new', oil='iso_vg_100', draw=1),
    case('fit', '40x10', 0.4, ISO, 'new', draw=2, fractal_dimension=2.4),
    case('fit', '20x5', 0.05, ISO, 'new', draw=2, preload=0.3),
    case('fit', '32x10', 0.4, LON, 'run_in', draw=3, temperature_degC=25.0),
    case('fit', '16x5', 0.1, ISO, 'new', draw=3, fractal_dimension=2.6, preload=0.4),
    case('fit', '40x10', 0.1, TRA, 'run_in', draw=3, oil='iso_vg_32'),
    case('fit', '20x5', 0.05, LON, 'run_in', draw=1, fractal_dimension=2.6),
    case('fit', '50x10', 0.1, LON, 'new', draw=1, preload=0.4),
    case('fit', '63x20', 0.2, TRA, 'new', draw=1),
    case('fit', 'nominal', 0.3, ISO, 'run_in', draw=3, fractal_dimension=2.6),
    case('fit', '25x5', 0.06, TRA, 'new', draw=2, fractal_dimension=2.6),
    case('choice', '20x5', 0.2, ISO, 'run_in', draw=21),
    case('choice', '40x10', 0.2, LON, 'new', draw=22),
    case('choice', '16x5', 0.06, ISO, 'new', draw=23, fractal_dimension=2.6),
    case('choice', '25x5', 0.1, LON, 'run_in', draw=24),
    case('choice', '63x20', 0.4, ISO, 'run_in', draw=25, fractal_dimension=2.4),
    case('choice', '50x10', 0.3, LON, 'run_in', draw=26, oil='iso_vg_100'),
    case('choice', '32x10', 0.05, ISO, 'new', draw=27),
    case('choice', '20x5', 0.15, TRA, 'new', draw=28),
    case('choice', 'nominal', 0.12, ISO, 'new', draw=29, fractal_dimension=2.68),
    case('choice', '16x5', 0.08, LON, 'new', draw=30, preload=0.5),
    case('choice', '40x10', 0.3, TRA, 'run_in', draw=31),
    case('choice', '32x10', 0.3, ISO, 'new', draw=32, oil='iso_vg_32', temperature_degC=30.0),
    case('held out', '25x5', 0.3, ISO, 'run_in', draw=41),
    case('held out', '40x10', 0.1, LON, 'run_in', draw=42, temperature_degC=30.0),
    case('held out', '50x10', 0.15, TRA, 'new', draw=43),
    case('held out', '16x5', 0.15, ISO, 'new', draw=44, fractal_dimension=2.4),
    case('held out', '63x20', 0.2, LON, 'new', draw=45),
    case('held out', '40x10', 0.2, ISO, 'run_in', draw=46, oil='iso_vg_100'),
    case('held out', '32x10', 0.06, ISO, 'new', draw=47, fractal_dimension=2.6, preload=0.5),
    case('held out', '20x5', 0.3, LON, 'run_in', draw=48, oil='iso_vg_100'),
    case('held out', '63x20', 0.1, TRA, 'run_in', draw=49),
    case('held out', '50x10', 0.08, LON, 'new', draw=50),
    case('held out', '63x20', 0.4, ISO, 'new', draw=51, fractal_dimension=2.6),
)
"""All marches, those of the fit first, in an order in which each part spans what is varied."""


def sheet_of(case: Case) -> Screw:
    """Return the screw of a case."""
    screw = load_screw(case.screw)
    roughness = replace(
        screw.roughness,
        rms=1e-6 * case.rms_um,
        rms_low=None,
        rms_high=None,
        lay=cast('Lay', case.lay),
        fan_angle=None if case.lay == ISO else math.radians(case.fan_deg),
        fractal_dimension=case.fractal_dimension,
        cutoff_long=1e-3 * case.cutoff_long_mm,
        state=cast('State', case.state),
        traced='new',
    )
    return replace(
        screw, roughness=roughness, preload=case.preload * screw.preload, working_load=None
    )


def strip_of(case: Case) -> RacewayStrip:
    """
    Return the strip of a case.

    Isotropic raceways that ran in are cut as `run_in` does, all others where their summits carry
    the hardness, as they were marched.

    """
    lubricant = load_lubricant(case.oil)
    state = lubricant_state(lubricant, case.temperature_degC + ZERO_CELSIUS)
    oil = ContactLubricant(
        viscosity=float(state.viscosity), pressure_viscosity=float(state.pressure_viscosity)
    )
    floor, screw, side = 1e-9 * case.floor_nm, sheet_of(case), cast('Side', case.side)
    (strip,) = raceway_strips(screw, side, oil, floor, draws=[case.draw], waves=case.waves)
    if (case.lay, case.state) == (ISO, 'run_in'):
        return strip
    running, shortest = RunningContact.of(screw, side), strip.shortest
    size, shape = tile_size(running, shortest=shortest)
    tile = draw_tile(running.waves[0], case.draw, size=size, shape=shape, shortest=shortest)
    pressures = running.working_pressure, running.cutting_pressure
    return replace(strip, tile=cut_alone(tile, 0.5 * running.reduced_modulus, *pressures))


def left_at(strip: RacewayStrip, speed: float) -> tuple[float, float, float, float]:
    """Return smooth film, and mean gap, mean wave and rms of what is left at a speed [m]."""
    line, oil = strip.strip.line, strip.oil
    M1, L = moes_line(line, speed, oil.viscosity, oil.pressure_viscosity)
    film = float(central_film_line(line, speed, oil.viscosity, oil.pressure_viscosity))
    left = left_by_rolling(strip.tile, float(M1**0.75 / np.sqrt(L)) / strip.strip.semi_axis)
    load = LOAD_SHARE * 0.25 * math.pi * strip.strip.max_pressure
    pressed = press(left, 0.5 * strip.strip.reduced_modulus, load, tolerance=TOLERANCE)
    wave = 2 * math.pi * math.sqrt(left.moment(0) / left.moment(1))
    return film, pressed.separation, wave, math.sqrt(left.moment(0))


def march(case: Case) -> tuple[Marched, list[Part]]:
    """March a case; return what was found and its course."""
    strip = strip_of(case)
    expected = strip.told
    onset, ramp = strip.march(expected)
    marched = Marched(
        **{name: getattr(case, name) for name in Case.__dataclass_fields__},
        onset_m_s=onset,
        expected_m_s=expected,
        slopes=lay_of(strip.tile),
        pressure_GPa=1e-9 * strip.strip.max_pressure,
        half_um=1e6 * strip.strip.semi_axis,
        shortest_um=1e6 * strip.shortest,
        status=ramp.status.name,
        steps=ramp.steps,
        failed=ramp.steps_failed,
        seconds=ramp.wall_time,
    )
    if math.isfinite(onset):
        film, gap, wave, left = left_at(strip, onset)
        ends = [left_at(strip, factor * onset) for factor in (1 / 1.1, 1.1)]
        slope = math.log(ends[1][0] / ends[1][1] / (ends[0][0] / ends[0][1])) / math.log(1.21)
        marched = replace(
            marched,
            film_nm=1e9 * film,
            smooth_nm=1e9 * ramp.film_at(onset),
            gap_nm=1e9 * gap,
            wave_um=1e6 * wave,
            left_nm=1e9 * left,
            slope=slope,
        )
    return marched, course(case.march, ramp) if ramp.speeds.size else []


def course(name: str, ramp: SpeedRamp) -> list[Part]:
    """Return the course of a march."""
    names = 'rcs', 'asperity_share', 'loss_factor'
    means = [ramp.means(PART, name) for name in names]
    return [
        Part(
            march=name,
            speed=float(speed),
            film_nm=1e9 * ramp.film_at(speed),
            **dict(zip(names, map(float, row), strict=True)),
        )
        for speed, *row in zip(means[0][0], *(mean for _, mean in means), strict=True)
    ]


def told_over_marched(row: Marched) -> float:
    """Return the film at the onset by the law, on the nodes of marches, over that marched [-]."""
    cut = row.gap_nm / (UNCUT * row.left_nm)
    height = 1e-9 * row.gap_nm * (1e-6 * row.wave_um) ** WAVE_POWER
    height *= cut ** (RIDGE_POWER * row.slopes) * math.exp(HIGHER * isotropy(row.slopes))
    film = film_at_onset(height, 1e-9 * row.floor_nm, 1e9 * row.pressure_GPa)
    return float(film) / COARSE_FILM / (1e-9 * row.film_nm)


@dataclass(frozen=True, kw_only=True, slots=True)
class HeldOut:
    """A strip that chose neither form nor constants; its `miss` is ln(marched over told film)."""

    raceway: str
    lay: str
    state: str
    miss: float


def held_out_strips(rows: Sequence[Marched]) -> list[HeldOut]:
    """Return the coarse strips that were held out: designed marches, and those of own screws."""
    strips = [
        HeldOut(
            raceway=row.march, lay=row.lay, state=row.state, miss=-math.log(told_over_marched(row))
        )
        for row in rows
        if row.role == 'held out'
    ]
    return strips + [
        HeldOut(
            raceway=f'own {1 + row.own}',
            lay=row.lay,
            state=own_strips.OWN[row.own].state,
            miss=math.log(row.film_factor),
        )
        for row in read_table(own_strips.RESULTS, own_strips.Strip)
        if row.strip != FINER and math.isfinite(row.film_factor)
    ]


def nine_of_ten(misses: Sequence[float]) -> float:
    """
    Return the factor within which a further strip lies nine times of ten, up to a twentieth [-].

    By split conformal prediction (Vovk, Gammerman, Shafer 2005): of n misses as logarithms the
    ceil(0.9 (n + 1))-th. It needs strips that are exchangeable with the further one; four of one
    raceway are not exchangeable with one of another raceway.

    """
    place = math.ceil(0.9 * (len(misses) + 1))
    return math.ceil(20 * math.exp(sorted(map(abs, misses))[place - 1])) / 20


def slope_of(row: Marched) -> float:
    """Return the slope of film over that of the law in speed [-]; its floors do not fall."""
    floors = FLOORS * row.floor_nm / (told_over_marched(row) * row.film_nm)
    return row.slope * (1 - floors) + FILM_POWER * floors


def report(rows: Sequence[Marched]) -> Iterator[str]:
    """Yield each march, and the scatter of each lay and role."""
    logs = {row.march: math.log(told_over_marched(row)) for row in rows}
    for row in rows:
        log = logs[row.march]
        yield (
            f'{row.march:60} {row.role:9} film {row.film_nm:6.1f} nm, told/marched '
            f'{math.exp(log):.2f} in film, {math.exp(log / slope_of(row)):.2f} in speed'
        )
    for role in ('fit', 'choice', 'held out'):
        for lay, band in FILM_BANDS.items():
            off = np.array([logs[row.march] for row in rows if (row.role, row.lay) == (role, lay)])
            yield (
                f'{role}, {lay}: {off.size}, mean {math.exp(off.mean()):.2f}, rms '
                f'{100 * math.sqrt(np.mean(off**2)):.0f} %, '
                f'{int((np.abs(off) < math.log(band)).sum())} within {band:g}'
            )
    strips = held_out_strips(rows)
    for lay, band in FILM_BANDS.items():
        for states in (('new', 'run_in'), ('new',), ('run_in',)):
            part = [strip for strip in strips if strip.lay == lay and strip.state in states]
            off = np.array([strip.miss for strip in part])
            yield (
                f'all held out, {lay}, {" and ".join(states)}: {off.size} of '
                f'{len({strip.raceway for strip in part})} raceways, mean '
                f'{math.exp(off.mean()):.2f}, rms {100 * math.sqrt(np.mean(off**2)):.1f} %, '
                f'{int((np.abs(off) < math.log(band)).sum())} within {band:g}'
            )
        inside, count = told_by_others([strip for strip in strips if strip.lay == lay])
        yield f'all held out, {lay}, by the bands of the other raceways: {inside} of {count}'


def told_by_others(strips: Sequence[HeldOut]) -> tuple[int, int]:
    """Return how many strips lie in bands given by those of other raceways, and of how many."""
    inside = 0
    for strip in strips:
        others = [other.miss for other in strips if other.raceway != strip.raceway]
        inside += abs(strip.miss) <= math.log(nine_of_ten(others))
    return inside, len(strips)


def main() -> None:
    """March what is missing, and report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--only', nargs='*', metavar='NAME', help='marches by their names')
    parser.add_argument('--report', action='store_true', help='march nothing')
    args = parser.parse_args()
    for case in CASES:
        there = {row.march for row in read_table(RESULTS, Marched)}
        if args.report or case.march in there or (args.only and case.march not in args.only):
            continue
        found, parts = march(case)
        write_table(COURSES, Part, [*read_table(COURSES, Part), *parts], digits=5)
        write_table(RESULTS, Marched, [*read_table(RESULTS, Marched), found], digits=5)
        print(
            f'{found.march}: told {found.expected_m_s:.3g}, marched {found.onset_m_s:.3g} m/s, '
            f'{found.status} {found.failed}/{found.steps}, {found.seconds:.0f} s',
            flush=True,
        )
    print(*report(read_table(RESULTS, Marched)), sep='\n')


if __name__ == '__main__':
    main()
