# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A catalogue swept: every item reported, one failure alone, a killed worker's items elsewhere."""

import importlib
import json
import os
from pathlib import Path
import signal
import sys
import threading

import pytest
from surrogate.builder import sweep, tiers
from surrogate.builder.closed_form import build_closed_form
from surrogate.builder.full import tier as full
from surrogate.builder.sweep import load_catalogue
from surrogate.parameters import DATA
from surrogate.surface import Surface
from surrogate.surface.file import read
from surrogate.tasks.worker import worker_name

COMMAND = ('surface', 'sweep')

DEADLINE = 600.0  # [s] which only ends a hang
THREE = 'screws: [nominal.yaml]\noils: [iso_vg_32, iso_vg_68, iso_vg_100]\n'
SHIPPED = THREE.replace('nominal.yaml', 'nominal')
SMALL = {'speed_nodes': 12, 'load_cells': 2, 'unloaded_cells': 1, 'temperature_nodes': 3}
BUILDERS = """
import os
from surrogate.builder.sweep import build_item
from surrogate.files import InputError

def build(inputs):
    if inputs['lubricant']['name'] == 'iso_vg_100' and 'SWEEP_HELLO' in os.environ:
        with open(os.environ['SWEEP_HELLO'], 'w') as hello:
            hello.write(str(os.getpid()))
        with open(os.environ['SWEEP_GATE']) as gate:
            gate.read()
    return build_item(inputs)

def build_all_but_one(inputs):
    if inputs['lubricant']['name'] == 'iso_vg_68':
        raise InputError('iso_vg_68: not today')
    return build_item(inputs)
"""


@pytest.fixture
def builder(tmp_path: Path, monkeypatch):
    """Return what makes surfaces small, and workers build them by a function of `BUILDERS`."""
    (tmp_path / 'sweep_builders.py').write_text(BUILDERS)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'sweep_builders', raising=False)

    def small(tier, screw, ranges):
        return tiers.default_settings(tier, screw, ranges | SMALL)

    def use(name: str) -> None:
        task = getattr(importlib.import_module('sweep_builders'), name)
        monkeypatch.setattr(sweep, 'build_item', task)
        monkeypatch.setattr(sweep, 'default_settings', small)

    return use


@pytest.fixture
def catalogue(tmp_path: Path) -> Path:
    """Return a catalogue of one screw, whose waves are long and so its tiles small, and oils."""
    sheet = (DATA / 'screws' / 'nominal.yaml').read_text()
    coarse = sheet.replace('cutoff_short_um: 2.5', 'cutoff_short_um: 20')
    (tmp_path / 'nominal.yaml').write_text(coarse)
    path = tmp_path / 'catalogue.yaml'
    path.write_text(THREE)
    return path


def report(out: Path) -> dict:
    """Return the report and see that its page is there."""
    assert (out / 'sweep.md').read_text().startswith('# Sweep of ')
    return json.loads((out / 'sweep.json').read_text())


def test_every_combination_is_built(run, tmp_path, builder, catalogue, capsys):
    """Screws times roughness times oils, each a file that is what the report says."""
    builder('build')
    catalogue.write_text(
        'screws: [nominal.yaml]\noils: [iso_vg_32, iso_vg_68]\n'
        'roughness: [{name: as_it_is}, {name: polished, rms_um: 0.06}]\n'
        'load_range_N: [-500, 500]\ntemperature_range_degC: [20, 60]\n'
    )
    out = tmp_path / 'out'
    assert run(catalogue, '--out', out, '--workers', 2) == 0
    assert '4 surfaces built, 0 failed' in capsys.readouterr().out
    items = report(out)['items']
    assert [item['name'] for item in items] == [
        f'{screw}_{oil}'
        for screw in ('nominal', 'nominal-polished')
        for oil in ('iso_vg_32', 'iso_vg_68')
    ]
    for item in items:
        surface = Surface.load(out / item['file'], screw=item['screw'], oil=item['oil'])
        assert surface.sha256 == item['sha256']
        assert surface.load_range == (-500.0, 500.0)
        assert surface.temperature_range == (293.15, 333.15)
        assert surface.errors['rcs'][0] == item['errors']['rcs']['max']
        assert item['status'] == 'built'
        assert item['seconds'] > 0
        rough = surface.header['inputs']['screw']['roughness']['rms']
        assert rough == pytest.approx(0.06e-6 if item['roughness'] == 'polished' else 0.12e-6)
    assert sorted(path.suffix for path in out.iterdir()) == ['.json', '.md', *4 * ['.npz']]


