# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Machines of recordings, which tell axes of one name apart.

A machine is the name that the map of a log states, else the folder that holds the recording.

"""

from collections import Counter
from collections.abc import Iterable
import os.path
from pathlib import Path
from typing import NamedTuple

from ballscrew_monitor.report.logs import bears_name_of_bag


class MachineAxis(NamedTuple):
    """An axis of a machine, which is a stated name or the absolute path of a folder."""

    machine: str
    axis: str


def folder_of(log: Path) -> Path:
    """
    Return the resolved folder that holds a recording.

    A folder with `metadata.yaml` is the recording itself, and so is one that bears the name of the
    files of its only bag, as that of a recorder that was killed. A link counts where it lies.

    """
    folder = Path(os.path.abspath(log if log.is_dir() else log.parent))
    return (
        folder.parent
        if (folder / 'metadata.yaml').is_file() or bears_name_of_bag(folder)
        else folder
    ).resolve()


def machine_names(axes: Iterable[MachineAxis]) -> dict[str, str]:
    """Return a short name of each machine: of a folder, as much of its path as tells it apart."""
    machines = list(dict.fromkeys(axis.machine for axis in axes))
    parts = {name: Path(name).parts if _is_folder(name) else (name,) for name in machines}
    names = {}
    for machine, own in parts.items():
        others = [other for name, other in parts.items() if name != machine]
        alone = (
            '/'.join(own[-depth:])
            for depth in range(1, len(own))
            if not any('/'.join(other[-depth:]) == '/'.join(own[-depth:]) for other in others)
        )
        names[machine] = next(alone, machine)
    return names


def _is_folder(machine: str) -> bool:
    return machine.startswith('/')


def axis_titles(axes: Iterable[MachineAxis]) -> dict[MachineAxis, str]:
    """Return the name of each axis, with its machine where machines share that name."""
    known = list(dict.fromkeys(axes))
    names, count = machine_names(known), Counter(axis.axis for axis in known)
    return {
        axis: axis.axis if count[axis.axis] == 1 else f'{axis.axis} of {names[axis.machine]}'
        for axis in known
    }


def folders_note(axes: Iterable[MachineAxis]) -> str:
    """Return in a sentence that folders with axes of one name count as machines, or ''."""
    known = set(axes)
    count = Counter(axis.axis for axis in known)
    folders = {axis.machine for axis in known if count[axis.axis] > 1 and _is_folder(axis.machine)}
    if len(folders) < 2:
        return ''
    return (
        f'{len(folders)} folders of recordings count as {len(folders)} machines: if they are of '
        'one machine, state machine in the map of its logs, or put its recordings into one '
        'folder'
    )
