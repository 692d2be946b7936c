# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of tables to judged bags: a small log always, the real one where it is."""

import contextlib
import io
import json
import math
import os
from pathlib import Path
import sys
import tempfile

from ballscrew_monitor import cli
from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import celsius, kelvin, SECOND
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import (
    facts_of,
    parameters_of,
    parameters_text,
    values_for,
)
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.tables import cells, sources
from ballscrew_monitor.recordings.tables.convert import convert, print_guess
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import gathering_of
from ballscrew_msgs.msg import InputHealth
from geometry_msgs.msg import WrenchStamped
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader, NonSeekingReader, SeekingReader
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import polars as pl
import pytest
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from rosbags.typesys import get_typestore, Stores
from sensor_msgs.msg import JointState, Temperature
import yaml

ROOT = Path(__file__).resolve().parents[4]
BEGIN = 946_684_800 * SECOND  # [ns] of 2000
NOMINAL = ROOT / 'config' / 'nominal_cycle.yaml'
TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    **{f'/{axis}/axial_load': 'geometry_msgs/msg/WrenchStamped' for axis in 'xyz'},
}


def content_of(log, rate=10.0):
    """Return the first map of a log, with what it asks for: the rate [Hz] and units."""
    content = guess(log).content
    for axis in content['axes'].values():
        for kind, unit in (('speed', 'mm/s'), ('position', 'mm')):
            if 'unit' in axis.get(kind, {}):
                axis[kind]['unit'] = axis[kind]['unit'] or unit
        if 'unit' in axis.get('current', {}):
            axis['current'] |= {'unit': 'A', 'magnitude': False}
            axis['torque_constant_Nm_per_A'] = 0.1
    if 'rate_Hz' in content['time']:
        content['time']['rate_Hz'] = rate
    return content


def converted(log, out):
    convert(log, make_map(content_of(log)), out)
    return Bag(out)


def states_of(bag):
    values = parameters_of(bag)
    found = {axis: [] for axis in values['axes']}
    for axis in values['axes']:
        values[f'{axis}.publish_period'] = 0.0
    for state, _ in replay(bag, values):
        health = {one.name: (one.state, one.refusal) for one in state.inputs}
        result = state.result
        known = result.validity == result.VALIDITY_VALID
        found[state.axis].append((known, result.reason, health['load']))
    return found


def check_every_sample(bag, rows):
    """Hold that each row is judged, or refused with a reason, on each axis; z has no load."""
    found = states_of(bag)
    for axis, states in found.items():
        assert len(states) == rows, axis
        assert all(known or reason for known, reason, _ in states)
    assert any(known for known, _, _ in found['x'])
    assert all(load == (InputHealth.STATE_OK, '') for _, _, load in found['x'])
    assert {reason for _, reason, _ in found['z']} == {'no valid sample of load'}
    assert all('must be a finite number' in refusal for _, _, (_, refusal) in found['z'])


@pytest.fixture(scope='module')
def mill_bag(tmp_path_factory, write_csv, mill):
    folder = tmp_path_factory.mktemp('mill')
    return converted(write_csv(folder / 'mill.csv', mill()), folder / 'bag')


def test_every_sample_is_judged_with_parameters_given_else_own_else_nominal(mill_bag, short_bag):
    assert mill_bag.types == TYPES
    check_every_sample(mill_bag, 300)
    given = values_for(mill_bag, NOMINAL, NOMINAL)
    assert (given.values['axes'], given.is_given, given.is_nominal) == (['x'], True, False)
    own = values_for(mill_bag, None, NOMINAL)
    assert (own.values['axes'], own.is_given, own.is_nominal) == (['x', 'y', 'z'], False, False)
    assert own.origin == f'those of {mill_bag.path}'
    nominal = values_for(Bag(short_bag), None, NOMINAL)
    assert (nominal.values, nominal.is_nominal) == (parameters.read_file(NOMINAL), True)
    assert nominal.origin.endswith('the nominal ones')
    said = values_for(mill_bag, None, NOMINAL).stated
    assert {'axes', 'y.load.topic', 'x.temperature.default'} <= said
    assert 'x.limits.rcs' not in said
    assert not values_for(Bag(short_bag), None, NOMINAL).stated


