# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings that paths mean, and the folders of their reports."""

import contextlib
from pathlib import Path

from ballscrew_monitor.recordings.tables.sources import is_log
from ballscrew_monitor.report import logs
from ballscrew_monitor.report.logs import (
    find_logs,
    folder_names,
    is_one_bag,
    left_out,
    replace_report,
)
import pytest


def touch(*paths):
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b'')


def names(found, root):
    return [str(path.relative_to(root)) for path in found]


def test_a_folder_stands_for_what_it_holds(tmp_path):
    touch(
        tmp_path / 'one' / 'metadata.yaml',
        tmp_path / 'a.mcap',
        tmp_path / 'deep' / 'two' / 'metadata.yaml',
        tmp_path / 'other' / 'notes.txt',
        tmp_path / '.rows-x' / 'hidden.mcap',
    )
    assert names(find_logs([tmp_path]), tmp_path) == ['a.mcap', 'deep/two', 'one']


def parts(pattern, numbers=range(11)):
    return [pattern.format(number) for number in numbers]


@pytest.mark.parametrize(
    'held',
    [
        parts('bag_{}.mcap', range(2)),
        parts('press.v2_{}.mcap'),
        parts('axis.2026-01-01_{}.mcap'),
        parts('a_1.b_{}.db3'),
        parts('a.b_{}.mcap.zstd'),
        ['press.v2_0.mcap', 'press.v2_1.mcap.active'],
    ],
)
def test_parts_of_a_split_bag_are_one_recording(tmp_path, held):
    """A point in a name is part of it, and a part that is not finished is one all the same."""
    touch(*(tmp_path / name for name in held))
    assert is_one_bag(tmp_path)
    assert find_logs([tmp_path]) == [tmp_path]
    touch(tmp_path / 'press.v3_0.mcap')
    assert not is_one_bag(tmp_path)
    finished = [name for name in held if not name.endswith('.active')]
    assert names(find_logs([tmp_path]), tmp_path) == sorted([*finished, 'press.v3_0.mcap'])


@pytest.mark.parametrize(
    'held',
    [
        parts('bag_{}.mcap', (1, 2)),
        parts('bag_{}.mcap', (0, 2)),
        parts('bag_{}.mcap', (20260101, 20260102)),
        ['press.v2_0.mcap', 'press.v3_0.mcap'],
        ['axis.2026-01-01_0.mcap', 'axis.2026-01-02_0.mcap'],
        ['press.v2_0.mcap', 'press.v3_1.mcap'],
        ['press_0.v2.mcap', 'press_1.v2.mcap'],
    ],
)
def test_files_of_other_names_or_with_a_gap_are_recordings_of_their_own(tmp_path, held):
    touch(*(tmp_path / name for name in held))
    assert not is_one_bag(tmp_path)
    found = find_logs([tmp_path])
    assert names(found, tmp_path) == held
    assert folder_names(found) == [name.removesuffix('.mcap') for name in held]


def test_tables_count_beside_a_bag_where_they_are_asked_for(tmp_path):
    touch(tmp_path / 'a.mcap', tmp_path / 'b.csv')
    assert find_logs([tmp_path]) == [tmp_path]
    assert names(find_logs([tmp_path], tables=True), tmp_path) == ['a.mcap', 'b.csv']


@pytest.mark.parametrize('tables', [False, True])
def test_reports_that_are_there_already_are_no_recordings(tmp_path, tables):
    made = (logs.PAGE, logs.STATES, logs.EVENTS, logs.SUMMARY)
    for report in (tmp_path, tmp_path / 'one', tmp_path / 'reports' / 'a'):
        judged = report / logs.JUDGED
        touch(*(report / name for name in made), judged / 'j.mcap', judged / 'metadata.yaml')
    touch(tmp_path / 'a.mcap', tmp_path / 'one' / 'one.mcap')
    assert names(find_logs([tmp_path], tables=tables), tmp_path) == ['a.mcap', 'one']


def test_the_folder_of_the_reports_to_come_holds_no_recordings(tmp_path):
    touch(tmp_path / 'a.csv', tmp_path / 'out' / 'b' / logs.STATES)
    found = find_logs([tmp_path], tables=True, out=tmp_path / 'one' / '..' / 'out')
    assert names(found, tmp_path) == ['a.csv']


def test_what_is_named_twice_is_taken_once_and_nothing_is_refused(tmp_path, refused):
    gone = tmp_path / 'gone.mcap'
    assert find_logs([gone, gone]) == [gone]
    refused('holds_recording_hold', find_logs, [tmp_path])
    touch(tmp_path / 'one.csv')
    refused('import_one_guess', find_logs, [tmp_path])


@pytest.mark.parametrize(
    ('link', 'target'),
    [
        ('latest', 'run'),
        ('up', '..'),
        ('here', '.'),
        ('run/cousin', '../other'),
        ('b.csv', 'a.csv'),
    ],
)
def test_links_lead_to_each_recording_once(link, target, tmp_path):
    touch(*(tmp_path / 'logs' / name for name in ('a.csv', 'run/c.csv', 'other/d.csv')))
    (tmp_path / 'logs' / 'other' / 'back').symlink_to('../run')
    (tmp_path / 'logs' / link).symlink_to(target)
    found = find_logs([tmp_path / 'logs'], tables=True)
    assert sorted(path.resolve().name for path in found) == ['a.csv', 'c.csv', 'd.csv']
    assert not left_out([tmp_path / 'logs'], found, tables=True)


def test_a_link_to_a_folder_elsewhere_is_followed(tmp_path):
    touch(tmp_path / 'disk' / 'a.csv')
    (tmp_path / 'logs').mkdir()
    (tmp_path / 'logs' / 'mill').symlink_to('../disk')
    assert names(find_logs([tmp_path / 'logs'], tables=True), tmp_path) == ['logs/mill/a.csv']


