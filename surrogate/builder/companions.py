# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Companions of a surface: the same screw and oil at parts of its preload, by formulas alone."""

from collections.abc import Iterator, Mapping
import dataclasses
from pathlib import Path
from typing import Any

from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw
from surrogate.surface import companion_path, PRELOAD_SHARES
from surrogate.surface.file import write


def build_companions(
    screw: Screw, lubricant: Lubricant, ranges: Mapping[str, Any], out: Path
) -> Iterator[Path]:
    """
    Write the companions of the surface file `out`, and yield the path of each.

    All of them cover what the surface covers: the `ranges` that were asked for (SI), and the
    defaults of the screw at its full preload. Raises InputError for a screw without preload.

    """
    if not screw.preload > 0.0:
        raise InputError(
            f'screw {screw.name}: preload_N is {screw.preload:g} N, --with-preloads needs a '
            'preload above 0 N'
        )
    settings = dataclasses.replace(default_settings(screw), **ranges)
    for share in PRELOAD_SHARES:
        part = dataclasses.replace(screw, preload=share * screw.preload)
        path = companion_path(out, share)
        write(path, build_closed_form(part, lubricant, settings))
        yield path
