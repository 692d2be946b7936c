# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Output of commands: a page for people, or JSON for programs."""

import argparse
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
import sys
from typing import Any, TypeVar

from surrogate.files import InputError, json_text, printable

Record = TypeVar('Record', bound=Mapping[str, Any])


def add_json(parser: argparse.ArgumentParser) -> None:
    """Add the option that asks for JSON."""
    parser.add_argument('--json', action='store_true', help='print JSON in SI units')


def show(record: Record, page: Callable[[Record], str], *, json: bool) -> None:
    """Print a record as JSON in SI units, or the page of it."""
    print(json_text(record) if json else printable(page(record)))


def tell(sentences: Iterable[str]) -> None:
    """Print what a person should look at again, beside the output."""
    for sentence in sentences:
        print(printable(f'ballscrew: {sentence}'), file=sys.stderr)


def draw_into(folder: Path, draw: Callable[[Path], Iterable[Path]]) -> None:
    """Draw into a folder, made where it is missing, and print the paths; raises InputError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path in draw(folder):
            print(path, file=sys.stderr)
    except OSError as error:
        raise InputError(f'--plot: {folder} cannot be written, {error.strerror}') from None
