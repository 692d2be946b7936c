# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns of a full-tier surface: chains over speed for every load, temperature and draw.

Loads of either sign share their chains: the contacts are the same, only the balls differ.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter
from surrogate.builder.full.chain import chain_inputs, SolvedChain
from surrogate.builder.full.draws import draws_of, WeightedDraws
from surrogate.formulas.load_sharing import idle_load
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.contacts import GRID_WAVELENGTH
from surrogate.surface import SolvedPoint

Array = NDArray[np.float64]
Chains = dict[str, dict[str, Any]]
Results = Mapping[str, SolvedChain | None]
"""By name what a chain yields, None where it failed."""
ColumnPlace = tuple[int, int, int]
"""Numbers of a load, a temperature and a draw."""
Node = tuple[int, int, int, int]
"""Numbers of a speed, a load, a temperature and a draw."""
Records = Mapping[Node, SolvedPoint | None]
"""By node what was solved there, None where the chain failed."""
NEAR_ONSET = (-1.25, 0.75)
"""Speed coordinates between which contact sets in, and draws differ most [-]."""
ROUNDING = 1e-9
"""Error of a mapped speed [-]."""
BESIDE = 1e-4
"""Distance of the nodes beside the idle load, over that load [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Columns:
    """
    Load [N] and solved temperature [K] nodes of one screw and oil, speeds [rad/s], onset of both.

    Mapped speeds of hot and cold oil differ by far, so that no column needs all speed nodes. All
    `draws` of the roughness are solved at the middle temperature around the onset, more on the
    verge of the idle load, and `shared_draws` of them elsewhere. Waves shorter than
    `grid_wavelength` [m] raise the floor. `first` are the speed coordinates [-] before more were
    added, None for those asked about.

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
    first: Array | None = None

    @property
    def magnitudes(self) -> Array:
        """Return the loads without their sign [N], rising."""
        return np.unique(np.abs(self.load))

    @property
    def reference(self) -> int:
        """Return the number of the middle temperature."""
        return len(self.temperature) // 2

    @property
    def ensemble(self) -> WeightedDraws:
        """Return the draws, with their weights."""
        return draws_of(self.screw, self.draws)

    @property
    def few(self) -> int:
        """Return how many draws are solved everywhere."""
        return min(self.shared_draws, self.draws)

    def speeds(self, s: Array, j: int, k: int) -> Array:
        """Return the speeds [rad/s] of the coordinates `s` at load j and temperature k."""
        return np.asarray(np.exp(s + self.log_onset[j, k]))

    def needed(self, s: Array) -> NDArray[np.bool_]:
        """Return the nodes [speed, load, temperature] that cover the speed range."""
        magnitudes = self.magnitudes
        onset = self.log_onset[[self.place_of(load) for load in magnitudes.tolist()]]
        # Either sign reads the chains of a magnitude: beside it lie those of both.
        both = covering(s, onset, self.speed_range, (3, 1))
        return np.asarray(both[:, np.searchsorted(magnitudes, np.abs(self.load))])

    def sought(self, s: Array) -> NDArray[np.bool_]:
        """
        Return the nodes [speed, load, temperature] that are solved with some draws.

        Away from the middle temperature, every second speed that all loads need there, too, is
        left out: at one mapped speed temperatures differ by a factor that changes slowly.

        """
        first = s if self.first is None else self.first
        common, sought = self._common(first), self.needed(s)
        skipped = np.flatnonzero(np.isin(s, np.setdiff1d(common[1:-1:2], self._far(s))))
        others = np.arange(len(self.temperature)) != self.reference
        sought[np.ix_(skipped, np.arange(len(self.load)), np.flatnonzero(others))] = False
        return sought

    def full(self, s: Array) -> NDArray[np.bool_]:
        """
        Return the speed nodes at which all draws are solved.

        Where draws differ most, and a far one, where contact has ended and from which on what they
        differ in changes little. Both are solved from cold, and what they differ in is much the
        same just beyond the onset, so the first node there is one of these only if it is the last.

        """
        near = (s >= NEAR_ONSET[0]) & (s <= NEAR_ONSET[1])
        return np.asarray(near | np.isin(s, self._far(s)))

    def _common(self, s: Array) -> Array:
        """Return those of speed nodes that all loads need at the middle temperature."""
        return np.asarray(s[self.needed(s)[:, :, self.reference].all(axis=1)])

    def _far(self, s: Array) -> Array:
        """Return the first node halfway from the end of contact to the fastest common one."""
        first = s if self.first is None else self.first
        common = self._common(first)
        beyond = first[first > NEAR_ONSET[1]]
        ahead = beyond[beyond <= common[-1]] if common.size else beyond[:0]
        return np.asarray(ahead[[(len(ahead) - 1) // 2]] if len(ahead) > 1 else beyond[:1])

    def asked(self, s: Array) -> NDArray[np.bool_]:
        """
        Return what is solved, over [speed, load, temperature, draw].

        Draws that are solved on the verge of the idle load alone are so around the onset alone.

        """
        draw = np.arange(self.ensemble.most)
        loads = np.array([self.ensemble.at(load) for load in self.load.tolist()])
        far = np.isin(s, self._far(s))[:, None]
        counts = np.where(far, np.minimum(loads, self.draws), loads)
        at_middle = np.arange(len(self.temperature)) == self.reference
        more = at_middle[:, None] & self.full(s)[:, None, None, None]
        more = more & (draw < counts[..., None, None])
        return np.asarray(self.sought(s)[..., None] & ((draw < self.few) | more))

    def chain(self, load: float, temperature: float, draw: int, speeds: Array) -> dict[str, Any]:
        """Return a chain at a load [N] and temperature [K] with falling `speeds` [rad/s]."""
        falling = sorted((float(speed) for speed in speeds), reverse=True)
        return chain_inputs(
            self.screw,
            self.lubricant,
            float(load),
            float(temperature),
            draw,
            falling,
            self.grid_wavelength,
        )

    def chains(self, s: Array, known: Collection[Node] = ()) -> Chains:
        """Return the chains of what is asked for and not `known`, by the name of `chain_name`."""
        return {
            name: self.chain(
                abs(self.load[j]), self.temperature[k], draw, self.speeds(s[places], j, k)
            )
            for name, (j, k, draw), places in self.chain_nodes(s, known)
        }

    def chain_nodes(
        self, s: Array, known: Collection[Node] = ()
    ) -> Iterator[tuple[str, ColumnPlace, NDArray[np.intp]]]:
        """Yield, for every load that presses a ball, the chains' names, places, speed nodes."""
        asked = self.asked(s)
        for j, k, draw in np.ndindex(asked.shape[1:]):
            load = float(abs(self.load[j]))
            wanted = np.flatnonzero(asked[:, j, k, draw])
            places = wanted[[(int(i), j, k, draw) not in known for i in wanted]]
            if presses(self.screw, load) and places.size:
                yield chain_name(load, k, draw), (j, k, draw), places

    def records(
        self, s: Array, results: Results, known: Collection[Node] = ()
    ) -> dict[Node, SolvedPoint | None]:
        """Return the records of the nodes in the results of `chains` of the same arguments."""
        found: dict[Node, SolvedPoint | None] = {}
        for name, (j, k, draw), places in self.chain_nodes(s, known):
            chain = results.get(name)
            points = chain.under(self.load[j]) if chain else (None,) * len(places)
            for i, point in zip(places[::-1].tolist(), points, strict=True):
                found[i, j, k, draw] = point
        return found

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
) -> NDArray[np.bool_]:
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


def moved_records(
    records: Records, before: tuple[Array, Array], after: tuple[Array, Array]
) -> dict[Node, SolvedPoint | None]:
    """Return records on the speeds and loads `after`, which hold all of those `before`."""
    speeds, loads = (np.searchsorted(new, old).tolist() for new, old in zip(after, before))
    return {(speeds[i], loads[j], k, draw): point for (i, j, k, draw), point in records.items()}


def points_by_speed(
    chains: Sequence[SolvedChain | None], count: int
) -> Iterator[list[SolvedPoint]]:
    """Yield, from the slowest speed on, the points of all chains, the load against the motion."""
    solved = [chain for chain in chains if chain is not None]
    for place in range(count):
        yield [chain.opposing[count - 1 - place] for chain in solved]


def mean_over_draws(points: Sequence[SolvedPoint], name: str) -> float:
    """Return the mean of a field over points that converged, NaN without any."""
    values = [getattr(point, name) for point in points if point.converged]
    return float(np.mean(values)) if values else math.nan
