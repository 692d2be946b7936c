# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that writes the recording of a node: it is started, fed and asked from here."""

from collections.abc import Callable, Mapping
import functools
import json
import os
from pathlib import Path
import subprocess
import sys
from typing import Any

from ballscrew_monitor.node.frames import Frame, FrameSender
from ballscrew_monitor.node.solver_process import worker_environment
from ballscrew_monitor.node.state_folder import AUTO
from surrogate.files import InputError

MODULE = 'ballscrew_monitor.recordings.black_box'
PIPE_SIZE = 2**20  # [B]
MEGABYTE = 1e6
LONGEST_LINE = 2**16  # [B]
PATIENCE = 2.0  # [s] for the last frames to be taken


def recording(
    values: Mapping[str, Any], state: Path | None
) -> Callable[[], 'RecordingProcess'] | None:
    """
    Return what starts the recording that the parameters `values` ask for, None: none is.

    `state` is where the node keeps what outlives it. Raises InputError when there is no place.

    """
    if values['record'] == 'off':
        return None
    folder = Path(values['record_dir'])
    if values['record_dir'] == AUTO:
        if state is None:
            raise InputError(
                f'parameter record is {values["record"]!r} and there is no state_dir: set '
                'record_dir to the directory of the recordings'
            )
        folder = state / 'recordings'
    settings = {
        'always': values['record'] == 'always',
        'before': values['record_before'],
        'after': values['record_after'],
        'longest': values['record_longest'],
        'largest': values['record_largest'] * MEGABYTE,
        'total': values['record_total'] * MEGABYTE,
    }
    return functools.partial(RecordingProcess, folder, settings)


class RecordingProcess:
    """A writer by name; frames that it has no time for wait here, up to a limit."""

    def __init__(self, folder: Path, settings: Mapping[str, Any]) -> None:
        """Start the writer for recordings in `folder`."""
        self._process = subprocess.Popen(
            [sys.executable, '-P', '-m', MODULE, str(folder), json.dumps(dict(settings))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            pipesize=PIPE_SIZE,
            env=worker_environment(),
            start_new_session=True,
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._out = self._process.stdout.fileno()
        os.set_blocking(self._out, False)
        self._sender = FrameSender(self._process.stdin.fileno())
        self._problem = ''

    @property
    def pid(self) -> int:
        """Return the number of the process."""
        return self._process.pid

    @property
    def lost(self) -> bool:
        """Tell whether the process has ended."""
        return self._sender.broken or self._process.poll() is not None

    @property
    def problem(self) -> str:
        """Return why nothing is recorded, in a sentence, or nothing."""
        if self.lost:
            return 'nothing is recorded: the process that records has ended, it is started again'
        try:
            lines = os.read(self._out, LONGEST_LINE).decode(errors='replace').splitlines()
        except BlockingIOError:
            lines = []
        self._problem = lines[-1] if lines else self._problem
        return self._problem

    def put(self, frame: Frame) -> bool:
        """Queue a frame; return False if it is lost."""
        return self._sender.put(frame)

    def flush(self) -> bool:
        """Send what can be sent without waiting; return whether that was all."""
        return self._sender.flush()

    def close(self) -> None:
        """Send what is left and let the process finish its recording."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        pipe = self._process.stdin
        os.set_blocking(pipe.fileno(), True)
        self._sender.flush()
        pipe.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:  # it finishes by itself, whenever that is
            pass
        self._process.stdout.close()
