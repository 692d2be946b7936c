# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The raceway of the published study: its generator and constants, rescaled over a window."""

from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.formulas.load_sharing import normal_force, UNLOADING_RATIO
from surrogate.parameters import Screw
from surrogate.raceway.fractal import fractal_surface, FractalSurface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window

WINDOW_SHARE = 0.05
"""Least axial load whose Hertz rectangle is the window of the patch, over the rating [-]."""
PUBLISHED = PublishedRoughness()
"""Constants of the study."""


def published_patch(screw: Screw, draw: int) -> FractalSurface:
    """
    Return one draw of the published raceway, rescaled once over a window that no load moves.

    The window is the Hertz rectangle on the screw side under the load that relieves the other nut,
    or under `WINDOW_SHARE` of the static rating where that is larger.

    """
    force = max(UNLOADING_RATIO * screw.preload, WINDOW_SHARE * screw.static_rating)
    ellipse = hertz(screw_contact(screw, 'screw'), float(normal_force(screw, force)))
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    return take_patch(fractal_surface(PUBLISHED, draw), 'rescaled', window, PUBLISHED.rms)
