# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset of contact by points: none moves it, oil is missing, or nothing tells of it."""

import dataclasses
import math
import random

from ballscrew_monitor.health.calibration import places_of
from ballscrew_monitor.health.change import change_between
from ballscrew_monitor.health.model import FILM_EXPONENT, Model
from ballscrew_monitor.health.onset import NAME, onset_note, onset_of, ran_of, UPTURN
from ballscrew_monitor.health.records import Place, Quantity
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.units import RPM

SPEEDS = 1.0, 3.0, 8.0, 14.0, 25.0, 50.0, 80.0
"""Speeds of the screw [rad/s]; contact begins at 33 rad/s in the surface of these tests."""
WARM, COLD = 313.0, 303.0


@pytest.fixture(scope='module')
def model(surface):
    return Model(surface)


@pytest.fixture(scope='module')
def days(motion, model):
    """Return what makes the points of days without a load; friction by points, else the model."""

    def make(friction=model.friction, *, first=0, speeds=SPEEDS, temperature=WARM, **changes):
        places = [
            motion.point(
                first_day=motion.today + first + day,
                place=Place(band, 0, 0, sign),
                speed=sign * speed,
                axial_load=0.0,
                temperature=temperature,
                residual=math.nan,
                torque_squares=4e-8,
                **changes,
            )
            for day in range(6)
            for band, speed in enumerate(speeds)
            for sign in (1, -1)
        ]
        return [
            dataclasses.replace(one, motor_torque=math.copysign(drag, one.speed))
            for one, drag in zip(places, friction(places))
        ]

    return make


def found(before, now, model):
    return onset_of(change_between(before, now, model), before, now, model, 'no reason')


def moved(model, ratio):
    """Return the friction of a model whose onset has moved by a ratio."""
    film = ratio**-FILM_EXPONENT
    return lambda points: model.friction(points) + model.starved(points, film)


def test_an_onset_that_stays_has_a_ratio_of_one(days, model):
    onset = found(days(), days(first=40), model)
    assert onset.value == pytest.approx(1.0, abs=1e-3)  # the vertex of a parabola
    assert 0.6 < onset.low < 1.0 < onset.high < 1.6
    assert onset.evidence == '14 places at low speed, 8 of them where friction turns up'


@given(ratio=st.floats(0.5, 2.5))
def test_a_ratio_that_is_planted_is_found(days, model, ratio):
    onset = found(days(), days(moved(model, ratio), first=40), model)
    assert onset.value == pytest.approx(ratio, rel=0.02)
    assert onset.low <= ratio <= onset.high


@pytest.mark.parametrize('ratio', [1.0, 1.5])
@pytest.mark.parametrize('temperature', [COLD, WARM])
def test_another_friction_at_all_speeds_moves_no_onset(days, model, ratio, temperature):
    """A wiper of a tenth of the friction and a factor beside it, on days of another warmth."""
    shifted = moved(model, ratio)
    now = days(lambda one: 0.008 + 0.9 * shifted(one), first=40, temperature=temperature)
    onset = found(days(), now, model)
    assert onset.low <= ratio <= onset.high
    assert onset.value == pytest.approx(ratio, rel=0.15)


@pytest.fixture(scope='module')
def closed_form_at():
    """Return what gives the friction at points with a film that an oil may be missing for."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')

    def of_film(film):
        starved = dataclasses.replace(oil, film_factor=film)

        def friction(points):
            places = places_of(points).T
            return closed_form.solve(Contacts.of(screw), starved, *places).friction_torque

        return friction

    return of_film


@pytest.mark.parametrize('ratio', [0.7, 1.0, 1.5])
@pytest.mark.parametrize('film', [0.8, 1.0])
def test_a_film_that_gets_thinner_by_the_closed_form_moves_the_onset(
    days, model, closed_form_at, film, ratio
):
    """The closed form stands in for a machine, which may not be flooded in its baseline."""
    films = film * min(1.0, ratio**FILM_EXPONENT), film * min(1.0, ratio**-FILM_EXPONENT)
    before, now = (days(closed_form_at(one), first=40 * at) for at, one in enumerate(films))
    onset = found(before, now, model)
    assert onset.low <= ratio <= onset.high < 2.5 * onset.low
    assert (onset.low > 1.0) == (ratio > 1.0)
    assert (onset.high < 1.0) == (ratio < 1.0)


def test_without_low_speeds_it_is_not_known_and_the_speed_is_said(days, model, says):
    fast = [speed for speed in SPEEDS if speed > 20.0]
    slow = UPTURN * model.surface.onset_speed(0.0, WARM) / RPM
    reason = found(days(speeds=fast), days(first=40, speeds=fast), model).reason
    assert reason == says('few', slow=f'{slow:.3g}', far=f'{6 * slow:.3g}')
    few = SPEEDS[:1]
    assert found(days(speeds=few), days(first=40, speeds=few), model).reason == reason


def test_what_tells_too_little_is_not_known(days, model, says):
    """Warmth that is not measured, or a scatter beside which nothing shows."""
    warmth = days(first=40, temperature_measured=False)
    assert found(days(), warmth, model).reason == says('measure')
    noisy = [dataclasses.replace(one, torque_squares=0.1) for one in days(first=40)]
    assert found(days(), noisy, model).reason == says('alike')


def test_what_is_not_compared_has_its_reason(days, model, says):
    onset = onset_of(None, days(), days(), model, 'no baseline yet')
    assert (onset.name, onset.is_known, onset.reason) == (NAME, False, 'no baseline yet')
    change, far = change_between(days(), days(first=40), model), days(speeds=(1e4,))
    assert onset_of(change, days(), far, model, '').reason == says('outside')


@given(seed=st.integers(0, 2**32 - 1))
def test_days_order_and_rebuilt_surfaces_change_nothing(days, model, seed):
    now = days(moved(model, 1.3), first=40)
    groups = change_between(days(), now, model).groups
    mixed = [dataclasses.replace(one, surface=f'{seed % 7}') for one in now]
    random.Random(seed).shuffle(mixed)
    one, other = (ran_of(points, groups, model) for points in (now, mixed))
    steps = np.array([-5, 0, 5])
    assert other.moved(model, steps) == pytest.approx(one.moved(model, steps), abs=1e-12)


@pytest.mark.parametrize(
    ('ends', 'noted'),
    [((1.5, 1.3, 1.8), True), ((1.5, 1.25, 1.8), True), ((1.5, 1.2, 1.8), False)],
)
def test_a_rise_is_noted_where_it_is_sure(ends, noted, says):
    """1.5 (1.25 / 1.5)^1.9 is 1.06; with 1.2 it is 0.98."""
    value, low, high = ends
    onset = Quantity(name=NAME, value=value, low=low, high=high)
    said = says('rise', low=f'{low:.2g}') if noted else ''
    assert onset_note(onset, 0.03, 1.9) == said
    assert onset_note(Quantity(name=NAME), 0.03, 1.9) == ''
    assert onset_note(dataclasses.replace(onset, value=0.7, low=0.6, high=0.8), 0.03, 1.9) == ''
