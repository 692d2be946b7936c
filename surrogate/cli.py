# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The offline subcommands, each in a module of its own."""

from typing import Any

from surrogate.contact_command import add_contact_command
from surrogate.figures_command import add_figures_command
from surrogate.identify_command import add_identify_command, BagReader
from surrogate.point_command import add_point_command
from surrogate.surface_command import add_surface_command


def add_commands(subparsers: Any, read_bag: BagReader | None = None) -> None:
    """
    Add the offline subcommands; each sets `handler`, which takes the arguments.

    `read_bag` is what `identify` reads a bag with.

    """
    add_point_command(subparsers)
    add_contact_command(subparsers)
    add_identify_command(subparsers, read_bag)
    add_figures_command(subparsers)
    add_surface_command(subparsers)
