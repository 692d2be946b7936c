# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The file to send holds what is needed, within its bounds, and nobody's name."""

import io
import json
import os
import zipfile

from ballscrew_monitor import cli
from ballscrew_monitor.clients import fault_report as reports
from ballscrew_monitor.clients import mask as masks
from ballscrew_monitor.clients.fault_report import fault_report, FaultCase
from ballscrew_monitor.clients.mask import Mask, Secret
from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.records import EVENT
from ballscrew_monitor.node import heartbeat
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_records import entry_of, Kind
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.event_messages import packed, read
from ballscrew_msgs.msg import AxisHealth, OutOfZone
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
import numpy as np
import pytest
from sensor_msgs.msg import CompressedImage, JointState, MultiEchoLaserScan
from std_msgs.msg import Header, String

HOST, USER, HOME = 'cell7-hmi', 'mgruber', '/srv/people/mgruber'
PERSON, REASON, OTHER, TOKEN = 'Jörg Huber', 'seen by J.H.', 'cell8-hmi', 'correct-horse-battery'
APPRENTICE = 'apprentice'  # another user, whose home is named
CHANGE = 'nut changed by Huber'
SECRETS = (
    CHANGE,
    HOST,
    USER,
    HOME,
    PERSON,
    json.dumps(PERSON)[1:-1],
    REASON,
    OTHER,
    TOKEN,
    APPRENTICE,
)
TOPICS = {
    f'/{HOST.replace("-", "_")}/joint_states': 'sensor_msgs/msg/JointState',
    '/monitor/x/out_of_zone': 'ballscrew_msgs/msg/OutOfZone',
    '/monitor/x/health': 'ballscrew_msgs/msg/AxisHealth',
    '/diagnostics': 'diagnostic_msgs/msg/DiagnosticArray',
    '/monitor/judge_events': 'ballscrew_msgs/msg/JudgeEvents',
}


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """Run on a machine of these names."""
    monkeypatch.setattr(masks.socket, 'gethostname', lambda: HOST)
    monkeypatch.setattr(masks.Path, 'home', lambda: masks.Path(HOME))
    monkeypatch.setenv('LOGNAME', USER)
    monkeypatch.setenv('USER', USER)
    monkeypatch.setattr(reports.tempfile, 'tempdir', str(tmp_path))


def instance_of(host):
    """Return what a node on a host says of itself."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heartbeat.socket, 'gethostname', lambda: host)
        return heartbeat.own_instance().value


def messages_at(second):
    """Return a message of each topic, all of which name somebody."""
    snapshot = {
        'axis': 'x',
        'values': {'x.surface': f'{HOME}/surface.npz', 'x.speed.topic': '/joint_states'},
        'memory': {'shelve_reason': REASON, 'ending': ['ACKNOWLEDGED', PERSON, '']},
    }
    pairs = [KeyValue(key='Host', value=instance_of(f'{OTHER}.plant.local'))]
    status = DiagnosticStatus(name='node', message=f'it runs on {OTHER}', values=pairs)
    return (
        serialized(JointState(header=Header(frame_id=f'{HOST}/base'), velocity=[float(second)])),
        serialized(OutOfZone(axis='x', event_id=3, acknowledged_by=PERSON)),
        serialized(AxisHealth(baseline_reason=CHANGE)),
        serialized(DiagnosticArray(status=[status])),
        packed(second, np.zeros(0, EVENT), {}, [json.dumps(snapshot)]),
    )


def make_bag(folder, duration=300):
    """Make a recording of some duration [s]."""
    with BagWriter(folder, folder.name) as writer:
        for name, kind in TOPICS.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.RELIABLE))
        for second in range(duration):
            stamp = (1000 + second) * SECOND
            for name, data in zip(TOPICS, messages_at(second), strict=True):
                writer.write(name, data, log_time=stamp, publish_time=stamp)
    return folder


@pytest.fixture
def state_dir(tmp_path):
    """Make what a node keeps, with its last recording."""
    folder = tmp_path / 'state'
    state = RestartState(folder)
    for kind in (Kind.ACKNOWLEDGE, Kind.SHELVE):
        state.keep(None, entry_of(kind, 'x', 5, {'name': PERSON, 'reason': REASON}))
    state.close()
    make_bag(folder / 'recordings' / '20261127T120000Z')
    return folder


@pytest.fixture
def table(tmp_path):
    """Make a table whose head names who has recorded it, in letters of one byte too."""
    path = tmp_path / f'{USER}.csv'
    lines = [f'# {PERSON} on {HOST}, /home/{APPRENTICE}/logs', 'time_s,speed']
    path.write_bytes('\n'.join([*lines, *(f'{n},{n}' for n in range(50))]).encode('latin-1'))
    return path


@pytest.fixture
def failure(tmp_path):
    path = tmp_path / 'ballscrew_failure_1.txt'
    text = f'{HOME}/.venv/bin/ballscrew page --token={TOKEN}\nAuthorization: Bearer {TOKEN}\n'
    path.write_text(f'{text}File "/home/{APPRENTICE}/a.py"\nhttp://{USER}:{TOKEN}@{HOST}:80/\n')
    return path


def unpacked(content, folder):
    """Return all files of a zip by their names, and the messages of its bags by their topics."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        archive.extractall(folder)
        files = {name: archive.read(name) for name in archive.namelist()}
    bags = {name.partition('/')[0] for name in files if name.endswith('.mcap')}
    heard = {}
    for message in (one for bag in bags for one in Bag(folder / bag).messages()):
        heard.setdefault(message.topic, []).append(message.data)
    return files, heard


