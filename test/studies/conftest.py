# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Studies as modules: they are scripts beside the packages."""

import importlib.util
from pathlib import Path
import sys

import pytest

STUDIES = Path(__file__).resolve().parents[2] / 'studies'


@pytest.fixture(scope='session')
def study():
    """Return the function that loads a study by its name; studies import one another."""
    if str(STUDIES) not in sys.path:
        sys.path.append(str(STUDIES))

    def load(name):
        spec = importlib.util.spec_from_file_location(name, STUDIES / f'{name}.py')
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load
