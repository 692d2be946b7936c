# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Words of a catalogue: every word has a flag, and what is missing is named by it."""

from dataclasses import fields

import pytest
from surrogate.catalogue.words import CatalogueOil, CatalogueScrew, flag_of
from surrogate.files.datasheet import sheet_of

ENOUGH = {
    'nominal_diameter_mm': 20.0,
    'lead_mm': 5.0,
    'nut': 'double',
    'turns': 4.0,
    'preload_N': 500.0,
}


def test_flags_carry_their_unit():
    flags = [flag_of(spec) for spec in fields(CatalogueScrew)]
    assert {'--nominal-diameter-mm', '--static-rating-kN', '--turns', '--ra-um'} <= set(flags)


@pytest.mark.parametrize(
    ('without', 'key'),
    [
        ('nominal_diameter_mm', 'diameter_missing'),
        ('lead_mm', 'lead_missing'),
        ('nut', 'nut_missing'),
        ('turns', 'turns_missing'),
        ('preload_N', 'preload_missing'),
    ],
)
def test_what_cannot_be_derived_is_asked_for(without, key, refused):
    content = {name: value for name, value in ENOUGH.items() if name != without}
    refused(key, sheet_of, CatalogueScrew, content, 'screw new')


@pytest.mark.parametrize(
    ('content', 'key'),
    [
        ({'pitch_diameter_mm': 10.3}, 'pitch_diameter_radius'),
        ({'lead_mm': 'five'}, 'lead_five'),
        ({'process': 'cast'}, 'process_cast'),
        ({'turns': 500.0}, 'turns_500'),
        ({'nut': 'single'}, 'nut_single'),
        ({'nut': 'offset', 'turns': 1.5}, 'turns_1_5'),
    ],
)
def test_a_value_that_no_catalogue_has_is_refused(content, key, refused):
    """A radius as a diameter, a word as a number, an offset nut without two halves."""
    refused(key, sheet_of, CatalogueScrew, ENOUGH | content, 'screw new')


def test_a_plain_nut_needs_no_preload():
    content = {name: value for name, value in ENOUGH.items() if name != 'preload_N'}
    assert sheet_of(CatalogueScrew, content | {'nut': 'plain'}, 'screw new').preload is None


def test_an_oil_needs_its_grade(refused):
    refused('grade_missing', sheet_of, CatalogueOil, {'base': 'pao'}, 'oil new')
