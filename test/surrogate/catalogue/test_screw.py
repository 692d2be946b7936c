# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Screws out of a catalogue: what is given stays, the rest follows."""

import math
import re

import pytest
from surrogate.catalogue.screw import equal_halves, heavy_preload, screw_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.datasheet_writer import write_sheet
from surrogate.formulas.plausibility import rated_pressure
from surrogate.parameters import load_screw

SIZE = {
    'nominal_diameter': 0.02,
    'lead': 0.005,
    'nut': 'double',
    'turns': 4.0,
    'dynamic_rating': 10910.0,
}


def test_every_value_has_a_note(tmp_path):
    """Given, derived with its way, or typical with its range, behind each number on file."""
    screw, notes = screw_of(CatalogueScrew(**SIZE))
    write_sheet(tmp_path / 'screw.yaml', screw, notes=notes)
    values = (tmp_path / 'screw.yaml').read_text().splitlines()[2:]
    bare = [line for line in values if not re.search(r'  # (given|derived|typical)\b', line)]
    assert bare == ['raceway:', 'ball:', 'roughness:']
    assert notes['lead_mm'] == notes['dynamic_rating_kN'] == 'given'
    assert notes['preload_N'] == 'derived (5 % of C 10.91 kN, usual 2 to 10 %)'
    assert notes['roughness.fractal_dimension'] == 'typical (2.3 to 2.7)'
    assert load_screw(str(tmp_path / 'screw.yaml')).name == screw.name == 'screw_20x5'


def test_what_follows_from_the_size():
    """Ball circle, balls, preload and the load that unloads a nut."""
    screw, _ = screw_of(CatalogueScrew(**SIZE, ball_diameter=3.175e-3))
    assert screw.pitch_radius == pytest.approx(10.32e-3)
    circle = math.hypot(math.pi * 20.635e-3, 5e-3)
    assert screw.loaded_balls_per_nut == int(4 * circle / 3.175e-3) == 81
    assert screw.preload == pytest.approx(545.5)
    assert screw.working_load == pytest.approx(2**1.5 * 545.5, rel=1e-3)
    assert rated_pressure(screw) == pytest.approx(4.2e9, rel=1e-3)


def test_the_nominal_screw_out_of_its_catalogue_values(screw):
    """Three turns on its ball circle hold the balls of the published study."""
    given = CatalogueScrew(
        pitch_diameter=0.032, lead=0.01, nut='double', turns=3.02, preload=990.0
    )
    found, notes = screw_of(given)
    assert found.pitch_radius == screw.pitch_radius
    assert notes['pitch_radius_mm'] == 'given, as a diameter'
    assert found.dynamic_rating is None
    assert 'dynamic_rating_kN' not in notes
    given = CatalogueScrew(
        pitch_diameter=0.032,
        lead=0.01,
        nut='double',
        balls=51,
        ball_diameter=5.953e-3,
        preload=990.0,
        static_rating=55e3,
    )
    found, notes = screw_of(given)
    assert found.static_rating == screw.static_rating
    assert found.loaded_balls_per_nut == screw.loaded_balls_per_nut
    assert notes['preload_N'] == notes['loaded_balls_per_nut'] == 'given'


def test_a_preloaded_nut_has_the_typical_drag_of_its_catalogue():
    """0.7 of 0.05 (tan alpha)^-0.5 F L/(2 pi), 0.13 to 1.76 of it; without preload none."""
    screw, notes = screw_of(CatalogueScrew(**SIZE))
    slope = screw.lead / (2 * math.pi * screw.pitch_radius)
    whole = 0.05 / math.sqrt(slope) * screw.preload * screw.lead / (2 * math.pi)
    assert screw.likely_drag == pytest.approx((0.13 * whole, 0.7 * whole, 1.76 * whole), rel=5e-3)
    assert notes['typical_drag_Nm'] == 'typical (0.7 of the drag torque of JIS B 1192)'
    plain, notes = screw_of(CatalogueScrew(**SIZE | {'nut': 'plain'}))
    assert plain.likely_drag is None
    assert 'typical_drag_Nm' not in notes


def test_a_measured_ra_has_no_typical_range():
    assert screw_of(CatalogueScrew(**SIZE, ra=0.2e-6))[0].roughness.rms_low is None
    rough = screw_of(CatalogueScrew(**SIZE, process='whirled'))[0].roughness
    assert (rough.rms_low, rough.rms_high) == pytest.approx((0.25e-6, 1e-6))


