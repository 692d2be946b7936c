# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Nodes of a full-tier surface: mapped speeds, loads that crowd the idle load, temperatures.

At the idle load torque and RCS jump, because the balls of the relieved nut are no longer solved;
so a node lies on either side of it, and some crowd below, where the contacts of that nut shrink to
nothing. Temperatures are even in the logarithm of the viscosity, speeds crowd the onset.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter
from surrogate.builder.closed_form import speed_coordinates
from surrogate.builder.full.settings import FullSettings
from surrogate.formulas.load_sharing import idle_load
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, Screw
from surrogate.screw.onset import onset_speeds

Array = NDArray[np.float64]
BESIDE = 1e-4
"""Distance of the nodes beside the idle load, over that load [-]."""
ROUNDING = 1e-9
"""Error of a mapped speed [-]."""
LIGHTEST = 0.003
"""Least load of a screw without preload over the largest [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nodes:
    """
    Mapped speeds [-], loads of either sign [N] with the breaks among them, temperatures [K].

    `log_onset` [load, temperature] is the logarithm of the onset speed [rad/s]; `needed` [speed,
    load, temperature] tells which nodes lookups in the range read.

    """

    s: Array
    load: Array
    breaks: list[float]
    temperature: Array
    log_onset: Array
    needed: NDArray[np.bool_]

    def speeds(self, load: int, temperature: int) -> Array:
        """Return the needed speeds [rad/s] of a column by the numbers of its nodes, falling."""
        inside = self.needed[:, load, temperature]
        return np.exp(self.s[inside] + self.log_onset[load, temperature])[::-1]


def surface_nodes(screw: Screw, lubricant: Lubricant, settings: FullSettings) -> Nodes:
    """Return the nodes of a surface of some settings."""
    load, breaks = signed_loads(screw, settings)
    temperature = temperature_nodes(lubricant, settings)
    onset = onset_speeds(screw, lubricant, load, temperature)
    log_onset = np.log(onset)
    s = speed_coordinates(settings, log_onset)
    return Nodes(
        s=s,
        load=load,
        breaks=breaks,
        temperature=temperature,
        log_onset=log_onset,
        needed=covering(s, log_onset, settings.speed_range),
    )


def signed_loads(screw: Screw, settings: FullSettings) -> tuple[Array, list[float]]:
    """Return the load nodes [N] of either sign within the range, and the breaks among them."""
    low, high = settings.load_range
    sizes = _magnitudes(screw, settings)
    nodes = np.union1d(-sizes, sizes) + 0.0
    nodes = np.union1d(nodes[(nodes >= low) & (nodes <= high)], [low, high])
    beside = [(1 + side) * idle_load(screw) for side in (-BESIDE, BESIDE)]
    breaks = [
        float(load)
        for load in nodes
        if load == 0 or any(math.isclose(abs(load), edge, rel_tol=1e-9) for edge in beside)
    ]
    return nodes, breaks


def _magnitudes(screw: Screw, settings: FullSettings) -> Array:
    """Return the magnitudes of the loads [N]: below the idle load, and above it."""
    most, idle = max(map(abs, settings.load_range)), idle_load(screw)
    below, above = (1 - BESIDE) * idle, (1 + BESIDE) * idle
    if idle <= 0:
        # Without preload there is no contact at zero load: nodes crowd towards it.
        cells = settings.load_cells + settings.unloaded_cells
        return np.union1d(0.0, np.geomspace(LIGHTEST * most, most, cells))
    if most <= above:
        return np.linspace(0.0, most, settings.load_cells + 1)
    shared = np.linspace(0.0, below, settings.load_cells + 1)
    halved = below - (shared[-1] - shared[-2]) * 0.5 ** np.arange(1, settings.idle_halvings + 1)
    alone = np.linspace(above, most, settings.unloaded_cells + 1)
    return np.concatenate([np.union1d(shared, halved), alone])


def temperature_nodes(lubricant: Lubricant, settings: FullSettings) -> Array:
    """Return temperatures [K] from end to end, even in the logarithm of the viscosity."""
    fine = np.linspace(*settings.temperature_range, 400)
    logs = np.log(lubricant_state(lubricant, fine).viscosity)
    even = np.linspace(logs[0], logs[-1], settings.temperature_nodes)
    nodes = np.interp(-even, -logs, fine)
    nodes[[0, -1]] = settings.temperature_range
    return np.asarray(nodes)


def covering(s: Array, log_onset: Array, speed_range: tuple[float, float]) -> NDArray[np.bool_]:
    """
    Return the nodes [speed, load, temperature] that lookups in the speed range [rad/s] read.

    A lookup reads the columns around it at its own coordinate, so a column covers what its
    neighbours cover.

    """
    low, high = (math.log(speed) - log_onset for speed in speed_range)
    slowest, fastest = minimum_filter(low, (3, 3)), maximum_filter(high, (3, 3))
    first = np.searchsorted(s, slowest + ROUNDING, side='right') - 1
    last = np.searchsorted(s, fastest - ROUNDING)
    place = np.arange(len(s))[:, None, None]
    return np.asarray((place >= first) & (place <= last))
