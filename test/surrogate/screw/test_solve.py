# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The whole screw in the full tier: energy, quadrants, limits, roughness, failures."""

from dataclasses import replace
import math
from types import SimpleNamespace

from coulomb import coulomb_traction
import pytest
from surrogate.asperities import law as asperity_law
from surrogate.ehl import Settings
from surrogate.files import InputError
from surrogate.formulas.geometry import SIDES
from surrogate.formulas.inlet import SPEED_EXPONENT
from surrogate.formulas.load_sharing import normal_force
from surrogate.identify.model import thickened
from surrogate.parameters import BallRoughness, load_lubricant, load_screw, OperatingPoint
from surrogate.screw import closed_form, nut
from surrogate.screw.ball_balance import balance_ball
from surrogate.screw.ball_motion import slip_floor
from surrogate.screw.contacts import make_contacts, ScrewSettings
from surrogate.screw.nut import CREEP, load_change, NutLoad, rolling_force, SolvedNut
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import (
    _check_same_load,
    _nut_loads,
    _without_floating,
    rebalance_screw,
    solve_screw,
    worst_contact,
)

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
SMALL = Settings(nx=65, ny=65, error_estimate=False)
SMOOTH = ScrewSettings(smooth=SMALL, kinematics='smooth')
ROLLING = ScrewSettings(smooth=SMALL)
KINEMATICS = {'rolling': ROLLING, 'smooth': SMOOTH}
MIXED = 120
"""Speed at which some of the load is on asperities of the new raceway [rev/min]."""
WARM = 313.15


def at(rpm, load, settings=SMOOTH, screw=SCREW):
    """Solve a point at 40 degC."""
    point = OperatingPoint(speed=rpm * math.pi / 30, load=load, temperature=WARM)
    return solve_screw(Contacts.of(screw), OIL, point, settings=settings)


def contact(rcs=0.0, film_ratio=1.0):
    """Return a contact with what tells the worst one, without a load if RCS is None."""
    return SimpleNamespace(solved=rcs, rcs=rcs, film_ratio=film_ratio)


@pytest.mark.parametrize(
    ('contacts', 'worst'),
    [
        ([contact(0.1), contact(0.3), contact(0.2), contact(0.0)], 1),
        ([contact(0.1, 2.0), contact(0.1, 3.0), contact(0.1), contact(0.1, 4.0)], 2),
        ([contact(0.1)] * 4, 0),  # of equal ones the first
        ([contact(math.nan), contact(0.1), contact(None), contact(0.2)], 3),
        ([contact(None)] * 4, 0),
        ([], 0),
    ],
)
def test_the_worst_contact_has_the_largest_rcs_or_the_thinnest_film(contacts, worst):
    assert worst_contact(contacts) == worst


@pytest.mark.parametrize(
    ('speed', 'load', 'flanks'),
    [(60.0, 0.0, (1, -1)), (60.0, 1.0, (1, -1)), (60.0, -0.5, (-1, 1)), (-60.0, 0.5, (-1, 1))],
)
def test_the_loaded_nut_presses_the_flank_that_opposes(speed, load, flanks):
    point = OperatingPoint(speed=speed, load=load, temperature=WARM)
    loads = _nut_loads(SCREW, point)
    assert tuple(one.flank for one in loads) == flanks
    assert loads[0].force - loads[1].force == pytest.approx(abs(load), abs=1e-9)
    assert [one.nut for one in loads] == ['loaded', 'relieved']


@pytest.mark.parametrize(
    ('share', 'failure', 'idle'),
    [(0.019, 'floats', True), (0.02, 'floats', False), (0.019, '', False)],
)
def test_a_relieved_nut_that_is_not_solved_floats_under_a_small_share(share, failure, idle):
    point = OperatingPoint(speed=60.0, load=1000.0, temperature=WARM)
    loaded = NutLoad(nut='loaded', force=1000.0, flank=1)
    relieved = NutLoad(nut='relieved', force=share * 1000.0, flank=-1)
    solved = [
        SolvedNut(force=one.force, contacts=(), ball=None, failure=text)
        for one, text in ((loaded, ''), (relieved, failure))
    ]
    found = _without_floating(SCREW, point, (loaded, relieved), solved)
    assert found[0] is solved[0]
    if idle:
        assert (found[1].force, found[1].failure, len(found[1].contacts)) == (0.0, '', 2)
    else:
        assert found[1] is solved[1]


