# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fields of a full-tier surface from the chains of its columns: means over draws, and spreads."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.full.columns import Columns, covering, Records
from surrogate.builder.full.draws import deviation, weighted_mean
from surrogate.builder.full.means import (
    carried_spread,
    fading,
    joined,
    middle_mean,
    moved_shares,
    other_mean,
    quiet,
)
from surrogate.builder.full.temperatures import between, log_viscosity
from surrogate.surface import FIELDS

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SPREAD = ('friction_torque', 'rcs', 'asperity_share', 'friction_coefficient')
"""Fields whose scatter over draws is kept."""
SHARES = ('rcs', 'asperity_share')
"""Fields from 0 to 1."""
FRICTION = ('friction_torque', 'friction_coefficient')
"""Fields that do not know of the oil where asperities carry everything."""
FAR = 'film_over_floor'
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
    columns: Columns, s: Array, records: Records, temperature: Array, log_onset: Array
) -> Nodes:
    """
    Return the fields at all `temperature` [K] nodes from the `records` of those solved.

    `log_onset` [load, temperature] is the logarithm of the onset speed [rad/s] at these.

    """
    solved, worst = _solved(columns, s, records)
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
        certified=_certified(columns, s, solved[FAR], everywhere['rcs'], mask),
    )


def _solved(
    columns: Columns, s: Array, records: Records
) -> tuple[dict[str, Array], NDArray[np.uint8]]:
    """Return the fields [speed, load, temperature, draw], NaN unless solved, and the contacts."""
    shape = (len(s), len(columns.load), len(columns.temperature))
    most = columns.ensemble.most
    values = {name: np.full((*shape, most), np.nan) for name in (*FIELDS, FAR)}
    places: dict[tuple[int, ...], list[int]] = {}
    for i, j, k, draw in np.ndindex(*shape, most):
        point = records.get((i, j, k, draw))
        if point is not None and point.converged:
            places.setdefault((i, j, k), []).append(point.worst_contact)
            for field, column in values.items():
                column[i, j, k, draw] = getattr(point, field)
    worst = np.zeros(shape, dtype=np.uint8)
    for node, contacts in places.items():
        worst[node] = commonest(contacts)
    return values, worst


def _means(columns: Columns, s: Array, solved: dict[str, Array]) -> dict[str, Array]:
    """Return the means over all draws at the solved temperatures, continued over all speeds."""
    asked = columns.asked(s)
    known = np.isfinite(solved['rcs']).sum(axis=-1)
    weak = asked.any(axis=-1) & (2 * known < asked.sum(axis=-1))
    fade = fading(solved['rcs'][:, :, columns.reference], columns.full(s), columns.few)
    free = ~weak
    free[:, [j for j, _ in columns.verges()]] = True
    return {
        name: continued(s, _joined_means(columns, s, solved[name], weak, fade, name), free)
        for name in FIELDS
    }


def _joined_means(
    columns: Columns, s: Array, field: Array, weak: Flags, fade: Array, name: str
) -> Array:
    """Return the means of a field; columns go on in the shape of those beside them."""
    share, dry = name in SHARES, fade if name in FRICTION else None
    base, sought = columns.reference, columns.sought(s)
    middle = _middle_mean(columns, s, field[:, :, base], fade, share=share)
    parts = [
        middle
        if k == base
        else _other_mean(columns, s, field[:, :, [k, base]], middle, share=share)
        for k in range(len(columns.temperature))
    ]
    parts = [np.where(weak[:, :, k], np.nan, part) for k, part in enumerate(parts)]
    for beside in (-1, 0):
        asked = sought[:, :, base]
        parts[base] = joined(s, parts[base], parts[beside], asked, share=share, fade=dry)
    longer = [
        joined(s, part, parts[base], sought[:, :, k], share=share, fade=dry)
        for k, part in enumerate(parts)
    ]
    found = np.stack([_at_verge(columns, s, part, share=share) for part in longer], axis=-1)
    if share:
        # Contact falls with speed; what is left of noise where it is all but complete may not.
        falling = np.fmax.accumulate(found[::-1])[::-1]
        found = np.where(np.isnan(found), np.nan, falling)
    return found


