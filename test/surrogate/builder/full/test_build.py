# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of the full tier on a fast stand-in: nodes, band, errors, failures, the header."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.asperities.law import NOTHING
from surrogate.builder.full.build import build_full
from surrogate.builder.full.chain import point_inputs, solved_chain
from surrogate.builder.full.settings import FullSettings
from surrogate.ehl import Condition
from surrogate.files import InputError
from surrogate.formulas.geometry import screw_contact, SIDES
from surrogate.formulas.inlet import inlet_speed
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.load_sharing import idle_load, normal_force, nut_forces
from surrogate.screw import closed_form
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import FIELDS, Surface, Validity
from surrogate.surface import file as surface_file
from surrogate.surface.aims import rcs_tolerance
from surrogate.surface_tools.describe import info_page, info_record

pytestmark = pytest.mark.usefixtures('small_tiles')
SETTINGS = FullSettings(
    speed_range=(0.5, 100.0),
    load_range=(-2000.0, 2000.0),
    temperature_range=(293.15, 333.15),
    speed_nodes=24,
    temperature_nodes=4,
    held_out=12,
    load_cells=3,
)


@pytest.fixture(scope='module', name='data')
def build(screw, oil, stand_in):
    """Build once."""
    return build_full(screw, oil, SETTINGS, stand_in.run)


@pytest.fixture(name='solve')
def make_solve(screw, oil, stand_in):
    """Return the solve of a point [rad/s, N, K] of the surface."""

    def solve(speed, load, heat):
        given = point_inputs(screw, oil, load, heat, speed)
        return solved_chain(stand_in.chain(given))[0][0]

    return solve


def test_file_of_the_full_tier_is_read_back(data, tmp_path):
    """Written, verified and looked up; tier, band and scatter between strips are in it."""
    assert json.loads(json.dumps(data.header)) == data.header
    surface_file.write(tmp_path / 'full.npz', data)
    surface = Surface.load(tmp_path / 'full.npz')
    assert surface.tier == 'full'
    assert surface.header['format_version'] == surface_file.FORMAT_VERSION
    low, high = surface.limit_band
    assert 0 < low < 1 < high
    point = surface.lookup(3.0, 500.0, 313.15)
    assert point.validity is Validity.VALID
    assert 0 < point.rcs_std < 1
    assert point.rcs_stderr == point.rcs_std
    assert math.isnan(point.friction_torque_std)


def test_nodes_are_what_solves_give(data, screw, oil, stand_in):
    """Torque and films are the formulas times the ratio, contact is that of the law."""
    low, high = SETTINGS.speed_range
    checked = 0
    for i, j, k in np.argwhere(~data.mask)[::7]:
        speed = math.exp(data.speed_coordinate[i] + data.log_onset[j, k])
        place = speed, float(data.load[j]), float(data.temperature[k])
        formula = closed_form.solve(Contacts.of(screw), oil, *place)
        assert data.fields['rcs'][i, j, k] == pytest.approx(float(formula.rcs), rel=1e-9)
        film = max(0.9 * float(formula.central_film), oil.film_floor)
        assert data.fields['central_film'][i, j, k] == pytest.approx(film, rel=0.01)
        if low <= speed <= high:
            torque = stand_in.torque(*place) * float(formula.friction_torque)
            assert data.fields['friction_torque'][i, j, k] == pytest.approx(torque, rel=2e-3)
            checked += 1
    assert checked > 40
    for name in FIELDS:
        assert np.isnan(data.fields[name][data.mask]).all()


