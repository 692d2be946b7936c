# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process of the full solves: what it holds, how it ends, and that it never outlives us."""

import os
from pathlib import Path
import signal
import subprocess
import sys

from ballscrew_monitor.node.solver_process import SolverProcess, worker_environment
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
