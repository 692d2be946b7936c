# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Columns in SI units and in the order of time, and what is said about those that are not."""

import math
import types

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import PREFIX
from ballscrew_monitor.recordings.tables import sources, times
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import force_of, read_series
import numpy as np
import pytest
from surrogate.files import InputError

TIME = np.arange(400) / 50.0
SPEED = 100.0 * np.sin(TIME)  # [mm/s]
POSITION = 300.0 - 100.0 * np.cos(TIME)  # [mm]
EPOCH = 946_684_800 * 10**9
AXIS = {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}


def joined(series):
    blocks = [rows for (rows,) in series.blocks()]
    columns = {
        name.removeprefix('x.'): np.concatenate([block.columns[name] for block in blocks])
        for name in blocks[0].columns
    }
    stamps = np.concatenate([block.stamps for block in blocks])
    return types.SimpleNamespace(
        stamps=stamps, notes=series.notes, usual_period=series.usual_period, **columns
    )


@pytest.fixture(params=[20, 1])
def read(tmp_path, write_csv, request, monkeypatch):
    """Return a function that reads columns in some blocks, by the time t unless told otherwise."""

    def make(columns, axis=None, **time):
        rows = -(-len(columns['v' if 'v' in columns else 'p']) // request.param)
        monkeypatch.setattr(sources, 'BLOCK', rows)
        monkeypatch.setattr(times, 'BLOCK', rows)
        time = time or {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
        mapping = make_map({'time': time, 'axes': {'x': axis or AXIS}})
        log = write_csv(tmp_path / 'log.csv', columns, form='{:.15g}')
        return joined(read_series(log, mapping))

    return make


@pytest.fixture
def small_reads(monkeypatch):
    monkeypatch.setattr(sources, 'BLOCK', 100)


FRICTION = 2.0 * np.sign(SPEED) + 0.005 * SPEED + 0.004 * 100.0 * np.cos(TIME)  # [N m]
OF_TORQUE = AXIS | {'torque': {'column': 'm', 'unit': 'N m'}, 'load': {'from': 'torque'}}


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(
    'motion', [{}, {'speed': {}, 'position': {'column': 'p', 'unit': 'mm'}}], ids=['v', 'p']
)
def test_amounts_of_a_torque_get_the_sign_of_the_motion(read, says, motion, sign):
    columns, axis = {'t': TIME, 'v': SPEED, 'p': POSITION}, OF_TORQUE | motion
    signed = read(columns | {'m': FRICTION}, axis)
    amounts = read(columns | {'m': sign * np.abs(FRICTION)}, axis)
    moves = np.abs(SPEED) > 3.0
    np.testing.assert_allclose(amounts.load[moves], signed.load[moves])
    np.testing.assert_allclose(amounts.torque[moves], FRICTION[moves])
    assert says('amounts') in amounts.notes
    assert says('amounts') not in signed.notes


def test_a_torque_that_holds_a_weight_keeps_its_sign_beside_a_measured_load(read, says):
    torque = 6.0 + FRICTION
    axis = OF_TORQUE | {'load': {'column': 'f', 'unit': 'N', 'magnitude': False}}
    found = read({'t': TIME, 'v': SPEED, 'm': torque, 'f': -torque}, axis)
    np.testing.assert_allclose(found.torque, torque)
    assert says('amounts') not in found.notes


@pytest.mark.parametrize('motion', ['v', 'p'])
@pytest.mark.parametrize(
    'torque',
    [6.0 + FRICTION, np.abs(0.3 + FRICTION), np.where(SPEED > 0.0, 1.9, 1.3)],
    ids=['weight', 'amounts', 'steady'],
)
def test_the_map_decides_on_the_sign_of_a_torque_that_makes_the_load(
    read, refused, torque, motion
):
    """What is more in one direction may be a weight, or the amount of what turns round."""
    position = {'position': {'column': 'p', 'unit': 'mm'}, 'lead_mm': 10.0}
    axis = (
        OF_TORQUE
        if motion == 'v'
        else position | {key: OF_TORQUE[key] for key in ('torque', 'load')}
    )
    columns = {'t': TIME, 'v': SPEED, 'p': POSITION, 'm': torque}
    refused('unclear_amounts', read, columns, axis)
    for magnitude, signs in ((True, np.sign(SPEED)), (False, 1.0)):
        stated = axis | {'torque': axis['torque'] | {'magnitude': magnitude}}
        moves = np.abs(SPEED) > 3.0
        found = read(columns, stated).torque[moves]
        np.testing.assert_allclose(found, (signs * torque)[moves], rtol=1e-6)


def test_a_steady_torque_of_one_sign_is_refused_until_the_map_says_what_it_is(read, refused):
    columns = {'t': TIME, 'v': SPEED, 'm': np.full(400, 2.0)}
    refused('unclear_amounts', read, columns, OF_TORQUE)
    for magnitude, signs in ((True, np.sign(SPEED)), (False, 1.0)):
        torque = OF_TORQUE['torque'] | {'magnitude': magnitude}
        found = read(columns, OF_TORQUE | {'torque': torque})
        np.testing.assert_allclose(found.torque[1:], (2.0 * signs * np.ones(400))[1:])


def there_and_back(rate, noise=0.0):
    """Return times [s], speeds [mm/s] and accelerations [mm/s2] of a motion with steady parts."""
    times = np.arange(int(12 * rate)) / rate
    knots = [0.0, 0.5, 1.0, 5.0, 5.5, 6.0, 6.5, 11.0, 11.5, 12.0]
    speed = np.interp(times, knots, [0, 0, 75, 75, 0, 0, -40, -40, 0, 0])
    draws = np.random.default_rng(1).normal(0.0, noise, len(times))
    return times, speed + draws * (speed != 0.0), np.gradient(speed, times)


@pytest.mark.parametrize(('rate', 'noise'), [(20.0, 2.0), (200.0, 0.0)])
@pytest.mark.parametrize(
    ('weight', 'pull', 'inertia', 'motion'),
    [(0.0, 0.0, 0.0, 'v'), (0.0, 0.0, 0.02, 'p'), (0.5, 0.3, 0.01, 'v'), (0.5, 0.3, 0.01, 'p')],
)
def test_a_torque_against_all_motion_is_a_question(
    tmp_path, write_csv, refused, rate, noise, weight, pull, inertia, motion
):
    """Friction of 1.5 N m beside a weight and a force that pulls, in [N m], and a mass."""
    times, speed, push = there_and_back(rate, noise)
    torque = 1.5 * np.sign(speed) + weight + pull * (speed > 0.0) + inertia * push
    place = np.append(0.0, np.cumsum((speed[1:] + speed[:-1]) / 2 / rate))
    axis = OF_TORQUE | {'position': {'column': 'p', 'unit': 'mm'}}
    axis = axis if motion == 'v' else {key: axis[key] for key in axis if key != 'speed'}

    def make(torque, **more):
        stated = axis | {'torque': OF_TORQUE['torque'] | more}
        content = {'time': {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}}
        columns = {'t': times, 'v': speed, 'p': place, 'm': torque}
        log = write_csv(tmp_path / 'log.csv', columns, form='{:.12g}')
        return joined(read_series(log, make_map(content | {'axes': {'x': stated}})))

    refused('against_the_motion', make, -torque)
    for scale in (1.0, -1.0):
        np.testing.assert_allclose(make(-torque, scale=scale).torque, -scale * torque, rtol=1e-6)
    np.testing.assert_allclose(make(torque).torque, torque, rtol=1e-6)


@pytest.mark.parametrize('weight', [-4.0, 4.0])
def test_a_weight_brakes_in_one_direction_and_is_none(read, weight):
    """It asks for 4 N m whichever way the axis goes, far more than friction of 0.5 N m."""
    times, speed, _ = there_and_back(100.0)
    columns = {'t': times, 'v': speed, 'm': weight + 0.5 * np.sign(speed)}
    axis = OF_TORQUE | {'torque': OF_TORQUE['torque'] | {'magnitude': False}}
    np.testing.assert_allclose(read(columns, axis).torque, columns['m'], rtol=1e-6)


def test_quantities_are_those_of_the_screw(read):
    axis = AXIS | {
        'position': {'column': 'p', 'unit': 'mm'},
        'current': {'column': 'i', 'unit': 'mA'},
        'temperature': {'column': 'w', 'unit': 'K'},
        'torque_constant_Nm_per_A': 0.5,
        'efficiency': 0.8,
        'load': {'from': 'current'},
    }
    columns = {'t': [5, 6], 'v': [10, -20], 'p': [0, 5], 'i': [2000, 0], 'w': [313.15, 293.15]}
    made = read(columns, axis)
    assert made.stamps.tolist() == [EPOCH, EPOCH + 10**9]
    assert made.speed == pytest.approx([2 * math.pi, -4 * math.pi])
    assert made.position == pytest.approx([0, math.pi])
    assert made.torque == pytest.approx([1.0, 0.0])
    # A torque that drives forward holds a force that pushes back.
    assert made.load == pytest.approx([-2 * math.pi * 0.8 * 1.0 / 0.01, 0.0])
    assert made.temperature == pytest.approx([40.0, 20.0])


@pytest.mark.parametrize('kind', ['torque', 'current'])
def test_a_part_of_the_rated_torque_is_a_torque(read, kind):
    axis = AXIS | {kind: {'column': 'part', 'unit': '%'}, 'torque_rated_Nm': 8.0}
    made = read({'t': [0, 1], 'v': [0, 30], 'part': [-25, 100]}, axis)
    assert made.torque == pytest.approx([-2.0, 8.0])


def test_rotary_units_need_no_lead_and_scale_and_offset_come_first(read):
    speed = {'column': 'v', 'unit': 'rev/min', 'scale': 2.0, 'offset': 60.0}
    made = read({'t': [0, 1], 'v': [0, 30]}, AXIS | {'speed': speed})
    assert made.speed == pytest.approx([2 * math.pi, 4 * math.pi])


def test_an_unknown_load_is_no_zero_and_speed_may_be_the_slope_of_position(read):
    made = read({'t': [0, 1], 'v': [1, 1]}, AXIS | {'load': {'unknown': 'no sensor'}})
    assert np.isnan(made.load).all()
    assert math.copysign(1.0, force_of(np.zeros(1), lead=0.01, efficiency=0.9)[0]) == 1.0
    axis = {'lead_mm': 10.0, 'position': {'column': 'p', 'unit': 'm'}}
    made = read({'t': [0, 1, 2, 2], 'p': [0.0, 0.01, 0.02, 0.02]}, axis)
    assert made.speed[:2] == pytest.approx([2 * math.pi] * 2)
    assert np.isnan(made.speed[-1])


def test_a_rate_makes_stamps_and_a_time_of_the_universal_clock_stays(read):
    made = read({'v': [1, 2, 3]}, rate_Hz=10.0, epoch='2000-01-01T00:00:00Z')
    assert np.diff(made.stamps).tolist() == [10**8] * 2
    assert made.usual_period == pytest.approx(0.1)
    made = read({'t': [1_767_323_045_500, 1_767_323_046_500], 'v': [1, 2]}, column='t', unit='ms')
    assert made.stamps.tolist() == [1_767_323_045_500_000_000, 1_767_323_046_500_000_000]


@pytest.mark.parametrize('times', [[0, 1], [1e12, 1e12 + 1]])
def test_times_that_make_no_stamps_are_refused(times, read, refused):
    refused('give_stamps_after', read, {'t': times, 'v': [1, 2]}, column='t', unit='s')


@pytest.mark.parametrize('times', [[1e303, 1.1e303], [0, 1e303], [-1.7e308, 1.7e308]])
@pytest.mark.parametrize('epoch', [{}, {'epoch': '2000-01-01T00:00:00Z'}])
def test_huge_times_are_refused_in_one_sentence(times, epoch, read, refused):
    times = [*times, times[-1]]
    refused('give_stamps_after', read, {'t': times, 'v': [1, 2, 3]}, column='t', unit='s', **epoch)


def test_rows_out_of_order_without_a_time_or_after_a_gap_are_said(read, says, refused):
    made = read({'t': [0, 2, 1, 3], 'v': [0, 2, 1, 3]})
    assert made.speed == pytest.approx(np.arange(4) * 0.2 * math.pi)
    assert made.notes[0].endswith(says('1_rows_earlier'))
    made = read({'t': ['0', '', '2'], 'v': [1, 2, 3]})
    assert len(made.stamps) == len(made.speed) == 2
    assert made.notes[-1].endswith('1 rows without a time are left out')
    refused('holds_1_rows', read, {'t': ['0', '', ''], 'v': [1, 2, 3]})
    made = read({'t': [0, 0.1, 0.2, 3600, 3600.1], 'v': [1] * 5})
    assert says('1_gap_longer') in made.notes[0]


@pytest.mark.parametrize('spread', [2, 3])
def test_rows_out_of_order_are_sorted(read, spread):
    random = np.random.default_rng(spread)
    # Some times are there more than once: their rows stay as they came.
    times = np.arange(200) * 0.1 + random.integers(0, spread, 200) * 0.15
    times[-1] = 30.0
    made = read({'t': 1.7e9 + times, 'v': np.arange(200.0)}, column='t', unit='s')
    order = np.argsort(times.round(2), kind='stable')
    assert made.speed == pytest.approx(order * 0.2 * math.pi)
    assert (np.diff(made.stamps) >= 0).all()
    assert made.usual_period == pytest.approx(np.median(np.diff(made.stamps)) * 1e-9)


def test_a_time_of_day_goes_on_through_midnight(read):
    clocks = ['23:59:20', '23:59:40', '00:00:00', '00:00:20']
    made = read({'t': clocks, 'v': [1, 2, 3, 4]})
    np.testing.assert_array_equal(made.stamps - EPOCH, np.arange(4) * 20 * 10**9)
    assert made.speed == pytest.approx(np.arange(1, 5) * 0.2 * math.pi)


def test_few_rows_wait_for_one_that_is_a_little_late(small_reads, tmp_path, write_csv):
    times = np.arange(3000) * 0.01
    times[1:-1:7] += 0.05
    log = write_csv(tmp_path / 'log.csv', {'t': times, 'v': times}, form='{:.15g}')
    time = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
    series = read_series(log, make_map({'time': time, 'axes': {'x': AXIS}}))
    lengths = [len(block.stamps) for (block,) in series.blocks()]
    assert sum(lengths) == 3000
    assert max(lengths) <= 110  # a few that have waited
    assert len(lengths) >= 30


@pytest.fixture
def notes(tmp_path, write_csv):
    """Return a function that imports speeds stated in a unit, and returns what is said of them."""

    def make(speed, unit, position=POSITION, time=TIME):
        mapping = make_map(
            {
                'time': {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'},
                'axes': {
                    'x': {
                        'lead_mm': 10.0,
                        'speed': {'column': 'v', 'unit': unit},
                        'position': {'column': 'p', 'unit': 'mm'},
                        'load': {'unknown': 'none'},
                    }
                },
            }
        )
        columns = {'t': time, 'v': speed, 'p': position}
        log = write_csv(tmp_path / 'log.csv', columns, form='{:.9g}')
        facts = convert(log, mapping, tmp_path / 'bag')
        assert Bag(tmp_path / 'bag').metadata == facts.texts()
        assert f'{PREFIX}notes' in facts.texts()
        return [note for note in facts.notes if 'its position' in note]

    return make


@pytest.mark.parametrize(
    ('factor', 'unit'),
    [(1.0, 'mm/s'), (1e-3, 'm/s'), (0.06, 'm/min'), (60.0, 'mm/min'), (6.0, 'rev/min')],
)
def test_the_unit_that_fits_is_named_where_another_is_stated(notes, factor, unit):
    for stated in ('mm/s', 'm/s', 'm/min', 'rev/min'):
        found = notes(SPEED * factor, stated)
        assert len(found) == (stated != unit)
        assert all(f'in {stated} says: {unit} fits' in note for note in found)


@pytest.mark.parametrize('position', [1e200, -1e200, 1e300])
def test_a_position_where_no_axis_is_is_refused(notes, position, refused):
    refused('no_position', notes, SPEED, 'mm/s', np.where(TIME == TIME[7], position, POSITION))


def test_large_numbers_beside_good_ones_say_nothing(notes):
    assert not notes(SPEED, 'mm/s', np.where(TIME == TIME[7], 1e99, POSITION))
    assert not notes(np.where(TIME == TIME[7], 1e200, SPEED), 'mm/s')
    assert not notes(np.where(TIME == TIME[7], 1e80, SPEED), 'mm/s', 1e90 * POSITION)


def test_a_gap_noise_and_rest_say_nothing_a_wrong_factor_is_told(notes):
    late = np.where(np.arange(400) < 200, TIME, TIME + 30.0)
    position = np.where(np.arange(400) < 200, POSITION, POSITION + 5e3)
    position[50] = np.nan
    assert not notes(SPEED, 'mm/s', position, late)
    noise = np.random.default_rng(1).normal(size=400)
    assert not notes(1e3 * noise, 'mm/s')
    assert not notes(0.0 * SPEED, 'mm/s')
    assert not notes(SPEED, 'mm/s', 0.0 * POSITION)
    assert notes(3.0 * SPEED, 'mm/s')[0].endswith('the time and the lead')


@pytest.mark.parametrize('noise', [0.0, 3.0])
@pytest.mark.parametrize('late', [False, True])
def test_a_position_that_moves_against_its_speed_is_refused(notes, noise, late, refused):
    """A run that begins again elsewhere, and noise of a meter, hide no sign."""
    speed = -SPEED + noise * np.random.default_rng(1).normal(size=400)
    position = np.where(late & (np.arange(400) > 250), POSITION + 400.0, POSITION)
    refused('turned', notes, speed, 'mm/s', position)
    assert not notes(-speed, 'mm/s', POSITION)


def test_turns_of_a_position_are_counted(read):
    """The slope of a sine of turns is a cosine, whichever turn the scale is in."""
    turns = 4.0 * np.sin(TIME)
    axis = {'lead_mm': 10.0, 'position': {'column': 'p', 'unit': 'deg'}}
    rows = read({'t': TIME, 'p': 360.0 * turns % 360.0}, axis)
    assert rows.speed[1:-1] == pytest.approx(2 * np.pi * 4.0 * np.cos(TIME[1:-1]), abs=0.01)
    assert any('p stays within a turn' in note for note in rows.notes)


def test_turns_that_too_few_rows_tell_are_refused(read):
    axis = {'lead_mm': 10.0, 'position': {'column': 'p', 'unit': 'rev', 'scale': 0.5}}
    with pytest.raises(InputError, match='begins again after each turn'):
        read({'t': TIME, 'p': 2.0 * (0.46 * np.arange(400) % 1.0)}, axis)


def test_a_speed_without_a_sign_gives_way_to_its_position(read, says):
    axis = AXIS | {'position': {'column': 'p', 'unit': 'mm'}}
    rows = read({'t': TIME, 'v': abs(SPEED), 'p': POSITION}, axis)
    true = 2 * np.pi / 10.0 * SPEED
    assert rows.speed[1:-1] == pytest.approx(true[1:-1], abs=0.05)
    assert says('amounts_of_speed') in rows.notes


def test_a_force_and_a_speed_of_one_sign_are_refused_until_the_map_says_that_they_have_one(
    read, refused
):
    axis = AXIS | {'load': {'column': 'f', 'unit': 'N'}}
    columns = {'t': TIME, 'v': SPEED, 'f': 900.0 + abs(SPEED)}
    refused('one_sign_of_force', read, columns, axis)
    axis['load']['magnitude'] = False
    np.testing.assert_allclose(read(columns, axis).load, columns['f'])
    axis = AXIS | {'torque': {'column': 'm', 'unit': 'N m'}, 'load': {'from': 'torque'}}
    refused('one_sign_of_speed', read, {'t': TIME, 'v': abs(SPEED), 'm': FRICTION}, axis)


@pytest.mark.parametrize('step', [0.02, 0.1])
@pytest.mark.parametrize('runs', [1, 2])
def test_values_that_were_written_when_they_changed_stay_where_the_map_says_so(
    step, runs, tmp_path, write_csv, refused, monkeypatch
):
    """A profile of even motions: of the plateaus the first row is written alone."""
    profile = np.interp(np.arange(0, 24, step), [0, 2, 3, 9, 10, 14, 15, 21, 22, 24],
                        [0, 0, 60, 60, 0, 0, -40, -40, 0, 0])  # fmt: skip
    seconds = np.arange(len(profile)) * step
    written = np.append(True, np.diff(profile) != 0.0)
    columns = {
        't': np.concatenate([seconds[written]] * runs),
        'v': np.concatenate([profile[written]] * runs),
    }
    monkeypatch.setattr(sources, 'BLOCK', 7)
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.9g}')
    axis = {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}
    content = {'time': {'column': 't', 'unit': 's', 'epoch': '2000-01-01'}, 'axes': {'x': axis}}
    refused('gaps', read_series, log, make_map(content))
    axis['speed']['hold'] = False
    assert read_series(log, make_map(content)).count == runs * written.sum()
    axis['speed']['hold'] = True
    series = read_series(log, make_map(content))
    rows = [rows for (rows,) in series.blocks()]
    stamps = np.concatenate([one.stamps for one in rows])
    speed = np.concatenate([one.columns['x.speed'] for one in rows]) * 10.0 / (2 * np.pi)
    ends = np.append(np.flatnonzero(np.diff(stamps) > 1.5 * step * 1e9) + 1, len(stamps))
    assert len(ends) == runs
    assert series.count == len(stamps) == sum(series.counts)
    begin = 0
    for end in ends:
        passed = (stamps[begin:end] - stamps[begin]) / 1e9
        true = np.interp(passed, seconds, profile)
        np.testing.assert_allclose(speed[begin:end], true, atol=1e-6)
        assert passed[-1] == pytest.approx(seconds[written][-1])
        begin = end


def test_gaps_at_rest_or_between_other_speeds_are_none_of_values_that_stay(read):
    late = np.where(np.arange(400) < 200, TIME, TIME + 30.0)
    assert len(read({'t': late, 'v': np.sin(np.arange(400) * np.pi / 200)}).stamps) == 400
    assert len(read({'t': late, 'v': np.where(late > 20.0, 40.0, -40.0)}).stamps) == 400


@pytest.mark.parametrize(
    ('axis', 'column', 'told'),
    [
        ('x', 'Y velocity [mm/s]', True),
        ('x1', 'Z1_ActualVelocity', True),
        ('x', 'X velocity [mm/s]', False),
        ('left', 'Y velocity [mm/s]', False),
        ('x', 'velocity [mm/s]', False),
    ],
)
def test_a_column_that_is_named_after_another_axis_is_said(
    axis, column, told, tmp_path, write_csv, says
):
    log = write_csv(tmp_path / 'log.csv', {'t': np.arange(60) / 10, column: np.arange(60.0)})
    place = {'lead_mm': 10.0, 'speed': {'column': column, 'unit': 'mm/s'}}
    time = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
    series = read_series(log, make_map({'time': time, 'axes': {axis: place}}))
    other = column[0].lower()
    sentence = says('of_another_axis', axis=axis, column=column, other=other)
    assert (sentence in series.notes) == told
