# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that records: whatever becomes of it, the node goes on and says so."""

import os
from pathlib import Path
import signal
import subprocess

from ballscrew_monitor.node import recording_process
from ballscrew_monitor.node.recording_process import recording, RecordingProcess
from ballscrew_monitor.recordings.frames import Frame, FrameKind
from ballscrew_monitor.settings import parameters
from surrogate.tasks import child

SETTINGS = {
    'always': True,
    'before': 60.0,
    'after': 10.0,
    'longest': 60.0,
    'largest': 1e6,
    'total': 1e7,
}
FRAME = Frame(FrameKind.MESSAGE, body=bytes(100_000))


def values(**changes):
    return parameters.defaults(['x']) | {'record': 'always'} | changes


def test_a_recording_is_made_where_it_is_wished_has_a_place_and_leaves_room(tmp_path, refused):
    assert recording(values(record='never'), None) is None
    refused('there_state_dir_set', recording, values(), None)
    assert recording(values(), tmp_path).args[0] == tmp_path / 'recordings'
    assert recording(values(record_dir='/there'), None).args[0] == Path('/there')
    refused('record_total_300_mb', recording, values(record_total=300.0), tmp_path)


def test_what_cannot_be_started_is_told_and_takes_nothing(tmp_path, monkeypatch, says):
    monkeypatch.setattr(child.sys, 'executable', '/no/python')
    process = RecordingProcess(tmp_path, SETTINGS)
    assert process.lost
    assert not process.put(FRAME)
    assert process.flush()
    assert process.problem == says('nothing_recorded_process')
    process.close()


def test_a_writer_that_stands_still_does_not_hold_up_the_end(tmp_path, monkeypatch):
    monkeypatch.setattr(recording_process, 'PATIENCE', 0.1)
    started = []
    popen = subprocess.Popen

    def start(*arguments, **options):
        started.append(popen(*arguments, **options))
        return started[-1]

    monkeypatch.setattr(recording_process.subprocess, 'Popen', start)
    process = RecordingProcess(tmp_path, SETTINGS)
    os.kill(started[0].pid, signal.SIGSTOP)
    while process.put(FRAME):
        process.flush()
    process.close()
    started[0].kill()
    started[0].wait()
