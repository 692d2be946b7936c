# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the full tier as a record, and the command that prints it."""

from dataclasses import replace
import json
import math
from types import SimpleNamespace

import pytest
from surrogate.ehl import Settings
from surrogate.ehl.friction import contact_friction
from surrogate.files import to_json
from surrogate.formulas.inlet import SPEED_EXPONENT
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import figures as figures_point
from surrogate.screw import full_record as full
from surrogate.screw import record as both
from surrogate.screw.ball_motion import slip_floor
from surrogate.screw.closed_form_record import closed_form_record, page
from surrogate.screw.contacts import make_contacts, ScrewSettings
from surrogate.screw.full_record import _warnings, full_record, law_sentence, solution_record
from surrogate.screw.nut import contact_slip
from surrogate.screw.opened import Contacts
from surrogate.screw.record import most_wear, with_wear
from surrogate.screw.screw_onset import with_raceway
from surrogate.screw.solve import solve_screw
from surrogate.surface import onset_of_surface, shipped_surface, Surface

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
SMALL = Settings(nx=65, ny=65, error_estimate=False)
SETTINGS = ScrewSettings(smooth=SMALL)


def record_at(screw, oil, point, settings):
    """Return the record of a point."""
    return full_record(screw, oil, point, settings)[1]


def record(rpm, load, settings=SETTINGS):
    """Solve a point at 40 degC."""
    point = OperatingPoint(speed=rpm * math.pi / 30, load=load, temperature=313.15)
    return point, record_at(SCREW, OIL, point, settings)


def test_warnings_begin_beyond_their_limits():
    """A change of 1 %, a film known to 10 % and the clearance are none yet."""

    def warnings(screw=SCREW, *, change=0.0, error=0.0, approach=0.0):
        ball = {'nut': 'loaded', 'side': 'screw', 'film_error': error}
        contact = SimpleNamespace(**ball, opposite_flank_approach=approach)
        found = SimpleNamespace(load_change=change, contacts=[contact])
        return [*_warnings(screw, found)]

    for change, told in ((0.01, 0), (0.0101, 1), (math.nan, 0)):
        assert len(warnings(change=change)) == told
    for error, told in ((0.1, 0), (0.101, 1), (math.nan, 0)):
        assert len(warnings(error=error)) == told
    for approach, told in ((1e-6, 0), (1.1e-6, 1), (math.nan, 0)):
        assert len(warnings(replace(SCREW, flank_clearance=1e-6), approach=approach)) == told
        assert not warnings(replace(SCREW, flank_clearance=None), approach=approach)


def test_record_has_the_keys_of_the_formulas_and_parts_that_add_up():
    """Plain JSON; sliding and rolling of all contacts are the torque without parasitic part."""
    point, found = record(60, 800.0)
    formulas = closed_form_record(SCREW, OIL, point)
    assert formulas.keys() <= found.keys()
    assert formulas['contacts'][0].keys() <= found['contacts'][0].keys()
    assert found['tier'] == 'full'
    assert json.loads(json.dumps(to_json(found), allow_nan=False))
    assert '(estimate)' not in page(found)
    parts = sum(c['sliding_torque_Nm'] + c['rolling_torque_Nm'] for c in found['contacts'])
    assert parts == pytest.approx(found['friction_torque_Nm'], rel=1e-9)
    assert found['energy_error'] < 1e-8
    assert found['rcs'] == max(c['rcs'] for c in found['contacts'])
    worst = max(found['contacts'], key=lambda c: (c['rcs'], -c['film_ratio']))
    assert found['worst_contact'] == {'nut': worst['nut'], 'side': worst['side']}


