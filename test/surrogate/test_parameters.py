# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Datasheets: shipped values, ranges, and one sentence for each kind of mistake."""

from dataclasses import asdict, replace
import math
import re

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import (
    BallRoughness,
    DATA,
    load_lubricant,
    load_screw,
    OperatingPoint,
    Screw,
)
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
def test_shipped_oils_have_their_viscosity_boundary_film_and_a_source(name):
    """ISO 3448 number at 40 degC; 3 nm between 1 and 5 nm, fully flooded."""
    oil = load_lubricant(name)
    assert oil.kinematic_viscosity_40 * 1e6 == pytest.approx(int(name.split('_')[-1]))
    assert oil.viscosity == pytest.approx(oil.kinematic_viscosity_40 * oil.density, rel=0.02)
    assert len(oil.source) > 20
    floors = (oil.film_floor_low, oil.film_floor, oil.film_floor_high)
    assert [1e9 * floor for floor in floors] == pytest.approx([1.0, 3.0, 5.0])
    assert oil.film_factor == 1.0


def test_an_oil_may_state_a_limiting_shear_stress():
    """Its values have no trace of a limit that is absent: hashes of inputs stay."""
    oil = load_lubricant('iso_vg_68')
    assert oil.limiting_shear_share is None
    assert 'limiting_shear_share' not in oil.stated()
    limited = replace(oil, limiting_shear_share=0.07)
    assert limited.stated() == oil.stated() | {'limiting_shear_share': 0.07}
    assert lubricant_state(limited, 313.15).limiting_shear_share == 0.07


def test_what_no_contact_depends_on_leaves_no_trace_among_the_inputs(screw):
    """A rating, a length and supports: surfaces and kept chains of a screw stay valid."""
    assert screw.service() == {}
    rated = replace(screw, dynamic_rating=25e3, free_length=1.0, support='fixed_free')
    assert rated.stated() == screw.stated()
    assert not set(screw.stated()) & set(Screw.SERVICE)
    assert rated.service() == {'dynamic_rating': 25e3, 'free_length': 1.0, 'support': 'fixed_free'}


DRAG = {'typical_drag_low': 0.1, 'typical_drag': 0.3, 'typical_drag_high': 0.9}


def test_a_typical_drag_has_its_range_until_it_is_identified(screw, refused):
    """Absent it leaves no trace among the inputs; beside an identified torque it has no sense."""
    assert screw.likely_drag is None
    assert not set(screw.stated()) & set(DRAG)
    sheet = replace(screw, **DRAG)
    assert sheet.likely_drag == (0.1, 0.3, 0.9)
    assert sheet.stated() == screw.stated() | DRAG
    with refused('drag_in_part'):
        replace(screw, typical_drag=0.3)
    with refused('drag_range'):
        replace(screw, **DRAG | {'typical_drag_low': 0.4})
    with refused('drag_identified'):
        replace(sheet, parasitic_torque=0.2)


