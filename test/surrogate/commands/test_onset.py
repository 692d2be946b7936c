# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The onset command as a user types it: how summits are cut stands in the sheet of the screw."""

import argparse
import json

import pytest
from surrogate.commands.point import load_inputs
from surrogate.files import InputError
from surrogate.parameters import DATA, load_screw
from surrogate.surface.file import read
from surrogate.surface.shipped import shipped_surface

pytestmark = pytest.mark.usefixtures('small_tiles')
COMMAND = ('onset',)
NOMINAL = (DATA / 'screws' / 'nominal.yaml').read_text(encoding='utf-8')


@pytest.fixture
def record(run, capsys, tmp_path):
    """Return the function that gives the JSON of the nominal sheet with other keys."""

    def printed(roughness, screw='', *words):
        path = tmp_path / 'sheet.yaml'
        path.write_text(screw + NOMINAL.replace('state: new', roughness), encoding='utf-8')
        assert run('--screw', path, '--json', *words) == 0
        return json.loads(capsys.readouterr().out)

    return printed


def test_the_shipped_sheet_as_a_page_in_the_range_of_the_oil(run, capsys):
    """Both states, though the sheet names one."""
    assert run('--screw', 'nominal', '--oil', 'iso_vg_68') == 0
    page = capsys.readouterr().out
    for part in (
        'nominal, iso_vg_68: 0 N, 40 degC',
        'new, after its first pass ',
        'cut at 7 GPa',
        'cut at 3 GPa',
        'a measured film floor by torque at slow speeds leaves ',
        'Contact is likely below',
        'raceway (new): Rq 0.12 um',
    ):
        assert part in page
    with pytest.raises(InputError, match='the range of the oil sheet'):
        run('--screw', 'nominal', '--oil', 'iso_vg_68', '--temperature-degC', 120)


def test_pressures_load_and_trace_are_those_of_the_sheet(record):
    """Harder summits touch at faster speeds."""
    one = 'run_in_pressure_GPa: 3.0\n  run_in_low_GPa: 3.0\n  run_in_high_GPa: 3.0'
    states = record(f'{one}\n  hardness_GPa: 5.0')['states']
    assert states['new']['cutting_pressure_Pa'] == 5e9
    assert states['run_in']['cutting_pressure_Pa'] == 3e9
    assert states['new']['speed_rad_s'] > states['run_in']['speed_rad_s'] > 0
    found = record('traced: run_in', 'working_load_N: 900.0\n', '--load-N', 500)
    assert list(found['states']) == ['run_in']
    assert (found['working_load_N'], found['working_load_stated']) == (900.0, True)
    assert found['load_N'] == 500.0


def test_a_picture_is_drawn_where_it_is_asked_for(run, tmp_path):
    pytest.importorskip('matplotlib')
    assert run('--screw', 'nominal', '--oil', 'iso_vg_68', '--plot', tmp_path / 'deep') == 0
    assert [path.name for path in (tmp_path / 'deep').iterdir()] == ['onset_nominal_iso_vg_68.png']


def test_a_shipped_screw_comes_with_the_marches_of_its_surface(tmp_path):
    """As another name for the same surface; a sheet that differs from the shipped one has none."""
    name = 'iso3408_16x5'
    stated = read(shipped_surface(name)).header['inputs']['screw']
    shipped, surface, changed = (
        load_inputs(argparse.Namespace(screw=str(screw), oil='iso_vg_32', verbose=False))[0]
        for screw in (name, shipped_surface(name), other_sheet(tmp_path, name))
    )
    assert shipped.stated() == surface.stated() == stated
    assert shipped.service() == load_screw(name).service()
    assert shipped.roughness.marched_film is not None
    assert changed.roughness.marched_film is None


def other_sheet(folder, name):
    """Return the path of a shipped sheet with another fan of its ridges."""
    text = (DATA / 'screws' / f'{name}.yaml').read_text(encoding='utf-8')
    path = folder / 'sheet.yaml'
    path.write_text(text.replace('fan_angle_deg: 10.0', 'fan_angle_deg: 12.0'), encoding='utf-8')
    return path
