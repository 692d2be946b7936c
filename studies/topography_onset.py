# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Marched onsets of contact beside those that the topography tells, and their scatter.

Usage: python studies/topography_onset.py [--march NAME] [--benchmark].

Reads results/asperity_marches.csv, in which each row is a strip whose tile was marched under a
falling speed, and draws the picture of docs/theory/raceway.md. With --march it marches one row
again (one to ten minutes), with --benchmark it writes what others need to solve each row.

"""

import argparse
import csv
from dataclasses import dataclass, replace
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from surrogate.asperities.topography import acting_roughness
from surrogate.asperities.topography_onset import COARSE_FILM, TopographyOnset
from surrogate.ehl import ContactLubricant
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.moving import MarchSettings, ramp_strip, StripContact
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.line import line_at
from surrogate.formulas.load_sharing import normal_force
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import load_lubricant, load_screw, Screw
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, VERMILION
from surrogate.raceway.dry_contact import press
from surrogate.raceway.scaling import scale_spectrum, with_shorter_waves
from surrogate.raceway.tile import draw_tile, Tile
from surrogate.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RESULTS = Path('studies/results/asperity_marches.csv')
PICTURE = Path('docs/pictures/topography_onset.png')
BENCHMARK = Path('studies/benchmark')
HEIGHT_UNIT = 2e-11
"""Unit of the heights of a benchmark, whole numbers of 16 bits [m]."""
ALONG, ACROSS, TRANSITS, TURN = 5.0, 4.0, 12.0, 2.0
"""Nodes of a march along and across in the shortest wave, transits, those of a turn [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Strip:
    """A row of the table as a strip with the tile that rolls through it; lengths [m]."""

    name: str
    strip: StripContact
    oil: ContactLubricant
    tile: Tile
    shortest: float
    film_floor: float
    onset: float

    @property
    def told(self) -> float:
        """Onset speed that the topography of this very tile tells, biased as marches are [m/s]."""
        return self.told_at(1.0)

    def told_at(self, film: float) -> float:
        """Return it where the film is `film` times that of the law [-]."""
        acting = acting_roughness([self.tile], 0.5 * self.strip.reduced_modulus, self.shortest)
        law = TopographyOnset(acting=acting, film_factor=film / COARSE_FILM)
        return float(law.speeds(self.strip.line, self.oil, self.film_floor))


def screw_of(row: dict[str, str]) -> Screw:
    """Return the screw of a row, nominal or 20x5, with its roughness."""
    screw = load_screw('nominal')
    if row['screw'] == '20x5':
        screw = replace(
            screw,
            name='20x5',
            pitch_radius=10.3e-3,
            lead=5e-3,
            ball_diameter=3.175e-3,
            loaded_balls_per_nut=56,
            preload=350.0,
            static_rating=22e3,
        )
    lay = row['lay']
    roughness = replace(
        screw.roughness,
        fractal_dimension=float(row['fractal_dimension']),
        cutoff_long=1e-3 * float(row['cutoff_long_mm']),
        lay=lay,
        fan_angle=None if lay == 'isotropic' else math.radians(10),
    )
    return replace(screw, roughness=roughness)


def cut_alone(tile: Tile, modulus: float, pressure: float, hardness: float) -> Tile:
    """
    Return a tile, cut where summits carry their hardness [Pa] and risen nowhere.

    Strips of the tables were marched on tiles that were cut so, not as raceways run in.

    """
    contact = press(tile, modulus, pressure, hardness=hardness, tolerance=1e-3)
    yields = (contact.pressure >= hardness) & (contact.gap < 0)
    return replace(tile, heights=tile.heights + np.where(yields, contact.gap, 0.0))


def strip_of(row: dict[str, str]) -> Strip:
    """Return the strip of a row of the table."""
    screw, lubricant = screw_of(row), load_lubricant(row['oil'])
    contact = screw_contact(screw, 'screw')
    line = line_at(contact, float(normal_force(screw, screw.preload)), 0.0)
    waves = scale_spectrum(screw.roughness)
    wanted = 1e-6 * float(row['shortest_um'])
    if wanted < screw.roughness.cutoff_short:
        waves = with_shorter_waves(screw.roughness, 0.99 * wanted)
    lengths = 2 * math.pi / waves.wave_number
    shortest = float(lengths[lengths > 0.97 * wanted].min())
    width = TURN * float(line.semi_axis)
    strip = StripContact(
        radius=line.radius,
        reduced_modulus=contact.reduced_modulus,
        max_pressure=float(row['pressure_share']) * float(line.max_pressure),
        width=width,
        columns=good_length(math.ceil(ACROSS * width / shortest)),
    )
    size = 2 * TURN * strip.semi_axis, strip.width
    shape = tuple(2 * math.ceil(4 * side / shortest) for side in size)
    tile = draw_tile(waves, int(row['draw']), size=size, shape=shape, shortest=shortest)
    if row['cut_GPa']:
        modulus, load = 0.5 * strip.reduced_modulus, float(row['cut_load']) * strip.max_pressure
        tile = cut_alone(tile, modulus, load, 1e9 * float(row['cut_GPa']))
    state = lubricant_state(lubricant, float(row['temperature_degC']) + ZERO_CELSIUS)
    return Strip(
        name=row['march'],
        strip=strip,
        oil=ContactLubricant(
            viscosity=float(state.viscosity), pressure_viscosity=float(state.pressure_viscosity)
        ),
        tile=tile,
        shortest=shortest,
        film_floor=1e-9 * float(row['floor_nm']),
        onset=1e-3 * float(row['onset_mm_s']),
    )


def march(one: Strip) -> None:
    """March a strip again while its speed falls, and print what it found."""
    nx = 2 * math.ceil(0.5 * ALONG * 5.2 * one.strip.semi_axis / one.shortest) + 1
    settings = MarchSettings(nx=nx, places=1, film_floor=one.film_floor)
    speeds = (2.2 * one.onset, 0.2 * one.onset)
    ramp = ramp_strip(
        one.strip, one.oil, speeds, one.tile.height_at, transits=TRANSITS, settings=settings
    )
    onset = ramp.onset(transits=TURN)
    print(f'{one.name}: marched {1e3 * onset:.0f} mm/s, table {1e3 * one.onset:.0f} mm/s')
    print(f'{ramp.status.value} {ramp.steps} steps, {ramp.wall_time:.0f} s')


def benchmark(rows: list[dict[str, str]]) -> None:
    """Write the topography of each row, and a table of its contact with what was marched."""
    (BENCHMARK / 'topographies').mkdir(parents=True, exist_ok=True)
    table = [benchmark_row(row, strip_of(row)) for row in rows]
    with (BENCHMARK / 'strips.csv').open('w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, list(table[0]), lineterminator='\n')
        writer.writeheader()
        writer.writerows(table)


def benchmark_row(row: dict[str, str], one: Strip) -> dict[str, str]:
    """Write one topography; return its contact and its results in SI units."""
    tile, line = one.tile, one.strip
    np.savez_compressed(
        BENCHMARK / 'topographies' / f'{one.name}.npz',
        heights=np.rint(tile.heights / HEIGHT_UNIT).astype(np.int16),
        unit_m=HEIGHT_UNIT,
        length_m=tile.length,
        width_m=tile.width,
    )
    numbers = {
        'radius_m': line.radius,
        'reduced_modulus_Pa': line.reduced_modulus,
        'hertz_pressure_Pa': line.max_pressure,
        'half_length_m': line.semi_axis,
        'viscosity_Pa_s': one.oil.viscosity,
        'pressure_viscosity_1_Pa': one.oil.pressure_viscosity,
        'film_floor_m': one.film_floor,
        'shortest_wave_m': one.shortest,
        'rms_height_m': tile.heights.std(),
        'onset_speed_m_s': one.onset,
        'onset_film_m': 1e-9 * float(row['film_nm']),
    }
    marched = ('rcs_half', 'rcs_quarter', 'loss_onset', 'loss_half')
    given = {'strip': one.name, 'role': row['role'], 'cut_GPa': row['cut_GPa']}
    return (
        given
        | {name: f'{value:.6g}' for name, value in numbers.items()}
        | {name: row[name] for name in marched}
    )


def picture(told: np.ndarray, marched: np.ndarray, other: np.ndarray) -> 'Figure':
    """Return told over marched onsets [m/s]; `other` are those of other draws than the first."""
    figure = new_figure(5.6, 5.0)
    axes, ends = figure.subplots(), np.array([0.08, 4.0])
    axes.fill_between(ends, ends / 1.3, 1.3 * ends, color=GREY, alpha=0.2, label='within 1.3')
    axes.plot(ends, ends, color=GREY, linewidth=0.8)
    axes.plot(marched[~other], told[~other], 'o', color=BLUE, label='first draw')
    axes.plot(marched[other], told[other], 's', color=VERMILION, label='other draws')
    axes.set(
        xscale='log',
        yscale='log',
        xlim=ends,
        ylim=ends,
        xlabel='onset, marched [m/s]',
        ylabel='onset, told by the topography [m/s]',
    )
    axes.legend(loc='upper left')
    return figure


def main() -> None:
    """Compare all rows of the table, or march one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--march', metavar='NAME')
    parser.add_argument('--benchmark', action='store_true')
    args = parser.parse_args()
    with RESULTS.open(encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    if args.march:
        march(strip_of(next(row for row in rows if row['march'] == args.march)))
        return
    if args.benchmark:
        benchmark(rows)
        return
    strips = [strip_of(row) for row in rows]
    told, marched = (np.array([getattr(one, key) for one in strips]) for key in ('told', 'onset'))
    off = np.log(told / marched)
    for row, error in zip(rows, off, strict=True):
        print(f'{row["march"]:18} {row["role"]:9} told/marched {math.exp(error):.2f}')
    other = np.array([int(row['draw']) != 1 for row in rows])
    held = np.array([row['role'] == 'held out' for row in rows])
    for name, part in (('all', ~other | other), ('other draws', other), ('held out', held)):
        inside = int((np.abs(off[part]) < math.log(1.3)).sum())
        print(
            f'{name}: {part.sum()}, mean {math.exp(off[part].mean()):.2f}, '
            f'rms {100 * math.sqrt(np.mean(off[part] ** 2)):.0f} %, {inside} within 1.3'
        )
    for column in ('rcs_half', 'rcs_quarter'):
        logs = [
            math.log(float(row[column]))
            for row in rows
            if row[column] and row['lay'] != 'transverse'
        ]
        print(
            f'{column}, no transverse lay: {len(logs)}, mean {math.exp(np.mean(logs)):.3f}, '
            f'standard deviation a factor of {math.exp(np.std(logs)):.2f}'
        )
    print(draw_picture(PICTURE, lambda: picture(told, marched, other)))


if __name__ == '__main__':
    main()
