# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The onset of the sheets agrees with their surface, and what it advises with the law."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.builder.full.build import build_full
from surrogate.builder.full.settings import FullSettings
from surrogate.builder.sheets_onset import EFFICIENCY, onset_of_sheets
from surrogate.catalogue.screw import screw_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.formulas.torque import efficiency
from surrogate.screw.onset_record import onset_record
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.surface import onset_of_surface, Surface
from surrogate.surface.contact_onset import RMS_POWER
from surrogate.surface.file import write
from surrogate.surface_tools.describe import info_page, info_record

pytestmark = pytest.mark.usefixtures('small_tiles')
SETTINGS = FullSettings(
    speed_range=(0.5, 100.0),
    load_range=(-2000.0, 2000.0),
    temperature_range=(313.15, 333.15),
    speed_nodes=6,
    temperature_nodes=2,
    held_out=1,
    load_cells=1,
)
WARM = 368.15  # [K], of no zone with the nominal sheets


@pytest.fixture(scope='module')
def found(screw, oil, small_tiles):
    return onset_of_sheets(screw, oil, WARM)


def test_it_is_the_onset_of_the_surface_of_these_sheets(screw, oil):
    """On a node of its temperatures; a surface of formulas states no band."""
    coarse = {'load_cells': 2, 'unloaded_cells': 1, 'temperature_nodes': 3}
    data = build_closed_form(screw, oil, replace(default_settings(screw), **coarse))
    theirs = onset_of_surface(Surface(data), data.temperature[0])
    ours = onset_of_sheets(screw, oil, data.temperature[0])
    alike = {'band': theirs.band, 'measure': theirs.measure, 'speed': 0.0}
    assert replace(ours, **alike) == replace(theirs, **alike)
    assert ours.speed == pytest.approx(theirs.speed, rel=1e-9)


def test_what_it_advises_makes_contact_begin_as_slow_as_it_must(screw, oil, found):
    """By the law: one over the viscosity, and a power of Rq, within a tenth of the speed."""
    assert not found.zone
    assert found.slower > 1.0
    target = found.speed / found.slower
    assert onset_point(Contacts.of(screw), oil, 0.0, found.colder)['speed_rad_s'] == pytest.approx(
        target
    )
    thicker = replace(
        oil,
        viscosity=found.slower * oil.viscosity,
        kinematic_viscosity_40=found.slower * oil.kinematic_viscosity_40,
        kinematic_viscosity_100=found.slower * oil.kinematic_viscosity_100,
    )
    smoother = with_raceway(screw, rms=screw.roughness.rms / found.slower**RMS_POWER)
    for sheet, lubricant in ((screw, thicker), (smoother, oil)):
        speed = onset_point(Contacts.of(sheet), lubricant, 0.0, WARM)['speed_rad_s']
        assert speed == pytest.approx(target, rel=0.1)


@pytest.mark.parametrize('factor', [0.5, 2.0])
def test_the_power_of_rq_is_near_that_of_the_law(screw, oil, factor):
    rougher = with_raceway(screw, rms=factor * screw.roughness.rms)
    usual, speed = (
        onset_point(Contacts.of(one), oil, 0.0, WARM)['speed_rad_s'] for one in (screw, rougher)
    )
    assert speed == pytest.approx(usual * factor ** (1 / RMS_POWER), rel=0.2)


def test_a_smooth_screw_has_no_onset_and_a_zone(screw, oil):
    found = onset_of_sheets(with_raceway(screw, rms=0.0), oil, WARM)
    assert found.speed == 0.0
    assert found.zone


def test_efficiencies_of_many_loads_are_those_of_one(screw):
    loads = np.array([-500.0, 0.0, 500.0])
    single = [efficiency(0.1, load, screw.lead) for load in loads]
    assert EFFICIENCY(0.1, loads, screw.lead).tolist() == single


@pytest.mark.parametrize('marches', [{}, {'marched_film': 1.1, 'marched_error': 0.05}])
def test_all_say_one_band_of_an_own_screw(oil, stand_in, tmp_path, marches):
    """Build, point, onset and info; its Ra is a typical one, the raceway was marched or not."""
    given = CatalogueScrew(
        nominal_diameter=0.036, lead=0.012, nut='double', turns=3.5, dynamic_rating=30e3
    )
    own, kelvin = with_raceway(screw_of(given)[0], **marches), oil.reference_temperature
    data = build_full(own, oil, SETTINGS, stand_in.run)
    surface = Surface(data)
    of_sheets, of_file = onset_of_sheets(own, oil, kelvin), onset_of_surface(surface, kelvin)
    state = onset_record(own, oil, 0.0, kelvin)['states'][own.roughness.state]
    assert of_sheets.band == of_file.band == tuple(state['band'])
    assert of_sheets.measure == of_file.measure
    assert of_file.measure[0] == state['measure'][0]['measurement']
    for name in ('limit_band', 'numerical_band', 'measure'):
        assert surface.header[name] == state[name]
    assert of_file.speed == pytest.approx(of_sheets.speed, rel=1e-6)  # on a node
    for found in (of_sheets, of_file):
        assert f'; a measured {found.measure[0]} leaves ' in found.sentence()
    write(tmp_path / 'own.npz', data)
    assert f'  {of_file.sentence()}.' in info_page(info_record(tmp_path / 'own.npz', data))
    assert of_file.sentence().startswith('Marched on this raceway: ') == bool(marches)
    film = math.exp(1.645 * 0.05) if marches else 1.3
    assert state['film_factor'] == pytest.approx(film)
