# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Texts as numbers or times: the form that reads the most cells, whatever the blocks are."""

from pathlib import Path

from ballscrew_monitor.recordings.tables.cells import Cells
from ballscrew_monitor.recordings.words import counted
from hypothesis import assume, example, given, strategies
import numpy as np
import polars as pl
import pytest

DAY = 1_767_312_000.0  # 2026-01-02 [s]
READ = {
    ' 12 ': {'point': 12.0, 'comma': 12.0},
    '1.5': {'point': 1.5},
    '2,5': {'comma': 2.5},
    '-1e3': {'point': -1e3, 'comma': -1e3},
    '1.234,5': {'comma': 1234.5},
    '1,234,5': {},
    'inf': {},
    'text': {},
    None: {},
    '2026-01-02T03:04:05.5Z': {'iso': DAY + 11045.5},
    '02.01.2026 03:04:05,5': {'german': DAY + 11045.5},
    '2026/01/02 03:04:05': {'slash': DAY + 11045.0},
    '03:04:05,25': {'clock': 11045.25},
    '02.01.2026': {'german day': DAY},
    '2026-01-02': {'iso day': DAY},
    '2026/01/02': {'slash day': DAY},
}
FORMS = (
    *('point', 'comma', 'iso', 'german', 'slash', 'clock'),
    *('iso day', 'german day', 'slash day'),
)
"""In the order in which the first of those that read as many cells is taken."""


def plain(texts):
    """Return the cells in the form of most of them, by one look at all of them."""
    made = {form: [READ[text].get(form) for text in texts] for form in FORMS}
    good = {form: sum(one is not None for one in column) for form, column in made.items()}
    best = max(good.values())
    alike = {tuple(made[form]) for form in FORMS if good[form] == best}
    assume(len(alike) == 1)
    return made[max(good, key=good.__getitem__)]


NUMBERS = [text for text, read in READ.items() if not read.keys() - {'point', 'comma'}]
BOTH = strategies.sampled_from(NUMBERS), strategies.sampled_from(list(READ))
LISTS = [strategies.lists(cells, min_size=1, max_size=12) for cells in BOTH]


@given(LISTS[0], strategies.integers(1, 12))
@example(['1.5', '2,5', '2,5'], 1)
@example(['1.5', '2,5', '2,5', '2,5', ' 12 '], 1)
@example(['1.5', ' 12 ', '2,5', '2,5'], 1)
def test_numbers_are_read_with_the_sign_of_most_part_by_part(texts, block):
    check_column(texts, block)


@given(LISTS[1])
def test_cells_are_read_in_the_form_of_most(texts):
    check_column(texts, len(texts))


def check_column(texts, block):
    cells = Cells(Path('log'), 'a')
    column = pl.Series(texts, dtype=pl.String)
    for begin in range(0, len(texts), block):
        cells.add(column.slice(begin, block))
    expected = plain(texts)
    if all(one is None for one in expected):
        with pytest.raises(ValueError, match='holds no number'):
            cells.reading()
        return
    reading = cells.reading()
    wanted = np.array([np.nan if one is None else one for one in expected])
    np.testing.assert_allclose(reading.numbers(column), wanted, rtol=0, atol=1e-6)
    np.testing.assert_allclose(reading.extremes, [np.nanmin(wanted), np.nanmax(wanted)], atol=1e-6)
    missing = int(np.isnan(wanted).sum()) - texts.count(None)
    assert (f'holds {counted(missing, "cell")} without a number' in reading.note) == bool(missing)
