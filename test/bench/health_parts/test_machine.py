# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The friction of the drawn machines has the limits of its sources."""

from dataclasses import replace
import math

from health_parts.machine import (
    bearing_friction,
    catalogue_drag,
    CELSIUS,
    Condition,
    draw_machine,
    friction,
    friction_parts,
    OILS,
    SIZES,
    stribeck,
    viscosity,
)
import numpy as np
import pytest

WARM = CELSIUS + 40.0
TURN = 2.0 * math.pi
SEEDS = range(20)


@pytest.fixture
def machine():
    """Return a machine with the oil of the catalogue, whose preload does not rise."""
    return replace(draw_machine(3, size='40x10'), grade=68, preload_rise=0.0)


def test_drag_of_a_catalogue():
    """40x10 with 2 kN: tan of the lead angle 0.0796, Kp 0.177, so 0.564 N m."""
    assert catalogue_drag(SIZES['40x10'], 2000.0) == pytest.approx(0.564, abs=5e-4)


@pytest.mark.parametrize('seed', SEEDS)
def test_nut_has_the_drag_of_the_catalogue_at_the_stated_speed_and_oil(seed):
    machine = replace(draw_machine(seed), grade=68)
    nut = friction_parts(machine, 100.0 / 60.0 * TURN, WARM)['nut']
    drag = catalogue_drag(machine.size, machine.preload)
    assert nut == pytest.approx(machine.catalogue_factor * drag, rel=1e-12)
    assert 0.6 <= nut / drag <= 1.6


@pytest.mark.parametrize('seed', SEEDS)
def test_preload_is_three_to_ten_percent_of_the_rating(seed):
    machine = draw_machine(seed)
    assert 0.03 <= machine.preload / machine.size.rating <= 0.10


def test_contacts_follow_the_preload_by_their_power(machine):
    dry = replace(machine, rolling=0.0)
    nuts = [
        friction_parts(dry, 20.0, WARM, condition=Condition(preload=preload))['nut']
        for preload in (1.0, 0.6)
    ]
    assert nuts[1] / nuts[0] == pytest.approx(0.6**machine.preload_power, rel=1e-12)


def test_seals_remain_alone_at_rest_without_oil(machine):
    """Coulomb: contacts on the boundary, seals, the load part of the bearings, the rails."""
    thin = Condition(viscosity=1e-12)
    parts = friction_parts(machine, 1e-9, CELSIUS + 20.0, condition=thin)
    drag = machine.catalogue_factor * catalogue_drag(machine.size, machine.preload)
    full = stribeck(1.0, machine.upturn, machine.film)
    assert parts['nut'] == pytest.approx(
        drag * (1.0 - machine.rolling) * (1.0 + machine.upturn) / full, rel=1e-4
    )
    assert parts['wiper'] == pytest.approx(machine.wiper, rel=1e-6)
    rail = 4.0 * 18.0 + machine.guide_friction * 500.0 * 9.81
    assert parts['guideway'] == pytest.approx(rail * 0.01 / TURN, rel=1e-6)


def test_bearings_by_hand(machine):
    """Palmgren in oil of 68 mm2/s at 1000 rev/min: 68000^(2/3) is 1666, 46 mm cubed 97336."""
    bearing = replace(machine, bearing_f0=2.0, bearing_f1=0.001)
    by_hand = 2e-7 * 1666.0 * 97336.0 + 0.001 * 3300.0 * 46.0  # [N mm]
    assert bearing_friction(bearing, 68000.0, 0.0) == pytest.approx(1e-3 * by_hand, rel=1e-3)


def test_bearings_do_not_know_the_oil_below_palmgrens_limit(machine):
    slow = [bearing_friction(machine, product, 0.0) for product in (1.0, 2000.0)]
    assert slow[0] == slow[1]


@pytest.mark.parametrize(('grade', 'pair'), OILS.items())
def test_oil_passes_through_its_two_viscosities(grade, pair):
    oil = viscosity(grade, np.array([WARM, CELSIUS + 100.0]))
    assert oil == pytest.approx(pair, rel=1e-12)


def test_oil_of_grade_68_at_20_degrees():
    """The chart of ASTM D341 through the same two points says 215 mm2/s."""
    assert viscosity(68, CELSIUS + 20.0) == pytest.approx(215.0, rel=0.02)


@pytest.mark.parametrize('seed', SEEDS)
def test_nut_falls_to_a_least_friction_and_rises(seed):
    """From 10 rev/min on: mixed friction falls, rolling resistance rises."""
    machine = draw_machine(seed)
    speed = np.geomspace(1.0, 300.0, 200)
    nut = friction_parts(machine, speed, CELSIUS + 25.0)['nut']
    least = int(np.argmin(nut))
    assert 0 < least < 199
    assert np.all(np.diff(nut[: least + 1]) < 0.0)
    assert np.all(np.diff(nut[least:]) > 0.0)


@pytest.mark.parametrize('part', ['preload', 'wiper', 'guideway', 'bearing', 'nut', 'every'])
@pytest.mark.parametrize('seed', range(5))
def test_friction_grows_with_each_part(seed, part):
    machine = draw_machine(seed)
    sums = [
        friction(machine, 60.0, 298.0, condition=Condition(**{part: factor}))
        for factor in (0.6, 0.8, 1.0, 1.2, 1.4)
    ]
    assert np.all(np.diff(sums) > 0.0)


def test_starved_film_moves_the_upturn_to_higher_speeds(machine):
    dry = replace(machine, rolling=0.0)
    starved = friction_parts(dry, 80.0, WARM, condition=Condition(film=8.0))['nut']
    assert starved == pytest.approx(friction_parts(dry, 10.0, WARM)['nut'], rel=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_warmth_lowers_the_friction_of_free_travel(seed):
    """By 0.2 to 2.5 % per kelvin, as of measured axes."""
    machine = replace(draw_machine(seed), preload_rise=0.0)
    cold, warm = (friction(machine, 100.0, kelvin) for kelvin in (294.0, 295.0))
    assert -0.025 < warm / cold - 1.0 < -0.002


def test_vertical_and_constant_axes_carry_a_force():
    assert draw_machine(1).standing_force == 0.0
    vertical = draw_machine(1, axis='vertical')
    assert vertical.standing_force == pytest.approx(
        -0.175 * vertical.size.mass * 9.81, abs=0.225 * vertical.size.mass * 9.81
    )
    constant = draw_machine(1, axis='constant')
    assert -1.5 < constant.standing_force / constant.preload < -0.3
    with pytest.raises(ValueError, match='axis must be horizontal, vertical or constant'):
        draw_machine(1, axis='tilted')
