# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Interface of every rough raceway to a contact, and the patch that a contact sees.

A patch is levelled over a window about the contact centre and scaled once, whatever load, speed,
grid or domain looks at it. Heights are positive out of the material.

"""

from dataclasses import dataclass, replace
import logging
import math
from typing import Any, ClassVar, get_args, Literal, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.files import InputError

Array = NDArray[np.float64]
Patch = Literal['rescaled', 'cut']
Plane = tuple[float, float, float]

SAMPLES_PER_WAVE, FEWEST_SAMPLES = 4, 41
"""Points per shortest wavelength, and in all along a side, when a patch is levelled [-]."""
FLAT = 1e-12
"""Rms height that counts as none [m]."""
LOG = logging.getLogger(__name__)


class Raceway(Protocol):
    """
    What a contact needs of a rough surface, fractal or measured: heights in metres anywhere.

    Heights are those of the raw surface less `plane` (offset [m], slopes [-]), times `scale` [-],
    the factor of the rescaling, 1 for a patch as it was cut. `patch` is None before one was taken.

    """

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def plane(self) -> Plane:
        """Return the mean plane: offset [m] and slopes [-]."""

    @property
    def scale(self) -> float:
        """Return the factor of the rescaling [-]."""

    @property
    def patch(self) -> Patch | None:
        """Return the kind of the patch."""

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength that the surface holds [m]."""

    def heights(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return heights [m], shape (nx, ny), on the grid of `x` and `y` [m] (see `grid_axes`)."""


AnyRaceway = TypeVar('AnyRaceway', bound=Raceway)


@dataclass(frozen=True, kw_only=True, slots=True)
class Window:
    """Rectangle about the contact centre where a patch is levelled and scaled, sides [m]."""

    length_x: float
    length_y: float

    def __post_init__(self) -> None:
        for name in ('length_x', 'length_y'):
            if not 0 < getattr(self, name) < math.inf:
                raise InputError(
                    f'window: {name} is {getattr(self, name):g} m, allowed is above 0'
                )


def take_patch(surface: AnyRaceway, kind: Patch, window: Window, rms: float) -> AnyRaceway:
    """
    Return the surface as a contact sees it, levelled over `window`.

    `rescaled`: scaled once to `rms` [m] over the window, as the published study has it. `cut`: at
    the height that it has. The window belongs to the draw: take a patch once, never per load. The
    factor is kept in `scale` [-] and logged.

    """
    if kind not in get_args(Patch):
        raise InputError(f'patch is {kind!r}, allowed is rescaled or cut')
    plane, found = _level(replace(surface, plane=(0.0, 0.0, 0.0), scale=1.0), window)
    if not found > FLAT:
        raise InputError('roughness: the surface is flat over the window of the patch')
    scale = rms / found if kind == 'rescaled' else 1.0
    LOG.info(
        'patch %s: rms %.4g um over %.4g x %.4g mm, times %.4g',
        kind,
        1e6 * found,
        1e3 * window.length_x,
        1e3 * window.length_y,
        scale,
    )
    return replace(surface, plane=plane, scale=scale, patch=kind)


def _level(surface: Raceway, window: Window) -> tuple[Plane, float]:
    """Return the mean plane of a surface over the window and its rms height [m] above it."""
    x, y = (
        np.linspace(-side / 2, side / 2, _samples(side / surface.shortest_wavelength))
        for side in (window.length_x, window.length_y)
    )
    heights = surface.heights(x, y)
    plane = (
        float(heights.mean()),
        float((x @ heights.mean(axis=1)) / (x @ x)),
        float((y @ heights.mean(axis=0)) / (y @ y)),
    )
    return plane, float(np.std(heights - on_plane(plane, x, y)))


def _samples(waves: float) -> int:
    return max(FEWEST_SAMPLES, SAMPLES_PER_WAVE * math.ceil(waves) + 1)


def grid_axes(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Return the axes of a grid from axes, or from the two arrays of a grid, first index x."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    return np.atleast_1d(x[:, 0] if x.ndim == 2 else x), np.atleast_1d(y[0] if y.ndim == 2 else y)


def on_plane(plane: Plane, x: Array, y: Array) -> Array:
    """Return the heights of a plane [m] on the grid of `x` and `y` [m]."""
    return np.asarray(plane[0] + plane[1] * x[:, None] + plane[2] * y[None, :])
