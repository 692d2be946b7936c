# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Published values: each declared in full, and verdicts on and beside the limit."""

from dataclasses import replace

import pytest
from surrogate.validation.sources import PUBLISHED, WITHOUT_NUMBER


@pytest.mark.parametrize('one', PUBLISHED, ids=lambda one: one.what)
def test_a_published_value_is_declared_in_full(one):
    """Source with a year or a standard, what was read of it, a range that rises, a reason."""
    assert one.source[-4:].isdigit()
    assert one.read
    assert one.reason
    assert 0 <= one.low <= one.high
    assert 0 <= one.tolerance < 0.2
    assert one.ours.__doc__


def test_no_value_is_declared_twice():
    assert len({one.what for one in PUBLISHED}) == len(PUBLISHED)
    assert all(sentence.endswith('.') for sentence in WITHOUT_NUMBER)


@pytest.mark.parametrize(
    ('found', 'verdict'), [([0.9, 2.2], 'agrees'), ([0.9, 2.21], 'differs'), ([0.89], 'differs')]
)
def test_all_of_ours_must_lie_within(found, verdict):
    """The limit itself belongs to the range; what is not comparable stays so."""
    one = replace(PUBLISHED[0], low=1.0, high=2.0, tolerance=0.1)
    assert one.verdict(found) == verdict
    assert replace(one, comparable=False).verdict(found) == 'not comparable'