@pytest.mark.parametrize('factor', [1.0009, 1.0011, 0.9991, 0.9989])
def test_a_normal_force_is_the_same_within_a_part_in_a_thousand(factor):
    point = OperatingPoint(speed=60.0, load=800.0, temperature=WARM)
    forces = [float(normal_force(SCREW, one.force)) for one in _nut_loads(SCREW, point)]
    found = SimpleNamespace(
        contacts=(contact(),) * 4, normal_forces=(factor * forces[0], forces[1])
    )
    if abs(factor - 1.0) < 1e-3:
        _check_same_load(SCREW, point, found)
        gone = SimpleNamespace(contacts=(contact(),) * 3 + (contact(None),), normal_forces=forces)
        with pytest.raises(InputError):
            _check_same_load(SCREW, point, gone)
    else:
        with pytest.raises(InputError):
            _check_same_load(SCREW, point, found)


@pytest.mark.parametrize(
    ('ratios', 'change'),
    [((1.0, 1.02), 0.02), ((0.97, 1.02), 0.03), ((None, 1.01), 0.01), ((), 0)],
)
def test_the_change_of_a_load_is_the_largest_over_that_solved(ratios, change):
    contacts = [
        SimpleNamespace(
            ball=SimpleNamespace(normal_force=20.0 * (ratio or 9.0)),
            pressed=ratio and SimpleNamespace(condition=SimpleNamespace(load=20.0)),
        )
        for ratio in ratios
    ]
    assert load_change(SimpleNamespace(contacts=contacts)) == pytest.approx(change)


@pytest.mark.parametrize(
    ('changes', 'rounds'),
    [((0.5,), 0), ((0.51, 0.5), 1), ((0.6, 0.4), 1), ((9.0,) * 9, 4), ((math.nan,), 0)],
)
def test_contacts_are_solved_again_while_a_force_changes_by_more_than_is_allowed(
    monkeypatch, changes, rounds
):
    """Under the forces of the last balance, four times at most."""
    left, asked = iter(changes), []

    def make(screw, point, carried, solved):
        force = 20.0 * (1.0 + next(left))
        ball = SimpleNamespace(normal_force=force)
        pressed = SimpleNamespace(condition=SimpleNamespace(load=20.0))
        return SimpleNamespace(contacts=[SimpleNamespace(ball=ball, pressed=pressed)] * 2)

    monkeypatch.setattr(nut, 'make_nut', make)
    monkeypatch.setattr(nut, 'solve_sides', lambda contacts, loads: asked.append(loads))
    nut.solve_nut(SCREW, None, None, (), (), tolerance=0.5)
    assert asked == [(20.0 * (1.0 + change),) * 2 for change in changes[:rounds]]


def test_the_accuracy_of_a_screw_was_measured_with_these():
    """Slow motion, friction left out of a balance; another one is measured again."""
    assert (CREEP, nut.NEGLECTED_FRICTION) == (1e-3, 3e-4)


@pytest.mark.parametrize('rpm', [600, -600])
@pytest.mark.parametrize('load', [800.0, -800.0])
def test_torque_from_loads_is_that_of_the_lost_power(rpm, load):
    """Four quadrants: both ways to the torque agree to rounding; the sign of the load decides."""
    found = at(rpm, load)
    assert found.converged, found.status
    assert found.energy_error < 1e-8
    ideal = rpm * load / abs(rpm) * SCREW.lead / (2 * math.pi)
    assert found.driving_torque == pytest.approx(ideal + found.friction_torque, rel=1e-8)
    assert found.back_driving == (rpm * load < 0)
    assert 0.9 < found.efficiency < 1
    assert found.load_change < 0.01


def test_preload_alone_loses_power_and_the_nuts_share_their_contacts():
    """Both nuts carry the preload; nothing drives the screw; each contact has its own ball."""
    found = at(600, 0.0)
    assert found.normal_forces[0] == pytest.approx(found.normal_forces[1])
    assert found.efficiency == 0
    assert not found.back_driving
    assert found.driving_torque == pytest.approx(found.friction_torque, rel=1e-8)
    first, second, third, fourth = found.contacts
    assert first.pressed is third.pressed
    assert second.pressed is fourth.pressed
    assert first.ball != third.ball
    other = at(600, 1.0)
    assert other.contacts[0].pressed is not other.contacts[2].pressed


