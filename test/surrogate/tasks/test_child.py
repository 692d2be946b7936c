# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Child processes: what they are given, what is heard of them, and how they end."""

import os
from pathlib import Path
import select
import signal
import subprocess
import sys

import pytest
from surrogate.tasks.child import (
    one_thread_environment,
    path_to_this_code,
    result_apart,
    start,
    stop,
    Workers,
)

DEADLINE = 600.0  # [s] which only ends a hang
ROOT = Path(__file__).resolve().parents[3]
WAITS = """
import signal, sys
print('here', flush=True)
signal.pause()
"""
STUBBORN = """
import signal, subprocess, sys
signal.signal(signal.SIGINT, signal.SIG_IGN)
print(subprocess.Popen([sys.executable, '-c', 'import signal; signal.pause()']).pid, flush=True)
signal.pause()
"""
DEADLY = """
import os, signal
from surrogate.files import InputError
class Panic(BaseException):
    pass
def abort(inputs):
    os.abort()
def panic(inputs):
    raise Panic('capacity overflow')
def overflow(inputs):
    os.kill(os.getpid(), signal.SIGSEGV)
def refuse(inputs):
    raise InputError(inputs['sentence'])
def fill(inputs):
    return {'size': len(bytearray(inputs['size']))}
"""
PARENT = """
import subprocess, sys
from surrogate.tasks.child import start, Workers
child = start('waits', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
child.stdout.readline()
with Workers(1) as workers:
    workers.submit('a', 'waits:nothing', {})
    ((_, heard),) = workers.wait(600.0)
    print(child.pid, heard['begun'].partition('/')[2], flush=True)
    sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def modules(tmp_path, monkeypatch):
    """Let children find some modules."""
    monkeypatch.setenv('PYTHONPATH', f'{ROOT}{os.pathsep}{tmp_path}')
    (tmp_path / 'waits.py').write_text(WAITS)
    (tmp_path / 'stubborn.py').write_text(STUBBORN)
    (tmp_path / 'deadly.py').write_text(DEADLY)


@pytest.fixture
def workers():
    with Workers(1) as made:
        yield made


def frames_of(workers, name):
    """Return the frames of a task up to its end."""
    frames = []
    while not frames or not {'result', 'lost'} & set(frames[-1]):
        frames += [frame for other, frame in workers.wait(DEADLINE) if other == name]
    return frames


def run(workers, task, inputs):
    """Return the process that was at a task, and the frame of its end."""
    workers.submit(task, task, inputs)
    begun, *_, end = frames_of(workers, task)
    return int(begun['begun'].partition('/')[2]), end


def test_a_worker_goes_on_with_the_next_task_and_a_lost_one_is_replaced(workers):
    """What a task prints is no frame; a failure is a sentence and keeps the process."""
    first, end = run(workers, 'math:sqrt', 9.0)
    assert (end['result'], end['sentence']) == (3.0, '')
    for task, inputs in (('builtins:print', 'a frame'), ('math:sqrt', -1.0)):
        process, end = run(workers, task, inputs)
        assert (process, end['result']) == (first, None)
    assert end['sentence'] == 'ValueError: math domain error'
    assert run(workers, 'os:_exit', 3) == (first, {'lost': 'ended with exit code 3'})
    second, end = run(workers, 'builtins:abs', -1)
    assert (second != first, end['result']) == (True, 1)


def test_a_killed_worker_is_told(workers):
    workers.submit('a', 'waits:nothing', {})
    (begun,) = workers.wait(DEADLINE)
    os.kill(int(begun[1]['begun'].partition('/')[2]), signal.SIGKILL)
    assert frames_of(workers, 'a') == [{'lost': 'was killed by signal 9'}]


def test_nothing_is_heard_of_a_task_that_was_ended(workers):
    """Nor of one that is asked to end by itself, unless it heeds that."""
    workers.submit('a', 'waits:nothing', {})
    ((name, begun),) = workers.wait(DEADLINE)
    workers.submit('b', 'builtins:abs', -1)
    workers.cancel('a')
    workers.cancel('nobody')
    pid = int(begun['begun'].partition('/')[2])
    ending = os.pidfd_open(pid)
    workers.kill(name)
    assert select.select([ending], [], [], 0.0)[0]
    os.close(ending)
    assert workers.wait(0.0) == []
    assert [sorted(frame)[0] for frame in frames_of(workers, 'b')] == ['begun', 'result']


def test_a_worker_that_cannot_be_started_is_lost():
    def fail(hear):
        raise OSError(11, 'Resource temporarily unavailable')

    with Workers(2, fail) as workers:
        workers.submit('a', 'math:sqrt', 1.0)
        begun, lost = frames_of(workers, 'a')
    assert begun['begun'].endswith('/-')
    assert lost == {'lost': 'cannot be started, Resource temporarily unavailable'}


@pytest.mark.parametrize(
    ('task', 'ending'),
    [
        ('abort', 'was killed by signal 6'),
        ('overflow', 'was killed by signal 11'),
        ('panic', 'ended with exit code 1'),
    ],
)
def test_a_task_that_ends_its_process_is_a_sentence(capfd, refused, task, ending):
    with refused('lost', ending=ending):
        result_apart(f'deadly:{task}', {}, memory=10**9, failure='log a.xlsx cannot be read')
    assert capfd.readouterr() == ('', '')


def test_a_task_apart_has_so_much_memory_and_its_refusal_is_its_own(refused):
    asked = {'memory': 500_000_000, 'failure': 'log a.xlsx cannot be read'}
    result = result_apart('deadly:fill', {'size': 100_000_000}, **asked)
    assert result == {'size': 100_000_000}
    with refused('no_memory'):
        result_apart('deadly:fill', {'size': 1_000_000_000}, **asked)
    with refused('of_task'):
        result_apart('deadly:refuse', {'sentence': 'log a.xlsx lists no sheet'}, **asked)


def test_no_child_outlives_its_parent():
    """The parent is killed and can clean up nothing: one child has a pipe, one reads nothing."""
    with subprocess.Popen(
        [sys.executable, '-c', PARENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as parent:
        endings = [os.pidfd_open(int(pid)) for pid in parent.stdout.readline().split()]
        parent.kill()
        for ending in endings:
            assert select.select([ending], [], [], DEADLINE)[0], 'a child is still there'
            os.close(ending)
    assert len(endings) == 2


def test_a_child_is_stopped_with_all_that_it_started():
    """It is asked first, and killed if it does not heed that."""
    asked = ((signal.SIGTERM, DEADLINE), (signal.SIGKILL, DEADLINE))
    process = start('waits', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
    assert process.stdout.readline() == b'here\n'
    assert stop(process, asked) == -signal.SIGTERM
    process.stdout.close()
    told = ((signal.SIGINT, 0.01), (signal.SIGKILL, DEADLINE))
    process = start('stubborn', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
    ending = os.pidfd_open(int(process.stdout.readline()))
    assert stop(process, told) == -signal.SIGKILL
    assert select.select([ending], [], [], DEADLINE)[0]
    os.close(ending)
    process.stdout.close()


def test_a_child_is_of_this_very_code_and_runs_one_thread(monkeypatch):
    monkeypatch.setenv('PYTHONPATH', '/somewhere')
    assert path_to_this_code().split(os.pathsep) == [str(ROOT), '/somewhere']
    assert path_to_this_code(['/a', '', '/a']).split(os.pathsep) == [str(ROOT), '/a']
    assert (ROOT / 'ballscrew_monitor').is_dir()
    monkeypatch.setenv('LD_LIBRARY_PATH', '/ros')
    monkeypatch.setenv('OMP_NUM_THREADS', '7')
    made = one_thread_environment()
    assert made['PYTHONPATH'] == path_to_this_code()
    assert (made['OMP_NUM_THREADS'], 'LD_LIBRARY_PATH' in made) == ('1', False)
    assert one_thread_environment(wheels=True)['LD_LIBRARY_PATH'] == '/ros'
