# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns of a full-tier surface: chains over speed for every load, temperature and draw.

Loads of either sign share their chains: the contacts are the same, only the balls differ.

"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter
from surrogate.full.chain import chain_inputs
from surrogate.full.idle import BESIDE, idle_load
from surrogate.parameters import Lubricant, Screw
from surrogate.screw_contacts import GRID_WAVELENGTH

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Chains = dict[str, dict[str, Any]]
Results = Mapping[str, Mapping[str, Any] | None]
Place = tuple[int, int, int]
"""Numbers of a load, a temperature and a draw."""
NEAR_ONSET = (-1.25, 0.75)
"""Speed coordinates between which contact sets in, and draws differ most [-]."""
ANCHORED, ANCHOR_STEP = (-1.25, 0.5), 0.35
"""Speed coordinates between which anchors lie, and their least distance [-]."""
ROUNDING = 1e-9
"""Error of a mapped speed [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Columns:
    """
    Load [N] and solved temperature [K] nodes of one screw and oil, speeds [rad/s], onset of both.

    Mapped speeds of hot and cold oil differ by far, so that no column needs all speed nodes. All
    `draws` of the roughness are solved at the middle temperature around the onset on the half
    grid, `shared_draws` of them at all nodes and temperatures, and on the fine grid all of them at
    a few speeds. Waves shorter than `grid_wavelength` [m] raise the film floor.

    """

    screw: Screw
    lubricant: Lubricant
    load: Array
    temperature: Array
    speed_range: tuple[float, float]
    draws: int
    shared_draws: int
    log_onset: Array
    grid_wavelength: float | None = GRID_WAVELENGTH

    @property
    def magnitudes(self) -> Array:
        """Return the loads without their sign [N], rising."""
        return np.unique(np.abs(self.load))

    @property
    def reference(self) -> int:
        """Return the number of the middle temperature."""
        return len(self.temperature) // 2

    @property
    def few(self) -> int:
        """Return how many draws are solved everywhere."""
        return min(self.shared_draws, self.draws)

    def speeds(self, s: Array, j: int, k: int) -> Array:
        """Return the speeds [rad/s] of the coordinates `s` at load j and temperature k."""
        return np.asarray(np.exp(s + self.log_onset[j, k]))

    def needed(self, s: Array) -> Flags:
        """Return the nodes [speed, load, temperature] that cover the speed range."""
        magnitudes = self.magnitudes
        onset = self.log_onset[[self.place_of(load) for load in magnitudes.tolist()]]
        # Either sign reads the chains of a magnitude: beside it lie those of both.
        both = covering(s, onset, self.speed_range, (3, 1))
        return np.asarray(both[:, np.searchsorted(magnitudes, np.abs(self.load))])

    def full(self, s: Array) -> Flags:
        """
        Return the speed nodes at which all draws are solved on the half grid.

        Where draws differ most, and one node beyond, where contact has ended; then two far nodes,
        between which what they differ in changes little.

        """
        beyond = int(np.searchsorted(s, NEAR_ONSET[1], side='right'))
        near = (s >= NEAR_ONSET[0]) & (np.arange(len(s)) <= beyond)
        near[self._far(s)] = True
        return near

    def anchors(self, s: Array) -> Flags:
        """
        Return the speed nodes at which all draws are solved on the fine grid.

        Around the onset, not too near to each other, and a far one, where contact is certified to
        have ended.

        """
        found = np.zeros(len(s), dtype=bool)
        last = -math.inf
        for i in np.flatnonzero((s >= ANCHORED[0]) & (s <= ANCHORED[1])):
            if s[i] - last >= ANCHOR_STEP:
                found[i], last = True, s[i]
        found[self._far(s)[:1]] = True
        return found

    def ends(self, s: Array, dry: Flags) -> Flags:
        """
        Return the speed nodes at which few draws are solved on the fine grid.

        Those slower than the anchors that are not `dry`, the first beyond the onset and the last.

        """
        place = np.arange(len(s))
        beyond = np.searchsorted(s, NEAR_ONSET[1], side='right')
        found = ((s < ANCHORED[0]) & ~dry) | (place == beyond)
        found[self._far(s)] = True
        return np.asarray(found & ~self.anchors(s))

    def _far(self, s: Array) -> list[int]:
        """Return two speed nodes beyond the onset that all loads have: between, and the last."""
        beyond = int(np.searchsorted(s, NEAR_ONSET[1], side='right'))
        common = np.flatnonzero(self.needed(s)[:, :, self.reference].all(axis=1))
        last = int(common[-1]) if common.size else 0
        return [(beyond + last) // 2, last] if last > beyond else []

    def asked_half(self, s: Array) -> Flags:
        """Return what is solved on the half grid, over [speed, load, temperature, draw]."""
        draw = np.arange(self.draws)
        more = self._at_middle & self.full(s)[:, None, None, None]
        return np.asarray(self.needed(s)[..., None] & ((draw < self.few) | more))

    def asked_fine(self, s: Array, dry: Flags) -> Flags:
        """
        Return what is solved on the fine grid, over [speed, load, temperature, draw].

        At the middle temperature, and not where the surfaces are all but `dry` [speed].

        """
        draw = np.arange(self.draws)
        anchors, ends = (
            flags[:, None, None, None] for flags in (self.anchors(s), self.ends(s, dry))
        )
        wanted = self._at_middle & (anchors | (ends & (draw < self.few)))
        return np.asarray(self.needed(s)[..., None] & wanted)

    @property
    def _at_middle(self) -> Flags:
        """Return which temperature is the middle one, for [speed, load, temperature, draw]."""
        return np.asarray((np.arange(len(self.temperature)) == self.reference)[:, None])

    def chain(
        self, load: float, temperature: float, draw: int, speeds: Array, grid: str
    ) -> dict[str, Any]:
        """Return a chain at a load [N] and temperature [K] with falling `speeds` [rad/s]."""
        falling = sorted((float(speed) for speed in speeds), reverse=True)
        return chain_inputs(
            self.screw,
            self.lubricant,
            float(load),
            float(temperature),
            draw,
            falling,
            grid=grid,
            grid_wavelength=self.grid_wavelength,
        )

    def chains(self, s: Array, asked: Flags, grid: str) -> Chains:
        """Return the chains of what is `asked` for on a grid, by the name of `chain_name`."""
        return {
            name: self.chain(
                abs(self.load[j]), self.temperature[k], draw, self.speeds(s[places], j, k), grid
            )
            for name, (j, k, draw), places in self.chain_nodes(asked)
        }

    def chain_nodes(self, asked: Flags) -> Iterator[tuple[str, Place, NDArray[np.intp]]]:
        """Yield, for every load that presses a ball, the chains' names, places, speed nodes."""
        for j, k, draw in np.ndindex(asked.shape[1:]):
            load, places = float(abs(self.load[j])), np.flatnonzero(asked[:, j, k, draw])
            if presses(self.screw, load) and places.size:
                yield chain_name(load, k, draw), (j, k, draw), places

    def verges(self) -> list[tuple[int, int]]:
        """Return the loads beside and below the idle one, each with its neighbour towards zero."""
        below = (1 - BESIDE) * idle_load(self.screw)
        return [
            (int(j), int(j) - side)
            for j in np.flatnonzero(np.isclose(np.abs(self.load), below, rtol=1e-9, atol=0.0))
            for side in [1 if self.load[j] > 0 else -1]
            if 0 <= j - side < len(self.load)
        ]

    def place_of(self, magnitude: float) -> int:
        """Return the first load node of a magnitude; onsets do not depend on the sign."""
        return int(np.flatnonzero(np.abs(self.load) == magnitude)[0])


