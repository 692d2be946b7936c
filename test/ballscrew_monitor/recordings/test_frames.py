# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Frames arrive as they were sent, and the sender waits for nobody."""

import contextlib
import io
import os

from ballscrew_monitor.recordings.frames import Frame, FrameKind, FrameSender, read_frames
from hypothesis import given
from hypothesis import strategies as st
import pytest

times = st.integers(-(2**63), 2**63 - 1)
frames = st.builds(
    Frame,
    kind=st.sampled_from(FrameKind),
    topic=st.integers(0, 2**16 - 1),
    log_time=times,
    publish_time=times,
    sequence=st.integers(0, 2**32 - 1),
    body=st.binary(max_size=200),
)


@given(st.lists(frames, max_size=10), st.integers(0, 100))
def test_frames_survive_the_pipe_and_one_that_is_cut_off_is_dropped(sent, cut):
    stream = b''.join(frame.packed() for frame in sent)
    assert list(read_frames(io.BytesIO(stream))) == sent
    if sent:
        cut = 1 + cut % len(sent[-1].packed())
        assert list(read_frames(io.BytesIO(stream[:-cut]))) == sent[:-1]


@pytest.fixture
def pipe():
    ends = os.pipe()
    yield ends
    for end in ends:
        with contextlib.suppress(OSError):
            os.close(end)


def frame(number, size=1000):
    return Frame(FrameKind.MESSAGE, sequence=number, body=bytes(size))


def test_what_a_full_pipe_does_not_take_waits_and_what_is_too_much_is_counted(pipe):
    sender = FrameSender(pipe[1], most=200_000)
    taken = [number for number in range(400) if sender.put(frame(number)) and sender.flush() + 1]
    assert 0 < len(taken) < 400
    assert not sender.flush()
    received = b''
    while not sender.flush():
        received += os.read(pipe[0], 2**16)
    os.close(pipe[1])
    while part := os.read(pipe[0], 2**16):
        received += part
    assert [one.sequence for one in read_frames(io.BytesIO(received))] == taken


def test_a_reader_that_is_gone_breaks_the_sender_and_an_absurd_length_the_stream(pipe):
    sender = FrameSender(pipe[1])
    os.close(pipe[0])
    assert sender.put(frame(0))
    assert sender.flush()
    assert sender.broken
    assert not sender.put(frame(1))
    head = Frame(FrameKind.MESSAGE, body=b'').packed()[:-4] + b'\xff' * 4
    assert list(read_frames(io.BytesIO(head + bytes(100)))) == []
