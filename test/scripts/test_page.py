# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`make page`: the node, its player and the page, and nothing of them afterwards."""

import os
from pathlib import Path
import signal
import subprocess

import pytest
from surrogate.tasks.child import path_to_this_code

TREE = Path(__file__).resolve().parents[2]
DEADLINE = 600.0  # [s] which only ends a hang


def of_group(number):
    """Return the processes of a group that run."""
    found = []
    for path in Path('/proc').glob('[0-9]*/stat'):
        try:
            fields = path.read_text().rpartition(')')[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(fields[2]) == number and fields[0] != 'Z':
            found.append(path.parent.name)
    return found


def test_the_page_shows_the_cycle_and_leaves_nothing(wait_for):
    if not (TREE / 'bags' / 'nominal_cycle').is_dir():
        pytest.skip('the bag of the nominal cycle is not made')
    process = subprocess.Popen(
        ['sh', TREE / 'scripts' / 'page.sh', '--port', '0'],
        env=dict(os.environ) | {'PYTHONPATH': path_to_this_code()},
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        line = process.stdout.readline()
        assert line.startswith('page http://127.0.0.1:')
        assert len(of_group(process.pid)) >= 4
    finally:
        os.killpg(process.pid, signal.SIGINT)
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 0
    wait_for(lambda: not of_group(process.pid), 'the end of node and player')