def leaks(files, heard):
    """Return which secrets stand in a file, in its name or in a message of a bag."""
    content = b'\n'.join([*files.values(), *(data for each in heard.values() for data in each)])
    content += '\n'.join([*files, *heard]).encode()
    codings = 'utf-8', 'latin-1'
    return {text for text in SECRETS for coding in codings if text.encode(coding) in content}


def test_no_secret_leaves_the_machine(machine, state_dir, table, failure, tmp_path):
    case = FaultCase(paths=[state_dir, table], failures=[failure], tokens=[TOKEN])
    content, lines = fault_report(case)
    files, heard = unpacked(content, tmp_path / 'there')
    assert leaks(files, heard) == set()
    hidden = next(line for line in lines if line.startswith('hidden: '))
    assert all(kind in hidden for kind in Secret)
    # What the cause is looked for in is there: numbers, events, parameters, the trace.
    assert [len(each) for each in heard.values()] == [121] * len(TOPICS)
    assert json.loads(files['parameters.json'])['x.speed.topic'] == '/joint_states'
    assert read(heard['/monitor/judge_events'][-1]).number == 299
    assert b'a.py' in files['failure_1.txt']
    assert files['log_USER.csv'].endswith(b'49,49')
    kinds = [json.loads(line)['kind'] for line in files['events.jsonl'].splitlines()]
    assert kinds == ['acknowledge', 'shelve']
    assert json.loads(files['versions.json'])['packages']['numpy']


@pytest.mark.parametrize(
    ('shown', 'seen'),
    [
        (Secret.HOST, {HOST, OTHER}),
        (Secret.USER, {USER, HOME, APPRENTICE}),
        (Secret.NAME, {PERSON, json.dumps(PERSON)[1:-1], REASON, CHANGE}),
        (Secret.TOKEN, set()),
    ],
)
def test_each_kind_is_shown_by_its_own_option(
    machine, state_dir, table, failure, tmp_path, shown, seen
):
    case = FaultCase(paths=[state_dir, table], failures=[failure], tokens=[TOKEN], shown=[shown])
    assert leaks(*unpacked(fault_report(case)[0], tmp_path / 'there')) == seen


def test_it_says_what_it_holds_and_how_large(machine, state_dir, table, tmp_path, capsys):
    out = tmp_path / 'fault.zip'
    asked = ['report-fault', str(state_dir), str(table), '--out', str(out)]
    assert cli.main(asked) == 0
    said = capsys.readouterr().out
    with zipfile.ZipFile(out) as archive:
        sizes = {info.filename: info.file_size for info in archive.infolist()}
        told = archive.read('contents.txt').decode()
    assert said == f'{out}: {out.stat().st_size} bytes to send\n{told}\n'
    del sizes['contents.txt']
    for name, size in sizes.items():
        assert f'{name}  {size} bytes\n' in told


def test_it_is_bounded(machine, tmp_path, monkeypatch):
    monkeypatch.setattr(reports, 'LARGEST_LOGS', 20_000)
    monkeypatch.setattr(reports, 'LARGEST_TEXT', 5_000)
    monkeypatch.setattr(reports, 'LARGEST', 40_000)
    monkeypatch.setattr(reports, 'HEAD', 100)
    table, failure = tmp_path / 'long.csv', tmp_path / 'failure.txt'
    table.write_text('time_s,speed\n' + '\n'.join(f'{n},{n}' for n in range(10_000)))
    failure.write_text('x' * 100_000)
    texts = {f'page_{number}.json': 'y' * 5_000 for number in range(10)}
    case = FaultCase(
        paths=[table, make_bag(tmp_path / 'bag')], failures=[failure], texts=texts, seconds=1e6
    )
    content, lines = fault_report(case)
    files, heard = unpacked(content, tmp_path / 'there')
    assert sum(map(len, files.values())) < 45_000
    assert any('left out' in line for line in lines)
    rows = files['log_long.csv'].decode().splitlines()
    assert (rows[0], rows[-1]) == ('time_s,speed', '9999,9999')
    assert 9_000 < len(files['log_long.csv']) <= 10_100
    assert all(row.partition(',')[0] == row.partition(',')[2] for row in rows[1:])


