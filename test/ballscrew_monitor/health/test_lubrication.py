# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The film's part in the life, severity of contact, and boundary running."""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.life import NO_RATING, Rated
from ballscrew_monitor.health.lubrication import (
    boundary_note,
    lubrication_rate,
    opposed,
    severity_quantities,
    usual_boundary,
)
from ballscrew_monitor.health.records import Baseline, Cell, SpectrumBin
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.life import life_factor_iso_281_2007
from surrogate.surface import find_surface, Surface

TODAY, DAY = 20_000, 86_400 * SECOND
SURFACE = Surface.load(find_surface('closed_form'))
RATED = Rated(dynamic_rating=25e3, static_rating=55e3, preload=990.0, pitch_diameter=0.032)


def point(speed=100.0, *, day=TODAY, load=0.0, temperature=313.15, hours=2.0):
    """Return a cell."""
    return Cell(
        start=day * DAY,
        first_day=day,
        direction=1 if speed > 0 else -1,
        stretches=9,
        duration=hours * 3600.0,
        speed=speed,
        axial_load=load,
        temperature=temperature,
        motor_torque=0.1,
    )


def worn(day, *times, hours=2.0):
    """Return a bin whose time lies in classes of severity by shares."""
    time = hours * 3600.0
    return SpectrumBin(
        first_day=day,
        load_band=0,
        axial_load=0.0,
        angle=1e6,
        speed=50.0,
        time=time,
        wear_time=tuple(share * time for share in times),
    )


def baseline(first=TODAY - 100):
    """Return a baseline of ten days."""
    return Baseline(begin=first * DAY, end=(first + 9) * DAY, reason='learned')


def test_an_opposing_load():
    """A positive load drives a positive motion."""
    assert opposed(point(100.0, load=300.0)) == -300.0
    assert opposed(point(-100.0, load=300.0)) == 300.0


def test_the_same_programme_passes_at_the_same_rate():
    found = lubrication_rate([point(day=TODAY - 50), point()], SURFACE, RATED, TODAY)
    assert found.value == found.low == found.high == pytest.approx(1.0)


def test_a_slower_programme_lets_life_pass_faster():
    """By the ratio of the factors at both films."""
    fast, slow = point(200.0, day=TODAY - 50, hours=20.0), point(5.0, hours=400.0)
    found = lubrication_rate([fast, slow], SURFACE, RATED, TODAY)
    films = [SURFACE.lookup(one.speed, 0.0, one.temperature).film_ratio for one in (fast, slow)]
    limit = 0.5 * 55e3 / 22 / (3 * 990.0)
    slowness = [1 / life_factor_iso_281_2007(film**1.3, limit) for film in films]
    # 4000 rad s/s against 2000: a third of the damage is that of the slow point.
    mean = (2 * slowness[0] + slowness[1]) / 3
    assert found.value == pytest.approx(slowness[1] / mean)
    assert 1 < found.low <= found.value <= found.high
    assert 'analogy' in found.evidence


@given(st.floats(5.0, 200.0), st.floats(-2000.0, 2000.0), st.floats(290.0, 340.0))
def test_the_interval_holds_the_rate(speed, load, temperature):
    points = [point(day=TODAY - 50), point(speed, load=load, temperature=temperature)]
    found = lubrication_rate(points, SURFACE, RATED, TODAY)
    assert 0 < found.low <= found.value <= found.high


@pytest.mark.parametrize(
    ('points', 'key'),
    [
        ([], 'nothing'),
        ([point(hours=0.5)], 'half_hour'),
        ([point(), point(1e5, hours=1.0)], 'outside'),
    ],
)
def test_a_film_that_is_not_known(points, key, says):
    found = lubrication_rate(points, SURFACE, RATED, TODAY)
    assert not found.is_known
    assert found.reason == says(key)


def test_without_a_rating():
    assert lubrication_rate([point()], SURFACE, None, TODAY).reason == NO_RATING


def test_shares_of_severity_and_their_shift():
    """From the second class to the third is a shift of one."""
    before = [worn(TODAY - 100 + day, 0.0, 1.0) for day in range(9)]
    now = [worn(TODAY - day, 0.0, 0.25, 0.5, 0.25) for day in range(6)]
    found = {one.name: one for one in severity_quantities([*before, *now], baseline(), TODAY)}
    assert [found[f'severity class {at}'].value for at in (1, 2, 3)] == [0.25, 0.5, 0.25]
    assert 'severity class 0' not in found
    shift = found['severity shift']
    assert shift.value == pytest.approx(1.0)
    assert shift.low == pytest.approx(1.0)  # without scatter


@pytest.mark.parametrize(
    ('bins', 'known', 'key'),
    [
        ([worn(TODAY)], baseline(), 'no_severity'),
        ([worn(TODAY, 1.0)], None, 'no_baseline'),
        ([worn(TODAY, 1.0), worn(TODAY - 95, 1.0)], baseline(), 'few_periods'),
    ],
)
def test_a_shift_that_is_not_known(bins, known, key, says):
    """Shares may be known without it."""
    *_, shift = severity_quantities(bins, known, TODAY)
    assert not shift.is_known
    assert shift.reason == says(key)


def test_boundary_running_that_is_normal(says):
    """It is where the baseline has it already, and not where it grows."""
    first = TODAY - 100
    slow, fast = point(0.2, hours=6.0), point(200.0, hours=4.0)
    before = point(0.2, day=first, hours=6.0), point(200.0, day=first, hours=4.0)
    usual = usual_boundary([*before, slow, fast], baseline(), SURFACE, TODAY)
    assert usual == pytest.approx((0.6, 0.6))
    assert boundary_note(*usual) == says('normal')
    assert usual_boundary([*before, slow], baseline(), SURFACE, TODAY) is None
    assert usual_boundary([before[1], slow], baseline(), SURFACE, TODAY) is None
    assert usual_boundary([*before, slow], None, SURFACE, TODAY) is None
    assert usual_boundary(before, baseline(), SURFACE, TODAY) is None
    unknown = point(1e6, day=first)
    assert usual_boundary([unknown, slow], baseline(), SURFACE, TODAY) is None
