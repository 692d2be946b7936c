# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Settings, surface and point by either tier, and the datasheets of a header."""

from dataclasses import asdict, replace
import json

import pytest
from surrogate.builder import tiers
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.builder.full import settings as full_settings
from surrogate.builder.full import tier as full
from surrogate.parameters import BallRoughness, screw_and_oil
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.surface import FIELDS, Surface


def test_an_unknown_tier_lists_the_known_ones(refused):
    """One sentence."""
    refused('tier_guess_closed_form', tiers.spreads, 'guess')


def test_a_header_gives_back_its_datasheets(surface_data, screw, oil):
    """The file alone is enough to solve again."""
    assert screw_and_oil(surface_data.header['inputs']) == (screw, oil)
    rough = replace(screw, ball_roughness=BallRoughness(grade='G10'))
    inputs = json.loads(json.dumps({'screw': asdict(rough), 'lubricant': asdict(oil)}))
    assert screw_and_oil(inputs) == (rough, oil)


@pytest.mark.parametrize(
    'change',
    [
        lambda inputs: inputs.pop('screw'),
        lambda inputs: inputs['screw'].pop('ball'),
        lambda inputs: inputs['screw']['ball'].pop('density'),
        lambda inputs: inputs['lubricant'].pop('minimum_temperature'),
        lambda inputs: inputs['lubricant'].update(film_floor='thin'),
        lambda inputs: inputs['lubricant'].update(density=10**400),
        lambda inputs: inputs.update(lubricant=5),
    ],
)
def test_inputs_that_are_not_whole_are_a_sentence(surface_data, change, refused):
    inputs = json.loads(json.dumps(surface_data.header['inputs']))
    change(inputs)
    refused('not_whole', screw_and_oil, inputs)


def test_a_point_is_solved_as_the_surface_was(surface_data, screw, oil):
    """All fields of the closed-form tier, as its solver gives them."""
    found = tiers.solve_point(surface_data.header, 62.8, 1000.0, 313.0)
    direct = closed_form.solve(Contacts.of(screw), oil, 62.8, 1000.0, 313.0)
    assert found.converged
    for name in (*FIELDS, 'worst_contact'):
        assert getattr(found, name) == float(getattr(direct, name))


def test_a_tier_builds_within_the_ranges_that_are_asked_for(screw, oil):
    """The builder behind the name is the builder."""
    settings = tiers.default_settings('closed_form', screw, {})
    coarse = replace(settings, speed_nodes=12, load_cells=2, unloaded_cells=1, temperature_nodes=3)
    built = tiers.build_surface('closed_form', screw, oil, coarse)
    assert built.sha256 == build_closed_form(screw, oil, coarse).sha256
    narrow = tiers.default_settings('closed_form', screw, {'load_range': (-10.0, 10.0)})
    assert narrow.load_range == (-10.0, 10.0)
    assert narrow.speed_range == settings.speed_range


def test_the_shipped_closed_form_is_the_one_that_is_built(surface_data, screw, oil):
    data = build_closed_form(screw, oil, default_settings(screw))
    shipped, built = Surface(surface_data), Surface(data)
    # What a build states beside it, for life and severity, makes no other surface.
    assert shipped.header == {name: built.header[name] for name in shipped.header}
    for name in FIELDS:
        told, expected = (
            getattr(one.lookup(62.8, 1000.0, 313.15), name) for one in (shipped, built)
        )
        assert told == pytest.approx(expected, rel=1e-9)


def test_a_builder_that_spreads_its_solves_gets_pool_and_file(monkeypatch, screw, oil, tmp_path):
    """The full tier is called with workers and the place beside which results are kept."""
    seen = {}
    monkeypatch.setattr(full, 'build_full_surface', lambda *_, **options: seen.update(options))
    assert tiers.spreads('full')
    assert not tiers.spreads('closed_form')
    tiers.build_surface('full', screw, oil, None, pool='workers', out=tmp_path)
    assert seen == {'pool': 'workers', 'out': tmp_path, 'march': False}
    settings = tiers.default_settings('full', screw, {'held_out': 3})
    assert settings == replace(full_settings.default_full_settings(screw), held_out=3)
