# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that writes the recording of a node: it is started, fed and asked from here."""

from collections.abc import Callable, Mapping
import contextlib
import fcntl
import functools
import json
import os
from pathlib import Path
import select
import subprocess
import time
from typing import Any

from ballscrew_monitor.node.restart_state import AUTO
from ballscrew_monitor.recordings.frames import Frame, FrameSender
from surrogate.files import InputError
from surrogate.tasks.child import one_thread_environment, start

MODULE = 'ballscrew_monitor.recordings.retention'
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
    if values['record'] == 'never':
        return None
    if values['record_total'] < 2.0 * values['record_largest']:
        raise InputError(
            f'parameter record_total is {values["record_total"]:g} MB, it must be at least twice '
            f'record_largest, {values["record_largest"]:g} MB: else each one removes the last'
        )
    folder = Path(values['record_dir'])
    if values['record_dir'] == AUTO:
        if state is None:
            raise InputError(
                f'parameter record is {values["record"]!r} and there is no state_dir: set '
                'record_dir to the directory of the recordings'
            )
        folder = state / 'recordings'
    settings = {name: values[f'record_{name}'] for name in ('before', 'after', 'longest')}
    settings |= {name: values[f'record_{name}'] * MEGABYTE for name in ('largest', 'total')}
    settings['always'] = values['record'] == 'always'
    return functools.partial(RecordingProcess, folder, settings)


class RecordingProcess:
    """A writer by name; frames that it has no time for wait here, up to a limit."""

    def __init__(self, folder: Path, settings: Mapping[str, Any]) -> None:
        """Start the writer for recordings in `folder`; one that cannot be started is lost."""
        self._problem = ''
        self._process: Any = None  # with pipes at both ends
        try:
            self._process = _started(folder, settings)
        except OSError as error:
            self._problem = f'the process that records cannot be started, {error.strerror}'
            return
        self._sender = FrameSender(self._process.stdin.fileno())

    @property
    def lost(self) -> bool:
        """Return True if there is no process, or it has ended."""
        if self._process is None:
            return True
        return self._sender.broken or self._process.poll() is not None

    @property
    def problem(self) -> str:
        """Return why nothing is recorded, in a sentence, or nothing."""
        if self._process is None:
            return f'nothing is recorded: {self._problem}'
        if self.lost:
            return 'nothing is recorded: the process that records has ended, it is started again'
        try:
            lines = os.read(self._process.stdout.fileno(), LONGEST_LINE)
        except BlockingIOError:
            lines = b''
        if lines:
            self._problem = lines.decode(errors='replace').splitlines()[-1]
        return self._problem

    def put(self, frame: Frame) -> bool:
        """Queue a frame; return False if it is lost."""
        return self._process is not None and self._sender.put(frame)

    def flush(self) -> bool:
        """Send what can be sent without waiting; return whether that was all."""
        return self._process is None or self._sender.flush()

    def close(self) -> None:
        """Send what is left and let the process finish its recording, which may take its time."""
        if self._process is None:
            return
        pipe, end = self._process.stdin, time.monotonic() + PATIENCE
        while not self._sender.flush() and (left := end - time.monotonic()) > 0:
            select.select([], [pipe], [], left)
        pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(max(end - time.monotonic(), 0.0))
        self._process.stdout.close()


def _started(folder: Path, settings: Mapping[str, Any]) -> Any:
    process: Any = start(
        *(MODULE, str(folder), json.dumps(dict(settings))),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
        env=one_thread_environment(),
    )
    with contextlib.suppress(OSError):  # the limit of this machine may be lower
        fcntl.fcntl(process.stdin, fcntl.F_SETPIPE_SZ, PIPE_SIZE)
    os.set_blocking(process.stdout.fileno(), False)
    return process
