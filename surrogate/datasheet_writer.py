# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Datasheets written back to YAML: the keys, units and blocks from which they are read."""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
import textwrap
from typing import Any

from surrogate.files import InputError, replace_file
from surrogate.files.datasheet import key_of
from surrogate.parameters import Lubricant, Screw
import yaml

DIGITS = 12
"""Digits of a number on file, few enough to hide the rounding of a change of unit."""
WIDTH = 99


def write_sheet(
    path: str | Path,
    sheet: Screw | Lubricant,
    comments: Sequence[str] = (),
    notes: Mapping[str, str] | None = None,
) -> None:
    """
    Write a datasheet whole or not at all, under lines of comment.

    `notes` stand behind values, by the key on file; one in a block is `roughness.rms_um`.

    Reading it gives `sheet` to twelve digits. Raises InputError when it cannot be written.

    """
    path = Path(path)
    head = [
        line
        for text in comments
        for line in textwrap.wrap(text, WIDTH - 2, break_on_hyphens=False)
    ]
    body = yaml.safe_dump(_on_file(sheet), sort_keys=False, allow_unicode=True, width=WIDTH)
    lines, block = [f'# {line}' for line in head], ''
    for line in body.splitlines():
        key = line.partition(':')[0]
        name = f'{block}.{key.strip()}' if line.startswith(' ') else key
        block = block if line.startswith(' ') else key
        lines.append(f'{line}  # {notes[name]}' if notes and name in notes else line)
    text = ''.join(f'{line}\n' for line in lines)
    try:
        replace_file(path, text.encode())
    except OSError as error:
        raise InputError(f'{path}: the datasheet cannot be written, {error.strerror}') from None


def _on_file(sheet: Any) -> dict[str, Any]:
    """Return the keys on file with their values in the units on file."""
    content = {}
    for spec in fields(sheet):
        value, rules = getattr(sheet, spec.name), spec.metadata
        if value is None:
            continue  # absent on file
        if 'block' in rules:
            value = _on_file(value)
        elif 'factor' in rules and not rules.get('whole'):
            value = float(f'{value / rules["factor"] - rules["shift"]:.{DIGITS}g}')
        content[key_of(spec)] = value
    return content
