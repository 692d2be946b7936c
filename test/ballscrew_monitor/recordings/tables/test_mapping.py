# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Maps that are not right: one sentence that says what is, and what is allowed."""

import copy
import itertools
import math
from pathlib import Path
import textwrap

from ballscrew_monitor.recordings.tables import mapping
from ballscrew_monitor.recordings.tables.mapping import make_map, read_map
import pytest
from surrogate.files import InputError
import yaml

GOOD = {
    'time': {'rate_Hz': 10.0, 'epoch': '2000-01-01T00:00:00Z'},
    'axes': {
        'x': {
            'speed': {'column': 'v', 'unit': 'mm/s', 'scale': -1.0},
            'current': {'column': 'i', 'unit': 'A'},
            'load': {'from': 'current'},
            'torque_constant_Nm_per_A': 0.2,
        }
    },
    'assumed': {'x.lead_mm': {'value': 5, 'reason': 'the log does not say it'}},
    'parameters': {'x': {'limits': {'rcs': 0.02}}},
}


def changed(**changes):
    content = copy.deepcopy(GOOD)
    for name, value in changes.items():
        *path, leaf = name.split('__')
        place = content
        for part in path:
            place = place[part]
        if value is None:
            del place[leaf]
        else:
            place[leaf] = value
    return content


def test_a_map_says_what_is_stated_and_what_is_assumed():
    made = make_map(GOOD)
    (axis,) = made.axes
    assert axis.lead == 0.005
    assert math.isnan(axis.temperature)
    assert axis.columns['speed'].scale == -1.0
    assert made.columns == ['v', 'i']
    assert made.epoch == 946_684_800 * 10**9
    assert made.assumptions[0].key == 'x.lead_mm'
    assert made.parameters == {'x.limits.rcs': 0.02}


@pytest.mark.parametrize(
    ('content', 'expected'),
    [
        (None, 'map_none'),
        ({'axis': {}}, 'map_holds_log'),
        (changed(axes={}), 'axes_missing'),
        (changed(axes={'X 1': {}}), '1'),
        (changed(axes__x=1), '1_hold_keys'),
        (changed(axes__x__speed=None), 'has_speed'),
        (changed(axes__x__speed__unit=None), 'speed_unit_missing'),
        (changed(axes__x__speed__unit='N'), 'speed_unit_n'),
        (changed(axes__x__speed__scale=0), 'scale_0'),
        (changed(axes__x__speed__scale='2'), 'they_numbers'),
        (changed(axes__x__speed__column=3), 'speed_column_3'),
        (changed(axes__x__speed__colum='v'), 'speed_colum_unknown'),
        (changed(axes__x__efficiency=3.0), 'number_from_0'),
        (changed(axes__x__load__from='speed'), 'load_from_speed'),
        (changed(axes__x__load__from='motor_torque'), 'torque_uncertainty_nm_mi'),
        (changed(axes__x__load__from='torque'), 'column_named'),
        (changed(axes__x__torque_constant_Nm_per_A=None), 'load_from_current'),
        (changed(axes__x__current__unit='%'), 'load_from_rated'),
        (changed(axes__x__torque={'column': 'M', 'unit': '%'}), 'torque_rated'),
        (changed(axes__x__always_free=1), 'always_free_1'),
        (changed(axes__x__always_free=True), 'free_load_replaces'),
        (changed(axes__x__free_load_N=-200.0), 'free_load_replaces'),
        (changed(axes__x__free_load_N=True), 'free_load_true'),
        (changed(machine=3), 'machine_3'),
        (changed(machine=' '), 'machine_blank'),
        (changed(skip=-1), 'skip_1'),
        (changed(header_rows=True), 'header_rows_true'),
        (changed(axes__x__lead_mm=5.0), 'lead_mm_both_stated'),
        (changed(assumed={}), 'lead_mm_missing'),
        (changed(assumed={'x.lead_mm': {'value': 5.0}}), 'have_value_reason'),
        (changed(assumed={'x.lead_mm': 5.0}), 'assumed_lead_mm_5'),
        (changed(time={}), 'name_column_rate_hz'),
        (changed(time__rate_Hz=0), 'time_rate_hz_0'),
        (changed(time__rate_Hz=2e5), 'time_rate_hz_200000'),
        (changed(time={'rate_Hz': None}), 'time_rate_hz_blank'),
        (changed(time__column='t', time__unit='s'), 'time_states_both'),
        (changed(time={'column': 't', 'unit': None}), 'time_unit_missing'),
        (changed(time__epoch='then'), 'date'),
        (changed(time__epoch='1970-01-01'), 'stamp_0_means'),
    ],
)
def test_what_is_wrong_with_a_map_is_one_sentence(content, expected, says):
    with pytest.raises(InputError) as caught:
        make_map(content)
    assert says(expected) in str(caught.value)
    assert '\n' not in str(caught.value)


def test_a_map_is_a_file(tmp_path, refused):
    path = tmp_path / 'map.yaml'
    path.write_text(yaml.safe_dump(GOOD))
    assert read_map(path).content == GOOD
    path.write_text('][')
    refused('map_cannot_read', read_map, path)
    path.write_text('axes: {}')
    refused('map_map_axes', read_map, path)
    for name, content in {'a.csv': b't;v\n0;1', 'a.parquet': b'PAR1\xff', 'a.xlsx': b'PK'}.items():
        table = tmp_path / name
        table.write_bytes(content)
        refused('a_table', read_map, table)
    path.rename(tmp_path / 'map.txt').write_text(yaml.safe_dump(GOOD))
    assert read_map(tmp_path / 'map.txt').content == GOOD


def test_every_key_has_a_place_with_its_meaning():
    leaves = {place.rpartition('.')[2] for place in mapping.PLACES}
    assert leaves >= {*mapping.NUMBERS, *mapping.LINES, *mapping.TEXTS, *mapping.INPUTS}


def test_the_map_of_the_guide_is_one():
    page = Path(__file__).resolve().parents[4] / 'docs' / 'guide' / 'recordings.md'
    lines = page.read_text(encoding='utf-8').splitlines()
    first = lines.index('    log: log.csv')
    block = itertools.takewhile(lambda line: line.startswith('    '), lines[first:])
    made = make_map(yaml.safe_load(textwrap.dedent('\n'.join(block))))
    assert [axis.name for axis in made.axes] == ['x', 'z']
    assert made.axes[0].load_from == 'current'


@pytest.mark.parametrize(
    ('valid', 'key'),
    [
        ({'column': 'q', 'cells': None}, 'blank_cells'),
        ({'column': 'q', 'cells': []}, 'no_cells'),
        ({'column': 'q'}, 'no_cells'),
        ({'cells': [192]}, 'no_cells'),
        ({'column': 3, 'cells': [192]}, 'no_column'),
        ({'column': 'q', 'cells': [[1]]}, 'list_cells'),
        (3, 'no_mark'),
    ],
)
def test_a_mark_is_a_column_and_cells_of_it(valid, key, refused):
    speed = {'column': 'v', 'unit': 'mm/s', 'valid': {'column': 'q', 'cells': [192, True, 'Ok']}}
    content = {'time': {'rate_Hz': 10.0}, 'axes': {'x': {'lead_mm': 10.0, 'speed': speed}}}
    marks = make_map(content).marks['v']
    assert (marks.valid.column, marks.valid.cells) == ('q', ('192', 'true', 'ok'))
    speed['valid'] = valid
    refused(key, make_map, content)
