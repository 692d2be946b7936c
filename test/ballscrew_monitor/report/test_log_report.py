# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One recording from a bag to all that is left of it."""

import csv
import json
import os
import shutil
import subprocess
import sys

from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.report import log_report
from ballscrew_monitor.report.log_report import (
    JUDGED_SHARE,
    remove_left,
    report_log,
    scratch_folder,
    STORED_SHARE,
    write_events,
)
from ballscrew_monitor.report.parameters import LogParameters, parameters_for
from ballscrew_monitor.settings.parameters import absolute, read_file
from ballscrew_msgs.msg import BallScrewState
from diagnostic_msgs.msg import DiagnosticArray
import polars as pl
import pytest
from rclpy.serialization import deserialize_message


@pytest.fixture(scope='module')
def params(request):
    return request.config.rootpath / 'config' / 'nominal_cycle.yaml'


@pytest.fixture(scope='module')
def reported(short_bag, params, tmp_path_factory):
    out = tmp_path_factory.mktemp('out') / 'report'
    bag = Bag(short_bag)
    return report_log(bag, out, parameters_for(bag, None, params)), out


def test_all_products_hold_every_sample_and_each_state_behind_its_cause(reported, short_bag):
    result, out = reported
    expected = ['events.csv', 'judged', 'report.html', 'states.parquet', 'summary.json']
    assert sorted(path.name for path in out.iterdir()) == expected
    assert result.judged
    wanted = [('x', 'bad', 1)]
    assert [(line.axis, line.standing, line.warnings) for line in result.lines] == wanted
    rows = pl.read_parquet(out / 'states.parquet')
    assert rows.height == Bag(short_bag).topics['/joint_states'].count
    totals = json.loads((out / 'summary.json').read_text())['axes']['x']['totals']
    assert rows['reason'].is_in(['JUDGED', 'STANDSTILL']).sum() == totals['judged']
    found = [(one.log_time, one.topic) for one in Bag(out / 'judged').messages()]
    assert [time for time, _ in found] == sorted(time for time, _ in found)
    causes = set()
    for log_time, topic in found:
        if topic == '/joint_states':
            causes.add(log_time)
        elif topic.endswith('/state'):
            assert log_time in causes
    assert causes


def test_the_judged_bag_holds_inputs_and_what_the_node_would_say(reported, short_bag, params):
    _, out = reported
    bag, original = Bag(out / 'judged'), Bag(short_bag)
    counts = {name: topic.count for name, topic in bag.topics.items()}
    for name, topic in original.topics.items():
        assert counts[name] == topic.count
    assert counts['/ballscrew_monitor/x/out_of_zone'] == 1  # it is still on
    assert counts['/ballscrew_monitor/x/surface_info'] == 1
    assert 3 <= counts['/diagnostics'] <= 12
    found = [
        (message.log_time, deserialize_message(message.data, BallScrewState))
        for message in bag.messages(['/ballscrew_monitor/x/state'])
    ]
    wanted = [
        (stamp_of(state), state.zone, state.judged)
        for state, _ in replay(original, read_file(params))
    ]
    assert [(stamp_of(state), state.zone, state.judged) for _, state in found] == wanted
    speeds = [message.log_time for message in original.messages(['/joint_states'])]
    assert [log_time for log_time, _ in found] == speeds


def test_each_diagnostics_tell_of_every_axis(short_bag, params, tmp_path):
    values = read_file(params)
    values |= {name.replace('x.', 'y.', 1): one for name, one in values.items() if name[0] == 'x'}
    parameters = LogParameters(values=values | {'axes': ['x', 'y']}, origin='mine')
    report_log(Bag(short_bag), tmp_path, parameters)
    told = list(Bag(tmp_path / 'judged').messages(['/diagnostics']))
    for message in told[1:]:  # the first one is of the axis that was judged first
        names = [one.name for one in deserialize_message(message.data, DiagnosticArray).status]
        assert {name.split(': ')[1] for name in names} == {'x', 'y'}
        assert len(names) == len(set(names))
    assert 3 <= len(told) <= 13


def test_the_judged_bag_says_of_what_log_it_is(short_bag, params, tmp_path):
    bag = Bag(short_bag)
    own = {'ballscrew_monitor.source': 'log.csv', 'ballscrew_monitor.mapping': '{}'}
    own |= {f'ballscrew_monitor.{name}': '[]\n' for name in ('notes', 'assumptions')}
    bag.metadata = own | {'robot': 'press 7'}
    report_log(bag, tmp_path, parameters_for(bag, None, params))
    found = Bag(tmp_path / 'judged').metadata
    expected = {key: text.strip() for key, text in own.items()}
    assert {key: text.strip() for key, text in found.items()} == expected


def test_the_judged_bag_carries_the_parameters_it_was_judged_with(short_bag, params, tmp_path):
    given = tmp_path / 'given.yaml'
    given.write_text(params.read_text() + '      limits: {rcs: 0.5}\n')
    bag = Bag(short_bag)
    bag.metadata = {'ballscrew_monitor.parameters': params.read_text()}
    report_log(bag, tmp_path / 'out', parameters_for(bag, given, params))
    again = parameters_for(Bag(tmp_path / 'out' / 'judged'), None, params)
    assert again.values == read_file(given)
    assert again.values['x.limits.rcs'] == 0.5
    assert not again.nominal


