# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Points looked up: the surface's own numbers, in both directions, one by one or in a table."""

import csv
from dataclasses import replace
import io
import json
import math

import numpy as np
import pytest
from surrogate.files import to_json
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.file import read, write
from surrogate.surface_tools.fields import FIELD_TEXTS

COMMAND = ('surface', 'query')

SHIPPED = Surface.load(shipped_surface())
CLOSED_FORM = shipped_surface(tier='closed_form')


@pytest.fixture
def query(run, capsys):
    def answer(*words):
        assert run(*words, '--json') in (0, 1)
        return json.loads(capsys.readouterr().out)

    return answer


@pytest.mark.parametrize('tier', ['full', 'closed_form'])
@pytest.mark.parametrize(('rpm', 'load', 'opposing'), [(600, 1000, 1000), (-600, 1000, -1000)])
def test_a_point_is_the_lookup(query, tier, rpm, load, opposing):
    """Every field, its errors, and the load's sign by the direction of motion."""
    found = query(tier, '--speed-rpm', rpm, '--load-N', load, '--temperature-degC', 50)
    direct = Surface.load(shipped_surface(tier=tier)).lookup(600 * math.pi / 30, opposing, 323.15)
    for name, text in FIELD_TEXTS.items():
        assert found[text.key] == getattr(direct, name)
    assert found['efficiency'] == direct.efficiency
    assert found['friction_torque_error_Nm'] == direct.friction_torque_error
    assert found['opposing_load_N'] == opposing
    assert found['back_driving'] is (opposing < 0)
    assert (found['validity'], found['reason']) == ('VALID', '')
    assert (found['tier'], found['rcs_std']) == (tier, to_json(direct.rcs_std))


@pytest.mark.parametrize('load', ['-5e-324', '5e-324', '-1e-307', '-0.0'])
def test_a_load_of_almost_nothing_is_no_load(query, load):
    """A negative number with an exponent may stand after a space."""
    found = query('--speed-rpm', 600, '--load-N', load, '--temperature-degC', 50)
    assert found['validity'] == 'VALID'
    assert found['efficiency'] == 0.0


def test_a_page_says_what_is_known(run, capsys, says):
    """Default temperature is that of the oil's datasheet; errors stand beside their numbers."""
    assert run('closed_form', '--speed-rpm', 600, '--load-N', 1000) == 0
    text = capsys.readouterr().out
    assert says('tier_closed_form_600') in text
    assert says('efficiency_0_9358') in text
    assert 'regime               mixed' in text
    assert 'worst contact        relieved nut, screw' in text


def test_a_typical_drag_is_the_band_of_torque_and_efficiency(run, capsys, tmp_path, query):
    """Beside the numbers of the contacts, which stay; nothing of it once it is identified."""
    data = read(CLOSED_FORM)
    drag = {'typical_drag_low': 0.1, 'typical_drag': 0.3, 'typical_drag_high': 0.9}
    inputs = {**data.header['inputs'], 'screw': {**data.header['inputs']['screw'], **drag}}
    write(tmp_path / 'a.npz', replace(data, header={**data.header, 'inputs': inputs}))
    place = '--speed-rpm', 600, '--load-N', 1000
    bare, found = query('closed_form', *place), query(tmp_path / 'a.npz', *place)
    assert found['efficiency'] == bare['efficiency']
    ideal = 1000 * 0.01 / (2 * math.pi)
    for end, value in (('low', 0.1), ('typical', 0.3), ('high', 0.9)):
        torque = bare['friction_torque_Nm'] + value
        assert found[f'typical_drag_{end}_friction_torque_Nm'] == pytest.approx(torque)
        share = ideal / (ideal + torque)
        assert found[f'typical_drag_{end}_efficiency'] == pytest.approx(share)
    assert not any(key.startswith('typical_drag') for key in bare)
    assert run(tmp_path / 'a.npz', *place) == 0
    assert 'with typical drag    efficiency 0.7' in capsys.readouterr().out


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        ('--speed-rpm 0 --load-N 0', 'the surface begins at 0.477 rev/min'),
        ('--speed-rpm 9000 --load-N 0', 'the surface ends at 2188 rev/min'),
        ('--speed-rpm 60 --load-N 9000', 'the surface covers -3960 to 3960 N'),
        ('--speed-rpm 60 --load-N 0 --temperature-degC 90', 'the surface covers 10 to 80 degC'),
    ],
)
def test_no_answer_has_a_reason_and_exit_code_1(run, capsys, query, words, reason):
    """The limit that was passed is named; the numbers are null."""
    assert run(*words.split()) == 1
    assert f'no answer: {reason}' in capsys.readouterr().out
    found = query(*words.split())
    assert found['efficiency'] is found['rcs'] is found['rcs_error'] is None
    assert reason in found['reason']


