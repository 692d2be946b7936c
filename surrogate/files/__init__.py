# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files for every folder: bad input in a sentence, complete files, strict JSON, shown texts."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import takewhile
import json
import math
import os
from pathlib import Path
import tempfile
from typing import Any

CONTROLS = {
    code: f'\\x{code:02x}' for code in (*range(32), *range(127, 160)) if chr(code) not in '\n\t'
}


class InputError(ValueError):
    """One sentence about an input: what, where, value, unit, allowed."""


@contextmanager
def new_folder(path: str | Path) -> Iterator[Path]:
    """
    Make a folder and those above it, and yield it; raises OSError.

    When the block raises, those among them that are empty are taken away again.

    """
    path = Path(path)
    missing = list(takewhile(lambda folder: not folder.exists(), (path, *path.parents)))
    path.mkdir(parents=True, exist_ok=True)
    try:
        yield path
    except BaseException:
        with suppress(OSError):  # the first that is not empty, or gone already
            for folder in missing:
                folder.rmdir()
        raise


@contextmanager
def new_file(path: str | Path) -> Iterator[Path]:
    """
    Yield a path to write to, which takes the place of `path` when the block ends.

    Its directory is made, as by `new_folder`. Raises OSError when it cannot be written, or `path`
    is something else than a regular file; then, and when the block raises, what was there before
    is as it was and nothing half-written stays.

    """
    path = Path(path)
    if path.exists() and not path.is_file():
        raise OSError(0, 'it is not a regular file', str(path))
    with new_folder(path.parent) as folder:
        number, name = tempfile.mkstemp(dir=folder, prefix=f'.{path.stem}.', suffix=path.suffix)
        temporary = Path(name)
        try:
            os.close(number)
            yield temporary
            with temporary.open('rb') as file:
                os.fsync(file.fileno())
            temporary.chmod(0o644)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)


def replace_file(path: str | Path, content: bytes) -> None:
    """Write `content` to `path` as `new_file` does."""
    with new_file(path) as temporary:
        temporary.write_bytes(content)


def printable(text: str) -> str:
    """Return a text whose control characters do nothing to a terminal; lines and tabs stay."""
    return text.translate(CONTROLS)


def to_json(record: Any) -> Any:
    """Return `record` with every number that is not finite as None, which JSON calls null."""
    if isinstance(record, float):
        return record if math.isfinite(record) else None
    if isinstance(record, list):
        return [to_json(value) for value in record]
    if isinstance(record, Mapping):  # last: to tell an abstract class takes longest
        return {key: to_json(value) for key, value in record.items()}
    return record


def json_text(record: Any) -> str:
    """Return a record as strict JSON for people, its numbers that are not finite as null."""
    return json.dumps(to_json(record), indent=2, allow_nan=False)


def canonical_json(content: Any) -> bytes:
    """Return JSON that is the same whenever the content is; raises ValueError for NaN."""
    return json.dumps(content, sort_keys=True, separators=(',', ':'), allow_nan=False).encode()
