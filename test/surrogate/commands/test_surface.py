# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The surface commands as a user types them."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.commands import surface
from surrogate.parameters import DATA as PACKAGE
from surrogate.parameters import screw_and_oil
from surrogate.screw import closed_form
from surrogate.screw.closed_form_record import formula_warnings
from surrogate.screw.opened import Contacts
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.file import read, write
from surrogate.tasks.store import store_path, TaskStore

COMMAND = ('surface',)

CLOSED_FORM = shipped_surface(tier='closed_form')
DATA = read(CLOSED_FORM)
FULL = read(shipped_surface(tier='full'))


def written(folder, **changes):
    """Return the path of the shipped surface with changes."""
    path = folder / 'map.npz'
    write(path, replace(DATA, **changes))
    return path


def test_build_info_check(run, tmp_path, capsys):
    """A surface is built, described and found good; a second build is the same surface."""
    path = tmp_path / 'map.npz'
    ranges = ('--load-range', -500, 500, '--temperature-range', 30, 50, '--speed-range', 1, 2000)
    assert run('build', '--tier', 'closed_form', '--out', path, *ranges, '--verbose') == 0
    built, warned = capsys.readouterr()
    assert run('info', path, '--json') == 0
    info = json.loads(capsys.readouterr().out)
    assert info['sha256'] in built
    assert info['contact_onset']['sentence'] in built
    assert [warned.count(text) for text in info['formula_warnings']] == [1, 1]
    assert info['load_range_N'] == [-500.0, 500.0]
    assert info['speed_range_rad_s'] == pytest.approx([0.10472, 209.44], rel=1e-4)
    assert run('info', path) == 0
    assert 'speed        1 to 2000 rev/min' in capsys.readouterr().out
    assert run('check', path, '--points', '5') == 0
    assert 'passed, hash verified, 5 of 5 points' in capsys.readouterr().out


def test_check_is_of_twenty_points_and_tells_how_far_off_the_limit_is(run, capsys, refused):
    """In per cent of the speed, at as many points as asked for; one is where the worst changes."""
    assert run('check', 'closed_form') == 0
    out = capsys.readouterr().out
    assert str(CLOSED_FORM) in out
    assert '20 of 20 points' in out
    words = ('check', 'closed_form', '--points', '2', '--limit-points')
    assert run(*words, '2') == 0
    _, *limits = capsys.readouterr().out.splitlines()
    assert len(limits) == 2
    for line in limits:
        assert line.startswith('RCS is 0.01 at ')
        assert abs(float(line.split()[-5])) < 1.0
    refused('limit_points_1', run, *words, '-1')


def test_check_finds_a_wrong_surface_and_info_is_strict_json_without_errors(run, tmp_path, capsys):
    """Numbers that are not those of the datasheets; a map without answers is not good either."""
    wrong = {**DATA.fields, 'rcs': 0.5 * DATA.fields['rcs']}
    assert run('check', written(tmp_path, fields=wrong)) == 1
    assert 'FAILED' in capsys.readouterr().out
    assert run('check', written(tmp_path, mask=np.ones_like(DATA.mask))) == 1
    assert '20 without an answer' in capsys.readouterr().out
    errors = {name: np.full_like(values, np.nan) for name, values in DATA.errors.items()}
    assert run('info', written(tmp_path, errors=errors), '--json') == 0
    assert json.loads(capsys.readouterr().out)['errors']['rcs'] == {'max': None, 'p95': None}


def test_check_without_time_is_a_failure(run, capsys, refused):
    """Time for no point at all is a failure; a time that is not positive is refused."""
    assert run('check', '--max-seconds', '1e-9') == 1
    out = capsys.readouterr().out
    assert str(shipped_surface(tier='full')) in out
    assert '0 of 20 points' in out
    for text in ('0', '-1', 'nan', 'inf'):
        refused('max_seconds_above', run, 'check', '--max-seconds', text)


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        ('build --speed-range 100 10', 'speed_range_100'),
        ('build --speed-range 0 10', 'speed_range_0'),
        ('build --load-range 5 5', 'load_range_5'),
        ('build --temperature-range 50 nan', 'temperature_range_50'),
        ('build --oil water', 'nor_one_shipped'),
        ('build --temperature-degC 120', 'temperature_120'),
        ('build --temperature-degC 40 --temperature-range 30 50', 'temperature_and_range'),
        ('build --tier closed_form --workers 2', 'workers_dask_have'),
        ('build --tier closed_form --march', 'march_closed_form'),
        ('build --tier closed_form --law-only', 'law_only_closed_form'),
        ('info none.npz', 'such_surface_file'),
        ('check --points 0', 'points_0'),
    ],
)
def test_bad_words_are_one_sentence(run, words, sentence, refused):
    """In the unit that was typed; workers would do nothing for formulas."""
    refused(sentence, run, *words.split())


@pytest.fixture
def own_sheet(tmp_path):
    """Return the function that writes the nominal sheet under another name, with more keys."""
    nominal = (PACKAGE / 'screws' / 'nominal.yaml').read_text(encoding='utf-8')

    def write_sheet(name='own', keys=''):
        path = tmp_path / f'{name}.yaml'
        text = nominal.replace('name: nominal', f'name: {name}')
        path.write_text(text.replace('  state: new', f'{keys}  state: new'), encoding='utf-8')
        return path

    return write_sheet