def test_draws_are_told(run, tmp_path, capsys, query):
    """Deviation and error of the mean of RCS and torque."""
    data = read(CLOSED_FORM)
    spread = np.full(data.mask.shape, 0.01)
    parts = {'deviations': {'rcs': spread}, 'standard_errors': {'rcs': 0.5 * spread}}
    write(tmp_path / 'a.npz', replace(data, **parts))
    found = query(tmp_path / 'a.npz', '--speed-rpm', 600, '--load-N', 1000)
    assert found['rcs_std'] == pytest.approx(0.01)
    assert found['rcs_stderr'] == pytest.approx(0.005)
    assert found['friction_torque_std_Nm'] is None
    assert run(tmp_path / 'a.npz', '--speed-rpm', 600, '--load-N', 1000) == 0
    assert 'between strips 0.01, of mean 0.005)' in capsys.readouterr().out


def test_a_table_for_a_table(run, tmp_path, capsys):
    """Columns of the input stay, every point gets its numbers or its reason."""
    table = tmp_path / 'in.csv'
    table.write_text(
        'speed_rpm,load_N,temperature_degC,note\n600,1000,,a\n-600,1000,50,b\n0,0,20,c\n'
    )
    assert run('--csv', table, '--out', tmp_path / 'out.csv') == 0
    assert capsys.readouterr().err == '2 of 3 points lie on the surface\n'
    rows = list(csv.DictReader((tmp_path / 'out.csv').read_text().splitlines()))
    assert [row['note'] for row in rows] == ['a', 'b', 'c']
    assert [row['validity'] for row in rows] == ['VALID', 'VALID', 'SPEED_BELOW_RANGE']
    assert float(rows[0]['rcs']) == SHIPPED.lookup(600 * math.pi / 30, 1000.0, 313.15).rcs
    assert float(rows[1]['efficiency']) == SHIPPED.lookup(20 * math.pi, -1000.0, 323.15).efficiency
    assert math.isnan(float(rows[2]['rcs']))
    assert run('--csv', table) == 0
    assert capsys.readouterr().out == (tmp_path / 'out.csv').read_text()


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('', 'column_speed_rpm_missing'),
        ('speed_rpm,load_N\n', 'in_csv_points'),
        ('speed_rpm,load_N\n1,2\n1,x\n', 'line_3_load_n_x'),
        ('speed_rpm,load_N\n1\n', 'line_2_values'),
        ('speed_rpm,load_N\n1,nan\n', 'line_2_load_n_nan'),
    ],
)
def test_a_wrong_table_is_one_sentence(run, tmp_path, text, sentence, refused):
    table = tmp_path / 'in.csv'
    table.write_text(text)
    refused(sentence, run, '--csv', table)


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        ('--speed-rpm 1', 'point_needs_speed_rpm'),
        ('--speed-rpm 1 --load-N 1 --out a.csv', 'out_belongs_csv'),
        ('--csv a.csv --json', 'csv_takes_points'),
        ('--csv none.csv', 'none_csv_read'),
    ],
)
def test_words_that_do_not_go_together(run, words, sentence, refused):
    refused(sentence, run, *words.split())


def test_the_table_reader_takes_any_lines():
    """Lines, not a file: the number of answers is told."""
    from surrogate.surface_tools.query import query_table

    text, points, answers = query_table(SHIPPED, io.StringIO('speed_rpm,load_N\n60,0\n'), 'x')
    assert (points, answers) == (1, 1)
    assert text.startswith('speed_rpm,load_N,sha256,')
