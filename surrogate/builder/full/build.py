# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: formulas at the nodes times the ratio of solved screws to them.

Points that are no nodes are solved last: they measure the error. Who solves is left to the caller.

"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.closed_form import check_ranges, check_rough, solve_grid, surface_header
from surrogate.builder.full.chain import point_inputs, solved_chain
from surrogate.builder.full.held_out import cell_errors, held_out_points, judged
from surrogate.builder.full.nodes import Nodes, surface_nodes
from surrogate.builder.full.ratios import ratios_at, Run, solve_ratios, solved_grid, with_floor
from surrogate.builder.full.settings import FullSettings
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.onset_bands import onset_bands
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import TIER
from surrogate.surface import FIELDS, Surface
from surrogate.surface.file import SurfaceData

Array = NDArray[np.float64]


def build_full(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, run: Run
) -> SurfaceData:
    """
    Build the surface of the full tier from chains that `run` solves.

    Raises InputError for ranges that make no sense, and for a screw of which no point converges.

    """
    check_rough(screw)
    check_ranges(settings, lubricant)
    opened = Contacts.of(screw)
    nodes = surface_nodes(opened, lubricant, settings)
    with ThreadPoolExecutor(max_workers=1) as beside:
        # While workers solve; a raceway may not bear the lowest pressure of its range.
        place = 0.0, lubricant.reference_temperature
        waiting = beside.submit(onset_bands, screw, lubricant, *place)
        data = _surface(opened, lubricant, settings, nodes, run)
        bands = waiting.result().record()
    points = held_out_points(Surface(data), screw, settings)
    chains = {
        f'held out {place}': point_inputs(screw, lubricant, load, heat, speed)
        for place, (speed, load, heat) in enumerate(points)
    }
    results = run(chains)
    pairs = zip(points, results.values(), strict=True)
    solved = ((point, solved_chain(result)[0][0]) for point, result in pairs if result)
    surface = Surface(data)
    compared = (judged(data, surface, screw, point, exact) for point, exact in solved)
    held_out = [place for place in compared if place is not None]
    errors = cell_errors(data, held_out, screw, settings)
    reached = max((place.miss for place in held_out), default=None)
    header = {**data.header, **bands, 'reached': reached}
    return replace(data, errors=errors, header=header)


def _surface(
    opened: Contacts, lubricant: Lubricant, settings: FullSettings, nodes: Nodes, run: Run
) -> SurfaceData:
    """Return the surface of formulas times the ratios of solved points, errors unknown."""
    screw = opened.sheet
    grid = solved_grid(screw, lubricant, settings)
    logs = solve_ratios(opened, lubricant, grid, run)
    ratios, failed = ratios_at(logs, grid, nodes, lubricant)
    axes, onset = (nodes.s, nodes.load, nodes.temperature), nodes.log_onset
    formula_values = solve_grid(opened, lubricant, *axes, onset)
    # RCS from an onset that is half of its deviation later to one that is as much sooner.
    later, sooner = (
        solve_grid(opened.with_law(opened.law.shifted(half)), lubricant, *axes, onset)
        for half in (0.5, -0.5)
    )
    deviation = np.asarray(later['rcs'] - sooner['rcs'])
    formulas = with_floor({name: formula_values[name] for name in FIELDS}, screw, lubricant)
    solved = {name: values * ratios.get(name, 1.0) for name, values in formulas.items()}
    # Between two solved points a ratio may take a film that lies on the floor below it.
    fields = with_floor(solved, screw, lubricant)
    mask = failed | ~np.all([np.isfinite(values) for values in fields.values()], axis=0)
    for values in (*fields.values(), deviation):
        values[mask] = np.nan
    header = surface_header(screw, lubricant, settings, nodes.breaks, TIER)
    return SurfaceData(
        header=header,
        speed_coordinate=nodes.s,
        load=nodes.load,
        temperature=nodes.temperature,
        log_onset=nodes.log_onset,
        fields=fields,
        errors=dict.fromkeys(FIELDS, np.full(np.subtract(mask.shape, 1), np.nan)),
        worst_contact=formula_values['worst_contact'].astype(np.uint8),
        mask=mask,
        deviations={'rcs': deviation},
        standard_errors={'rcs': deviation},
    )
