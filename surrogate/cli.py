# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The offline subcommands, each in a module of its own."""

from typing import Any

from surrogate.commands.contact import add_contact_command
from surrogate.commands.figures import add_figures_command
from surrogate.commands.identify import add_identify_command, BagReader
from surrogate.commands.onset import add_onset_command
from surrogate.commands.point import add_point_command
from surrogate.commands.surface import add_surface_command
from surrogate.commands.sweep import add_workers

__all__ = ['add_commands', 'add_workers']


def add_commands(subparsers: Any, read_bag: BagReader | None = None) -> None:
    """
    Add the offline subcommands; each sets `handler`, which takes the arguments.

    `read_bag` is what `identify` reads a bag with.

    """
    add_point_command(subparsers)
    add_onset_command(subparsers)
    add_contact_command(subparsers)
    add_identify_command(subparsers, read_bag)
    add_figures_command(subparsers)
    add_surface_command(subparsers)
