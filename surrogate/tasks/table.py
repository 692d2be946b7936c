# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables of results: frozen dataclasses as lines of a CSV, an output that is written whole."""

from collections.abc import Callable, Iterable
import csv
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, get_type_hints, TypeVar

from surrogate.files import InputError, new_file

Row = TypeVar('Row')
KINDS: dict[Any, Callable[[str], Any]] = {bool: lambda word: word == 'True'}
"""How words become values, where the type itself does not say."""


def read_table(path: Path, kind: type[Row]) -> list[Row]:
    """
    Return the rows of a table; an absent table has no rows.

    Columns that are missing keep their defaults. Raises InputError for anything else.

    """
    kinds = {name: KINDS.get(column, column) for name, column in get_type_hints(kind).items()}
    try:
        with path.open(newline='', encoding='utf-8') as file:
            return [
                kind(**{name: kinds[name](line[name]) for name in kinds if name in line})
                for line in csv.DictReader(file)
            ]
    except FileNotFoundError:
        return []
    except (OSError, UnicodeDecodeError, ValueError, TypeError, csv.Error) as error:
        raise InputError(f'{path}: cannot be read as a table of results, {error}') from None


def write_table(path: Path, kind: Any, rows: Iterable[Any], digits: int | None = None) -> None:
    """Write rows of a `kind`, floats to some digits or all; what was there stays until then."""
    with new_file(path) as partial, partial.open('w', newline='', encoding='utf-8') as file:
        names = [column.name for column in fields(kind)]
        writer = csv.DictWriter(file, names, lineterminator='\n')
        writer.writeheader()
        writer.writerows(_shown(row, digits) for row in rows)


def _shown(row: Any, digits: int | None) -> dict[str, Any]:
    if digits is None:
        return asdict(row)
    return {
        name: f'{value:.{digits}g}' if isinstance(value, float) else value
        for name, value in asdict(row).items()
    }