def test_the_bag_says_what_it_was_made_of_and_so_does_the_file_alone(mill_bag):
    facts = facts_of(mill_bag)
    assert facts.source == 'mill.csv'
    assert facts.mapping['axes']['x']['speed'] == {'column': 'X1_ActualVelocity'}
    assumed = {one.key: one.value for one in facts.assumptions}
    assert facts.mapping['time'] == {'rate_Hz': 10.0}
    assert assumed['x.load.from'] == 'current'
    assert assumed['z.load'] == 'unknown'
    assert facts.parameters['axes'] == ['x', 'y', 'z']
    assert facts.parameters['y.load.topic'] == 'y/axial_load'
    said = facts.sentences()
    assert 'assumed of mill.csv, axis z: load = unknown' in said
    together = next(one for one in said if one.startswith('assumed of mill.csv, all axes: '))
    assert 'lead_mm = 10.0' in together
    assert 'time.epoch = 2000-01-01T00:00:00Z' in together
    assert 'rate_Hz' not in together
    assert Bag(mill_bag.files[0]).metadata == mill_bag.metadata


def test_the_text_of_parameters_holds_what_is_said_and_what_is_not_usual():
    values = parameters.defaults(['x']) | {'x.screw': 'y', 'x.max_lag': 3.0}
    text = parameters_text(values, ['x.temperature.default'])
    assert parameters.read_text(text, 'text') == values
    names = parameters.names_in_text(text, 'text')
    assert names == {'axes', 'x.screw', 'x.max_lag', 'x.temperature.default'}


