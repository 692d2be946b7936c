# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Courses of numbers, and what is said of them beside the published study."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import load_screw
from surrogate.studies import readings as judged
from surrogate.studies.rows import nut_rows, StudyRow
from surrogate.studies.tasks import RELIEVED, SMOOTH, STANDING

SCREW, LAW = load_screw('nominal'), AsperityLaw(onsets={}, deviation=0.16)
BASE = StudyRow(inputs='a', kind='screw', rpm=5.0, load=0.0, status='CONVERGED')


@pytest.mark.parametrize(
    ('values', 'expected'),
    [
        ([3.0, 2.0, 1.0], [('falls', 2)]),
        ([3.0, 1.0, 2.0, 4.0], [('falls', 1), ('rises', 3)]),
        ([1.0, 4.0, 2.0, 3.5], [('rises', 1), ('falls', 2), ('rises', 3)]),
        ([1.0, 1.05, 0.97, 1.0], []),
        ([1.0, 1.06, 1.12, 1.18], [('rises', 3)]),
        ([1.0, 2.0, 1.95, 2.05, 1.0], [('rises', 3), ('falls', 4)]),
        ([2.0, 1.0, 0.95, 1.0], [('falls', 2)]),
        ([1.0], []),
    ],
)
def test_course(values, expected):
    """Turns larger than the tolerance, each with the place of its end; creeping adds up."""
    assert judged.course(np.array(values), np.full(len(values), 0.1)) == expected


def test_a_change_as_large_as_the_tolerance_is_none_and_words_of_a_course():
    """Equality counts as no change; words have value and place of the start and of each turn."""
    assert judged.course(np.array([1.0, 1.5]), np.full(2, 0.5)) == []
    assert judged.course(np.array([1.5, 1.0]), np.full(2, 0.5)) == []
    at = np.array([2.0, 20.0, 1000.0])
    found = judged.read_course(at, np.array([90.0, 50.0, 205.0]), ('falls', 'rises'), 'rev/min')
    assert found == judged.Reading(
        said='90 at 2 rev/min, falls to 50 at 20, rises to 205 at 1000', agrees='yes'
    )
    assert judged.read_course(at[:1], at[:1], ('falls',), 'N') is None


@pytest.mark.parametrize(
    ('values', 'agrees'),
    [([3.0, 1.0, 2.0], 'yes'), ([3.0, 1.0, 1.0], 'in part'), ([1.0, 1.0, 1.0], 'no')],
)
def test_agreement(values, agrees):
    """With falls, then rises: the whole course, a part of it, none of it."""
    found = judged.read_course(
        np.array([2.0, 20.0, 1000.0]), np.array(values), ('falls', 'rises'), 'rev/min'
    )
    assert found is not None
    assert found.agrees == agrees


def test_onsets_are_judged_by_the_film_ratio():
    """Within 0.6 and 1.2 the speed is that of deterministic solutions, whatever the speed."""
    rows = [
        replace(
            BASE,
            case=case,
            rpm=rpm,
            draw=SMOOTH if case == 'ours' else 0,
            rcs=0.01 * (end / rpm) ** 5,
            central_film=1e-9 * rpm**0.75,
        )
        for case, end in (('ours', 500.0), (STANDING, 50.0))
        for rpm in (10.0, 100.0, 1000.0)
    ]
    first = judged.trends(SCREW, LAW, rows)[0]
    assert first.rolling is not None
    assert first.standing is not None
    assert first.rolling.said.startswith('500 rev/min')
    assert first.rolling.agrees == 'yes'
    assert first.standing.said.startswith('50 rev/min')
    assert first.standing.agrees == 'no'


def test_nuts_share_the_contacts_under_preload():
    """A relieved nut has its own rows under load, and neither has those of other assumptions."""
    rows = [
        replace(BASE, kind='contact', case=case, load=load)
        for case, load in (('ours', 0.0), ('ours', 9.0), (RELIEVED, 9.0), ('short inlet', 0.0))
    ]
    assert [len(nut_rows(rows, nut)) for nut in ('loaded', 'relieved')] == [2, 2]


def test_table_and_summary():
    """A row for each trend, empty where a model says nothing; the list names what changed."""
    yes, no = judged.Reading(said='a', agrees='yes'), judged.Reading(said='b', agrees='no')
    found = [
        judged.Trend(name='one', published='falls', standing=no, rolling=yes),
        judged.Trend(name='two', published='rises', standing=None, rolling=no),
    ]
    expected = ['| one | falls | b | no | a | yes |', '| two | rises |  |  | b | no |']
    assert judged.trend_table(found).splitlines()[2:] == expected
    assert judged.summary(found).splitlines() == [
        '* Rolling roughness, agree: one.',
        '* Rolling roughness, agree in part: none.',
        '* Rolling roughness, differ: two.',
        '* Unlike standing roughness: one.',
    ]
