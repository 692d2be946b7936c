# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Building a surface: ranges, nodes, measured errors, other screws."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import (
    build_closed_form,
    default_settings,
    load_nodes,
    surface_header,
    temperature_nodes,
)
from surrogate.formulas.lubricant import lubricant_state
from surrogate.formulas.sliding import largest_sliding
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_speeds
from surrogate.surface import FIELDS, Surface, Validity

SMALL = {'speed_nodes': 16, 'load_cells': 3, 'unloaded_cells': 1, 'temperature_nodes': 3}


def test_smooth_surfaces_have_no_map(screw, oil, refused):
    """Without any roughness the film ratio, a field of the map, has no end."""
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    refused('screw_nominal_rms_um', build_closed_form, smooth, oil, default_settings(smooth))
    found = closed_form.solve(Contacts.of(smooth), oil, 10.0, 0.0, 313.15)
    assert (float(found.film_ratio), float(found.rcs)) == (math.inf, 0.0)


def test_break_nodes_are_nodes(screw):
    """Zero load and the unloading load, both signs, are nodes and breaks."""
    load, breaks = load_nodes(screw, default_settings(screw))
    assert breaks == pytest.approx([-(2**1.5) * 990, 0.0, 2**1.5 * 990])
    assert set(breaks) <= set(load.tolist())
    assert np.all(np.diff(load) > 0)


def test_an_onset_is_where_rcs_is_one_percent(screw, oil):
    """In the middle of the loaded contacts; their sides, less pressed, touch a little more."""
    load, kelvin = np.array([0.0, 1500.0, 3500.0]), 330.0
    speed = onset_speeds(Contacts.of(screw), oil, load, np.array([kelvin]))[:, 0]
    contacts = closed_form.solve(Contacts.of(screw), oil, speed, load, kelvin).contacts[:2]
    assert np.maximum(*(one.rcs for one in contacts)) == pytest.approx(0.0144, rel=0.05)


@pytest.mark.parametrize('count', [2, 5, 9])
def test_temperatures_are_even_in_the_logarithm_of_the_viscosity(screw, oil, count):
    """From end to end of the range."""
    ends = default_settings(screw).temperature_range
    found = temperature_nodes(oil, ends, count)
    assert found[[0, -1]].tolist() == list(ends)
    steps = np.diff(np.log(lubricant_state(oil, found).viscosity))
    assert (steps < 0).all()
    assert steps == pytest.approx(steps.mean(), rel=1e-3)


def test_measured_errors_are_those_of_the_lookup(screw, oil):
    """In a coarse map, the stated error of a cell is what a solve at its centre finds."""
    data = build_closed_form(screw, oil, replace(default_settings(screw), **SMALL))
    surface = Surface(data)
    measured = np.argwhere(np.isfinite(data.errors['rcs']))
    i, j, k = measured[len(measured) // 2]
    s, load, kelvin = (
        float(0.5 * (axis[n] + axis[n + 1]))
        for axis, n in ((data.speed_coordinate, i), (data.load, j), (data.temperature, k))
    )
    speed = surface.onset_speed(load, kelvin) * math.exp(s)
    solved = closed_form.solve(Contacts.of(screw), oil, speed, load, kelvin)
    found = surface.lookup(speed, load, kelvin)
    for name in FIELDS:
        error = abs(getattr(found, name) - float(getattr(solved, name)))
        assert data.errors[name][i, j, k] == pytest.approx(error, rel=1e-6, abs=1e-12)
    assert found.rcs_error == data.errors['rcs'][i, j, k]


def test_more_nodes_mean_smaller_errors(screw, oil):
    """Refining every axis shrinks the measured error of torque and film ratio."""
    coarse, fine = (
        Surface(build_closed_form(screw, oil, replace(default_settings(screw), **nodes))).errors
        for nodes in (SMALL, {name: 2 * number - 1 for name, number in SMALL.items()})
    )
    for name in ('friction_torque', 'film_ratio', 'rcs'):
        assert fine[name][1] < 0.5 * coarse[name][1]


def test_header_states_the_numbers_of_service(screw, oil):
    """Beside the inputs, which they leave as they are."""
    rated = replace(screw, dynamic_rating=25e3)
    bare, stated = (
        surface_header(one, oil, default_settings(screw), [], 'closed_form')
        for one in (screw, rated)
    )
    assert stated['inputs'] == bare['inputs']
    assert bare['service'] == {}
    assert stated['service'] == {'dynamic_rating': 25e3}
    assert stated['sliding_m_per_rad'] == bare['sliding_m_per_rad'] == largest_sliding(screw)


def test_same_inputs_same_hash(screw, oil):
    """Building twice gives one surface; progress counts to its total."""
    seen = []
    small = replace(default_settings(screw), **SMALL)
    one = build_closed_form(screw, oil, small, progress=lambda *at: seen.append(at))
    assert one.sha256 == build_closed_form(screw, oil, small).sha256
    assert seen == [(n, 5) for n in range(1, 6)]
    assert one.provenance['build_seconds'] > 0


def test_zero_preload_masks_zero_load_only(screw, oil):
    """Without preload there is no contact at zero load; elsewhere the surface answers."""
    loose = replace(screw, preload=0.0)
    surface = Surface(build_closed_form(loose, oil, replace(default_settings(loose), **SMALL)))
    assert surface.lookup(60.0, 0.0, 313.15).validity is Validity.MASKED
    assert surface.lookup(60.0, 4000.0, 313.15).validity is Validity.VALID


@pytest.mark.parametrize(
    ('changes', 'sentence'),
    [
        ({'speed_range': (100.0, 10.0)}, 'speed_range_100'),
        ({'speed_range': (0.0, 10.0)}, 'speed_range_begins'),
        ({'load_range': (5.0, 5.0)}, 'load_range_5'),
        ({'temperature_range': (313.15, math.nan)}, 'temperature_range_313'),
        ({'temperature_range': (263.15, 353.15)}, 'oil_iso_vg_68_allows'),
    ],
)
def test_a_wrong_range_is_one_sentence(screw, oil, changes, sentence, refused):
    """Reversed, empty, or beyond the oil's datasheet."""
    refused(sentence, build_closed_form, screw, oil, replace(default_settings(screw), **changes))
