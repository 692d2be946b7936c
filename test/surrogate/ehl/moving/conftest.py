# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A circular contact on a coarse grid whose waves cost seconds, not minutes."""

import numpy as np
import pytest
from surrogate.ehl.moving import march_contact, MarchSettings


@pytest.fixture(scope='session')
def circular(moes_case):
    """March the circular contact M = 100, L = 10 over one place of a raceway."""
    contact, oil, condition, _ = moes_case(100, 10, 'roelands_dh')

    def march(raceway, transits=1.0, **settings):
        known = {'nx': 65, 'ny': 33, 'places': 1, 'film_floor': 1e-10, **settings}
        return march_contact(
            contact, oil, condition, raceway, transits=transits, settings=MarchSettings(**known)
        )

    return march


@pytest.fixture(scope='session')
def smooth_march(circular):
    """March it over a raceway without roughness."""
    return circular(lambda x, y: 0 * x * y)


@pytest.fixture(scope='session')
def semi_axis(smooth_march):
    """Return the semi-axis of that contact [m]."""
    return float(smooth_march.x_nodes[-1] / smooth_march.x[-1])


@pytest.fixture
def transverse():
    """Return a raceway of one transverse wave: amplitude and wavelength [m]."""

    def wave(amplitude, length):
        return lambda x, y: amplitude * np.cos(2 * np.pi * x / length) + 0 * y

    return wave
