# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The worker beside the judgement: rows become cells on the disk, failures become sentences."""

import contextlib
import dataclasses
import functools
import math
import sqlite3

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.assess import HealthSettings
from ballscrew_monitor.health.collect import Collected
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.keeper import HealthKeeper
from ballscrew_monitor.health.records import Condition, LoadSource
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import FILE, HealthStore, read_health
from ballscrew_monitor.judge.inputs import DERIVED
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.node import health_worker
from ballscrew_monitor.node.health_worker import Gatherer, HealthWorker, Job
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.records import as_array

NOON = 20_000 * DAY + DAY // 2
NOTHING = Collected([], [])


@pytest.fixture(name='surface', scope='module')
def loaded_surface():
    return Surface.load(shipped_surface())


@pytest.fixture(name='make')
def make_worker(tmp_path):
    """Return a function that makes a worker of a folder, which is closed at the end."""
    with contextlib.ExitStack() as stack:

        def make(is_held=lambda: True):
            worker = HealthWorker(HealthStore(tmp_path), is_held)
            stack.callback(worker.close)
            return worker

        yield make


def rows(seconds, *, start=NOON, **changes):
    """Return rows of a steady motion at 100 Hz."""
    row = Row(
        speed=50.0,
        axial_load=500.0,
        temperature=313.0,
        motor_torque=0.5,
        axial_load_source=1,
        temperature_source=1,
        motor_torque_source=1,
        direction=1,
        validity=1,
        friction_torque=0.2,
    )
    return [
        dataclasses.replace(row, stamp=start + at * SECOND // 100, **changes)
        for at in range(round(100 * seconds))
    ]


def gathered(surface, some, settings=None, **options):
    gatherer = Gatherer(surface, settings)
    for one in some:
        gatherer.take(one)
    return gatherer.hand_over(surface, **options)


@pytest.fixture
def job(usual_limits):
    """Return what makes a job of an axis."""

    def make_job(worker, surface, collected=NOTHING, **changes):
        values = {
            'keeper': HealthKeeper('x', worker.store),
            'axis': 'x',
            'now': NOON,
            'collected': collected,
            'surface': surface,
            'settings': HealthSettings(limits=usual_limits),
            'policy': WarningPolicy.BOTH,
            'assesses': False,
        }
        return Job(**values | changes)

    return make_job


def test_rows_end_as_cells_and_motion_on_the_disk(job, make, surface, tmp_path):
    worker = make()
    found = gathered(surface, [None, *rows(3.0)], rows_end=True)
    assert worker.put(job(worker, surface, found))
    worker.close()
    kept = read_health(tmp_path)['x']
    (cell,) = kept.cells
    assert (cell.stretches, cell.motor_torque) == (1, pytest.approx(0.5))
    (one,) = kept.spectrum
    assert one.time == pytest.approx(2.99)
    assert worker.problem == ''
    assert {path.name for path in tmp_path.iterdir()} == {FILE}


def test_an_axis_without_process_force_has_its_free_load(surface):
    free = GatherSettings(free_load=-200.0, always_free=True)
    derived = rows(3.0, axial_load_source=DERIVED)
    (stretch,) = gathered(surface, derived, free, rows_end=True).stretches
    assert (stretch.load_source, stretch.axial_load) == (LoadSource.FREE, -200.0)


def test_motion_that_goes_on_is_handed_over_and_its_stretch_later(surface):
    gatherer = Gatherer(surface)
    some = rows(4.0)
    for one in some[:200]:
        gatherer.take(one)
    first = gatherer.hand_over(surface)
    for one in some[200:]:
        gatherer.take(one)
    gatherer.give_back(first)
    found = gatherer.hand_over(surface, rows_end=True)
    assert first.stretches == []
    assert [one.duration > 3.0 for one in found.stretches] == [True]
    assert sum(one.time for one in found.bins) == pytest.approx(3.99)
    assert gatherer.hand_over(surface) == NOTHING


@pytest.mark.parametrize('most', [150, 10_000])
def test_arrays_of_rows_are_added_up_as_the_rows_one_by_one(surface, monkeypatch, most):
    """Whatever waits is added up before a single row, and before it is handed over."""
    monkeypatch.setattr(health_worker, 'MOST_ROWS', most)
    some = rows(4.0)
    gatherer = Gatherer(surface)
    for begin in range(0, 300, 10):
        end = begin + 10
        gatherer.take_many(np.concatenate([as_array(row) for row in some[begin:end]]))
    for row in some[300:]:
        gatherer.take(row)
    assert gatherer.hand_over(surface, rows_end=True) == gathered(surface, some, rows_end=True)


def test_a_defect_of_gathering_is_a_sentence_and_no_more_is_taken(surface, says):
    gatherer = Gatherer(surface)
    gatherer.take('no row')
    assert gatherer.defect == says('no_row')
    for one in rows(2.0):
        gatherer.take(one)
    assert gatherer.hand_over(surface, rows_end=True) == NOTHING


def test_an_assessment_is_done_beside_and_not_known_without_motion(job, make, surface, wait_for):
    worker = make()
    worker.put(job(worker, surface, assesses=True))
    wait_for(lambda: worker.done, 'the assessment')
    health, message = worker.done[0]
    assert (health.condition, message.condition) == (Condition.UNKNOWN, 0)
    assert (message.verdict, message.surface_id) == (health.verdict, surface.base_sha256[:16])
    assert 'not known' in health.verdict
    assert math.isnan(health.quantities[0].value)


def test_a_folder_of_another_node_is_left_alone_until_it_is_ours(
    job, make, surface, wait_for, tmp_path, says
):
    held = []
    worker = make(lambda: bool(held))
    keeper = HealthKeeper('x', worker.store)
    ask = functools.partial(job, worker, surface, keeper=keeper)
    worker.put(ask(gathered(surface, rows(3.0), rows_end=True)))
    wait_for(lambda: worker.problem, 'the sentence')
    assert worker.problem == says('not_held', file=tmp_path / FILE, folder=tmp_path)
    assert not (tmp_path / FILE).exists()
    held.append(True)
    worker.put(ask())
    worker.close()
    assert worker.problem == ''
    assert [one.stretches for one in read_health(tmp_path)['x'].cells] == [1]


@pytest.mark.parametrize('content', [b'no database' * 1000, None], ids=['damaged', 'version'])
def test_a_store_that_no_node_has_left_is_set_aside(
    job, make, surface, wait_for, tmp_path, content
):
    if content is None:
        with contextlib.closing(sqlite3.connect(tmp_path / FILE)) as database:
            database.execute('PRAGMA user_version = 7')
    else:
        (tmp_path / FILE).write_bytes(content)
    worker = make()
    worker.put(job(worker, surface, gathered(surface, rows(3.0), rows_end=True), assesses=True))
    wait_for(lambda: worker.done, 'the assessment')
    (said,) = worker.damage
    assert said.endswith(f'moved to {FILE}.aside')
    assert worker.done[0][0].condition is Condition.UNKNOWN
    assert (tmp_path / f'{FILE}.aside').exists()


def test_whatever_fails_in_the_thread_is_a_sentence_and_it_goes_on(
    job, make, surface, wait_for, monkeypatch, says
):
    def fail(self, *args, **named):
        raise ZeroDivisionError('by zero')

    worker = make()
    with monkeypatch.context() as patch:
        patch.setattr(HealthKeeper, 'assess', fail)
        worker.put(job(worker, surface, assesses=True))
        wait_for(lambda: worker.problem, 'the sentence')
    assert worker.problem == says('defect')
    worker.put(job(worker, surface, assesses=True))
    wait_for(lambda: worker.done, 'the assessment')
    wait_for(lambda: worker.problem == '', 'the end of it')


def test_more_jobs_than_may_wait_are_refused(job, tmp_path, surface, monkeypatch):
    monkeypatch.setattr(health_worker, 'MOST_JOBS', 2)
    worker = HealthWorker(HealthStore(tmp_path), lambda: True)
    with worker.store.lock:  # the thread waits for the store
        taken = [worker.put(job(worker, surface)) for _ in range(5)]
    worker.close()
    assert (taken[0], taken[-1]) == (True, False)
