# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The ledger of each input, by files whose writer counted its messages."""

import json
import math

from ballscrew_monitor import cli
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason, Zone
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.ledger import ledger_of, unjudged_share
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.report.verdict import verdict_of, VerdictKind
from ballscrew_monitor.settings import parameters
from ballscrew_msgs.msg import Totals
from geometry_msgs.msg import WrenchStamped
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import String
import yaml

BEGIN = 1_767_600_000 * SECOND
STEP = SECOND // 100
SPEED, LOAD = '/joint_states', '/axial_load'
TYPES = {
    SPEED: 'sensor_msgs/msg/JointState',
    LOAD: 'geometry_msgs/msg/WrenchStamped',
    '/note': 'std_msgs/msg/String',
}
COLUMNS = (
    'time: {column: t, unit: s}\naxes:\n  x:\n    speed: {column: v, unit: mm/s}\n'
    '    load: {column: f, unit: N}\n    lead_mm: 10.0\n    screw: nominal\n    oil: iso_vg_68\n'
    '    temperature_degC: 40.0\nassumed:\n  time.epoch: {value: "2026-01-05T08:00:00Z", '
    'reason: test}\n'
)


def stamped(message, stamp):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return message


def speed(stamp, value=60.0, joint='x_axis'):
    return SPEED, stamped(JointState(name=[joint], velocity=[value]), stamp)


def load(stamp, value=-1000.0):
    message = stamped(WrenchStamped(), stamp)
    message.wrench.force.x = value
    return LOAD, message


def at(number):
    """Return the stamp of a sample [ns]."""
    return BEGIN + number * STEP


def write(folder, timed):
    """Write messages with their log times as a bag."""
    with BagWriter(folder, folder.name) as writer:
        for name, kind in TYPES.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for log_time, (topic, message) in timed:
            times = {'log_time': log_time, 'publish_time': log_time}
            writer.write(topic, serialize_message(message), **times)
    return folder


def motion(numbers, **loads):
    """Yield a load and a speed for each number, the load that `loads` gives or the usual one."""
    for number in numbers:
        yield at(number), load(at(number), loads.get(str(number), -1000.0))
        yield at(number), speed(at(number))


def promise(folder, more):
    """Let the metadata of a bag count `more` messages of each topic."""
    file = folder / 'metadata.yaml'
    content = yaml.safe_load(file.read_text())
    for topic in content['rosbag2_bagfile_information']['topics_with_message_count']:
        topic['message_count'] += more
    file.write_text(yaml.safe_dump(content))


def judge(folder, **changes):
    values = parameters.defaults(['x']) | changes
    return judge_log(Bag(folder), LogParameters(values=values, origin='test'))


def test_what_is_whole_has_no_difference(tmp_path):
    log = judge(write(tmp_path / 'bag', motion(range(200))))
    for source in (Source.SPEED, Source.LOAD):
        ledger = ledger_of(log.axes[0], source)
        counts = ledger.promised, ledger.present, ledger.read, ledger.judged
        assert counts == (200, 200, 200, 200)
        assert ledger.losses == {}
    assert unjudged_share(log) == 0.0


def test_each_difference_of_a_bag_has_its_number_and_reason(tmp_path):
    unknown = {str(number): math.nan for number in range(100, 130)}
    timed = list(motion(range(200), **unknown))
    timed += [(at(400) + number, speed(at(number))) for number in range(190, 195)]
    timed += [(at(410) + n, speed(at(410) + n, joint='z_axis')) for n in range(40)]
    timed += [(at(420) + n, speed(at(420) + n, value=math.nan)) for n in range(3)]
    timed += [(at(430) + n, ('/note', String(data='nothing'))) for n in range(7)]
    folder = write(tmp_path / 'bag', timed)
    promise(folder, 10)
    log = judge(folder)
    speeds, loads = (ledger_of(log.axes[0], one) for one in (Source.SPEED, Source.LOAD))
    # Written were 200 speeds, 5 again and late, 40 of another joint, 3 that are no number.
    assert (speeds.promised, speeds.present, speeds.read) == (258, 248, 208)
    assert speeds.judged == 170
    assert speeds.losses == {
        Bag.absent: 10,
        'of other joints': 40,
        'not a number': 3,
        'out of order': 5,
        Reason.NO_LOAD.text: 30,
    }
    assert speeds.promised - sum(speeds.losses.values()) == speeds.judged
    assert (loads.promised, loads.present, loads.read, loads.judged) == (210, 200, 200, 170)
    assert loads.losses == {Bag.absent: 10, 'not a number': 30}
    # Those of another joint were never to be judged.
    assert unjudged_share(log) == pytest.approx(48 / 218)
    assert log.unread == {'/note': 7}


