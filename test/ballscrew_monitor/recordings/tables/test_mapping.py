# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Maps that are not right: one sentence that says what is, and what is allowed."""

import copy
import itertools
import math
from pathlib import Path
import textwrap

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
    """Return the good map with values at dotted places; None takes one out."""
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
        (None, 'the map is None'),
        ({'axis': {}}, "the map holds 'axis', allowed are log, time, axes"),
        (changed(axes={}), 'axes is missing'),
        (changed(axes={'X 1': {}}), "'X 1'"),
        (changed(axes__x=1), 'axis x is 1, it must hold keys and values'),
        (changed(axes__x__speed=None), 'x has no speed'),
        (changed(axes__x__speed__unit=None), 'x.speed.unit is missing, allowed are m/s'),
        (changed(axes__x__speed__unit='N'), "x.speed.unit is 'N', allowed are m/s"),
        (changed(axes__x__speed__scale=0), 'the scale not 0'),
        (changed(axes__x__speed__scale='2'), 'they must be numbers'),
        (changed(axes__x__speed__column=3), 'x.speed.column is 3, it must be a text'),
        (changed(axes__x__speed__colum='v'), 'x.speed.colum is unknown'),
        (changed(axes__x__efficiency=3.0), 'it must be a number from 0.1 to 1'),
        (
            changed(axes__x__load__from='speed'),
            "x.load.from is 'speed', allowed is current, torque",
        ),
        (changed(axes__x__load__from='motor_torque'), 'x.torque_uncertainty_Nm is missing'),
        (changed(axes__x__load__from='torque'), 'of which no column is named'),
        (changed(axes__x__torque_constant_Nm_per_A=None), 'a load from the current needs it'),
        (changed(axes__x__lead_mm=5.0), 'x.lead_mm is both stated and assumed'),
        (changed(assumed={}), 'x.lead_mm is missing'),
        (changed(assumed={'x.lead_mm': {'value': 5.0}}), 'must have a value and a reason'),
        (changed(assumed={'x.lead_mm': 5.0}), 'assumed x.lead_mm is 5.0'),
        (changed(time={}), 'it must name a column or a rate_Hz'),
        (changed(time__rate_Hz=0), 'time.rate_Hz is 0'),
        (changed(time__epoch='then'), 'it must be a date'),
        (changed(time__epoch='1970-01-01'), 'a stamp of 0 means none'),
    ],
)
def test_what_is_wrong_with_a_map_is_one_sentence(content, expected):
    with pytest.raises(InputError) as caught:
        make_map(content)
    assert expected in str(caught.value)
    assert '\n' not in str(caught.value)


def test_a_map_is_a_file(tmp_path):
    path = tmp_path / 'map.yaml'
    path.write_text(yaml.safe_dump(GOOD))
    assert read_map(path).content == GOOD
    path.write_text('][')
    with pytest.raises(InputError, match=r'map .* cannot be read'):
        read_map(path)
    path.write_text('axes: {}')
    with pytest.raises(InputError, match=r'map .*map.yaml: axes is missing'):
        read_map(path)


def test_the_map_of_the_guide_is_one():
    page = Path(__file__).resolve().parents[4] / 'docs' / 'guide' / 'own_log.md'
    lines = page.read_text(encoding='utf-8').splitlines()
    first = lines.index('    log: log.csv')
    block = itertools.takewhile(lambda line: line.startswith('    '), lines[first:])
    made = make_map(yaml.safe_load(textwrap.dedent('\n'.join(block))))
    assert [axis.name for axis in made.axes] == ['x', 'z']
    assert made.axes[0].load_from == 'current'