def test_the_nominal_sheet_stays_as_published():
    """Isotropic with D 2.68, whatever is typical of ground raceways."""
    roughness = load_screw('nominal').roughness
    assert (roughness.lay, roughness.fractal_dimension) == ('isotropic', 2.68)
    assert roughness.rms == pytest.approx(0.12e-6)


def test_a_share_of_c_is_the_preload():
    screw, notes = screw_of(CatalogueScrew(**SIZE, preload_share=0.08))
    assert screw.preload == pytest.approx(872.8)
    assert notes['preload_N'] == 'derived (8 % of C 10.91 kN, given)'


@pytest.mark.parametrize(
    ('counted', 'balls', 'note'),
    [
        # A turn of 20.635 mm and a lead of 5 mm is 65.0 mm long and holds 20.47 balls.
        ({'turns': 4.0}, 40, 'derived (2 turns, half of the 4 of the nut)'),
        ({'turns': 5.0}, 51, 'derived (2.5 turns, half of the 5 of the nut)'),
        ({'turns': None, 'balls': 82}, 41, 'derived (half of the 82 balls of the nut)'),
        ({'turns': None, 'balls': 83}, 41, 'derived (half of the 83 balls of the nut)'),
    ],
)
def test_an_offset_nut_is_two_halves_of_its_turns(counted, balls, note):
    """Half of its loaded balls carry in each direction, and half is not twice all of them."""
    given = CatalogueScrew(**SIZE | {'nut': 'offset', 'ball_diameter': 3.175e-3} | counted)
    screw, notes = screw_of(given)
    assert screw.loaded_balls_per_nut == balls
    assert notes['loaded_balls_per_nut'] == note


def test_halves_that_need_not_be_equal_are_named(says):
    for counted, key in (
        ({'turns': 5.0}, 'five_turns'),
        ({'turns': 2.5}, 'turns_2_5'),
        ({'turns': None, 'balls': 83}, 'balls_83'),
        ({'turns': 4.0}, None),
        ({'turns': 5.0, 'balls': 82}, None),  # balls count, as they do in the sheet
    ):
        offset = CatalogueScrew(**SIZE | {'nut': 'offset'} | counted)
        assert list(equal_halves(offset)) == ([says(key)] if key else [])
        assert list(equal_halves(CatalogueScrew(**SIZE | counted))) == []


def test_turns_of_a_double_nut_are_those_of_each():
    """Its sheet says so; a turn of a 20 x 5 is 65 mm, and holds 20 balls of 3.175 mm."""
    screw, notes = screw_of(CatalogueScrew(**SIZE | {'turns': 5.0, 'ball_diameter': 3.175e-3}))
    assert screw.loaded_balls_per_nut == 102
    assert notes['loaded_balls_per_nut'] == 'derived (5 turns in each of two nuts)'


def test_spacers_halve_the_loaded_balls():
    given = CatalogueScrew(**SIZE | {'nut': 'oversize', 'spacers': 'yes'}, ball_diameter=3.175e-3)
    screw, notes = screw_of(given)
    assert screw.loaded_balls_per_nut == 40  # of 81
    assert notes['loaded_balls_per_nut'] == 'derived (4 turns, every second ball a spacer)'


def test_a_heavy_preload_of_oversize_balls_is_named(says):
    """Above 5 % of C 10.91 kN, 545.5 N; two nuts may have it."""
    for nut, preload, expected in (
        ('oversize', 870.0, [says('above_five_per_cent')]),
        ('oversize', 545.0, []),
        ('double', 870.0, []),
    ):
        screw, _ = screw_of(CatalogueScrew(**SIZE | {'nut': nut}, preload=preload))
        assert list(heavy_preload(screw)) == expected


def test_without_preload_no_nut_is_relieved():
    """A load stands for it, of which the sheet says that it is to be replaced."""
    screw, notes = screw_of(CatalogueScrew(**SIZE, preload=0.0))
    assert screw.working_load == pytest.approx(2**1.5 * 0.01 * screw.static_rating, rel=1e-3)
    assert notes['working_load_N'] == (
        'derived (2.83 % of C0, without preload: state the largest axial load)'
    )


def test_numbers_that_no_screw_has_are_refused(refused):
    """Before a sheet is written."""
    few = {**SIZE, 'turns': None, 'balls': 10000, 'static_rating': 23560.0}
    refused('balls_10000', screw_of, CatalogueScrew(**few))
