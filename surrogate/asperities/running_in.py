# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Raceways as they run: traced, after their first pass, and run in.

No raceway carries more than its hardness, at which the first pass under the largest working load
cuts the summits. Running in goes on with mild wear, for which a lower cutting pressure stands.
Raceway and ball are each cut alone and then added, as the contact adds them.

"""

from dataclasses import dataclass, replace
import math
from typing import Literal

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
from surrogate.raceway.stated import spectrum_of
from surrogate.raceway.tile import draw_tile, Tile
from surrogate.units import GIGA

State = Literal['new', 'run_in']
TILES = 3
"""Tiles of a raceway, each of another draw [-]."""
LENGTH, WIDTH = 4.0, 2.0
"""Length and width of a tile over the half length of the contact under preload [-]."""
MOST_WAVES = 32
"""Most of the shortest waves along a tile [-]."""
NODES = 8
"""Nodes of a tile in the shortest wave [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Cut:
    """
    How summits yield: hardness of the steel [Pa], by default that of 60 HRC, and what runs in.

    `run_in_pressure` [Pa] stands for yield and mild wear together, with its lowest and highest
    likely value. `working_load`, the largest axial load in operation [N], None for that which
    unloads the relieved nut. A profile that was `traced_run_in` is cut at the hardness alone.

    """

    hardness: float = 7e9
    run_in_pressure: float = 3e9
    run_in_range: tuple[float, float] = (2e9, 5e9)
    working_load: float | None = None
    traced_run_in: bool = False

    def __post_init__(self) -> None:
        """Check the order of the pressures and the load."""
        bounds = self.run_in_range
        rising = [bounds[0], self.run_in_pressure, bounds[1], self.hardness]
        if not (rising[0] > 0 and rising == sorted(rising) and self.hardness < math.inf):
            low, middle, high, most = (f'{GIGA * one:g}' for one in rising)
            raise InputError(
                f'run-in pressure is {middle} GPa between {low} and {high} GPa, allowed are '
                f'rising numbers above 0 and up to the hardness ({most} GPa)'
            )
        if self.working_load is not None and not 0 <= self.working_load < math.inf:
            raise InputError(f'working load is {self.working_load:g} N, allowed is 0 or more')

    def load(self, screw: Screw) -> float:
        """Return the largest working load of a screw [N]."""
        if self.working_load is None:
            return UNLOADING_RATIO * working_preload(screw)
        return self.working_load

    def pressure(self, state: State) -> float:
        """Return the pressure at which summits of a state are cut [Pa]."""
        if state == 'new' or self.traced_run_in:
            return self.hardness
        return self.run_in_pressure


USUAL = Cut()
"""Hardness and running-in where nobody says better."""


def running_tiles(screw: Screw, side: Side, state: State, cut: Cut = USUAL) -> list[Tile]:
    """
    Return tiles of a raceway with its ball, `new` or `run_in`; none where both are smooth.

    Raises InputError where the largest working load presses the contact by more than the cutting
    pressure.

    """
    contact = screw_contact(screw, side)
    fields = waves_of(screw)
    if not fields:
        return []
    loaded = float(nut_forces(cut.load(screw), screw.preload)[0])
    pressure = float(hertz(contact, float(normal_force(screw, loaded))).max_pressure)
    bound = cut.pressure(state)
    size, shape = tile_size(screw, side)
    return [
        _added(
            [
                _cut(
                    draw_tile(waves, draw, size=size, shape=shape, field=field),
                    0.5 * contact.reduced_modulus,
                    pressure,
                    bound,
                )
                for field, waves in fields.items()
            ]
        )
        for draw in range(TILES)
    ]


def waves_of(screw: Screw) -> dict[int, ScaledSpectrum]:
    """Return the waves of raceway and ball by their field, 0 and 1; a smooth one has none."""
    raceway = scale_spectrum(spectrum_of(screw.roughness))
    ball = ball_of(screw.roughness, screw.ball_roughness)
    fields = {0: raceway if screw.roughness.rms else None, 1: ball}
    return {field: waves for field, waves in fields.items() if waves is not None}


def shortest_wave(screw: Screw) -> float:
    """Return the shortest wave of raceway and ball [m]."""
    return min(2 * math.pi / float(waves.wave_number[-1]) for waves in waves_of(screw).values())


def tile_size(screw: Screw, side: Side) -> tuple[tuple[float, float], tuple[int, int]]:
    """Return length and width of the tiles of a raceway [m] and their nodes [-]."""
    force = float(normal_force(screw, working_preload(screw)))
    semi_axis = float(hertz(screw_contact(screw, side), force).semi_axis_x)
    shortest = shortest_wave(screw)
    length = min(LENGTH * semi_axis, MOST_WAVES * shortest)
    # An even number of nodes, so that every other one repeats too.
    rows = 2 * next_fast_len(math.ceil(0.5 * NODES * length / shortest), real=True)
    columns = 2 * next_fast_len(math.ceil(0.25 * NODES * length / shortest), real=True)
    return (length, WIDTH / LENGTH * length), (rows, columns)


def _cut(tile: Tile, modulus: float, pressure: float, bound: float) -> Tile:
    if not tile.heights.any():
        raise InputError(
            'roughness: all its waves are longer than half of the contact, allowed are shorter '
            'ones: a smaller cutoff_short_um'
        )
    lower, found = run_in(tile, modulus, pressure, bound)
    if not found.converged:
        raise InputError(
            f'raceway: pressed by {GIGA * pressure:.3g} GPa its summits yield at '
            f'{GIGA * bound:.3g} GPa nearly everywhere, allowed is a cutting pressure well above'
        )
    return lower


def _added(tiles: list[Tile]) -> Tile:
    return replace(tiles[0], heights=np.sum([tile.heights for tile in tiles], axis=0))
