# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The record of all comparisons, computed once."""

import pytest
from surrogate.studies.validation import validation_record


@pytest.fixture(scope='session')
def record():
    """Compute every comparison."""
    return validation_record()
