# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The executor beneath a pool of processes: calls, failures, losses, its end."""

import math
import operator
import os

import pytest
from surrogate.tasks.spawned import apart, LostWorker, SpawnedWorkers
from surrogate.tasks.worker import tell_share

DEADLINE = 600.0  # [s] which only ends a hang


@pytest.fixture
def began():
    return []


@pytest.fixture
def workers(began):
    with SpawnedWorkers(2, lambda arguments, worker: began.append((arguments, worker))) as pool:
        yield pool


def test_calls_return_and_raise_and_map_keeps_the_order(workers, began, refused):
    """What the function returns or raises is what the future has."""
    assert workers.submit(math.sqrt, 9.0).result(DEADLINE) == 3.0
    refused('math_domain_error', workers.submit(math.sqrt, -1.0).result, DEADLINE)
    assert [arguments for arguments, _ in began] == [(9.0,), (-1.0,)]
    assert list(workers.map(operator.neg, range(20))) == [-n for n in range(20)]


def test_a_lost_process_is_the_loss_of_its_call(workers):
    with pytest.raises(LostWorker):
        workers.submit(os._exit, 3).result(DEADLINE)
    assert workers.submit(abs, -1).result(DEADLINE) == 1


def refuse(arguments, _):
    """Raise what the loss of a process raises, too."""
    if arguments:
        raise BrokenPipeError('nobody reads')


@pytest.mark.parametrize('listeners', [(refuse,), (lambda *_: None, refuse)])
def test_what_a_listener_raises_is_no_lost_process(listeners, refused):
    """The call has its error, the same process goes on with the next."""
    with SpawnedWorkers(1, *listeners) as pool:
        before = pool.submit(os.getpid).result(DEADLINE)
        refused('nobody_reads', pool.submit(tell_share, 0.5).result, DEADLINE)
        assert pool.submit(os.getpid).result(DEADLINE) == before


def test_what_cannot_be_handed_over_is_that_call_alone(workers, refused):
    """A function without a name, arguments by keyword, a result that has no bytes."""
    with pytest.raises(Exception, match='pickle'):
        workers.submit(lambda: 1).result(DEADLINE)
    refused('by_position', workers.submit, abs, x=1)
    with pytest.raises(Exception, match='pickle'):
        workers.submit(memoryview, b'abc').result(DEADLINE)
    assert workers.submit(abs, -1).result(DEADLINE) == 1


def test_the_end_cancels_what_was_not_begun(began, refused):
    """No call is left that is neither done nor cancelled, and none is taken any more."""
    pool = SpawnedWorkers(1, lambda arguments, worker: began.append(worker))
    first = pool.submit(abs, -1)
    assert first.result(DEADLINE) == 1
    later = [pool.submit(abs, number) for number in range(50)]
    pool.shutdown()
    assert all(future.done() for future in later)
    assert later[-1].cancelled() or later[-1].exception() or later[-1].result() == 49
    refused('have_been_ended', pool.submit, abs, 1)


def test_the_environment_is_as_it_was_afterwards(monkeypatch):
    """One thread for those that start meanwhile, and no trace of it."""
    monkeypatch.setenv('OMP_NUM_THREADS', '7')
    monkeypatch.delenv('MKL_NUM_THREADS', raising=False)
    with apart():
        assert os.environ['OMP_NUM_THREADS'] == os.environ['MKL_NUM_THREADS'] == '1'
    assert os.environ['OMP_NUM_THREADS'] == '7'
    assert 'MKL_NUM_THREADS' not in os.environ
