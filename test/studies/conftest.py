# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the offline tests that the studies need, too: a fast model and a pool here."""

import importlib.util
from pathlib import Path
from types import ModuleType

TESTS = Path(__file__).resolve().parents[1]


def conftest_of(folder: str) -> ModuleType:
    """Return the fixtures of another folder of tests as a module."""
    path = TESTS / folder / 'conftest.py'
    spec = importlib.util.spec_from_file_location(f'conftest_of_{path.parent.name}', path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


stand_in = conftest_of('surrogate').stand_in
here = conftest_of('surrogate/builder/full').here