def test_a_hole_of_a_bag_within_a_motion_is_not_judged(tmp_path):
    log = judge(write(tmp_path / 'bag', motion([*range(100), *range(200, 300)])))
    ledger = ledger_of(log.axes[0], Source.SPEED)
    assert (ledger.expected, ledger.judged) == (200, 200)
    assert unjudged_share(log) == pytest.approx(1.01 / 2.99)
    assert ledger.words == '34 % of the motion in gaps between samples in motion'


def test_positions_that_make_no_speed_have_a_reason_of_their_own(tmp_path):
    timed = []
    for number in range(200):
        message = JointState(name=['x_axis'], position=[60.0 * number / 100])
        timed += [
            (at(number), load(at(number))),
            (at(number), (SPEED, stamped(message, at(number)))),
        ]
    changes = {'x.speed.field': 'position[x_axis]', 'x.speed.unit': 'rad'}
    ledger = ledger_of(judge(write(tmp_path / 'bag', timed), **changes).axes[0], Source.SPEED)
    ((reason, first),) = ledger.losses.items()
    assert reason == 'out of order or without a position to make a speed with'
    assert 0 < first < 20
    assert ledger.judged == 200 - first


def test_an_axis_without_a_sample_is_not_judged_at_all(tmp_path):
    folder = write(tmp_path / 'bag', motion(range(50)))
    assert unjudged_share(judge(folder, **{'x.speed.field': 'velocity[nope]'})) == 1.0


def table(path, cell):
    """Write 300 rows at 100 Hz; `cell` gives time and load of a row as text."""
    rows = (f'{time},50,{force}' for time, force in map(cell, range(300)))
    path.write_text('t,v,f\n' + '\n'.join(rows) + '\n')
    (path.parent / 'map.yaml').write_text(f'log: {path.name}\n{COLUMNS}')
    return ['replay', str(path), '--map', str(path.parent / 'map.yaml')]


def test_rows_of_a_table_are_counted_as_messages_are(tmp_path, capsys):
    arguments = table(
        tmp_path / 'feed.csv',
        lambda row: (
            '' if 100 <= row < 120 else f'{row / 100}',
            'nan' if 200 <= row < 230 else '-1000',
        ),
    )
    assert cli.main([*arguments, '--json']) == 1
    record = json.loads(capsys.readouterr().out)['x']
    assert record['unjudged_share'] == pytest.approx(50 / 300)
    speeds = record['inputs']['speed']['ledger']
    assert speeds == {
        'promised': 300,
        'present': 280,
        'read': 280,
        'judged': 250,
        'losses': {TableLog.absent: 20, Reason.NO_LOAD.text: 30},
    }
    loads = record['inputs']['load']['ledger']
    assert (loads['present'], loads['judged']) == (280, 250)


@pytest.mark.parametrize(
    ('name', 'promised', 'judged'),
    [
        ('every second row, then none', 420, 220),
        ('none for a while', 300, 180),
        ('none at the end', 300, 180),
        ('none at the begin', 300, 180),
        ('rows of two tables', 300, 300),
        ('too few cells', 300, 288),
    ],
)
def test_a_speed_that_is_empty_for_long_is_missing(tmp_path, capsys, name, promised, judged):
    """An empty cell is no sample, as beside another clock; many together are a loss."""
    hollow = {
        'every second row, then none': [
            f'{row / 100},{"" if row % 2 or 240 <= row < 640 else 50},-1000' for row in range(840)
        ],
        'none for a while': [
            f'{row / 100},{"" if 100 <= row < 220 else 50},-1000' for row in range(300)
        ],
        'none at the end': [f'{row / 100},{50 if row < 180 else ""},-1000' for row in range(300)],
        'none at the begin': [
            f'{row / 100},{50 if row >= 120 else ""},-1000' for row in range(300)
        ],
        'rows of two tables': [
            *(f'{row / 100},50,' for row in range(300)),
            *(f'{row / 100},,-1000' for row in range(300)),
        ],
        'too few cells': [
            f'{row / 100},50' if row % 25 == 7 else f'{row / 100},50,-1000' for row in range(300)
        ],
    }
    path = tmp_path / 'feed.csv'
    arguments = table(path, lambda row: ('', ''))
    path.write_text('t,v,f\n' + '\n'.join(hollow[name]) + '\n')
    assert cli.main([*arguments, '--json']) == int(judged < 0.95 * promised)
    speed = json.loads(capsys.readouterr().out)['x']['inputs']['speed']
    ledger = speed['ledger']
    assert (ledger['promised'], ledger['judged']) == (promised, judged)
    if name.startswith('none'):
        assert speed['rate_Hz'] == pytest.approx(100.0)
    missing = promised - judged
    assert ledger['losses'] == ({TableLog.absent: missing} if missing else {})


