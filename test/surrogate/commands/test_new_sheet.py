# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The commands that make sheets, as a user types them."""

from pathlib import Path
import shlex

import pytest
from surrogate.parameters import DATA, load_lubricant, load_screw
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point
from surrogate.units import RPM

pytestmark = pytest.mark.usefixtures('small_tiles')
COMMAND = ()
SHIPPED = sorted((DATA / 'screws').glob('iso3408_*.yaml'))
CATALOGUE = {
    # HIWIN Ballscrews BS-08-2-EN-1704-K, double nuts R20-5T4-FDI, R40-10T4-FDI, R63-20T4-RDI:
    # diameter, lead, ball, C and C0, and the onset of a small tile in rev/min with VG 68.
    '20x5': (20, 5, 3.175, 10.91, 23.56, 444),
    '40x10': (40, 10, 6.35, 37.89, 94.26, 170),
    '63x20': (63, 20, 9.525, 106.57, 312.51, 110.6),
}


def made_by(path: Path) -> list[str]:
    """Return the command line in the comment of a sheet."""
    lines = path.read_text(encoding='utf-8').splitlines()
    line = ' '.join(one.removeprefix('# ') for one in lines if one.startswith('# '))
    return shlex.split(line)[1:]


@pytest.mark.parametrize('path', SHIPPED, ids=lambda path: path.stem)
def test_shipped_sheets_are_what_their_command_makes(run, tmp_path, path):
    """The command stands in the sheet; a change of a rule asks for it again."""
    assert run(*made_by(path), '--out', tmp_path / 'sheet.yaml') == 0
    assert (tmp_path / 'sheet.yaml').read_bytes() == path.read_bytes()
    assert load_screw(path.stem).name == path.stem


def test_the_sizes_that_are_shipped():
    sizes = '16x5 20x5 25x5 32x10 40x10 50x10 63x20'.split()
    assert [path.stem.removeprefix('iso3408_') for path in SHIPPED] == sizes


@pytest.mark.parametrize('size', CATALOGUE)
def test_from_the_page_of_a_catalogue_to_the_onset(run, tmp_path, capsys, says, size):
    """The larger the screw, the slower contact begins; what is assumed of Ra is told."""
    diameter, lead, ball, dynamic, static, expected = CATALOGUE[size]
    words = ('--nominal-diameter-mm', diameter, '--lead-mm', lead, '--ball-diameter-mm', ball)
    ratings = ('--dynamic-rating-kN', dynamic, '--static-rating-kN', static)
    words += ('--nut', 'double', '--turns', 4)
    path = tmp_path / 'my.yaml'
    assert run('screw', 'new', *words, *ratings, '--ra-um', 0.16, '--out', path) == 0
    assert capsys.readouterr() == (f'{path}\n', '')
    assert run('screw', 'new', *words, *ratings, '--out', path, '--force') == 0
    assert capsys.readouterr() == (f'{path}\n', says('ra_typical'))
    oil = load_lubricant('iso_vg_68')
    found = onset_point(Contacts.of(load_screw(str(path))), oil, 0.0, oil.reference_temperature)
    assert found['speed_rad_s'] / RPM == pytest.approx(expected, rel=0.02)


