# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fields of a full-tier surface from the chains of its columns: means over draws, and spreads."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.full.columns import Columns, covering, records_by_speed, Results
from surrogate.full.means import fading, middle_mean, middle_spread, moved_share, other_mean, quiet
from surrogate.full.temperatures import between, log_viscosity
from surrogate.surface import FIELDS

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SPREAD = ('friction_torque', 'rcs', 'asperity_share', 'friction_coefficient')
"""Fields whose scatter over draws is kept."""
SHARES = ('rcs', 'asperity_share')
"""Fields from 0 to 1."""
FAR = 'film_over_floor'
SENSES = ('assisting', 'opposing')
CERTAIN = 2.0
"""Least rough film over the floor at which no asperity is near [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nodes:
    """
    Fields on the nodes [speed, load, temperature] in SI.

    Means over draws, standard deviations of the draws and standard errors of the means; worst
    contact; mask of nodes without a number; the least speed coordinate from which on no solved
    draw of any column comes near contact, None if there is none.

    """

    means: dict[str, Array]
    deviations: dict[str, Array]
    standard_errors: dict[str, Array]
    worst_contact: NDArray[np.uint8]
    mask: Flags
    certified: float | None


def gather_nodes(
    columns: Columns, s: Array, results: Results, temperature: Array, log_onset: Array
) -> Nodes:
    """
    Return the fields at all `temperature` [K] nodes from the results of `columns.chains(s)`.

    `log_onset` [load, temperature] is the logarithm of the onset speed [rad/s] at these.

    """
    solved, worst = _solved(columns, s, results)
    means = _means(columns, s, solved)
    x, wanted = (
        log_viscosity(columns.lubricant, heat) for heat in (columns.temperature, temperature)
    )
    everywhere = {name: _at_all(name, values, x, wanted) for name, values in means.items()}
    mask = ~covering(s, log_onset, columns.speed_range, (3, 3))
    mask |= ~np.all([np.isfinite(values) for values in everywhere.values()], axis=0)
    deviations, errors = _spreads(columns, s, solved, means, mask)
    nearest = np.argmin(np.abs(x - wanted[:, None]), axis=1)
    return Nodes(
        means=everywhere,
        deviations=deviations,
        standard_errors=errors,
        worst_contact=worst[:, :, nearest],
        mask=mask,
        certified=_certified(columns, s, solved[FAR]),
    )


def _solved(
    columns: Columns, s: Array, results: Results
) -> tuple[dict[str, Array], NDArray[np.uint8]]:
    """Return the fields [speed, load, temperature, draw], NaN unless solved, and the contacts."""
    shape = (len(s), len(columns.load), len(columns.temperature))
    values = {name: np.full((*shape, columns.draws), np.nan) for name in (*FIELDS, FAR)}
    places: dict[tuple[int, ...], list[int]] = {}
    for name, (j, k, draw), solved in columns.pieces(s):
        sense, chain = SENSES[int(columns.load[j] >= 0)], results.get(name)
        if chain is None:
            continue
        for i, (record,) in zip(solved.tolist(), records_by_speed([chain], sense, len(solved))):
            if record['converged']:
                places.setdefault((i, j, k), []).append(record['worst_contact'])
                for field, column in values.items():
                    column[i, j, k, draw] = record[field]
    worst = np.zeros(shape, dtype=np.uint8)
    for node, contacts in places.items():
        worst[node] = commonest(contacts)
    return values, worst


def _means(columns: Columns, s: Array, solved: dict[str, Array]) -> dict[str, Array]:
    """Return the means over all draws at the solved temperatures, continued over all speeds."""
    full, base = columns.full(s), columns.reference
    fade = fading(solved['rcs'][:, :, base], full, columns.few)
    known = np.isfinite(solved['rcs']).sum(axis=-1)
    weak = 2 * known < np.maximum(columns.asked(s).sum(axis=-1), 1)
    means = {}
    for name in FIELDS:
        field = solved[name]
        middle = middle_mean(s, field[:, :, base], full, columns.few, fade, share=name in SHARES)
        parts = []
        for k in range(len(columns.temperature)):
            few = field[:, :, [k, base], : columns.few]
            if k == base:
                parts.append(middle)
            elif name in SHARES:
                moved = [
                    moved_share(s, few[:, j, 0], few[:, j, 1], middle[:, j], full)
                    for j in range(len(columns.load))
                ]
                parts.append(np.stack(moved, axis=1))
            else:
                parts.append(other_mean(s, few[:, :, 0], few[:, :, 1], middle))
        mean = np.where(weak, np.nan, np.stack(parts, axis=-1))
        means[name] = continued(s, mean)
    return means


def _at_all(name: str, values: Array, x: Array, wanted: Array) -> Array:
    """Return a field at all temperatures from that at those solved, which stay as they are."""
    if name in SHARES:
        found = between(x, values, wanted, smooth=False)
    else:
        found = np.exp(between(x, np.log(values), wanted, smooth=True))
    for place, solved in enumerate(x):
        found[..., wanted == solved] = values[..., [place]]
    return np.asarray(found)


def _spreads(
    columns: Columns, s: Array, solved: dict[str, Array], means: dict[str, Array], mask: Flags
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return deviations and standard errors at all nodes: those of the middle temperature."""
    full, base = columns.full(s), columns.reference
    fade = fading(solved['rcs'][:, :, base], full, columns.few)
    deviations: dict[str, Array] = {}
    errors: dict[str, Array] = {}
    for name in SPREAD:
        found = middle_spread(
            s, solved[name][:, :, base], means[name][:, :, base], full, fade, share=name in SHARES
        )
        for kept, values in zip((deviations, errors), found):
            kept[name] = np.where(mask, np.nan, values[:, :, None])
    return deviations, errors


def commonest(places: Sequence[int]) -> int:
    """Return the value that stands most often, the least of equals."""
    return max(sorted(set(places)), key=places.count, default=0)


def continued(s: Array, values: Array) -> Array:
    """
    Return `values` [speed, load, temperature] with columns continued beyond their ends.

    As powers of speed, or as constants where a value is zero or falls. Columns of colder and
    hotter oil reach further, and what lies between two temperatures is read from both.

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


def _certified(columns: Columns, s: Array, film: Array) -> float | None:
    """
    Return the least coordinate from which on all that is solved lies far from contact.

    At that coordinate itself every draw that was asked for must be known; beyond, where films
    only grow, a solve that failed is no objection.

    """
    close = np.flatnonzero((quiet(np.nanmin, film) < CERTAIN).any(axis=(1, 2)))
    unknown = (columns.asked(s) & ~np.isfinite(film)).any(axis=(1, 2, 3))
    far = np.arange(len(s)) > (close[-1] if close.size else -1)
    found = np.flatnonzero(far & ~unknown & columns.full(s))
    return float(s[found[0]]) if found.size else None
