# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Maps, points and ghosts are those of the surface itself."""

import math
from types import SimpleNamespace

from ballscrew_monitor.core.conversions import kelvin
from ballscrew_monitor.core.judgement import rcs_to_clear
from ballscrew_monitor.messages.state_messages import out_of_zone_message
from ballscrew_monitor.page import maps, records
from ballscrew_monitor.page.maps import Motion
from ballscrew_monitor.recordings.words import TURNS
from hypothesis import assume, example, given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM

WARMTH = 40.0  # [degC]
SPEEDS, LOADS = st.floats(1.0, 200.0), st.floats(-3000.0, 3000.0)


@pytest.fixture(scope='module')
def surface():
    return Surface.load(shipped_surface())


@pytest.fixture(scope='module')
def limits(page_parts):
    return maps.limits_of(page_parts.limits)


def rows_of(parts, speeds_rpm, loads, step=0.1):
    motion = zip(speeds_rpm, loads, strict=True)
    return np.array(
        [
            parts.row(1e9 + step * at, speed_rpm=speed, load_N=load, temperature_degC=WARMTH)
            for at, (speed, load) in enumerate(motion)
        ]
    )


@given(speed=SPEEDS, load=LOADS)
def test_a_point_is_what_the_surface_says(surface, limits, speed, load):
    found = surface.lookup(speed, load, kelvin(WARMTH))
    record = maps.point_of(surface, limits, speed, load, WARMTH)
    assert record['efficiency'] == pytest.approx(found.efficiency, nan_ok=True)
    assert record['rcs'] == pytest.approx(found.rcs, nan_ok=True)
    assert record['torque_N_m'] == pytest.approx(found.driving_torque, nan_ok=True)
    light = abs(load) < limits.light_load
    good = found.rcs < limits.rcs and (light or found.efficiency >= limits.efficiency)
    expected = 'unknown' if math.isnan(found.rcs) else 'optimal' if good else 'outside'
    assert record['zone'] == expected
    assert record['words']


def test_points_beyond_the_surface_say_why(surface, limits):
    for key, point in {
        'speed_above_range': (1e4, 0.0, WARMTH),
        'no_direction': (0.0, 0.0, WARMTH),
        'load_out_of_range': (10.0, 1e6, WARMTH),
        'temperature_out_of_range': (10.0, 0.0, 300.0),
    }.items():
        record, (speed, load, warmth) = maps.point_of(surface, limits, *point), point
        where = {'speed': {'speed': speed / RPM}, 'load': {'load_N': load}}
        where['temperature'] = {'temperature_degC': warmth}
        assert record['zone'] == 'unknown'
        assert record['words'] == {'key': f'reason_{key}', 'values': where}


def test_a_map_is_the_surface_amid_its_cells(surface, limits, page_parts):
    motion = Motion.of(rows_of(page_parts, [100.0, 100.0], [-500.0, 500.0]), limits)
    record, arrays = maps.map_of(surface, limits, WARMTH, motion, 'rcs')
    rows, columns = record['rows'], record['columns']
    assert all(arrays[name].shape == (rows, columns) for name in ('cells', 'zone', 'dwell'))
    low, high = record['speed']['low'], record['speed']['high']
    at = 0.7 * columns
    speed = low * (high / low) ** ((int(at) + 0.5) / columns)
    span = record['load']['high'] - record['load']['low']
    load = record['load']['low'] + span * 20.5 / rows
    found = surface.lookup(speed * RPM, load, kelvin(WARMTH))
    assert arrays['cells'][20, int(at)] == pytest.approx(found.rcs, rel=0.05)
    assert set(np.unique(arrays['zone'][np.isfinite(arrays['zone'])])) == {0.0, 1.0}


def test_lines_are_named_and_bands_come_in_pairs(surface, limits, page_parts):
    motion = Motion.of(rows_of(page_parts, [100.0], [-500.0]), limits)
    record, arrays = maps.map_of(surface, limits, WARMTH, motion, 'efficiency')
    kinds = [line['kind'] for line in record['lines']]
    assert kinds.count('rcs') == kinds.count('efficiency') == 1
    assert 'rcs_band' not in kinds
    assert [kinds.count(kind) for kind in maps.BANDS] == [2, 2]
    for line in record['lines']:
        assert arrays[line['array']].shape[1] == 2
    edges = [arrays[line['array']] for line in record['lines'] if line['kind'] == maps.BANDS[0]]
    middle = next(arrays[line['array']] for line in record['lines'] if line['kind'] == 'rcs')
    for edge, factor in zip(edges, surface.onset_band, strict=True):
        np.testing.assert_allclose(edge[:, 0], factor * middle[:, 0])


