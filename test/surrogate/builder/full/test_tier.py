# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The full tier as users build it: workers, kept results, interruption, a point solved again."""

from dataclasses import replace
from functools import partial
import math
import re

import numpy as np
import pytest
from surrogate.builder import tiers
from surrogate.builder.full import build as full_build
from surrogate.builder.full import tier as full_tier
from surrogate.builder.full.run import ChainRun
from surrogate.builder.full.settings import default_full_settings, FullSettings
from surrogate.files import InputError
from surrogate.screw.contacts import GRID_WAVELENGTH
from surrogate.surface import FIELDS, Surface
from surrogate.surface_tools.check import check_surface
from surrogate.tasks.store import TaskStore

SETTINGS = FullSettings(
    speed_range=(1.0, 60.0),
    load_range=(-1000.0, 1000.0),
    temperature_range=(303.15, 323.15),
    temperature_nodes=2,
    load_cells=2,
    draws=2,
    held_out=3,
)


@pytest.fixture(autouse=True)
def fast(monkeypatch, stand_in):
    """Let chains be those of the stand-in."""
    monkeypatch.setattr(full_tier, 'ChainRun', partial(ChainRun, task=stand_in.solve))
    monkeypatch.setattr(full_tier, 'solve_chain', stand_in.solve)


def build(screw, oil, out, pool, settings=SETTINGS):
    """Build beside `out`."""
    return tiers.build_surface('full', screw, oil, settings, pool=pool, out=out)


def test_an_interrupted_build_resumes_to_the_same_file(screw, oil, tmp_path, capsys, here):
    """What was kept is not solved again, and the hash is that of a build in one go."""
    whole = here()
    data = build(screw, oil, tmp_path / 'whole.npz', whole)
    assert whole.solved > 20
    first, second = here(most=18), here()
    with pytest.raises(KeyboardInterrupt):
        build(screw, oil, tmp_path / 'cut.npz', first)
    resumed = build(screw, oil, tmp_path / 'cut.npz', second)
    assert resumed.sha256 == data.sha256
    assert resumed.provenance['kept_chains'] >= first.solved
    assert data.provenance['kept_chains'] < first.solved
    with TaskStore(tmp_path / 'cut.npz', full_tier.WORK) as store:
        kept = len(store)
    assert kept == whole.solved
    assert second.solved < whole.solved
    assert 'chains, nodes' in capsys.readouterr().err


def test_a_build_interrupted_while_nodes_are_added_resumes_to_the_same_file(
    screw, oil, tmp_path, here
):
    """The last task is one of those: held-out points that were missed are judged as before."""
    finer = replace(
        SETTINGS,
        speed_range=(0.5, 100.0),
        load_range=(-2000.0, 1000.0),
        temperature_range=(293.15, 333.15),
        load_cells=1,
        held_out=12,
        accuracy=0.25,
    )
    whole, plain = here(), here()
    data = build(screw, oil, tmp_path / 'whole.npz', whole, finer)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(full_build, 'nodes_for_misses', lambda *of_any: (np.empty(0), np.empty(0)))
        build(screw, oil, tmp_path / 'plain.npz', plain, finer)
    assert plain.solved < whole.solved
    first, second = here(most=whole.solved - 1), here()
    with pytest.raises(KeyboardInterrupt):
        build(screw, oil, tmp_path / 'cut.npz', first, finer)
    assert build(screw, oil, tmp_path / 'cut.npz', second, finer).sha256 == data.sha256
    assert 0 < second.solved <= whole.solved - plain.solved


def test_provenance_counts_the_work_and_is_not_hashed(screw, oil, tmp_path, here):
    """Chains, points and versions; another run of the same work has the same hash."""
    data = build(screw, oil, tmp_path / 'a.npz', here())
    assert data.provenance['solved_points'] > data.provenance['chains'] > 20
    assert data.provenance['failed_chains'] == 0
    assert replace(data, provenance={}).sha256 == data.sha256


