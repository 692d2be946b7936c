# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Two machines with one axis x each are two histories; a machine is a stated name or a folder."""

import json

from ballscrew_monitor.cli import main
from ballscrew_monitor.report.machines import (
    axis_titles,
    folder_of,
    folders_note,
    machine_names,
    MachineAxis,
)
import pytest

MAP = """
time: {column: t, unit: s}
axes:
  x:
    speed: {column: v, unit: rad/s}
    load: {column: f, unit: N}
    lead_mm: 10.0
"""
NEW_YEAR = 1_767_225_600  # [s]


@pytest.fixture
def logs(tmp_path, monkeypatch):
    """Return what writes short logs by their paths, and their map; the folder is the present."""
    monkeypatch.chdir(tmp_path)

    def write(*names, machine=''):
        for day, name in enumerate(names):
            begin = NEW_YEAR + 86_400 * day
            rows = ''.join(
                f'{begin + 0.01 * row:.2f},{10.0 + row % 7},-500\n' for row in range(100)
            )
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text('t,v,f\n' + rows)
        (tmp_path / 'map.yaml').write_text(MAP + (f'machine: {machine}\n' if machine else ''))
        return [*names]

    return write


@pytest.fixture
def told(capsys):
    """Return what gives the records of `ballscrew health` by logs, and what it says of folders."""

    def tell(names):
        assert main(['health', *names, '--map', 'map.yaml', '--json']) == 0
        shown = capsys.readouterr()
        lines = shown.err.splitlines()
        return json.loads(shown.out), [line for line in lines if 'folders' in line]

    return tell


def test_machines_with_one_axis_x_each_are_two_histories(logs, told, says):
    names = logs('mill/one.csv', 'mill/two.csv', 'lathe/one.csv')
    records, said = told(names)
    found = {title: (one['axis'], one['machine']) for title, one in records.items()}
    assert found == {'x of mill': ('x', 'mill'), 'x of lathe': ('x', 'lathe')}
    assert [len(one['course']) for one in records.values()] == [2, 1]
    assert [one['machine'] for one in records['x of mill']['course']] == ['mill', 'mill']
    assert records['x of lathe']['verdict'].startswith('Axis x of lathe: ')
    assert said == [f'ballscrew: {says("folders")}']


def test_one_folder_is_one_machine_however_it_is_written(logs, told):
    logs('mill/one.csv', 'mill/two.csv')
    records, said = told(['mill/one.csv', './mill/../mill/two.csv'])
    assert [(key, one['machine']) for key, one in records.items()] == [('x', 'mill')]
    assert len(records['x']['course']) == 2
    assert records['x']['verdict'].startswith('Axis x: ')
    assert said == []


def test_a_machine_in_the_map_joins_the_folders_of_its_days(logs, told):
    records, said = told(logs('day1/x.csv', 'day2/x.csv', 'day3/x.csv', machine='mill 3'))
    assert [(key, one['machine']) for key, one in records.items()] == [('x', 'mill 3')]
    assert len(records['x']['course']) == 3
    assert said == []


def test_a_bag_that_was_imported_knows_the_machine_of_its_map(logs, capsys):
    logs('day1/x.csv', 'day2/x.csv', machine='mill 3')
    bags = []
    for day in ('day1', 'day2'):
        bags.append(f'bags/{day}/x')
        assert main(['import', f'{day}/x.csv', '--config', 'map.yaml', '--out', bags[-1]]) == 0
    capsys.readouterr()
    assert main(['health', *bags, '--json']) == 0
    (record,) = json.loads(capsys.readouterr().out).values()
    assert (record['machine'], len(record['course'])) == ('mill 3', 2)


@pytest.mark.usefixtures('one_worker')
def test_the_overview_tells_machines_apart(logs, says, tmp_path):
    names = logs('mill/one.csv', 'lathe/one.csv')
    main(['replay', *names, '--map', 'map.yaml', '--out', 'out', '--workers', '1'])
    page = (tmp_path / 'out' / 'index.html').read_text()
    assert '<td>x of mill</td>' in page
    assert '<td>x of lathe</td>' in page
    assert says('folders') in page


