# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Results of solves, kept while a surface is built, so that an interruption costs one solve at most.

A store beside the output, with a row for each result and a checksum of its own in it: SQLite
survives a kill, and notices no number that is damaged on the disk. Floats are written in full, so
that they come back bit for bit.

"""

from collections.abc import Mapping
import contextlib
import dataclasses
import hashlib
import json
from pathlib import Path
import sqlite3
import sys
from typing import Any, Self

from surrogate.files import canonical_json
from surrogate.files.store import (
    BAD,
    is_passing,
    OtherVersion,
    PARTS,
    readable,
    set_file_aside,
    Store,
    Table,
)
from surrogate.surface.file import SurfaceError
from surrogate.tasks.worker import plain_result

VERSION = 1
ENDING = '.store'
JOURNAL = 2**24
"""Size that the journal may keep [B]; the results themselves have no limit."""


@dataclasses.dataclass(frozen=True, slots=True)
class KeptResult:
    """The result of a task as a text of JSON, the solver with its version, and a checksum."""

    key: str
    work: str
    text: str
    checksum: str

    def check(self) -> None:
        """Raise ValueError for a result that is damaged."""
        if self.checksum != checksum_of(self.key, self.work, self.text):
            raise ValueError('damaged result')


RESULTS = Table(name='results', kind=KeptResult, key='key', check=KeptResult.check)


def checksum_of(*texts: str) -> str:
    """Return the checksum of some texts."""
    return hashlib.sha256(json.dumps(texts).encode()).hexdigest()


def store_path(out: str | Path) -> Path:
    """Return where the results of the surface `out` are kept."""
    return Path(f'{out}{ENDING}')


def task_key(work: str, inputs: Mapping[str, Any]) -> str:
    """
    Return the name of a task by its content: 64 hexadecimal digits.

    SHA-256 over canonical JSON of `work`, which names the solver and its version, and of the
    inputs, plain JSON with finite numbers. 1 and 1.0 are different inputs.

    """
    return hashlib.sha256(canonical_json([VERSION, work, inputs])).hexdigest()


def clear(out: str | Path) -> bool:
    """Remove the kept results of the surface `out`; return True if there were any."""
    path = store_path(out)
    try:
        path.unlink()
    except FileNotFoundError:
        return False
    except OSError as error:
        raise SurfaceError(f'{path}: cannot be removed, {error.strerror}') from None
    for part in PARTS[1:]:
        path.with_name(path.name + part).unlink(missing_ok=True)
    return True


class TaskStore:
    """
    Results of the tasks of one surface by their keys; open it with `with`.

    Another build of the same surface cannot open the file meanwhile.

    """

    def __init__(self, out: str | Path, work: str) -> None:
        """
        Open the results kept for the surface `out`, or begin with none.

        Of a damaged file those go on that can be read, and stderr says so. Raises SurfaceError,
        one sentence, for results of other `work`, in use by another process, or a file that is
        something else or cannot be written.

        """
        self.path = store_path(out)
        self.work, self._out = work, out
        self._store = Store(self.path, [RESULTS], version=VERSION, limit=16 * JOURNAL, alone=True)
        try:
            self._open()
        except BaseException:
            self._store.let_go()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._store.close()

    def __contains__(self, key: str) -> bool:
        return self.get(key) is not None

    def __len__(self) -> int:
        return int(self._store.database.execute('SELECT count(*) FROM results').fetchone()[0])

    def get(self, key: str) -> dict[str, Any] | None:
        """Return the result of a task, or None."""
        pairs = readable(RESULTS, self._store.rows(RESULTS, 'WHERE key = ?', [key]))
        return json.loads(pairs[0][1].text) if pairs else None

    def put(self, key: str, result: Mapping[str, Any]) -> None:
        """
        Keep the result of a task: plain JSON, in which floats may be of any value.

        When it returns, the result is on the disk. Raises SurfaceError when it cannot be written;
        the results before it stay.

        """
        text = json.dumps(plain_result(result))
        kept = KeptResult(key, self.work, text, checksum_of(key, self.work, text))
        try:
            with self._store.transaction():
                self._store.put(RESULTS, [kept])
        except sqlite3.Error as error:
            self._store.connect()
            raise SurfaceError(
                f'{self.path}: a result cannot be written, {error}; {len(self)} results are kept'
            ) from None

    def _open(self) -> None:
        clean = f'`ballscrew surface clean {self._out}` removes'
        try:
            self._store.connect()
        except BAD as error:
            code = getattr(error, 'sqlite_errorcode', sqlite3.SQLITE_ERROR) & 0xFF
            if code == sqlite3.SQLITE_BUSY:
                sentence = f'in use by another build of {self._out}'
            elif is_passing(error):
                sentence = f'cannot be written, {error}'
            elif code == sqlite3.SQLITE_NOTADB or isinstance(error, OtherVersion):
                sentence = f'not a store of results, {clean} it'
            else:
                # Damaged: it is set aside, and the results that can be read are kept.
                sound: list[KeptResult] = []
                with contextlib.suppress(sqlite3.Error):
                    for row in self._store.database.execute('SELECT * FROM results'):
                        kept = readable(RESULTS, [row])
                        sound += [result for _, result in kept if result.work == self.work]
                self._store.let_go()
                print(set_file_aside(self.path, error), file=sys.stderr)
                self._store.connect()
                with self._store.transaction():
                    self._store.put(RESULTS, sound)
                return
            raise SurfaceError(f'{self.path}: {sentence}') from None
        except OSError as error:
            raise SurfaceError(f'{self.path}: cannot be written, {error.strerror}') from None
        others = readable(RESULTS, self._store.rows(RESULTS, 'WHERE work != ?', [self.work]))
        if others:
            raise SurfaceError(
                f'{self.path}: results of {others[0][1].work}, this program makes {self.work}; '
                f'{clean} them'
            )