def _middle_mean(columns: Columns, s: Array, values: Array, fade: Array, *, share: bool) -> Array:
    """Return the mean [speed, load] of `values` [speed, load, draw] at the middle temperature."""
    whole = weighted_mean(values, columns.ensemble.weights(values, columns.load))
    # Where the few are all there are, none has to be moved.
    if columns.few == columns.draws:
        return whole
    return middle_mean(s, values, whole, columns.full(s), columns.few, fade, share=share)


def _at_verge(columns: Columns, s: Array, values: Array, *, share: bool) -> Array:
    """
    Return `values` [speed, load] with the load beside the idle one whole.

    There balls of the relieved nut carry a thousandth of the others, and some solves fail: what is
    missing of these columns has the shape of the load next to them.

    """
    found = values.copy()
    for j, inner in columns.verges():
        column, beside = values[:, [j]], values[:, [inner]]
        if 2 * np.isfinite(column).sum() > np.isfinite(beside).sum():
            failed = np.isnan(column) & np.isfinite(beside)
            found[:, [j]] = joined(s, column, beside, ~failed, share=share)
    return found


def _other_mean(columns: Columns, s: Array, both: Array, middle: Array, *, share: bool) -> Array:
    """Return the mean [speed, load] at a temperature; `both` holds it and the middle one."""
    both, full = both[..., : columns.few], columns.full(s)
    if not share or columns.few == columns.draws:
        return other_mean(s, both[:, :, 0], both[:, :, 1], middle)
    return moved_shares(s, both[:, :, 0], both[:, :, 1], middle, full)


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
        values, mean = solved[name][:, :, base], means[name][:, :, base]
        weights = columns.ensemble.weights(values, columns.load)
        own = deviation(values, weights), columns.ensemble.standard_error(values, weights)
        for kept, spread in zip((deviations, errors), own):
            found = carried_spread(s, spread, mean, full, fade, share=name in SHARES)
            kept[name] = np.where(mask, np.nan, found[:, :, None])
    return deviations, errors


def commonest(places: Sequence[int]) -> int:
    """Return the value that stands most often, the least of equals."""
    return max(sorted(set(places)), key=places.count, default=0)


def continued(s: Array, values: Array, free: Flags) -> Array:
    """
    Return `values` [speed, load, temperature] with columns continued beyond their ends.

    At the fast end as powers of speed, at the slow one as constants, where a node is `free`, that
    is not one that failed, unless beside the idle load. No lookup reads them but there; slopes of
    the columns beside them do.

    """
    held = values.copy()
    for j, k in np.ndindex(values.shape[1:]):
        column = values[:, j, k]
        known = np.flatnonzero(np.isfinite(column))
        if known.size < 2:
            continue
        inner, first, last = known[-2], known[0], known[-1]
        power = 0.0
        if column[last] > 0 and column[inner] > 0:
            power = math.log(column[last] / column[inner]) / (s[last] - s[inner])
        place = np.arange(len(s))
        slow, fast = ((place < first), (place > last)) & np.broadcast_to(
            free[:, j, k], (2, len(s))
        )
        held[slow, j, k] = column[first]
        held[fast, j, k] = column[last] * np.exp(power * (s[fast] - s[last]))
    return held


def _certified(columns: Columns, s: Array, film: Array, rcs: Array, mask: Flags) -> float | None:
    """
    Return the least coordinate from which on all that is solved lies far from contact.

    At that coordinate itself every draw that was asked for must be known; beyond, where films
    only grow, a solve that failed is no objection. The `rcs` of all nodes is zero there.

    """
    near = (quiet(np.nanmin, film) < CERTAIN).any(axis=(1, 2)) | ((rcs > 0) & ~mask).any(
        axis=(1, 2)
    )
    unknown = (columns.asked(s) & ~np.isfinite(film)).any(axis=(1, 2, 3))
    last = np.flatnonzero(near)
    far = np.arange(len(s)) > (last[-1] if last.size else -1)
    found = np.flatnonzero(far & ~unknown & columns.full(s))
    return float(s[found[0]]) if found.size else None
