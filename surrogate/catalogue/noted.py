# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Values of a sheet with the note that stands behind them: given, derived, or typical."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from surrogate.files.datasheet import key_of

Sheet = TypeVar('Sheet')
DIGITS = 4
"""Digits of a derived number: no catalogue states more."""


@dataclass(frozen=True, slots=True)
class Noted:
    """Value in SI and its note."""

    value: Any
    note: str


def derived(value: float, how: str) -> Noted:
    """Return a value that follows from others, to four digits."""
    return Noted(float(f'{value:.{DIGITS}g}'), f'derived ({how})')


def typical(value: Any, words: str) -> Noted:
    """Return a usual value with the words of its range and source."""
    return Noted(value, f'typical ({words})')


def stated(value: Any, otherwise: Noted) -> Noted:
    """Return a value as given, or what stands for it."""
    return otherwise if value is None else Noted(value, 'given')


def noted_sheet(cls: type[Sheet], values: Mapping[str, Any]) -> tuple[Sheet, dict[str, str]]:
    """
    Return a sheet and its notes by the keys on file; blocks are mappings of their own.

    What is not named is the default of the declaration.

    """
    arguments, notes = {}, dict[str, str]()
    for spec in fields(cls):  # type: ignore[arg-type]
        entry = values.get(spec.name)
        if isinstance(entry, Mapping):
            entry, inner = noted_sheet(spec.metadata['block'], entry)
            notes |= {f'{key_of(spec)}.{key}': note for key, note in inner.items()}
        elif entry is None:
            entry = spec.default
        elif isinstance(entry, Noted):
            notes[key_of(spec)] = entry.note
            entry = entry.value
        arguments[spec.name] = entry
    return cls(**arguments), notes