def test_a_warm_start_saves_work_and_changes_nothing():
    near = at(20, 400.0)
    point = OperatingPoint(speed=24 * math.pi / 30, load=400.0, temperature=WARM)
    warm = solve_screw(OPENED, OIL, point, settings=SMOOTH, start=near)
    cold = at(24, 400.0)
    assert warm.converged, warm.status
    assert warm.friction_torque == pytest.approx(cold.friction_torque, rel=1e-4)
    assert warm.minimum_film == pytest.approx(cold.minimum_film, rel=1e-3)
    steps = [
        sum(contact.pressed.newton_iterations for contact in found.contacts)
        for found in (warm, cold)
    ]
    assert steps[0] < 0.6 * steps[1]


def test_full_tier_is_near_the_formulas_at_full_film():
    """At 600 rev/min film within 10 %, torque within 30 % of the closed-form tier."""
    found = at(600, 500.0)
    formula = closed_form.solve(OPENED, OIL, 600 * math.pi / 30, 500.0, WARM)
    assert found.central_film == pytest.approx(float(formula.central_film), rel=0.1)
    assert found.friction_torque == pytest.approx(float(formula.friction_torque), rel=0.3)
    assert found.rcs == 0.0
    assert found.entrainment_speed == pytest.approx(0.49657, rel=1e-4)


def test_beyond_unloading_the_relieved_nut_is_idle():
    found = at(600, 3.0 * SCREW.preload)
    assert found.converged, found.status
    assert found.normal_forces[1] == 0.0
    assert [contact.smooth is None for contact in found.contacts] == [False, False, True, True]
    free = at(600, 500.0, screw=replace(SCREW, preload=0.0))
    assert free.converged, free.status
    assert free.normal_forces[1] == 0.0
    idle = at(600, 0.0, screw=replace(SCREW, preload=0.0))
    assert idle.friction_torque == 0.0
    assert idle.rcs == 0.0
    assert math.isnan(idle.film_ratio)


def test_a_nut_about_to_unload_is_idle_and_named():
    """Its share cannot hold its balls; the other nut carries exactly the load."""
    found = at(600, 0.9985 * 2**1.5 * SCREW.preload)
    assert found.converged, found.status
    assert 'relieved one is idle' in found.status
    assert found.normal_forces[1] == 0.0
    assert found.energy_error < 1e-8


def test_smooth_raceway_and_ball_do_not_touch():
    """Rq 0 is the smooth contact; a rough ball alone is not."""
    bare = replace(SCREW, roughness=replace(SCREW.roughness, rms=0.0))
    rough = replace(bare, ball_roughness=BallRoughness(grade='G10'))
    assert at(5, 500.0, ROLLING, bare).rcs == 0.0
    assert at(5, 500.0, ROLLING, rough).rcs > 0.0


def test_a_starved_contact_is_taken_at_a_slower_entrainment():
    """The speed whose flooded film is the stated share."""
    point = OperatingPoint(speed=10.0, load=0.0, temperature=313.15)
    full, half = (
        make_contacts(
            OPENED, replace(OIL, film_factor=factor), point, ScrewSettings(inlet_heating=False)
        )[0]
        for factor in (1.0, 0.5)
    )
    assert half.entrainment(20.0) == pytest.approx(0.5 ** (1 / 0.67) * full.entrainment(20.0))


@pytest.mark.parametrize('settings', KINEMATICS.values(), ids=KINEMATICS)
def test_rest_is_dry_and_loses_most(settings):
    """At speed zero all load is on asperities, whose friction is the boundary one."""
    rest, fast = at(0, 500.0, settings), at(3000, 500.0, settings)
    assert rest.converged, rest.status
    assert rest.rcs == pytest.approx(1.0, abs=1e-3)
    assert rest.film_ratio == 0.0
    assert rest.energy_error < 1e-8
    assert rest.friction_coefficient == pytest.approx(SCREW.roughness.asperity_friction, rel=0.02)
    assert fast.rcs == 0.0
    assert fast.friction_coefficient < 0.5 * rest.friction_coefficient
    assert fast.film_ratio > 1


def test_energy_holds_with_some_of_the_load_on_asperities():
    """Torque from loads and from lost power."""
    found = at(MIXED, -800.0, ROLLING)
    assert found.converged, found.status
    assert found.rcs > 0
    assert found.energy_error < 1e-8
    assert found.back_driving


