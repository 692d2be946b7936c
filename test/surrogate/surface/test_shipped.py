# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Shipped surfaces: found by tier, the full one first, and listed when nothing fits."""

from pathlib import Path

from surrogate.surface import (
    companion_path,
    find_surface,
    PRELOAD_SHARES,
    shipped_surface,
    Surface,
)
import surrogate.surface.shipped


def test_a_surface_is_found_by_path_or_tier(tmp_path, refused):
    """The name of a tier is one that is shipped, all else a path."""
    for tier in ('closed_form', 'full'):
        for wanted in (tier, Path(tier)):
            assert find_surface(wanted) == shipped_surface(tier=tier)
        assert Surface.load(find_surface(tier)).tier == tier
    assert find_surface(tmp_path / 'mine.npz') == tmp_path / 'mine.npz'
    refused('surface_tier_full', find_surface, 'full', 'nominal', 'iso_vg_32')
    refused('shipped_nominal_iso_vg_68', shipped_surface, 'nominal', 'iso_vg_32')


def test_without_a_wish_solved_contacts_come_first(tmp_path, monkeypatch, refused):
    """Nothing means the full tier where such a file is shipped, otherwise the closed form."""
    for wanted in (None, ''):
        assert find_surface(wanted) == shipped_surface() == shipped_surface(tier='full')
    monkeypatch.setattr(surrogate.surface.shipped, 'SHIPPED', tmp_path)
    for name in ('a_oil.npz', 'a_oil_full.npz', 'b_oil.npz', 'c_oil_full.npz'):
        (tmp_path / name).touch()
    assert find_surface('', 'a', 'oil').name == 'a_oil_full.npz'
    assert find_surface('', 'b', 'oil').name == 'b_oil.npz'
    assert find_surface('closed_form', 'a', 'oil').name == 'a_oil.npz'
    refused('shipped_screw_d', find_surface, '', 'd', 'oil')
    refused('surface_tier_closed_form', find_surface, 'closed_form', 'c', 'oil')


def test_a_companion_lies_beside_its_surface(tmp_path):
    """At four parts of the preload, of which the first is the surface itself."""
    assert PRELOAD_SHARES == (1.0, 0.8, 0.6, 0.4)
    names = [companion_path(tmp_path / 'a.npz', share).name for share in PRELOAD_SHARES]
    assert names == [f'a_preload{part}.npz' for part in (100, 80, 60, 40)]
    assert companion_path(tmp_path / 'a.npz', 0.29).parent == tmp_path