def test_the_share_that_is_done_rises_to_one_with_all_products(short_bag, params, tmp_path):
    bag, shares, there = Bag(short_bag), [], []

    def on_share(share):
        shares.append(share)
        there.append(sorted(path.name for path in tmp_path.glob('[a-z]*')))

    report_log(bag, tmp_path, parameters_for(bag, None, params), on_share=on_share)
    assert shares == sorted(shares)
    assert shares[-3:] == [JUDGED_SHARE, STORED_SHARE, 1.0]
    assert there[-3] == there[-2] == []
    assert there[-1] == sorted(path.name for path in tmp_path.iterdir() if path.name[0] != '.')


@pytest.mark.parametrize('share', [0.0, JUDGED_SHARE, STORED_SHARE])
def test_an_interrupt_leaves_what_was_there(reported, short_bag, params, tmp_path, share):
    _, whole = reported
    names = files(whole)
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text('older')
    bag = Bag(short_bag)

    def interrupt(done):
        if done >= share:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        report_log(bag, tmp_path, parameters_for(bag, None, params), on_share=interrupt)
    assert files(tmp_path) == names
    assert {(tmp_path / name).read_text() for name in names} == {'older'}


def test_what_a_kill_leaves_goes_with_the_next_report(short_bag, params, tmp_path):
    """A copy is what a process that is killed leaves: nothing there is locked any more."""
    bag, out, left = Bag(short_bag), tmp_path / 'out', []

    def copy(share):
        if share < 1.0:
            left.append(tmp_path / str(len(left)))
            shutil.copytree(out, left[-1])

    report_log(bag, out, parameters_for(bag, None, params), on_share=copy)
    assert len(left) >= 2
    for folder in left:
        assert files(folder)
        remove_left(folder)
        assert not list(folder.iterdir())


def files(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob('*') if path.is_file())


def test_a_message_that_does_not_decode_is_counted(short_bag, params, copy_bag, tmp_path):
    load, cut = absolute(read_file(params)['x.load.topic']), []

    def damaged(message):
        if message.topic != load or cut:
            return message.data
        cut.append(message)
        return message.data[:12]

    found = copy_bag(Bag(short_bag), tmp_path / 'damaged', damaged)
    result = report_log(found, tmp_path / 'out', parameters_for(found, params, params))
    assert result.judged
    inputs = json.loads((tmp_path / 'out' / 'summary.json').read_text())['axes']['x']['inputs']
    assert inputs['load']['refused'] == '1 that do not decode'


def test_a_bag_may_be_not_judged_but_must_fit(short_bag, params, tmp_path, refused):
    values = read_file(params) | {'x.speed.field': 'velocity[nope]'}
    result = report_log(Bag(short_bag), tmp_path, LogParameters(values=values, origin='mine'))
    assert not result.judged
    assert result.unjudged == ['x']
    assert 'Not known' in (tmp_path / 'report.html').read_text()
    values = read_file(params) | {'x.load.topic': 'nope'}
    with refused('topic_nope'):
        report_log(Bag(short_bag), tmp_path / 'out', LogParameters(values=values, origin='mine'))
    assert not list((tmp_path / 'out').glob('*'))


def test_events_are_a_line_each_and_none_is_a_table_without_lines(judged, tmp_path):
    events = [judged.event(1, 0.1, 0.2), judged.event(2, 0.5, 0.1, active=True)]
    case = judged.case([judged.rows()], events)
    write_events(tmp_path / 'events.csv', judged.log(case))
    with (tmp_path / 'events.csv').open(newline='', encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    expected = [('x', '1', 'False'), ('x', '2', 'True')]
    assert [(row['axis'], row['event_id'], row['active']) for row in rows] == expected
    assert float(rows[1]['start_s']) == 0.5
    assert [float(rows[0][name]) for name in ('speed_rad_s', 'axial_load_N')] == [45.0, -1200.0]
    assert rows[0]['target_speed_rad_s'] == '60.0'
    assert not [name for name in rows[0] if 'target_load' in name]
    assert int(rows[0]['start_stamp_ns']) == judged.begin + 100_000_000
    log = judged.log(judged.case([judged.rows()]))
    write_events(tmp_path / 'events.csv', log)
    assert (tmp_path / 'events.csv').read_text().startswith('axis,event_id,')


KILLED = """
import os
import signal
import sys
from pathlib import Path
from ballscrew_monitor.report.log_report import scratch_folder
with scratch_folder(Path(sys.argv[1])) as folder:
    (folder / 'rows').touch()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_process_has_left_is_removed_and_what_is_in_use_is_not(tmp_path):
    environment = os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, '-c', KILLED, str(tmp_path)], env=environment, check=False)
    (left,) = tmp_path.iterdir()
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert not left.exists()
        assert set(tmp_path.iterdir()) == {first, second}
    assert not list(tmp_path.iterdir())


def test_where_there_are_no_locks_nothing_is_taken_away(tmp_path, monkeypatch):
    def refuse(*_):
        raise OSError

    monkeypatch.setattr(log_report.fcntl, 'flock', refuse)
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert set(tmp_path.iterdir()) == {first, second}


def test_an_interrupt_as_soon_as_a_folder_is_there_leaves_nothing(tmp_path, monkeypatch):
    make = os.mkdir

    def make_and_interrupt(*arguments):
        make(*arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, 'mkdir', make_and_interrupt)
    with pytest.raises(KeyboardInterrupt), scratch_folder(tmp_path):
        raise AssertionError
    assert not list(tmp_path.iterdir())
