# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Prerequisites on machines that lack something, played by a folder of commands."""

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import subprocess
import sys

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / 'scripts' / 'prerequisites.sh'
DEADLINE = 600.0  # [s] which only ends a hang
# The interpreter underneath the environment that the tests run in.
BASE = os.path.realpath(getattr(sys, '_base_executable', sys.executable))
TRUE = '#!/bin/sh\n'
WORKING = f'#!/bin/sh\nexec {BASE} "$@"\n'
# Found on PATH, but fails when run: pyenv leaves such names for versions that are not selected.
SHIM = '#!/bin/sh\necho "pyenv: command not found" >&2\nexit 127\n'

Machine = Callable[..., 'subprocess.CompletedProcess[str]']


def put(folder, name, text):
    path = folder / name
    path.write_text(text)
    path.chmod(0o755)


@pytest.fixture
def machine(tmp_path):
    """Return a function that runs the script on a machine with just these commands."""
    folder = tmp_path / 'bin'
    folder.mkdir()
    for name in ('id', 'mkdir', 'sed', 'sh', 'tail'):
        (folder / name).symlink_to(shutil.which(name) or name)

    def run(commands, **variables):
        for name, text in commands.items():
            (folder / name).unlink(missing_ok=True)
            put(folder, name, text)
        return subprocess.run(
            [folder / 'sh', SCRIPT],
            env={'PATH': str(folder), **variables},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            timeout=DEADLINE,
        )

    return run


COMPLETE = {'git': TRUE, 'make': TRUE, 'g++': TRUE, 'python3': WORKING}
APT = {'apt-get': TRUE, 'apt-cache': '#!/bin/sh\n[ $3 != python3 ] || echo Version: 3.12.3-0\n'}


def test_python_underneath_that_works_or_was_asked_for_is_the_only_candidate(machine, says):
    done = machine(COMPLETE)
    assert (done.returncode, done.stdout, done.stderr) == (0, f'{BASE}\n', '')
    done = machine({**COMPLETE, 'python3': SHIM, 'python3.12': SHIM, 'python3.11': WORKING})
    assert (done.returncode, done.stdout) == (0, f'{BASE}\n')
    done = machine({**COMPLETE, 'other': SHIM}, PYTHON='other')
    assert done.returncode == 2
    assert done.stderr == says('set_up_python')


def test_user_gets_one_line_to_type(machine, says):
    """Nothing is installed for a user who is not root, and sudo is never called."""
    lacking = {name: text for name, text in COMPLETE.items() if name not in ('g++', 'python3')}
    done = machine({**lacking, **APT, 'id': '#!/bin/sh\necho 1000\n', 'python3': SHIM})
    assert done.returncode == 2
    assert done.stderr == says('set_up_type')


def test_machine_without_apt_gets_the_list(machine, says):
    done = machine({**COMPLETE, 'python3': SHIM})
    assert done.returncode == 2
    assert done.stderr.startswith(says('set_up_install'))
    assert done.stderr.count('\n') == 1


def test_root_gets_what_is_missing(machine, tmp_path):
    lacking = {name: text for name, text in COMPLETE.items() if name != 'g++'}
    apt = f'#!/bin/sh\necho "$@" >> asked\n[ $1 = update ] || : > {tmp_path}/bin/g++\n'
    chmod = shutil.which('chmod')
    done = machine(
        {
            **lacking,
            **APT,
            'id': '#!/bin/sh\necho 0\n',
            'apt-get': f'{apt}[ $1 = update ] || {chmod} +x {tmp_path}/bin/g++\n',
        }
    )
    assert (done.returncode, done.stdout) == (0, f'{BASE}\n')
    expected = ['update', 'install -y --no-install-recommends g++']
    assert (tmp_path / 'asked').read_text().splitlines() == expected


def test_failing_apt_is_said(machine, says):
    """The reason is the end of its output."""
    lacking = {name: text for name, text in COMPLETE.items() if name != 'make'}
    done = machine(
        {
            **lacking,
            **APT,
            'id': '#!/bin/sh\necho 0\n',
            'apt-get': '#!/bin/sh\necho no network\nexit 100\n',
        }
    )
    assert done.returncode == 2
    expected = ['set-up: installing make', 'no network', says('set_up_apt')]
    assert done.stderr.splitlines() == expected
