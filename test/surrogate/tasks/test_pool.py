# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tasks on real processes: same results for any workers, and none lost with its worker."""

import contextlib
import importlib
import logging
import os
from pathlib import Path
import select
import signal
import subprocess
import sys
import threading

import pytest
from surrogate.surface import SurfaceError
from surrogate.tasks import child
from surrogate.tasks import workers as task_workers
from surrogate.tasks.pool import MOST_TRIES, run_tasks
from surrogate.tasks.store import TaskStore
from surrogate.tasks.worker import worker_name
from surrogate.tasks.workers import open_pool

DEADLINE = 600.0  # [s] which only ends a hang
HALF_MADE = '.half_made'
TASKS = (
    f"""
HALF_MADE = {HALF_MADE!r}
"""
    + """
import fcntl, math, os, signal
from surrogate.files import InputError
from surrogate.tasks.worker import tell_share

def root(inputs):
    return {'root': math.sqrt(inputs['x']), 'chain': [math.exp(-inputs['x']), 1]}

def refuse(inputs):
    raise InputError('x is -1, allowed is 0 or more')

def say_hello_and_wait(inputs):
    half_made = inputs['hello'] + HALF_MADE
    open(half_made, 'w').close()
    try:
        with open(inputs['hello'], 'w') as hello:
            hello.write(str(os.getpid()))
        with open(inputs['gate']) as gate:
            gate.read()
    finally:
        os.unlink(half_made)
    return {'done': True}

def say_hello_and_stay(inputs):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    return say_hello_and_wait(inputs)

def takes_frames(number):
    try:
        is_pipe = os.readlink(f'/proc/self/fd/{number}').startswith('pipe:')
        return is_pipe and fcntl.fcntl(number, fcntl.F_GETFL) & os.O_WRONLY
    except OSError:
        return False

def send_half(inputs):
    if inputs['cut']:
        pipe = max(filter(takes_frames, range(3, 100)))
        os.write(pipe, b'{"result": {"text": "xxx')
        os.kill(os.getpid(), signal.SIGKILL)
    return {'text': 1000 * 'x'}

def tell(inputs):
    for share in (0.25, 0.251, 0.5):
        tell_share(share)
    return {}

def kill_worker(inputs):
    if inputs['kill']:
        os.kill(os.getpid(), signal.SIGKILL)
    return {'x': inputs['x']}

def describe(inputs):
    import numba
    ignored = signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    return {'threads': numba.get_num_threads(), 'blas': os.environ['OMP_NUM_THREADS'],
            'ignores': ignored}
"""
)
PARENT = """
import signal
import sys
from surrogate.tasks.pool import run_tasks
from surrogate.tasks.workers import open_pool
import pool_tasks

if __name__ == '__main__':
    # A shell may have started the tests deaf to Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    import polars  # takes Ctrl-C over, and lets the system resume the wait that it interrupts
    *hellos, gate = sys.argv[1:]
    inputs = {hello: {'hello': hello, 'gate': gate} for hello in hellos}
    with open_pool(2) as pool:
        run_tasks(pool, pool_tasks.say_hello_and_wait, inputs)
"""


@pytest.fixture(scope='module')
def tasks(tmp_path_factory):
    """Return a module of tasks that workers can import too."""
    folder = tmp_path_factory.mktemp('tasks')
    (folder / 'pool_tasks.py').write_text(TASKS)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        yield importlib.import_module('pool_tasks')
    del sys.modules['pool_tasks']


@pytest.fixture(scope='module')
def pool(tasks):
    with open_pool(2) as workers:
        yield workers


@pytest.fixture
def pipes(tmp_path):
    """Return named pipes: a task says hello with its process number, then waits at the gate."""
    names = {name: str(tmp_path / name) for name in ('hello', 'second', 'gate')}
    for path in names.values():
        os.mkfifo(path)
    return names


def read(path):
    """Return what one writer says on a named pipe."""
    with open(path) as pipe:
        return pipe.read()


def killer(pipes, seen):
    """Kill the worker that begins the waiting task first, and let the second one pass."""

    def work():
        seen.append(int(read(pipes['hello'])))
        os.kill(seen[0], signal.SIGKILL)
        seen.append(int(read(pipes['hello'])))
        open(pipes['gate'], 'w').close()

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    return thread


def numbers(count):
    return {f'task {number}': {'x': number / 7} for number in range(count)}


def test_results_do_not_depend_on_workers(tasks, pool):
    found = []
    with open_pool(1) as alone:
        both = [run_tasks(workers, tasks.root, numbers(20)) for workers in (alone, pool)]
    for outcomes in both:
        assert list(outcomes) == list(numbers(20))
        found.append([outcome.result for outcome in outcomes.values()])
        expected = {worker_name().partition('/')[0]}
        assert {outcome.worker.partition('/')[0] for outcome in outcomes.values()} == expected
    assert found[0] == found[1]
    assert found[0] == [tasks.root(inputs) for inputs in numbers(20).values()]