def test_a_table_that_is_no_text_needs_an_option(machine, monkeypatch, tmp_path, refused):
    table = tmp_path / 'log.parquet'
    table.write_bytes(b'PAR1\0\0')
    with refused('table_no_text', path=table):
        fault_report(FaultCase(paths=[table], failures=[]))
    content, _ = fault_report(FaultCase(paths=[table], failures=[], tables=True))
    assert unpacked(content, tmp_path / 'there')[0]['log_log.parquet'] == b'PAR1\0\0'
    with monkeypatch.context() as patch:
        patch.setattr(reports, 'LARGEST_LOGS', 5)
        with refused('table_large', path=table):
            fault_report(FaultCase(paths=[table], failures=[], tables=True))
    content, lines = fault_report(FaultCase(paths=[table], failures=[], table_refused=False))
    assert set(unpacked(content, tmp_path / 'third')[0]) == {'contents.txt', 'versions.json'}
    assert any('log.parquet' in line for line in lines)


def test_without_a_node_it_holds_versions_and_failures(machine, tmp_path, failure, monkeypatch):
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    out = tmp_path / 'fault.zip'
    assert cli.main(['report-fault', '--out', str(out)]) == 0
    names = set(zipfile.ZipFile(out).namelist())
    assert names == {'contents.txt', 'versions.json', 'failure_1.txt'}


def test_what_does_not_exist_is_refused(machine, tmp_path, capsys, says):
    path = tmp_path / 'nowhere'
    asked = ((says('fault_nowhere', path=path), []), (says('minutes'), ['--minutes', '0']))
    for sentence, more in asked:
        assert cli.main(['report-fault', str(path), *more]) == 2
        assert capsys.readouterr().err == f'ballscrew: {sentence}\n'


def test_a_name_is_hidden_where_it_is_a_word(machine):
    mask = Mask(tokens=[TOKEN])
    mask.learn(Secret.NAME, ['Al', 'x', ''])
    text = f'axial Al, al_pc of {USER}_old at {HOST.upper()}: 10.1.2.3, a@b.org, x 1.2.3'
    hidden = 'axial NAME, NAME_pc of USER_old at HOST: HOST, NAME, x 1.2.3'
    assert mask.text(text) == hidden


def test_a_table_in_letters_of_two_bytes_is_read(machine, tmp_path):
    table = tmp_path / 'wide.csv'
    table.write_text(f'# {PERSON} at {HOST}\ntime_s,speed\n0,1\n', encoding='utf-16')
    content, _ = fault_report(FaultCase(paths=[table], failures=[]))
    files, _ = unpacked(content, tmp_path / 'there')
    assert files['log_wide.csv'].decode().endswith('at HOST\ntime_s,speed\n0,1\n')


def test_only_files_of_this_user_are_taken_for_failures(machine, tmp_path, failure):
    key = tmp_path / 'id_ed25519'
    key.write_text('PRIVATE KEY')
    (tmp_path / 'ballscrew_failure_2.txt').symlink_to(key)
    (tmp_path / 'ballscrew_failure_3.txt').hardlink_to(key)
    (tmp_path / 'ballscrew_failure_4.txt').mkdir()
    os.mkfifo(tmp_path / 'ballscrew_failure_5.txt')
    assert reports.own_failures() == [failure.read_text()]


def test_a_long_run_of_letters_is_masked_in_its_length(machine):
    letters = 'a' * 1_000_000  # each letter of which may begin an address
    text = f'{letters}\nfrom {"a" * 64}@{"b" * 63}.{"c" * 63}.org'
    assert Mask().text(text) == f'{letters}\nfrom NAME'


def test_a_name_of_several_lines_is_hidden(machine):
    mask = Mask()
    mask.learn(Secret.NAME, ['seen by\nHuber'])
    assert mask.text('seen by\nHuber, "seen by\\nHuber", Huber') == 'NAME\nNAME, "NAME", NAME'


