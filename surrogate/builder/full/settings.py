# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings of a full-tier surface: its ranges and its nodes."""

from dataclasses import dataclass

from surrogate.builder.closed_form import default_settings, SurfaceSettings
from surrogate.files import InputError
from surrogate.parameters import Screw

TEMPERATURES = 3
"""Number of solved temperatures."""
ONE_TEMPERATURE = 1.01
"""Width of a range [K] over which the ratio of solves to formulas does not change."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FullSettings(SurfaceSettings):
    """
    Ranges and nodes of a full-tier surface.

    As for formulas, with `load_cells` below the load at which the relieved nut becomes idle, the
    last of which is halved `idle_halvings` times towards it. Number of held-out points and the
    seed that draws them.

    """

    speed_nodes: int = 22
    load_cells: int = 6
    idle_halvings: int = 3
    unloaded_cells: int = 4
    temperature_nodes: int = 5
    held_out: int = 60
    seed: int = 1

    @property
    def solved_temperatures(self) -> int:
        """Return at how many temperatures screws are solved: one for a range of one."""
        low, high = self.temperature_range
        return TEMPERATURES if high - low > ONE_TEMPERATURE else 1

    @property
    def load_sizes(self) -> tuple[float, float]:
        """Return the least and the largest magnitude of the loads in the range [N]."""
        low, high = self.load_range
        sizes = abs(low), abs(high)
        return 0.0 if low <= 0 <= high else min(sizes), max(sizes)

    def __post_init__(self) -> None:
        for name, least in (
            ('held_out', 1),
            ('speed_nodes', 4),
            ('load_cells', 1),
            ('idle_halvings', 0),
            ('unloaded_cells', 1),
            ('temperature_nodes', 2),
        ):
            if getattr(self, name) < least:
                raise InputError(f'{name} is {getattr(self, name)}, allowed is {least} or more')


def default_full_settings(screw: Screw) -> FullSettings:
    """Return the ranges of the closed-form surface of a screw, with the nodes of this tier."""
    ranges = default_settings(screw)
    return FullSettings(
        speed_range=ranges.speed_range,
        load_range=ranges.load_range,
        temperature_range=ranges.temperature_range,
    )
