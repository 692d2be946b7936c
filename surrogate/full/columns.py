# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns of a full-tier surface: chains over speed for every load, temperature and draw.

Loads of either sign share their chains: the contacts are the same, only the balls differ.

"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter
from surrogate.full.chain import chain_inputs
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]
Chains = dict[str, dict[str, Any]]
Results = Mapping[str, Mapping[str, Any] | None]
ROUNDING = 1e-9
"""Error of a mapped speed [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Columns:
    """
    Load [N] and temperature [K] nodes of one screw and oil, speeds [rad/s], onset over both.

    Mapped speeds of hot and cold oil differ by far, so that no column needs all speed nodes. All
    `draws` of the roughness are solved at the reference temperature, `shared_draws` of them at
    others.

    """

    screw: Screw
    lubricant: Lubricant
    load: Array
    temperature: Array
    speed_range: tuple[float, float]
    draws: int
    shared_draws: int
    log_onset: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def magnitudes(self) -> Array:
        """Return the loads without their sign [N], rising."""
        return np.unique(np.abs(self.load))

    @property
    def reference(self) -> int:
        """Return the number of the temperature node nearest to the oil's reference."""
        return int(np.argmin(np.abs(self.temperature - self.lubricant.reference_temperature)))

    def draws_at(self, k: int) -> range:
        """Return the draws that are solved at temperature k."""
        few = min(self.shared_draws, self.draws)
        return range(self.draws if k == self.reference else few)

    def speeds(self, s: Array, j: int, k: int) -> Array:
        """Return the speeds [rad/s] of the coordinates `s` at load j and temperature k."""
        return np.asarray(np.exp(s + self.log_onset[j, k]))

    def needed(self, s: Array) -> NDArray[np.bool_]:
        """
        Return the nodes [speed, load, temperature] that some lookup in the speed range reads.

        A lookup reads the columns around it at its own coordinate, so a column reaches as far as
        its neighbours.

        """
        low, high = (math.log(speed) - self.log_onset for speed in self.speed_range)
        slowest, fastest = minimum_filter(low, 3), maximum_filter(high, 3)
        first = np.searchsorted(s, slowest + ROUNDING, side='right') - 1
        last = np.searchsorted(s, fastest - ROUNDING)
        place = np.arange(len(s))[:, None, None]
        return np.asarray((place >= first) & (place <= last))

    def chain(self, load: float, temperature: float, draw: int, speeds: Array) -> dict[str, Any]:
        """Return a chain at a load [N] and temperature [K] with falling `speeds` [rad/s]."""
        falling = sorted((float(speed) for speed in speeds), reverse=True)
        return chain_inputs(
            self.screw, self.lubricant, float(load), float(temperature), draw, falling
        )

    def chains(self, s: Array) -> Chains:
        """Return the chains of all columns, by the name of `chain_name`."""
        needed = self.needed(s)
        return {
            chain_name(load, k, draw): self.chain(
                load, heat, draw, self.speeds(s[needed[:, j, k]], j, k)
            )
            for load in self.magnitudes.tolist()
            for k, heat in enumerate(self.temperature)
            for draw in self.draws_at(k)
            for j in [self.place_of(load)]
        }

    def place_of(self, magnitude: float) -> int:
        """Return the first load node of a magnitude; onsets do not depend on the sign."""
        return int(np.flatnonzero(np.abs(self.load) == magnitude)[0])


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