def test_what_holds_bytes_or_is_of_no_known_type_stays_out_of_a_bag(machine, tmp_path):
    bag = tmp_path / 'bag'
    with BagWriter(bag, bag.name) as writer:
        for message in (JointState(), CompressedImage(data=b'face'), MultiEchoLaserScan()):
            kind = f'sensor_msgs/msg/{type(message).__name__}'
            topic = f'/{type(message).__name__}'
            writer.add_topic(Topic(name=topic, type_name=kind, offer=Offer.RELIABLE))
            writer.write(topic, serialized(message), log_time=SECOND, publish_time=SECOND)
    content, lines = fault_report(FaultCase(paths=[bag], failures=[]))
    _, heard = unpacked(content, tmp_path / 'there')
    assert heard.keys() == {'/JointState', '/MultiEchoLaserScan'}
    assert any(line.startswith('/CompressedImage is left out') for line in lines)
    assert masks.holds_bytes('std_msgs/msg/UInt8MultiArray')
    assert not masks.holds_bytes('ballscrew_msgs/msg/JudgeEvents')


def test_a_damaged_part_leaves_all_others(machine, state_dir, table, tmp_path):
    (state_dir / 'state.sqlite3').write_bytes(b'damaged')
    empty = tmp_path / 'empty'
    empty.mkdir()
    (empty / 'metadata.yaml').write_text('?')
    content, lines = fault_report(FaultCase(paths=[state_dir, empty, table], failures=[]))
    files, heard = unpacked(content, tmp_path / 'there')
    assert leaks(files, heard) == set()
    assert {'parameters.json', 'log_USER.csv'} <= files.keys()
    assert len(heard) == len(TOPICS)
    assert any('state.sqlite3' in line for line in lines)
    assert any('metadata.yaml' in line or '/empty' in line for line in lines)


def test_a_message_that_does_not_decode_stays_out(machine, tmp_path):
    bag = tmp_path / 'bag'
    names = {**TOPICS, '/note': 'std_msgs/msg/String'}
    with BagWriter(bag, bag.name) as writer:
        for name, kind in names.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.RELIABLE))
        messages = *messages_at(1), serialized(String(data=HOST))
        for name, data in zip(names, messages, strict=True):
            writer.write(name, data, log_time=SECOND, publish_time=SECOND)
            # Its text ends before its length says so; and it names somebody.
            short = b'\0\1\0\0\xff\xff\0\0' + PERSON.encode() + HOST.encode()
            writer.write(name, short, log_time=SECOND, publish_time=SECOND)
    content, lines = fault_report(FaultCase(paths=[bag], failures=[]))
    files, heard = unpacked(content, tmp_path / 'there')
    assert leaks(files, heard) == set()
    assert [len(each) for each in heard.values()] == [1] * len(names)
    assert sum('does not decode' in line for line in lines) == len(names)


def test_an_address_of_a_host_is_learned_in_whole():
    assert masks.with_short('10.1.2.3') == {'10.1.2.3'}
    assert masks.with_short('cell7.plant.local') == {'cell7.plant.local', 'cell7'}


@pytest.mark.parametrize('room', [400, 401])
def test_the_end_of_a_table_in_letters_of_two_bytes_is_read(machine, tmp_path, monkeypatch, room):
    monkeypatch.setattr(reports, 'LARGEST_LOGS', room)
    monkeypatch.setattr(reports, 'HEAD', 100)
    table = tmp_path / 'wide.csv'
    table.write_text('time_s,speed\n' * 40 + f'# {PERSON} at {HOST}\n', encoding='utf-16')
    content, _ = fault_report(FaultCase(paths=[table], failures=[]))
    files, _ = unpacked(content, tmp_path / 'there')
    lines = files['log_wide.csv'].decode().splitlines()
    assert lines[-1].endswith('at HOST')
    assert set(lines[:-1]) == {'time_s,speed'}


def test_a_reason_of_a_word_of_the_product_hides_no_parameter(machine, tmp_path):
    folder = tmp_path / 'state'
    state = RestartState(folder)
    state.keep(None, entry_of(Kind.SHELVE, 'x', 5, {'name': 'Max', 'reason': 'load'}))
    state.keep(None, entry_of(Kind.SHELVE, 'x', 5, {'name': 'Max', 'reason': 'OK'}))
    state.close()
    texts = {'page.json': 'x.load.topic ok Max'}
    content, _ = fault_report(FaultCase(paths=[folder], texts=texts, failures=[]))
    files, _ = unpacked(content, tmp_path / 'there')
    assert files['page.json'] == b'x.load.topic ok NAME'
