# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a sheet that do not suit each other: refused, or told, with the number that fits."""

from dataclasses import replace
import math

import pytest
from surrogate.formulas.plausibility import (
    check_plausible,
    doubts,
    rated_pressure,
    rating_by_hertz,
)
from surrogate.parameters import DATA, load_screw

SHIPPED = sorted(path.stem for path in (DATA / 'screws').glob('*.yaml'))


@pytest.mark.parametrize('name', SHIPPED)
def test_shipped_sheets_are_plausible(name):
    screw = load_screw(name)
    check_plausible(screw)
    assert doubts(screw) == []


@pytest.mark.parametrize('name', [name for name in SHIPPED if name != 'nominal'])
def test_ratings_of_a_catalogue_press_a_ball_as_the_standard_says(name):
    """Every size of HIWIN's double nuts, which were rated without this formula."""
    screw = load_screw(name)
    assert 3.75e9 < rated_pressure(screw) < 4.5e9
    assert rating_by_hertz(screw) == pytest.approx(screw.static_rating, rel=0.4)


def test_the_rating_by_hertz_presses_by_its_pressure(screw):
    fitting = replace(screw, static_rating=rating_by_hertz(screw))
    assert rated_pressure(fitting) == pytest.approx(4.2e9)


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'preload': 2.645}, 'preload_2_645'),
        ({'preload': 0.2}, 'preload_0_2'),
        ({'loaded_balls_per_nut': 10000}, 'balls_10000'),
        ({'static_rating': 5.5e7}, 'rating_55000'),
    ],
)
def test_what_no_screw_has_is_refused(screw, change, key, refused):
    """With the number that would fit; a screw without preload is one."""
    check_plausible(replace(screw, preload=0.0))
    refused(key, check_plausible, replace(screw, **change))


@pytest.mark.parametrize(
    ('change', 'key'),
    [({'pitch_radius': 0.032}, 'radius_32'), ({'static_rating': 20e3}, 'rating_20')],
)
def test_an_unusual_size_is_told(screw, change, key, says):
    """A diameter typed as radius, a rating of another nut."""
    assert says(key) in doubts(replace(screw, **change))


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'rms': 1e-6, 'fractal_dimension': 2.1}, 'rz'),
        ({'rms': 0.02e-6, 'lay': 'longitudinal', 'fan_angle': 0.1}, 'along_the_lay'),
        ({'rms': 0.7e-6}, 'slope'),
        ({'rms': 0.126e-6, 'cutoff_long': None}, 'cutoff_long'),
    ],
)
def test_an_unusual_roughness_is_told(screw, change, key, says):
    """Rz as Rq, a trace along the lay, a steep one, a cut-off that a slight change of Rq moves."""
    found = doubts(replace(screw, roughness=replace(screw.roughness, **change)))
    assert found == [says(key)]


def test_a_smooth_raceway_has_no_doubts(screw):
    smooth = replace(screw.roughness, rms=0.0, cutoff_long=None)
    assert doubts(replace(screw, roughness=smooth)) == []


def test_balls_that_fill_less_than_a_fifth_of_the_diameters_of_their_circle_are_told(screw):
    """Loaded turns times ball over ball-circle diameter; the 51 balls of the sheet fill 0.56."""
    turn = math.hypot(2 * math.pi * screw.pitch_radius, screw.lead)
    for number in range(10, 52):
        turns = number * screw.ball_diameter / turn
        told = doubts(replace(screw, loaded_balls_per_nut=number))
        little = turns * screw.ball_diameter / (2 * screw.pitch_radius) < 0.2
        assert any('the balls fill' in sentence for sentence in told) is little, number
