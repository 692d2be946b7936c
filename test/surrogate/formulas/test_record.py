# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The record of a point by formulas: light, and of one sentence per regime."""

import math
import subprocess
import sys

import pytest
from surrogate.surface import regime_of


def test_the_record_loads_no_solver():
    """A point by formulas starts without the compiled kernels."""
    code = 'import sys, surrogate.formulas.record; print({"numba", "matplotlib"} & {*sys.modules})'
    found = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True, timeout=60
    )
    assert found.stdout.strip() == 'set()'


@pytest.mark.parametrize(
    ('ratio', 'word'),
    [
        (0.99, 'boundary'),
        (1.0, 'mixed'),
        (2.99, 'mixed'),
        (3.0, 'hydrodynamic'),
        (math.nan, 'unknown'),
    ],
)
def test_regimes_begin_at_their_limits(ratio, word):
    """The limit belongs to the thicker film."""
    assert regime_of(ratio).word == word