def test_a_failed_item_never_stops_the_rest(run, tmp_path, builder, catalogue, capsys):
    """Its sentence is in the report and on the page; the exit code is 1."""
    builder('build_all_but_one')
    out = tmp_path / 'out'
    assert run(catalogue, '--out', out, '--workers', 1) == 1
    assert '2 surfaces built, 1 failed' in capsys.readouterr().out
    found = report(out)
    assert found['counts'] == {'built': 2, 'failed': 1, 'waiting': 0}
    failed = found['items'][1]
    assert (failed['status'], failed['sentence']) == ('failed', 'iso_vg_68: not today')
    assert failed['sha256'] == ''
    assert 'failed: iso_vg_68: not today' in (out / 'sweep.md').read_text()
    assert not (out / 'nominal_iso_vg_68.npz').exists()


def test_a_tier_that_spreads_its_solves_is_built_here(run, tmp_path, monkeypatch, catalogue):
    """Its builder gets the workers and the file; what it raises is that item's sentence."""

    def build(screw, lubricant, settings, *, pool, out, march):
        if lubricant.name == 'iso_vg_68':
            raise ValueError(f'{out.name} with {type(pool).__name__}')
        changes = {**SMALL, 'load_range': (-10.0, 10.0)}
        small = tiers.default_settings('closed_form', screw, changes)
        return build_closed_form(screw, lubricant, small)

    monkeypatch.setattr(full, 'build_full_surface', build)
    catalogue.write_text('tier: full\n' + THREE)
    out = tmp_path / 'out'
    assert run(catalogue, '--out', out, '--workers', 1) == 1
    items = report(out)['items']
    assert [item['status'] for item in items] == ['built', 'failed', 'built']
    assert items[1]['sentence'] == 'ValueError: nominal_iso_vg_68.npz with ProcessPool'
    assert items[0]['worker'] == worker_name()


def killer(hello: str, gate: str, seen: list[int]) -> threading.Thread:
    """Kill the worker that begins the item at the gate, and let the second one pass."""

    def work() -> None:
        for _ in range(2):
            with open(hello) as pipe:
                seen.append(int(pipe.read()))
            if len(seen) == 1:
                os.kill(seen[0], signal.SIGKILL)
        open(gate, 'w').close()

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    return thread


def test_a_pool_that_loses_a_worker_builds_everything(
    run, tmp_path, builder, catalogue, monkeypatch, says
):
    """Two workers, one killed at work: the report shows who did its item, same surfaces."""
    builder('build')
    names = {name: str(tmp_path / name) for name in ('hello', 'gate')}
    for name, path in names.items():
        os.mkfifo(path)
        monkeypatch.setenv(f'SWEEP_{name.upper()}', path)
    seen: list[int] = []
    thread = killer(names['hello'], names['gate'], seen)
    assert run(catalogue, '--out', tmp_path / 'out', '--workers', 2) == 0
    thread.join(DEADLINE)
    found = report(tmp_path / 'out')
    host = worker_name().partition('/')[0]
    killed, other = (f'{host}/{pid}' for pid in seen)
    item = found['items'][2]
    assert (item['name'], item['status']) == ('nominal_iso_vg_100', 'built')
    assert (item['lost_workers'], item['worker']) == ([killed], other)
    # What it had just done may be lost with it too: results stay where they were made.
    assert 'nominal_iso_vg_100' in found['workers'][killed]['lost_at']
    assert 'nominal_iso_vg_100' not in found['workers'][killed]['done']
    assert 'nominal_iso_vg_100' in found['workers'][other]['done']
    page = (tmp_path / 'out' / 'sweep.md').read_text()
    assert says('nominal_iso_vg_100_done_by', killed=killed, other=other) in page
    for known, item in zip(load_catalogue(catalogue), found['items'], strict=True):
        settings = sweep.default_settings(known.tier, known.screw, known.ranges)
        data = build_closed_form(known.screw, known.lubricant, settings)
        assert data.sha256 == item['sha256']


