# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sums of a known motion: angle, load, energies, severity, and days that are over."""

import dataclasses
import math
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.bands import load_band, severity_class, UNKNOWN_LOAD
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.records import SpectrumBin
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.spectrum import (
    count,
    merged_bins,
    sliding_of,
    SpectrumMemory,
    take_bins,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import Found

HELD, DERIVED = 3, 4


@pytest.fixture(name='spectrum')
def count_rows(motion, surface):
    def spectrum(rows, **settings):
        memory, bins, settings = SpectrumMemory(), [], GatherSettings(**settings)
        for row in motion.single(rows):
            if not count(surface.tables, settings, memory, row, Found()):
                bins += take_bins(memory)
                assert count(surface.tables, settings, memory, row, Found())
        return bins + take_bins(memory)

    return spectrum


def test_angle_energy_and_severity_of_a_steady_motion(spectrum, motion, surface):
    """500 N against the motion at -40 rad/s for ten seconds."""
    rows = motion.steady(10.01, -40.0, torque=-1.2, load=500.0)
    (found,) = spectrum(rows)
    assert (found.first_day, found.days, found.load_band) == (motion.today, 1, load_band(500.0))
    assert found.axial_load == pytest.approx(500.0)
    assert (found.angle, found.speed, found.time) == pytest.approx((400.0, 40.0, 10.0))
    assert found.energy_lost == pytest.approx(0.2 * 400.0)
    ideal = 500.0 * surface.lead / (2 * math.pi)
    assert found.energy_measured == pytest.approx((1.2 - ideal) * 400.0)
    assert found.energy_expected == pytest.approx(found.energy_lost)
    here = surface.lookup(40.0, 500.0, 313.0)
    pressure = here.asperity_share * 2 / 3 * here.max_pressure
    assert found.wear_time[severity_class(pressure)] == pytest.approx(10.0)
    (slid,) = spectrum(rows, sliding=1e-3)
    assert slid.wear_time[severity_class(pressure * 40.0 * 1e-3)] == pytest.approx(10.0)


def test_a_load_along_the_motion_is_negative_and_signs_agree(spectrum, motion):
    """The friction torque is that of the mirrored motion."""
    one, other = (
        spectrum(motion.steady(5.0, sign * 40.0, torque=sign * 0.3, load=sign * 300.0))[0]
        for sign in (1.0, -1.0)
    )
    assert one == other
    assert one.axial_load == pytest.approx(-300.0)
    assert one.energy_measured > 0.0


@pytest.mark.parametrize(('load', 'band'), [(1e9, 24), (-1e9, -24), (50.0, 0)])
def test_a_load_beyond_the_last_band_is_counted_in_it(spectrum, motion, load, band):
    (found,) = spectrum(motion.steady(1.01, -40.0, load=load))
    assert (found.load_band, found.time) == (band, pytest.approx(1.0))


def test_what_is_not_known_is_in_no_energy_and_no_motion_is_lost(spectrum, motion):
    rows = motion.steady(8.01)
    rows['axial_load_source'][:200] = DERIVED
    rows['axial_load_source'][200:400] = HELD
    rows['validity'][200:400] = 7
    rows['motor_torque_source'][400:600] = HELD
    rows['validity'][600:] = 3
    derived_and_on, unknown = spectrum(rows)
    assert unknown.load_band == UNKNOWN_LOAD
    assert math.isnan(unknown.axial_load)
    assert math.isnan(unknown.energy_measured)
    assert (unknown.time, unknown.energy_lost, sum(unknown.wear_time)) == pytest.approx((2, 0, 0))
    assert derived_and_on.time == pytest.approx(6.0)
    assert derived_and_on.energy_lost == pytest.approx(0.2 * 50.0 * 4.0)
    assert sum(derived_and_on.wear_time) == pytest.approx(4.0)
    assert math.isnan(derived_and_on.energy_measured)


def test_holes_standstill_and_ticks_add_nothing(spectrum, motion):
    rows = motion.then(motion.steady(2.0), motion.steady(2.0), after=SECOND)
    assert spectrum(rows)[0].time == pytest.approx(2 * 1.99)
    assert spectrum(rows, max_gap=SECOND)[0].time == pytest.approx(4.98)
    rows['gates'] = 1
    assert spectrum(rows) == []
    rows['gates'], rows['tick'] = 0, True
    assert spectrum(rows) == []
    back = motion.then(motion.steady(2.0), motion.steady(2.0), after=-5 * SECOND)
    assert spectrum(back)[0].time == pytest.approx(2 * 1.99)


def test_every_day_has_its_bins(spectrum, motion):
    """A clock that leaps gives bins of the days that it says."""
    rows = motion.steady(4.0, start=(motion.today + 1) * DAY - 2 * SECOND)
    assert [(one.first_day, one.time) for one in spectrum(rows)] == [
        (motion.today, pytest.approx(1.99)),
        (motion.today + 1, pytest.approx(2.0)),
    ]
    rows['stamp'][200:] -= 300 * DAY
    assert [one.first_day for one in spectrum(rows)] == [motion.today, motion.today - 299]


def test_the_surface_states_the_sliding(surface):
    assert math.isnan(sliding_of(types.SimpleNamespace(header={})))
    assert sliding_of(types.SimpleNamespace(header={'sliding_m_per_rad': 2e-3})) == 2e-3


def bins():
    amount = st.floats(0.125, 1e3)
    return st.builds(
        SpectrumBin,
        first_day=st.integers(19_000, 20_000),
        load_band=st.integers(-2, 2),
        axial_load=amount,
        angle=amount,
        speed=amount,
        time=amount,
        wear_time=st.tuples(amount, amount),
        energy_lost=amount,
        energy_measured=st.one_of(st.just(math.nan), amount),
        energy_expected=amount,
    )


@given(st.lists(bins(), max_size=12), st.integers(20_000, 23_000))
def test_merging_keeps_sums_whatever_the_order(many, today):
    one, other = merged_bins(many, today), merged_bins(many[::-1], today)
    assert [dataclasses.astuple(each)[:3] for each in one] == [
        dataclasses.astuple(each)[:3] for each in other
    ]
    for found in (one, other, merged_bins(merged_bins(many), today)):
        for name in ('angle', 'time', 'energy_lost', 'energy_expected', 'energy_measured'):
            sums = [np.nansum([getattr(each, name) for each in some]) for some in (found, many)]
            assert sums[0] == pytest.approx(sums[1])
        moment = [sum(each.axial_load * each.angle for each in some) for some in (found, many)]
        assert moment[0] == pytest.approx(moment[1])
        worn = [sum(sum(each.wear_time) for each in some) for some in (found, many)]
        assert worn[0] == pytest.approx(worn[1])
    assert len({(each.first_day, each.load_band) for each in one}) == len(one)
