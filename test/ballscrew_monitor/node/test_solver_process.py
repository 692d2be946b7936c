# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process of the full solves: what it holds, how it ends, and that it never outlives us."""

import math
import os
from pathlib import Path
import signal
import subprocess
import sys

from ballscrew_monitor.node.solver_process import (
    Done,
    End,
    GRACE,
    Job,
    MOST_WAITING,
    Solver,
    SolverProcess,
    step_of,
    worker_environment,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest

BAD_REQUEST = {'solve': {'point': {}}}


@pytest.fixture(name='process')
def make_process():
    made = SolverProcess()
    yield made
    made.kill()


def test_a_bad_request_and_ctrl_c_do_not_end_it_and_a_kill_is_told(process, wait_for, says):
    for _ in range(2):
        process.send(BAD_REQUEST)
        (frame,) = wait_for(process.frames, 'a frame')
        assert frame == {'failed': "KeyError: 'header'"}
    process.send(BAD_REQUEST)
    wait_for(process.frames, 'a frame')
    os.kill(process.pid, signal.SIGINT)
    process.send(BAD_REQUEST)
    assert 'failed' in wait_for(process.frames, 'a frame')[0]
    os.kill(process.pid, signal.SIGKILL)
    (frame,) = wait_for(process.frames, 'a frame')
    assert frame == {'lost': says('process_solve_was')}


def test_it_holds_nothing_of_ros_and_runs_nicely(process, wait_for):
    process.send(BAD_REQUEST)
    wait_for(process.frames, 'a frame')
    maps = Path(f'/proc/{process.pid}/maps').read_text()
    assert 'numba' in maps  # the solver is loaded
    assert 'rclpy' not in maps
    assert 'fastrtps' not in maps
    here = os.getpriority(os.PRIO_PROCESS, 0)
    assert os.getpriority(os.PRIO_PROCESS, process.pid) == min(here + 10, 19)


def test_what_the_worker_imports_is_the_offline_half_alone():
    code = 'import surrogate.on_demand.worker, surrogate.on_demand.solve, sys; print(*sys.modules)'
    done = subprocess.run(
        [sys.executable, '-P', '-c', code],
        env=worker_environment(),
        check=True,
        capture_output=True,
        text=True,
    )
    names = {name.split('.')[0] for name in done.stdout.split()}
    assert 'surrogate' in names
    assert not names & {'rclpy', 'ballscrew_monitor', 'ballscrew_msgs', 'matplotlib'}


def test_it_ends_with_whoever_started_it(wait_for, is_alive):
    """The parent is killed, and can clean up nothing."""
    code = (
        'from ballscrew_monitor.node.solver_process import SolverProcess\n'
        'import sys\n'
        'process = SolverProcess()\n'
        'print(process.pid, flush=True)\n'
        'sys.stdin.read()\n'
    )
    parent = subprocess.Popen(
        [sys.executable, '-c', code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=worker_environment(),
        text=True,
    )
    worker = int(parent.stdout.readline())
    assert Path(f'/proc/{worker}').exists()
    parent.kill()
    parent.wait()
    wait_for(lambda: not is_alive(worker), 'the end of the worker')
    parent.stdin.close()
    parent.stdout.close()


class Process:
    """Notes what it is sent and hands out what it is given."""

    def __init__(self):
        self.sent, self.out, self.killed = [], [], False

    def send(self, frame):
        self.sent.append(frame)

    def frames(self):
        taken, self.out = self.out, []
        return taken

    def kill(self):
        self.killed = True


@pytest.fixture(name='world')
def world_fixture():
    return make_world()


def make_world():
    started = []

    def start():
        started.append(Process())
        return started[-1]

    return Solver(start), started


def job(number=0, timeout=10.0):
    return Job(request={'number': number}, timeout=timeout)


def begin(world, *jobs):
    """Hand jobs over and let the first begin; return the solver and its processes."""
    solver, started = world
    for one in jobs:
        solver.submit(one)
    assert solver.poll(0.0) == []
    return solver, started


def ends(done):
    return [(one.job, one.end, one.sentence) for one in done]


def test_no_process_is_started_before_it_is_needed_and_closing_ends_it(world):
    solver, started = world
    assert solver.poll(0.0) == []
    assert (started, solver.busy) == ([], False)
    solver, started = begin(world, job())
    solver.close()
    assert started[0].killed
    assert not solver.busy


def test_one_after_another_in_the_order_in_which_they_came(world):
    jobs = [job(number) for number in range(3)]
    solver, started = begin(world, *jobs)
    (process,) = started
    for now, one in enumerate(jobs, start=1):
        assert process.sent[-1] == {'solve': one.request}
        process.out = [{'solved': {'rcs': 0.5}}]
        expected = [Done(job=one, end=End.SOLVED, result={'rcs': 0.5}, wall_time=1.0)]
        assert solver.poll(float(now)) == expected
    assert not solver.busy


def test_progress_is_kept_with_the_solve(world):
    one = job()
    assert one.step.stage == 'waiting'
    solver, started = begin(world, one)
    assert one.step.stage == 'starting'
    started[0].out = [
        {'progress': {'stage': 'rough contact', 'nut': 1, 'side': 2, 'fraction': 0.25}}
    ]
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
    solver, started = begin(world, first)
    solver.submit(second)
    solver.cancel(second, 0.0)
    assert ends(solver.poll(0.1)) == [(second, End.CANCELLED, '')]
    assert not started[0].killed
    assert solver.busy


def test_a_solve_at_work_may_end_by_itself_or_its_process_is_ended(world):
    first, second = job(1), job(2)
    solver, started = begin(world, first, second)
    solver.cancel(first, 1.0)
    assert started[0].sent[-1] == {'cancel': None}
    started[0].out = [{'cancelled': None}]
    assert ends(solver.poll(1.1)) == [(first, End.CANCELLED, '')]
    assert not started[0].killed
    solver.cancel(second, 2.0)
    assert solver.poll(2.0 + 0.9 * GRACE) == []
    assert ends(solver.poll(2.1 + GRACE)) == [(second, End.CANCELLED, '')]
    assert started[0].killed


@pytest.mark.parametrize(
    ('frame', 'cancelled', 'end', 'sentence', 'processes'),
    [
        ({'solved': {}}, True, End.CANCELLED, '', 1),  # a result that comes after all is not kept
        ({'failed': 'ValueError: no'}, False, End.FAILED, 'ValueError: no', 1),
        ({'lost': 'killed by signal 9'}, False, End.FAILED, 'killed by signal 9', 2),
    ],
)
def test_a_solve_that_comes_to_nothing(world, frame, cancelled, end, sentence, processes):
    """A failure keeps the process; one that is lost fails its solve alone and is replaced."""
    first, second = job(1), job(2)
    solver, started = begin(world, first, second)
    if cancelled:
        solver.cancel(first, 1.0)
    started[0].out = [frame]
    assert ends(solver.poll(1.1)) == [(first, end, sentence)]
    assert started[-1].sent[-1] == {'solve': second.request}
    assert len(started) == processes


def test_a_solve_ends_at_its_timeout_which_counts_from_its_begin(world):
    first, second = job(1, timeout=5.0), job(2, timeout=5.0)
    solver, started = begin(world, first, second)
    started[0].out = [{'progress': {'stage': 'contact', 'fraction': 0.5}}]
    assert solver.poll(4.9) == []
    text = 'stopped after its timeout of 5 s, 50 % done'
    assert ends(solver.poll(5.0)) == [(first, End.FAILED, text)]
    assert started[0].killed
    assert started[1].sent == [{'solve': second.request}]
    assert solver.poll(9.9) == []


def test_a_step_without_numbers_knows_none():
    step = step_of({'stage': 'loading', 'residual': None}, 3.0)
    assert step.stage == 'loading'
    assert math.isnan(step.residual)
    assert math.isnan(step.seconds_left)


acts = st.lists(
    st.sampled_from(['submit', 'cancel', 'solved', 'failed', 'lost', 'progress', 'wait']),
    max_size=60,
)


@given(acts)
def test_every_solve_ends_exactly_once(script):
    solver, started = make_world()
    jobs, done, now = [], [], 0.0
    for act in script:
        now += 1.0
        if act == 'submit' and not solver.refusal:
            jobs.append(job(len(jobs), timeout=7.0))
            solver.submit(jobs[-1])
        elif act == 'cancel' and jobs:
            solver.cancel(jobs[len(jobs) // 2], now)
        elif act in ('solved', 'progress') and started:
            started[-1].out.append({act: {}})
        elif act in ('failed', 'lost') and started:
            started[-1].out.append({act: 'why'})
        done += solver.poll(now)
    while solver.busy:
        now += 1.0
        done += solver.poll(now)
    assert sorted(one.job.request['number'] for one in done) == list(range(len(jobs)))
