# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
r"""
Results of solves, kept while a surface is built, so that an interruption costs one solve at most.

One file that only grows, beside the output: a line of header, then a line per result, each with
its own checksum, written by one call and flushed to the disk. A directory with a file per result
would be as safe, but a map has thousands; a line needs no rename, and a reader sees at once which
results there are. SQLite survives a kill as well, but has no checksums: a file that is cut off or
damaged in one byte costs it all results, or none and a wrong number. A line that was torn by a
kill or a full disk fails its checksum and is dropped. Floats are kept in hexadecimal, bit for bit.

"""

from collections.abc import Mapping
import fcntl
import hashlib
import json
import os
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from surrogate.files import canonical_json
from surrogate.surface.file import SurfaceError
from surrogate.worker import plain_result

FORMAT = 'ballscrew_task_store'
FORMAT_VERSION = 1
ENDING = '.store'
CHECKSUM = 16
"""Hexadecimal digits of the checksum of a line [-]."""
FLOAT, FLOATS = '$float', '$floats'
"""Keys that stand for a float and for a list of nothing but floats."""


def store_path(out: str | Path) -> Path:
    """Return where the results of the surface `out` are kept."""
    return Path(f'{out}{ENDING}')


def task_key(work: str, inputs: Mapping[str, Any]) -> str:
    """
    Return the name of a task by its content: 64 hexadecimal digits.

    SHA-256 over canonical JSON of `work`, which names the solver and its version, and of the
    inputs, plain JSON with finite numbers. 1 and 1.0 are different inputs.

    """
    return hashlib.sha256(canonical_json([FORMAT_VERSION, work, inputs])).hexdigest()


def clear(out: str | Path) -> bool:
    """Remove the kept results of the surface `out`; tell whether there were any."""
    path = store_path(out)
    try:
        path.unlink()
    except FileNotFoundError:
        return False
    except OSError as error:
        raise SurfaceError(f'{path}: cannot be removed, {error.strerror}') from None
    return True


class TaskStore:
    """
    Results of the tasks of one surface by their keys; open it with `with`.

    `dropped` counts the torn lines that were found. Another build of the same surface cannot open
    the file meanwhile.

    """

    def __init__(self, out: str | Path, work: str) -> None:
        """
        Open the results kept for the surface `out`, or begin with none.

        Raises SurfaceError, one sentence, for results of other `work`, of another version, in use
        by another process, or a file that cannot be written.

        """
        self.path = store_path(out)
        self.dropped = 0
        self.work, self._out = work, out
        self._results: dict[str, dict[str, Any]] = {}
        self._file = self._open()
        try:
            self._end = self._load()
        except BaseException:
            os.close(self._file)
            raise

    def __enter__(self) -> Self:
        """Return the open store."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        """Close the file; every result is in it already."""
        os.close(self._file)

    def __contains__(self, key: str) -> bool:
        """Tell whether the result of a task is kept."""
        return key in self._results

    def __len__(self) -> int:
        """Return the number of kept results."""
        return len(self._results)

    def get(self, key: str) -> dict[str, Any] | None:
        """Return the result of a task, or None."""
        return self._results.get(key)

    def put(self, key: str, result: Mapping[str, Any]) -> None:
        """
        Keep the result of a task: plain JSON, in which floats may be of any value.

        When it returns, the result is on the disk. Raises SurfaceError when it cannot be written;
        the results before it stay.

        """
        self._append(_line([key, _pack(result)]))
        self._results[key] = plain_result(result)

    def _open(self) -> int:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            raise SurfaceError(f'{self.path}: cannot be written, {error.strerror}') from None
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(file)
            raise SurfaceError(f'{self.path}: in use by another build of {self._out}') from None
        return file

    def _load(self) -> int:
        """Read what is whole and cut off a torn end; return the length that is kept."""
        with open(self.path, 'rb') as file:
            *lines, torn = file.read().split(b'\n')
        head = _line({'format': FORMAT, 'version': FORMAT_VERSION, 'work': self.work})
        if not lines and head.startswith(torn):
            self._end = 0
            self._append(head)
            return self._end
        self._check_head(lines[0] if lines else torn, head)
        for line in lines[1:]:
            self._keep(line)
        end = sum(len(line) + 1 for line in lines)
        if torn:
            self.dropped += 1
            os.ftruncate(self._file, end)
        return end

    def _check_head(self, found: bytes, wanted: bytes) -> None:
        if found + b'\n' == wanted:
            return
        try:
            head = _content(found)
        except ValueError:
            head = {}
        if not isinstance(head, dict) or head.get('format') != FORMAT:
            raise SurfaceError(
                f'{self.path}: not a store of results, `ballscrew surface clean {self._out}` '
                'removes it'
            )
        raise SurfaceError(
            f'{self.path}: results of {head.get("work")}, format {head.get("version")}, this '
            f'program makes {self.work}, format {FORMAT_VERSION}; '
            f'`ballscrew surface clean {self._out}` removes them'
        )

    def _keep(self, line: bytes) -> None:
        """Keep the result of a line, unless it is torn."""
        try:
            key, packed = _content(line)
            self._results[key] = _unpack(packed)
        except (ValueError, TypeError):
            self.dropped += 1

    def _append(self, line: bytes) -> None:
        """Write a line at the end and flush it; on failure the file is as it was."""
        try:
            written = os.pwrite(self._file, line, self._end)
            if written < len(line):
                written += os.pwrite(self._file, line[written:], self._end + written)
            os.fsync(self._file)
        except OSError as error:
            os.ftruncate(self._file, self._end)
            raise SurfaceError(
                f'{self.path}: a result cannot be written, {error.strerror}; '
                f'{len(self)} results are kept'
            ) from None
        self._end += len(line)


def _line(content: Any) -> bytes:
    text = canonical_json(content)
    return f'{hashlib.sha256(text).hexdigest()[:CHECKSUM]} '.encode() + text + b'\n'


def _content(line: bytes) -> Any:
    """Return what a line says; raises ValueError for a torn one."""
    checksum, _, text = line.partition(b' ')
    if hashlib.sha256(text).hexdigest()[:CHECKSUM].encode() != checksum:
        raise ValueError('torn line')
    return json.loads(text)


def _pack(value: Any) -> Any:
    """Return plain JSON with every float in hexadecimal; TypeError for anything but plain JSON."""
    if isinstance(value, float):
        return {FLOAT: value.hex()}
    if isinstance(value, Mapping):
        if not all(isinstance(key, str) and not key.startswith('$') for key in value):
            raise TypeError(f'keys of a result are words without $, got {list(value)}')
        return {key: _pack(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        if value and all(isinstance(part, float) for part in value):
            return {FLOATS: ' '.join(part.hex() for part in value)}
        return [_pack(part) for part in value]
    if value is None or isinstance(value, str | int):
        return value
    raise TypeError(f'a result is plain JSON, got {type(value).__name__}')


def _unpack(value: Any) -> Any:
    if isinstance(value, dict):
        if FLOAT in value:
            return float.fromhex(value[FLOAT])
        if FLOATS in value:
            return [float.fromhex(part) for part in value[FLOATS].split()]
        return {key: _unpack(part) for key, part in value.items()}
    return [_unpack(part) for part in value] if isinstance(value, list) else value
