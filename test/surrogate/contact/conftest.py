# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A small circular contact with roughness that rolls, marched once for all tests."""

from dataclasses import replace

import pytest
from surrogate.contact.case import CaseGrid, CaseRoughness, load_case
from surrogate.contact.rolling import march_case
from surrogate.parameters import DATA
import yaml


@pytest.fixture(scope='session')
def rolling_case():
    """Return a circular case of few nodes and long waves, rough enough to puncture its film."""
    return replace(
        load_case('circular_m20_l10'),
        domain=None,
        entrainment_speed=0.1,
        grid=CaseGrid(nx=65, ny=33),
        kinematics='rolling',
        transits=2.0,
        places=2,
        roughness=CaseRoughness(
            patch='standard',
            rms=0.1e-6,
            cutoff_long=0.08e-3,
            fractal_dimension=2.3,
            shortest_wavelength=20e-6,
            seed=3,
        ),
    )


@pytest.fixture
def load(tmp_path):
    """Return the function that loads the nominal smooth case with `keys` of its file changed."""
    content = yaml.safe_load((DATA / 'cases' / 'nominal_smooth.yaml').read_text(encoding='utf-8'))

    def loaded(**keys):
        path = tmp_path / 'case.yaml'
        path.write_text(yaml.safe_dump(content | keys), encoding='utf-8')
        return load_case(str(path))

    return loaded


@pytest.fixture(scope='session')
def marched(rolling_case):
    """Return its averages and the surface that rolled."""
    return march_case(rolling_case)