def test_other_programs_read_it(mill_bag):
    with AnyReader([mill_bag.path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        connection, stamp, data = next(reader.messages())
        assert reader.deserialize(data, connection.msgtype).header.stamp.sec == 946_684_800
        assert stamp == 946_684_800 * 10**9
        assert reader.message_count == 1200
    with mill_bag.files[0].open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = reader.iter_decoded_messages(topics=['/x/axial_load'])
        wrenches = [one.decoded_message.wrench.force.x for one in found]
    assert len(wrenches) == 300
    assert np.isfinite(wrenches).all()


def test_a_log_slower_than_the_timeouts_lengthens_them(tmp_path, write_csv, says):
    speed = [100.0] * 20
    log = write_csv(
        tmp_path / 'log.csv', {'t_s': np.arange(20.0) * 2, 'x_vel_mm_s': speed, 'x_force_N': speed}
    )
    bag = converted(log, tmp_path / 'bag')
    facts = facts_of(bag)
    assert facts.parameters['x.speed.timeout'] == 5.0
    assert says('rows_2_s') in facts.notes
    assert all(known for known, _, _ in states_of(bag)['x'])


def test_a_torque_and_a_temperature_have_their_topics(tmp_path, write_csv):
    columns = {
        't_s': np.arange(20.0) / 10,
        'x_vel_mm_s': [100.0] * 20,
        'x_force_N': [100.0] * 20,
        'x_torque_Nm': [0.5] * 20,
        'oil_temp_degC': [35.0] * 20,
    }
    log = write_csv(tmp_path / 'log.csv', columns)
    bag = converted(log, tmp_path / 'bag')
    last = [state for state, _ in replay(bag, parameters_of(bag))][-1]
    assert last.point.temperature == pytest.approx(35.0)
    assert last.point.motor_torque == 0.5


def test_a_load_may_be_left_to_the_node(tmp_path, write_csv):
    speeds, currents = [100.0] * 40, [20.0] * 40
    columns = {'t_s': np.arange(40.0) / 100, 'x_vel_mm_s': speeds, 'x_current_A': currents}
    log = write_csv(tmp_path / 'log.csv', columns)
    content = content_of(log)
    content['assumed']['x.load.from']['value'] = 'motor_torque'
    content['axes']['x'] |= {'torque_uncertainty_Nm': 0.05, 'inertia_kg_m2': 1e-4}
    content['axes']['x'] |= {'always_free': True, 'free_load_N': -200.0}
    convert(log, make_map(content), tmp_path / 'bag')
    bag = Bag(tmp_path / 'bag')
    gathering = gathering_of('x', parameters_of(bag))
    assert (gathering.always_free, gathering.free_load) == (True, -200.0)
    assert list(bag.topics) == ['/joint_states']
    last = [state for state, _ in replay(bag, parameters_of(bag))][-1]
    assert last.point.motor_torque == pytest.approx(2.0)
    assert -1400.0 < last.point.axial_load < -900.0
    assert last.inputs[1].state == InputHealth.STATE_DERIVED


def test_another_lead_than_that_of_the_surface_is_said(tmp_path, write_csv, mill):
    log = write_csv(tmp_path / 'mill.csv', mill())
    content = content_of(log)
    content['assumed']['x.lead_mm']['value'] = 5.0
    content['assumed']['y.screw']['value'] = 'mine'
    notes = convert(log, make_map(content), tmp_path / 'bag').notes
    assert any('axis x: the lead is 5 mm, that of the surface 10 mm' in note for note in notes)
    assert any('axis y: ' in note and 'before there is a surface' in note for note in notes)


def test_nothing_is_written_when_the_log_is_bad(tmp_path, write_csv, mill, refused):
    log = write_csv(tmp_path / 'mill.csv', mill())
    content = content_of(log)
    content['parameters'] = {'x': {'nonsense': 1.0}}
    refused('nonsense_unknown', convert, log, make_map(content), tmp_path / 'bag')
    assert not (tmp_path / 'bag').exists()
    refused('file_directory', convert, log, make_map(content_of(log)), log)


class Shown:
    """Keeps what is shown, and may be interrupted at a share of what is written."""

    def __init__(self, until=2.0):
        self.until, self.shares = until, {}

    @contextlib.contextmanager
    def __call__(self, total, unit):
        shares = self.shares[unit, round(total)] = []

        def show(share):
            shares.append(share)
            if unit == 'rows written' and share >= self.until:
                raise KeyboardInterrupt

        yield show


@pytest.fixture
def small_blocks(monkeypatch):
    """Let tables be read in blocks of 32 rows; return how many were numbers at a time."""
    monkeypatch.setattr(sources, 'BLOCK', 32)
    monkeypatch.setattr(sources, 'LINES', 32)
    lengths, numbers = [], cells.Reading.numbers

    def counted(reading, block):
        lengths.append(len(block))
        return numbers(reading, block)

    monkeypatch.setattr(cells.Reading, 'numbers', counted)
    return lengths


@pytest.mark.parametrize('ending', ['csv', 'parquet'])
def test_a_table_is_made_a_bag_block_by_block(small_blocks, tmp_path, write_csv, mill, ending):
    log, out = tmp_path / f'mill.{ending}', tmp_path / 'bag'
    columns = mill(1000)
    if ending == 'csv':
        write_csv(log, columns)
    else:
        pl.DataFrame(columns).write_parquet(log)
    mapping, shown = make_map(content_of(log)), Shown()
    small_blocks.clear()
    convert(log, mapping, out, shown=shown)
    assert max(small_blocks) == 32
    looked, timed, written = shown.shares
    assert (timed, written) == (('times looked through', 1000), ('rows written', 1000))
    assert looked[0] == 'rows looked through'
    for shares in shown.shares.values():
        assert len(shares) >= 1000 // 32
        assert shares == sorted(shares)
        assert shares[-1] == pytest.approx(1.0, rel=0.1)  # of a CSV the rows are estimated
    assert Bag(out).topics['/joint_states'].count == 1000


def test_the_blocks_leave_no_trace_in_the_bag(monkeypatch, tmp_path, write_csv, mill):
    log, found = write_csv(tmp_path / 'mill.csv', mill(1000)), []
    mapping = make_map(content_of(log))
    for block in (7, 1000):
        monkeypatch.setattr(sources, 'BLOCK', block)
        convert(log, mapping, tmp_path / str(block))
        found.append([(one.topic, one.data) for one in Bag(tmp_path / str(block)).messages()])
    assert found[0] == found[1]


def test_an_interrupt_leaves_no_half_bag(small_blocks, tmp_path, write_csv, mill):
    log = write_csv(tmp_path / 'mill.csv', mill())
    shown = Shown(until=0.5)
    with pytest.raises(KeyboardInterrupt):
        convert(log, make_map(content_of(log)), tmp_path / 'bag', shown=shown)
    assert shown.shares['rows written', 300][-1] < 1.0
    assert [path.name for path in tmp_path.iterdir()] == ['mill.csv']


@pytest.mark.skipif(
    'BALLSCREW_RECORDINGS' not in os.environ, reason='BALLSCREW_RECORDINGS names no recordings'
)
def test_every_sample_of_the_real_log_is_judged_or_refused_with_a_reason(tmp_path):
    log = Path(os.environ['BALLSCREW_RECORDINGS']) / 'cnc_mill' / 'experiment_01.csv'
    assert guess(log).content['time'] == {'rate_Hz': None}
    bag = converted(log, tmp_path / 'bag')
    assert bag.types == TYPES
    check_every_sample(bag, 1055)


TWO_AXES = ('/x/oil_temperature', '/x/axial_load', '/y/axial_load', '/joint_states')
FINITE = st.floats(-1e15, 1e15)
ROW = st.tuples(st.integers(1, 100_000), *[FINITE] * 4)


@given(first=st.tuples(st.just(0), *[FINITE] * 4), others=st.lists(ROW, min_size=1))
@settings(max_examples=settings.default.max_examples // 3)
def test_a_bag_holds_each_row_to_the_last_bit_for_every_reader(first, others):
    """Rows of steps [ms], gaps among them."""
    steps, *columns = zip(first, *others)
    table = {'t': np.cumsum(steps), **dict(zip('vFTM', columns))}
    units = {'speed': 'rad/s', 'load': 'N', 'temperature': 'degC', 'torque': 'N m'}
    both = [{'lead_mm': 10.0}, {'lead_mm': 10.0, 'speed': {'column': 'M', 'unit': 'rad/s'}}]
    for (kind, unit), name in zip(units.items(), 'vFTM'):
        both[0][kind] = {'column': name, 'unit': unit}
    for place in (both[0]['speed'], both[0]['load'], both[0]['torque'], both[1]['speed']):
        place['magnitude'] = False
        place['hold'] = False
    time = {'column': 't', 'unit': 'ms', 'epoch': '2000-01-01T00:00:00Z'}
    content = {'time': time, 'axes': dict(zip('xy', both))}
    stamps = BEGIN + table['t'] * 1_000_000
    numbers = [[math.nan if one is None else one + 0.0 for one in column] for column in columns]
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / 'log.csv'
        pl.DataFrame(table).write_csv(log)
        convert(log, make_map(content), log.parent)
        (file,) = Bag(log.parent).files
        data = file.read_bytes()
    expected = [
        (stamp, serialized(message))
        for stamp, *row in zip(stamps.tolist(), *numbers)
        for message in messages_of(stamp, *row)
    ]
    for reader in (SeekingReader, NonSeekingReader):
        found = [*reader(io.BytesIO(data), validate_crcs=True).iter_messages()]
        assert [(one.log_time, one.data) for *_, one in found] == expected
        assert [(one.publish_time, one.sequence) for *_, one in found] == [
            (stamp, row) for row, stamp in enumerate(stamps) for _ in TWO_AXES
        ]
        assert [channel.topic for _, channel, _ in found] == [*TWO_AXES] * len(stamps)
    for (schema, *_), (_, content) in zip(found, expected):
        message = deserialize_message(content, message_class(schema.name))
        assert serialized(message) == content


@given(rows=st.lists(st.tuples(*[st.none() | FINITE] * 3), min_size=3, max_size=20))
@settings(max_examples=settings.default.max_examples // 3)
def test_an_empty_cell_is_no_sample(rows):
    """A bag holds the cells that are filled, at their times and in their order, and no others."""
    filled = {'v': [float(at) for at in range(len(rows))], **dict(zip('FTM', zip(*rows)))}
    assume(all(any(one is not None for one in filled[name]) for name in 'FTM'))
    table = {'t': list(range(len(rows))), **{name: list(each) for name, each in filled.items()}}
    axis = {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'rad/s', 'magnitude': False}}
    axis['load'] = {'column': 'F', 'unit': 'N', 'magnitude': False}
    axis['temperature'] = {'column': 'T', 'unit': 'degC'}
    axis['torque'] = {'column': 'M', 'unit': 'N m', 'magnitude': False}
    time = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / 'log.csv'
        pl.DataFrame(table, schema=dict.fromkeys(table, pl.Float64)).write_csv(log)
        convert(log, make_map({'time': time, 'axes': {'x': axis}}), log.parent)
        (file,) = Bag(log.parent).files
        data = file.read_bytes()
    found = {name: [] for name in 'vFTM'}
    for schema, _, record in NonSeekingReader(io.BytesIO(data)).iter_messages():
        message = deserialize_message(record.data, message_class(schema.name))
        second = (record.log_time - BEGIN) // SECOND
        if schema.name.endswith('WrenchStamped'):
            found['F'].append((second, message.wrench.force.x))
        elif schema.name.endswith('Temperature'):
            found['T'].append((second, message.temperature))
        else:
            for name, values in (('v', message.velocity), ('M', message.effort)):
                found[name] += [(second, one) for one in values if math.isfinite(one)]
    for name, each in filled.items():
        wanted = [(at, one) for at, one in enumerate(each) if one is not None]
        assert [at for at, _ in found[name]] == [at for at, _ in wanted], name
        assert [one for _, one in found[name]] == pytest.approx([one for _, one in wanted])


def messages_of(stamp, speed, force, warmth, torque):
    """Return the messages of a row, made one by one: y has the torque for its speed, no load."""
    messages = [Temperature(temperature=celsius(kelvin(warmth)))]
    for axis, one in (('x', force), ('y', math.nan)):
        messages.append(WrenchStamped())
        messages[-1].header.frame_id, messages[-1].wrench.force.x = f'{axis}_nut', one
    joints = JointState(name=['x_axis', 'y_axis'], velocity=[speed, torque])
    joints.effort = [torque, math.nan]
    for message in (*messages, joints):
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return *messages, joints


def to_12_digits(text):
    """Return a number but for what the order of a sum leaves open."""
    return float(f'{float(text):.12g}')


def test_a_guess_is_a_map_that_works_once_the_rate_is_stated(mill_log, tmp_path, capsys, says):
    assert cli.main(['import', str(mill_log), '--guess']) == 0
    captured = capsys.readouterr()
    assert set(yaml.safe_load(captured.out)) == {'log', 'time', 'axes', 'assumed'}
    assert says('z_load_known') in captured.err
    assert says('state_rate') in captured.err
    mapping, bag = tmp_path / 'map.yaml', tmp_path / 'bag'
    mapping.write_text(captured.out)
    for command in (
        ['import', str(mill_log), '--config', str(mapping), '--out', str(bag)],
        ['replay', str(mill_log), '--map', str(mapping)],
        ['replay', str(mill_log), '--map', str(mapping), '--out', str(tmp_path / 'report')],
        ['health', str(mill_log), '--map', str(mapping)],
    ):
        assert cli.main(command) == 2, command
        assert says('blank_rate') in capsys.readouterr().err
    stated = captured.out.replace('rate_Hz: null', 'rate_Hz: 10').replace('unit: null', 'unit: A')
    stated = stated.replace('magnitude: null', 'magnitude: false')
    stated = stated.replace('Nm_per_A: null', 'Nm_per_A: 0.1')
    mapping.write_text(stated)
    assert cli.main(['import', str(mill_log), '--config', str(mapping), '--out', str(bag)]) == 0
    assert '  assumed x.lead_mm = 10.0: ' in capsys.readouterr().out
    assert cli.main(['replay', str(bag), '--json']) == 1, 'axis z has no load'
    captured = capsys.readouterr()
    by_bag = json.loads(captured.out, parse_float=to_12_digits)
    assert set(by_bag) == {'x', 'y', 'z'}
    assert f'parameters: those of {bag}' in captured.err
    assert 'assumed of mill.csv, axis z: load = unknown' in captured.err
    assert says('nothing_was_judged') in captured.err
    assert cli.main(['replay', str(mill_log), '--map', str(mapping), '--json']) == 1
    captured = capsys.readouterr()
    assert json.loads(captured.out, parse_float=to_12_digits) == by_bag
    assert f'parameters: those of {mill_log}' in captured.err


def test_what_is_missing_or_superfluous_is_named(mill_log, tmp_path, capsys, short_bag, refused):
    assert cli.main(['import', str(mill_log)]) == 2
    assert '--config is missing; --guess prints' in capsys.readouterr().err
    assert cli.main(['import', str(mill_log), '--config', str(tmp_path / 'map.yaml')]) == 2
    assert '--out is missing' in capsys.readouterr().err
    assert cli.main(['replay', str(mill_log)]) == 2
    assert 'a table needs a map: ballscrew import' in capsys.readouterr().err
    for log in (short_bag, short_bag / 'short.mcap'):
        refused('bag_needs_import', print_guess, log)
    refused('cannot_read', print_guess, Path(tmp_path / 'nothing.csv'))


def test_a_workbook_without_its_reader_is_a_sentence(tmp_path, capsys, monkeypatch, says):
    log = tmp_path / 'book.xlsx'
    log.write_bytes(b'PK\3\4')
    monkeypatch.setitem(sys.modules, 'fastexcel', None)
    assert cli.main(['import', str(log), '--guess']) == 2
    assert capsys.readouterr().err == says('no_fastexcel')


def test_what_cannot_be_read_is_judged_without_and_the_map_is_told(tmp_path, write_csv, says):
    columns = {'t': np.arange(20.0) / 10, 'v': [50.0] * 20, 'F': ['n/a'] * 20, 'i': ['-'] * 20}
    log = write_csv(tmp_path / 'log.csv', columns)
    axis = {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}
    time = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
    current = {'current': {'column': 'i', 'unit': 'A'}, 'torque_constant_Nm_per_A': 0.1}
    axes = {
        'x': axis | {'load': {'column': 'F', 'unit': 'N'}},
        'y': axis | current | {'load': {'from': 'current'}},
        'z': axis | {'load': {'unknown': 'no sensor'}},
    }
    facts = convert(log, make_map({'time': time, 'axes': axes}), tmp_path / 'bag')
    notes = [note.removeprefix(f'log {log}: ') for note in facts.notes]
    assert [says('without_load'), says('without_current'), says('no_load')] == notes[:3]
    reasons = {one.key: one.reason for one in facts.assumptions}
    assert reasons['x.load'] == reasons['y.load'] == 'its column holds no number'
    assert all(
        not known for states in states_of(Bag(tmp_path / 'bag')).values() for known, _, _ in states
    )


def test_an_axis_whose_motion_cannot_be_read_is_refused(tmp_path, write_csv, refused):
    log = write_csv(tmp_path / 'log.csv', {'t': [0.0, 0.1], 'v': ['a', 'b'], 'p': [1.0, 2.0]})
    axis = {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}
    content = {'time': {'rate_Hz': 10.0, 'epoch': '2000-01-01'}, 'axes': {'x': axis}}
    refused('no_motion', convert, log, make_map(content), tmp_path / 'bag')
    axis['position'] = {'column': 'p', 'unit': 'mm'}
    facts = convert(log, make_map(content), tmp_path / 'bag')
    assert 'x.speed' in {one.key for one in facts.assumptions}


def test_it_is_shown_how_far_rows_are_put_in_order(small_blocks, tmp_path, write_csv, mill):
    columns = mill(320)
    columns['t'] = np.arange(320.0) / 10
    columns['t'][::40] += 0.5  # a row of each forty stands five rows too early
    log, shown = write_csv(tmp_path / 'mill.csv', columns), Shown()
    content = content_of(log)
    content['time'] = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
    content['assumed'] = {
        key: one for key, one in content['assumed'].items() if not key.startswith('time')
    }
    convert(log, make_map(content), tmp_path / 'bag', shown=shown)
    assert max(small_blocks) == 32
    shares = shown.shares['rows put in order', 320]
    assert shares == pytest.approx([number / 10 for number in range(1, 11)])
