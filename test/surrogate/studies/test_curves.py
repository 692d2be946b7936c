# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tasks, rows and their files, curves and crossings of the comparison with the study."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.law import VERSION
from surrogate.parameters import load_lubricant, load_screw
from surrogate.studies import curves
from surrogate.studies.curves import inputs_hash, StudyRow
from surrogate.studies.solve import known_inputs, run_study
from surrogate.studies.tasks import FIGURES, RELIEVED, SMOOTH, StudyTask, tasks
from surrogate.tasks.table import read_table, write_table
from surrogate.tasks.workers import open_pool

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
BASE = StudyRow(inputs='a', kind='contact', rpm=5.0, load=0.0, draw=0, status='CONVERGED', rcs=0.1)


def test_every_task_is_asked_once_and_more_draws_are_more_rough_contacts(refused):
    """Figures share their solves; the whole screw has no draws."""
    wanted = tasks(FIGURES, 6)
    assert len({task.key for task in wanted}) == len(wanted)
    assert len(tasks(('6b',), 1)) == 12
    few, many = (tasks(('trends',), draws) for draws in (2, 6))
    more = {task.key for task in many} - {task.key for task in few}
    assert len(more) == len(many) - len(few) > 4
    assert {task.kind for task in many if task.key in more} == {'contact'}
    assert {task.draw for task in many if task.kind == 'screw'} == {SMOOTH}
    refused('figure_5', tasks, ('5',), 6)
    refused('draws_0', tasks, ('6b',), 0)


def test_rows_come_back_by_their_key_and_broken_tables_are_refused(tmp_path, refused):
    """With NaN and negative draws."""
    rows, path = (
        [BASE, replace(BASE, draw=SMOOTH, nut=RELIEVED, load=500.0)],
        tmp_path / 'paper.csv',
    )
    write_table(path, StudyRow, rows, digits=6)
    first, second = read_table(path, StudyRow)
    assert (first.key, second.key) == (BASE.key, rows[1].key)
    assert (first.rcs, first.draw, first.status) == (0.1, 0, 'CONVERGED')
    assert math.isnan(first.friction_torque)
    task = StudyTask(kind='contact', rpm=5.0, load=0.0, draw=0)
    assert task.key == BASE.key == 'contact_loaded_5rpm_0N_draw0'
    path.write_text('inputs,kind,rpm\na,contact,fast\n')
    refused('paper_cannot_read', read_table, path, StudyRow)


def test_another_screw_is_another_study():
    """The hash covers both datasheets, and the version of the law where it is given."""
    assert len({inputs_hash(SCREW, OIL, law) for law in ('', VERSION, 'another')}) == 3
    known = {'screw': inputs_hash(SCREW, OIL, VERSION), 'contact': inputs_hash(SCREW, OIL)}
    assert known_inputs() == known
    changed = replace(OIL, viscosity=1.01 * OIL.viscosity)
    assert inputs_hash(SCREW, OIL) == inputs_hash(SCREW, OIL)
    assert inputs_hash(SCREW, OIL) != inputs_hash(SCREW, changed)


def test_a_study_goes_on_where_it_stopped(tmp_path):
    """What is kept is not solved again."""
    wanted = tasks(('6b',), 1)
    told = []
    with open_pool(1) as pool:
        run_study(tmp_path, wanted[:2], pool, lambda *now: told.append(now))
        assert told == [(1, 2), (2, 2)]
        told.clear()
        rows = run_study(tmp_path, wanted[:2], pool, lambda *now: told.append(now))
        assert not told
        assert list(rows) == [task.key for task in wanted[:2]]
        run_study(tmp_path, wanted[1:3], pool, lambda *now: told.append(now))
        assert len(told) == 1
    table = read_table(tmp_path / 'paper.csv', StudyRow)
    assert [row.key for row in table] == [task.key for task in wanted[1:3]]


def test_mean_and_spread_over_draws():
    """Standard deviation and error of two draws by hand; rows that failed are left out."""
    rows = [
        replace(BASE, draw=draw, rpm=rpm, rcs=rcs)
        for draw, rpm, rcs in ((0, 5.0, 0.1), (1, 5.0, 0.3), (0, 20.0, 0.0), (1, 20.0, 0.02))
    ]
    rows.append(replace(BASE, draw=2, status='STALLED', rcs=9.0))
    found = curves.curve(rows, 'rpm', 'rcs', kind='contact', rough=True)
    np.testing.assert_allclose(found.mean, [0.2, 0.01])
    np.testing.assert_allclose(found.deviation, [0.1 * math.sqrt(2), 0.01 * math.sqrt(2)])
    np.testing.assert_allclose(found.error, [0.1, 0.01])
    assert found.draws == 2
    assert not curves.pick(rows, rough=False)
    rows = [replace(row, load=9.0 * (row.rpm == 20.0), rpm=5.0) for row in rows]
    error = curves.paired_error(rows, 'rcs', 9.0, kind='contact')
    assert error == pytest.approx(0.09)  # changes of -0.1 and -0.28


def line(at, mean):
    nothing = np.full(len(at), math.nan)
    return curves.Curve(
        at=np.array(at), mean=np.array(mean), deviation=nothing, error=nothing, draws=1
    )


def test_crossing_by_logarithms_and_the_map_is_a_grid():
    """Between 0.1 and 0.001 half way in the logarithm; NaN where it never passes."""
    assert curves.crossing(line([10.0, 40.0], [0.1, 0.001]), 0.01) == pytest.approx(20.0)
    assert curves.crossing(line([10.0, 40.0], [0.01, 0.0]), 0.01) == pytest.approx(10.0)
    assert math.isnan(curves.crossing(line([10.0, 40.0], [0.1, 0.02]), 0.01))
    assert math.isnan(curves.crossing(line([10.0, 40.0], [0.001, 0.0]), 0.01))
    rows = [
        replace(BASE, kind='screw', load=load, rpm=rpm, rcs=load * rpm)
        for load in (50.0, 100.0)
        for rpm in (5.0, 10.0)
    ]
    rows[1] = replace(rows[1], status='nut: stalled')
    rows.append(replace(rows[3], nut=RELIEVED, rcs=1200.0))
    speeds, loads, values = curves.grid(rows, 'rcs')
    np.testing.assert_array_equal(speeds, [5.0, 10.0])
    np.testing.assert_array_equal(loads, [50.0, 100.0])
    np.testing.assert_array_equal(values, [[250.0, math.nan], [500.0, 1000.0]])