def test_sheets_beside_the_catalogue_are_found(tmp_path, catalogue):
    """A file name is looked up beside the catalogue, whatever the working directory."""
    sheet = (DATA / 'screws' / 'nominal.yaml').read_text()
    (tmp_path / 'mine.yaml').write_text(sheet.replace('name: nominal', 'name: mine'))
    catalogue.write_text('screws: [nominal, mine.yaml]\noils: [iso_vg_68]\n')
    assert [item.name for item in load_catalogue(catalogue)] == [
        'nominal_iso_vg_68',
        'mine_iso_vg_68',
    ]


def test_marches_are_those_of_the_raceway_of_the_sheet_alone(tmp_path, catalogue):
    sheet = (DATA / 'screws' / 'nominal.yaml').read_text().replace('name: nominal', 'name: mine')
    head, _, rest = sheet.partition('\nroughness:\n')
    marched = '\nroughness:\n  marched_film: 1.1\n  marched_error: 0.05\n'
    (tmp_path / 'mine.yaml').write_text(f'{head}{marched}{rest}')
    others = 'roughness: [{name: as_is}, {name: a, rms_um: 0.1}]\n'
    catalogue.write_text(f'screws: [mine.yaml]\noils: [iso_vg_68]\n{others}')
    films = [item.screw.roughness.marched_film for item in load_catalogue(catalogue)]
    assert films == [1.1, None]


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('- nominal\n', 'mapping_keys_values'),
        ('screw: [nominal]\n', 'unknown_key_screw'),
        ('screws: [nominal]\n', 'oils_list_names'),
        ('screws: nominal\noils: [iso_vg_68]\n', 'screws_list_got'),
        ('screws: [z]\noils: [iso_vg_68]\n', 'z_neither_file'),
        ('screws: [nominal]\noils: [iso_vg_68, iso_vg_68]\n', 'two_surfaces_would'),
        (THREE + 'tier: guess\n', 'tier_guess_closed_form'),
        (THREE + 'roughness: smooth\n', 'roughness_list_mappings'),
        (THREE + 'roughness: [smooth]\n', 'roughness_smooth_mapping'),
        (THREE + 'roughness: [{name: a b}]\n', 'roughness_b_name'),
        (THREE + 'roughness: [{name: a, rq: 1.0}]\n', 'roughness_unknown_key'),
        (THREE + 'roughness: [{name: a, rms_nm: 60.0}]\n', 'rms_nm_has_wrong'),
        (THREE + 'roughness: [{name: a, rms_um: 99.0}]\n', 'rms_um_99_0'),
        (SHIPPED + 'roughness: [{name: a, rms_slope_deg: 1.0}]\n', 'rms_slope'),
        (THREE + 'load_range_N: [5]\n', 'load_range_n_5_low'),
        (THREE + 'load_range_N: [5, 1]\n', 'load_range_n_5_1'),
        (THREE + 'oils: [iso_vg_68]\n', 'key_oils_stands'),
    ],
)
def test_a_wrong_catalogue_is_one_sentence(catalogue, text, sentence, refused):
    """What, value, allowed; before anything is built."""
    catalogue.write_text(text)
    with refused(sentence) as caught:
        load_catalogue(catalogue)
    assert '\n' not in str(caught.value)


def test_a_scheduler_that_is_not_there_leaves_a_report_of_waiting_items(
    run, tmp_path, catalogue, monkeypatch, refused
):
    """Soon and in one sentence."""
    pytest.importorskip('distributed')
    monkeypatch.setattr('surrogate.tasks.workers.PATIENCE', 0.3)
    with refused('dask_scheduler_tcp'):
        run(catalogue, '--out', tmp_path / 'out', '--dask', 'tcp://127.0.0.1:1')
    assert report(tmp_path / 'out')['counts'] == {'built': 0, 'failed': 0, 'waiting': 3}


def test_a_surface_that_cannot_be_written_is_that_item_alone(run, tmp_path, builder, catalogue):
    """A directory stands where a file should go."""
    builder('build')
    out = tmp_path / 'out'
    (out / 'nominal_iso_vg_32.npz').mkdir(parents=True)
    assert run(catalogue, '--out', out, '--workers', 1) == 1
    items = report(out)['items']
    assert [item['status'] for item in items] == ['failed', 'built', 'built']
    assert 'it is not a regular file' in items[0]['sentence']
    assert read(out / items[2]['file']).sha256 == items[2]['sha256']