def test_a_bag_of_ros_1_is_found_to_say_how_it_is_converted(tmp_path):
    (tmp_path / 'old.bag').write_bytes(b'#ROSBAG V2.0\n')
    (tmp_path / 'notes.bag').write_text('two bags of grease')
    touch(tmp_path / 'new' / 'a.mcap')
    assert names(find_logs([tmp_path]), tmp_path) == ['old.bag', 'new']


def test_tables_that_are_left_out_are_named(tmp_path):
    touch(tmp_path / 'a.mcap', *(tmp_path / f't{number}.csv' for number in range(7)))
    for path in tmp_path.glob('*.csv'):
        path.write_text('t,v\n')
    (sentence,) = left_out([tmp_path], find_logs([tmp_path]))
    assert 'left out' in sentence
    assert f'{tmp_path / "t4.csv"} and 2 more' in sentence
    assert not left_out([tmp_path], find_logs([tmp_path], tables=True))
    assert not left_out([tmp_path / 'a.mcap', tmp_path / 't1.csv'], [])


def test_tables_of_any_ending_are_found_with_a_map_and_all_other_files_are_named(tmp_path, says):
    """What `check` takes is what a replay by a map takes."""
    rows = 't,v\n' + ''.join(f'{row},{row}\n' for row in range(40))
    for name in ('feed.csv', 'scope.trc', 'below/other.rec'):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(rows)
    (tmp_path / 'plan.pdf').write_text('%PDF-1.4')
    (tmp_path / 'order').write_text('twelve nuts, please')
    (tmp_path / 'screw.yaml').write_text('lead_mm: 5.0')
    touch(tmp_path / 'empty.trc')
    found = logs.logs_of([tmp_path], tmp_path / 'screw.yaml')
    assert names(found, tmp_path) == ['feed.csv', 'scope.trc', 'below/other.rec']
    assert found == find_logs([tmp_path], tables=True, is_log=is_log)
    (sentence,) = left_out([tmp_path], found, tables=True)
    assert sentence == says('others', folder=tmp_path)
    assert [logs.map_for(one, tmp_path, alone=False) for one in found] == [tmp_path] * 3


def test_each_report_has_a_folder_of_its_own():
    logs = [Path('a/log.mcap'), Path('b/log.mcap'), Path('c/<img src=x>'), Path('d/..mcap')]
    made = folder_names(logs)
    assert len(set(made)) == 4
    assert made[:2] == ['log', 'log-2']
    assert not set('<> /') & set(''.join(made))
    made = folder_names([Path('x/log.mcap'), Path('log-2.mcap'), Path('y/log.mcap')])
    assert len(set(made)) == 3


NAMES = ('report.html', 'summary.json', 'states.parquet', 'judged/judged.mcap')


@pytest.mark.parametrize('there', [False, True])
@pytest.mark.parametrize('steps', range(2 * len(NAMES)))
def test_no_products_are_beside_a_page_of_others(tmp_path, monkeypatch, there, steps):
    made, out = tmp_path / 'made', tmp_path / 'out'
    for folder in (made, out):
        (folder / 'judged').mkdir(parents=True)
        for name in NAMES if there or folder == made else ():
            (folder / name).write_text(folder.name)
    (out / 'judged' / 'notes.txt').write_text('of a user')
    left = iter(range(steps))
    for name in ('replace', 'unlink'):
        monkeypatch.setattr(Path, name, interrupted(getattr(Path, name), left))
    with contextlib.suppress(KeyboardInterrupt):
        replace_report(made, out)
    found = {name: (out / name).read_text() for name in NAMES if (out / name).exists()}
    assert len(set(found.values())) <= 1
    assert not found or 'report.html' in found
    assert (len(found) == len(NAMES) and 'made' in found.values()) == (steps == 2 * len(NAMES) - 1)
    assert (out / 'judged' / 'notes.txt').exists()


def interrupted(change, left):
    """Return a change of a file that is interrupted when no more are left."""

    def changed(*arguments, **options):
        if next(left, None) is None:
            raise KeyboardInterrupt
        return change(*arguments, **options)

    return changed


def test_files_of_others_are_not_replaced(tmp_path, refused):
    logs.check_output(tmp_path / 'none')
    logs.check_output(tmp_path)
    touch(tmp_path / logs.EVENTS)
    refused('foreign', logs.check_output, tmp_path)
    touch(tmp_path / logs.PAGE)
    logs.check_output(tmp_path)


def test_where_a_report_was_removed_another_is_made(tmp_path, refused):
    """Unless files of others are beside the removed ones."""
    judged = tmp_path / logs.JUDGED
    products = judged / 'judged.mcap', judged / 'metadata.yaml', tmp_path / logs.EVENTS
    touch(*products, tmp_path / logs.PAGE)
    logs.remove_report(tmp_path)
    assert not list(tmp_path.iterdir())
    logs.check_output(tmp_path)
    touch(*products, judged / 'notes.txt', tmp_path / logs.PAGE)
    logs.remove_report(tmp_path)
    refused('removed', logs.check_output, tmp_path)


def test_what_sqlite_writes_beside_a_bag_is_read_with_it_and_not_left_out(tmp_path):
    bag = tmp_path / 'bag'
    touch(bag / 'metadata.yaml', bag / 'a_0.db3', bag / 'a_0.db3-wal', bag / 'a_0.db3-shm')
    found = find_logs([tmp_path])
    assert names(found, tmp_path) == ['bag']
    assert not left_out([tmp_path], found)