@pytest.mark.parametrize(
    ('name', 'keys', 'options', 'marched'),
    [
        ('own', '', [], True),
        ('own', '', ['--law-only'], False),
        ('nominal', '', [], False),
        ('nominal', '', ['--march'], True),
        ('nominal', '  ridges: 12\n', [], True),
        ('own', '  marched_film: 1.1\n  marched_error: 0.05\n', [], False),
        ('own', '  onset_factor: 0.56\n', [], False),
        ('own', "  calibrated: '2026-11-24'\n  onset_band: 1.2\n", [], False),
    ],
)
def test_an_own_raceway_is_marched_unless_it_is_known(
    run, tmp_path, monkeypatch, capsys, own_sheet, name, keys, options, marched
):
    """A shipped sheet under a name of its own is an own one, as is one with other numbers."""
    seen = []

    def build_surface(*given, march, **known):
        seen.append(march)
        return DATA

    monkeypatch.setattr(surface, 'build_surface', build_surface)
    words = (
        '--screw',
        own_sheet(name, keys),
        '--workers',
        1,
        '--out',
        tmp_path / 'a.npz',
        *options,
    )
    assert run('build', *words) == 0
    assert seen == [marched]


def test_a_page_says_what_was_marched(run, tmp_path, capsys):
    """The sentence of the onset with the one band, the roughness, and a line for each strip."""
    header = json.loads(json.dumps(FULL.header))
    header['inputs']['screw']['roughness'] |= {'marched_film': 1.1, 'marched_error': 0.05}
    strip = {'marched_m_s': None, 'told_m_s': 0.1, 'shortest_wave_m': 1e-5, 'status': 'Well.'}
    header['march'] = {'strip 1': strip}
    write(tmp_path / 'map.npz', replace(FULL, header=header))
    assert run('info', tmp_path / 'map.npz') == 0
    page = capsys.readouterr().out
    surface = Surface(FULL)
    onset = surface.onset_speed(0.0, 313.15) * 30 / math.pi
    low, high = (factor * onset for factor in surface.onset_band)
    said = f'Marched on this raceway: contact begins at {onset:.0f} rev/min ({low:.3g} to '
    assert f'  {said}{high:.0f}; a measured ' in page
    assert page.lower().count('marched on this raceway: ') == 1
    assert 'film at the onset 1.10 times that by the topography, marched on this raceway' in page
    assert '  strip 1, waves down to 10 um: contact does not begin, told 0.1 m/s; Well.' in page


def test_info_is_a_page_a_person_reads(run, capsys):
    assert run('info', 'closed_form') == 0
    text = capsys.readouterr().out
    for part in (
        'Contact begins at 332 rev/min at 40 degC; this screw',
        'nominal, iso_vg_68; lead 10 mm, preload 990 N, Rq 0.12 um, film floor 3 nm',
        'raceway (new): Rq 0.12 um between 2.5 um and 0.25 mm',
        'tier         closed_form, format version 4',
        'kinks at     -2800, 0, 2800 N',
        'temperature  10 to 80 degC, nodes at 10, ',
        'nodes        40 x 33 x 9, 0 without a number',
        'friction_torque [N m]                        0.00148',
        'numpy        ',
    ):
        assert part in text


def test_info_of_a_surface_whose_header_is_not_whole_names_the_file(run, tmp_path, refused):
    inputs = json.loads(json.dumps(DATA.header['inputs']))
    del inputs['lubricant']['minimum_temperature']
    path = tmp_path / 'part.npz'
    write(path, replace(DATA, header={**DATA.header, 'inputs': inputs}))
    with refused('not_whole', path=path):
        run('info', str(path))


def test_formulas_beyond_what_they_were_fitted_over_are_named_once(run, capsys):
    """Of the whole surface; where contacts are solved no formula is left to be warned of."""
    assert run('info', 'closed_form', '--json') == 0
    told = json.loads(capsys.readouterr().out)['formula_warnings']
    screw, oil = screw_and_oil(DATA.header['inputs'])
    corner = closed_form.solve(
        Contacts.of(screw), oil, DATA.header['settings']['speed_range'], 3960.0, 353.15
    )
    names = [text.split()[0] for text in told]
    assert names == [text.split()[0] for text in formula_warnings(corner)]
    assert len(set(names)) == len(names) > 0
    assert run('info', 'closed_form') == 0
    assert '  formulas ' not in capsys.readouterr().out
    assert run('info', 'closed_form', '--verbose') == 0
    page = capsys.readouterr().out
    assert [page.count(f'  formulas     {text}') for text in told] == [1] * len(told)
    assert run('info', 'full', '--json') == 0
    assert json.loads(capsys.readouterr().out)['formula_warnings'] == []


def test_info_tells_what_draws_leave_uncertain(run, tmp_path, capsys, says):
    """Median and largest deviation, in the page and in the record."""
    spread = np.linspace(0.0, 0.02, DATA.mask.size).reshape(DATA.mask.shape)
    path = written(tmp_path, deviations={'rcs': spread})
    assert run('info', path) == 0
    text = capsys.readouterr().out
    assert 'deviation: median, max    of the mean' in text
    assert says('rcs_0_01') in text
    assert run('info', path, '--json') == 0
    spreads = json.loads(capsys.readouterr().out)['spreads']
    assert spreads['rcs']['std'] == pytest.approx({'median': 0.01, 'max': 0.02})
    assert spreads['rcs']['stderr'] == {'median': None, 'max': None}


def test_clean_removes_kept_results(run, tmp_path, capsys):
    """The command that a refused store names does what the sentence says."""
    out = tmp_path / 'map.npz'
    with TaskStore(out, 'test 1'):
        pass
    assert run('clean', out) == 0
    assert f'{store_path(out)}: removed' in capsys.readouterr().out
    assert not store_path(out).exists()
    assert run('clean', out) == 0
    assert 'nothing to remove' in capsys.readouterr().out
