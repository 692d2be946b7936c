# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The offline subcommands, each in a module of its own, and the parser of all commands."""

import argparse
from collections.abc import Mapping
import re
from types import MappingProxyType
from typing import Any

from surrogate.commands.contact import add_contact_command
from surrogate.commands.figures import add_figures_command
from surrogate.commands.identify import add_identify_command, LogReader
from surrogate.commands.new_sheet import add_new_commands
from surrogate.commands.onset import add_onset_command
from surrogate.commands.point import add_point_command
from surrogate.commands.surface import add_surface_command
from surrogate.commands.sweep import add_workers
from surrogate.commands.validate import add_validate_command

__all__ = ['add_commands', 'add_workers', 'Parser']


class Parser(argparse.ArgumentParser):
    """Takes -1e3 for a number too, and not for an option, and so do its subcommands."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._negative_number_matcher = re.compile(r'-(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$', re.I)


def add_commands(subparsers: Any, readers: Mapping[str, LogReader] = MappingProxyType({})) -> None:
    """
    Add the offline subcommands; each sets `handler`, which takes the arguments.

    `readers` are what `identify` reads a `bag` and a `table` with.

    """
    add_new_commands(subparsers)
    add_point_command(subparsers)
    add_onset_command(subparsers)
    add_contact_command(subparsers)
    add_identify_command(subparsers, readers)
    add_figures_command(subparsers)
    add_validate_command(subparsers)
    add_surface_command(subparsers)
