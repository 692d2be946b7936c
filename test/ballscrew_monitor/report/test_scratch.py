# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Hidden folders go with their process, or with the next one that makes a report there."""

import os
import subprocess
import sys

from ballscrew_monitor.report import scratch
from ballscrew_monitor.report.scratch import scratch_folder
import pytest

KILLED = """
import os
import signal
import sys
from pathlib import Path
from ballscrew_monitor.report.scratch import scratch_folder
with scratch_folder(Path(sys.argv[1])) as folder:
    (folder / 'rows').touch()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_process_has_left_is_removed_and_what_is_in_use_is_not(tmp_path):
    environment = os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, '-c', KILLED, str(tmp_path)], env=environment, check=False)
    (left,) = tmp_path.iterdir()
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert not left.exists()
        assert set(tmp_path.iterdir()) == {first, second}
    assert not list(tmp_path.iterdir())


def test_where_there_are_no_locks_nothing_is_taken_away(tmp_path, monkeypatch):
    def refuse(*_):
        raise OSError

    monkeypatch.setattr(scratch.fcntl, 'flock', refuse)
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert set(tmp_path.iterdir()) == {first, second}


def test_an_interrupt_as_soon_as_a_folder_is_there_leaves_nothing(tmp_path, monkeypatch):
    make = os.mkdir

    def make_and_interrupt(*arguments):
        make(*arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, 'mkdir', make_and_interrupt)
    with pytest.raises(KeyboardInterrupt), scratch_folder(tmp_path):
        raise AssertionError
    assert not list(tmp_path.iterdir())
