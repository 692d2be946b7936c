# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Typical raceways: the process gives height and lay, and the cut-off is stated."""

import pytest
from surrogate.catalogue.raceways import PROCESSES, raceway_of
from surrogate.catalogue.words import CatalogueScrew

SIZE = {'nominal_diameter': 0.02, 'lead': 0.005, 'nut': 'double', 'turns': 4.0, 'preload': 500.0}


@pytest.mark.parametrize(
    ('given', 'lay', 'rms'),
    [
        ({}, 'longitudinal', 0.2e-6),
        ({'accuracy': '5'}, 'longitudinal', 0.2e-6),
        ({'accuracy': '7'}, 'longitudinal', 0.375e-6),
        ({'process': 'rolled'}, 'longitudinal', 0.375e-6),
        ({'process': 'whirled', 'accuracy': '7'}, 'transverse', 0.375e-6),
        ({'ra': 0.1e-6}, 'longitudinal', 0.125e-6),
    ],
)
def test_process_and_ra(given, lay, rms):
    """Rq is 1.25 Ra, that of the catalogue or a typical one."""
    found = raceway_of(CatalogueScrew(**SIZE, **given))
    assert found['lay'].value == lay
    assert found['rms'].value == pytest.approx(rms)


@pytest.mark.parametrize('ra', [0.09e-6, 0.1e-6, 0.1008e-6, 0.4e-6])
def test_the_cut_off_does_not_step_with_ra(ra):
    """The table of the standard goes from 0.25 to 0.8 mm at Ra 0.1 um."""
    assert raceway_of(CatalogueScrew(**SIZE, ra=ra))['cutoff_long'].value == 0.25e-3
    given = raceway_of(CatalogueScrew(**SIZE, ra=ra, cutoff_long=0.8e-3))['cutoff_long']
    assert (given.value, given.note) == (0.8e-3, 'given')


def test_each_process_names_range_and_source():
    for process in PROCESSES.values():
        assert ' to ' in process.ra_words
        assert process.lay_words