def test_a_page_of_a_single_nut_does_not_become_two_nuts(run, tmp_path, capsys, says, refused):
    """Its kind is asked for; an offset nut has two halves of its turns, the others all of them."""
    path = tmp_path / 'my.yaml'
    page = ('--nominal-diameter-mm', 40, '--lead-mm', 10, '--ball-diameter-mm', 6.35)
    page += ('--turns', 5, '--dynamic-rating-kN', 21.3, '--ra-um', 0.16, '--out', path)
    refused('nut_missing', run, 'screw', 'new', *page)
    refused('nut_turns', run, 'screw', 'new', '--nut', 'offset', *page, '--turns', 1.5)
    for nut in ('double', 'offset'):
        refused('turns_apart', run, 'screw', 'new', '--nut', nut, *page, '--turns', '3+2')
    refused('plain_preloaded', run, 'screw', 'new', '--nut', 'plain', *page, '--preload-N', 500)
    assert not path.exists()
    assert run('screw', 'new', '--nut', 'offset', *page) == 0
    assert capsys.readouterr() == (f'{path}\n', says('five_turns'))
    # A ball circle of 41.27 mm and a lead of 10 mm give 130.0 mm a turn, 20.5 balls.
    assert load_screw(str(path)).loaded_balls_per_nut == int(2.5 * 20.477)
    for nut, preload in (('oversize', 1065.0), ('plain', 0.0)):
        assert run('screw', 'new', '--nut', nut, *page, '--force') == 0
        assert capsys.readouterr() == (f'{path}\n', '')
        single = load_screw(str(path))
        assert (single.nut, single.preload) == (nut, preload)
        assert single.loaded_balls_per_nut == int(5 * 20.477)


def test_a_grease_loads(run, tmp_path, capsys):
    path = tmp_path / 'grease.yaml'
    assert run('oil', 'new', '--iso-vg', 100, '--kind', 'grease', '--out', path) == 0
    assert load_lubricant(str(path)).film_factor == 0.7
    assert made_by(path) == ['oil', 'new', '--iso-vg', '100', '--kind', 'grease']


def test_without_flags_a_terminal_is_asked(run, tmp_path, monkeypatch, capsys):
    """An empty answer leaves the value to the rules, and the file has the name of the sheet."""
    answers = {'ISO VG, of a grease that of its base oil: ': ' 46 '}
    asked = []
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr('sys.stdin.isatty', lambda: True)
    monkeypatch.setattr('builtins.input', lambda text: asked.append(text) or answers.get(text, ''))
    assert run('oil', 'new') == 0
    assert load_lubricant('mineral_vg_46.yaml').kinematic_viscosity_40 == pytest.approx(46e-6)
    assert 'density at 15 degC (default by the base) [kg_m3]: ' in asked


def test_the_end_of_the_answers_interrupts(run, monkeypatch):
    def end(text):
        raise EOFError

    monkeypatch.setattr('sys.stdin.isatty', lambda: True)
    monkeypatch.setattr('builtins.input', end)
    with pytest.raises(KeyboardInterrupt):
        run('screw', 'new')


def test_a_sheet_is_not_written_over(run, tmp_path, refused):
    """Unless it is asked for: it may have been edited."""
    path = tmp_path / 'oil.yaml'
    path.write_text('mine')
    refused('there_already', run, 'oil', 'new', '--iso-vg', 46, '--out', path)
    assert path.read_text() == 'mine'
    assert run('oil', 'new', '--iso-vg', 46, '--out', path, '--force') == 0
    assert load_lubricant(str(path)).name == 'mineral_vg_46'


def test_flags_that_do_not_suffice_are_refused(run, refused, monkeypatch):
    """Nobody is asked where no terminal is, nor beside flags."""
    monkeypatch.setattr('sys.stdin.isatty', lambda: False)
    refused('diameter_missing', run, 'screw', 'new')
    refused('balls_few', run, 'screw', 'new', '--balls', 'few', '--lead-mm', 5)


def test_commands_tell_what_is_unusual(run, tmp_path, capsys, says, refused):
    """Beside their output, and refuse what no screw has."""
    text = (DATA / 'screws' / 'nominal.yaml').read_text(encoding='utf-8')
    path = tmp_path / 'screw.yaml'
    path.write_text(text.replace('pitch_radius_mm: 16.0', 'pitch_radius_mm: 32.0'))
    assert run('point', '--screw', path, '--speed-rpm', 600, '--load-N', 500, '--json') == 0
    assert capsys.readouterr().err == says('radius_32')
    path.write_text(text.replace('preload_N: 990.0', 'preload_N: 2.645'))
    refused('preload_2_645', run, 'onset', '--screw', path)
