# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The full tier as users build it: workers, kept results, interruption, a point solved again."""

from dataclasses import replace
import math
import re

import pytest
from surrogate.builder import tiers
from surrogate.builder.full import chain
from surrogate.builder.full import tier as full_tier
from surrogate.builder.full.settings import default_full_settings, FullSettings
from surrogate.files import InputError
from surrogate.surface import FIELDS, Surface
from surrogate.surface_tools.check import check_surface
from surrogate.tasks.store import TaskStore

pytestmark = pytest.mark.usefixtures('small_tiles')
SETTINGS = FullSettings(
    speed_range=(1.0, 60.0),
    load_range=(-1000.0, 1000.0),
    temperature_range=(303.15, 323.15),
    temperature_nodes=2,
    load_cells=2,
    held_out=3,
)
CHAINS = 15
SOLVE_CHAIN = chain.solve_chain


@pytest.fixture(autouse=True)
def fast(monkeypatch, stand_in):
    """Let chains be those of the stand-in."""
    monkeypatch.setattr(full_tier, 'solve_chain', stand_in.chain)


def let_fail(monkeypatch, failing):
    """Let a function solve chains, which workers find by the name of the task."""
    monkeypatch.setattr(full_tier, 'solve_chain', SOLVE_CHAIN)
    monkeypatch.setattr(chain, 'solve_chain', failing)


def build(screw, oil, out, pool, settings=SETTINGS):
    """Build beside `out`."""
    return tiers.build_surface('full', screw, oil, settings, pool=pool, out=out)


@pytest.mark.parametrize(('most', 'kept'), [(CHAINS - 2, 0), (CHAINS + 2, CHAINS)])
def test_an_interrupted_build_resumes_to_the_same_file(
    screw, oil, tmp_path, capsys, here, most, kept
):
    """Among chains or held-out points: what was kept is not solved again, the hash is the same."""
    whole = here()
    data = build(screw, oil, tmp_path / 'whole.npz', whole)
    assert whole.solved == CHAINS + SETTINGS.held_out
    first, second = here(most=most), here()
    with pytest.raises(KeyboardInterrupt):
        build(screw, oil, tmp_path / 'cut.npz', first)
    resumed = build(screw, oil, tmp_path / 'cut.npz', second)
    assert resumed.sha256 == data.sha256
    assert data.provenance['kept_tasks'] == 0
    assert resumed.provenance['kept_tasks'] == kept
    assert second.solved == whole.solved - kept
    with TaskStore(tmp_path / 'cut.npz', full_tier.WORK) as store:
        assert len(store) == whole.solved
    assert 'chains' in capsys.readouterr().err


def test_other_held_out_points_of_the_same_grid_solve_no_node(screw, oil, tmp_path, here):
    """Chains are kept by what they are made from."""
    build(screw, oil, tmp_path / 'a.npz', here())
    again = here()
    data = build(screw, oil, tmp_path / 'a.npz', again, replace(SETTINGS, held_out=4))
    assert data.provenance['kept_tasks'] >= CHAINS
    assert data.provenance['tasks'] - data.provenance['kept_tasks'] == again.solved


def test_provenance_counts_the_work_and_is_not_hashed(screw, oil, tmp_path, here):
    """Chains and held-out points; another run of the same work has the same hash."""
    pool = here()
    data = build(screw, oil, tmp_path / 'a.npz', pool)
    assert data.provenance['tasks'] == pool.solved
    assert data.provenance['failed_tasks'] == 0
    assert replace(data, provenance={}).sha256 == data.sha256


def test_a_point_is_solved_from_the_inputs_of_the_surface(screw, oil, tmp_path, here):
    """A check passes at points that were never nodes; the fields are all there."""
    data = build(screw, oil, tmp_path / 'a.npz', here())
    solved = full_tier.solve_full(data.header, 10.0, 300.0, 310.0)
    assert solved.converged
    assert all(math.isfinite(getattr(solved, name)) for name in FIELDS)
    result = check_surface(data, points=10, seed=4, has_time=lambda: True)
    assert result.tried == 10
    assert result.silent == result.unsolved == 0
    assert result.efficiency < 0.01


def test_failed_tasks_are_named_and_counted(
    screw, oil, tmp_path, monkeypatch, stand_in, capsys, here
):
    """A chain leaves its nodes without a number."""

    def failing(inputs):
        if inputs['load'] == 1000.0:
            raise InputError('no luck')
        return stand_in.chain(inputs)

    let_fail(monkeypatch, failing)
    data = build(screw, oil, tmp_path / 'a.npz', here())
    assert data.provenance['failed_tasks'] == 3
    assert data.mask[:, [0, -1]].all()
    assert not data.mask.all()
    told = capsys.readouterr().err
    assert re.search(r'chain, 1000\.0 N, temperature 0: .*no luck', told)


def test_missing_nodes_are_told_with_their_place(
    screw, oil, tmp_path, monkeypatch, stand_in, capsys, here, says
):
    """Fast points of cold oil fail: one sentence, and lookups there are NaN; none without."""

    def failing(inputs):
        found = stand_in.chain(inputs)
        for speed, *records in zip(inputs['speeds'], *found.values(), strict=True):
            for record in records:
                record['converged'] &= speed < 20 or inputs['temperature'] > 304
        return found

    build(screw, oil, tmp_path / 'a.npz', here())
    assert 'missing' not in capsys.readouterr().err
    let_fail(monkeypatch, failing)
    data = build(screw, oil, tmp_path / 'b.npz', here())
    told = re.search(r'(\d+) of \d+ nodes are missing.*', capsys.readouterr().err)
    assert 0 < int(told[1]) <= data.mask.sum()
    assert says('1000_1000_n') in told[0]
    assert math.isnan(Surface(data).lookup(55.0, 300.0, 304.0).rcs)
    assert not math.isnan(Surface(data).lookup(2.0, 300.0, 304.0).rcs)


@pytest.mark.parametrize(
    ('reached', 'sentence'),
    [(0.9, None), (1.7, 'is 1.7 times the allowed one'), (None, 'accuracy is not known')],
)
def test_errors_above_the_allowed_are_told(screw, oil, tmp_path, here, reached, sentence):
    """And where no point was solved, that none is known."""
    data = build(screw, oil, tmp_path / 'a.npz', here())
    known = replace(data, header={**data.header, 'reached': reached})
    told = list(full_tier.shortfalls(known))
    assert len(told) == (sentence is not None)
    assert all(sentence in one for one in told)


def test_defaults_cover_what_the_closed_form_covers(screw, refused):
    """Same ranges, by the name of the tier; changes are checked."""
    found = tiers.default_settings('full', screw, {'held_out': 3, 'speed_nodes': 9})
    assert found == replace(default_full_settings(screw), held_out=3, speed_nodes=9)
    closed = tiers.default_settings('closed_form', screw, {})
    for name in ('speed_range', 'load_range', 'temperature_range'):
        assert getattr(found, name) == getattr(closed, name)
    refused('held_out_0_1', tiers.default_settings, 'full', screw, {'held_out': 0})
    with refused('temperature_nodes_1_2'):
        tiers.default_settings('full', screw, {'temperature_nodes': 1})
