# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Two surfaces compared: nothing between equals, what was changed between others."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.file import read, write
from surrogate.surface_tools.diff import diff_record, zone_limits

COMMAND = ('surface', 'diff')

CLOSED_FORM = shipped_surface(tier='closed_form')
DATA = read(CLOSED_FORM)
SHIPPED = Surface(DATA)


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Compare at fewer speeds and along fewer lines: what is said does not depend on them."""
    monkeypatch.setattr('surrogate.surface_tools.diff.SPEEDS', 10)
    monkeypatch.setattr('surrogate.surface_tools.diff.LINES', (7, 3))


def scaled(data, **factors):
    fields = {name: factors.get(name, 1.0) * values for name, values in data.fields.items()}
    return replace(data, fields=fields)


def test_equal_surfaces_do_not_differ(run, capsys):
    """Zero everywhere, exit code 0, in words and as JSON, also by the name of a tier."""
    assert run('closed_form', CLOSED_FORM) == 0
    assert capsys.readouterr().out.endswith('within the tolerances\n')
    assert run(CLOSED_FORM, CLOSED_FORM) == 0
    text = capsys.readouterr().out
    assert 'inputs and settings: the same' in text
    assert text.endswith('within the tolerances\n')
    assert run(CLOSED_FORM, CLOSED_FORM, '--json') == 0
    found = json.loads(capsys.readouterr().out)
    assert {gap['max'] for gap in found['fields'].values()} == {0.0}
    assert found['zone']['largest_shift_slow'] == found['zone']['largest_shift_fast'] == 0.0
    assert found['points'] == 10 * (32 + 2) * (8 + 2)
    assert found['exceeded'] == []


def test_a_scaled_field_differs_by_its_scale():
    """A torque 1 % higher: the largest difference is 1 % of the largest torque, no other field."""
    fields = diff_record(DATA, scaled(DATA, friction_torque=1.01))['fields']
    at = fields['friction_torque']['at']
    expected = 0.01 * SHIPPED.lookup(*at).friction_torque
    assert fields['friction_torque']['max'] == pytest.approx(expected)
    assert fields['friction_torque']['p95'] < fields['friction_torque']['max']
    assert fields['rcs']['max'] == 0.0
    assert 0 < fields['efficiency']['max'] < 0.01


def test_a_shifted_onset_shifts_the_zone():
    """Speeds 10 % higher for the same films and contact: so is the slow limit of the zone."""
    moved = replace(DATA, log_onset=DATA.log_onset + math.log(1.1))
    slow, fast = DATA.header['settings']['speed_range']
    settings = {**DATA.header['settings'], 'speed_range': [slow * 1.1, fast]}
    moved = replace(moved, header={**DATA.header, 'settings': settings})
    record = diff_record(DATA, moved)
    assert record['zone']['largest_shift_slow'] == pytest.approx(0.1, abs=2e-3)
    assert record['common_speed_rad_s'] == [slow * 1.1, fast]
    assert [one['what'] for one in record['inputs']] == ['settings.speed_range']


def test_the_zone_begins_where_rcs_falls_below_its_limit():
    """At 40 degC and 1000 N: just below the limit outside, just above inside."""
    limits = zone_limits(SHIPPED, 1000.0, 313.15, SHIPPED.speed_range)
    assert limits
    assert SHIPPED.lookup(limits[0], 1000.0, 313.15).rcs == pytest.approx(0.01, abs=1e-6)
    assert SHIPPED.lookup(limits[0] * 0.999, 1000.0, 313.15).rcs > 0.01
    assert limits[1] == pytest.approx(SHIPPED.speed_range[1])
    assert zone_limits(SHIPPED, 1000.0, 353.15, (1.0, 200.0)) is None


def test_differences_beyond_the_tolerances_and_answers_of_one_alone_are_told(
    run, tmp_path, capsys
):
    """The sentence says what, how much and what is allowed; a wider tolerance accepts it."""
    other = tmp_path / 'other.npz'
    write(other, scaled(DATA, friction_torque=1.02))
    assert run(CLOSED_FORM, other) == 1
    assert 'efficiency differs by 0.0' in capsys.readouterr().out
    words = ('--efficiency-tolerance', 0.02, '--zone-tolerance', 0.1)
    assert run(CLOSED_FORM, other, *words) == 0
    mask = DATA.mask.copy()
    mask[:, 5, :] = True
    write(tmp_path / 'holed.npz', replace(DATA, mask=mask))
    assert run(CLOSED_FORM, tmp_path / 'holed.npz') == 1
    assert 'points are answered by one surface only' in capsys.readouterr().out


def test_other_inputs_are_listed(run, tmp_path, capsys, screw, oil, says, small_tiles):
    """Another preload and other ranges: both are named, common ranges are compared."""
    nodes = {'speed_nodes': 16, 'load_cells': 3, 'unloaded_cells': 1, 'temperature_nodes': 3}
    settings = replace(default_settings(screw), temperature_range=(293.15, 333.15), **nodes)
    data = build_closed_form(replace(screw, preload=1000.0), oil, settings)
    write(tmp_path / 'other.npz', data)
    assert run(CLOSED_FORM, tmp_path / 'other.npz') == 1
    text = capsys.readouterr().out
    assert says('inputs_screw_preload') in text
    assert says('temperature_9_nodes') in text


def test_ranges_that_do_not_meet_and_a_tolerance_that_is_no_number_are_refused(refused, run):
    warm = replace(DATA, temperature=DATA.temperature + 100.0)
    refused('surfaces_have_temperature', diff_record, DATA, warm)
    refused('rcs_tolerance_nan', run, CLOSED_FORM, CLOSED_FORM, '--rcs-tolerance', np.nan)
