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
DEADLINE = 600.0  # [s] which only ends a hang
COMMANDS = {
    'run': ['ballscrew_monitor', 'run', '--bag'],
    'play': ['ballscrew_monitor', 'play', '--wait', str(DEADLINE)],
    'replay': ['ballscrew_monitor', 'replay'],
    'doctor': ['ballscrew_monitor', 'doctor', '--seconds', str(DEADLINE)],
    'solve': ['ballscrew_monitor', 'solve', '--axis', 'x', '--wait', str(DEADLINE)],
}
STAGES = {'start': '', 'rclpy': 'librcl.so', 'participant': '/dev/shm/fastrtps_'}
"""What a process has mapped at a moment of its start."""


@pytest.fixture(scope='module')
def domain():
    """Return a domain for all of these processes, none of which is to hear another."""
    with free_domain() as number:
        yield number


@pytest.fixture
def end(domain, wait_for):
    """
    Return what starts a program and sends it a signal when a condition of its number holds.

    Not before it takes SIGTERM, as Python does not. Gives its exit code and what it said.

    """

    def run(command, *more, number, folder, when=lambda pid: True, **environment):
        with subprocess.Popen(
            [sys.executable, '-m', *command, *map(str, more)],
            env=child_environment(domain)
            | {'PYTHONPATH': str(ROOT), 'ROS_LOG_DIR': str(folder), **environment},
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        ) as process:
            for reached in (functools.partial(takes, number=signal.SIGTERM), when):
                wait_for(
                    lambda reached=reached: process.poll() is not None or reached(process.pid),
                    'the moment of the signal',
                )
            process.send_signal(number)
            out, err = process.communicate(timeout=DEADLINE)  # which workers hold, too
        return process.returncode, out, err

    return run


def takes(pid, number):
    """Tell whether a process has a handler for a signal."""
    try:
        lines = Path(f'/proc/{pid}/status').read_text().splitlines()
    except OSError:
        return False
    caught = next(line for line in lines if line.startswith('SigCgt:'))
    return bool(int(caught.split()[1], 16) >> (number - 1) & 1)


def has_mapped(pid, stage):
    """Tell whether a process has mapped what belongs to a stage of its start."""
    try:
        return STAGES[stage] in Path(f'/proc/{pid}/maps').read_text()
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
def test_the_node_ends_with_0(end, tmp_path, stage, number):
    arguments = ['--ros-args', '-p', "state_dir:=''"]
    reached = functools.partial(has_mapped, stage=stage)
    code, out, err = end(
        ['ballscrew_monitor.node'], *arguments, number=number, folder=tmp_path, when=reached
    )
    assert (code, out) == (0, '')
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
def test_a_command_ends_with_130(end, tmp_path, short_bag, command, stage):
    more = [short_bag] if command in ('run', 'play', 'replay') else []
    reached = functools.partial(has_mapped, stage=stage)
    code, _, err = end(
        COMMANDS[command], *more, number=signal.SIGINT, folder=tmp_path, when=reached
    )
    assert code == 130
    assert 'Traceback' not in err
    assert not err or err.startswith('ballscrew: interrupted')


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_ended_report_leaves_nothing(end, tmp_path, nominal_bag, number, code):
    out, scratch = tmp_path / 'out', tmp_path / 'scratch'
    scratch.mkdir()
    more = [nominal_bag, '--out', out]  # long enough to be met at work
    at_work = {'when': lambda pid: any(out.glob('.rows-*')), 'TMPDIR': str(scratch)}
    found, _, err = end(COMMANDS['replay'], *more, number=number, folder=tmp_path, **at_work)
    assert found == code
    assert err.splitlines()[-1] == 'ballscrew: interrupted'
    assert 'Traceback' not in err
    assert not out.exists()
    assert not [*scratch.iterdir()]


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGKILL, -9)])
def test_workers_that_are_ended_leave_nothing_unfinished(end, tmp_path, short_bag, number, code):
    """Whoever ends them: the program that is interrupted, or they themselves when it is gone."""
    logs, out, scratch = (tmp_path / name for name in ('logs', 'out', 'scratch'))
    scratch.mkdir()
    for name in 'abc':
        shutil.copytree(short_bag, logs / name)
    more = [logs, '--out', out, '--workers', '2']
    at_work = {'when': lambda pid: any(out.glob('*/.rows-*/*')), 'TMPDIR': str(scratch)}
    found, _, err = end(COMMANDS['replay'], *more, number=number, folder=tmp_path, **at_work)
    assert found == code
    assert 'Traceback' not in err
    assert not [*out.rglob('.*'), *scratch.iterdir()]


def test_sigterm_has_its_own_exit_code(end, tmp_path):
    assert end(COMMANDS['doctor'], number=signal.SIGTERM, folder=tmp_path)[0] == 143
