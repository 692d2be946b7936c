# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The shipped surface in place of one that is built first."""

import pytest
from surrogate.surface import shipped_surface
from surrogate.surface.file import read


@pytest.fixture(scope='session')
def surface_data():
    return read(shipped_surface(tier='closed_form'))
