# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record and page: complete, and the document holds what the command prints."""

import json
from pathlib import Path
import re
from statistics import NormalDist

import numpy as np
import pytest
from surrogate.files import json_text
from surrogate.studies.drag import PRELOADS
from surrogate.studies.validation import (
    compared,
    LOADS,
    OURS,
    PUBLISHED,
    reduced_peak_height,
    rolling_force,
    span,
    SPEEDS,
    validation_page,
    ValidationCase,
)

DOCUMENT = Path(__file__).parents[3] / 'docs' / 'theory' / 'validation.md'
SHARES = (np.arange(20000) + 0.5) / 20000
NUMBER = re.compile(r'\d+(?:\.\d+)?')


QUICK = (
    *('efficiency_with_drag', 'efficiency_of_load', 'efficiency_over_load', 'sealed_drag'),
    'drag_over_measured',
)
"""Comparisons whose numbers take a second."""


def assert_alike(kept, table):
    """Hold lines to be the same words, and numbers within what another processor may round."""
    assert NUMBER.sub('#', kept) == NUMBER.sub('#', table)
    numbers = [[float(one) for one in NUMBER.findall(part)] for part in (kept, table)]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.03, abs=0.011)


def test_the_document_holds_what_is_quickly_compared(one_small_tile):
    """Some lines of its first table, and of that of rolling forces."""
    places = {f'| {load:g} | {rpm:.0f} |': (load, rpm) for load, rpm in zip(LOADS, SPEEDS)}
    with one_small_tile():
        case = ValidationCase()
        quick = [one for one in PUBLISHED['values'] if one['ours'] in QUICK]
        known = {
            'comparisons': [compared(value, OURS[value['ours']](case)) for value in quick],
            'rolling': [rolling_force(case, *place) for place in places.values()],
        }
    empty = {'without_number': [], 'rolling_over_width': {}, 'torque_Nm': {}}
    lines = DOCUMENT.read_text(encoding='utf-8').splitlines()
    starts = *(f'| {value["what"]} |' for value in quick), *places
    page = validation_page(known | empty).splitlines()
    for start in starts:
        kept, told = ([one for one in text if one.startswith(start)] for text in (lines, page))
        assert len(kept) == len(told) == 1, start
        assert_alike(kept[0], told[0])


@pytest.mark.long
def test_the_document_holds_the_tables_of_the_command(record):
    text = DOCUMENT.read_text(encoding='utf-8')
    for table in validation_page(record).split('\n\n'):
        head = table.splitlines()[0]
        assert text.count(head) == 1
        first = text.index(head)
        kept = text[first:].split('\n\n')[0]
        assert_alike(kept, table)


@pytest.mark.long
def test_a_record_says_everything_of_each_comparison(record):
    """All texts are there, ranges rise, and numbers are finite."""
    verdicts = [one['verdict'] for one in record['comparisons']]
    assert set(verdicts) == {'agrees', 'differs', 'not comparable'}
    for one in record['comparisons']:
        assert all(one[key] for key in ('what', 'source', 'read', 'ours', 'reason'))
        assert one['published'][0] <= one['published'][1]
    assert json.loads(json_text(record))['torque_Nm'] == record['torque_Nm']


@pytest.mark.long
def test_the_torque_under_other_laws(record):
    """A limit that is not reached changes nothing; limited Newtonian oil rises with the limit."""
    plain, high, low, thin, thick, *limited = list(record['torque_Nm'].values())[:7]
    assert high == pytest.approx(plain, rel=1e-4)
    assert low == pytest.approx(plain, rel=1e-4)
    assert thin < plain < thick < limited[0] < limited[1]


@pytest.mark.long
def test_torque_over_preload_lies_between_those_of_the_powers_of_a_contact(record):
    """Between half of it, as rolling, and 4/3, as sliding over the width of a Hertz contact."""
    low, middle, high = PRELOADS
    slow, fast = (2 * middle**p / (low + high**p) for p in (4 / 3, 0.5))
    (row,) = (one for one in record['comparisons'] if one['what'].endswith('4, 100 rev/min'))
    assert slow < row['ours'][0] < fast


@pytest.mark.long
def test_more_oil_costs_more_rolling(record):
    """It grows with the width of the oil, with its logarithm once that is wide."""
    ratios = record['rolling_over_width']
    assert list(ratios.values()) == sorted(ratios.values())
    wider = ratios[6.0] - ratios[3.0]
    assert wider == pytest.approx(ratios[3.0] - ratios[2.0], rel=0.8)


def test_spans():
    assert span([0.5, 0.5]) == '0.50'
    assert span([2.0, 0.0581]) == '0.058 to 2.00'


@pytest.mark.parametrize('value', PUBLISHED['values'], ids=lambda value: value['what'])
def test_a_published_value_is_declared_in_full(value):
    """Source with a year or a standard, what was read of it, a range that rises, a reason."""
    assert value['source'][-4:].isdigit()
    assert value['read']
    assert value['reason']
    assert 0 <= value['published'][0] <= value['published'][1]
    assert 0 <= value.get('tolerance', 0.0) < 0.2
    assert OURS[value['ours']].__doc__


def test_no_value_is_declared_twice():
    assert len({value['what'] for value in PUBLISHED['values']}) == len(PUBLISHED['values'])
    assert all(sentence.endswith('.') for sentence in PUBLISHED['without_number'])


@pytest.mark.parametrize(
    ('found', 'expected'), [([0.9, 2.2], 'agrees'), ([0.9, 2.21], 'differs'), ([0.89], 'differs')]
)
def test_all_of_ours_must_lie_within(found, expected):
    """The limit itself belongs to the range; what is not comparable stays so."""
    value = {'published': [1.0, 2.0], 'tolerance': 0.1, 'comparable': True}
    assert compared(value, found)['verdict'] == expected
    unequal = compared(value | {'comparable': False}, found)
    assert unequal['verdict'] == 'not comparable'


def test_a_uniform_profile_has_no_peaks():
    """Its material ratio curve is straight."""
    assert reduced_peak_height(np.linspace(-1e-7, 1e-7, 1000)) == pytest.approx(0.0, abs=1e-12)


def test_gaussian_heights():
    """
    Core from the quantile of 0.7, slope 2 q/0.4, extended to the top t = 5 q/2.

    Spk = 2 (pdf(t) - t Q(t))/Q(t), in rms heights.

    """
    normal = NormalDist()
    top = 2.5 * normal.inv_cdf(0.7)
    above = 1 - normal.cdf(top)
    expected = 2 * (normal.pdf(top) - top * above) / above
    heights = np.array([normal.inv_cdf(share) for share in SHARES])
    assert reduced_peak_height(1e-7 * heights) == pytest.approx(1e-7 * expected, rel=5e-3)


def test_peaks_upon_a_plateau():
    """One in ten rises evenly to a height upon a flat: a triangle of that height."""
    heights = np.concatenate([np.zeros(9000), np.linspace(0, 1e-6, 1001)[1:]])
    assert reduced_peak_height(heights) == pytest.approx(1e-6, rel=1e-2)
