# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The pages of the published study: the numbers against their rows, the rows against code."""

from dataclasses import replace
from pathlib import Path
import re

import numpy as np
import pytest
from surrogate.asperities.law import AsperityLaw
from surrogate.commands.figures import DRAWS
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw.opened import Contacts
from surrogate.studies import report as judged
from surrogate.studies.curves import nut_rows, StudyRow
from surrogate.studies.report import report, trends
from surrogate.studies.solve import known_inputs, solve_task
from surrogate.studies.tasks import FIGURES, RELIEVED, StudyTask, tasks
from surrogate.tasks.table import read_table

TREE = Path(__file__).parents[3]
SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
ROWS = {row.key: row for row in read_table(TREE / 'test' / 'data' / 'paper.csv', StudyRow)}
THEORY = TREE / 'docs' / 'theory'
PAGE = (THEORY / 'validation.md').read_text(encoding='utf-8')
NUMBERS = (THEORY / 'published_study_numbers.md').read_text(encoding='utf-8')
BASE = StudyRow(inputs='a', kind='screw', rpm=5.0, load=0.0, status='CONVERGED')
LAW = AsperityLaw(onsets={}, deviation=0.16)
TRENDS = trends(SCREW, OPENED.law, ROWS.values())


def task_of(kind, rpm, load, **more):
    return StudyTask(kind=kind, rpm=float(rpm), load=float(load), **more)


def trend(start):
    """Return the one trend whose name begins so."""
    (found,) = (one for one in TRENDS if one.name.startswith(start))
    return found


def test_page_of_numbers_is_the_report_of_the_rows_of_the_default_run():
    assert NUMBERS.endswith(report(SCREW, OPENED.law, ROWS))
    wanted = {task.key: task for task in tasks(FIGURES, DRAWS)}
    assert set(ROWS) == set(wanted)
    known = known_inputs()
    assert all(row.inputs == known[wanted[key].kind] for key, row in ROWS.items())
    assert {row.status for row in ROWS.values()} == {'CONVERGED'}


@pytest.mark.parametrize(
    'words', [trend('contact at higher').rolling.text.split(', standard')[0], 'film ratio of 0.1,']
)
def test_sentences_have_the_numbers_of_the_table(words):
    assert words in ' '.join(PAGE.split())


def test_every_picture_is_there_and_small():
    pictures = TREE / 'docs' / 'pictures'
    shown = set(re.findall(r'\]\(\.\./pictures/(paper_\w+\.png)\)', PAGE))
    assert shown == {path.name for path in pictures.glob('paper_*.png')}
    assert len(shown) == 4
    assert all((pictures / name).stat().st_size < 300_000 for name in shown)


def test_film_is_that_of_the_study_and_asperities_move_to_the_centre():
    """Smooth within 1 %, and rough by the trend."""
    film = trend('central film')
    assert float(film.rolling.text.split()[0]) == pytest.approx(153.0, rel=0.01)
    assert film.standing.agrees == film.rolling.agrees == 'yes'
    assert trend('distance of the asperity load').standing.agrees == 'yes'
    assert len(TRENDS) == 13


@pytest.mark.parametrize(
    ('name', 'standing', 'rolling'),
    [
        ('contact at higher speeds', 'no', 'yes'),
        ('RCS, preload', 'yes', 'yes'),
        ('friction torque', None, 'yes'),
        ('friction coefficient of the sliding', None, 'yes'),
        ('friction coefficient, all losses', None, 'yes'),
        ('efficiency over speed', None, 'in part'),
        ('efficiency over load', None, 'in part'),
        ('RCS over load, loaded nut', 'no', 'no'),
        ('RCS over load, relieved nut', 'yes', 'yes'),
        ('film over load [nm], loaded nut', 'no', 'no'),
    ],
)
def test_what_agrees(name, standing, rolling):
    found = trend(name)
    assert (found.standing and found.standing.agrees, found.rolling.agrees) == (standing, rolling)


@pytest.mark.parametrize(
    ('task', 'columns', 'tolerance'),
    [
        (task_of('contact', 600, 2400), 'central_film mean_film', 2e-3),
        (
            task_of('contact', 10, 0, draw=3),
            'rcs asperity_share asperity_distance mean_film',
            0.02,
        ),
        (task_of('contact', 5, 1000, draw=1, nut=RELIEVED), 'rcs mean_film', 0.02),
        (task_of('screw', 1000, 1000), 'friction_torque sliding_torque central_film', 5e-3),
        (
            task_of('screw', 300, 0),
            'friction_torque friction_coefficient asperity_coefficient rcs rolling_torque',
            5e-3,
        ),
    ],
    ids=lambda value: value.key if isinstance(value, StudyTask) else '',
)
def test_rows_are_what_the_code_solves(task, columns, tolerance):
    """One row of every kind, solved again; none of the compared numbers is zero."""
    kept = ROWS[task.key]
    row = solve_task(OPENED, OIL, task, kept.inputs)
    assert row.status == kept.status
    for name in columns.split():
        assert getattr(kept, name) > 0
        assert getattr(row, name) == pytest.approx(getattr(kept, name), rel=tolerance), name


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
        text='90 at 2 rev/min, falls to 50 at 20, rises to 205 at 1000', agrees='yes'
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
            kind=kind,
            rpm=rpm,
            draw=draw,
            rcs=0.01 * (end / rpm) ** 5,
            central_film=1e-9 * rpm**0.75,
        )
        for kind, draw, end, speeds in (
            ('screw', -1, 500.0, (10.0, 100.0, 1000.0)),
            ('contact', 0, 12.0, (5.0, 10.0, 15.0)),
        )
        for rpm in speeds
    ]
    first = trends(SCREW, LAW, rows)[0]
    assert first.rolling is not None
    assert first.standing is not None
    assert first.rolling.text.startswith('500 rev/min')
    assert first.rolling.agrees == 'yes'
    assert first.standing.text.startswith('12 rev/min')
    assert first.standing.agrees == 'no'


def test_nuts_share_the_contacts_under_preload():
    """A relieved nut has its own rows under load."""
    rows = [
        replace(BASE, kind='contact', nut=nut, load=load)
        for nut, load in (('loaded', 0.0), ('loaded', 9.0), (RELIEVED, 9.0))
    ]
    assert [len(nut_rows(rows, nut)) for nut in ('loaded', 'relieved')] == [2, 2]


def test_table_of_trends():
    """A row for each trend, empty where a model says nothing."""
    yes, no = judged.Reading(text='a', agrees='yes'), judged.Reading(text='b', agrees='no')
    every = [
        judged.Trend(name='one', published='falls', standing=no, rolling=yes),
        judged.Trend(name='two', published='rises', standing=None, rolling=no),
    ]
    expected = ['| one | falls | b | no | a | yes |', '| two | rises |  |  | b | no |']
    assert judged.trend_table(every).splitlines()[2:] == expected
