# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Nodes of a full-tier surface: mapped speeds, loads that crowd the idle load, temperatures.

At the idle load torque and RCS jump, because the balls of the relieved nut are no longer solved;
so a node lies on either side of it, and some crowd below, where the contacts of that nut shrink to
nothing. Oversize balls are solved under any load; nodes crowd the loads between which their motion
changes. Temperatures are even in the logarithm of the viscosity, speeds crowd the onset.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.builder.closed_form import speed_coordinates, temperature_nodes
from surrogate.builder.full.settings import FullSettings
from surrogate.formulas.load_sharing import idle_load, UNLOADING_RATIO
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_speeds

Array = NDArray[np.float64]
BESIDE = 1e-4
"""Distance of the nodes beside the idle load, over that load [-]."""
FOUR_POINT_LOADS = (0.0, 0.2, 0.4, 0.55, 0.65, 0.72, 0.78, 0.84, 0.9, 0.96, 1.05, 1.25)
"""Loads on oversize balls over that which unloads a pair of their flanks [-]."""
LIGHTEST = 0.003
"""Least load of a screw without preload over the largest [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nodes:
    """
    Mapped speeds [-], loads of either sign [N] with the breaks among them, temperatures [K].

    `log_onset` [load, temperature] is the logarithm of the onset speed [rad/s].

    """

    s: Array
    load: Array
    breaks: list[float]
    temperature: Array
    log_onset: Array

    @property
    def log_speed(self) -> Array:
        """Return the logarithms of the speeds [rad/s], [speed, load, temperature]."""
        return np.asarray(self.s[:, None, None] + self.log_onset)


def surface_nodes(opened: Contacts, lubricant: Lubricant, settings: FullSettings) -> Nodes:
    """Return the nodes of a surface of some settings."""
    load, breaks = signed_loads(opened.sheet, settings)
    temperature = temperature_nodes(
        lubricant, settings.temperature_range, settings.temperature_nodes
    )
    log_onset = np.log(onset_speeds(opened, lubricant, load, temperature))
    return Nodes(
        s=speed_coordinates(settings, log_onset),
        load=load,
        breaks=breaks,
        temperature=temperature,
        log_onset=log_onset,
    )


def signed_loads(screw: Screw, settings: FullSettings) -> tuple[Array, list[float]]:
    """Return the load nodes [N] of either sign within the range, and the breaks among them."""
    low, high = settings.load_range
    (_, most), beside = settings.load_sizes, beside_idle(screw)
    below, above = beside
    if screw.nut == 'oversize':
        sizes = four_point_loads(screw, settings)
    elif above <= 0:
        # Without preload there is no contact at zero load: nodes crowd towards it.
        cells = settings.load_cells + settings.unloaded_cells
        sizes = np.union1d(0.0, np.geomspace(LIGHTEST * most, most, cells))
    elif most <= above:
        sizes = np.linspace(0.0, most, settings.load_cells + 1)
    else:
        shared = np.linspace(0.0, below, settings.load_cells + 1)
        halvings = 0.5 ** np.arange(1, settings.idle_halvings + 1)
        halved = below - (shared[-1] - shared[-2]) * halvings
        alone = np.linspace(above, most, settings.unloaded_cells + 1)
        sizes = np.concatenate([np.union1d(shared, halved), alone])
    nodes = np.union1d(-sizes, sizes) + 0.0
    nodes = np.union1d(nodes[(nodes >= low) & (nodes <= high)], [low, high])
    breaks = [
        float(load)
        for load in nodes
        if load == 0 or any(math.isclose(abs(load), edge, rel_tol=1e-9) for edge in beside)
    ]
    return nodes, breaks


def four_point_loads(screw: Screw, settings: FullSettings) -> Array:
    """Return the magnitudes of the load [N] in the range under which oversize balls are solved."""
    least, most = settings.load_sizes
    loads = UNLOADING_RATIO * screw.preload * np.array(FOUR_POINT_LOADS)
    return np.unique([least, *loads[(loads > least) & (loads < most)], most])


def beside_idle(screw: Screw) -> tuple[float, float]:
    """Return the loads [N] just below and just above the idle load."""
    idle = idle_load(screw)
    return (1 - BESIDE) * idle, (1 + BESIDE) * idle
