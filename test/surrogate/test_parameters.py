# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Datasheets: shipped values, ranges, and one sentence for each kind of mistake."""

from dataclasses import asdict, replace
import math
from pathlib import Path
import re

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import InputError
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import BallRoughness, DATA, load_lubricant, load_screw, OperatingPoint
from surrogate.raceway.ball import ball_of
from surrogate.raceway.fractal import PublishedRoughness
from surrogate.units import ZERO_CELSIUS

SCREW = (DATA / 'screws' / 'nominal.yaml').read_text(encoding='utf-8')
OIL = (DATA / 'lubricants' / 'iso_vg_68.yaml').read_text(encoding='utf-8')

PLACES = {
    'contact_angle': ('screw', 'contact_angle', math.pi / 180),
    'normal_force_at_preload': None,
    'young_modulus': ('screw.raceway', 'young_modulus', 1),
    'poisson_ratio': ('screw.raceway', 'poisson_ratio', 1),
    'viscosity': ('oil', 'viscosity', 1),
    'pressure_viscosity': ('oil', 'pressure_viscosity', 1),
    'density': ('oil', 'density', 1),
    'eyring_stress': ('oil', 'eyring_stress', 1),
    'asperity_friction': ('screw.roughness', 'asperity_friction', 1),
    'roughness_rms': ('screw.roughness', 'rms', 1),
    'fractal_dimension': ('screw.roughness', 'fractal_dimension', 1),
    'fractal_roughness': ('published', 'fractal_roughness', 1),
    'fractal_sample_length': ('published', 'sample_length', 1),
    'cutoff_long': ('screw.roughness', 'cutoff_long', 1),
    'cutoff_short': ('screw.roughness', 'cutoff_short', 1),
    'central_film_at_502mm_s': None,
    'rcs_limit': None,
    'efficiency_limit': None,
    'reference_temperature': ('oil', 'reference_temperature', 1),
    'kinematic_viscosity_40C': ('oil', 'kinematic_viscosity_40', 1),
    'kinematic_viscosity_100C': ('oil', 'kinematic_viscosity_100', 1),
    'ball_density': ('screw.ball', 'density', 1),
    'film_floor': ('oil', 'film_floor', 1),
    'shortest_wavelength': ('published', 'shortest_wavelength', 1),
    'fractal_scale_ratio': ('screw.roughness', 'scale_ratio', 1),
    'fractal_ridges': ('screw.roughness', 'ridges', 1),
    'speed_limit_Dn': ('screw', 'speed_limit', math.pi / 30),
}
"""Where a quantity of the table stands in the datasheets; None: it is a result or a limit."""


def test_nominal_datasheets_hold_every_quantity_of_the_table(table, screw, oil):
    owners = {'screw': screw, 'oil': oil, 'published': PublishedRoughness()}
    for row in table('nominal_screw.csv'):
        place = PLACES.get(row['quantity'], ('screw', row['quantity'], 1))
        if place is None:
            continue
        owner: object = owners[place[0].split('.')[0]]
        for part in place[0].split('.')[1:]:
            owner = getattr(owner, part)
        assert getattr(owner, place[1]) == pytest.approx(
            float(row['value']) * place[2], rel=1e-12
        ), row['quantity']


def test_vg_68_has_the_nominal_viscosity_at_40_degrees(oil):
    assert float(lubricant_state(oil, 40 + ZERO_CELSIUS).viscosity) == 0.060


@pytest.mark.parametrize('name', ['iso_vg_32', 'iso_vg_68', 'iso_vg_100'])
def test_grades_have_their_viscosity_and_a_source(name):
    oil = load_lubricant(name)
    assert oil.kinematic_viscosity_40 * 1e6 == pytest.approx(int(name.split('_')[-1]))
    assert oil.viscosity == pytest.approx(oil.kinematic_viscosity_40 * oil.density, rel=0.02)
    assert len(oil.source) > 20