def test_a_failed_task_is_a_sentence(tasks, pool):
    """A refusal keeps its sentence, any other error its name; the rest is done."""
    outcomes = run_tasks(pool, tasks.root, {**numbers(3), 'bad': {'x': -1.0}, 'none': {}})
    refused = run_tasks(pool, tasks.refuse, {'one': {}})['one']
    assert outcomes['bad'].result is None
    assert outcomes['bad'].sentence == 'ValueError: math domain error'
    assert outcomes['none'].sentence == "KeyError: 'x'"
    assert [outcome.sentence for outcome in outcomes.values()].count('') == 3
    assert refused.sentence == 'x is -1, allowed is 0 or more'


@pytest.mark.parametrize('dask', [None, 'local'])
def test_the_task_of_a_killed_worker_is_done_elsewhere(tasks, pipes, dask):
    """SIGKILL at work: another process does the task, and the outcome names both."""
    if dask:
        pytest.importorskip('distributed')
    seen: list[int] = []
    thread = killer(pipes, seen)
    with open_pool(2, dask) as pool:
        outcome = run_tasks(pool, tasks.say_hello_and_wait, {'it': pipes})['it']
        rest = run_tasks(pool, tasks.root, numbers(20))
    thread.join(DEADLINE)
    host = worker_name().partition('/')[0]
    assert outcome.result == {'done': True}
    assert outcome.lost == (f'{host}/{seen[0]}',)
    assert outcome.worker == f'{host}/{seen[1]}'
    assert len(set(seen)) == 2
    assert not any(other.sentence for other in rest.values())


def test_tasks_tell_how_far_they_are(tasks):
    """By their names and in order, and not for every small step."""
    told: list[tuple[str, float]] = []
    with open_pool(2, on_share=lambda *share: told.append(share)) as pool:
        outcomes = run_tasks(pool, tasks.tell, {'a': {}, 'b': {}, 'c': {}})
    assert [outcome.result for outcome in outcomes.values()] == [{}, {}, {}]
    for name in 'abc':
        assert [share for whose, share in told if whose == name] == [0.25, 0.5]


def test_users_of_one_cluster_do_not_hear_of_each_others_tasks(tasks, dask_address):
    """What the scheduler tells comes in order: the tasks of others before these are done."""
    told: list[str] = []
    with (
        open_pool(dask=dask_address, on_share=lambda name, _: told.append(name)) as one,
        open_pool(dask=dask_address) as other,
    ):
        assert run_tasks(other, tasks.tell, {'of another': {}})['of another'].result == {}
        assert run_tasks(one, tasks.tell, {'own': {}})['own'].result == {}
        assert one.wait(0.0) == []
    assert 'of another' not in told


