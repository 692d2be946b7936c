# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: every node the mean over draws of solved screws.

First the loads that an interpolation needs and the speeds at which contact sets in, from which the
mapped speed counts; then speed nodes where a column of few draws needs them; then all columns; at
last points that are no nodes, which measure the error. Where that misses its aim and there is room
for more nodes, these are solved, too. What is solved, and where, is left to the caller.

"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.build import check_ranges, surface_header
from surrogate.full.columns import Columns, Records
from surrogate.full.finer import nodes_for_misses, Room
from surrogate.full.held_out import cell_errors, held_out_points, HeldOut, Point, solve_held_out
from surrogate.full.loads import LoadPieces, signed_loads
from surrogate.full.nodes import gather_nodes
from surrogate.full.onset import find_loads, find_onset, middle, Profiles
from surrogate.full.run import Once
from surrogate.full.settings import error_target, FullSettings, Run
from surrogate.full.speed_nodes import Sample
from surrogate.full.speeds import find_speed_nodes, speed_room
from surrogate.full.temperatures import file_temperatures, solved_temperatures
from surrogate.parameters import InputError, Lubricant, Screw
from surrogate.screw import TIER
from surrogate.surface import FIELDS, Surface
from surrogate.surface_file import format_version, SurfaceData

Array = NDArray[np.float64]
GAIN = 0.9
"""Largest part of a miss that is left if more nodes are the way to bring it in [-]."""


@dataclass(frozen=True, slots=True)
class Plan:
    """
    Nodes of a surface: columns at the solved temperatures, all temperatures [K], load breaks [N].

    `onset` is the logarithm of the onset speed [rad/s] over the loads and `heats` [K], which are
    both kinds of temperatures.

    """

    columns: Columns
    temperature: Array
    breaks: list[float]
    onset: Array
    heats: Array

    @property
    def log_onset(self) -> Array:
        """Return the logarithm of the onset speed [rad/s] over the nodes [load, temperature]."""
        return np.asarray(self.onset[:, np.isin(self.heats, self.temperature)])


@dataclass(frozen=True, slots=True)
class Measured:
    """A surface and its held-out points."""

    data: SurfaceData
    held_out: list[HeldOut]

    @property
    def misses(self) -> dict[Point, float]:
        """Return the errors over the allowed ones by point, infinite where not known [-]."""
        return defaultdict(lambda: math.inf, {one.point: one.miss for one in self.held_out})

    @property
    def reached(self) -> float | None:
        """Return the largest error at a held-out point over the allowed one, None without any."""
        return max((one.miss for one in self.held_out), default=None)


def build_full(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, run: Run
) -> SurfaceData:
    """
    Build the surface of the full tier from chains that `run` solves.

    The header says how far the error at the held-out points is from what was aimed at: `reached`
    is the largest error over the allowed one. Raises InputError for ranges that make no sense, and
    for a screw of which no point converges.

    """
    check_ranges(settings, lubricant)
    profiles = Profiles(screw=screw, lubricant=lubricant, settings=settings, run=Once(run))
    heats = solved_temperatures(lubricant, settings.temperature_range)
    pieces, known = find_loads(profiles, middle(heats))
    plan = _plan(profiles, pieces, known, heats)
    s = find_speed_nodes(plan.columns, plan.onset, settings, profiles.run)
    best = _refined(profiles, pieces, known, plan, s)
    errors = cell_errors(best.data, best.held_out, plan.columns, settings)
    return replace(best.data, errors=errors, header={**best.data.header, 'reached': best.reached})


def _plan(
    profiles: Profiles, pieces: LoadPieces, known: Mapping[float, Sample], heats: Array
) -> Plan:
    """Return the columns of some loads at the solved temperatures `heats` [K]."""
    screw, lubricant, settings = profiles.screw, profiles.lubricant, profiles.settings
    temperature = file_temperatures(
        lubricant, settings.temperature_range, heats, settings.temperature_nodes
    )
    load, breaks = signed_loads(screw, settings, pieces)
    both = np.union1d(temperature, heats)
    onset = find_onset(profiles, pieces, known, load, heats, both)
    columns = Columns(
        screw=screw,
        lubricant=lubricant,
        load=load,
        temperature=heats,
        speed_range=settings.speed_range,
        draws=settings.draws,
        shared_draws=settings.shared_draws,
        log_onset=onset[:, np.isin(both, heats)],
        grid_wavelength=settings.grid_wavelength,
    )
    return Plan(columns, temperature, breaks, onset, both)


def _refined(
    profiles: Profiles, pieces: LoadPieces, known: Mapping[float, Sample], plan: Plan, s: Array
) -> Measured:
    """Return the surface with nodes added as long as held-out points come nearer by them."""
    settings, run, heats = profiles.settings, profiles.run, plan.columns.temperature
    records = _solve(plan.columns, s, {}, run)
    data = _surface(plan, s, records, settings)
    points = held_out_points(Surface(data), profiles.screw, settings)
    found = Measured(data, solve_held_out(data, points, plan.columns, settings, run))
    asking = found.held_out
    while True:
        more_s, more_loads = _wanted(data, asking, plan.columns, settings)
        if not (more_s.size or more_loads.size):
            return found
        s, pieces = np.union1d(s, more_s), pieces.with_more(more_loads)
        plan = _plan(profiles, pieces, known, heats)
        records = {**records, **_solve(plan.columns, s, records, run)}
        data = _surface(plan, s, records, settings)
        before = found.misses
        found = Measured(data, solve_held_out(data, points, plan.columns, settings, run))
        asking = [one for one in found.held_out if one.miss < GAIN * before[one.point]]


def _wanted(
    data: SurfaceData, asking: Sequence[HeldOut], columns: Columns, settings: FullSettings
) -> tuple[Array, Array]:
    """Return speed coordinates [-] and magnitudes of the load [N] for which there is room."""
    screw = columns.screw
    speeds = speed_room(columns, data.speed_coordinate, settings)
    loads = max(0, settings.load_nodes - len(columns.magnitudes))
    target = error_target(screw, settings)
    return nodes_for_misses(data, asking, target, screw.lead, Room(speeds, loads))


def _solve(columns: Columns, s: Array, known: Records, run: Run) -> Records:
    """Return the records of nodes that are asked for and not known."""
    purpose = 'more nodes' if known else 'nodes'
    return columns.records(s, run(purpose, columns.chains(s, known)), known)


def _surface(plan: Plan, s: Array, records: Records, settings: FullSettings) -> SurfaceData:
    """Return the surface of solved nodes, errors unknown; InputError if all failed."""
    columns, temperature = plan.columns, plan.temperature
    nodes = gather_nodes(columns, s, records, temperature, plan.log_onset)
    if nodes.mask.all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    header = surface_header(columns.screw, columns.lubricant, settings, plan.breaks, TIER)
    cells = [len(axis) - 1 for axis in (s, columns.load, temperature)]
    return SurfaceData(
        header=header | {'format_version': format_version(True), 'certified_s': nodes.certified},
        speed_coordinate=s,
        load=columns.load,
        temperature=temperature,
        log_onset=plan.log_onset,
        fields={name: nodes.means[name] for name in FIELDS},
        errors={name: np.full(cells, np.nan) for name in FIELDS},
        worst_contact=nodes.worst_contact,
        mask=nodes.mask,
        deviations=nodes.deviations,
        standard_errors=nodes.standard_errors,
    )