MISTAKES = [
    ('lead_mm: 10.0\n', '', 'missing key lead_mm'),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nfriction: 0.1', 'unknown key friction, allowed are name'),
    ('lead_mm: 10.0', 'lead_m: 0.01', 'lead_m has a wrong unit, the key is lead_mm'),
    ('rms_um: 0.12', 'rms_nm: 120.0', 'roughness: rms_nm has a wrong unit, the key is rms_um'),
    (
        'rms_um: 0.12',
        'rms_um: 0.12\n  rms_slope_rad: 0.03',
        'roughness: rms_slope_rad has a wrong unit, the key is rms_slope_deg',
    ),
    ('  rms_um: 0.12', '  rms_um: -0.1', 'roughness: rms_um is -0.1, allowed is 0 to 10'),
    ('cutoff_long_mm: 0.25', 'cutoff_long_mm: 0.002', 'screw.yaml: roughness: long cut-off is 2'),
    ('  fractal_dimension: 2.68\n', '', 'neither fractal dimension nor rms slope is given'),
    ('fractal_dimension: 2.68', 'rms_slope_deg: 30.0', 'rms slope is 30 deg, allowed is 0.553'),
    (
        'fractal_dimension: 2.68',
        'fractal_dimension: 2.68\n  rms_slope_deg: 1.0',
        'fractal dimension 2.68 has the rms slope 2.18 deg, stated is 1 deg',
    ),
    ('rms_um: 0.12', 'rms_um: 0.12\n  lay: longitudinal', 'roughness: fan angle is missing'),
    ('state: new', 'state: old', "state is 'old', allowed is run_in or new"),
    ('state: new', 'traced: old', "traced is 'old', allowed is new or run_in"),
    (
        'state: new',
        'state: new\n  traced: run_in',
        'screw.yaml: roughness: traced is run_in and state is new, allowed is state: run_in for a '
        'profile that was traced after running in',
    ),
    (
        'state: new',
        'run_in_pressure_GPa: 6.0',
        'screw.yaml: roughness: run_in_pressure_GPa is 6 GPa between run_in_low_GPa (2) and '
        'run_in_high_GPa (5), allowed are rising numbers up to the hardness (7 GPa)',
    ),
    ('state: new', 'run_in_low_GPa: 3.5', 'is 3 GPa between run_in_low_GPa (3.5) and'),
    ('state: new', 'hardness_GPa: 4.0', 'allowed are rising numbers up to the hardness (4 GPa)'),
    ('state: new', 'hardness_GPa: .nan', 'hardness_GPa is nan, allowed is 1 to 20'),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nworking_load_N: -1.0', 'working_load_N is -1, allowed is 0'),
    ('roughness:\n', 'ball_roughness: {}\nroughness:\n', 'neither rms_um nor grade is given'),
    (
        'roughness:\n',
        'ball_roughness: {rms_um: 0.01, grade: G10}\nroughness:\n',
        'ball_roughness: rms_um and grade are given, allowed is one of the two',
    ),
    ('roughness:\n', 'ball_roughness: {grade: G7}\nroughness:\n', "grade is 'G7', allowed is G3"),
    ('lead_mm: 10.0', 'lead_mm: 0.01', 'lead_mm is 0.01, allowed is 0.5 to 200'),
    ('lead_mm: 10.0', 'lead_mm: .nan', 'lead_mm is nan, allowed is 0.5 to 200'),
    ('lead_mm: 10.0', 'lead_mm: .inf', 'lead_mm is inf, allowed is 0.5 to 200'),
    ('lead_mm: 10.0', 'lead_mm: ten', "lead_mm is 'ten', allowed is a number from 0.5 to 200"),
    ('lead_mm: 10.0', 'lead_mm: 1e1', 'write 1.0e-8, not 1e-8'),
    ('poisson_ratio: 0.3', 'poisson_ratio: true', 'poisson_ratio is True, allowed is a number'),
    ('loaded_balls_per_nut: 51', 'loaded_balls_per_nut: 51.5', 'allowed is a whole number'),
    ('ball_diameter_mm: 5.953', 'ball_diameter_mm: 16.5', 'allowed is less than pitch_radius_mm'),
    ('raceway:', 'raceway: 3\nunused:', 'unknown key unused'),
    ('name: nominal', 'name: [', 'cannot be read as YAML'),
    ('name: nominal', 'name: ../nominal', "name is '../nominal', allowed is letters, digits"),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nlead_mm: 12.0', 'key lead_mm stands twice'),
    ('preload_N: 990.0', 'preload_N: 99000.0', 'preload_N is 99000 N, allowed is up to static'),
]