def test_the_heating_factor_is_that_by_which_a_starved_contact_is_slowed():
    """What is reported without inlet heating is what it would apply."""
    starved = replace(OIL, film_factor=0.5)
    settings = replace(SETTINGS, kinematics='smooth', inlet_heating=False)
    point = OperatingPoint(speed=1000 * math.pi / 30, load=800.0, temperature=313.15)
    told = record_at(SCREW, starved, point, settings)
    assert told['inlet_heating'] is False
    loads = (told['normal_force_loaded_N'], told['normal_force_relieved_N'])
    contacts = make_contacts(OPENED, starved, point, settings)
    heated = make_contacts(OPENED, starved, point, replace(settings, inlet_heating=True))
    slowed = min(
        hot.entrainment(load) / cold.entrainment(load)
        for cold, hot in zip(contacts, heated, strict=True)
        for load in loads
    )
    assert told['inlet_heating_factor'] == pytest.approx(slowed**SPEED_EXPONENT, rel=1e-9)
    flooded = record_at(SCREW, OIL, point, settings)['inlet_heating_factor']
    assert flooded < told['inlet_heating_factor'] < 1.0


def test_friction_coefficient_lies_between_film_and_boundary():
    _, rest = record(0, 500.0)
    _, moving = record(600, 500.0)
    expected = SCREW.roughness.asperity_friction
    assert rest['friction_coefficient'] == pytest.approx(expected, rel=0.02)
    assert 0 < moving['friction_coefficient'] < 0.5 * rest['friction_coefficient']


def test_friction_is_integrated_with_the_slip_of_the_balance():
    point = OperatingPoint(speed=60 * math.pi / 30, load=800.0, temperature=313.15)
    # Contacts under the very forces of the balance.
    agreed = replace(SETTINGS, coupling_tolerance=1e-4)
    for contact in solve_screw(OPENED, OIL, point, settings=agreed).contacts:
        slip_x, slip_y = contact_slip(SCREW, contact.pressed, contact.side, contact.motion)
        found = contact_friction(
            contact.pressed,
            slip_x=slip_x,
            slip_y=slip_y,
            asperity_friction=SCREW.roughness.asperity_friction,
            asperity_share=contact.solved.friction_share,
            slip_floor=slip_floor(SCREW, contact.motion.screw_speed),
        )
        assert found.power == pytest.approx(contact.ball.slip_power, rel=2e-3)


def test_wear_is_by_the_load_on_asperities_where_rcs_is_a_share():
    """At 600 rev/min and 53 degC 3000 N lie inside the zone, 1000 N outside, and slide on more."""
    speed = 600 * math.pi / 30
    light, heavy = (
        closed_form_record(SCREW, OIL, OperatingPoint(speed=speed, load=load, temperature=326.15))
        for load in (1000.0, 3000.0)
    )
    assert heavy['rcs'] < 0.01 < light['rcs']
    assert heavy['asperity_power_W'] > 1.2 * light['asperity_power_W'] > 0
    loads = [
        contact['asperity_share'] * contact['normal_force_N']
        for contact in (light['contacts'][0], heavy['contacts'][0])
    ]
    assert loads[1] > loads[0]
    # The area of the ellipse grows faster than the load on the asperities.
    assert heavy['asperity_pressure_Pa'] < light['asperity_pressure_Pa']
    assert 'asperity wear        {:.3g} MPa, {:.3g} mW'.format(
        1e-6 * heavy['asperity_pressure_Pa'], 1e3 * heavy['asperity_power_W']
    ) in page(heavy)


def test_the_most_wear_stands_beside_rcs_in_either_tier():
    """Over all four contacts; none on a relieved nut without load, by the slip of the balance."""
    point, full = record(60, 3000.0)
    for found in (full, closed_form_record(SCREW, OIL, point)):
        for name in ('asperity_pressure_Pa', 'asperity_power_W'):
            each = [contact[name] for contact in found['contacts']]
            assert found[name] == max(each) > 0
            assert each[2:] == [0.0, 0.0]
    # Both contacts of a ball share its spin as friction likes it, so the sum is what agrees.
    closed = closed_form_record(SCREW, OIL, point)
    for name in ('asperity_pressure_Pa', 'asperity_power_W'):
        both = [sum(one[name] for one in found['contacts']) for found in (full, closed)]
        assert both[0] == pytest.approx(both[1], rel=0.15)