def test_a_point_is_solved_with_the_draws_of_the_surface(screw, oil, tmp_path, here):
    """A check passes at points that were never nodes; the fields are all there."""
    data = build(screw, oil, tmp_path / 'a.npz', here())
    solved = full_tier.solve_full(data.header, 10.0, 300.0, 310.0)
    assert solved.converged
    assert all(math.isfinite(getattr(solved, name)) for name in FIELDS)
    result = check_surface(data, points=10, seed=4, has_time=lambda: True)
    assert result.tried == 10
    assert result.silent == result.unsolved == 0
    assert result.efficiency < 0.01


def test_failed_chains_are_named_and_counted(
    screw, oil, tmp_path, monkeypatch, stand_in, capsys, here
):
    """One draw that fails everywhere leaves the means of the others."""

    def failing(inputs):
        if inputs['draw'] == 1:
            raise InputError('no luck')
        return stand_in.solve(inputs)

    monkeypatch.setattr(full_tier, 'ChainRun', partial(ChainRun, task=failing))
    data = build(screw, oil, tmp_path / 'a.npz', here())
    assert data.provenance['failed_chains'] > 10
    assert not data.mask.all()
    assert 'draw 1: no luck' in capsys.readouterr().err


def test_missing_nodes_are_told_with_their_place(
    screw, oil, tmp_path, monkeypatch, stand_in, capsys, here
):
    """Fast points of cold oil fail: one sentence, and lookups there are NaN; none without."""

    def failing(inputs):
        found = stand_in.solve(inputs)
        for speed, *records in zip(inputs['speeds'], *found.values(), strict=True):
            for record in records:
                record['converged'] &= speed < 20 or inputs['temperature'] > 304
        return found

    build(screw, oil, tmp_path / 'a.npz', here())
    assert 'missing' not in capsys.readouterr().err
    monkeypatch.setattr(full_tier, 'ChainRun', partial(ChainRun, task=failing))
    data = build(screw, oil, tmp_path / 'b.npz', here())
    told = re.search(r'(\d+) of \d+ nodes are missing.*', capsys.readouterr().err)
    assert 0 < int(told[1]) <= data.mask.sum()
    assert '-1000 to 1000 N, 30 to 30 degC; lookups beside them are NaN' in told[0]
    assert math.isnan(Surface(data).lookup(55.0, 300.0, 304.0).rcs)
    assert not math.isnan(Surface(data).lookup(2.0, 300.0, 304.0).rcs)


def test_defaults_cover_what_the_closed_form_covers(screw):
    """Same ranges, by the name of the tier; changes are checked."""
    found = tiers.default_settings('full', screw, {'draws': 3, 'accuracy': 2.0})
    assert found == replace(default_full_settings(screw), draws=3, accuracy=2.0)
    closed = tiers.default_settings('closed_form', screw, {})
    assert found.load_range == closed.load_range
    with pytest.raises(InputError, match='draws is 0, allowed is 1 or more'):
        tiers.default_settings('full', screw, {'draws': 0})
    with pytest.raises(InputError, match='accuracy is 0, allowed is 0.1 to 100'):
        tiers.default_settings('full', screw, {'accuracy': 0.0})


def test_waves_that_are_solved_are_a_setting(screw, oil, tmp_path, stand_in, monkeypatch, here):
    """They reach every chain and the check; those that no grid holds are refused."""
    seen = []

    def solve(inputs):
        seen.append(inputs['grid_wavelength'])
        return stand_in.solve(inputs)

    monkeypatch.setattr(full_tier, 'ChainRun', partial(ChainRun, task=solve))
    monkeypatch.setattr(full_tier, 'solve_chain', solve)
    data = build(screw, oil, tmp_path / 'a.npz', here(), replace(SETTINGS, grid_wavelength=8e-6))
    full_tier.solve_full(data.header, 10.0, 300.0, 310.0)
    assert set(seen) == {8e-6}
    assert data.header['settings']['grid_wavelength'] == 8e-6
    older = {key: one for key, one in data.header['settings'].items() if key != 'grid_wavelength'}
    seen.clear()
    full_tier.solve_full({**data.header, 'settings': older}, 10.0, 300.0, 310.0)
    assert set(seen) == {GRID_WAVELENGTH}
    with pytest.raises(InputError, match='wavelength is 0.5 um, allowed is 1 to 1000 um'):
        replace(SETTINGS, grid_wavelength=0.5e-6)
