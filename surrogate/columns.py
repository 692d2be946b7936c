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
from surrogate.chain_task import chain_inputs
from surrogate.parameters import Lubricant, Screw
from surrogate.surface import FIELDS

Array = NDArray[np.float64]
Chains = dict[str, dict[str, Any]]
Results = Mapping[str, Mapping[str, Any] | None]
SPREAD = ('friction_torque', 'rcs', 'asperity_share', 'friction_coefficient')
"""Fields whose scatter over draws is kept."""
ROUNDING = 1e-9
"""Error of a mapped speed [-]."""
CERTAIN = 2.0
"""Least rough film over the floor at which no asperity is near [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nodes:
    """
    Fields on the nodes [speed, load, temperature] in SI.

    Means over draws, standard deviations of the draws and standard errors of the means; worst
    contact; mask of nodes without a number; number of draws that did not converge; the least speed
    coordinate from which on no draw of any column comes near contact, None if there is none.

    """

    means: dict[str, Array]
    deviations: dict[str, Array]
    standard_errors: dict[str, Array]
    worst_contact: NDArray[np.uint8]
    mask: NDArray[np.bool_]
    failed: int
    certified: float | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Columns:
    """
    Load [N] and temperature [K] nodes of one screw and oil, speeds [rad/s], onset over both.

    Mapped speeds of hot and cold oil differ by far, so that no column needs all speed nodes.

    """

    screw: Screw
    lubricant: Lubricant
    load: Array
    temperature: Array
    speed_range: tuple[float, float]
    log_onset: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def magnitudes(self) -> Array:
        """Return the loads without their sign [N], rising."""
        return np.unique(np.abs(self.load))

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

    def chains(self, s: Array, draws: int) -> Chains:
        """Return the chains of all columns, by the name of `chain_name`."""
        needed = self.needed(s)
        return {
            chain_name(load, k, draw): self.chain(
                load, heat, draw, self.speeds(s[needed[:, j, k]], j, k)
            )
            for load in self.magnitudes.tolist()
            for k, heat in enumerate(self.temperature)
            for draw in range(draws)
            for j in [self.place_of(load)]
        }

    def place_of(self, magnitude: float) -> int:
        """Return the first load node of a magnitude; onsets do not depend on the sign."""
        return int(np.flatnonzero(np.abs(self.load) == magnitude)[0])

    def gather(self, s: Array, draws: int, results: Results) -> Nodes:
        """Return the fields from the results of `chains`."""
        shape = (len(s), len(self.load), len(self.temperature))
        means = {name: np.full(shape, np.nan) for name in FIELDS}
        spreads = [{name: np.full(shape, np.nan) for name in SPREAD} for _ in range(2)]
        worst = np.zeros(shape, dtype=np.uint8)
        far, failed, needed = np.full(shape, np.inf), 0, self.needed(s)
        for j, k in np.ndindex(shape[1:]):
            chains = [
                results[chain_name(float(abs(self.load[j])), k, draw)] for draw in range(draws)
            ]
            sense = 'opposing' if self.load[j] >= 0 else 'assisting'
            places = np.flatnonzero(needed[:, j, k])
            for i, records in zip(places, records_by_speed(chains, sense, len(places))):
                far[i, j, k] = -np.inf
                solved = [record for record in records if record['converged']]
                failed += draws - len(solved)
                if 2 * len(solved) < draws or not solved:
                    continue
                for name in FIELDS:
                    means[name][i, j, k] = mean_over_draws(solved, name)
                for name in SPREAD:
                    deviation = deviation_over_draws(solved, name)
                    spreads[0][name][i, j, k] = deviation
                    spreads[1][name][i, j, k] = deviation / math.sqrt(len(solved))
                worst[i, j, k] = commonest([record['worst_contact'] for record in solved])
                far[i, j, k] = min(record['film_over_floor'] for record in solved)
        mask = ~np.all([np.isfinite(means[name]) for name in FIELDS], axis=0)
        return Nodes(
            means={name: continued(s, values) for name, values in means.items()},
            deviations=spreads[0],
            standard_errors=spreads[1],
            worst_contact=worst,
            mask=mask,
            failed=failed,
            certified=_certified(s, far),
        )


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


def deviation_over_draws(records: Sequence[Mapping[str, Any]], name: str) -> float:
    """Return the standard deviation of a field over draws, NaN for fewer than two."""
    if len(records) < 2:
        return math.nan
    return float(np.std([record[name] for record in records], ddof=1))


def commonest(places: Sequence[int]) -> int:
    """Return the value that stands most often, the least of equals."""
    return max(sorted(set(places)), key=places.count)


def continued(s: Array, values: Array) -> Array:
    """
    Return `values` [speed, load, temperature] with columns continued beyond their ends.

    As powers of speed, or as constants where a value is zero or falls; no lookup reads them, but
    slopes of the columns beside them do.

    """
    filled = values.copy()
    for j, k in np.ndindex(values.shape[1:]):
        column = values[:, j, k]
        known = np.flatnonzero(np.isfinite(column))
        if known.size < 2:
            continue
        for end, inner in ((known[0], known[1]), (known[-1], known[-2])):
            beyond = np.arange(len(s)) < end if end < inner else np.arange(len(s)) > end
            power = 0.0
            if column[end] > 0 and column[inner] > 0 and end > inner:
                power = math.log(column[end] / column[inner]) / (s[end] - s[inner])
            filled[beyond, j, k] = column[end] * np.exp(power * (s[beyond] - s[end]))
    return filled


def _certified(s: Array, far: Array) -> float | None:
    """Return the least coordinate from which on all nodes lie far from contact."""
    near = np.flatnonzero((far < CERTAIN).any(axis=(1, 2)))
    first = int(near[-1]) + 1 if near.size else 0
    return float(s[first]) if first < len(s) else None