def test_all_load_on_asperities_is_coulomb_friction():
    """At rest: one nut pushes balls of that coefficient against the motion, the other with it."""
    rest, floor = at(0, 0.0, ROLLING), slip_floor(SCREW, CREEP)
    first, second = (
        coulomb_traction(SCREW, side, SCREW.roughness.asperity_friction, slip_floor=floor)
        for side in SIDES
    )
    balls = [
        balance_ball(
            SCREW,
            CREEP,
            screw_traction=first,
            nut_traction=second,
            axial_force=SCREW.preload / SCREW.loaded_balls_per_nut,
            flank=flank,
        )
        for flank in (1, -1)
    ]
    whole = SCREW.loaded_balls_per_nut * sum(ball.loss_torque for ball in balls)
    assert rest.friction_torque == pytest.approx(whole, rel=0.02)


def test_rolling_roughness_is_the_smooth_contact_with_the_law():
    """The default. Pressures and film are smooth; RCS that of the law, the worst one counts."""
    assert ScrewSettings().kinematics == 'rolling'
    found, smooth = at(MIXED, 500.0, ROLLING), at(MIXED, 500.0)
    for contact in found.contacts:
        solved = contact.solved
        assert solved.pressed is solved.smooth
        law = OPENED.law.contact(
            contact.side,
            solved.smooth.contact,
            solved.smooth.condition,
            solved.smooth.lubricant,
            OIL.film_floor,
        )
        assert solved.asperities == law
        assert solved.friction_share == law.asperity_share
    assert 0.001 < found.rcs < 1
    assert found.rcs == max(contact.solved.asperities.rcs for contact in found.contacts)
    assert found.rcs_deviation > 0
    assert found.central_film == smooth.central_film
    assert found.max_pressure == pytest.approx(smooth.max_pressure, rel=1e-3)
    assert smooth.rcs == 0.0
    assert found.friction_torque > smooth.friction_torque


def test_rolling_loss_is_that_of_the_smooth_film_times_its_factor(monkeypatch):
    """The oil alone: hysteresis is not multiplied. Torque grows with it."""
    # The factor fades far above the onset, and bends to the least one.
    monkeypatch.setattr(asperity_law, 'SMOOTH_FROM', 60.0)
    monkeypatch.setattr(asperity_law, 'SOFT_LOSS', 1e-3)
    monkeypatch.setattr(asperity_law, 'LOSS_SLOPE', (0.0, 0.0, 0.0))
    monkeypatch.setattr(asperity_law, 'LOSS_RIDGES', 0.0)
    found = []
    for factor in (1.0, 2.0):
        monkeypatch.setattr(asperity_law, 'LOSS', (factor, 0.0, 0.0))
        found.append(at(600, 0.0, ROLLING))
    one, two = found
    lossy = replace(SCREW, hysteresis_loss=0.01)
    for first, second in zip(one.contacts, two.contacts, strict=True):
        plain = rolling_force(SCREW, first.solved)
        assert plain == pytest.approx(first.pressed.whole_rolling_force, rel=1e-9)
        assert rolling_force(SCREW, second.solved) == pytest.approx(2 * plain, rel=1e-6)
        elastic = rolling_force(lossy, first.solved) - plain
        again = rolling_force(lossy, second.solved) - rolling_force(SCREW, second.solved)
        assert again == pytest.approx(elastic, rel=1e-6)
    added = two.friction_torque - one.friction_torque
    rolling = sum(contact.ball.rolling_power for contact in one.contacts)
    whole = SCREW.loaded_balls_per_nut * rolling / (600 * math.pi / 30)
    assert added == pytest.approx(whole, rel=0.05)


def test_a_starved_film_touches_more():
    """The film of a flooded contact so much slower, about half; more contact at one speed."""
    point = OperatingPoint(speed=MIXED * math.pi / 30, load=500.0, temperature=WARM)
    full, half = (
        solve_screw(OPENED, replace(OIL, film_factor=factor), point, settings=ROLLING)
        for factor in (1.0, 0.5)
    )
    slower = replace(point, speed=0.5 ** (1 / SPEED_EXPONENT) * point.speed)
    flooded = solve_screw(OPENED, OIL, slower, settings=ROLLING)
    assert half.central_film == pytest.approx(flooded.central_film, rel=1e-6)
    assert half.rcs == pytest.approx(flooded.rcs, rel=1e-6)
    assert half.central_film == pytest.approx(0.5 * full.central_film, rel=0.1)
    assert half.rcs > full.rcs > 0
    assert half.entrainment_speed == full.entrainment_speed