def test_wear_is_load_times_share_over_area_and_times_the_sliding():
    """Nothing without load, and unknown where the share is."""
    contact = {'normal_force_N': 20.0, 'asperity_share': 0.1}
    contact |= {'semi_axis_x_m': 1e-4, 'semi_axis_y_m': 2e-4}
    found = with_wear(contact, 0.5)
    assert found['asperity_power_W'] == pytest.approx(1.0)
    assert found['asperity_pressure_Pa'] == pytest.approx(1e8 / math.pi)
    none = with_wear(contact | {'normal_force_N': 0.0, 'asperity_share': math.nan}, math.nan)
    assert none['asperity_power_W'] == none['asperity_pressure_Pa'] == 0.0
    unknown = with_wear(contact | {'asperity_share': math.nan}, 0.5)
    assert math.isnan(most_wear([found, unknown])['asperity_power_W'])


def test_the_record_says_where_contact_is_from():
    """By the law and its raceway, or what stands for it; the scatter of RCS where it rolls."""
    new, run_in = (
        law_sentence(with_raceway(SCREW, state=state), SETTINGS) for state in ('new', 'run_in')
    )
    assert new == (
        'roughness that rolls, new, summits cut at 7 GPa; film at the onset by the topography, '
        'within 1.15 of nine of ten marches'
    )
    assert 'rolls, run in, summits cut at 3 GPa; film' in run_in
    assert law_sentence(with_raceway(SCREW, rms=0.0), SETTINGS) == 'no roughness'
    assert law_sentence(SCREW, replace(SETTINGS, kinematics='smooth')) == 'no roughness'
    _, rolling = record(60, 800.0)
    assert rolling['asperity_law'] == law_sentence(SCREW, SETTINGS)
    assert rolling['rcs_deviation'] > 0
    point, smooth = record(60, 800.0, replace(SETTINGS, kinematics='smooth'))
    assert math.isnan(smooth['rcs_deviation'])
    formulas = closed_form_record(SCREW, OIL, point)
    for name in ('asperity_law', 'rcs_deviation'):
        assert name not in formulas


def test_moved_forces_are_warned_about():
    """A nut near unloading at high speed."""
    once = ScrewSettings(smooth=SMALL, kinematics='smooth', coupling_tolerance=math.inf)
    _, found = record(3000, 2600.0, once)
    assert found['load_change'] > 0.02
    assert any(text.startswith('balls: friction') for text in found['warnings'])
    _, again = record(3000, 2600.0, replace(once, coupling_tolerance=1e-3))
    assert again['load_change'] < 1e-3
    assert not any(text.startswith('balls: friction') for text in again['warnings'])
    assert again['friction_torque_Nm'] != found['friction_torque_Nm']


def test_idle_nut_and_failure_give_a_reason():
    _, idle = record(600, 3.0 * SCREW.preload)
    assert [bool(c['reason']) for c in idle['contacts']] == [False, False, True, True]
    assert idle['normal_force_relieved_N'] == 0.0
    # The ratings are those of the formulas, their fitted ranges are left to them.
    assert [text[:30] for text in idle['warnings']] == ['load: the relieved nut carries']
    failed = ScrewSettings(smooth=Settings(newton_limit=1), kinematics='smooth')
    _, none = record(600, 500.0, failed)
    assert 'smooth contact' in none['status']
    assert none['converged'] is False
    numbers = ('efficiency', 'friction_torque_Nm', 'rcs', 'friction_coefficient')
    for key in (*numbers, 'minimum_film_m', 'max_pressure_Pa', 'film_ratio'):
        assert to_json(none)[key] is None
    assert none['contacts'][0]['reason'] == none['status']


def test_a_third_contact_is_reported_when_it_appears():
    """Zero clearance: the side with the smaller angle reaches its other flank; 10 um: none."""
    point = OperatingPoint(speed=2 * math.pi, load=800.0, temperature=313.15)
    tight = record_at(replace(SCREW, flank_clearance=0.0), OIL, point, SETTINGS)
    warned = [text for text in tight['warnings'] if 'third contact' in text]
    reached = [c for c in tight['contacts'] if c['opposite_flank_approach_m'] > 0]
    assert len(warned) == len(reached) == 2
    assert all(c['contact_angle_rad'] < SCREW.contact_angle for c in reached)
    wide = record_at(replace(SCREW, flank_clearance=1e-5), OIL, point, SETTINGS)
    assert not any('third contact' in text for text in wide['warnings'])


