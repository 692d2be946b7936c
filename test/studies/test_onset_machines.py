# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Synthetic machines of the study, whose contacts follow marches outside the fit."""

import numpy as np
import pytest
from surrogate.asperities.law import FILM_POWER


@pytest.fixture(scope='module', name='machines')
def load_machines(study):
    return study('onset_machines')


@pytest.fixture(scope='module')
def rows(machines):
    return list(machines.rows_of('staircase', machines.SPEEDS, range(6)))


def test_the_factor_of_machines_outside_the_fit_is_told(rows, machines):
    """Six strips, each with a seal, a ripple, noise and an oil that warms up."""
    assert len({row['march'] for row in rows}) == 6
    off = [row['onset_factor_found'] / row['onset_factor'] for row in rows]
    assert sum(1 / machines.WITHIN < one < machines.WITHIN for one in off) >= 5
    held = [
        row['onset_factor_low'] < row['onset_factor'] < row['onset_factor_high'] for row in rows
    ]
    assert sum(held) >= 5


def test_a_machine_touches_as_its_march_does(machines):
    """RCS at the onset, at half and at a quarter of its speed."""
    march = machines.held_out()[0]
    law = machines.MachineLaw(onsets={}, deviation=0.1, march=march)
    marched = [0.01, float(march['rcs_half']), float(march['rcs_quarter'])]
    np.testing.assert_allclose(law._rcs(FILM_POWER * np.log([1.0, 0.5, 0.25])), marched, rtol=1e-6)
