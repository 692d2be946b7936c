# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Synthetic machines of the study, whose contacts follow marches outside the fit."""

import numpy as np
import pytest
from surrogate.asperities.law import FILM_POWER
from surrogate.identify.onset import WIDEST


@pytest.fixture(scope='module', name='machines')
def load_machines(study):
    return study('onset_machines')


@pytest.fixture(scope='module')
def rows(machines):
    return list(machines.rows_of('steady', machines.SPEEDS, range(6)))


def test_what_is_stated_of_machines_outside_the_fit_holds(rows):
    """Six strips, each with a seal, a ripple, noise and an oil that warms up; half are told."""
    assert len({row['march'] for row in rows}) == 6
    closed = [row for row in rows if not row['onset_factor_reason']]
    assert len(closed) >= 3
    held = [
        row['onset_factor_low'] < row['onset_factor'] < row['onset_factor_high'] for row in closed
    ]
    assert sum(held) >= len(held) - 1
    for row in rows:
        least = row['onset_factor_reason'].partition('at least ')[2]
        most = row['onset_factor_reason'].partition('at most ')[2]
        assert not least or row['onset_factor'] > float(least.split()[0])
        assert not most or row['onset_factor'] < float(most.split()[0])
    off = [row['onset_factor_found'] / row['onset_factor'] for row in closed]
    assert max(off) < WIDEST
    assert min(off) > 1 / WIDEST


def test_drag_beside_the_contacts_is_two_to_eight_times_theirs(rows, machines):
    """By the mean torque of the nominal contacts, from which those of a machine differ by 1.5."""
    contacts = machines.closed_form.solve(
        machines.OPENED, machines.OIL, machines.SPEEDS * machines.RPM, 0.0, machines.WARM
    ).friction_torque.mean()
    over = [row['parasitic_torque'] / contacts for row in rows]
    assert min(over) > 2 / 1.5
    assert 4 < max(over) < 8 * 1.5


def test_a_machine_touches_as_its_march_does(machines):
    """RCS at the onset, at half and at a quarter of its speed."""
    march = machines.held_out()[0]
    law = machines.MachineLaw(onsets={}, deviation=0.1, march=march)
    marched = [0.01, float(march['rcs_half']), float(march['rcs_quarter'])]
    np.testing.assert_allclose(law._rcs(FILM_POWER * np.log([1.0, 0.5, 0.25])), marched, rtol=1e-6)