def test_time_spent_lies_where_the_rows_do(surface, limits, page_parts):
    """Of both directions, whose load opposes the motion alike; a gap does not count."""
    rows = rows_of(
        page_parts, [300.0, 300.0, -300.0, -300.0, 0.0], [-600.0, -600.0, 600.0, 600.0, 0]
    )
    rows[3:, 0] += 60.0
    motion = Motion.of(rows, limits)
    record, arrays = maps.map_of(surface, limits, WARMTH, motion, 'efficiency')
    ((row, column),) = np.argwhere(arrays['dwell'])
    assert arrays['dwell'][row, column] == pytest.approx(0.3)
    low, high = record['load']['low'], record['load']['high']
    assert low + (high - low) * row / record['rows'] < 600.0
    assert low + (high - low) * (row + 1) / record['rows'] > 600.0


@given(load=st.floats(-1500.0, 1500.0), degrees=st.floats(15.0, 75.0))
def test_at_the_limit_speed_rcs_is_at_its_limit(surface, limits, load, degrees):
    """And above it below; without one, no judged speed is at the limit, or all are."""
    slowest, fastest = surface.speed_range
    slowest = max(slowest, limits.standstill_speed)
    speed = maps.limit_speed(surface, limits, load, degrees, speed=slowest)
    if math.isnan(speed):
        found = surface.lookup(slowest, load, kelvin(degrees)).rcs
        last = surface.lookup(fastest, load, kelvin(degrees)).rcs
        assert not (found >= limits.rcs and last < limits.rcs)
    else:
        at, above = (surface.lookup(f * speed, load, kelvin(degrees)).rcs for f in (1.0, 1.1))
        assert at == pytest.approx(limits.rcs, rel=0.01)
        assert above < limits.rcs


@pytest.fixture(scope='module')
def island(surface):
    """Return a surface on which a full solve has found contact beyond the limit."""
    place = SimpleNamespace(speed=600.0 * RPM, opposing_load=1500.0, temperature=kelvin(WARMTH))
    return surface.with_correction(place, SimpleNamespace(rcs=0.3))


@pytest.fixture(scope='module')
def borders(island, limits):
    """Return the speeds [rev/min] at which contact ends, begins again and ends on the island."""
    speeds = np.geomspace(5.0, 2000.0, 3000)
    rcs = [island.lookup(each * RPM, 1500.0, kelvin(WARMTH)).rcs for each in speeds]
    return speeds[np.flatnonzero(np.diff(np.array(rcs) >= limits.rcs))].tolist()


@given(speed=st.floats(5.0, 2000.0))
def test_of_several_limits_the_next_one_counts(island, borders, limits, speed):
    """As a fine scan has it, away from where RCS rises steeply."""
    first, rise, last = borders
    assume(abs(speed / rise - 1.0) > 0.05)
    expected = last if speed > rise else first
    found = maps.limit_speed(island, limits, 1500.0, WARMTH, speed=speed * RPM) / RPM
    assert found == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize('known', ['surface', 'island'])
@example(load=1500.0, degrees=WARMTH, part=0.5, sign=1.0)
@given(
    load=st.floats(-3000.0, 3000.0),
    degrees=st.floats(15.0, 75.0),
    part=st.floats(0.1, 0.99),
    sign=st.sampled_from([1.0, -1.0]),
)
def test_the_advice_on_a_standing_warning_lies_just_beyond_the_limit(
    core, request, usual_limits, page_parts, known, load, degrees, part, sign
):
    """By the hysteresis, as far as its words are rounded: at the limit itself nothing clears."""
    surface = request.getfixturevalue(known)
    limit = maps.limit_speed(surface, usual_limits, load, degrees, speed=0.0)
    assume(part * limit > usual_limits.standstill_speed)
    changes = {'default_temperature': kelvin(degrees), 'speed_allowed': True}
    monitor = core.monitor(surface, usual_limits, **changes)
    moves = core.motion(sign * part * limit, force=-sign * load)
    (state,) = core.feed(monitor, moves)
    message = state.message
    view = page_parts.axis()
    view.know({}, surface, '')
    view.hear(records.row_of(message), {}, records.limits_record(message), 0.0)
    event = out_of_zone_message(monitor, shelved=False)
    assume(math.isfinite(event.cause.target_speed))
    assert view.limit['speed_rpm'] == pytest.approx(limit / RPM)
    assert view.limit['speed_rpm'] < float(TURNS.search(event.advice)[1])
    found = surface.lookup(abs(event.cause.target_speed), load, kelvin(degrees))
    assert found.rcs == pytest.approx(rcs_to_clear(usual_limits), rel=1e-3)


