# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Raceways as they run: traced, after their first pass, and run in.

The first pass under the largest working load cuts the summits at the hardness. Running in goes on
with mild wear, for which a lower cutting pressure stands. Raceway and ball are each cut alone and
then added, as the contact adds them.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

import numpy as np
from scipy.fft import next_fast_len
from surrogate.files import InputError
from surrogate.formulas.geometry import hertz, screw_contact, Side
from surrogate.formulas.load_sharing import (
    normal_force,
    nut_forces,
    UNLOADING_RATIO,
    working_preload,
)
from surrogate.parameters import Screw
from surrogate.raceway.ball import ball_of
from surrogate.raceway.dry_contact import run_in
from surrogate.raceway.scaling import scale_spectrum, ScaledSpectrum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stated import BallRoughness
from surrogate.raceway.tile import draw_tile, Tile
from surrogate.units import GIGA

TILES, LONG_TILES = 3, 1
"""Tiles of a raceway, each of another draw, and of one whose tiles are long [-]."""
LONG = 48
"""Shortest waves along a tile from which on it is long [-]."""
LENGTH, WIDTH = 4.0, 2.0
"""Length and width of a tile over the half length of the contact under preload [-]."""
MOST_WAVES = 128
"""Most of the shortest waves along a tile [-]; shorter ones are left out."""
NODES = 8
"""Nodes of a tile in the shortest wave [-]."""


def working_load(screw: Screw) -> float:
    """Return the largest working load of a screw [N], that which unloads a nut if not stated."""
    if screw.working_load is None:
        return UNLOADING_RATIO * working_preload(screw)
    return screw.working_load


def working_pressure(screw: Screw, side: Side) -> float:
    """Return the Hertz pressure of the loaded nut under the largest working load [Pa]."""
    loaded = float(nut_forces(working_load(screw), screw.preload)[0])
    force = float(normal_force(screw, loaded))
    return float(hertz(screw_contact(screw, side), force).max_pressure)


@dataclass(frozen=True, kw_only=True, slots=True)
class RunningContact:
    """
    Raceway and ball of a contact as they run: all that the topography depends on.

    Profile of the raceway as it was traced; roughness of the ball, None where it is smooth;
    pressure at which summits are cut [Pa]; reduced modulus of the contact [Pa], its half length
    under preload [m], largest working load [N] and Hertz pressure under it [Pa].

    """

    raceway: RoughnessSpectrum
    ball: BallRoughness | None
    cutting_pressure: float
    reduced_modulus: float
    half_length: float
    working_load: float
    working_pressure: float

    @classmethod
    def of(cls, screw: Screw, side: Side) -> 'RunningContact':
        """Return a side of a screw, its raceway in the state of the sheet."""
        contact = screw_contact(screw, side)
        preload = float(normal_force(screw, working_preload(screw)))
        return cls(
            raceway=screw.roughness.spectrum,
            ball=screw.ball_roughness,
            cutting_pressure=screw.roughness.cutting_pressure,
            reduced_modulus=contact.reduced_modulus,
            half_length=float(hertz(contact, preload).semi_axis_x),
            working_load=working_load(screw),
            working_pressure=working_pressure(screw, side),
        )

    @property
    def waves(self) -> dict[int, ScaledSpectrum]:
        """Waves of raceway and ball by their field, 0 and 1; a smooth one has none."""
        raceway = scale_spectrum(self.raceway) if self.raceway.rms else None
        fields = {0: raceway, 1: ball_of(self.raceway, self.ball)}
        return {field: waves for field, waves in fields.items() if waves is not None}

    @property
    def resolved_wave(self) -> float:
        """Shortest wave that a tile holds [m]."""
        return self.wave_above(LENGTH * self.half_length / MOST_WAVES)

    def wave_above(self, least: float) -> float:
        """Return the shortest wave of raceway and ball that is not below `least` [m]."""
        lengths = [2 * math.pi / waves.wave_number for waves in self.waves.values()]
        every = np.concatenate(lengths)
        return float(every[every >= least].min(initial=float(every.max())))


def running_tiles(
    contact: RunningContact, *, shortest: float = 0.0, draws: Sequence[int] = ()
) -> list[Tile]:
    """
    Return tiles of a raceway with its ball in their state; none where both are smooth.

    One a draw, by default `TILES` or `LONG_TILES`, with waves not shorter than `shortest` [m].
    Raises InputError where all waves are longer than half of the contact, or `run_in` does not
    converge.

    """
    fields = contact.waves
    if not fields:
        return []
    pressure, hardness = contact.working_pressure, contact.cutting_pressure
    shortest = max(contact.resolved_wave, shortest)
    size, shape = tile_size(contact, shortest=shortest)
    modulus, tiles = 0.5 * contact.reduced_modulus, []
    for draw in draws or range(TILES if shape[0] < LONG * NODES else LONG_TILES):
        drawn = (
            draw_tile(waves, draw, size=size, shape=shape, shortest=shortest, field=field)
            for field, waves in fields.items()
        )
        cut = [_cut(tile, modulus, pressure, hardness) for tile in drawn]
        heights = np.sum([tile.heights for tile in cut], axis=0)
        tiles.append(replace(cut[0], heights=heights))
    return tiles


def tile_size(
    contact: RunningContact, *, shortest: float = 0.0
) -> tuple[tuple[float, float], tuple[int, int]]:
    """Return length and width of the tiles of a raceway [m] and their nodes [-]."""
    shortest = max(contact.resolved_wave, shortest)
    length = LENGTH * contact.half_length
    # An even number of nodes, so that every other one repeats too.
    rows = 2 * next_fast_len(math.ceil(0.5 * NODES * length / shortest), real=True)
    columns = 2 * next_fast_len(math.ceil(0.25 * NODES * length / shortest), real=True)
    return (length, WIDTH / LENGTH * length), (rows, columns)


def _cut(tile: Tile, modulus: float, pressure: float, hardness: float) -> Tile:
    if not tile.heights.any():
        raise InputError(
            'roughness: all its waves are longer than half of the contact, allowed are shorter '
            'ones: a smaller cutoff_short_um'
        )
    lower, contact = run_in(tile, modulus, pressure, hardness)
    if not contact.converged:
        raise InputError(
            f'raceway: pressed by {GIGA * pressure:.3g} GPa, where its summits yield at '
            f'{GIGA * hardness:.3g} GPa was not found in {contact.iterations} iterations, allowed '
            'is a smaller working_load_N'
        )
    return lower
