# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Speeds that do not make the positions beside them are told, with the unit that would."""

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import PREFIX
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.mapping import make_map
import numpy as np
import pytest

TIME = np.arange(400) / 50.0
SPEED = 100.0 * np.sin(TIME)  # [mm/s]
POSITION = 300.0 - 100.0 * np.cos(TIME)  # [mm]


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


def test_a_gap_and_a_row_without_a_number_say_nothing(notes):
    late = np.where(np.arange(400) < 200, TIME, TIME + 30.0)
    position = np.where(np.arange(400) < 200, POSITION, POSITION + 5e3)
    position[50] = np.nan
    assert not notes(SPEED, 'mm/s', position, late)


def test_the_sign_and_a_factor_of_no_unit_are_told(notes):
    assert notes(-SPEED, 'mm/s')[0].endswith('one of both has the wrong sign of its scale')
    assert notes(3.0 * SPEED, 'mm/s')[0].endswith('the time and the lead')


def test_what_is_not_of_one_motion_or_at_rest_is_not_compared(notes):
    noise = np.random.default_rng(1).normal(size=400)
    assert not notes(1e3 * noise, 'mm/s')
    assert not notes(0.0 * SPEED, 'mm/s')
    assert not notes(SPEED, 'mm/s', 0.0 * POSITION)