@pytest.mark.parametrize(('old', 'new', 'sentence'), MISTAKES, ids=[m[2][:30] for m in MISTAKES])
def test_a_mistake_in_a_datasheet_is_one_sentence(tmp_path: Path, old, new, sentence):
    path = tmp_path / 'screw.yaml'
    assert old in SCREW
    path.write_text(SCREW.replace(old, new, 1), encoding='utf-8')
    with pytest.raises(InputError, match=re.escape(sentence)) as caught:
        load_screw(str(path))
    assert str(path) in str(caught.value)
    assert '\n' not in str(caught.value)


OLD = (
    'fractal_roughness_nm: 0.97',
    'sample_length_mm: 4.0',
    'shortest_wavelength_um: 8.0',
    'film_floor_nm: 3.0',
)


@pytest.mark.parametrize('old', [OLD, OLD[1:3], *((one,) for one in OLD)])
def test_keys_of_an_old_datasheet_are_named_with_what_to_write_instead(tmp_path: Path, old):
    """One sentence: the file, every old key that it has, and the keys that took their place."""
    path = tmp_path / 'screw.yaml'
    lines = ''.join(f'  {line}\n' for line in old)
    path.write_text(SCREW.replace('roughness:\n', f'roughness:\n{lines}', 1), encoding='utf-8')
    names = ', '.join(line.split(':')[0] for line in old)
    sentence = f'{path}: roughness: {names} {"is" if len(old) == 1 else "are"} not read'
    with pytest.raises(InputError, match=re.escape(sentence)) as caught:
        load_screw(str(path))
    instead = str(caught.value).split('instead', 1)[1]
    for key in ('cutoff_long_mm', 'cutoff_short_um', 'fractal_dimension', 'rms_slope_deg'):
        assert key in instead
    assert instead.endswith('film_floor_nm belongs to the lubricant')
    assert '\n' not in str(caught.value)


def test_a_rough_ball_beside_a_smooth_raceway_needs_a_dimension(screw, refused):
    """The ball shares that of the raceway, which a smooth one need not state."""
    smooth = replace(screw.roughness, rms=0.0, fractal_dimension=None)
    assert replace(screw, roughness=smooth).composite_rms == 0.0
    ball = BallRoughness(grade='G10')
    refused('ball_roughness_given_without', replace, screw, roughness=smooth, ball_roughness=ball)
    rough = replace(screw, roughness=replace(smooth, fractal_dimension=2.5), ball_roughness=ball)
    assert rough.composite_rms == pytest.approx(0.025e-6)


@pytest.mark.parametrize(('grade', 'long'), [('G10', 80e-6), ('G28', 250e-6)])
def test_a_cut_off_that_leaves_the_balls_no_waves_is_refused(screw, grade, long, refused):
    """That of the raceway is theirs too, and lies below their own long one."""
    ball = BallRoughness(grade=grade)
    coarse = replace(screw.roughness, cutoff_long=0.8e-3, cutoff_short=long)
    assert replace(screw, roughness=coarse).roughness.cutoff_short == long
    sentence = f'cutoff_short_um of roughness is {long * 1e6:g} um, allowed is less than the long'
    with pytest.raises(InputError, match=sentence):
        replace(screw, roughness=coarse, ball_roughness=ball)
    refused('long_cut_off', ball_of, coarse, ball)
    finer = replace(coarse, cutoff_short=0.99 * long)
    assert replace(screw, roughness=finer, ball_roughness=ball).composite_rms > screw.composite_rms
    assert ball_of(finer, ball) is not None
    assert replace(screw, roughness=coarse, ball_roughness=BallRoughness(rms=0.0))