def test_the_own_record_of_a_machine_of_any_name_may_be_replaced(logs):
    names = logs('a "b/x.csv', 'c/x.csv')
    command = ['health', *names, '--map', 'map.yaml', '--out', 'out']
    assert [main(command), main(command)] == [0, 0]


def test_a_picture_has_no_more_axes_than_it_has_room_for(logs, capsys, monkeypatch, says):
    names = logs('a/x.csv', 'b/x.csv', 'c/x.csv')
    monkeypatch.setattr('ballscrew_monitor.report.health_picture.MOST_DRAWN', 2)
    assert main(['health', *names, '--map', 'map.yaml', '--out', 'out']) == 0
    assert says('picture') in capsys.readouterr().err


def test_the_folder_that_holds_a_recording(tmp_path, monkeypatch):
    bag, parts, other = (tmp_path / name for name in ('mill/bag', 'mill/parts', 'other'))
    for folder in (bag, parts, other):
        folder.mkdir(parents=True)
    for file in (bag / 'metadata.yaml', bag / 'bag_0.mcap', parts / 'parts_0.mcap'):
        file.touch()
    (other / 'link.mcap').symlink_to(parts / 'parts_0.mcap')
    mill = (tmp_path / 'mill').resolve()
    assert folder_of(bag) == folder_of(bag / 'bag_0.mcap') == mill
    assert folder_of(parts) == folder_of(parts / 'parts_0.mcap') == mill
    assert folder_of(other / 'link.mcap') == other.resolve()
    monkeypatch.chdir(bag)
    assert [folder_of(type(bag)(name)) for name in ('.', 'bag_0.mcap', '../bag')] == [mill] * 3


def test_the_folder_of_a_killed_recorder_is_the_recording_itself(tmp_path):
    killed, finished = (tmp_path / f'recordings/20260105T06000{n}Z' for n in range(2))
    for folder in (killed, finished):
        folder.mkdir(parents=True)
    (killed / f'{killed.name}.mcap.active').touch()
    for name in (f'{finished.name}.mcap', 'metadata.yaml'):
        (finished / name).touch()
    assert folder_of(killed) == folder_of(finished) == killed.parent.resolve()
    assert folder_of(next(killed.iterdir())) == killed.parent.resolve()


@pytest.mark.parametrize('beside', ['other.mcap', 'mill.csv', 'day/day_0.mcap'])
def test_a_folder_with_more_than_the_bag_of_its_name_is_a_machine(tmp_path, beside):
    mill = tmp_path / 'mill'
    (mill / 'day').mkdir(parents=True)
    for name in ('mill.mcap', beside):
        (mill / name).touch()
    assert folder_of(mill / 'mill.mcap') == mill.resolve()


def axes_of(*machines, axis='x'):
    return [MachineAxis(one, axis) for one in machines]


def test_folders_of_one_name_show_as_much_of_their_path_as_tells_them_apart():
    names = machine_names(axes_of('/hall1/a', '/hall2/a', '/hall2/b', '/c/hall1/a', '/a', 'mill'))
    assert [*names.values()] == ['/hall1/a', 'hall2/a', 'b', 'c/hall1/a', '/a', 'mill']
    assert [*machine_names(axes_of('/hall1/a', 'a')).values()] == ['hall1/a', 'a']
    assert len(set(names.values())) == len(names)


def test_a_machine_is_named_where_its_axis_shares_a_name_alone():
    titles = axis_titles([*axes_of('/a', '/b'), *axes_of('/b', axis='z')])
    assert [*titles.values()] == ['x of a', 'x of b', 'z']
    assert [*axis_titles(axes_of('/a', '/a')).values()] == ['x']
    assert axis_titles([]) == {}


def test_only_folders_that_share_a_name_of_an_axis_are_told_of():
    assert folders_note([*axes_of('/a'), *axes_of('/b', axis='y')]) == ''
    assert folders_note(axes_of('/a', 'mill')) == ''
    assert folders_note(axes_of('mill', 'lathe')) == ''
    assert folders_note(axes_of('/a', '/b', 'mill')).startswith('2 folders ')
