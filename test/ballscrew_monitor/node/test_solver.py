# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process of the full solves: what it holds, how it ends, and that it never outlives us."""

import math
import os
from pathlib import Path
import signal
import subprocess
import sys

from ballscrew_monitor.node.solver import (
    End,
    GRACE,
    Job,
    MOST_WAITING,
    Solver,
    start_worker,
    step_of,
    TASK,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.tasks.child import one_thread_environment

BAD_REQUEST = {'point': {}}


class Asked:
    """A worker of solves, and the frames that were heard of it and not yet taken."""

    def __init__(self, pool, wait_for):
        self.pool, self.wait_for, self.frames = pool, wait_for, []

    def hear(self):
        """Return the next frame; several may be heard at once."""
        while not self.frames:
            self.frames += self.wait_for(lambda: self.pool.wait(0.0), 'a frame')
        return self.frames.pop(0)[1]

    def ask(self):
        """Ask for a solve that cannot be; return the process that is asked."""
        self.pool.submit('a', TASK, BAD_REQUEST)
        return int(self.hear()['begun'].partition('/')[2])


@pytest.fixture(name='asked')
def make_asked(wait_for):
    with start_worker() as pool:
        yield Asked(pool, wait_for)


def test_a_bad_request_and_ctrl_c_do_not_end_it_and_a_kill_is_told(asked):
    process = asked.ask()
    assert asked.hear()['sentence'] == "KeyError: 'header'"
    os.kill(process, signal.SIGINT)
    assert asked.ask() == process
    assert asked.hear()['sentence'] == "KeyError: 'header'"
    os.kill(process, signal.SIGSTOP)
    assert asked.ask() == process
    os.kill(process, signal.SIGKILL)
    assert asked.hear() == {'lost': 'was killed by signal 9'}


def test_it_holds_nothing_of_ros_and_runs_nicely_in_bounded_memory(asked):
    process = asked.ask()
    asked.hear()
    maps = Path(f'/proc/{process}/maps').read_text()
    assert 'numba' in maps  # the solver is loaded
    assert 'rclpy' not in maps
    assert 'fastrtps' not in maps
    here = os.getpriority(os.PRIO_PROCESS, 0)
    assert os.getpriority(os.PRIO_PROCESS, process) == min(here + 10, 19)
    limits = Path(f'/proc/{process}/limits').read_text()
    assert f'Max data size             {6 * 2**30}' in limits


def test_what_the_worker_imports_is_the_offline_half_alone():
    code = 'import surrogate.tasks.worker, surrogate.builder.on_demand, sys; print(*sys.modules)'
    done = subprocess.run(
        [sys.executable, '-P', '-c', code],
        env=one_thread_environment(),
        check=True,
        capture_output=True,
        text=True,
    )
    names = {name.split('.')[0] for name in done.stdout.split()}
    assert 'surrogate' in names
    assert not names & {'rclpy', 'ballscrew_monitor', 'ballscrew_msgs', 'matplotlib'}


class Pool:
    """Notes what it is asked and hands out what it is given."""

    def __init__(self):
        self.asked, self.out, self.cancelled, self.killed, self.closed = [], [], [], [], False

    @property
    def last(self):
        return self.asked[-1]

    def submit(self, name, task, inputs):
        assert task == TASK
        self.asked.append((name, inputs))
        self.out.append((name, {'begun': 'host/1'}))

    def give(self, *frames):
        self.out += [(self.last[0], frame) for frame in frames]

    def wait(self, seconds):
        assert seconds == 0.0
        taken, self.out = self.out, []
        return taken

    def cancel(self, name):
        self.cancelled.append(name)

    def kill(self, name):
        self.killed.append(name)

    def close(self):
        self.closed = True


@pytest.fixture(name='world')
def world_fixture():
    return make_world()


def make_world():
    pool = Pool()
    return Solver(lambda: pool), pool


def job(number=0, timeout=10.0):
    return Job(request={'number': number}, timeout=timeout)


def begin(world, *jobs):
    """Hand jobs over and let the first begin; return the solver and its pool."""
    solver, pool = world
    for one in jobs:
        solver.submit(one)
    assert solver.poll(0.0) == []
    return solver, pool


def ends(done):
    return [(one, one.end, one.sentence) for one in done]


def solved(**result):
    return {'result': result, 'sentence': '', 'worker': 'host/1', 'seconds': 1.0}


def failed(sentence):
    return {'result': None, 'sentence': sentence, 'worker': 'host/1', 'seconds': 1.0}


def test_nothing_is_asked_before_it_is_needed_and_closing_ends_it(world):
    solver, pool = world
    assert solver.poll(0.0) == []
    assert (pool.asked, solver.busy) == ([], False)
    begin(world, job())
    solver.close()
    assert pool.closed
    assert not solver.busy


def test_one_after_another_in_the_order_in_which_they_came(world):
    jobs = [job(number) for number in range(3)]
    solver, pool = begin(world, *jobs)
    for now, one in enumerate(jobs, start=1):
        assert pool.last[1] == one.request
        pool.give(solved(rcs=0.5))
        assert ends(solver.poll(float(now))) == [(one, End.SOLVED, '')]
        assert (one.result, one.wall_time) == ({'rcs': 0.5}, 1.0)
    assert not solver.busy
    assert len({name for name, _ in pool.asked}) == len(jobs)


def test_progress_is_kept_with_the_solve(world):
    one = job()
    assert one.step.stage == 'waiting'
    solver, pool = begin(world, one)
    assert one.step.stage == 'starting'
    pool.give({'step': {'stage': 'rough contact', 'nut': 1, 'side': 2, 'fraction': 0.25}})
    assert solver.poll(2.0) == []
    assert (one.step.stage, one.step.nut, one.step.side) == ('rough contact', 1, 2)
    assert one.step.seconds_left == pytest.approx(6.0)


def test_the_queue_is_bounded_and_says_so(world):
    solver, _ = world
    for number in range(1 + MOST_WAITING):
        assert solver.refusal == ''
        solver.submit(job(number))
        solver.poll(0.0)
    assert solver.refusal == '8 solves wait already, no more than 8 may'


def test_a_solve_that_waits_is_taken_back_at_once(world):
    first, second = job(1), job(2)
    solver, pool = begin(world, first)
    solver.submit(second)
    solver.cancel(second, 0.0)
    assert ends(solver.poll(0.1)) == [(second, End.CANCELLED, '')]
    assert (pool.cancelled, pool.killed) == ([], [])
    assert solver.busy


def test_a_solve_at_work_may_end_by_itself_or_its_process_is_ended(world):
    first, second = job(1), job(2)
    solver, pool = begin(world, first, second)
    name = pool.last[0]
    solver.cancel(first, 1.0)
    assert pool.cancelled == [name]
    pool.give(failed('Cancelled: '))
    assert ends(solver.poll(1.1)) == [(first, End.CANCELLED, '')]
    assert pool.killed == []
    solver.cancel(second, 2.0)
    assert solver.poll(2.0 + 0.9 * GRACE) == []
    assert ends(solver.poll(2.1 + GRACE)) == [(second, End.CANCELLED, '')]
    assert pool.killed == [pool.last[0]] != [name]


@pytest.mark.parametrize(
    ('frame', 'cancelled', 'end', 'sentence'),
    [
        (solved(rcs=1.0), True, End.CANCELLED, ''),  # a result that comes after all is not kept
        (failed('ValueError: no'), False, End.FAILED, 'ValueError: no'),
        ({'lost': 'was killed by signal 9'}, False, End.FAILED, 'process_solve_was'),
    ],
)
def test_a_solve_that_comes_to_nothing(world, frame, cancelled, end, sentence, says):
    """It fails alone, and the next one begins."""
    first, second = job(1), job(2)
    solver, pool = begin(world, first, second)
    if cancelled:
        solver.cancel(first, 1.0)
    pool.give(frame)
    sentence = says(sentence) if 'lost' in frame else sentence
    assert ends(solver.poll(1.1)) == [(first, end, sentence)]
    assert pool.last[1] == second.request


def test_a_solve_ends_at_its_timeout_which_counts_from_its_begin(world):
    first, second = job(1, timeout=5.0), job(2, timeout=5.0)
    solver, pool = begin(world, first, second)
    name = pool.last[0]
    pool.give({'step': {'stage': 'contact', 'fraction': 0.5}})
    assert solver.poll(4.9) == []
    text = 'stopped after its timeout of 5 s, 50 % done'
    assert ends(solver.poll(5.0)) == [(first, End.FAILED, text)]
    assert pool.killed == [name]
    assert pool.last[1] == second.request
    pool.out.append((name, solved()))  # of the one before
    assert solver.poll(9.9) == []


def test_a_step_without_numbers_knows_none():
    step = step_of({'stage': 'loading'}, 3.0)
    assert step.stage == 'loading'
    assert math.isnan(step.residual)
    assert math.isnan(step.seconds_left)


acts = st.lists(
    st.sampled_from(['submit', 'cancel', 'solved', 'failed', 'lost', 'step', 'wait']), max_size=60
)


@given(acts)
def test_every_solve_ends_exactly_once(script):
    frames = {
        'solved': solved(),
        'failed': failed('why'),
        'lost': {'lost': 'was killed by signal 9'},
        'step': {'step': {}},
    }
    solver, pool = make_world()
    jobs, done, now = [], [], 0.0
    for act in script:
        now += 1.0
        if act == 'submit' and not solver.refusal:
            jobs.append(job(len(jobs), timeout=7.0))
            solver.submit(jobs[-1])
        elif act == 'cancel' and jobs:
            solver.cancel(jobs[len(jobs) // 2], now)
        elif act in frames and pool.asked:
            pool.give(frames[act])
        done += solver.poll(now)
    while solver.busy:
        now += 1.0
        done += solver.poll(now)
    assert sorted(one.request['number'] for one in done) == list(range(len(jobs)))
