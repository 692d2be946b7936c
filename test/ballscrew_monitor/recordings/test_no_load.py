# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Torque over speed out of a bag: what counts as steady, bins, errors, and the command on it."""

import itertools
import json
import math

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.no_load import (
    _is_steady,
    read_no_load,
    speed_channel,
    temperature_channel,
    torque_channel,
    WINDOW,
)
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState, Temperature
from surrogate.parameters import find_sheet, load_lubricant, load_screw, OperatingPoint
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts

SECOND = 10**9
RATE = 50  # samples of JointState per second
LEAD = 0.01
PLATEAU, RAMP = 4.0, 1.0  # [s]
PLATEAUS = (60, 150, 400, 1000, 2000)  # [rev/min]
CHANNELS = [
    speed_channel('joint_states', 'velocity[x_axis]', 'rad/s', LEAD),
    torque_channel('joint_states', 'effort[x_axis]', 1.0),
]
OIL = load_lubricant('iso_vg_68')


def speeds(*plateaus):
    """Return a speed [rad/s] per sample: plateaus with ramps between them."""
    ends = [0.0, *plateaus]
    parts = []
    for before, after in zip(ends[:-1], ends[1:], strict=True):
        parts += [np.linspace(before, after, int(RAMP * RATE), endpoint=False)]
        parts += [np.full(int(PLATEAU * RATE), after)]
    return np.concatenate(parts)


def stamped(message, place):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(
        100 * SECOND + place * SECOND // RATE, SECOND
    )
    return message


def write(folder, speed, torque, *, warmth=None, joint='x_axis'):
    with BagWriter(folder, 'bag') as writer:
        for name, kind in (('joint_states', 'JointState'), ('oil', 'Temperature')):
            writer.add_topic(
                Topic(name=f'/{name}', type_name=f'sensor_msgs/msg/{kind}', offer=Offer.SENSOR)
            )
        for place, (turned, pulled) in enumerate(zip(speed, torque, strict=True)):
            messages = {
                '/joint_states': JointState(
                    name=[joint], velocity=[float(turned)], effort=[float(pulled)]
                )
            }
            if warmth is not None:
                messages['/oil'] = Temperature(temperature=float(warmth[place]))
            for topic, message in messages.items():
                time = 100 * SECOND + place * SECOND // RATE
                data = serialize_message(stamped(message, place))
                writer.write(topic, data, log_time=time, publish_time=time)
    return Bag(folder)


def test_plateaus_make_points_and_ramps_do_not(tmp_path, says):
    """Torque of the ramps, made absurd, reaches no point; neither does a standstill."""
    speed = speeds(0.0, 10.0, 40.0, -20.0)
    steady = np.isin(speed, (10.0, 40.0, -20.0))
    ripple = 0.01 * np.sin(np.arange(len(speed)))
    bag = write(tmp_path, speed, np.where(steady, 0.01 * speed + ripple, 1e3))
    columns, notes = read_no_load(bag, CHANNELS)
    assert columns['speed'] == pytest.approx([10.0, 40.0, -20.0])
    assert columns['torque'] == pytest.approx([0.1, 0.4, -0.2], abs=2e-3)
    assert (columns['torque_std'] < 2e-3).all()
    assert 'temperature' not in columns
    # Eight windows a plateau; the first settles, and the last of all is cut short.
    assert notes == (says('20_39_windows'),)


