# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Corrections of surfaces on the disk, so that they outlive the node: a file for each axis.

The directory belongs to one node: a second one of the same name keeps nothing and says so. A file
is replaced as a whole, and holds what was solved, not what became of the surface.

"""

from collections.abc import Sequence
import dataclasses
import fcntl
import json
import os
from pathlib import Path
from typing import Any

from surrogate.files import InputError, json_text, replace_file
from surrogate.surface import Correction, FIELDS

VERSION = 1
LARGEST = 10_000_000  # [B] a file of corrections that is longer is none
AUTO = 'auto'


def state_directory(wanted: str, node_name: str) -> Path | None:
    """
    Return where a node of a full name keeps what outlives it, None: nowhere.

    `auto` is the place that the XDG base directory specification has for state.

    """
    if not wanted:
        return None
    if wanted != AUTO:
        return Path(wanted)
    home = os.environ.get('XDG_STATE_HOME') or Path.home() / '.local' / 'state'
    return Path(home, 'ballscrew_monitor', *node_name.strip('/').split('/'))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class KeptSolve:
    """A solve that corrects: speed [rad/s], opposing load [N], temperature [K], fields [SI]."""

    speed: float
    opposing_load: float
    temperature: float
    solved: dict[str, float]


class CorrectionStore:
    """The corrections kept for the axes of one node; `reason` is why nothing is kept, if so."""

    def __init__(self, folder: Path | None) -> None:
        """Take the directory for this node alone, if there is one and nobody has it."""
        self.reason = '' if folder else 'state_dir is empty'
        self._folder = folder
        self._lock = -1
        if folder is None:
            return
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(folder / 'lock', os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self._give_up(f'{folder} is in use by another node of this name')
        except OSError as error:
            self._give_up(f'{folder} cannot be written, {error.strerror}')

    def close(self) -> None:
        """Let another node have the directory."""
        if self._lock >= 0:
            os.close(self._lock)
        self._lock = -1

    def load(self, axis: str) -> tuple[str, list[KeptSolve]]:
        """
        Return the hash of the surface that the kept solves of an axis belong to, and the solves.

        Raises InputError for a file that is none; it is moved aside and nothing is lost.

        """
        path = self._path(axis)
        if path is None or not path.exists():
            return '', []
        try:
            return _read(path)
        except (OSError, ValueError, KeyError, TypeError) as error:
            aside = path.with_suffix('.damaged')
            path.replace(aside)
            raise InputError(
                f'{path}: no corrections of a surface ({error}), moved to {aside.name}'
            ) from None

    def save(self, axis: str, sha256: str, corrections: Sequence[Correction]) -> str:
        """Keep the corrections of the surface of a hash; return why that failed, or nothing."""
        path = self._path(axis)
        if path is None:
            return self.reason
        kept = [
            {
                'speed_rad_s': one.speed,
                'opposing_load_N': one.opposing_load,
                'temperature_K': one.temperature,
                'solved': dict(one.solved),
            }
            for one in corrections
        ]
        content = {'version': VERSION, 'surface': sha256, 'corrections': kept}
        try:
            replace_file(path, (json_text(content) + '\n').encode())
        except OSError as error:
            return f'{path} cannot be written, {error.strerror}'
        return ''

    def _path(self, axis: str) -> Path | None:
        usable = self._folder is not None and not self.reason
        return self._folder / f'{axis}.corrections.json' if usable and self._folder else None

    def _give_up(self, reason: str) -> None:
        self.reason = reason
        self.close()


def _read(path: Path) -> tuple[str, list[KeptSolve]]:
    """Return the content of a file; raises ValueError, KeyError or TypeError when it is wrong."""
    if path.stat().st_size > LARGEST:
        raise ValueError(f'longer than {LARGEST} bytes')
    content = json.loads(path.read_text(encoding='utf-8'))
    if content['version'] != VERSION:
        raise ValueError(f'version {content["version"]}, known is {VERSION}')
    return str(content['surface']), [_kept(one) for one in content['corrections']]


def _kept(one: dict[str, Any]) -> KeptSolve:
    solved = {name: float(one['solved'][name]) for name in FIELDS if name in one['solved']}
    return KeptSolve(
        speed=float(one['speed_rad_s']),
        opposing_load=float(one['opposing_load_N']),
        temperature=float(one['temperature_K']),
        solved=solved,
    )