def test_hysteresis_adds_its_couple_to_the_torque():
    """Friction torque grows by 4 F us/w per ball and nut and the record holds the force."""
    point = OperatingPoint(speed=20 * math.pi, load=0.0, temperature=313.15)
    smooth = ScrewSettings(smooth=SMALL, kinematics='smooth')
    plain = record_at(SCREW, OIL, point, smooth)
    lossy = record_at(replace(SCREW, hysteresis_loss=0.01), OIL, point, smooth)
    added = [
        lossy['contacts'][k]['rolling_force_N'] - plain['contacts'][k]['rolling_force_N']
        for k in range(4)
    ]
    assert min(added) > 2e-4
    power = 2 * SCREW.loaded_balls_per_nut * plain['entrainment_speed_m_s'] * sum(added)
    rise = lossy['friction_torque_Nm'] - plain['friction_torque_Nm']
    assert rise == pytest.approx(power / point.speed, rel=0.02)


def test_picture_has_a_column_per_pressed_contact(tmp_path):
    """Two columns beyond unloading; labels with units; the file appears whole."""
    point = OperatingPoint(speed=2.0, load=3.0 * SCREW.preload, temperature=313.15)
    found = solve_screw(OPENED, OIL, point, settings=SETTINGS)
    record = solution_record(OPENED, OIL, point, found, SETTINGS)
    figure = figures_point.figure_point(SCREW, found, record)
    titles = [axes.get_title() for axes in figure.axes if 'nut' in axes.get_title()]
    assert len(titles) == 2
    labels = ' '.join(axes.get_ylabel() for axes in figure.axes)
    assert 'total pressure [GPa]' in labels
    assert 'film [nm]' in labels
    path = figures_point.draw_point(tmp_path, SCREW, found, record)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_a_failed_point_is_drawn_without_its_contacts(tmp_path):
    """No column for a contact without a solution; the record is not lost."""
    point = OperatingPoint(speed=60.0, load=500.0, temperature=313.15)
    failed = ScrewSettings(smooth=Settings(newton_limit=1), kinematics='smooth')
    found = solve_screw(OPENED, OIL, point, settings=failed)
    assert not found.converged
    record = solution_record(OPENED, OIL, point, found, failed)
    assert figures_point.draw_point(tmp_path, SCREW, found, record).exists()


def test_films_of_hardly_pressed_contacts_are_warned_about():
    """Near unloading at high speed the relieved nut floats; each contact tells its error."""
    settings = ScrewSettings(kinematics='smooth')
    point = OperatingPoint(speed=200.0, load=2520.0, temperature=313.15)
    found = record_at(SCREW, OIL, point, settings)
    assert found['contacts'][0]['film_error'] < 0.01
    assert found['contacts'][2]['film_error'] > 0.1
    assert any('hardly pressed' in text for text in found['warnings'])


def test_normal_forces_are_those_of_the_solve():
    """A nut about to unload is idle in the head of the record as in its contacts."""
    _, found = record(600, 0.9985 * 2**1.5 * SCREW.preload)
    assert found['normal_force_relieved_N'] == 0.0
    assert found['contacts'][2]['normal_force_N'] == 0.0


def test_every_key_is_declared_with_its_meaning():
    """Those of the closed form for both tiers, the others for the full one."""
    point, found = record(60, 800.0)
    formulas = closed_form_record(SCREW, OIL, point)
    assert both.KEYS.keys() == formulas.keys() | {'contact_onset', 'typical_drag'}
    assert both.CONTACT_KEYS.keys() == formulas['contacts'][0].keys()
    assert full.KEYS.keys() == found.keys() - formulas.keys()
    solved = found['contacts'][0].keys()
    assert full.CONTACT_KEYS.keys() == solved - both.CONTACT_KEYS.keys()
    onset = onset_of_surface(Surface.load(shipped_surface())).record()
    assert all(f'`{key}`' in both.KEYS['contact_onset'] for key in onset)