def test_standard_errors_are_those_of_the_windows(tmp_path):
    """Means that scatter from window to window by a known amount, equally in both bins."""
    speed = np.repeat([10.0, 40.0], int(20 * RATE))
    steps = 0.02 * (np.arange(len(speed)) // int(WINDOW * RATE) % 2)
    columns, _ = read_no_load(write(tmp_path, speed, 0.3 + steps), CHANNELS)
    counts = np.array([39, 38])  # 0.5 s windows of 20 s; the first of each plateau settles
    expected = 0.01 * math.sqrt(counts.sum() / (counts - 1).sum()) / np.sqrt(counts)
    assert columns['torque_std'] == pytest.approx(expected, rel=0.03)
    assert columns['torque'] == pytest.approx([0.31, 0.31], abs=5e-4)


def test_a_slow_drift_is_no_steady_speed(tmp_path, refused):
    """1 % within a window is the limit: 0.8 % passes, 1.2 % does not."""
    seconds = np.arange(20 * RATE) / RATE
    for drift, found in ((0.008, True), (0.012, False)):
        speed = 10.0 * np.exp(drift / WINDOW * seconds)
        bag = write(tmp_path / str(drift), speed, 0.01 * speed)
        if found:
            assert len(read_no_load(bag, CHANNELS)[0]['speed']) > 3
        else:
            refused('0_39_windows', read_no_load, bag, CHANNELS)


@pytest.mark.parametrize(('drift', 'keeps'), [(0.0, True), (1.0, True), (1.0625, False)])
def test_a_drift_of_just_1_percent_is_steady(drift, keeps):
    """The speeds are exact in binary; 1 % of 100 rad/s is rounded to just 1."""
    time = np.array([0.0, 0.25, 0.5])
    value = 100.0 + drift * np.array([-0.5, 0.0, 0.5])
    assert _is_steady(time, value) is keeps
    assert _is_steady(time, -value) is keeps


def test_units_scale_and_temperature(tmp_path):
    """A linear speed is turned by the lead, a current into torque; degC becomes kelvin."""
    speed = np.repeat([0.1, 0.2], 5 * RATE)
    warmth = np.repeat([40.0, 42.0], 5 * RATE)
    bag = write(tmp_path, speed, 2.0 + 0 * speed, warmth=warmth)
    channels = [
        speed_channel('/joint_states', 'velocity[0]', 'm/s', LEAD),
        torque_channel('/joint_states', 'effort[0]', 0.25),
        temperature_channel('oil', 'temperature'),
    ]
    columns, _ = read_no_load(bag, channels)
    assert columns['speed'] == pytest.approx([20 * math.pi, 40 * math.pi])
    assert columns['torque'] == pytest.approx([0.5, 0.5])
    assert 'torque_std' not in columns
    assert columns['temperature'] == pytest.approx([313.15, 315.15])


def test_numbers_that_are_none_are_counted(tmp_path):
    """A NaN in the torque is left out and said."""
    speed = speeds(10.0)
    torque = np.where(np.arange(len(speed)) % 50 == 7, math.nan, 0.2)
    columns, notes = read_no_load(write(tmp_path, speed, torque), CHANNELS)
    assert columns['torque'] == pytest.approx([0.2])
    assert notes[1] == '5 messages held no finite number'


def test_messages_that_do_not_decode_are_counted_and_named(copy_bag, tmp_path):
    speed = speeds(0.0, 10.0, 40.0)
    whole = write(tmp_path / 'whole', speed, 0.01 * speed)
    ends = itertools.chain([None] * 500, [20], [None] * 99, [20], itertools.repeat(None))
    bad = copy_bag(whole, tmp_path / 'bad', lambda one: one.data[: next(ends)])
    columns, notes = read_no_load(bad, CHANNELS)
    assert columns['speed'] == pytest.approx([10.0, 40.0])
    assert notes[-1] == '2 messages held no finite number'
    assert 'the message of /joint_states at ' in bad.notes[0]
    assert bad.notes[0].endswith('; 2 such messages were refused')


def test_a_bag_without_what_is_asked_for_or_without_its_fields_is_refused(
    tmp_path, refused, capsys
):
    bag = write(tmp_path, speeds(10.0), speeds(10.0), joint='y_axis')
    refused('message_joint_states_holds', read_no_load, bag, CHANNELS)
    nowhere = [speed_channel('nope', 'velocity[0]', 'rad/s', LEAD), *CHANNELS]
    refused('topic_nope_missing', read_no_load, bag, nowhere)
    odd = [CHANNELS[0], torque_channel('joint_states', 'effect[0]', 1.0)]
    refused('has_field_effect', read_no_load, bag, odd)
    empty = [*CHANNELS, temperature_channel('oil', 'temperature')]
    refused('topic_oil_holds', read_no_load, bag, empty)
    write(tmp_path / 'bag', speeds(10.0), speeds(10.0))
    words = ['identify', str(tmp_path / 'bag'), '--speed-topic', 'joint_states']
    assert cli.main(words) == 2
    assert '--speed-field is missing, a bag needs it' in capsys.readouterr().err


def test_the_command_finds_the_parasitic_torque_in_a_bag(tmp_path, capsys):
    """From messages to the datasheet: known torque, noise, both directions, a restless start."""
    speed = speeds(*(sign * rpm * math.pi / 30 for sign in (1, -1) for rpm in PLATEAUS))
    sheet = tmp_path / 'smooth.yaml'  # no onset of contact is looked for
    sheet.write_text(find_sheet('nominal', 'screws').read_text().replace('0.12\n', '0.0\n'))
    opened = Contacts.of(load_screw(str(sheet)))
    amounts, places = np.unique(np.abs(speed).round(9), return_inverse=True)
    contacts = closed_form.solve(opened, OIL, amounts, 0.0, 313.15).friction_torque[places]
    drag = np.sign(speed) * (contacts + 0.12) + 4e-4 * speed + 0.03
    noise = 0.01 * np.random.default_rng(6).standard_normal(len(speed))
    inertia = 2e-3 * np.gradient(speed) * RATE
    write(tmp_path / 'bag', speed, drag + noise + inertia, warmth=40.0 + 0 * speed)
    words = ['identify', str(tmp_path / 'bag'), '--out', str(tmp_path / 'found.yaml'), '--json']
    topics = ['--speed-topic', 'joint_states', '--speed-field', 'velocity[x_axis]']
    topics += [
        '--screw',
        str(sheet),
        '--torque-field',
        'effort[x_axis]',
        '--temperature-topic',
        'oil',
    ]
    assert cli.main(words + topics) == 0
    record = json.loads(capsys.readouterr().out)
    values = {one['name']: one for one in record['parameters']}
    truth = {'parasitic_torque': 0.12, 'parasitic_torque_rate': 4e-4, 'torque_offset': 0.03}
    for name, true in truth.items():
        assert values[name]['low'] <= true <= values[name]['high']
        assert values[name]['high'] - values[name]['low'] < 0.2 * true
    assert 'windows of 0.5 s are steady' in record['notes'][0]
    point = OperatingPoint(speed=600 * math.pi / 30, load=0.0, temperature=313.15)
    words = ['point', '--tier', 'closed_form', '--speed-rpm', '600', '--load-N', '0', '--json']
    assert cli.main([*words, '--screw', str(tmp_path / 'found.yaml')]) == 0
    found = json.loads(capsys.readouterr().out)['friction_torque_Nm']
    bare = float(closed_form.solve(opened, OIL, point.speed, 0.0, 313.15).friction_torque)
    assert found == pytest.approx(bare + 0.12 + 4e-4 * point.speed, rel=0.01)
