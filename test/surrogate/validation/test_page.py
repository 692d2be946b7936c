# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record and page: complete, and the document holds what the command prints."""

import json
from pathlib import Path
import re

import pytest
from surrogate.files import json_text
from surrogate.validation.page import span, validation_page

DOCUMENT = Path(__file__).parents[3] / 'docs' / 'theory' / 'validation.md'
NUMBER = re.compile(r'\d+(?:\.\d+)?')


def test_the_document_holds_the_tables_of_the_command(record):
    """Word for word; numbers within what another processor may round."""
    text = DOCUMENT.read_text(encoding='utf-8')
    for table in validation_page(record).split('\n\n'):
        head = table.splitlines()[0]
        assert text.count(head) == 1
        first = text.index(head)
        kept = text[first:].split('\n\n')[0]
        assert NUMBER.sub('#', kept) == NUMBER.sub('#', table)
        numbers = [[float(one) for one in NUMBER.findall(part)] for part in (kept, table)]
        assert numbers[0] == pytest.approx(numbers[1], rel=0.03, abs=0.011)


def test_a_record_says_everything_of_each_comparison(record):
    """All texts are there, ranges rise, and numbers are finite."""
    verdicts = [one['verdict'] for one in record['comparisons']]
    assert set(verdicts) == {'agrees', 'differs', 'not comparable'}
    for one in record['comparisons']:
        assert all(one[key] for key in ('what', 'source', 'read', 'ours', 'reason'))
        assert one['published'][0] <= one['published'][1]
    assert json.loads(json_text(record))['torque_Nm'] == record['torque_Nm']


def test_the_torque_under_other_laws(record):
    """A limit that is not reached changes nothing; limited Newtonian oil rises with the limit."""
    plain, high, low, thin, thick, *limited = list(record['torque_Nm'].values())[:7]
    assert high == pytest.approx(plain, rel=1e-4)
    assert low == pytest.approx(plain, rel=1e-4)
    assert thin < plain < thick < limited[0] < limited[1]


def test_more_oil_costs_more_rolling(record):
    """It grows with the width of the oil, with its logarithm once that is wide."""
    ratios = record['rolling_over_width']
    assert list(ratios.values()) == sorted(ratios.values())
    wider = ratios[6.0] - ratios[3.0]
    assert wider == pytest.approx(ratios[3.0] - ratios[2.0], rel=0.8)


def test_spans():
    assert span([0.5, 0.5]) == '0.50'
    assert span([2.0, 0.0581]) == '0.058 to 2.00'