def test_heights_of_raceway_and_ball_add_as_squares(screw):
    """Their phases are independent."""
    rough = replace(screw, ball_roughness=BallRoughness(rms=0.05e-6))
    assert rough.composite_rms == pytest.approx(0.13e-6)
    assert screw.composite_rms == screw.roughness.rms


@pytest.mark.parametrize('name', ['iso_vg_32', 'iso_vg_68', 'iso_vg_100'])
def test_shipped_oils_state_their_boundary_film(name):
    """3 nm between 1 and 5 nm, fully flooded."""
    oil = load_lubricant(name)
    floors = (oil.film_floor_low, oil.film_floor, oil.film_floor_high)
    assert [1e9 * floor for floor in floors] == pytest.approx([1.0, 3.0, 5.0])
    assert oil.film_factor == 1.0


def test_the_film_floor_lies_between_its_bounds(oil):
    """On a bound it is inside; beyond it is one sentence."""
    assert replace(oil, film_floor=1e-9).film_floor == 1e-9
    assert replace(oil, film_floor=5.0 * 1e-9).film_floor == 5.0 * 1e-9
    for floor in (0.9e-9, 5.1e-9):
        with pytest.raises(InputError, match=r'film_floor_nm is [\d.]+ nm, allowed is 1 to 5 nm'):
            replace(oil, film_floor=floor)


@pytest.mark.parametrize('content', ['', '3', '[1, 2]', 'name', '\x00'])
def test_a_file_that_is_no_mapping_is_refused(tmp_path: Path, content):
    path = tmp_path / 'oil.yaml'
    path.write_text(content, encoding='utf-8')
    with pytest.raises(InputError, match=r'oil\.yaml: (must be a mapping|cannot be read)'):
        load_lubricant(str(path))


def test_the_source_is_mandatory(tmp_path: Path, refused):
    path = tmp_path / 'screw.yaml'
    path.write_text(re.sub(r'source: >-\n(  .*\n)+', "source: ''\n", SCREW), encoding='utf-8')
    refused('source_text_empty', load_screw, str(path))


@pytest.mark.parametrize(
    ('change', 'sentence'),
    [
        # The two viscosities must fall with temperature.
        ({'kinematic_viscosity_100': 70e-6}, '70_mm2_s'),
        # 60 Pa s contradicts 68 mm2/s times 870 kg/m3 in the same sheet.
        ({'viscosity': 60.0}, 'viscosity_pa_s_60_pa'),
        # The anchor lies inside the range of the sheet.
        ({'minimum_temperature': 50 + ZERO_CELSIUS}, 'reference_temperature_de'),
        ({'film_factor': 0.01}, 'film_factor_0_01'),
    ],
)
def test_an_oil_that_contradicts_itself_is_refused(oil, change, sentence, refused):
    refused(sentence, replace, oil, **change)


def test_an_unknown_name_lists_the_shipped_ones(refused):
    refused('nor_one_shipped', load_lubricant, 'iso_vg_46')


def test_limits_themselves_are_allowed(screw):
    """A value on its limit is inside, in spite of the conversion to SI."""
    assert replace(screw, conformity_nut=0.7).conformity_nut == 0.7
    assert replace(screw, contact_angle=math.radians(70)).contact_angle == math.radians(70)


@given(speed=st.floats(-1e4, 1e4), load=st.floats(-1e6, 1e6))
def test_a_point_and_its_mirror_image_are_one_point(speed, load):
    """Reversing motion and load leaves the opposing load as it was."""
    point = OperatingPoint(speed=speed, load=load, temperature=313.15)
    mirror = replace(point, speed=-speed, load=-load)
    if speed:
        assert mirror.opposing_load == point.opposing_load


def test_sheets_are_frozen(screw):
    with pytest.raises(AttributeError):
        screw.lead = 0.02
    assert set(asdict(screw)) >= {'lead', 'roughness'}
