# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The tiers of a surface: what builds one, and what solves a point to check it.

A tier is a line of `TIERS`. Its functions are named and not imported, because a tier that is not
asked for must not cost the start of a command.

"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from surrogate.files import InputError
from surrogate.parameters import BallRoughness, Lubricant, Material, Roughness, Screw
from surrogate.progress import OnProgress
from surrogate.surface.file import SurfaceData
from surrogate.surface.solved import SolvedPoint
from surrogate.tasks.pool import Pool


@dataclass(frozen=True, kw_only=True, slots=True)
class Tier:
    """
    Names of the functions of a tier, each `module:function`.

    `settings(screw)` returns default settings, a dataclass with `speed_range` [rad/s],
    `load_range` [N] and `temperature_range` [K]. `build(screw, lubricant, settings, progress=...)`
    returns SurfaceData; with `spreads` the builder spreads its own solves over workers and is
    called `build(screw, lubricant, settings, pool=..., out=..., march=...)`, `out` being the file
    beside which it keeps its results; with `march` it marches strips of the raceway as well.
    `solve(header, speed, load, temperature)` solves a point [rad/s, N, K] as the surface of that
    header was solved, and returns a `SolvedPoint`.

    """

    settings: str
    build: str
    solve: str
    spreads: bool = False


TIERS = {
    'closed_form': Tier(
        settings='surrogate.builder.closed_form:default_settings',
        build='surrogate.builder.closed_form:build_closed_form',
        solve='surrogate.builder.closed_form:solve_closed_form',
    ),
    'full': Tier(
        settings='surrogate.builder.full.settings:default_full_settings',
        build='surrogate.builder.full.tier:build_full_surface',
        solve='surrogate.builder.full.tier:solve_full',
        spreads=True,
    ),
}


BLOCKS = {
    'raceway': Material,
    'ball': Material,
    'roughness': Roughness,
    'ball_roughness': BallRoughness,
}
"""Blocks of the datasheet of a screw."""


def find_tier(name: str) -> Tier:
    """Return a tier; raises InputError that lists those there are."""
    if name not in TIERS:
        raise InputError(f'tier is {name!r}, allowed is {" or ".join(TIERS)}')
    return TIERS[name]


def default_settings(tier: str, screw: Screw, changes: Mapping[str, Any]) -> Any:
    """Return the default settings of a tier with some of them (SI) changed."""
    from dataclasses import replace

    return replace(load_function(find_tier(tier).settings)(screw), **changes)


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
    """Build a surface by the builder of its tier; raises InputError as that does."""
    found = find_tier(tier)
    options: dict[str, Any] = {'progress': progress}
    if found.spreads:
        options = {'pool': pool, 'out': out, 'march': march}
    data: SurfaceData = load_function(found.build)(screw, lubricant, settings, **options)
    return data


def solve_point(
    header: Mapping[str, Any], speed: float, load: float, temperature: float
) -> SolvedPoint:
    """Solve at speed [rad/s], opposing load [N], temperature [K] by the tier of a header."""
    solve = load_function(find_tier(header['tier']).solve)
    found: SolvedPoint = solve(header, speed, load, temperature)
    return found


def screw_and_oil(inputs: Mapping[str, Any]) -> tuple[Screw, Lubricant]:
    """
    Rebuild the datasheets from the `inputs` of a header, so that a file needs no other.

    Raises InputError if these are not all values of both.

    """
    try:
        screw, lubricant = (dict(inputs[kind]) for kind in ('screw', 'lubricant'))
        for name, cls in BLOCKS.items():
            if screw[name] is not None:
                screw[name] = cls(**screw[name])
        return Screw(**screw), Lubricant(**lubricant)
    except (KeyError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(
            f'the header of the surface states no whole screw and oil ({error}): build the '
            'surface again'
        ) from None


def load_function(name: str) -> Callable[..., Any]:
    """Import and return a function by its name, `module:function`."""
    module, _, function = name.partition(':')
    found: Callable[..., Any] = getattr(import_module(module), function)
    return found