def test_parasitic_torque_is_added_and_never_hidden_in_friction():
    """Constant and speed-proportional parts add to friction and driving torque."""
    screw = replace(SCREW, parasitic_torque=0.1, parasitic_torque_rate=1e-3)
    more, bare = at(600, 500.0, screw=screw), at(600, 500.0)
    added = 0.1 + 1e-3 * 600 * math.pi / 30
    assert more.friction_torque - bare.friction_torque == pytest.approx(added, rel=1e-9)
    assert more.driving_torque - bare.driving_torque == pytest.approx(added, rel=1e-9)


def test_a_contact_that_fails_is_named_and_leaves_no_number():
    settings = ScrewSettings(smooth=Settings(newton_limit=1), kinematics='smooth')
    found = at(600, 500.0, settings)
    assert not found.converged
    assert found.status.startswith('loaded nut, screw, smooth contact: ')
    assert math.isnan(found.friction_torque)
    assert math.isnan(found.efficiency)


def test_balls_are_balanced_anew_on_solved_contacts():
    """The same point gives the same; another friction what a fresh solve gives."""
    rpm, settings = 60, ROLLING
    found = at(rpm, 500.0, settings)
    point = OperatingPoint(speed=rpm * math.pi / 30, load=500.0, temperature=WARM)
    again = rebalance_screw(OPENED, OIL, point, found, settings=settings)
    assert again.friction_torque == found.friction_torque
    assert again.rcs == found.rcs
    rough = replace(SCREW, roughness=replace(SCREW.roughness, asperity_friction=0.15))
    balanced = rebalance_screw(Contacts.of(rough), OIL, point, found, settings=settings)
    fresh = at(rpm, 500.0, settings, screw=rough)
    assert balanced.friction_torque == pytest.approx(fresh.friction_torque, rel=1e-9)
    assert balanced.energy_error < 1e-8
    assert balanced.friction_torque > 1.2 * found.friction_torque


def test_another_oil_at_the_same_viscosity_times_speed_shears_on_the_same_film():
    """Half the speed and twice the viscosity: within 1 % of contacts solved there."""
    found = at(600, 0.0)
    thick = thickened(OIL, 2.0)
    point = OperatingPoint(speed=300 * math.pi / 30, load=0.0, temperature=WARM)
    fresh = solve_screw(OPENED, thick, point, settings=SMOOTH)
    balanced = rebalance_screw(OPENED, thick, point, found)
    assert balanced.friction_torque == pytest.approx(fresh.friction_torque, rel=0.01)
    assert found.friction_torque != pytest.approx(fresh.friction_torque, rel=0.01)


def test_a_balance_needs_solved_contacts():
    """None in a nut without load, and a sentence where a contact has failed."""
    idle = at(600, 3.0 * SCREW.preload)
    point = OperatingPoint(speed=600 * math.pi / 30, load=3.0 * SCREW.preload, temperature=WARM)
    again = rebalance_screw(OPENED, OIL, point, idle)
    assert again.friction_torque == idle.friction_torque
    settings = ScrewSettings(smooth=Settings(newton_limit=1), kinematics='smooth')
    failed = at(600, 3.0 * SCREW.preload, settings)
    again = rebalance_screw(OPENED, OIL, point, failed)
    assert not again.converged
    assert again.status.startswith('loaded nut, screw, smooth contact: ')


def test_contacts_of_another_load_are_not_rebalanced(refused):
    """Smooth contacts beyond unloading say nothing about a load below it, nor of another one."""
    idle = at(600, 3.0 * SCREW.preload)
    point = OperatingPoint(speed=600 * math.pi / 30, load=1000.0, temperature=WARM)
    refused('load_1000_n', rebalance_screw, OPENED, OIL, point, idle)
    refused('load_1000', rebalance_screw, OPENED, OIL, point, at(600, 900.0))
    same = replace(point, load=3.0 * SCREW.preload)
    again = rebalance_screw(OPENED, OIL, same, idle)
    assert again.friction_torque == pytest.approx(idle.friction_torque, rel=1e-9)