CLUSTER = """
import distributed, sys
if __name__ == '__main__':
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1,
                                  dashboard_address='127.0.0.1:0') as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def test_a_scheduler_that_is_killed_ends_in_a_sentence_alone(tasks, tmp_path, monkeypatch):
    """No traceback of its client stands beside it."""
    pytest.importorskip('distributed')
    records: list[logging.LogRecord] = []
    monkeypatch.setattr(logging.getLogger('distributed.client'), 'handle', records.append)
    script = tmp_path / 'cluster.py'
    script.write_text(CLUSTER)
    paths = os.pathsep.join([str(Path(tasks.__file__).parent), *sys.path])
    with subprocess.Popen(
        [sys.executable, script],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, 'PYTHONPATH': paths},
        text=True,
    ) as cluster:
        try:
            with open_pool(dask=cluster.stdout.readline().strip()) as pool:
                with pytest.raises(SurfaceError, match='the scheduler was lost; run the command'):
                    run_tasks(
                        pool, tasks.root, numbers(300), report=lambda outcome: cluster.kill()
                    )
        finally:
            cluster.kill()
    assert records == []


def test_what_an_earlier_run_tells_late_is_not_heard(tasks, monkeypatch):
    """Names that are not of this run count for none of its tasks."""
    with open_pool(1) as pool:
        late = [('of another', {'begun': 'host/1'}), ('of another', {'result': None})]
        wait = pool.wait
        monkeypatch.setattr(pool, 'wait', lambda seconds: late + wait(seconds))
        outcomes = run_tasks(pool, tasks.root, numbers(1))
    assert list(outcomes) == ['task 0']
    assert outcomes['task 0'].lost == ()


def test_a_task_that_kills_its_workers_ends_as_a_sentence(tasks, pool):
    """Also by half a message in a pipe; given up after a few tries, it costs no other result."""
    inputs = {f'{one}': {'x': one, 'kill': one == 3, 'cut': one == 3} for one in range(10)}
    for task, result in (
        (tasks.kill_worker, lambda number: {'x': number}),
        (tasks.send_half, lambda number: {'text': 1000 * 'x'}),
    ):
        outcomes = run_tasks(pool, task, inputs)
        assert outcomes['3'].sentence == f'its worker was lost {MOST_TRIES} times'
        assert len(set(outcomes['3'].lost)) == MOST_TRIES
        for name, outcome in outcomes.items():
            assert outcome.result == (None if name == '3' else result(int(name)))


def test_a_module_that_ends_its_process_is_told(tmp_path, monkeypatch):
    """Every process that imports it ends: a sentence, and no endless loop."""
    (tmp_path / 'deadly_tasks.py').write_text(
        f'import os\nif os.getpid() != {os.getpid()}:\n    os._exit(3)\n'
        'def task(inputs):\n    return {}\n'
    )
    monkeypatch.syspath_prepend(tmp_path)
    import deadly_tasks

    with open_pool(1) as pool:
        outcome = run_tasks(pool, deadly_tasks.task, {'a': {}})['a']
    assert outcome.sentence == f'its worker was lost {MOST_TRIES} times'


def test_a_module_that_workers_do_not_have_is_told(tmp_path, monkeypatch, says):
    """The other tasks go on."""
    (tmp_path / 'gone_tasks.py').write_text('def task(inputs):\n    return {}\n')
    with monkeypatch.context() as here:
        here.syspath_prepend(tmp_path)
        import gone_tasks
    with open_pool(1) as pool:
        outcome = run_tasks(pool, gone_tasks.task, {'a': {}})['a']
    assert outcome.sentence == says('module_named_gone_tasks')


def test_kept_results_are_not_solved_again(tasks, pool, tmp_path):
    """The second run solves what has failed alone; both give the same results."""
    inputs = {**numbers(5), 'bad': {'x': -1.0}}
    told: list[str] = []
    with TaskStore(tmp_path / 'map.npz', 'test 1') as store:
        first = run_tasks(pool, tasks.root, inputs, store=store)
    with TaskStore(tmp_path / 'map.npz', 'test 1') as store:
        second = run_tasks(
            pool, tasks.root, inputs, store=store, report=lambda outcome: told.append(outcome.name)
        )
    assert not any(outcome.stored for outcome in first.values())
    assert [name for name, outcome in second.items() if not outcome.stored] == ['bad']
    assert [o.result for o in first.values()] == [o.result for o in second.values()]
    assert sorted(told) == sorted(inputs)


def test_a_worker_has_one_thread_and_ignores_ctrl_c(tasks, pool):
    """Workers share the cores, and Ctrl-C is for the parent."""
    found = run_tasks(pool, tasks.describe, {'a': {}})['a']
    assert found.result == {'threads': 1, 'blas': '1', 'ignores': True}


@contextlib.contextmanager
def parent(tmp_path, tasks, pipes):
    """Start a program with two workers at work, in a session of its own."""
    script = tmp_path / 'parent.py'
    script.write_text(PARENT)
    path = os.pathsep.join(
        [str(Path(tasks.__file__).parent), str(Path(child.__file__).parents[2])]
    )
    with subprocess.Popen(
        [sys.executable, str(script), *pipes.values()],
        env={**os.environ, 'PYTHONPATH': path},
        start_new_session=True,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_outlives_its_parent(tasks, tmp_path, pipes, number):
    """
    Ctrl-C reaches the whole group, a kill the parent alone: all are gone, no one chatters.

    What they had half made is gone, too.

    """
    with parent(tmp_path, tasks, pipes) as process:
        workers = [int(read(pipes[name])) for name in ('hello', 'second')]
        endings = [os.pidfd_open(pid) for pid in workers]
        if number == signal.SIGINT:
            os.killpg(process.pid, number)
        else:
            process.send_signal(number)
        for ending in endings:
            assert select.select([ending], [], [], DEADLINE)[0], 'a worker is still there'
            os.close(ending)
        errors = process.communicate(timeout=DEADLINE)[1]
    assert process.returncode == -number
    assert not list(tmp_path.glob(f'*{HALF_MADE}'))
    # Ctrl-C may arrive while the parent handles that nothing has ended yet.
    chained = errors.count('During handling of the above exception')
    assert errors.count('Traceback') - chained == (number == signal.SIGINT)
    assert errors.endswith('KeyboardInterrupt\n') == (number == signal.SIGINT)


def test_a_worker_that_does_not_leave_is_killed(tasks, pipes, monkeypatch):
    """It has a bounded time to put things in order, and no more."""
    monkeypatch.setattr(child, 'UNWIND', 0.1)
    with open_pool(1) as pool:
        pool.submit('it', 'pool_tasks:say_hello_and_stay', pipes)
        ending = os.pidfd_open(int(read(pipes['hello'])))
    assert select.select([ending], [], [], 0.0)[0], 'the worker is still there'
    os.close(ending)


@pytest.mark.parametrize(
    ('workers', 'dask', 'sentence'),
    [
        (0, None, 'workers_0_1'),
        (2, 'tcp://host:8786', 'workers_does_belong'),
        (None, 'here', 'scheduler_here_missing'),
        (None, 'tcp://127.0.0.1:1', 'scheduler_tcp_127'),
    ],
)
def test_a_wrong_pool_is_one_sentence(monkeypatch, workers, dask, sentence, refused):
    """What, value, allowed; a scheduler that is not there is told soon."""
    if dask and workers is None:
        pytest.importorskip('distributed')
    monkeypatch.setattr(task_workers, 'PATIENCE', 0.3)
    refused(sentence, open_pool, workers, dask)