def test_the_deviation_of_a_node_is_that_of_the_law_at_its_worst_contact(data, screw, oil):
    """
    An onset half of the deviation later and sooner, behind the heating of the inlet.

    Where contacts are nearly alike, another one may be the worst if all begin later.

    """
    arm, law = no_slip_rates(screw).entrainment, Contacts.of(screw).law

    def worst(speed, load, heat, half):
        forces = [float(normal_force(screw, force)) for force in nut_forces(load, screw.preload)]
        shifted, fluid = law.shifted(half), oil_at(oil, heat)
        return max(
            shifted.contact(
                side,
                screw_contact(screw, side),
                Condition(
                    load=force,
                    entrainment_speed=float(inlet_speed(screw, oil, side, force, speed, heat)),
                ),
                fluid,
                oil.film_floor,
            ).rcs
            for force in forces
            for side in SIDES
            if force > 0.0
        )

    for i, j, k in np.argwhere(~data.mask)[::29]:
        speed = arm * np.exp(data.speed_coordinate[i] + data.log_onset[j, k])
        place = speed, float(data.load[j]), float(data.temperature[k])
        difference = worst(*place, 0.5) - worst(*place, -0.5)
        deviation = data.deviations['rcs'][i, j, k]
        assert deviation == pytest.approx(difference, rel=1e-6, abs=10 * NOTHING)


def test_rcs_at_the_origin_of_the_speed_is_one_percent(data):
    """In the middle of the contacts, whose sides touch a little more; RCS falls with the speed."""
    surface = Surface(data)
    for heat in data.temperature.tolist():
        onset = surface.onset_speed(0.0, heat)
        assert surface.lookup(onset, 0.0, heat).rcs == pytest.approx(0.0130, rel=0.1)
    shares = np.where(data.mask, np.nan, data.fields['rcs'])
    assert not (np.diff(shares, axis=0) > 0).any()


def test_every_point_of_the_range_has_an_answer(data):
    """Corners and random points."""
    surface, drawn = Surface(data), np.random.default_rng(5)
    for _ in range(300):
        speed = math.exp(drawn.uniform(*np.log(SETTINGS.speed_range)))
        load = float(drawn.choice([-2000.0, 2000.0, drawn.uniform(-2000, 2000)]))
        heat = float(drawn.choice([293.15, 333.15, drawn.uniform(293.15, 333.15)]))
        point = surface.lookup(speed, load, heat)
        assert point.validity is Validity.VALID
        assert all(math.isfinite(getattr(point, name)) for name in FIELDS)


def test_every_corner_is_near_what_solves_give(data, solve):
    """Uniform over speed, load and temperature, within what is aimed at."""
    surface, drawn = Surface(data), np.random.default_rng(11)
    for _ in range(100):
        speed = math.exp(drawn.uniform(*np.log(SETTINGS.speed_range)))
        load, heat = drawn.uniform(-2000, 2000), drawn.uniform(293.15, 333.15)
        found, solved = surface.lookup(speed, load, heat), solve(speed, load, heat)
        assert found.friction_torque == pytest.approx(solved.friction_torque, rel=0.05)
        assert abs(found.rcs - solved.rcs) < rcs_tolerance(solved.rcs)


def test_errors_are_those_at_held_out_points(data):
    """Where one was measured the cells have an error, and the worst is in the header."""
    assert np.isfinite(data.errors['rcs']).any()
    assert 0 < data.header['reached'] < 1


@pytest.mark.parametrize(
    'ranges',
    [
        {'load_range': (0.0, 1500.0)},
        {'load_range': (-4000.0, 2800.0)},
        {'load_range': (3000.0, 3500.0)},
        {'speed_range': (60.0, 90.0)},
        {'temperature_range': (312.15, 314.15)},
        {'temperature_nodes': 2, 'load_cells': 1, 'idle_halvings': 0},
    ],
)
def test_any_range_is_built_and_answers(screw, oil, stand_in, ranges):
    """Lopsided, one-sided, narrow, far from the onset, coarse."""
    settings = replace(SETTINGS, **{'held_out': 9, 'temperature_nodes': 3, **ranges})
    data = build_full(screw, oil, settings, stand_in.run)
    surface, drawn = Surface(data), np.random.default_rng(7)
    assert math.isfinite(data.header['reached'])
    for _ in range(40):
        speed = math.exp(drawn.uniform(*np.log(settings.speed_range)))
        load = drawn.uniform(*settings.load_range)
        found = surface.lookup(speed, load, drawn.uniform(*settings.temperature_range))
        assert found.validity is Validity.VALID
        assert 0 <= found.rcs <= 1


