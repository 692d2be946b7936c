# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Whirling and buckling of the shaft, against the printed factors of two makers."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.plausibility import doubts
from surrogate.formulas.shaft import (
    buckling_load,
    core_diameter,
    critical_speed,
    service_of,
    shaft_doubts,
)
from surrogate.parameters import DATA, load_screw
from surrogate.units import MILLI, RPM

COMMAND = ('point',)
THK = {
    'fixed_free': (3.4, 1.3),
    'supported_supported': (9.7, 5.0),
    'fixed_supported': (15.1, 10.0),
    'fixed_fixed': (21.9, 20.0),
}
"""Printed factors of THK, General Catalog, A15: 0.8 n = f d/L^2 1e7, 0.5 F = m d^4/L^2 1e4."""


def held(screw, support='fixed_free', length=1.0):
    """Return a screw between bearings."""
    return replace(screw, free_length=length, support=support)


@pytest.mark.parametrize('support', THK)
def test_factors_of_a_catalogue(screw, support):
    """With their shares of 80 % and one half, to the digits in print."""
    shaft = held(screw, support, 0.82)
    diameter = MILLI * core_diameter(shaft)
    speed, thrust = THK[support]
    turns = 0.8 * critical_speed(shaft) / RPM
    assert turns == pytest.approx(speed * diameter / 820**2 * 1e7, rel=0.015)
    printed = thrust * diameter**4 / 820**2 * 1e4
    assert 0.5 * buckling_load(shaft) == pytest.approx(printed, rel=0.045)


def test_the_example_of_a_catalogue(screw):
    """MISUMI 2025, p. 1676: 12.5 mm at the root, 820 mm, fixed and supported, 3630 N."""
    shaft = held(screw, 'fixed_supported', 0.82)
    wide = buckling_load(shaft) / core_diameter(shaft) ** 4
    assert 0.5 * wide * 0.0125**4 == pytest.approx(3630.0, rel=0.02)


@given(st.floats(0.502, 0.6), st.floats(0.4, 1.1))
def test_the_groove_ends_under_the_ball_on_its_arc(conformity, angle):
    """Both arcs pass through the apex; a groove as narrow as the ball touches it there."""
    shaft = replace(load_screw('nominal'), conformity_screw=conformity, contact_angle=angle)
    ball = shaft.ball_diameter
    depth = shaft.pitch_radius - core_diameter(shaft) / 2
    behind = (conformity - 0.5) * ball
    centre = -behind * math.sin(angle), -behind * math.cos(angle)
    assert math.hypot(*centre, 0.0) == pytest.approx(behind)
    assert math.hypot(centre[0], depth - centre[1]) == pytest.approx(conformity * ball)
    assert ball / 2 < depth


def test_without_a_length_nothing_is_known(screw):
    """And nothing is told."""
    assert math.isnan(critical_speed(screw))
    assert math.isnan(buckling_load(screw))
    assert service_of(screw) == {}
    assert list(shaft_doubts(screw, 1e9, 1e9)) == []


def test_what_a_header_states(screw):
    stated = service_of(held(replace(screw, dynamic_rating=25e3)))
    assert stated['dynamic_rating'] == 25e3
    assert stated['critical_speed'] == critical_speed(held(screw))
    assert stated['buckling_load'] == buckling_load(held(screw))


def test_a_shaft_that_is_too_long_is_told(screw, says):
    """Of what the sheet allows, and of a point; at the limits nothing is said."""
    shaft = held(screw, 'fixed_free', 3.0)
    assert doubts(shaft) == [says('sheet_speed'), says('sheet_load')]
    assert doubts(held(screw, 'fixed_fixed', 0.5)) == []
    assert list(shaft_doubts(shaft, 2000 * RPM, 0.0)) == [says('point_speed')]
    speed, load = 0.8 * critical_speed(shaft), 0.5 * buckling_load(shaft)
    assert list(shaft_doubts(shaft, speed, load)) == []


def test_commands_tell_it(run, small_tiles, tmp_path, capsys, says):
    """The limits of the sheet, and then the point."""
    sheet = tmp_path / 'long.yaml'
    text = (DATA / 'screws' / 'nominal.yaml').read_text(encoding='utf-8')
    sheet.write_text(f'{text}\nfree_length_mm: 3000.0\nsupport: fixed_free\n', encoding='utf-8')
    point = '--tier', 'closed_form', '--speed-rpm', 2000, '--load-N', 0
    assert run('--screw', sheet, *point) == 0
    told = capsys.readouterr().err.splitlines()
    keys = 'sheet_speed', 'sheet_load', 'point_speed'
    assert told == [f'ballscrew: {says(key)}' for key in keys]


@pytest.mark.parametrize(
    ('change', 'key'),
    [({'free_length': 1.0}, 'no_support'), ({'support': 'fixed_free'}, 'no_length')],
)
def test_length_and_support_go_together(screw, refused, change, key):
    refused(key, replace, screw, **change)
