# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The list of the robustness bench is fixed and wide, and its table comes back as it went."""

from dataclasses import replace
import hashlib
import importlib.util
from pathlib import Path

import pytest

SPEC = importlib.util.spec_from_file_location(
    'robustness', Path(__file__).resolve().parents[2] / 'studies' / 'robustness.py'
)
bench = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(bench)
CASES = bench.case_list()


@pytest.fixture
def row():
    """Return a row of a smooth case that converged."""
    case = replace(CASES[0], kind='smooth', rms=0.0, draw=0, speed=0.5)
    return replace(bench.failed(case, 'CONVERGED', 0.1, 9.0), converged=True, finite=True)


def test_list_is_the_same_everywhere():
    text = ' '.join(case.key for case in CASES)
    assert hashlib.sha256(text.encode()).hexdigest()[:12] == 'ac3fa6384587'


@pytest.mark.parametrize('every', [1, 8, 40])
def test_any_part_of_the_list_is_a_fair_sample(every):
    """Both kinds and both contacts in their shares, some cases at rest."""
    cases = CASES[::every]
    assert sum(case.kind == 'mixed' for case in cases) / len(cases) == pytest.approx(0.35, abs=0.1)
    assert sum(case.side == 'nut' for case in cases) / len(cases) == pytest.approx(0.5, abs=0.15)
    assert any(case.speed == 0 for case in cases)


def test_cases_lie_in_their_ranges():
    for case in CASES:
        low, high = bench.LOADS[case.kind]
        assert low <= case.load <= high
        assert case.speed == 0 or 0.002 <= case.speed <= 3.0
        assert 0.005 <= case.viscosity <= 0.5
        assert 0.02 <= case.rms <= 0.4 if case.kind == 'mixed' else case.rms == 0
        assert 0 <= case.draw < 5


def test_rows_come_back_from_the_table(tmp_path, row):
    other = replace(row, key='other', rcs=0.25, converged=False)
    bench.write_rows(tmp_path / 'table.csv', [row, other])
    back = bench.read_rows(tmp_path / 'table.csv')
    assert list(back) == [row.key, 'other']
    assert back['other'].rcs == 0.25
    assert back[row.key].converged
    assert not back['other'].converged


@pytest.mark.parametrize(
    ('change', 'group'),
    [
        ({}, 'smooth, film above the floor'),
        ({'film_over_floor': 1.001}, 'smooth, film at the floor'),
        ({'speed': 0.0}, 'smooth, dry'),
        ({'kind': 'mixed'}, 'mixed'),
        ({'kind': 'mixed', 'speed': 0.0}, 'rough, dry'),
    ],
)
def test_each_row_has_one_group(row, change, group):
    assert replace(row, **change).group == group


@pytest.mark.parametrize(
    ('change', 'defect'),
    [
        ({}, False),
        ({'finite': False}, True),
        ({'converged': False, 'finite': False}, False),
        ({'converged': False, 'status': 'ValueError: no'}, True),
        ({'seconds': 91.0}, True),
    ],
)
def test_defects_are_broken_promises(row, change, defect):
    """A NaN called a result, an exception or a hang; a case that says it failed is not broken."""
    assert replace(row, **change).defect is defect
