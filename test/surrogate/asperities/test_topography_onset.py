# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset by the topography: limits, order and scaling."""

import math

import pytest
from surrogate.asperities.running_in import RunningContact
from surrogate.asperities.topography_onset import film_at_onset, onset_of
from surrogate.ehl import ContactLubricant
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.load_sharing import normal_force
from surrogate.screw.screw_onset import with_raceway

FLOOR = 3e-9
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)


@pytest.fixture(scope='module')
def place(screw):
    """Return contact and force on the screw side under the preload."""
    return screw_contact(screw, 'screw'), float(normal_force(screw, screw.preload))


@pytest.fixture(scope='module')
def new(screw):
    return onset_of(RunningContact.of(screw, 'screw'))


def test_smooth_raceways_have_no_onset_and_others_one_over_the_viscosity(screw, place, new):
    smooth = with_raceway(screw, rms=0.0)
    assert onset_of(RunningContact.of(smooth, 'screw')).speed(*place, OIL, FLOOR) == 0.0
    assert film_at_onset(1e-12, FLOOR, 1e9) == FLOOR
    assert film_at_onset(1e-5, FLOOR, 1e9) > FLOOR
    thick, thin = (
        new.speed(*place, ContactLubricant(viscosity=eta, pressure_viscosity=2e-8), FLOOR)
        for eta in (0.2, 0.02)
    )
    assert thin / thick == pytest.approx(10.0, rel=2e-3)


def test_softer_summits_touch_at_slower_and_rougher_ones_at_faster_speeds(screw, place, new):
    run = onset_of(RunningContact.of(with_raceway(screw, state='run_in'), 'screw')).speed(
        *place, OIL, FLOOR
    )
    assert 0.2 < run / new.speed(*place, OIL, FLOOR) < 0.6
    rough = with_raceway(screw, rms=0.18e-6)
    faster = onset_of(RunningContact.of(rough, 'screw')).speed(*place, OIL, FLOOR)
    assert faster > 1.3 * new.speed(*place, OIL, FLOOR)


@pytest.mark.parametrize(('floor', 'sign'), [(1e-9, -1), (5e-9, 1)])
def test_a_thicker_boundary_film_touches_at_faster_speeds(new, place, floor, sign):
    usual, other = (new.speed(*place, OIL, one) for one in (FLOOR, floor))
    assert sign * math.log(other / usual) > 0.1