def test_same_work_same_file(data, screw, oil, stand_in):
    """In another order of tasks, as many workers finish them, the file has the same hash."""

    def backwards(tasks):
        return dict(reversed(stand_in.run(dict(reversed(tasks.items()))).items()))

    assert build_full(screw, oil, SETTINGS, backwards).sha256 == data.sha256
    other = replace(SETTINGS, speed_nodes=20)
    assert build_full(screw, oil, other, stand_in.run).sha256 != data.sha256


def test_failed_chains_leave_masked_nodes(data, screw, oil, stand_in):
    """The column of the highest load in cold oil; lookups beside it are NaN, others stay."""

    def run(tasks):
        gone = f'{2000.0!r} N, temperature 0'
        done = stand_in.run(tasks)
        return {name: None if name == gone else one for name, one in done.items()}

    broken = build_full(screw, oil, SETTINGS, run)
    for j in (0, -1):
        assert broken.mask[:, j, 0].all()
    rest = np.s_[:, 1:-1, 1:]
    assert np.array_equal(broken.mask[rest], data.mask[rest])
    surface = Surface(broken)
    assert math.isnan(surface.lookup(10.0, 1990.0, 294.0).rcs)
    assert surface.lookup(10.0, 100.0, 320.0).validity is Validity.VALID


def test_nothing_that_converges_is_one_sentence(screw, oil):
    """No file of masked nodes."""
    with pytest.raises(InputError, match='no point of the surface converged'):
        build_full(screw, oil, SETTINGS, dict.fromkeys)


def test_what_makes_no_sense_is_refused_before_any_work(screw, oil, refused):
    """The builder is never asked to solve."""
    wrong = replace(SETTINGS, load_range=(100.0, -100.0))
    refused('load_range_2', build_full, screw, oil, wrong, None)
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    with pytest.raises(InputError, match='rms_um of roughness is 0 um'):
        build_full(smooth, oil, SETTINGS, None)
    long = with_raceway(screw, cutoff_short=400e-6, cutoff_long=8e-3)
    with pytest.raises(InputError, match='waves are longer than half of the contact'):
        build_full(long, oil, SETTINGS, None)


def test_info_says_where_contact_begins_and_what_was_reached(data, tmp_path):
    """And nothing of the error where it is not known."""
    (low, high), numerics = (data.header[name] for name in ('limit_band', 'numerical_band'))
    path = tmp_path / 'full.npz'
    for reached in (2.5, None):
        surface_file.write(path, replace(data, header={**data.header, 'reached': reached}))
        page = info_page(info_record(path, surface_file.read(path)))
        told = 'begins between {:.2g} and {:.2g} times the stated speed, by {}'
        assert told.format(low, high, 'what is not known') in page
        assert told.format(*numerics, 'the numerics') in page
        assert ('has 2.5 times the error that is aimed at' in page) is (reached is not None)


def test_accuracy_is_not_known_without_a_held_out_point(screw, oil, stand_in):
    """All of them fail: no number, and errors are NaN."""

    def run(tasks):
        held = all('held out' in name for name in tasks)
        return dict.fromkeys(tasks) if held else stand_in.run(tasks)

    found = build_full(screw, oil, SETTINGS, run)
    assert found.header['reached'] is None
    assert np.isnan(found.errors['rcs']).all()


def test_beyond_the_idle_load_fields_jump_once(screw, oil, stand_in):
    """A node on either side of it, both a break."""
    wide = replace(SETTINGS, load_range=(0.0, 3500.0))
    data = build_full(screw, oil, wide, stand_in.run)
    idle = idle_load(screw)
    beside = [load for load in data.header['load_breaks'] if abs(load / idle - 1) < 1e-3]
    assert len(beside) == 2
