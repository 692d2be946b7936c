# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface of the full tier: every node the mean over draws of solved screws.

First the speeds at which contact sets in, from which the mapped speed counts; then speed nodes
where a reference column of few draws needs them; then all columns; at last points that are no
nodes, which measure the error. What is solved, and where, is left to the caller.

"""

from dataclasses import replace

import numpy as np
from surrogate.build import check_ranges, load_nodes, surface_header, temperature_nodes
from surrogate.full.columns import Columns
from surrogate.full.held_out import measure_errors
from surrogate.full.nodes import gather_nodes
from surrogate.full.onset import find_onset, find_speed_nodes
from surrogate.full.settings import FullSettings, Run
from surrogate.parameters import InputError, Lubricant, Screw
from surrogate.screw import TIER
from surrogate.surface import FIELDS
from surrogate.surface_file import format_version, SurfaceData


def build_full(
    screw: Screw, lubricant: Lubricant, settings: FullSettings, run: Run
) -> SurfaceData:
    """
    Build the surface of the full tier from chains that `run` solves.

    Raises InputError for ranges that make no sense, and for a screw of which no point converges.

    """
    check_ranges(settings, lubricant)
    load, breaks = load_nodes(screw, settings)
    temperature = temperature_nodes(screw, lubricant, settings)
    columns = Columns(
        screw=screw,
        lubricant=lubricant,
        load=load,
        temperature=temperature,
        speed_range=settings.speed_range,
        draws=settings.draws,
        shared_draws=settings.shared_draws,
    )
    columns = replace(columns, log_onset=find_onset(columns, settings, run))
    s = find_speed_nodes(columns, settings, run)
    nodes = gather_nodes(columns, s, run('nodes', columns.chains(s)))
    if nodes.mask.all():
        raise InputError('screw: no point of the surface converged, see the reasons above')
    data = SurfaceData(
        header=surface_header(screw, lubricant, settings, breaks, TIER)
        | {'format_version': format_version(True), 'certified_s': nodes.certified},
        speed_coordinate=s,
        load=load,
        temperature=temperature,
        log_onset=columns.log_onset,
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
    return replace(data, errors=measure_errors(data, columns, settings, run))