@given(factors=st.lists(st.floats(0.5, 1.5), min_size=1, max_size=3))
def test_ghosts_move_the_same_way(surface, limits, page_parts, factors):
    rows = rows_of(page_parts, [200.0, 400.0, -300.0, 100.0], [-600.0, 200.0, 900.0, 0.0])
    motion = Motion.of(rows, limits)
    record, arrays = maps.ghosts_of(surface, limits, motion, WARMTH, factors)
    assert [one['factor'] for one in record['ghosts']] == factors
    for one in record['ghosts']:
        factor = one['factor']
        assert factor * one['duration_s'] == pytest.approx(0.3)
        path = arrays[one['array']]
        np.testing.assert_allclose(path[:, 0], factor * np.abs(rows[:, 1]))
        found = [surface.lookup(speed * RPM, load, kelvin(WARMTH)) for speed, load in path]
        # What is lost over a way does not ask for the time that it took.
        way = [200.0 * RPM * 0.1, 400.0 * RPM * 0.1, 300.0 * RPM * 0.1, 0.0]
        lost = sum(point.friction_torque * angle for point, angle in zip(found, way, strict=True))
        assert one['lost_J'] == pytest.approx(lost, rel=1e-6)
        judged = [maps.point_of(surface, limits, *p, WARMTH)['zone'] for p in path * [RPM, 1.0]]
        assert one['outside_share'] == pytest.approx(judged[:3].count('outside') / 3.0)


def test_with_a_full_film_a_faster_ghost_loses_more_over_the_same_way(surface, limits, page_parts):
    motion = Motion.of(rows_of(page_parts, [900.0, 1100.0, -1200.0], [-600.0, 0.0, 900.0]), limits)
    factors = [0.8, 0.9, 1.0, 1.1, 1.2, 1.5]
    ghosts = maps.ghosts_of(surface, limits, motion, WARMTH, factors)[0]['ghosts']
    assert {(one['unknown_share'], one['words']) for one in ghosts} == {(0.0, '')}
    assert np.all(np.diff([one['lost_J'] for one in ghosts]) > 0.0)


def test_a_ghost_that_leaves_the_surface_says_how_long_and_loses_no_number_to_it(
    surface, limits, page_parts
):
    """Of 1000 steps five are left out; of a quarter of the time nothing is invented."""
    top = surface.speed_range[1] / RPM
    for fast, key in ((5, 'ghost_left_out'), (250, 'ghost_not_known')):
        rows = rows_of(page_parts, [0.9 * top] * fast + [1000.0] * (1001 - fast), [-600.0] * 1001)
        motion = Motion.of(rows, limits)
        within, beyond = maps.ghosts_of(surface, limits, motion, WARMTH, [1.0, 1.2])[0]['ghosts']
        assert (within['unknown_share'], within['words']) == (0.0, '')
        assert beyond['unknown_share'] == pytest.approx(fast / 1000.0, rel=1e-3)
        said = {'share': {'share': beyond['unknown_share']}}
        assert beyond['words'] == {'key': key, 'values': said}
        assert math.isnan(beyond['lost_J']) is (beyond['unknown_share'] > maps.MOST_UNKNOWN)


def test_ghosts_of_no_motion_know_nothing(surface, limits, page_parts):
    motion = Motion.of(rows_of(page_parts, [0.0, 0.0], [0.0, 0.0]), limits)
    ((ghost,), _) = maps.ghosts_of(surface, limits, motion, WARMTH, [1.0])[0].values(), 0
    assert math.isnan(ghost[0]['outside_share'])
    assert ghost[0]['duration_s'] == 0.0


def test_the_oil_is_the_last_that_was_measured_else_that_of_the_datasheet(surface, page_parts):
    rows = rows_of(page_parts, [1.0, 1.0], [0.0, 0.0])
    rows[1, 3] = math.nan
    assert maps.oil_temperature(rows, surface) == WARMTH
    assert maps.oil_temperature(rows[1:], surface) == pytest.approx(40.0)
    rows[0, 3] = 55.0
    assert maps.oil_temperature(rows, surface) == 55.0


def test_an_unknown_quantity_is_refused(surface, limits, page_parts, refused):
    motion = Motion.of(rows_of(page_parts, [1.0], [0.0]), limits)
    refused('quantity', maps.map_of, surface, limits, WARMTH, motion, 'wear')
