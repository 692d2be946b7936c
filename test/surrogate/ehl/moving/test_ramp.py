# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Speed ramps: the onset of made-up columns, and a march down and up against standing speeds."""

from dataclasses import replace
from functools import cache
import math

import numpy as np
import pytest
from surrogate.ehl import ContactLubricant, moving

OIL = ContactLubricant(viscosity=0.04, pressure_viscosity=2.2e-8)
STRIP = moving.StripContact(
    radius=0.0127, reduced_modulus=226e9, max_pressure=0.8e9, width=30e-6, columns=12
)
SETTINGS = moving.MarchSettings(nx=65, places=1, film_floor=5e-9)


def rough(x, y):
    """Return a raceway of crossing waves that repeats with the strip."""
    return 90e-9 * np.cos(2 * np.pi * x / 40e-6) * np.cos(2 * np.pi * y / 30e-6)


def column(rcs):
    """Return a ramp with an RCS of the speed."""
    speeds = np.geomspace(0.1, 0.001, 400)
    return moving.SpeedRamp(
        status=moving.MarchStatus.CONVERGED,
        speeds=speeds,
        rcs=rcs(speeds),
        transit=10.0,
        steps=400,
    )


def test_the_onset_of_a_power_law_is_its_own_in_a_scattered_column_too():
    """RCS = 0.01 (u0/u)^6 passes 0.01 at u0, whatever means are taken of a slow ramp."""
    ramp = column(lambda u: 0.01 * (0.013 / u) ** 6)
    for transits in (1.0, 2.0):
        assert ramp.onset(transits=transits) == pytest.approx(0.013, rel=0.03)
    assert ramp.onset(rcs=0.3) == pytest.approx(0.013 * (0.01 / 0.3) ** (1 / 6), rel=0.03)
    rng = np.random.default_rng(1)
    ramp = column(lambda u: 0.01 * (0.013 / u) ** 6 * rng.uniform(0.4, 1.6, u.size))
    assert ramp.onset() == pytest.approx(0.013, rel=0.1)


@pytest.mark.parametrize('level', [0.0, 1.0])
def test_an_onset_that_is_not_on_the_ramp_is_nan(level):
    assert math.isnan(column(lambda u: level + 0.0 * u).onset())


def test_means_keep_the_sum():
    ramp = replace(column(lambda u: u), loss_factor=1 + np.geomspace(0.1, 0.001, 400))
    speeds, means = ramp.means(4.0)
    assert means.size == 10
    assert means.mean() == pytest.approx(ramp.rcs.mean())
    assert speeds[0] > speeds[-1]
    again, factors = ramp.means(4.0, 'loss_factor')
    assert np.array_equal(again, speeds)
    assert factors == pytest.approx(1 + means)


def test_failed_steps_count_where_the_onset_is():
    """A mean of 20 steps on each side of it: five of these 40 fail, and many far away."""
    converged = np.ones(400)
    converged[190:195] = converged[300:] = 0.0
    ramp = replace(column(lambda u: u), converged=converged)
    middle = math.sqrt(ramp.speeds[199] * ramp.speeds[200])
    assert ramp.failed_share(middle) == pytest.approx(5 / 40)
    assert ramp.failed_share(0.1) == 0.0
    assert ramp.failed_share(0.001) == 1.0


def test_a_flat_strip_loses_what_a_smooth_one_does():
    """The loss factor is 1 all along but for the lag, which turns with the sense; no contact."""
    known = {'transits': 4.0, 'settings': SETTINGS}
    down, up = (
        moving.ramp_strip(STRIP, OIL, speeds, lambda x, y: 0 * x * y, **known)
        for speeds in ((0.1, 0.08), (0.08, 0.1))
    )
    assert down.loss_factor.size == down.speeds.size > 100
    for ramp in (down, up):
        assert ramp.loss_factor == pytest.approx(1.0, abs=0.03)
        assert ramp.rcs.max() == 0.0
        assert ramp.converged.size == ramp.speeds.size
        assert ramp.converged.all()
    assert down.loss_factor.mean() > 1 > up.loss_factor.mean()
    both = 0.5 * (down.loss_factor.mean() + up.loss_factor.mean())
    assert both == pytest.approx(1.0, abs=0.005)


@cache
def onsets(transits):
    """Return the onset of a ramp down and of one up [m/s]."""
    known = {'transits': transits, 'settings': SETTINGS}
    down = moving.ramp_strip(STRIP, OIL, (0.1, 0.03), rough, **known)
    up = moving.ramp_strip(STRIP, OIL, (0.03, 0.1), rough, **known)
    assert down.status is up.status is moving.MarchStatus.CONVERGED
    assert down.speeds[0] == pytest.approx(0.1, rel=0.01)
    assert down.speeds[-1] == pytest.approx(0.03, rel=1e-6)
    return [ramp.onset(rcs=0.02, transits=1.0) for ramp in (down, up)]


def test_down_and_up_enclose_the_standing_speed():
    """Contact lags behind the speed; no lag at one speed."""
    down, up = onsets(6.0)
    assert 0 < math.log(up / down) < 0.3
    touching, parted = (
        moving.march_strip(STRIP, OIL, speed, rough, transits=2.0, settings=SETTINGS).rcs.value
        for speed in (0.9 * down, 1.1 * up)
    )
    assert parted < 0.02 < touching


@pytest.mark.long
def test_contact_lags_the_less_the_slower_the_speed_changes():
    quick, slow = (math.log(up / down) for down, up in map(onsets, (6.0, 18.0)))
    assert 0 < slow < quick


def test_a_ramp_without_an_end_is_one_sentence(refused):
    with refused('speeds'):
        moving.ramp_strip(STRIP, OIL, (0.1, 0.1), rough, transits=2.0, settings=SETTINGS)
    with refused('transits_0_5'):
        moving.ramp_strip(STRIP, OIL, (0.1, 0.05), rough, transits=0.5, settings=SETTINGS)
