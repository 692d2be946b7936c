# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Ratios of solved screws to formulas, which few points tell.

Load sharing, kinematics and the law of asperity contact are the same in both tiers. What is left,
films, traction and the balance of the balls, differs by a factor that varies slowly with speed,
load and temperature; RCS and asperity share do not differ. Oversize balls change their motion near
unloading, which no formula follows: there the solved loads are close to each other.

"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import distance_transform_edt
from surrogate.builder.closed_form import temperature_nodes
from surrogate.builder.full.chain import chain_inputs, SENSES, solved_chain
from surrogate.builder.full.nodes import beside_idle, four_point_loads, LIGHTEST, Nodes
from surrogate.builder.full.settings import FullSettings
from surrogate.files import InputError
from surrogate.formulas.film import film_ratio
from surrogate.formulas.load_sharing import UNLOADING_RATIO
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, Screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.surface import FIELDS
from surrogate.surface.fields import SHARES

Array = NDArray[np.float64]
CORRECTED = tuple(name for name in FIELDS if name not in SHARES)
"""Fields that differ between the tiers."""
SPEEDS = (0.0, 0.25, 0.42, 0.58, 0.71, 0.83, 0.92, 0.96, 1.0)
"""Solved speeds over the range, in logarithms [-]: they crowd where the balls feel inertia."""
FOUR_POINT_SPEEDS = tuple(sorted({*SPEEDS, 0.15, 0.34, 0.5, 0.65, 0.77}))
"""Those of oversize balls [-]: near unloading their motion changes with friction."""
LOADS = (0.0, 0.375, 0.75, 0.9, 1.0)
"""Solved loads between none and the idle load [-]."""
FILMS = 'central_film', 'minimum_film'
NEXT_TO_A_FAILURE = 1e-9
"""Interpolated share of failed points above which a node has one beside it [-]."""
Results = Mapping[str, Mapping[str, Any] | None]
Run = Callable[[Mapping[str, Mapping[str, Any]]], Results]
"""Solves named chains: their results, None for a failure."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedGrid:
    """
    Where screws are solved: rising speeds [rad/s], loads [N], temperatures [K].

    Magnitudes of the load stand in `pieces`, between which the fields jump.

    """

    speeds: Array
    pieces: tuple[Array, ...]
    temperature: Array

    @property
    def loads(self) -> Array:
        """Return the loads of all pieces [N]."""
        return np.concatenate(self.pieces)


def solved_grid(screw: Screw, lubricant: Lubricant, settings: FullSettings) -> SolvedGrid:
    """Return the points that are solved for a surface of some settings."""
    low, high = np.log(settings.speed_range)
    shares = FOUR_POINT_SPEEDS if screw.nut == 'oversize' else SPEEDS
    return SolvedGrid(
        speeds=np.exp(low + (high - low) * np.array(shares)),
        pieces=tuple(_pieces(screw, settings)),
        temperature=_temperatures(lubricant, settings),
    )


def _temperatures(lubricant: Lubricant, settings: FullSettings) -> Array:
    """Return the temperatures [K] of solves: over the range, or its middle."""
    number, ends = settings.solved_temperatures, settings.temperature_range
    return temperature_nodes(lubricant, ends, number) if number > 1 else np.array([np.mean(ends)])


def _pieces(screw: Screw, settings: FullSettings) -> Iterator[Array]:
    """Yield loads [N] up to the idle load and beyond it, as far as the range reaches."""
    (least, most), (below, above) = settings.load_sizes, beside_idle(screw)
    if screw.nut == 'oversize':
        yield four_point_loads(screw, settings)
        return
    if above <= 0:
        yield np.geomspace(max(least, LIGHTEST * most), most, len(LOADS))
        return
    if least < above:
        end = most if most <= above else below
        yield least + (end - least) * np.array(LOADS)
    if most > above:
        ends = np.array([above, UNLOADING_RATIO * screw.preload, most])
        yield np.unique(np.clip(ends, max(least, above), most))


def solve_ratios(
    opened: Contacts, lubricant: Lubricant, grid: SolvedGrid, run: Run
) -> dict[str, Array]:
    """
    Return the logarithms of the ratios by field, [sense, speed, load, temperature].

    NaN where a point did not converge. Raises InputError if none did.

    """
    by_formulas = closed_form.solve(
        opened, lubricant, grid.speeds[:, None, None], grid.loads[:, None], grid.temperature
    )
    formulas = with_floor(
        {name: getattr(by_formulas, name) for name in CORRECTED}, opened.sheet, lubricant
    )
    shape = (len(SENSES), len(grid.speeds), len(grid.loads), len(grid.temperature))
    logs = {name: np.full(shape, np.nan) for name in CORRECTED}
    speeds, tasks, places = grid.speeds[::-1].tolist(), {}, {}
    for j, load in enumerate(grid.loads.tolist()):
        for k, heat in enumerate(grid.temperature.tolist()):
            name = f'{load!r} N, temperature {k}'
            tasks[name] = chain_inputs(opened.sheet, lubricant, load, heat, speeds)
            places[name] = j, k
    for name, result in run(tasks).items():
        j, k = places[name]
        for sense, points in enumerate(solved_chain(result) if result else ()):
            for i, point in enumerate(reversed(points)):
                for field in CORRECTED if point.converged else ():
                    ratio = getattr(point, field) / formulas[field][i, j, k]
                    logs[field][sense, i, j, k] = math.log(ratio)
    if np.isnan(logs['friction_torque']).all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    return logs


def with_floor(
    fields: Mapping[str, Array], screw: Screw, lubricant: Lubricant
) -> dict[str, Array]:
    """Return fields of formulas whose films end at the film floor, as those of solves do."""
    floors = dict.fromkeys(FILMS, lubricant.film_floor)
    floors['film_ratio'] = float(film_ratio(lubricant.film_floor, screw.composite_rms))
    return {name: np.maximum(values, floors.get(name, -np.inf)) for name, values in fields.items()}


def ratios_at(
    logs: Mapping[str, Array], grid: SolvedGrid, nodes: Nodes, lubricant: Lubricant
) -> tuple[dict[str, Array], NDArray[np.bool_]]:
    """
    Return the ratios of each field at nodes, and which nodes have a failed point beside them.

    Monotone cubics along each axis, constant beyond the solved speeds.

    """
    failed = np.isnan(logs['friction_torque'])
    nearest = distance_transform_edt(failed, return_distances=False, return_indices=True)
    stacked = np.stack([*(values[tuple(nearest)] for values in logs.values()), failed])
    solved, hot = (
        -np.log(lubricant_state(lubricant, heat).viscosity)
        for heat in (grid.temperature, nodes.temperature)
    )
    if len(solved) == 1:
        heated = np.repeat(stacked, len(hot), axis=4)
    else:
        heated = np.asarray(PchipInterpolator(solved, stacked, axis=4)(hot))
    # [field, speed, load, temperature] at the signed loads, each within its piece.
    sizes, opposing = np.abs(nodes.load), nodes.load >= 0
    gaps = [0.5 * (low[-1] + high[0]) for low, high in zip(grid.pieces, grid.pieces[1:])]
    owner, firsts = np.searchsorted(gaps, sizes), np.cumsum([0, *map(len, grid.pieces)])
    loaded = np.empty((len(heated), len(grid.speeds), len(sizes), len(nodes.temperature)))
    for place, piece in enumerate(grid.pieces):
        first, last = firsts[place], firsts[place + 1]
        for sense, signed in enumerate((opposing, ~opposing)):
            here = (owner == place) & signed
            of_load = PchipInterpolator(piece, heated[:, sense, :, first:last], axis=2)
            loaded[:, :, here] = of_load(np.clip(sizes[here], piece[0], piece[-1]))
    known = np.log(grid.speeds)
    wanted = np.clip(nodes.log_speed, known[0], known[-1])
    stacked_at_nodes = np.empty((len(loaded), *wanted.shape))
    for j, k in np.ndindex(nodes.log_onset.shape):
        along = PchipInterpolator(known, loaded[:, :, j, k], axis=1)
        stacked_at_nodes[:, :, j, k] = along(wanted[:, j, k])
    ratios = {name: np.exp(values) for name, values in zip(logs, stacked_at_nodes)}
    return ratios, stacked_at_nodes[-1] > NEXT_TO_A_FAILURE
