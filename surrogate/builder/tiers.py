# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Surface and point by a tier: published formulas, or solved contacts.

Each function imports the builder that it calls, for commands that build nothing start without it.

"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw
from surrogate.surface.file import SurfaceData, TIERS
from surrogate.surface.solved import SolvedPoint
from surrogate.tasks.pool import Pool
from surrogate.tasks.progress import OnProgress


def check_tier(tier: str) -> None:
    """Raise InputError for an unknown tier, with those there are."""
    if tier not in TIERS:
        raise InputError(f'tier is {tier!r}, allowed is {" or ".join(TIERS)}')


def spreads(tier: str) -> bool:
    """Return True if a tier spreads the solves of a surface over workers; InputError."""
    check_tier(tier)
    return tier == 'full'


def default_settings(tier: str, screw: Screw, changes: Mapping[str, Any]) -> Any:
    """Return the default settings of a tier with some of them (SI) changed."""
    if spreads(tier):
        from surrogate.builder.full.settings import default_full_settings

        return replace(default_full_settings(screw), **changes)
    from surrogate.builder import closed_form

    return replace(closed_form.default_settings(screw), **changes)


def build_surface(
    tier: str,
    screw: Screw,
    lubricant: Lubricant,
    settings: Any,
    *,
    progress: OnProgress = lambda done, total: None,
    pool: Pool | None = None,
    out: str | Path = '',
    march: bool = False,
) -> SurfaceData:
    """
    Build a surface by the builder of its tier; raises InputError as that does.

    The full tier needs the `pool` of its workers and the file `out`, beside which it keeps its
    results; with `march` it marches strips of the raceway as well.

    """
    if spreads(tier):
        from surrogate.builder.full import tier as full

        assert pool is not None
        return full.build_full_surface(screw, lubricant, settings, pool=pool, out=out, march=march)
    from surrogate.builder.closed_form import build_closed_form

    return build_closed_form(screw, lubricant, settings, progress=progress)


def solve_point(
    header: Mapping[str, Any], speed: float, load: float, temperature: float
) -> SolvedPoint:
    """Solve at speed [rad/s], opposing load [N], temperature [K] by the tier of a header."""
    if spreads(header['tier']):
        from surrogate.builder.full import tier as full

        return full.solve_full(header, speed, load, temperature)
    from surrogate.builder.closed_form import solve_closed_form

    return solve_closed_form(header, speed, load, temperature)
