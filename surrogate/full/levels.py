# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What is solved on the half and on the fine grid at the nodes of a full-tier surface.

Two levels of one estimate: many draws where they are cheap, few solves that say what the fine grid
changes. As in multilevel Monte Carlo, but that the change is carried over the speed.

"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from surrogate.full.chain import FINE, HALF
from surrogate.full.columns import Columns, records_by_speed, Results
from surrogate.full.means import quiet
from surrogate.full.settings import Run
from surrogate.surface import FIELDS

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
FILM = 'film_over_floor'
SENSES = ('assisting', 'opposing')
DRY = 0.98
"""RCS of few draws at every load from which on the half grid is enough [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Level:
    """
    Solves on one grid: what was asked for, and what is known of it, NaN elsewhere.

    Both over [speed, load, temperature, draw]; `contacts` holds the worst contacts of a node's
    draws by the numbers of its speed, load and temperature.

    """

    asked: Flags
    values: dict[str, Array]
    contacts: dict[tuple[int, int, int], list[int]]

    @property
    def weak(self) -> Flags:
        """Return the nodes [speed, load, temperature] with less than half of the draws asked."""
        known = np.isfinite(self.values['rcs']).sum(axis=-1)
        return np.asarray(self.asked.any(axis=-1) & (2 * known < self.asked.sum(axis=-1)))


def solve_levels(columns: Columns, s: Array, run: Run) -> tuple[Level, Level]:
    """Return what the half grid, then what the fine grid gives at speed nodes `s`."""
    asked = columns.asked_half(s)
    half = gather(columns, asked, run('nodes, half grid', columns.chains(s, asked, HALF)))
    asked = columns.asked_fine(s, dry(columns, half))
    fine = gather(columns, asked, run('nodes, fine grid', columns.chains(s, asked, FINE)))
    return half, fine


def dry(columns: Columns, half: Level) -> Flags:
    """
    Return the speed nodes at which asperities carry all but everything at every load.

    What the films in between do is of no account there, and the grid changes next to nothing. If
    it is so at all nodes, the fastest is solved on the fine grid all the same.

    """
    rcs = quiet(np.nanmean, half.values['rcs'][:, :, columns.reference, : columns.few])
    least = np.fmin.reduce(rcs, axis=1)
    found = np.nan_to_num(np.fmin.accumulate(least)) >= DRY
    found[-1] = False
    return np.asarray(found)


def gather(columns: Columns, asked: Flags, results: Results) -> Level:
    """Return the level of what was `asked` for from the results of its chains."""
    level = Level(
        asked=asked,
        values={name: np.full(asked.shape, np.nan) for name in (*FIELDS, FILM)},
        contacts={},
    )
    for name, (j, k, draw), solved in columns.chain_nodes(asked):
        sense, chain = SENSES[int(columns.load[j] >= 0)], results.get(name)
        if chain is None:
            continue
        for i, (record,) in zip(solved.tolist(), records_by_speed([chain], sense, len(solved))):
            if record['converged']:
                level.contacts.setdefault((i, j, k), []).append(record['worst_contact'])
                for field, values in level.values.items():
                    values[i, j, k, draw] = record[field]
    return level


def worst_contacts(levels: Sequence[Level]) -> NDArray[np.uint8]:
    """Return the worst contact of nodes [speed, load, temperature], of the finest that has one."""
    worst = np.zeros(levels[0].asked.shape[:-1], dtype=np.uint8)
    for level in levels:
        for node, contacts in level.contacts.items():
            worst[node] = commonest(contacts)
    return worst


def commonest(places: Sequence[int]) -> int:
    """Return the value that stands most often, the least of equals."""
    return max(sorted(set(places)), key=places.count, default=0)
