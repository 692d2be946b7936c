# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a full-tier surface covers, how fine it is, and how its work is handed out."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import math
from typing import Any

from surrogate.builder.closed_form import default_settings, SurfaceSettings
from surrogate.builder.full.columns import Results
from surrogate.builder.full.speed_nodes import Target
from surrogate.files import InputError
from surrogate.parameters import Screw
from surrogate.screw.contacts import GRID_WAVELENGTH
from surrogate.surface.aims import (
    EFFICIENCY_TOLERANCE,
    LIGHT_LOAD,
    RCS_RELATIVE_TOLERANCE,
    RCS_TOLERANCE,
)

SolveChains = Callable[[str, Mapping[str, Mapping[str, Any]]], Results]
"""Solves named chains: takes what they are for, returns their results, None for a failure."""
LEAST_IN_RATINGS = 0.01
"""Stands for the preload of a screw without one, over the static rating [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FullSettings(SurfaceSettings):
    """
    Ranges and nodes of a full-tier surface.

    As for formulas, but `speed_nodes` is the most that refinement reaches, and `load_nodes` that
    over the loads without their sign, beginning with `load_cells` below unloading, the last of
    which is halved `idle_halvings` times towards it, and `unloaded_cells` above. Draws of the
    roughness from 0, and how many of them are solved where draws differ little; number of held-out
    points and the seed that draws them; accuracy aimed at as a multiple of 0.003 in efficiency and
    of 0.003 or, where that is more, 5 % in RCS [-]. Shortest wavelength of the roughness that is
    solved [m], None for all; shorter ones raise the film floor.

    """

    speed_nodes: int = 16
    load_nodes: int = 13
    load_cells: int = 4
    idle_halvings: int = 3
    unloaded_cells: int = 4
    temperature_nodes: int = 7
    draws: int = 16
    shared_draws: int = 2
    held_out: int = 18
    seed: int = 1
    accuracy: float = 1.0
    grid_wavelength: float | None = GRID_WAVELENGTH

    def __post_init__(self) -> None:
        """Check the numbers that are not ranges."""
        for name, least in (
            ('draws', 1),
            ('shared_draws', 1),
            ('held_out', 1),
            ('speed_nodes', 2),
            ('load_nodes', 2),
            ('load_cells', 1),
            ('idle_halvings', 0),
            ('unloaded_cells', 1),
            ('temperature_nodes', 2),
        ):
            if getattr(self, name) < least:
                raise InputError(f'{name} is {getattr(self, name)}, allowed is {least} or more')
        if not 0.1 <= self.accuracy <= 100:
            raise InputError(f'accuracy is {self.accuracy:g}, allowed is 0.1 to 100')
        if not (self.grid_wavelength is None or 1e-6 <= self.grid_wavelength <= 1e-3):
            raise InputError(
                f'wavelength is {self.grid_wavelength * 1e6:g} um, allowed is 1 to 1000 um'
            )


def default_full_settings(screw: Screw) -> FullSettings:
    """Return the ranges of the closed-form surface of a screw, with the nodes of this tier."""
    ranges = default_settings(screw)
    return FullSettings(
        speed_range=ranges.speed_range,
        load_range=ranges.load_range,
        temperature_range=ranges.temperature_range,
    )


def error_target(screw: Screw, settings: FullSettings) -> Target:
    """Return the allowed errors, with the efficiency at the least load that is judged."""
    least = LIGHT_LOAD * (screw.preload or LEAST_IN_RATINGS * screw.static_rating)
    return Target(
        ideal_torque=least * screw.lead / (2 * math.pi),
        efficiency=settings.accuracy * EFFICIENCY_TOLERANCE,
        rcs=settings.accuracy * RCS_TOLERANCE,
        rcs_relative=settings.accuracy * RCS_RELATIVE_TOLERANCE,
    )
