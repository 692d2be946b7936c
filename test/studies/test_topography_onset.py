# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Marched strips of the table and what their topography tells."""

import csv
from pathlib import Path

import pytest

STUDIES = Path(__file__).resolve().parents[2] / 'studies'


@pytest.fixture(scope='module', name='marches')
def load_marches(study):
    return study('topography_onset')


@pytest.fixture(scope='module')
def rows():
    with (STUDIES / 'results' / 'asperity_marches.csv').open(encoding='utf-8') as file:
        return {row['march']: row for row in csv.DictReader(file)}


@pytest.mark.parametrize('name', ['n4_new', 'd25_new', 's3_H3', 'long_new', 'f8_nD26d38_H4'])
def test_the_topography_tells_the_onset_of_a_marched_strip(rows, marches, name):
    """Within 1.2 in film: two screws, two cuts and none, a lay; the last marched after the fit."""
    one = marches.strip_of(rows[name])
    low, high = (one.told_at(film) for film in (1 / 1.2, 1.2))
    assert low < one.onset < high