@pytest.mark.parametrize(
    ('unknown', 'option', 'code'),
    [
        (0, [], 0),
        (15, [], 0),
        (16, [], 1),
        (16, ['--most-unjudged-percent', '6'], 0),
        (15, ['--most-unjudged-percent', '4'], 1),
    ],
)
def test_the_share_that_is_allowed_decides_the_exit_code(tmp_path, capsys, unknown, option, code):
    arguments = table(
        tmp_path / 'feed.csv',
        lambda row: (f'{row / 100}', 'nan' if 100 <= row < 100 + unknown else '-1000'),
    )
    assert cli.main([*arguments, *option]) == code
    assert ('--most-unjudged-percent' in capsys.readouterr().err) == bool(code)


@pytest.mark.parametrize('share', ['-1', '101', 'nan'])
def test_a_share_beyond_all_is_refused(tmp_path, capsys, share, says):
    arguments = table(tmp_path / 'feed.csv', lambda row: (f'{row / 100}', '-1000'))
    assert cli.main([*arguments, '--most-unjudged-percent', share]) == 2
    assert says('most_unjudged', share=share) in capsys.readouterr().err


@pytest.mark.usefixtures('one_worker')
def test_reports_of_one_and_of_many_hold_the_ledger_and_the_exit_code(tmp_path, capsys):
    bag, params = write(tmp_path / 'logs' / 'bag', motion(range(200))), tmp_path / 'params.yaml'
    params.write_text("/**/ballscrew_monitor: {ros__parameters: {axes: ['x']}}\n")
    promise(bag, 40)
    out, with_params = tmp_path / 'out', ['--params', str(params)]
    assert cli.main(['replay', str(bag), '--out', str(out), *with_params]) == 1
    ledger = json.loads((out / 'summary.json').read_text())['axes']['x']['inputs']['speed']
    assert ledger['ledger']['promised'] == 240
    assert f'40 {Bag.absent}' in (out / 'report.html').read_text()
    capsys.readouterr()
    many = ['replay', str(tmp_path / 'logs'), '--out', str(tmp_path / 'all'), '--workers', '1']
    many += with_params
    assert cli.main(many) == 1
    assert '1 recording, 1 bad' in capsys.readouterr().out
    assert cli.main([*many, '--most-unjudged-percent', '20']) == 0


@pytest.mark.parametrize(('more', 'standing'), [(0, 'good'), (190, 'good'), (210, 'unknown')])
def test_half_of_what_was_promised_is_needed_to_be_good(tmp_path, more, standing):
    folder = write(tmp_path / 'bag', motion(range(200)))
    promise(folder, more)
    changes = {'x.limits.rcs': 0.99, 'x.limits.efficiency': 0.01}
    verdict = verdict_of(judge(folder, **changes).axes[0])
    assert verdict.standing is VerdictKind(standing)


def test_a_motion_that_was_seldom_seen_in_the_zone_is_not_good(judged, says):
    times = {'running_time': 60.0, 'optimal_time': 24.0, 'outside_time': 8.0}
    times['unjudged_time'] = 28.0
    totals = Totals(**times)
    reasons = [Reason.LOAD_OUT_OF_RANGE] * 2800 + [Reason.JUDGED] * 3200
    zones = [Zone.UNKNOWN] * 2800 + [Zone.OPTIMAL] * 3200
    case = judged.case([judged.rows(count=6000, reason=reasons, zone=zones)], totals=totals)
    verdict = verdict_of(case)
    assert verdict.whole == says('seldom_optimal')
    assert verdict.standing is VerdictKind.UNKNOWN
