# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Paths of the surfaces that come with the package."""

from pathlib import Path

from surrogate.surface.file import SurfaceError, TIERS

SHIPPED_TIERS = ('full', 'closed_form')
"""Tiers of shipped surfaces, the one that is taken first coming first."""
PRELOAD_SHARES = (1.0, 0.8, 0.6, 0.4)
"""Parts of the preload for which companions of a surface are built [-]."""
SHIPPED = Path(__file__).parent.parent / 'data' / 'surfaces'


def find_surface(
    wanted: str | Path | None, screw: str = 'nominal', oil: str = 'iso_vg_68'
) -> Path:
    """
    Return the file that is wanted: a path, or a tier of those shipped; nothing means any tier.

    Raises SurfaceError when no such surface is shipped.

    """
    text = str(wanted or '')
    if text and text not in TIERS:
        return Path(text)
    return shipped_surface(screw, oil, text or None)


def shipped_surface(
    screw: str = 'nominal', oil: str = 'iso_vg_68', tier: str | None = None
) -> Path:
    """
    Return where the shipped surface of `screw` and `oil` lies.

    Without a tier, a surface of solved contacts comes first. Raises SurfaceError if no file fits.

    """
    for kind in SHIPPED_TIERS if tier is None else (tier,):
        ending = '' if kind == 'closed_form' else f'_{kind}'
        path = SHIPPED / f'{screw}_{oil}{ending}.npz'
        if path.is_file():
            return path
    shipped = ', '.join(sorted(file.stem for file in SHIPPED.glob('*.npz')))
    raise SurfaceError(
        f'no surface {f"of tier {tier} " if tier else ""}is shipped for screw {screw!r} and oil '
        f'{oil!r}, shipped are {shipped or "none"}'
    )


def companion_path(surface: Path, share: float) -> Path:
    """Return where the companion of a surface file at a `share` of its preload [-] lies."""
    return surface.with_name(f'{surface.stem}_preload{round(100 * share)}.npz')
