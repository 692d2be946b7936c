# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Companions of a surface: one file for each part of the preload, over one range."""

import dataclasses

import pytest
from surrogate.builder import companions
from surrogate.parameters import load_lubricant, load_screw
from surrogate.surface import companion_path, PRELOAD_SHARES, shipped_surface, Surface
from surrogate.surface.file import read


@pytest.fixture
def built(monkeypatch):
    """Build nothing; return what each companion was asked to be."""
    asked = []

    def build(screw, lubricant, settings):
        asked.append((screw.preload, settings))
        return read(shipped_surface())

    monkeypatch.setattr(companions, 'build_closed_form', build)
    return asked


def test_each_part_of_the_preload_has_a_file_beside_the_surface(built, tmp_path):
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    out = tmp_path / 'one.npz'
    ranges = {'temperature_range': (300.0, 320.0)}
    files = list(companions.build_companions(screw, oil, ranges, out))
    assert [file.name for file in files] == [
        f'one_preload{percent}.npz' for percent in (100, 80, 60, 40)
    ]
    assert files == [companion_path(out, share) for share in PRELOAD_SHARES]
    assert [preload for preload, _ in built] == [s * screw.preload for s in PRELOAD_SHARES]
    assert {settings.temperature_range for _, settings in built} == {(300.0, 320.0)}
    assert len({settings.load_range for _, settings in built}) == 1
    assert Surface.load(files[-1]).screw_name == 'nominal'


def test_a_screw_without_preload_has_no_companions(built, tmp_path, refused):
    screw = dataclasses.replace(load_screw('nominal'), preload=0.0)
    made = companions.build_companions(screw, load_lubricant('iso_vg_68'), {}, tmp_path / 'a.npz')
    refused('companions_without_preload', list, made)
    assert not built
