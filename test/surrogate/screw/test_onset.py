# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record, page and picture of the onset by the topography."""

from dataclasses import replace
import math

import pytest
from surrogate.asperities.running_in import Cut, USUAL
from surrogate.screw.onset import (
    BANDS,
    cut_at,
    extrapolated,
    onset_page,
    onset_point,
    onset_record,
)
from surrogate.screw.onset_figure import figure_onset
from surrogate.units import RPM

KELVIN = 313.15


@pytest.fixture(scope='module')
def record(screw, oil):
    return onset_record(screw, oil, 0.0, KELVIN)


def test_both_states_stand_in_the_record(record):
    new, run = record['states']['new'], record['states']['run_in']
    assert new['speed_rad_s'] > run['speed_rad_s'] > 0
    low, high = run['speed_range_rad_s']
    assert low < run['speed_rad_s'] < high < new['speed_rad_s']
    assert new['cutting_pressure_Pa'] == 7e9
    assert record['working_load_stated'] is False


def test_the_range_is_that_of_the_bounds_of_the_sheet(screw, oil, record):
    low = cut_at(USUAL, USUAL.run_in_range[0])
    found = onset_point(screw, oil, 0.0, KELVIN, 'run_in', low)['speed_rad_s']
    assert record['states']['run_in']['speed_range_rad_s'][0] == found


def test_half_the_film_of_starvation_needs_a_faster_speed(screw, oil, record):
    starved = onset_point(screw, replace(oil, film_factor=0.5), 0.0, KELVIN, 'new')
    assert starved['speed_rad_s'] > 2 * record['states']['new']['speed_rad_s']


def test_the_page_says_where_contact_is_sure_and_where_possible(record):
    page = onset_page(record)
    fastest = BANDS['isotropic'] * record['states']['new']['speed_rad_s'] / RPM
    assert f'possible below {fastest:.3g} rev/min' in page
    assert 'cut at 7 GPa' in page
    assert 'assumed: it unloads the relieved nut' in page


def test_a_profile_traced_after_running_in_has_one_state(screw, oil, record):
    found = onset_record(screw, oil, 0.0, KELVIN, Cut(traced_run_in=True))
    assert list(found['states']) == ['run_in']
    speed = found['states']['run_in']['speed_rad_s']
    assert speed == record['states']['new']['speed_rad_s']
    assert 'over the range' not in onset_page(found)


def test_a_load_beyond_the_working_load_cuts_too(screw, oil):
    assert onset_record(screw, oil, -5000.0, KELVIN)['working_load_N'] == 5000.0


@pytest.mark.parametrize(
    ('load', 'kelvin', 'sentence'),
    [
        (math.nan, KELVIN, 'load_n_nan'),
        (math.inf, KELVIN, 'load_n_inf'),
        (0.0, 450.0, 'temperature_176_85'),
    ],
)
def test_a_place_that_no_screw_has_is_refused(screw, oil, load, kelvin, sentence, refused):
    refused(sentence, onset_record, screw, oil, load, kelvin)


def test_what_was_not_marched_is_called_extrapolated(screw):
    assert extrapolated(screw) == []
    fine = replace(screw, roughness=replace(screw.roughness, cutoff_short=0.5e-6, rms=0.4e-6))
    assert [text.split()[0] for text in extrapolated(fine)] == ['Rq', 'short']


@pytest.mark.parametrize('lay', ['longitudinal', 'transverse'])
def test_ridges_without_a_fan_have_an_onset(screw, oil, lay):
    sheet = replace(screw.roughness, lay=lay, fan_angle=0.0)
    ridges = replace(screw, roughness=sheet)
    assert onset_point(ridges, oil, 0.0, KELVIN, 'run_in')['speed_rad_s'] > 0


def test_smooth_raceways_say_so(screw, oil):
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    page = onset_page(onset_record(smooth, oil, 0.0, KELVIN))
    assert 'no contact: raceway and ball are smooth' in page
    assert 'Contact is likely' not in page


def test_the_picture_falls_with_the_cutting_pressure(screw, oil, record, monkeypatch):
    monkeypatch.setattr('surrogate.screw.onset_figure.STEPS', 3)
    axes = figure_onset(screw, oil, USUAL, record).axes[0]
    speeds = axes.lines[0].get_ydata()
    assert list(speeds) == sorted(speeds)
    assert all(math.isfinite(one) for one in speeds)
    assert '[rev/min]' in axes.get_ylabel()
    assert '[GPa]' in axes.get_xlabel()