def covering(
    s: Array, log_onset: Array, speed_range: tuple[float, float], reach: tuple[int, int]
) -> Flags:
    """
    Return the nodes [speed, load, temperature] that lookups in the speed range [rad/s] read.

    A lookup reads the columns around it at its own coordinate, so a column covers what its
    neighbours within the window `reach` of loads and temperatures cover.

    """
    low, high = (math.log(speed) - log_onset for speed in speed_range)
    slowest, fastest = minimum_filter(low, reach), maximum_filter(high, reach)
    first = np.searchsorted(s, slowest + ROUNDING, side='right') - 1
    last = np.searchsorted(s, fastest - ROUNDING)
    place = np.arange(len(s))[:, None, None]
    return np.asarray((place >= first) & (place <= last))


def presses(screw: Screw, load: float) -> bool:
    """Tell whether balls are pressed at a load [N]."""
    return load > 0 or screw.preload > 0


def chain_name(load: float, heat: int, draw: int) -> str:
    """Return the name of a chain: load [N], number of the temperature node, draw."""
    return f'{load!r} N, temperature {heat}, draw {draw}'


def records_by_speed(
    chains: Sequence[Mapping[str, Any] | None], sense: str, count: int
) -> Iterator[list[dict[str, Any]]]:
    """Yield, from the slowest speed on, the records of all chains that were solved."""
    solved = [chain for chain in chains if chain is not None]
    for place in range(count):
        yield [chain[sense][count - 1 - place] for chain in solved]


def mean_over_draws(records: Sequence[Mapping[str, Any]], name: str) -> float:
    """Return the mean of a field over solved records, NaN without any."""
    return float(np.mean([record[name] for record in records])) if records else math.nan
