# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: every node the mean over draws of solved screws.

First the loads that an interpolation needs and the speeds at which contact sets in, from which the
mapped speed counts; then speed nodes where a column of few draws needs them; then all columns; at
last points that are no nodes, which measure the error. What is solved, and where, is left to the
caller.

"""

from dataclasses import replace

import numpy as np
from surrogate.build import check_ranges, surface_header
from surrogate.full.columns import Columns
from surrogate.full.held_out import measure_errors
from surrogate.full.loads import signed_loads
from surrogate.full.nodes import gather_nodes
from surrogate.full.onset import find_loads, find_onset, middle, Profiles
from surrogate.full.settings import FullSettings, Run
from surrogate.full.speeds import find_speed_nodes
from surrogate.full.temperatures import file_temperatures, solved_temperatures
from surrogate.parameters import InputError, Lubricant, Screw
from surrogate.screw import TIER
from surrogate.surface import FIELDS
from surrogate.surface_file import format_version, SurfaceData


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
    solved = solved_temperatures(lubricant, settings.temperature_range)
    temperature = file_temperatures(
        lubricant, settings.temperature_range, solved, settings.temperature_nodes
    )
    profiles = Profiles(screw=screw, lubricant=lubricant, settings=settings, run=run)
    pieces, known = find_loads(profiles, middle(solved))
    load, breaks = signed_loads(screw, settings, pieces)
    nodes_and_solved = np.union1d(temperature, solved)
    onset = find_onset(profiles, pieces, known, load, solved, nodes_and_solved)
    log_onset = onset[:, np.isin(nodes_and_solved, temperature)]
    columns = Columns(
        screw=screw,
        lubricant=lubricant,
        load=load,
        temperature=solved,
        speed_range=settings.speed_range,
        draws=settings.draws,
        shared_draws=settings.shared_draws,
        log_onset=onset[:, np.isin(nodes_and_solved, solved)],
        grid_wavelength=settings.grid_wavelength,
    )
    s = find_speed_nodes(columns, onset, settings, run)
    nodes = gather_nodes(columns, s, run('nodes', columns.chains(s)), temperature, log_onset)
    if nodes.mask.all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    data = SurfaceData(
        header=surface_header(screw, lubricant, settings, breaks, TIER)
        | {'format_version': format_version(True), 'certified_s': nodes.certified},
        speed_coordinate=s,
        load=load,
        temperature=temperature,
        log_onset=log_onset,
        fields={name: nodes.means[name] for name in FIELDS},
        errors={
            name: np.full([len(axis) - 1 for axis in (s, load, temperature)], np.nan)
            for name in FIELDS
        },
        worst_contact=nodes.worst_contact,
        mask=nodes.mask,
        deviations=nodes.deviations,
        standard_errors=nodes.standard_errors,
    )
    errors, reached = measure_errors(data, columns, settings, run)
    return replace(data, errors=errors, header={**data.header, 'reached': reached})
