# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: every node a solved screw.

Points that are no nodes are solved last: they measure the error. What is solved, and where, is
left to the caller.

"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.closed_form import check_ranges, check_rough, surface_header
from surrogate.builder.full.chain import chain_inputs, solved_chain, SolvedChain
from surrogate.builder.full.held_out import cell_errors, held_out_points, HeldOut, judged
from surrogate.builder.full.nodes import Nodes, surface_nodes
from surrogate.builder.full.settings import FullSettings
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.onset import onset_speeds, run_in_at, run_in_range, with_raceway
from surrogate.screw.solve import TIER
from surrogate.surface import FIELDS, SolvedPoint, Surface
from surrogate.surface.file import format_version, SurfaceData

Array = NDArray[np.float64]
Results = Mapping[str, Mapping[str, Any] | None]
Run = Callable[[Mapping[str, Mapping[str, Any]]], Results]
"""Solves named chains: their results, None for a failure."""
UNSOLVED = SolvedPoint(converged=False, status='The chain failed.')


def build_full(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, run: Run
) -> SurfaceData:
    """
    Build the surface of the full tier from chains that `run` solves.

    Raises InputError for ranges that make no sense, and for a screw of which no point converges.

    """
    check_rough(screw)
    check_ranges(settings, lubricant)
    nodes = surface_nodes(screw, lubricant, settings)
    # Before any work: a raceway may not bear the lowest pressure of its range.
    band = limit_band(screw, lubricant)
    columns = _columns(screw, lubricant, nodes, run)
    data = _surface(screw, lubricant, settings, nodes, columns)
    held_out = _held_out(data, screw, lubricant, settings, run)
    errors = cell_errors(data, held_out, screw, settings)
    reached = max((one.miss for one in held_out), default=None)
    header = {**data.header, 'limit_band': band, 'reached': reached}
    return replace(data, errors=errors, header=header)


def _columns(
    screw: Screw, lubricant: Lubricant, nodes: Nodes, run: Run
) -> dict[tuple[int, int], tuple[SolvedPoint, ...]]:
    """Return the solved points of each column [load, temperature], from the fastest on."""
    chains, places = {}, {}
    for j, k in np.ndindex(nodes.log_onset.shape):
        load, speeds = float(nodes.load[j]), nodes.speeds(j, k).tolist()
        heat = float(nodes.temperature[k])
        # Loads of either sign share a chain unless their speeds differ.
        name = f'{abs(load)!r} N, temperature {k}, {len(speeds)} from {speeds[0]!r} rad/s'
        chains[name] = chain_inputs(screw, lubricant, abs(load), heat, speeds)
        places[j, k] = name, load
    results = run(chains)
    solved = {name: solved_chain(one) if one else None for name, one in results.items()}
    return {
        place: _under(solved[name], load, len(nodes.speeds(*place)))
        for place, (name, load) in places.items()
    }


def _under(chain: SolvedChain | None, load: float, count: int) -> tuple[SolvedPoint, ...]:
    return chain.under(load) if chain else (UNSOLVED,) * count


def _surface(
    screw: Screw,
    lubricant: Lubricant,
    settings: FullSettings,
    nodes: Nodes,
    columns: Mapping[tuple[int, int], tuple[SolvedPoint, ...]],
) -> SurfaceData:
    """Return the surface of solved nodes, errors unknown; InputError if all failed."""
    fields = {name: np.full(nodes.needed.shape, np.nan) for name in (*FIELDS, 'rcs_deviation')}
    worst = np.zeros(nodes.needed.shape, dtype=np.uint8)
    mask = np.ones(nodes.needed.shape, dtype=bool)
    for (j, k), points in columns.items():
        for i, point in zip(np.flatnonzero(nodes.needed[:, j, k])[::-1], points, strict=True):
            if point.converged:
                mask[i, j, k], worst[i, j, k] = False, point.worst_contact
                for name, values in fields.items():
                    values[i, j, k] = getattr(point, name)
    if mask.all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    deviation = fields.pop('rcs_deviation')
    header = surface_header(screw, lubricant, settings, nodes.breaks, TIER)
    header |= {'format_version': format_version(True)}
    return SurfaceData(
        header=header,
        speed_coordinate=nodes.s,
        load=nodes.load,
        temperature=nodes.temperature,
        log_onset=nodes.log_onset,
        fields=fields,
        errors=dict.fromkeys(FIELDS, np.full(np.subtract(mask.shape, 1), np.nan)),
        worst_contact=worst,
        mask=mask,
        deviations={'rcs': deviation},
        standard_errors={'rcs': deviation},
    )


def limit_band(screw: Screw, lubricant: Lubricant) -> list[float]:
    """
    Return the least and the largest onset speed that may be, over the stated one [-].

    At the preload and the reference temperature: over the range of floors of the oil and, where
    the profile was traced on a new raceway that has run in, over that of the pressure at which
    this cuts the summits, up to none of it. A calibrated onset has its own band instead.

    """
    if screw.roughness.onset_band is not None:
        return [1 / screw.roughness.onset_band, screw.roughness.onset_band]
    low, high = screw, screw
    if (screw.roughness.state, screw.roughness.traced) == ('run_in', 'new'):
        low = run_in_at(screw, run_in_range(screw)[0])
        high = with_raceway(screw, state='new')
    place = np.array([0.0]), np.array([lubricant.reference_temperature])
    least, stated, most = (
        float(onset_speeds(one, _with_floor(lubricant, floor), *place)[0, 0])
        for one, floor in (
            (low, lubricant.film_floor_low),
            (screw, lubricant.film_floor),
            (high, lubricant.film_floor_high),
        )
    )
    return [least / stated, most / stated]


def _with_floor(lubricant: Lubricant, floor: float) -> Lubricant:
    return replace(lubricant, film_floor=floor, film_floor_low=floor, film_floor_high=floor)


def _held_out(
    data: SurfaceData, screw: Screw, lubricant: Lubricant, settings: FullSettings, run: Run
) -> list[HeldOut]:
    """Return points that are no nodes, solved and compared with the lookup."""
    points = held_out_points(Surface(data), screw, settings)
    chains = {
        f'held out {place}': chain_inputs(screw, lubricant, abs(load), heat, [speed])
        for place, (speed, load, heat) in enumerate(points)
    }
    results = run(chains)
    pairs = zip(points, results.values(), strict=True)
    solved = ((point, solved_chain(one).under(point[1])[0]) for point, one in pairs if one)
    surface = Surface(data)
    compared = (judged(data, surface, screw, point, found) for point, found in solved)
    return [one for one in compared if one is not None]
