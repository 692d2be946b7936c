# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A signal at any moment after the first line of the program ends it without a traceback."""

import functools
from pathlib import Path
import shutil
import signal
import subprocess
import sys

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment
import pytest

ROOT = Path(__file__).resolve().parents[2]
DEADLINE = 120.0  # [s]
COMMANDS = {
    'run': ['ballscrew_monitor', 'run', '--bag'],
    'play': ['ballscrew_monitor', 'play'],
    'replay': ['ballscrew_monitor', 'replay'],
    'doctor': ['ballscrew_monitor', 'doctor', '--seconds', '60'],
    'solve': ['ballscrew_monitor', 'solve', '--axis', 'x', '--wait', '60'],
}
STAGES = {'start': '', 'rclpy': 'librcl.so', 'participant': '/dev/shm/fastrtps_'}
"""What a process has mapped at a moment of its start."""


@pytest.fixture(scope='module')
def domain():
    """Return a domain for all of these processes, none of which is to hear another."""
    with free_domain() as number:
        yield number


@pytest.fixture
def until(wait_for):
    """Return what waits for a condition, or for the end of a process."""

    def reached(process, condition):
        wait_for(lambda: process.poll() is not None or condition(), 'the moment of the signal')

    return reached


@pytest.fixture
def start(domain, until):
    """Return what starts a program, and waits until it takes SIGTERM, as Python does not."""
    return functools.partial(_start, domain, until)


def _start(domain, until, command, *more, folder, **environment):
    process = subprocess.Popen(
        [sys.executable, '-m', *command, *more],
        env=child_environment(domain)
        | {'PYTHONPATH': str(ROOT), 'ROS_LOG_DIR': str(folder), **environment},
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    until(process, lambda: takes(process.pid, signal.SIGTERM))
    return process


def takes(pid, number):
    """Tell whether a process has a handler for a signal."""
    try:
        lines = Path(f'/proc/{pid}/status').read_text().splitlines()
    except OSError:
        return False
    caught = next(line for line in lines if line.startswith('SigCgt:'))
    return bool(int(caught.split()[1], 16) >> (number - 1) & 1)


def has_mapped(pid, text):
    """Tell whether a process has mapped a file of a name."""
    try:
        return text in Path(f'/proc/{pid}/maps').read_text()
    except OSError:
        return False


@pytest.mark.parametrize(
    ('stage', 'number'),
    [
        ('start', signal.SIGINT),
        ('rclpy', signal.SIGINT),
        ('rclpy', signal.SIGTERM),
        ('participant', signal.SIGINT),
    ],
)
def test_the_node_ends_with_0(start, until, tmp_path, stage, number):
    arguments = ['--ros-args', '-p', "state_dir:=''"]
    with start(['ballscrew_monitor.node'], *arguments, folder=tmp_path) as process:
        until(process, lambda: has_mapped(process.pid, STAGES[stage]))
        process.send_signal(number)
        out, err = process.communicate(timeout=DEADLINE)
    assert (process.returncode, out) == (0, '')
    assert 'Traceback' not in err


@pytest.mark.parametrize(
    ('command', 'stage'),
    [
        ('run', 'start'),
        ('run', 'participant'),
        ('play', 'rclpy'),
        ('play', 'participant'),
        ('replay', 'rclpy'),
        ('doctor', 'participant'),
        ('solve', 'participant'),
    ],
)
def test_a_command_ends_with_130(start, until, tmp_path, short_bag, command, stage):
    more = [str(short_bag)] if command in ('run', 'play', 'replay') else []
    with start(COMMANDS[command], *more, folder=tmp_path) as process:
        until(process, lambda: has_mapped(process.pid, STAGES[stage]))
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 130
    assert 'Traceback' not in err
    assert not err or err.startswith('ballscrew: interrupted')


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_report_that_is_ended_leaves_nothing_unfinished(
    start, until, tmp_path, nominal_bag, number, code
):
    out, scratch = tmp_path / 'out', tmp_path / 'scratch'
    scratch.mkdir()
    more = [str(nominal_bag), '--out', str(out)]  # long enough to be met at work
    with start(COMMANDS['replay'], *more, folder=tmp_path, TMPDIR=str(scratch)) as process:
        until(process, lambda: any(out.glob('.rows-*')))
        process.send_signal(number)
        _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == code
    assert err.splitlines()[-1] == 'ballscrew: interrupted'
    assert 'Traceback' not in err
    assert not [*out.iterdir(), *scratch.iterdir()]


@pytest.mark.parametrize(
    ('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -9)]
)
def test_workers_that_are_ended_leave_nothing_unfinished(
    start, until, tmp_path, short_bag, number, code
):
    """Whoever ends them: the program that is interrupted, or they themselves when it is gone."""
    logs, out, scratch = (tmp_path / name for name in ('logs', 'out', 'scratch'))
    scratch.mkdir()
    for name in 'abcd':
        shutil.copytree(short_bag, logs / name)
    more = [str(logs), '--out', str(out), '--workers', '2']
    with start(COMMANDS['replay'], *more, folder=tmp_path, TMPDIR=str(scratch)) as process:
        until(process, lambda: any(out.glob('*/.rows-*/*')))
        process.send_signal(number)
        _, err = process.communicate(timeout=DEADLINE)  # which the workers hold, too
    assert process.returncode == code
    assert 'Traceback' not in err
    assert not [*out.rglob('.*'), *scratch.iterdir()]


def test_sigterm_has_its_own_exit_code(start, tmp_path):
    with start(COMMANDS['doctor'], folder=tmp_path) as process:
        process.terminate()
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 143
