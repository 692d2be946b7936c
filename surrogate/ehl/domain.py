# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The domain of a contact that states none, and the nodes across it that a rough surface asks for.

A domain has room for inlet, outlet, sides and summits.

"""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.interface import Settings
from surrogate.ehl.scales import ScaledContact

Array = NDArray[np.float64]
RIGID = 1.5
"""Width of the pressure over the semi-axis from which bodies hardly deform [-]."""
FINEST, MOST_LINES, PLACES = 0.05, 60, 129
"""Least distance of lines on which summits are sought, over a semi-axis; most lines, places on one
[-]."""
WIDE = 1.6
"""Side of a domain over the semi-axis from which on its nodes may lie further apart [-]."""
NODES_PER_WAVE, MOST_NODES = 6.0, 513
"""Nodes per shortest wavelength of a rough grid, and most along a side for its sake [-]."""


def production_domain(scaled: ScaledContact, summit_reach: float) -> tuple[float, float, float]:
    """
    Return inlet, outlet and side over the semi-axes: with the open inlet, films within 0.3 %.

    `summit_reach`: how far outside the Hertz zone summits are sought, over the semi-axes [-].

    The pressure in front of the contact falls off over the inlet length of the film; across, the
    more slowly the rounder the contact. A rough contact needs room where its summits still reach
    the other surface, and its thin film less inlet. A film thicker than the height unit hardly
    deforms the bodies: the load falls off as 1/y^2 across, which no domain holds; films are about
    15 % low at 5 to 40 height units, more beyond.

    """
    speed = scaled.condition.entrainment_speed
    before, behind, beside = _summit_reaches(scaled, summit_reach)
    if not speed:
        return -max(1.4, 1 + before), max(1.4, 1 + behind), max(1.3, 1 + beside)
    reach = (6 * scaled.film_estimate(speed)) ** (2 / 3)
    thick = math.sqrt(2 * scaled.film_estimate(speed))
    rigid = max(0.0, thick - RIGID)
    side = min(0.08 * reach**2 + reach / scaled.ellipticity**2, 1.0 + 2.0 * thick)
    inlet = 2.1 if scaled.roughness is None else 1.75
    return (
        -max(inlet + min(0.9 * reach, 4.0 + 3.0 * thick) + 6.0 * rigid, 1 + before),
        max(1.25 + min(0.03 * reach**2, 0.9 * thick), 1 + behind),
        max(1.2 + side + 4.0 * rigid, 1 + beside),
    )


def nodes_on_waves(length: float, wave: float, per_wave: float = NODES_PER_WAVE) -> int:
    """
    Return the nodes [-] that a rough surface asks for along a `length` [m], an odd number.

    So many per shortest `wave` [m], up to `MOST_NODES`.

    """
    return min(2 * math.ceil(per_wave * length / wave / 2) + 1, MOST_NODES)


def nodes_at_multiples(settings: Settings, side: float, semi_axis: float) -> tuple[int, float]:
    """
    Return the nodes [-] across that `spacing` asks for, and the side [m], widened to the last one.

    A summit at the limit of contact touches or not by where the nodes lie on it. With nodes that
    move as the load does, RCS near 0.01 scatters by a tenth between neighbouring loads.

    """
    assert settings.spacing
    coarser = max(0, math.ceil(2 * math.log2(side / (WIDE * semi_axis))))
    finest = 2 * math.log2(2 * side / ((settings.ny - 1) * settings.spacing))
    distance = settings.spacing * math.sqrt(2) ** min(coarser, math.floor(finest))
    half = math.ceil(side / distance)
    return 2 * half + 1, half * distance


def _summit_reaches(scaled: ScaledContact, reach: float) -> tuple[float, float, float]:
    """
    Return how far summits touch before, behind and beside the Hertz zone, over the semi-axes [-].

    Heights given at the nodes come with a domain of their own: nothing is known of them outside.

    """
    if not callable(scaled.roughness):
        return 0.0, 0.0, 0.0
    out = np.linspace(0, reach, 1 + round(min(reach / FINEST, MOST_LINES)))
    across = np.linspace(-1.3, 1.3, PLACES)
    place = 1 + out
    # Dry gap beside a line contact, over a^2/Rx: the narrowest one along x.
    gap = (place * np.sqrt(place**2 - 1) - np.arccosh(place)) / 2
    before, behind = (
        _outermost(out, _heights(scaled, side * place, across), gap) for side in (-1, 1)
    )
    along = np.linspace(-1 - before, 1 + behind, PLACES)
    # Beside a circular contact, over b^2/Ry: narrower than along y.
    unit = scaled.ellipticity**2 * scaled.contact.radius_x / scaled.contact.radius_y
    gap = unit * ((np.sqrt(place**2 - 1) - (2 - place**2) * np.arccos(1 / place)) / math.pi)
    beside = (_outermost(out, _heights(scaled, along, side * place).T, gap) for side in (-1, 1))
    return before, behind, max(beside)


def _heights(scaled: ScaledContact, x: Array, y: Array) -> Array:
    """Return the roughness at x and y, over the semi-axes, in Hertz units [-]."""
    assert callable(scaled.roughness)
    places = np.meshgrid(x * scaled.semi_axis_x, y * scaled.semi_axis_y, indexing='ij')
    return np.asarray(scaled.roughness(*places), dtype=float) / scaled.height_unit


def _outermost(out: Array, heights: Array, gap: Array) -> float:
    """Return the place just outside the last line on which a summit is higher than the gap."""
    touching = np.flatnonzero(heights.max(axis=1) > gap)
    return float(out[min(touching[-1] + 1, out.size - 1)]) if touching.size else 0.0
