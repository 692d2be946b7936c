# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The directory for what outlives the node: for one node alone, files replaced as a whole, one limit.

A second node of the same name keeps nothing and says so. Beyond the limit the oldest part of the
event log goes first.

"""

from collections.abc import Callable, Mapping
import contextlib
import fcntl
import json
import os
from pathlib import Path
import re
from typing import Any, TypeVar

from surrogate.files import InputError, json_text, replace_file

AUTO = 'auto'
EMPTY = 'state_dir is empty'
UNWRITABLE = 'cannot be written'
IN_USE = 'is in use by another node of this name'
DAMAGED = 'is damaged'
VERSION = 1
LARGEST = 10_000_000  # [B] a file that is longer is none of ours
OLD_LOG = re.compile(r'events\.([0-9]+)\.jsonl')
Content = TypeVar('Content')


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


class StateFolder:
    """A directory and its lock; `reason` is why nothing is kept, if so, and `limit` [B]."""

    def __init__(self, path: Path | None, *, limit: int = 64_000_000) -> None:
        """Take the directory for this node alone, if there is one and nobody has it."""
        self.path = path
        self.limit = limit
        self.reason = EMPTY
        self._lock = -1
        self.take()

    @property
    def wanted(self) -> bool:
        """Tell whether anything is to be kept at all."""
        return self.path is not None

    def take(self) -> bool:
        """Try to take the directory, if it is not ours yet; tell whether it is."""
        if self.path is None or self._lock >= 0:
            return self._lock >= 0
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(self.path / 'lock', os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.close()
            self.reason = f'{self.path} {IN_USE}'
            return False
        except OSError as error:
            self.close()
            self.reason = self.unwritable(error)
            return False
        self.reason = ''
        self._sweep()
        return True

    def close(self) -> None:
        """Let another node have the directory."""
        if self._lock >= 0:
            os.close(self._lock)
        self._lock = -1

    def file(self, name: str) -> Path | None:
        """Return the path of a file, None while nothing is kept."""
        return None if self.path is None or self._lock < 0 else self.path / name

    def read(self, name: str, parse: Callable[[Any], Content]) -> Content | None:
        """
        Return what `parse` makes of the content of a file, None if there is no such file.

        Raises InputError for a file that is none; it is moved aside and nothing is lost.

        """
        path = self.file(name)
        if path is None or not path.exists():
            return None
        try:
            return parse(_content(path))
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            aside = path.with_suffix('.damaged')
            moved = f'moved to {aside.name}'
            try:
                path.replace(aside)
            except OSError as refused:
                moved = f'and cannot be moved, {refused.strerror}'
            raise InputError(f'{path} {DAMAGED} ({error}), {moved}') from None

    def write(self, name: str, content: Mapping[str, Any], *, spare: int = 0) -> str:
        """
        Replace a file, as long as `spare` [B] are left below the limit if that is not 0.

        Return why that failed, or nothing.

        """
        path = self.file(name)
        if path is None:
            return self.reason or f'{self.path} is closed'
        text = (json_text({'version': VERSION, **content}) + '\n').encode()
        if not self.make_room(len(text) + spare) and spare:
            return f'{self.path} is at its state_limit of {self.limit / 1e6:g} MB'
        try:
            replace_file(path, text)
        except OSError as error:
            return self.unwritable(error)
        return ''

    def make_room(self, size: int) -> bool:
        """Remove the oldest event logs until `size` [B] more are within the limit; tell if so."""
        if self.path is None:
            return False
        with contextlib.suppress(OSError):
            over = sum(one.stat().st_size for one in self.path.iterdir()) + size - self.limit
            for old in old_logs(self.path).values():
                if over <= 0:
                    break
                over -= old.stat().st_size
                old.unlink()
            return over <= 0
        return True  # what is wrong with the disk the write itself will tell

    def unwritable(self, error: OSError) -> str:
        """Return that the directory cannot be written, and why."""
        return f'{self.path} {UNWRITABLE}, {error.strerror}'

    def _sweep(self) -> None:
        """Remove what a node that was killed in the middle of a write has left."""
        if self.path is not None:
            for left in self.path.glob('.*.json'):
                with contextlib.suppress(OSError):
                    left.unlink()


def old_logs(folder: Path) -> dict[int, Path]:
    """Return the full event logs in a folder by number, the oldest first; copies are none."""
    matches = {path: OLD_LOG.fullmatch(path.name) for path in folder.iterdir()}
    return dict(sorted((int(match[1]), path) for path, match in matches.items() if match))


def _content(path: Path) -> Any:
    if path.stat().st_size > LARGEST:
        raise ValueError(f'longer than {LARGEST} bytes')
    content = json.loads(path.read_text(encoding='utf-8'))
    if content['version'] != VERSION:
        raise ValueError(f'version {content["version"]}, known is {VERSION}')
    return content
