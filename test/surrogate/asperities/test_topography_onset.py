# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset by the topography: limits, order and scaling."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.running_in import RunningContact
from surrogate.asperities.topography import WAVE_POWER
from surrogate.asperities.topography_onset import COARSE_FILM, film_at_onset, FLOORS, onset_of
from surrogate.ehl import ContactLubricant
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.line import central_film_line, line_at, moes_line
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
    thick, thin = (
        new.speed(*place, ContactLubricant(viscosity=eta, pressure_viscosity=2e-8), FLOOR)
        for eta in (0.2, 0.02)
    )
    assert thin / thick == pytest.approx(10.0, rel=2e-3)


def test_the_film_at_the_onset_is_so_many_floors_as_roughness_vanishes_and_scales():
    """All lengths times s, heights s^(1 - beta) with them, under one pressure: films times s."""
    heights = np.geomspace(1e-12, 1e-5, 40)
    films = film_at_onset(heights, FLOOR, 0.9e9)
    assert (np.diff(films) > 0).all()
    assert films[0] == pytest.approx(COARSE_FILM * FLOORS * FLOOR, rel=1e-3)
    assert (films > 2.5 * FLOOR).all()
    larger = film_at_onset(3 ** (1 + WAVE_POWER) * heights, 3 * FLOOR, 0.9e9)
    assert larger == pytest.approx(3 * films)


def test_a_factor_in_film_is_amplified_in_speed_by_the_slope_there(place, new):
    """Roots of hc(u) = F told(u): the slope from films and heights around the root itself."""
    line = line_at(*place, 0.0)

    def spare(speed):
        M1, L = moes_line(line, speed, OIL.viscosity, OIL.pressure_viscosity)
        reduction = float(M1**0.75 / np.sqrt(L) / line.semi_axis)
        film = central_film_line(line, speed, OIL.viscosity, OIL.pressure_viscosity)
        height = new.acting.height(reduction, line.max_pressure)
        return math.log(film / film_at_onset(height, FLOOR, line.max_pressure))

    low, stated, high = (new.speed(*place, OIL, FLOOR, film=F) for F in (1 / 1.1, 1.0, 1.1))
    for speed, factor in ((low, 1 / 1.1), (stated, 1.0), (high, 1.1)):
        assert spare(speed) == pytest.approx(math.log(factor), abs=2e-3)
    assert low < stated / 1.1 < 1.1 * stated < high
    other = replace(new, film_factor=1.1)
    assert other.speed(*place, OIL, FLOOR) == pytest.approx(high)


def test_softer_summits_touch_at_slower_and_rougher_ones_at_faster_speeds(screw, place, new):
    run = onset_of(RunningContact.of(with_raceway(screw, state='run_in'), 'screw')).speed(
        *place, OIL, FLOOR
    )
    assert 0.5 < run / new.speed(*place, OIL, FLOOR) < 0.7
    rough = with_raceway(screw, rms=0.18e-6)
    faster = onset_of(RunningContact.of(rough, 'screw')).speed(*place, OIL, FLOOR)
    assert faster > 1.3 * new.speed(*place, OIL, FLOOR)


@pytest.mark.parametrize(('floor', 'sign'), [(1e-9, -1), (5e-9, 1)])
def test_a_thicker_boundary_film_touches_at_faster_speeds(new, place, floor, sign):
    usual, other = (new.speed(*place, OIL, one) for one in (FLOOR, floor))
    assert sign * math.log(other / usual) > 0.1