MISTAKES = [
    ('lead_mm: 10.0\n', '', 'missing_lead_mm'),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nfriction: 0.1', 'unknown_friction_name'),
    ('lead_mm: 10.0', 'lead_m: 0.01', 'lead_m_lead_mm'),
    ('rms_um: 0.12', 'rms_nm: 120.0', 'roughness_rms_nm_rms_um'),
    ('rms_um: 0.12', 'rms_um: 0.12\n  rms_slope_rad: 0.03', 'rms_slope_rad_wrong'),
    ('  rms_um: 0.12', '  rms_um: -0.1', 'roughness_rms_um_0_1'),
    ('cutoff_long_mm: 0.25', 'cutoff_long_mm: 0.002', 'roughness_long_cut'),
    ('  fractal_dimension: 2.68\n', '', 'neither_fractal_dimension'),
    ('fractal_dimension: 2.68', 'rms_slope_deg: 30.0', 'rms_slope_30'),
    (
        'fractal_dimension: 2.68',
        'fractal_dimension: 2.68\n  rms_slope_deg: 1.0',
        'fractal_dimension_2_68',
    ),
    ('rms_um: 0.12', 'rms_um: 0.12\n  lay: longitudinal', 'roughness_fan_angle'),
    ('state: new', 'state: old', 'state_old_run_in'),
    ('state: new', 'traced: old', 'traced_old_new'),
    ('state: new', 'state: new\n  traced: run_in', 'roughness_traced_run_in'),
    ('state: new', 'run_in_pressure_GPa: 6.0', 'roughness_run_in_pressure_gpa_6'),
    ('state: new', 'run_in_low_GPa: 3.5', 'run_in_pressure_3'),
    ('state: new', 'hardness_GPa: 4.0', 'rising_numbers_up'),
    ('state: new', 'hardness_GPa: .nan', 'hardness_gpa_nan_1'),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nworking_load_N: -1.0', 'working_load_n_1_0'),
    ('roughness:\n', 'ball_roughness: {}\nroughness:\n', 'neither_rms_um_nor'),
    (
        'roughness:\n',
        'ball_roughness: {rms_um: 0.01, grade: G10}\nroughness:\n',
        'ball_roughness_rms_um_grade',
    ),
    ('roughness:\n', 'ball_roughness: {grade: G7}\nroughness:\n', 'grade_g7_g3'),
    ('lead_mm: 10.0', 'lead_mm: 0.01', 'lead_mm_0_01_0_5'),
    ('lead_mm: 10.0', 'lead_mm: .nan', 'lead_mm_nan_0_5'),
    ('lead_mm: 10.0', 'lead_mm: .inf', 'lead_mm_inf_0_5'),
    ('lead_mm: 10.0', 'lead_mm: ten', 'lead_mm_ten_0_5'),
    ('lead_mm: 10.0', 'lead_mm: 1e1', 'write_1_0e_8'),
    ('poisson_ratio: 0.3', 'poisson_ratio: true', 'poisson_ratio_true'),
    ('loaded_balls_per_nut: 51', 'loaded_balls_per_nut: 51.5', 'balls_whole'),
    ('ball_diameter_mm: 5.953', 'ball_diameter_mm: 16.5', 'less_than_pitch_radius_mm'),
    ('raceway:', 'raceway: 3\nunused:', 'unknown_unused'),
    ('name: nominal', 'name: [', 'cannot_be_read'),
    ('name: nominal', 'name: ../nominal', 'name_nominal_letters'),
    ('lead_mm: 10.0', 'lead_mm: 10.0\nlead_mm: 12.0', 'lead_mm_stands_twice'),
    ('preload_N: 990.0', 'preload_N: 99000.0', 'preload_n_99000_n'),
]


@pytest.mark.parametrize(('old', 'new', 'sentence'), MISTAKES, ids=[m[2] for m in MISTAKES])
def test_a_mistake_in_a_datasheet_is_one_sentence(tmp_path, old, new, sentence, refused):
    path = tmp_path / 'screw.yaml'
    assert old in SCREW
    path.write_text(SCREW.replace(old, new, 1), encoding='utf-8')
    caught = refused(sentence, load_screw, str(path))
    assert str(path) in str(caught.value)
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
    with refused('cutoff_short_um_roughness', long=f'{long * 1e6:g}'):
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


def test_the_film_floor_lies_between_its_bounds(oil, refused):
    """On a bound it is inside; beyond it is one sentence."""
    assert replace(oil, film_floor=1e-9).film_floor == 1e-9
    assert replace(oil, film_floor=5.0 * 1e-9).film_floor == 5.0 * 1e-9
    for floor in (0.9e-9, 5.1e-9):
        refused('film_floor_nm', replace, oil, film_floor=floor)


@pytest.mark.parametrize('content', ['', '3', '[1, 2]', 'name', '\x00'])
def test_a_file_that_is_no_mapping_is_refused(tmp_path, content, refused):
    path = tmp_path / 'oil.yaml'
    path.write_text(content, encoding='utf-8')
    sentence = 'oil_yaml_read' if content == '\x00' else 'oil_yaml_mapping'
    refused(sentence, load_lubricant, str(path))


def test_the_source_is_mandatory(tmp_path, refused):
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
