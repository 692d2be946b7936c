# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Designed marches: what they span, and that a row is the strip that its case makes."""

import math

import numpy as np
import pytest
from surrogate.asperities.law import FILM_BANDS
from surrogate.tasks.table import read_table


@pytest.fixture(scope='module', name='marches')
def load_marches(study):
    return study('film_marches')


@pytest.fixture(scope='module')
def rows(marches):
    return {row.march: row for row in read_table(marches.RESULTS, marches.Marched)}


@pytest.fixture(scope='module')
def held_out(marches, rows):
    return marches.held_out_strips(rows.values())


def test_every_case_was_marched_and_spans_roughness_lay_state_and_screw(marches, rows):
    names = [case.march for case in marches.CASES]
    assert names == list(rows)
    for role in ('fit', 'held out'):
        part = [case for case in marches.CASES if case.role == role]
        assert {case.lay for case in part} == {'isotropic', 'longitudinal', 'transverse'}
        assert {case.state for case in part} == {'new', 'run_in'}
        assert max(case.rms_um for case in part) >= 0.4
        assert min(case.rms_um for case in part) <= 0.06
    draws = {
        role: {case.draw for case in marches.CASES if case.role == role}
        for role in ('fit', 'choice', 'held out')
    }
    assert not draws['held out'] & (draws['fit'] | draws['choice'])


@pytest.mark.parametrize('name', ['40x10 0.2 longi run_in', '16x5 0.15 isotr new draw=44'])
def test_a_row_is_the_strip_of_its_case(marches, rows, name):
    """Half length, pressure and shortest wave; the gap of what is left at the marched onset."""
    row = next(row for march, row in rows.items() if march.startswith(name))
    strip = marches.strip_of(next(case for case in marches.CASES if case.march == row.march))
    assert 1e6 * strip.strip.semi_axis == pytest.approx(row.half_um, rel=1e-3)
    assert 1e-9 * strip.strip.max_pressure == pytest.approx(row.pressure_GPa, rel=1e-3)
    assert 1e6 * strip.shortest == pytest.approx(row.shortest_um, rel=1e-3)
    film, gap, wave, left = marches.left_at(strip, row.onset_m_s)
    found = [1e9 * film, 1e9 * gap, 1e6 * wave, 1e9 * left]
    assert found == pytest.approx([row.film_nm, row.gap_nm, row.wave_um, row.left_nm], rel=0.01)


def test_every_case_and_every_own_screw_has_a_sheet(marches):
    """Its Rq is that of the row, whatever the shipped sheet holds likely; it has no likely one."""
    own = marches.own_strips
    sheets = [marches.sheet_of(case) for case in marches.CASES]
    sheets += [own.sheet_of(screw) for screw in own.OWN]
    wanted = [row.rms_um for row in (*marches.CASES, *own.OWN)]
    assert len(sheets) == 46 + 28
    assert [1e6 * sheet.roughness.rms for sheet in sheets] == pytest.approx(wanted)
    assert {sheet.roughness.likely_rms for sheet in sheets} == {(None, None)}


@pytest.mark.parametrize(
    ('lay', 'rms'), [('isotropic', 0.11), ('longitudinal', 0.10), ('transverse', 0.15)]
)
def test_the_law_tells_the_film_of_designed_marches_held_out_from_its_fit(marches, rows, lay, rms):
    held = [row for row in rows.values() if (row.role, row.lay) == ('held out', lay)]
    off = np.log([marches.told_over_marched(row) for row in held])
    assert math.sqrt(np.mean(off**2)) < rms


@pytest.mark.parametrize(
    ('lay', 'strips', 'raceways', 'rms'),
    [('isotropic', 65, 20, 0.10), ('longitudinal', 40, 13, 0.13), ('transverse', 18, 6, 0.14)],
)
def test_the_law_tells_the_film_of_strips_held_out_from_its_fit(
    held_out, lay, strips, raceways, rms
):
    part = [strip for strip in held_out if strip.lay == lay]
    assert (len(part), len({strip.raceway for strip in part})) == (strips, raceways)
    assert math.sqrt(np.mean([strip.miss**2 for strip in part])) < rms


def test_nine_of_ten_held_out_marches_lie_in_the_band_that_is_stated(marches, rows):
    inside = [
        abs(math.log(marches.told_over_marched(row))) < math.log(FILM_BANDS[row.lay])
        for row in rows.values()
        if row.role == 'held out'
    ]
    assert sum(inside) >= 0.9 * len(inside)


def test_the_law_of_a_strip_is_that_of_its_columns(marches, rows):
    """Its onset by the table of the very tile, as by gap, wave and rms at the marched onset."""
    row = next(row for row in rows.values() if row.role == 'held out' and row.state == 'new')
    strip = marches.strip_of(next(case for case in marches.CASES if case.march == row.march))
    by_film = math.log(marches.told_over_marched(row)) / marches.slope_of(row)
    assert math.log(strip.told / row.onset_m_s) == pytest.approx(by_film, abs=0.05)


def test_the_stated_bands_are_those_of_all_strips_that_were_held_out(marches, held_out):
    """They hold nine of ten of them for each lay, with room for one more strip."""
    for lay, band in FILM_BANDS.items():
        misses = [strip.miss for strip in held_out if strip.lay == lay]
        assert sum(abs(off) < math.log(band) for off in misses) >= 0.9 * len(misses)
        assert marches.nine_of_ten(misses) == pytest.approx(band)


def test_a_further_strip_lies_in_the_stated_band_nine_times_of_ten(marches):
    """Normal misses of 18 and of 60 strips, one more drawn each time; never below 90 %."""
    generator = np.random.default_rng(46)
    for count in (18, 60):
        draws = 0.1 * generator.standard_normal((2000, count + 1))
        inside = [
            abs(last) <= math.log(marches.nine_of_ten(known)) for *known, last in draws.tolist()
        ]
        assert 0.89 < np.mean(inside) < 0.97
