# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reference tables and shared objects of the offline tests."""

import csv
from pathlib import Path

import pytest
from surrogate.build import build_closed_form, default_settings
from surrogate.parameters import load_lubricant, load_screw, Lubricant, Screw
from surrogate.surface_file import SurfaceData

REFERENCE = Path(__file__).parents[1] / 'reference'


def rows(name: str) -> list[dict[str, str]]:
    """Return the rows of a reference table, without its header lines."""
    lines = (REFERENCE / name).read_text(encoding='utf-8').splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith('#')))


@pytest.fixture(scope='session')
def table():
    """Return the reader of the reference tables."""
    return rows


@pytest.fixture(scope='session')
def screw() -> Screw:
    """Return the nominal screw."""
    return load_screw('nominal')


@pytest.fixture(scope='session')
def oil() -> Lubricant:
    """Return the nominal oil."""
    return load_lubricant('iso_vg_68')


@pytest.fixture(scope='session')
def surface_data(screw: Screw, oil: Lubricant) -> SurfaceData:
    """Build the nominal surface once."""
    return build_closed_form(screw, oil, default_settings(screw))
