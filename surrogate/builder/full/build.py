# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: every node the mean over draws of solved screws.

First the loads that an interpolation needs and the speeds at which contact sets in, from which the
mapped speed counts; then speed nodes where a column of few draws needs them; then all columns; at
last points that are no nodes, which measure the error. Where that misses its aim and there is room
for more nodes, these are solved, too. What is solved, and where, is left to the caller.

"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.closed_form import check_ranges, check_rough, surface_header
from surrogate.builder.full.columns import Columns, moved_records, Records
from surrogate.builder.full.finer import nodes_for_misses, Room
from surrogate.builder.full.held_out import (
    cell_errors,
    held_out_points,
    HeldOut,
    HeldOutPlace,
    solve_held_out,
)
from surrogate.builder.full.loads import LoadPieces, signed_loads
from surrogate.builder.full.nodes import gather_nodes
from surrogate.builder.full.onset import find_loads, find_onset, middle, Profiles
from surrogate.builder.full.run import Once
from surrogate.builder.full.settings import error_target, FullSettings, SolveChains
from surrogate.builder.full.speed_nodes import NodeSample
from surrogate.builder.full.speeds import find_speed_nodes, speed_room
from surrogate.builder.full.temperatures import file_temperatures, solved_temperatures
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.solve import TIER
from surrogate.surface import FIELDS, Surface
from surrogate.surface.file import format_version, SurfaceData

Array = NDArray[np.float64]
GAIN = 0.9
"""Largest part of a miss that is left if more nodes are the way to bring it in [-]."""


@dataclass(frozen=True, slots=True)
class NodePlan:
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
class JudgedSurface:
    """A surface and its held-out points."""

    data: SurfaceData
    held_out: list[HeldOut]

    @property
    def reached(self) -> float | None:
        """Return the largest error at a held-out point over the allowed one, None without any."""
        return max(self.misses.values(), default=None)

    @property
    def misses(self) -> dict[HeldOutPlace, float]:
        """Return the errors over the allowed ones by point [-]."""
        return {one.point: one.miss for one in self.held_out}

    def is_worse_than(self, other: 'JudgedSurface') -> bool:
        """Tell whether a point is lost or the largest error has grown."""
        lost = other.misses.keys() - self.misses.keys()
        return bool(lost) or (self.reached or 0.0) > (other.reached or 0.0)


@dataclass(slots=True)
class Builder:
    """
    Solves and measures a surface, with more nodes each time; no node is solved twice.

    `known` are the profiles by the magnitude of the load [N], `heats` the solved temperatures [K],
    `first` the speed nodes [-] of the first time, `points` those held out then. `records` are on
    the speeds [-] and loads [N] of `axes`.

    """

    profiles: Profiles
    known: Mapping[float, NodeSample]
    heats: Array
    first: Array | None = None
    points: list[HeldOutPlace] | None = None
    records: Records = field(default_factory=dict)
    axes: tuple[Array, Array] = (np.empty(0), np.empty(0))

    def plan(self, pieces: LoadPieces) -> NodePlan:
        """Return the columns of some loads."""
        screw, lubricant = self.profiles.screw, self.profiles.lubricant
        settings, heats = self.profiles.settings, self.heats
        temperature = file_temperatures(
            lubricant, settings.temperature_range, heats, settings.temperature_nodes
        )
        load, breaks = signed_loads(screw, settings, pieces)
        both = np.union1d(temperature, heats)
        onset = find_onset(self.profiles, pieces, self.known, load, heats, both)
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
            first=self.first,
        )
        return NodePlan(columns, temperature, breaks, onset, both)

    def measure(self, pieces: LoadPieces, s: Array) -> JudgedSurface:
        """Solve what is not known of the speed nodes `s` [-] at some loads, then the points."""
        plan, settings, run = self.plan(pieces), self.profiles.settings, self.profiles.run
        columns, purpose = plan.columns, 'more nodes' if self.records else 'nodes'
        axes = s, columns.load
        known, self.axes = moved_records(self.records, self.axes, axes), axes
        results = run(purpose, columns.chains(s, known))
        self.records = known | columns.records(s, results, known)
        data = _surface(plan, s, self.records, settings)
        if self.points is None:
            self.points = held_out_points(Surface(data), columns.screw, settings)
        return JudgedSurface(data, solve_held_out(data, self.points, columns, settings, run))


def build_full(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, run: SolveChains
) -> SurfaceData:
    """
    Build the surface of the full tier from chains that `run` solves.

    The header says how far the error at the held-out points is from what was aimed at: `reached`
    is the largest error over the allowed one. Raises InputError for ranges that make no sense, and
    for a screw of which no point converges.

    """
    check_rough(screw)
    check_ranges(settings, lubricant)
    profiles = Profiles(screw=screw, lubricant=lubricant, settings=settings, run=Once(run))
    heats = solved_temperatures(lubricant, settings.temperature_range)
    pieces, known = find_loads(profiles, middle(heats))
    builder = Builder(profiles, known, heats)
    plan = builder.plan(pieces)
    builder.first = find_speed_nodes(plan.columns, plan.onset, settings, profiles.run)
    first, last = _refined(builder, pieces, speed_room(plan.columns, builder.first, settings))
    before = first.held_out if last is not first else []
    errors = cell_errors(last.data, last.held_out, screw, settings, before)
    return replace(last.data, errors=errors, header={**last.data.header, 'reached': last.reached})


def _refined(
    builder: Builder, pieces: LoadPieces, speeds: int
) -> tuple[JudgedSurface, JudgedSurface]:
    """
    Return the surface at first and with nodes added as long as held-out points come nearer by it.

    `speeds` more speed nodes at most [-].

    """
    settings, screw = builder.profiles.settings, builder.profiles.screw
    s, target = np.asarray(builder.first), error_target(screw, settings)
    room = Room(speeds, max(0, settings.load_nodes - len(pieces.magnitudes)))
    first = last = builder.measure(pieces, s)
    asking = first.held_out
    while True:
        more_s, more_loads = nodes_for_misses(last.data, asking, target, screw.lead, room)
        if not (more_s.size or more_loads.size):
            return first, last
        room = Room(room.speeds - more_s.size, room.loads - more_loads.size)
        s, pieces = np.union1d(s, more_s), pieces.with_more(more_loads)
        found = builder.measure(pieces, s)
        if found.is_worse_than(last):
            return first, last
        misses, last = last.misses, found
        asking = [one for one in found.held_out if one.miss < GAIN * misses.get(one.point, np.inf)]


def _surface(plan: NodePlan, s: Array, records: Records, settings: FullSettings) -> SurfaceData:
    """Return the surface of solved nodes, errors unknown; InputError if all failed."""
    columns, temperature = plan.columns, plan.temperature
    nodes = gather_nodes(columns, s, records, temperature, plan.log_onset)
    if nodes.mask.all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    header = surface_header(columns.screw, columns.lubricant, settings, plan.breaks, TIER)
    header |= {'format_version': format_version(True), 'certified_s': nodes.certified}
    if columns.ensemble.powers:
        header['weighted_draws'] = asdict(columns.ensemble) | {
            'powers': [*columns.ensemble.powers]
        }
    cells = [len(axis) - 1 for axis in (s, columns.load, temperature)]
    return SurfaceData(
        header=header,
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
