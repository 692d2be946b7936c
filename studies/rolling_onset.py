# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The onset of contact under roughness that rolls: its speed against every choice of the model.

Usage: python studies/rolling_onset.py [--only NAME ...] [--out studies/results/rolling_onset.csv].
Each variation changes one thing of the base case, a strip in the middle of the nominal contact
under a falling speed. Finished ramps are kept in rolling_onset.csv.store, so that an interrupted
study goes on where it stopped.

"""

import argparse
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
import math
from pathlib import Path
from typing import Any

from surrogate.ehl import ContactLubricant
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.moving import MarchSettings, ramp_contact, ramp_strip, SpeedRamp, strip_at
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.periodic import periodic_across
from surrogate.raceway.scaling import draw_raceway, scale_spectrum, with_shorter_waves
from surrogate.raceway.short_waves import without_short_waves
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.tasks.kept import run_kept
from surrogate.tasks.table import read_table, write_table

WORK = 'studies/rolling_onset.py 1'
"""Solver and version of the kept results."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """
    One setting of the study.

    Shortest wave [um], nodes per it along and across the track, load [N], place across over the
    semi-axis [-], None for the whole contact, width of the strip over the half length of the
    contact [-], floor [nm], first and last speed [m/s], transits, nodes of a step, seed of the
    draw; roughness: Rq [um], long cut-off [mm], fractal dimension; Eyring stress of the ripples'
    flow [MPa], None for a Newtonian oil; sideways slip [-].

    """

    name: str
    shortest_um: float = 9.0
    along: float = 8.0
    across: float = 6.0
    load: float = 27.6
    place: float | None = 0.0
    width: float = 2.0
    floor_nm: float = 3.0
    first: float = 0.3
    last: float = 0.03
    transits: float = 16.0
    stride: int = 1
    seed: int = 0
    rms_um: float = 0.12
    cutoff_long_mm: float = 0.25
    dimension: float = 2.68
    eyring_MPa: float | None = None
    side_slip: float = 0.0


BASE = Variation(name='base')
COARSE = replace(BASE, along=5.0, across=4.0, transits=10.0)
STUDY = (
    BASE,
    replace(BASE, name='wave 22 um', shortest_um=21.0, first=0.15, last=0.015),
    replace(BASE, name='wave 15 um', shortest_um=14.0, first=0.2, last=0.02),
    replace(BASE, name='wave 6.5 um', shortest_um=6.0, first=0.4, last=0.05),
    replace(BASE, name='wave 4.3 um', shortest_um=4.0, first=0.5, last=0.1, transits=10.0),
    replace(BASE, name='wave 2.9 um', shortest_um=2.6, first=0.6, last=0.24, transits=6.0),
    replace(COARSE, name='wave 6.5 um, half the nodes', shortest_um=6.0, first=0.4, last=0.1),
    replace(COARSE, name='wave 2.9 um, half the nodes', shortest_um=2.6, first=0.8, last=0.2),
    replace(
        COARSE,
        name='wave 1.9 um, half the nodes',
        shortest_um=1.8,
        first=0.9,
        last=0.35,
        transits=4.0,
    ),
    replace(BASE, name='floor 1 nm', floor_nm=1.0),
    replace(BASE, name='floor 2 nm', floor_nm=2.0),
    replace(BASE, name='floor 5 nm', floor_nm=5.0),
    replace(BASE, name='floor 10 nm', floor_nm=10.0, first=0.6, last=0.06),
    replace(COARSE, name='half the nodes', transits=16.0),
    replace(BASE, name='12 x 9 nodes a wave', along=12.0, across=9.0),
    replace(BASE, name='16 nodes along, step of 2', along=16.0, stride=2),
    replace(BASE, name='step of 2', stride=2),
    replace(BASE, name='rising speed', first=0.03, last=0.3),
    replace(BASE, name='slower ramp', transits=48.0),
    replace(BASE, name='draw 1', seed=1),
    replace(BASE, name='draw 2', seed=2),
    replace(BASE, name='draw 3', seed=3),
    replace(BASE, name='twice the width', width=4.0),
    replace(BASE, name='place 0.5', place=0.5),
    replace(BASE, name='place 0.8', place=0.8),
    replace(COARSE, name='whole contact', place=None, first=0.2, last=0.06, transits=4.0),
    replace(BASE, name='100 N', load=100.0),
    replace(BASE, name='5 N', load=5.0),
    replace(BASE, name='Eyring stress 5 MPa', eyring_MPa=5.0),
    replace(BASE, name='Eyring stress 20 MPa', eyring_MPa=20.0),
    replace(BASE, name='1.9 % sideways slip', side_slip=0.019),
    replace(BASE, name='cut-off 0.8 mm', cutoff_long_mm=0.8, first=0.2, last=0.02),
    replace(BASE, name='dimension 2.4', dimension=2.4, first=0.2, last=0.02),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class RampRow:
    """Means over a transit: speed [m/s], smooth film [m]; onset of the ramp and film there."""

    variation: str
    speed: float
    film: float
    rcs: float
    onset: float
    onset_film: float
    nodes_along: int
    nodes_across: int
    status: str
    steps: int
    failed: int
    seconds: float


def solve_ramp(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """March one variation in plain JSON."""
    variation = Variation(**inputs['variation'])
    ramp, nx, ny = march(variation)
    speeds, means = ramp.means(1.0) if ramp.speeds.size else ([], [])
    onset = ramp.onset() if ramp.speeds.size else math.nan
    rows = [
        RampRow(
            variation=variation.name,
            speed=float(speed),
            film=ramp.film_at(speed),
            rcs=float(rcs),
            onset=onset,
            onset_film=ramp.film_at(onset) if onset > 0 else math.nan,
            nodes_along=nx,
            nodes_across=ny,
            status=ramp.status.name,
            steps=ramp.steps,
            failed=ramp.steps_failed,
            seconds=ramp.wall_time,
        )
        for speed, rcs in zip(speeds, means, strict=True)
    ]
    return {'rows': [asdict(row) for row in rows]}


def march(variation: Variation) -> tuple[SpeedRamp, int, int]:
    """March one variation; return also the nodes along and across."""
    contact = screw_contact(load_screw('nominal'), 'screw')
    oil = load_lubricant('iso_vg_68')
    lubricant = ContactLubricant(
        viscosity=oil.viscosity, pressure_viscosity=oil.pressure_viscosity
    )
    spectrum = RoughnessSpectrum(
        rms=variation.rms_um * 1e-6,
        cutoff_long=variation.cutoff_long_mm * 1e-3,
        fractal_dimension=variation.dimension,
    )
    cut, waves = variation.shortest_um * 1e-6, scale_spectrum(spectrum)
    if cut < spectrum.cutoff_short:
        # Waves that no stylus has measured, to show what depends on them.
        waves = with_shorter_waves(spectrum, cut)
    surface = without_short_waves(draw_raceway(waves, variation.seed), cut)
    ellipse = hertz(contact, variation.load)
    a = float(ellipse.semi_axis_x)
    shortest = surface.shortest_wavelength
    nx = 2 * math.ceil(0.5 * variation.along * 5.2 * a / shortest) + 1
    settings = MarchSettings(
        nx=nx,
        places=1,
        stride=variation.stride,
        film_floor=variation.floor_nm * 1e-9,
        ripple_eyring_stress=1e6 * (variation.eyring_MPa or math.inf),
        side_slip=variation.side_slip,
    )
    speeds, ways = (variation.first, variation.last), {'transits': variation.transits}
    if variation.place is None:
        ny = (
            2 * math.ceil(0.5 * variation.across * 2.8 * float(ellipse.semi_axis_y) / shortest) + 1
        )
        whole = replace(settings, ny=ny)
        return (
            ramp_contact(
                contact, lubricant, variation.load, speeds, surface.heights, settings=whole, **ways
            ),
            nx,
            ny,
        )
    width = variation.width * a
    ny = good_length(math.ceil(variation.across * width / shortest))
    strip = strip_at(contact, variation.load, variation.place, width, ny)
    repeated = periodic_across(surface, width)
    return (
        ramp_strip(strip, lubricant, speeds, repeated.heights, settings=settings, **ways),
        nx,
        ny,
    )


def main() -> None:
    """Run what is missing and write the table; rows of other variations stay in it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--only', nargs='*', default=None, help='names of variations')
    parser.add_argument('--out', type=Path, default=Path('studies/results/rolling_onset.csv'))
    parser.add_argument('--workers', type=int, default=1, help='processes')
    args = parser.parse_args()
    tasks = {
        variation.name: {'variation': asdict(variation)}
        for variation in STUDY
        if not args.only or variation.name in args.only
    }
    found = run_kept(args.out, WORK, solve_ramp, tasks, workers=args.workers, unit='ramps')
    rows = read_table(args.out, RampRow)
    rows += [RampRow(**row) for result in found.values() for row in result['rows']]
    by_place = {(row.variation, round(row.speed, 9)): row for row in rows}
    write_table(args.out, RampRow, by_place.values(), digits=6)


if __name__ == '__main__':
    main()
