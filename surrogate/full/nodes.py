# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fields of a full-tier surface from the chains of its columns: means over draws, and their spread.

At one mapped speed the product of viscosity and speed is the same at every temperature, and so,
nearly, is what one draw differs from another. So the mean at a temperature with few draws is that
of these draws, moved by what all draws differ from the same few at the reference temperature.

"""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any
import warnings

import numpy as np
from numpy.typing import NDArray
from surrogate.full.columns import chain_name, Columns, records_by_speed, Results
from surrogate.surface import FIELDS

Array = NDArray[np.float64]
SPREAD = ('friction_torque', 'rcs', 'asperity_share', 'friction_coefficient')
"""Fields whose scatter over draws is kept."""
SHARES = ('rcs', 'asperity_share')
"""Fields from 0 to 1, which draws shift; they scale the others."""
FAR = 'film_over_floor'
CERTAIN = 2.0
"""Least rough film over the floor at which no asperity is near [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nodes:
    """
    Fields on the nodes [speed, load, temperature] in SI.

    Means over draws, standard deviations of the draws and standard errors of the means; worst
    contact; mask of nodes without a number; number of solves that did not converge; the least
    speed coordinate from which on no solved draw of any column comes near contact, None if there
    is none.

    """

    means: dict[str, Array]
    deviations: dict[str, Array]
    standard_errors: dict[str, Array]
    worst_contact: NDArray[np.uint8]
    mask: NDArray[np.bool_]
    failed: int
    certified: float | None


def gather_nodes(columns: Columns, s: Array, results: Results) -> Nodes:
    """Return the fields on the nodes from the results of `columns.chains(s)`."""
    solved, worst = _solved(columns, s, results)
    base = columns.reference
    known = np.isfinite(solved['rcs'])
    asked = np.array([len(columns.draws_at(k)) for k in range(len(columns.temperature))])
    needed = columns.needed(s)
    mask = ~needed | (2 * known.sum(axis=-1) < asked)
    means = {name: _shared_mean(solved[name], base, name in SHARES) for name in FIELDS}
    deviations, errors = {}, {}
    for name in SPREAD:
        own = solved[name][:, :, base, :]
        count = np.isfinite(own).sum(axis=-1)
        # With one draw there is no deviation: 0/0 is the answer.
        with np.errstate(invalid='ignore', divide='ignore'):
            spread = _quiet(np.nanstd, own) * np.sqrt(count / (count - 1.0))
            one = np.where(count > 1, spread, np.nan)
            error = one / np.sqrt(count)
        deviations[name] = np.where(mask, np.nan, _held(one)[:, :, None])
        errors[name] = np.where(mask, np.nan, _held(error)[:, :, None])
    for values in means.values():
        values[mask] = np.nan
    far = np.where(needed, np.where(mask, -np.inf, _quiet(np.nanmin, solved[FAR])), np.inf)
    return Nodes(
        means={name: continued(s, values) for name, values in means.items()},
        deviations=deviations,
        standard_errors=errors,
        worst_contact=worst,
        mask=mask,
        failed=int((needed * asked).sum() - (known & needed[..., None]).sum()),
        certified=_certified(s, far),
    )


def _solved(
    columns: Columns, s: Array, results: Results
) -> tuple[dict[str, Array], NDArray[np.uint8]]:
    """Return the fields [speed, load, temperature, draw], NaN unless solved, and the contacts."""
    shape = (len(s), len(columns.load), len(columns.temperature), columns.draws)
    values = {name: np.full(shape, np.nan) for name in (*FIELDS, FAR)}
    worst = np.zeros(shape[:3], dtype=np.uint8)
    needed = columns.needed(s)
    for j, k in np.ndindex(shape[1:3]):
        load, sense = columns.load[j], 'opposing' if columns.load[j] >= 0 else 'assisting'
        chains = [results[chain_name(float(abs(load)), k, draw)] for draw in columns.draws_at(k)]
        draws = [draw for draw, chain in zip(columns.draws_at(k), chains) if chain is not None]
        places = np.flatnonzero(needed[:, j, k])
        for i, records in zip(places, records_by_speed(chains, sense, len(places))):
            found = [(d, record) for d, record in zip(draws, records) if record['converged']]
            for draw, record in found:
                for name in values:
                    values[name][i, j, k, draw] = record[name]
            worst[i, j, k] = commonest([record['worst_contact'] for _, record in found])
    return values, worst


def _shared_mean(values: Array, base: int, share: bool) -> Array:
    """Return the mean over draws, where few were solved by what all of them say at `base`."""
    reference = values[:, :, [base], :]
    both = np.isfinite(values) & np.isfinite(reference)
    few = _quiet(np.nanmean, np.where(both, reference, np.nan))
    own = _quiet(np.nanmean, values)
    whole = _quiet(np.nanmean, reference)
    if share:
        shift = _held(np.where(np.isfinite(few), whole - few, np.nan))
        return np.asarray(np.clip(own + np.nan_to_num(shift), 0.0, 1.0))
    ratio = _held(np.where(np.isfinite(few), whole / few, np.nan))
    return np.asarray(own * np.where(np.isfinite(ratio), ratio, 1.0))


def _held(values: Array) -> Array:
    """Return columns over speed with their ends held where nothing is known beyond."""
    filled = values.copy()
    flat = filled.reshape(len(filled), -1)
    for column in flat.T:
        known = np.flatnonzero(np.isfinite(column))
        if known.size:
            first, last = known[0], known[-1]
            place = np.arange(len(column))
            column[place < first], column[place > last] = column[first], column[last]
    return filled


def _quiet(reduce: Any, values: Array) -> Array:
    """Reduce over draws, where there may be none."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)
        return np.asarray(reduce(values, axis=-1))


def commonest(places: Sequence[int]) -> int:
    """Return the value that stands most often, the least of equals."""
    return max(sorted(set(places)), key=places.count, default=0)


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
