# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Which recordings are meant: bags, files, and folders that hold some."""

from collections.abc import Iterable, Sequence
from pathlib import Path
import re

from ballscrew_monitor.recordings.bag_files import ACTIVE, ENDINGS, TABLES
from surrogate.files import InputError

_PART = re.compile(r'(.*)_\d+')  # file of a bag that was split
_UNSAFE = re.compile(r'[^\w.-]+')


def find_logs(paths: Iterable[Path], *, tables: bool = False) -> list[Path]:
    """
    Return the recordings that paths name, those in a folder in the order of their names.

    A path that is a bag or a file stands for itself, whatever is in it; `tables` tells whether
    those in a folder count too. Raises InputError for a folder without any recording.

    """
    endings = (*ENDINGS, *TABLES) if tables else ENDINGS
    found: list[Path] = []
    for path in paths:
        whole = not path.is_dir() or is_one_bag(path)
        found += [path] if whole else _inside(path, endings)
    return list(dict.fromkeys(found))


def is_one_bag(folder: Path) -> bool:
    """Tell whether a folder is one bag: with metadata, or no more than the parts of one."""
    if (folder / 'metadata.yaml').is_file():
        return True
    if any(is_one_bag(child) for child in _folders(folder)):
        return False
    files = _files(folder, (*ENDINGS, ACTIVE))
    parts = [_PART.fullmatch(file.name.partition('.')[0]) for file in files]
    stems = {part[1] for part in parts if part is not None}
    return len(files) == 1 or (len(stems) == 1 and all(parts))


def _inside(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    """Return the recordings in a folder and in those below it."""
    logs = _files(folder, endings)
    for child in _folders(folder):
        logs += [child] if is_one_bag(child) else _below(child, endings)
    if not logs:
        raise InputError(
            f'folder {folder} holds no recording, it must hold bags or files of '
            f'{" or ".join(endings)}'
        )
    return logs


def _below(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    try:
        return _inside(folder, endings)
    except InputError:  # one that holds other things
        return []


def _folders(folder: Path) -> list[Path]:
    """Return the folders in a folder that are not hidden."""
    return sorted(
        path for path in folder.iterdir() if path.is_dir() and not path.name.startswith('.')
    )


def _files(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    return sorted(
        path for path in folder.iterdir() if path.is_file() and path.name.endswith(endings)
    )


def folder_names(logs: Sequence[Path]) -> list[str]:
    """Return a name for the directory of each recording, each another one and harmless."""
    taken: dict[str, int] = {}
    names = []
    for log in logs:
        stem = log.absolute().name
        if stem.endswith((*ENDINGS, *TABLES)):
            stem = stem.partition('.')[0]
        name = _UNSAFE.sub('_', stem).strip('.') or 'log'
        taken[name] = taken.get(name, 0) + 1
        names.append(name if taken[name] == 1 else f'{name}-{taken[name]}')
    return (
        names if len(set(names)) == len(names) else [f'{i + 1}-{n}' for i, n in enumerate(names)]
    )
